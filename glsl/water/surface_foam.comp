#version 460
// Pass `surface_foam`, compute path. It finds the depth of the frontmost surface foam (thesis Sec. 4.6.2), then sums,
// in fixed-point steps, the thickness of all foam and of its front layer, the foam right behind the frontmost (Sec.
// 4.8). One invocation handles a sprite, a whole workgroup a large one. A noise breaks up the discs: a pattern that
// all sprites share, or a noise of each sprite that changes with its age.
// Reads: Counts, sprites, words. Writes: words.

#include "frame.glsl"
#include "sphere.glsl"
#include "counts.glsl"
#include "random.glsl"
#include "whole_steps.glsl"
#include "gradient_noise.glsl"
#include "surface_foam.glsl"
#include "pattern.glsl"
#include "kernel.glsl"
#include "surface_foam_sprite.glsl"
#include "surface_foam_sums.glsl"
#include "plane.glsl"

layout(local_size_x = FOAM_GROUP) in;
// 0: depth. 1: thickness.
layout(constant_id = 0) const uint THICK = 0;

layout(set = 0, binding = 1, std430) readonly buffer Sprites { FoamSprite sprites[]; };
layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 5, std430) buffer Words { uint words[]; };

// Max number of texels of a sprite's box for which one invocation processes the sprite alone; a larger sprite is
// shared by the workgroup. The number is the upper end of a size class.
const int SMALL = 1023;

// Number of classes by which foam sprites are sorted: two for each power of two of a sprite's number of texels.
const uint CLASSES = 24u;

shared int texels[FOAM_GROUP];
shared uint order[FOAM_GROUP];
shared uint before[CLASSES];

struct Splat {
    FoamPlane plane;
    vec3 along;  // divided by its half-axis
    vec3 across;
    float amount;
    FoamNoise noise;
    ivec4 box;   // texels that it may cover
};

// Bounds of a foam sprite's ellipse on one axis of the image, as slopes (x / depth or y / depth), from the two
// tangent planes through the eye; ±1e10 if the ellipse comes near the eye's own plane (depth 0). They are computed
// relative to the centre's slope, so that they are exact for small sprites.
vec2 touching(vec2 centre, vec2 half1, vec2 half2) {
    float from = centre.x / -centre.y;
    vec2 w = vec2(half1.x + from * half1.y, half2.x + from * half2.y);
    vec2 z = vec2(half1.y, half2.y);
    float lead = centre.y * centre.y - dot(z, z);
    if (lead <= 0.02 * centre.y * centre.y) {
        return vec2(-1.0e10, 1.0e10);
    }
    float mean = dot(w, z);
    float reach = sqrt(mean * mean + lead * dot(w, w));
    return from + vec2(mean - reach, mean + reach) / lead;
}

Splat splat_of(uint index) {
    FoamSprite sprite = sprites[index];
    Splat s;
    s.plane = foam_plane(sprite, THICK == 1u);
    s.along = s.plane.e1 / s.plane.axes.x;
    s.across = s.plane.e2 / s.plane.axes.y;
    if (THICK == 1u) {
        s.amount = foam_amount(sprite, s.plane);
        s.noise = foam_noise(sprite, s.plane);
    }
    vec3 a = s.plane.e1 * s.plane.axes.x;
    vec3 b = s.plane.e2 * s.plane.axes.y;
    vec2 x = touching(s.plane.centre.xz, a.xz, b.xz);
    vec2 y = touching(s.plane.centre.yz, a.yz, b.yz);
    vec4 texels = pixel_bounds(vec4(x.x, y.x, x.y, y.y), frame.thick_slope);
    s.box = pixel_span(texels + vec4(-0.125, -0.125, 0.125, 0.125), frame.thick_extent.xy);
    return s;
}

// Adds `steps` to the texel's sums of thickness from `word` on, most of which get 0. Any number of sprites may lie on
// one spot: an addition to a word that is already half full is subtracted again, so no word overflows, unless more
// invocations add at the same time than HALF_FULL leaves room for. All additions share one atomic operation in a loop:
// a CPU driver runs the invocations one by one at each atomic operation in the code, even those that add nothing.
void add(uint word, uvec4 steps) {
    do {
        // If the word was half full before the addition, the addition is undone in the next round. An addition of 0
        // must not be undone, as this would repeat forever.
        bool over = atomicAdd(words[word], steps.x) >= HALF_FULL && steps.x - 1u < HALF_FULL - 1u;
        steps = over ? uvec4(0u - steps.x, steps.yzw) : uvec4(steps.yzw, 0u);
        word += over ? 0u : 1u;
        bool next = !over && steps.x == 0u;
        steps = next ? uvec4(steps.yzw, 0u) : steps;
        word += next ? 1u : 0u;
    } while (any(notEqual(steps, uvec4(0u))));
}

void splat(ivec2 texel, Splat s) {
    vec2 slope = ray_slope(vec2(texel) + 0.5, frame.thick_slope);
    vec2 place;
    float depth;
    if (!plane_hit(s.plane.centre, s.along, s.across, s.plane.normal, slope, place, depth)) {
        return;
    }
    uint at = words_of(texel);
    uint front = words[at + FRONT];
    if (THICK == 0u) {
        // The atomic minimum is skipped if a read shows that it would change nothing: a read is cheaper, and most
        // sprites are behind the scene or behind other sprites.
        if (floatBitsToUint(depth) < front) {
            atomicMin(words[at + FRONT], floatBitsToUint(depth));
        }
        return;
    }
    uint scene = words[at + SCENE];
    // Distance along z from the foam sprite to the scene behind it; 0 or less where the scene hides the sprite.
    float before = uintBitsToFloat(scene) - depth;
    if (!(before > 0.0)) {
        return;
    }
    float frontmost = front < scene ? uintBitsToFloat(front) : EMPTY;
    uvec4 steps = uvec4(foam_steps(texel, s.amount, s.noise, place, depth, frontmost, before));
    if (steps.x > 0u) {
        uvec2 behind = uvec2(min(steps.w, steps.x), steps.x - min(steps.x, steps.y));
        uint unlit = steps.y - min(steps.z, steps.y);
        add(at + ALL, LIT == 1u ? uvec4(steps.x, unlit, behind) : uvec4(steps.x, behind, 0u));
    }
}

int texels_of(ivec4 box) {
    ivec2 size = max(box.zw - box.xy + 1, ivec2(0));
    return size.x * size.y;
}

uint class_of(int texels) {
    uint n = uint(max(texels, 1));
    uint power = uint(findMSB(n));
    return min(2u * power + (power > 0u ? n >> (power - 1u) & 1u : 0u), CLASSES - 1u);
}

// Returns the index in the workgroup of the sprite that this invocation processes; `own` is the number of texels of
// its original sprite. Invocations in lockstep wait for the one with the most texels, so the sprites of a workgroup
// are sorted by size class.
uint in_order(int own) {
    uint local = gl_LocalInvocationIndex;
    if (local < CLASSES) {
        before[local] = 0u;
    }
    texels[local] = own;
    barrier();
    uint place = atomicAdd(before[class_of(own)], 1u);
    barrier();
    if (local == 0u) {
        uint sum = 0u;
        for (uint i = 0u; i < CLASSES; ++i) {
            uint here = before[i];
            before[i] = sum;
            sum += here;
        }
    }
    barrier();
    order[before[class_of(own)] + place] = local;
    barrier();
    return order[local];
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint first = gl_WorkGroupID.x * FOAM_GROUP;
    uint mine = in_order(first + local < counts.foam ? texels_of(splat_of(first + local).box) : 0);
    if (texels[mine] > 0 && texels[mine] <= SMALL) {
        Splat s = splat_of(first + mine);
        for (int y = s.box.y; y <= s.box.w; ++y) {
            for (int x = s.box.x; x <= s.box.z; ++x) {
                splat(ivec2(x, y), s);
            }
        }
    }
    // The largest ones at the end are shared by all invocations.
    for (uint i = FOAM_GROUP; i > 0u && texels[order[i - 1u]] > SMALL; --i) {
        Splat s = splat_of(first + order[i - 1u]);
        ivec2 lane = ivec2(local & 7u, local >> 3);
        for (int y = s.box.y + lane.y; y <= s.box.w; y += 8) {
            for (int x = s.box.x + lane.x; x <= s.box.z; x += 8) {
                splat(ivec2(x, y), s);
            }
        }
    }
}
