#version 460
// Pass `splat`: the frontmost of the diffuse particles and their thickness (Akinci et al. 2013, Sec. 2.1 and 2.2;
// passes 3 and 4), an invocation a particle. Depth, unlike in water, is not smoothed: that would take from the
// occlusion. The second time over what goes with the frontmost: its search radius and normal.
// Reads: positions, kinds, radii, ages, ids, words, arguments, packets, list. Writes: words, list.

#include "frame.glsl"
#include "frustum.glsl"
#include "falloff.glsl"
#include "diffuse.glsl"
#include "hand_over.glsl"
#include "diffuse_words.glsl"

layout(local_size_x = 64) in;
// 0: depth and thickness. 1: what goes with the depth.
layout(constant_id = 0) const uint FRONTMOST = 0;

#include "diffuse_push.glsl"
#include "diffuse_streams.glsl"

layout(set = 0, binding = 6, std430) buffer Words { uint words[]; };
layout(set = 0, binding = 7, std430) readonly buffer Arguments { uvec4 arguments[]; };
// The same memory, four words at a time.
layout(set = 0, binding = 12, std430) readonly buffer Heads { uvec4 heads[]; };

#include "diffuse_splat.glsl"

void splat(ivec2 pixel, Sprite s) {
    Diffuse p = s.p;
    Footprint f = s.f;
    vec2 place;
    float rr = diffuse_place(f, pixel, place);
    if (!(rr < 1.0)) {
        return;
    }
    float w = sqrt(1.0 - rr);
    float depth = -p.centre.z - w * p.radius;
    uint bits = floatBitsToUint(depth);
    uint at = words_of(pixel);
    uvec4 head = heads[at / 4u];
    uint front = head[FRONT];
    if (FRONTMOST == 1u) {
        if (bits == front && front < head[SCENE]) {
            atomicMin(words[at + WITH], with_of(s.search, place, w));
        }
        return;
    }
    if (!(bits < head[SCENE])) {
        return;
    }
    // Most lose: a read is cheaper than an atomic.
    if (bits < front) {
        atomicMin(words[at + FRONT], bits);
    }
    thicken(at, p, f, rr, depth, uintBitsToFloat(head[FLUID]));
}

#include "diffuse_cover.glsl"

void main() {
    cover();
}
