#version 460
// Pass `surface_foam`, raster path: depth of the frontmost foam (thesis Sec. 4.6.2, Listing A.10). MIN blending keeps
// the nearest.
// Reads: scene depth. Writes: foam depth (R32F).

#include "frame.glsl"
#include "sprite_hit.glsl"

layout(set = 0, binding = 2) uniform sampler2D scene_depth;

layout(location = 0) out float depth;

void main() {
    vec2 place;
    if (!sprite_hit(ray_slope(gl_FragCoord.xy, frame.thick_slope), place, depth)) {
        discard;
    }
    vec2 pixel = gl_FragCoord.xy * frame.thick_extent.z;
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    if (scene > 0.0 && depth >= scene) {
        discard;
    }
}
