#version 460
// Pass `thickness`, raster path with two sheets: additive, tested against the scene by the centre's depth.
// Reads: scene depth, boundaries. Writes: thickness (R32F, metres along z), sheets
// (RGBA32F: front, back, window).

#include "frame.glsl"
#include "kernel.glsl"
#include "sheets.glsl"

layout(set = 0, binding = 2) uniform sampler2D scene_depth;

layout(location = 0) flat in vec4 disc;
layout(location = 1) flat in float amplitude;
layout(location = 0) out float thickness;
layout(location = 1) out vec4 sheets;

void main() {
    vec2 slope = ray_slope(gl_FragCoord.xy, frame.thick_slope);
    float rho2 = thickness_rho2(slope, disc.xyz, disc.w);
    vec2 pixel = gl_FragCoord.xy * frame.thick_extent.z;
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    if (rho2 > 1.0 || (scene > 0.0 && -disc.z >= scene)) {
        discard;
    }
    thickness = amplitude * thickness_kernel(rho2);
    sheets = vec4(sheet_shares(-disc.z, boundary_of(ivec2(gl_FragCoord.xy))) * thickness, 0.0);
}
