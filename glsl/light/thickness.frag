#version 460
// Pass `light`: sums along the sunlight the thicknesses of water and of foam in scene units (x, y), and the same with
// each particle's thickness multiplied by its depth along the light (z, w); z / x and w / y are mean depths. The
// thesis has this thickness for the camera (Sec. 3.2.2, kernel.glsl), but not for the sun.
// Reads: the discs of thickness.vert. Writes: thickness (RGBA32F), summed.

#include "frame.glsl"
#include "kernel.glsl"
#include "random.glsl"
#include "whole_steps.glsl"

layout(location = 0) flat in vec2 centre;
layout(location = 1) flat in float depth;
layout(location = 2) flat in float axis;
layout(location = 3) flat in vec2 amount;
layout(location = 4) flat in uint chance;

layout(location = 0) out vec4 thickness;

void main() {
    vec2 place = (gl_FragCoord.xy - centre) * (frame.light_map.y / axis);
    float rho2 = dot(place, place);
    if (rho2 > 1.0) {
        discard;
    }
    // Thicknesses are whole steps, so that their sums are exact in any order.
    float step = frame.foam_back.w;
    float up = rounding_up(chance, ivec2(gl_FragCoord.xy));
    vec2 height = floor(amount * (thickness_kernel(rho2) / step) + up) * step;
    // Depths are rounded to multiples of 512 thickness steps, which is a quarter of s, where s is the particle
    // spacing rounded down to a power of two. So products of thickness and depth, and their sums, are exact too, up to
    // 2048 s^2: for example 20 s of water at a depth of 100 s.
    thickness = vec4(height, height * (floor(depth / (512.0 * step) + 0.5) * (512.0 * step)));
}
