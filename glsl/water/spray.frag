#version 460
// Pass `spray`: optical depth of droplets in front of scene and water (thesis Sec. 4.9.5 adds a colour instead).
// Reads: scene depth, water depth. Writes: spray (RG32F, or RG16F where that is not blended), summed.

#include "frame.glsl"
#include "random.glsl"
#include "whole_steps.glsl"
#include "kernel.glsl"
#include "sprite_hit.glsl"

layout(location = 4) flat in vec2 amount;
layout(location = 5) flat in int aside;
layout(location = 6) flat in uint chance;

// 1: sums in single precision, 0: in half precision.
layout(constant_id = 34) const uint SINGLE = 1;
// Fixed-point steps per optical depth of 1: sums are exact in any order up to 64, with half floats up to 4.
const float STEPS = SINGLE == 1u ? 262144.0 : 512.0;

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D water_depth;

layout(location = 0) out vec2 optical_depth; // optical depth: all, and the sunlit part

void main() {
    vec2 place;
    float depth;
    if (!sprite_hit(ray_slope(gl_FragCoord.xy, frame.slope), place, depth)) {
        discard;
    }
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(gl_FragCoord.xy), 0).x);
    // Only a body of water hides spray; a drop is transparent. So the farthest of five depths, a drop apart, is
    // used.
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
    // Droplets surround particles that may also be water, so those just behind the surface are visible.
    float before = 1.0 - smoothstep(0.0, 1.5 * frame.particle.y, depth - water);
    // The kernel of the thickness, because the thesis' exp(-2 rho^2) alone ends with an edge.
    float added = before * amount.x * thickness_kernel(dot(place, place));
    optical_depth = floor(added * vec2(1.0, amount.y) * STEPS + rounding_up(chance, pixel)) / STEPS;
}
