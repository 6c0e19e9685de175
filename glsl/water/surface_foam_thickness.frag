#version 460
// Pass `surface_foam`, raster path: four thicknesses in scene units: of all foam; of the front layer, which is the
// foam right behind the frontmost (thesis Sec. 4.8.2, Listing A.16); of the layer's sunlit part; and of all foam
// with weights from 0 to 1 that grow with the distance behind the frontmost. A noise breaks up the discs: a pattern
// that all sprites share, or a noise of each sprite that changes with its age.
// Reads: scene depth, foam depth. Writes: foam thickness (RGBA32F).

#include "frame.glsl"
#include "random.glsl"
#include "whole_steps.glsl"
#include "gradient_noise.glsl"
#include "surface_foam.glsl"
#include "pattern.glsl"
#include "kernel.glsl"
#include "surface_foam_sprite.glsl"
#include "sprite_hit.glsl"

layout(location = 4) flat in float amount;
layout(location = 5) flat in FoamNoise noise;

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D foam_depth;

layout(location = 0) out vec4 thickness;

void main() {
    vec2 place;
    float depth;
    if (!sprite_hit(ray_slope(gl_FragCoord.xy, frame.thick_slope), place, depth)) {
        discard;
    }
    vec2 pixel = gl_FragCoord.xy * frame.thick_extent.z;
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    if (scene > 0.0 && depth >= scene) {
        discard;
    }
    float front = texelFetch(foam_depth, ivec2(gl_FragCoord.xy), 0).x;
    float before = scene > 0.0 ? scene - depth : EMPTY;
    thickness = foam_steps(ivec2(gl_FragCoord.xy), amount, noise, place, depth, front, before) * frame.foam_back.w;
}
