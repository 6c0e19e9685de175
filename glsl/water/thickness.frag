#version 460
// Pass `thickness`, raster path: adds each sprite's thickness of water by blending, except where the sprite's
// centre is behind the scene (thesis Sec. 4.8.1, Listing A.15; kernel.glsl).
// Reads: scene depth, foam depth. Writes: thickness (scene units along z; R32F, or RG32F with foam).

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "kernel.glsl"
#include "surface_foam_share.glsl"
#include "surface_foam_front.glsl"

layout(set = 0, binding = 2) uniform sampler2D scene_depth;

layout(location = 0) flat in vec4 disc;
layout(location = 1) flat in float amplitude;
layout(location = 2) flat in vec3 conic;
// All water, and the water before the frontmost foam.
layout(location = 0) out vec2 thickness;

void main() {
    vec2 slope = ray_slope(gl_FragCoord.xy, frame.thick_slope);
    float rho2 = ELLIPSOIDS == 1u ? disc_rho2(slope, disc.xyz, conic) : thickness_rho2(slope, disc.xyz, disc.w);
    vec2 pixel = gl_FragCoord.xy * frame.thick_extent.z;
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    if (rho2 > 1.0 || (scene > 0.0 && -disc.z >= scene)) {
        discard;
    }
    float amount = amplitude * thickness_kernel(rho2);
    thickness = vec2(amount, FOAM == 1u ? amount * share_before(-disc.z, foam_at(ivec2(gl_FragCoord.xy))) : 0.0);
}
