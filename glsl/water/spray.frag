#version 460
// Pass `spray`: sums the optical depth of droplets in front of scene and water (thesis Sec. 4.9.5 adds a colour).
// Reads: scene depth, water depth. Writes: spray (RG32F, or RG16F if the device cannot blend that), summed.

#include "frame.glsl"
#include "random.glsl"
#include "whole_steps.glsl"
#include "kernel.glsl"
#include "sprite_hit.glsl"

layout(location = 4) flat in vec2 amount;
layout(location = 5) flat in int aside;
layout(location = 6) flat in uint chance;
layout(location = 7) flat in vec3 grain;
layout(location = 8) flat in vec2 turn;

// 1: sums in single precision, 0: in half precision.
layout(constant_id = 34) const uint SINGLE = 1;
// Fixed-point steps per optical depth of 1. Sums up to 64 are exact in any order, with half floats sums up to 4.
const float STEPS = SINGLE == 1u ? 262144.0 : 512.0;

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D water_depth;

layout(location = 0) out vec2 optical_depth; // optical depth: all, and the sunlit part

// log(mean(exp(a n))) / a^2 for value noise n with the amplitude a. For a up to 2 it is this constant within 0.3 %;
// it keeps the mean of the mist's density.
const float RAISED = 0.0895;

// Random value of a lattice point, -1 to 1. `joined` has the point's coordinates multiplied by primes of xxHash, as in
// gradient_noise.glsl.
float lattice_value(uvec2 joined, uint salt) {
    uint h = joined.x ^ joined.y ^ salt;
    h = (h ^ (h >> 15)) * 0x27D4EB2Fu;
    return float((h ^ (h >> 13)) >> 8) * (2.0 / 16777216.0) - 1.0;
}

// Value noise, -1 to 1.
float value_noise(vec2 p, uint salt) {
    vec2 cell = floor(p);
    vec2 f = p - cell;
    f *= f * (3.0 - 2.0 * f);
    const uvec2 PRIMES = uvec2(0x9E3779B1u, 0x85EBCA77u);
    uvec2 near = uvec2(ivec2(cell)) * PRIMES;
    uvec2 far = near + PRIMES;
    float low = mix(lattice_value(near, salt), lattice_value(uvec2(far.x, near.y), salt), f.x);
    float high = mix(lattice_value(uvec2(near.x, far.y), salt), lattice_value(far, salt), f.x);
    return mix(low, high, f.y);
}

// Octave k of the noise, from 0, has the relative amplitude min(FINER (k + 1), 1). Coarse octaves are weak, because
// strong clumps of a particle's size would show the particles.
const float FINER = 0.25;

// Density of mist, divided by its mean. Drops come in clumps of all sizes, so the logarithm of the density is a sum
// of octaves of noise.
float clumps(vec2 place) {
    vec2 cells = place * grain.xy;
    vec2 at = vec2(cells.x * turn.x - cells.y * turn.y, cells.x * turn.y + cells.y * turn.x);
    at += vec2(chance & 0xFFFFu, chance >> 16) / 65536.0;
    float sum = 0.0;
    for (uint k = 0u; float(k) < grain.z; ++k) {
        float amplitude = frame.spray_mist.x * min(FINER * float(k + 1u), 1.0) * min(grain.z - float(k), 1.0);
        sum += amplitude * (value_noise(at, chance + k * 0xC2B2AE3Du) - RAISED * amplitude);
        at *= 2.0;
    }
    return exp(sum);
}

void main() {
    vec2 place;
    float depth;
    if (!sprite_hit(ray_slope(gl_FragCoord.xy, frame.slope), place, depth)) {
        discard;
    }
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(gl_FragCoord.xy), 0).x);
    // Only a body of water hides spray; a single drop does not. So the farthest of five water depths is used: at this
    // pixel and at the four pixels that are `aside` pixels away on both axes, farther than a drop reaches.
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float water = texelFetch(water_depth, pixel, 0).x;
    for (int i = 0; i < 4; ++i) {
        ivec2 there = pixel + aside * (2 * ivec2(i & 1, i >> 1) - 1);
        there = clamp(there, ivec2(0), ivec2(frame.extent.xy) - 1);
        water = max(water, texelFetch(water_depth, there, 0).x);
    }
    if (scene > 0.0 && depth >= scene) {
        discard;
    }
    // Droplets surround particles that may also be drawn as water, which would hide half of them. So droplets behind
    // the water's surface fade with their distance from it, and vanish at 1.5 particle spacings.
    float before = 1.0 - smoothstep(0.0, 1.5 * frame.particle.y, depth - water);
    // The falloff is that of the thickness, sqrt(1 - rho^2) exp(-2 rho^2), which is 0 at the sprite's edge, where rho
    // is 1. The thesis' exp(-2 rho^2) is still 0.14 there, which would show the edge.
    float added = before * amount.x * clumps(place) * thickness_kernel(dot(place, place));
    optical_depth = floor(added * vec2(1.0, amount.y) * STEPS + rounding_up(chance, pixel)) / STEPS;
}
