#version 460
// Pass `depth`, raster path: one sprite per sphere or ellipsoid, a point if it fits, otherwise a quad (thesis Sec. 4.5,
// 4.6.1, Listing A.8: only points). The footprint is conservative; only the intersection test decides coverage.
// Reads: visible. Writes: the sprite's corners.

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"

// 0: points, from the front of the list. 1: quads, from its back.
layout(constant_id = 0) const uint QUADS = 0;

layout(set = 0, binding = 1, std430) readonly buffer Visible { vec4 visible[]; };
layout(push_constant, std430) uniform Push { uint capacity; } push;

layout(location = 0) flat out vec4 sphere;
// For ellipsoids, the matrix that maps the ray to the space of the sphere: xx, yy, zz; yz, xz, xy.
layout(location = 1) flat out vec3 diagonal;
layout(location = 2) flat out vec3 off;

void main() {
    uint index = QUADS == 0u ? uint(gl_VertexIndex) : push.capacity - 1u - uint(gl_InstanceIndex);
    Ellipsoid body = ellipsoid_in(visible, index);
    sphere = vec4(body.centre, body.sphere.w);
    diagonal = vec3(body.inverse[0].x, body.inverse[1].y, body.inverse[2].z);
    off = vec3(body.inverse[2].y, body.inverse[2].x, body.inverse[1].x);
    vec4 slopes;
    ellipsoid_bounds(body, slopes);
    vec4 pixels = pixel_bounds(slopes, frame.slope);
    // Sub-pixel snapping (1/16 at worst) must not cut the footprint.
    pixels += vec4(-0.125, -0.125, 0.125, 0.125);
    pixels = clamp(pixels, vec4(-1.0), frame.extent.xyxy + 1.0);
    vec2 at = 0.5 * (pixels.xy + pixels.zw);
    gl_PointSize = max(pixels.z - pixels.x, pixels.w - pixels.y);
    if (QUADS == 1u) {
        at = vec2((gl_VertexIndex & 1) == 0 ? pixels.x : pixels.z,
                  (gl_VertexIndex & 2) == 0 ? pixels.y : pixels.w);
    }
    gl_Position = vec4(at / frame.extent.xy * 2.0 - 1.0, 0.5, 1.0);
}
