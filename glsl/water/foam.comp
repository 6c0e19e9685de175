#version 460
// Pass `foam`, compute path: the frontmost foam (thesis Sec. 4.6.2), then the metres of all foam and of the
// layer right behind the frontmost (Sec. 4.8), in whole steps. An invocation a sprite, or all of a group the
// large ones. A noise of its own in each sprite, that changes as it ages, breaks up the discs.
// Reads: Counts, sprites, words. Writes: words.

#include "frame.glsl"
#include "sphere.glsl"
#include "counts.glsl"
#include "random.glsl"
#include "gradient_noise.glsl"
#include "foam.glsl"
#include "kernel.glsl"
#include "foam_sprite.glsl"
#include "foam_sums.glsl"
#include "plane.glsl"

layout(local_size_x = FOAM_GROUP) in;
// 0: depth. 1: thickness.
layout(constant_id = 0) const uint THICK = 0;

layout(set = 0, binding = 1, std430) readonly buffer Sprites { FoamSprite sprites[]; };
layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 5, std430) buffer Words { uint words[]; };

// Texels of a box that an invocation does by itself.
const int SMALL = 256;

shared uint large_count;
shared uint large[FOAM_GROUP];

struct Splat {
    FoamPlane plane;
    vec3 along;  // over its half-axis
    vec3 across;
    vec4 look;
    vec2 torn;   // strength of the noise; share of the sun's light
    ivec4 box;   // texels that may see it
};

// Bounds of the ellipse in slopes along an axis, from the planes through the eye that touch it; of all there
// is where it reaches the eye's plane. From where its centre is seen: exact for small ones.
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
        s.look = foam_look(sprite, s.plane);
        s.torn = vec2(s.plane.torn, sprite.rest.y);
    }
    vec3 a = s.plane.e1 * s.plane.axes.x;
    vec3 b = s.plane.e2 * s.plane.axes.y;
    vec2 x = touching(s.plane.centre.xz, a.xz, b.xz);
    vec2 y = touching(s.plane.centre.yz, a.yz, b.yz);
    vec4 texels = pixel_bounds(vec4(x.x, y.x, x.y, y.y), frame.thick_slope);
    s.box = pixel_span(texels + vec4(-0.125, -0.125, 0.125, 0.125), frame.thick_extent.xy);
    return s;
}

// Full ones stay so: no number of sprites on one spot is too many.
void add(uint at, uint steps) {
    if (steps > 0u && words[at] < FULL) {
        atomicAdd(words[at], steps);
    }
}

void splat(ivec2 texel, Splat s) {
    vec2 slope = ray_slope(vec2(texel) + 0.5, frame.thick_slope);
    vec2 place;
    float depth;
    if (!plane_hit(s.plane.centre, s.along, s.across, s.plane.normal, slope, place, depth)) {
        return;
    }
    uint at = words_of(texel);
    // Metres to the scene; what hides a sprite has none.
    float before = uintBitsToFloat(words[at + SCENE]) - depth;
    if (!(before > 0.0)) {
        return;
    }
    uint front = words[at + FRONT];
    if (THICK == 0u) {
        // Most lose: a read is cheaper than an atomic.
        if (floatBitsToUint(depth) < front) {
            atomicMin(words[at + FRONT], floatBitsToUint(depth));
        }
        return;
    }
    uvec3 steps = uvec3(foam_steps(s.look, s.torn, place, depth, uintBitsToFloat(front), before));
    add(at + ALL, steps.x);
    add(at + LATE, steps.x - min(steps.x, steps.y));
    if (LIT == 1u) {
        add(at + UNLIT, steps.y - min(steps.y, steps.z));
    }
}

void visit(uint index) {
    Splat s = splat_of(index);
    ivec2 size = max(s.box.zw - s.box.xy + 1, ivec2(0));
    if (size.x * size.y > SMALL) {
        large[atomicAdd(large_count, 1u)] = index;
        return;
    }
    for (int y = s.box.y; y <= s.box.w; ++y) {
        for (int x = s.box.x; x <= s.box.z; ++x) {
            splat(ivec2(x, y), s);
        }
    }
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    uint local = gl_LocalInvocationIndex;
    if (local == 0u) {
        large_count = 0u;
    }
    barrier();
    if (index < counts.foam) {
        visit(index);
    }
    barrier();
    uint wide = large_count;
    for (uint i = 0u; i < wide; ++i) {
        Splat s = splat_of(large[i]);
        ivec2 lane = ivec2(local & 7u, local >> 3);
        for (int y = s.box.y + lane.y; y <= s.box.w; y += 8) {
            for (int x = s.box.x + lane.x; x <= s.box.z; x += 8) {
                splat(ivec2(x, y), s);
            }
        }
    }
}
