#version 460
// Pass `depth`, raster path: intersects the pixel's ray with the sphere or ellipsoid (thesis Sec. 4.6.1; Listing A.9
// offsets the billboard instead). MIN blending keeps the nearest hit.
// Reads: the sphere of depth.vert. Writes: depth (R32F).

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"

layout(location = 0) flat in vec4 sphere;
layout(location = 1) flat in vec3 diagonal;
layout(location = 2) flat in vec3 off;
layout(location = 0) out float depth;

void main() {
    vec3 ray = vec3(ray_slope(gl_FragCoord.xy, frame.slope), -1.0);
    if (ELLIPSOIDS == 1u) {
        ray = diagonal * ray + off.zzy * ray.yxx + off.yxx * ray.zzy;
    }
    depth = ray_hit(ray, sphere.xyz, sphere.w, frame.depth.z);
    if (depth >= EMPTY) {
        discard;
    }
}
