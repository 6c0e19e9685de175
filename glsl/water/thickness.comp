#version 460
// Pass `thickness`, compute path: sums the thickness of water of each texel in fixed point, so that the order of the
// particles does not matter (thesis Sec. 4.8.1 blends; kernel.glsl). An addend is at most 2^26 for a sphere (one with
// half the radius), so 64 of them overflow a word; for an ellipsoid seen along its longest half-axis it is up to 64
// times as large. Carries are counted in a second word, so any number of particles may lie on one spot. A second
// dispatch handles texels with two layers of water: it sums the front layer and the window, the water close to the
// boundary between the layers. Only the few spheres that are not well behind every nearby boundary take part.
// Reads: Counts, visible, shares, scene depth (with foam: depths of scene and frontmost foam, from the foam's words),
// boundaries, blocks. Writes: sums (UNITS of the amplitude).

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "counts.glsl"
#include "kernel.glsl"
#include "sheets.glsl"
#include "surface_foam_share.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint LARGE = 0;
// 0: all water. 1: front sheet and window.
layout(constant_id = 1) const uint APART = 0;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Visible { vec4 visible[]; };
layout(set = 0, binding = 3) uniform sampler2D scene_depth;
// Each sum is two words: the low word and the number of carries. First the sums of all water; then, if there may be
// foam, those of the water before the frontmost foam; then those of the front layers; then those of the windows.
layout(set = 0, binding = 4, std430) buffer Sums { uint sums[]; };
// The farthest boundary of each block.
layout(set = 0, binding = 5, std430) readonly buffer Blocks { float blocks[]; };

layout(set = 0, binding = 6, std430) readonly buffer Shares { float shares[]; };

// With foam: for each texel FOAM_WORDS words of the compute path of `surface_foam`. The first is the depth of the
// frontmost foam (that of the scene if no foam lies before it), the second that of the scene, both as the bits of a
// float. Reading them is faster than reading two images.
layout(constant_id = 10) const uint FOAM_WORDS = 5;
layout(set = 0, binding = 8, std430) readonly buffer FoamWords { uint foam_words[]; };

layout(push_constant, std430) uniform Push { uint capacity; } push;

// The sprite of a particle.
struct Sprite {
    vec3 centre;
    vec3 conic;  // of ellipsoids: the quadratic form of rho^2
    vec2 reach;  // half of its bounding box, in the plane of the centre
    float inverse_axis; // of spheres
    float scale; // units per amplitude of 1
};

// Returns the fixed-point units per amplitude of 1 for a sphere of this radius. A particle with a smaller radius has
// a smaller sprite that holds the same volume.
float units(float radius) {
    float grown = frame.particle.x / radius;
    return UNITS * grown * grown;
}

// Returns the sprite of particle `index`, in the size that it has without foam. The thickness that it adds is scaled
// by the fraction of the particle that is water.
Sprite sprite_of(uint index) {
    Ellipsoid body = ellipsoid_in(visible, index);
    float water = FOAM == 1u ? shares[index] : 1.0;
    body.sphere.w = FOAM == 1u ? body.sphere.w / water : body.sphere.w;
    float times = frame.particle.z / frame.particle.x;
    Sprite sprite = Sprite(body.sphere.xyz, vec3(0.0), vec2(0.0), 0.0, 0.0);
    if (ELLIPSOIDS == 1u) {
        Disc disc = ellipsoid_disc(body, times, frame.thick_slope);
        sprite.conic = disc.conic;
        sprite.reach = disc.reach;
        sprite.scale = water * UNITS * frame.particle.z * frame.particle.z / disc.area;
        return sprite;
    }
    float widened;
    float axis = drawn_axis(times * body.sphere.w, -body.sphere.z, frame.thick_slope, widened);
    sprite.reach = vec2(axis);
    sprite.inverse_axis = 1.0 / axis;
    sprite.scale = water * units(body.sphere.w) / widened;
    return sprite;
}

// Returns the texels that the sprite's disc covers (first x and y, last x and y). The bounds are exact, because the
// disc is parallel to the image plane.
ivec4 span(Sprite sprite) {
    float inverse = 1.0 / -sprite.centre.z;
    vec4 slopes = vec4(sprite.centre.xy - sprite.reach, sprite.centre.xy + sprite.reach) * inverse;
    return pixel_span(pixel_bounds(slopes, frame.thick_slope), frame.thick_extent.xy);
}

// Adds `amount` to sum `at` and `more` to sum `other`, both rounded to whole units: to the low word of a sum and, if
// that overflows, 1 to its number of carries. All additions are in one loop: a CPU driver runs the invocations one by
// one at each atomic operation in the code, even those that add nothing.
void add(uint at, float amount, uint other, float more) {
    uint word = 2u * at;
    uint units = uint(amount + 0.5);
    uint next = 2u * other;
    uint after = uint(more + 0.5);
    do {
        // The low word overflows if the old value is more than this.
        bool carries = atomicAdd(sums[word], units) > ~units;
        word = carries ? word + 1u : next;
        units = carries ? 1u : after;
        after = carries ? after : 0u;
    } while (units > 0u);
}

void splat(ivec2 texel, Sprite sprite) {
    vec2 slope = ray_slope(vec2(texel) + 0.5, frame.thick_slope);
    float rho2 = ELLIPSOIDS == 1u ? disc_rho2(slope, sprite.centre, sprite.conic)
                                  : thickness_rho2(slope, sprite.centre, sprite.inverse_axis);
    if (rho2 > 1.0) {
        return;
    }
    uint at = uint(texel.y) * uint(frame.thick_extent.x) + uint(texel.x);
    float scene;
    float foam = EMPTY;
    if (FOAM == 1u) {
        scene = uintBitsToFloat(foam_words[FOAM_WORDS * at + 1u]);
        if (APART == 0u) {
            float front = uintBitsToFloat(foam_words[FOAM_WORDS * at]);
            foam = front < scene ? front : EMPTY;
        }
    } else {
        scene = eye_depth(texelFetch(scene_depth, scene_texel((vec2(texel) + 0.5) * frame.thick_extent.z), 0).x);
    }
    if (scene > 0.0 && -sprite.centre.z >= scene) {
        return;
    }
    float amount = thickness_kernel(rho2) * sprite.scale;
    uint texels = uint(frame.thick_extent.x) * uint(frame.thick_extent.y);
    if (APART == 0u) {
        add(at, amount, at + texels, foam < EMPTY ? amount * share_before(-sprite.centre.z, foam) : 0.0);
        return;
    }
    float boundary = boundaries[at];
    if (boundary < EMPTY) {
        vec3 parts = sheet_shares(-sprite.centre.z, boundary);
        add(at + (1u + FOAM) * texels, amount * parts.x, at + (2u + FOAM) * texels, amount * parts.z);
    }
}

// Narrows the sprite's box of texels to those blocks of 16x16 pixels with a boundary between two layers of water that
// the sprite's centre lies before or at most a window's reach behind (front layer or window).
ivec4 before_boundary(Sprite sprite, ivec4 box) {
    int columns = (int(frame.extent.x) + BLOCK - 1) / BLOCK;
    int bits = BLOCK_BITS - findMSB(int(frame.thick_extent.z)); // of a block's texels
    ivec4 touched = box >> bits;
    ivec4 part = ivec4(touched.zw + 1, touched.xy - 1);
    // Two nested loops: a single `do`-`while` loop that runs only once would lose `part` with lavapipe 22.3.
    for (int y = touched.y; y <= touched.w; ++y) {
        for (int x = touched.x; x <= touched.z; ++x) {
            if (-sprite.centre.z < blocks[y * columns + x] + WINDOW.y * frame.particle.y) {
                part = ivec4(min(part.xy, ivec2(x, y)), max(part.zw, ivec2(x, y)));
            }
        }
    }
    ivec4 texels = (ivec4(part.xy, part.zw + 1) << bits) - ivec4(0, 0, 1, 1);
    return ivec4(max(box.xy, texels.xy), min(box.zw, texels.zw));
}

void main() {
    if (LARGE == 0u) {
        uint index = gl_GlobalInvocationID.x;
        if (index >= counts.small) {
            return;
        }
        Sprite sprite = sprite_of(index);
        // A particle whose centre is nearer than the near plane has no sprite.
        if (-sprite.centre.z <= frame.depth.z) {
            return;
        }
        ivec4 box = span(sprite);
        if (box.x > box.z || box.y > box.w) {
            return;
        }
        if (APART == 1u) {
            box = before_boundary(sprite, box);
            if (box.x > box.z || box.y > box.w) {
                return;
            }
        }
        // One `do`-`while` loop instead of two nested loops. SIMD lanes wait for the lane with the most pixels: once
        // for the whole loop here, but once per row in nested loops. No lane runs an empty iteration.
        ivec2 p = box.xy;
        do {
            splat(p, sprite);
            p = p.x < box.z ? ivec2(p.x + 1, p.y) : ivec2(box.x, p.y + 1);
        } while (p.y <= box.w);
        return;
    }
    for (uint i = gl_WorkGroupID.x; i < counts.large; i += gl_NumWorkGroups.x) {
        Sprite sprite = sprite_of(push.capacity - 1u - i);
        if (-sprite.centre.z <= frame.depth.z) {
            continue;
        }
        ivec4 box = span(sprite);
        ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
        for (int y = box.y + lane.y; y <= box.w; y += 8) {
            for (int x = box.x + lane.x; x <= box.z; x += 8) {
                splat(ivec2(x, y), sprite);
            }
        }
    }
}
