#version 460
// Pass `depth`, raster path: the hit of the pixel's ray (thesis Sec. 4.6.1; Listing A.9 offsets the
// billboard instead). MIN blending keeps the nearest.
// Reads: depth.vert's sphere. Writes: depth (R32F).

#include "frame.glsl"
#include "sphere.glsl"

layout(location = 0) flat in vec4 sphere;
layout(location = 0) out float depth;

void main() {
    vec2 slope = ray_slope(gl_FragCoord.xy, frame.slope);
    depth = sphere_hit(slope, sphere.xyz, sphere.w, frame.depth.z);
    if (depth >= EMPTY) {
        discard;
    }
}
