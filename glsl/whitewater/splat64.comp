#version 460
// Pass `splat` in one dispatch, with 64-bit atomics (Akinci et al. 2013, Sec. 2.1 and 2.2; passes 3 and 4). The upper
// half of a word is the depth of a particle, the lower half its attributes, so one minimum finds both for the
// frontmost. The result is that of the two dispatches of splat.comp.
// Reads: positions, kinds, radii, ages, ids, crossfade, words, arguments, packets, list. Writes: words, list.

#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require

#include "frame.glsl"
#include "frustum.glsl"
#include "falloff.glsl"
#include "whitewater.glsl"
#include "crossfade.glsl"
#include "whitewater_words.glsl"

layout(local_size_x = 64) in;

#include "whitewater_push.glsl"
#include "whitewater_streams.glsl"

// A pixel's words of whitewater_words.glsl as a struct. Plain reads and atomics use this one declaration of the
// buffer, because a driver may assume that two declarations are different memory.
struct Pixel {
    uint64_t front; // depth of the frontmost in the high word, its attributes in the low word
    uint scene;
    uint fluid;
    uvec4 sums;
};
layout(set = 0, binding = 6, std430) buffer Words { Pixel pixels[]; };
layout(set = 0, binding = 7, std430) readonly buffer Arguments { uvec4 arguments[]; };

#define WORD(at) pixels[(at) / WORDS].sums[(at) % 4u]
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
    uint own = at / WORDS;
    if (!(bits < pixels[own].scene)) {
        return;
    }
    // Most particles lie behind the stored depth, and a read is cheaper than an atomic. The depth read here may be
    // outdated, that is, too large. The atomic compares with the current one.
    if (bits <= uint(pixels[own].front >> 32)) {
        atomicMin(pixels[own].front, uint64_t(bits) << 32 | with_of(s.search, place, w));
    }
    thicken(at, p, f, rr, depth, uintBitsToFloat(pixels[own].fluid));
}

#include "whitewater_cover.glsl"

void main() {
    cover();
}
