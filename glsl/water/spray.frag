#version 460
// Pass `spray`: sums the optical depth of droplets in front of scene and water (thesis Sec. 4.9.5 adds a colour).
// Reads: scene depth, water depth. Writes: spray (RG32F, or RG16F if the device cannot blend that), summed.

#include "frame.glsl"
#include "random.glsl"
#include "whole_steps.glsl"
#include "kernel.glsl"
#include "sprite_hit.glsl"
#include "gradient_noise.glsl"
#include "pattern.glsl"
#include "clumps.glsl"

layout(location = 4) flat in vec4 amount;
layout(location = 5) flat in int aside;
layout(location = 6) flat in uint chance;
layout(location = 7) flat in vec3 drift;
layout(location = 8) flat in vec4 source;

// 1: sums in single precision, 0: in half precision.
layout(constant_id = 34) const uint SINGLE = 1;
// Fixed-point steps per optical depth of 1. Sums up to 64 are exact in any order, with half floats sums up to 4.
// Larger sums, as of glints, depend on the order by rounding errors.
const float STEPS = SINGLE == 1u ? 262144.0 : 512.0;

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D water_depth;

layout(location = 0) out vec2 optical_depth; // x: optical depth; y: the same weighted by sunlight, which is above 1 for glints

void main() {
    vec2 place;
    float depth;
    vec2 slope = ray_slope(gl_FragCoord.xy, frame.slope);
    if (!sprite_hit(slope, place, depth)) {
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
    float added = before * amount.x * thickness_kernel(dot(place, place));
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    for (bool go = source.w > 0.0 && added > 0.0; go; go = false) {
        vec3 hit = (frame.world * vec4(depth * vec3(slope, -1.0), 1.0)).xyz;
        float pixel = depth * max(abs(frame.slope.x), abs(frame.slope.y));
        added *= clumps_at(hit, source.xyz, drift, pixel, CLUMP_OCTAVES);
    }
    // A drop mirrors the sun in one small spot: a whole glinting droplet would be a white block.
    float sun = amount.y * (1.0 + amount.z * thickness_kernel(min(dot(place, place) * amount.w, 1.0)));
    optical_depth = floor(added * vec2(1.0, sun) * STEPS + rounding_up(chance, pixel)) / STEPS;
}
