#version 460
// Pass `splat`: depth of the frontmost whitewater particle and thickness of all (Akinci et al. 2013, Sec. 2.1 and
// 2.2; passes 3 and 4), one invocation per particle, a workgroup per large one. Unlike the water's depth, this depth is
// not smoothed, because smoothing would weaken the occlusion. The second dispatch writes the attributes of the
// frontmost particle: normal, and the radius in which occlusion is searched.
// Reads: positions, kinds, radii, ages, ids, crossfade, words, arguments, packets, list. Writes: words, list.

#include "frame.glsl"
#include "frustum.glsl"
#include "falloff.glsl"
#include "whitewater.glsl"
#include "crossfade.glsl"
#include "whitewater_words.glsl"

layout(local_size_x = 64) in;
// 0: depth and thickness. 1: the attributes of the frontmost particle.
layout(constant_id = 0) const uint FRONTMOST = 0;

#include "whitewater_push.glsl"
#include "whitewater_streams.glsl"

// Words of the pixels: two uvec4 entries per pixel. Reads of entries and atomics on single words use one declaration,
// because a driver may assume that two declarations are different memory.
layout(set = 0, binding = 6, std430) buffer Words { uvec4 words[]; };
layout(set = 0, binding = 7, std430) readonly buffer Arguments { uvec4 arguments[]; };

#define WORD(at) words[(at) / 4u][(at) % 4u]
#include "whitewater_splat.glsl"

void splat(ivec2 pixel, Sprite s) {
    Whitewater p = s.p;
    Footprint f = s.f;
    vec2 place;
    float rr = whitewater_place(f, pixel, place);
    if (!(rr < 1.0)) {
        return;
    }
    float w = sqrt(1.0 - rr);
    float depth = -p.centre.z - w * p.radius;
    uint bits = floatBitsToUint(depth);
    uint at = words_of(pixel);
    // The depth read here may be outdated, that is, too large. The atomic minimum compares with the current one.
    uvec4 head = words[at / 4u];
    uint front = head[FRONT];
    if (FRONTMOST == 1u) {
        if (bits == front && front < head[SCENE]) {
            atomicMin(WORD(at + WITH), with_of(s.search, place, w));
        }
        return;
    }
    if (!(bits < head[SCENE])) {
        return;
    }
    // Most particles lose the comparison: a read is cheaper than an atomic.
    if (bits < front) {
        atomicMin(WORD(at + FRONT), bits);
    }
    thicken(at, p, f, rr, depth, uintBitsToFloat(head[FLUID]));
}

#include "whitewater_cover.glsl"

void main() {
    cover();
}
