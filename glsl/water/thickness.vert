#version 460
// Pass `thickness`, raster path: a disc for each particle, in the plane of its centre's depth (thesis Sec. 3.2.2,
// 4.8.1).
// Reads: visible, shares. Writes: the disc's corners, amplitude and quadratic form.

#include "frame.glsl"
#include "sphere.glsl"
#include "ellipsoid.glsl"
#include "kernel.glsl"

// 0: points, from the front of the list. 1: quads, from its back.
layout(constant_id = 0) const uint QUADS = 0;
// 1: spheres are scaled by the fraction of water of their particles.
layout(constant_id = 9) const uint FOAM = 0;

layout(set = 0, binding = 1, std430) readonly buffer Visible { vec4 visible[]; };
layout(set = 0, binding = 6, std430) readonly buffer Shares { float shares[]; };
layout(push_constant, std430) uniform Push { uint capacity; } push;

layout(location = 0) flat out vec4 disc; // centre; for spheres 1 / half-axis
layout(location = 1) flat out float amplitude;
layout(location = 2) flat out vec3 conic; // for ellipsoids: the quadratic form

void main() {
    uint index = QUADS == 0u ? uint(gl_VertexIndex) : push.capacity - 1u - uint(gl_InstanceIndex);
    Ellipsoid body = ellipsoid_in(visible, index);
    vec4 sphere = body.sphere;
    float share = FOAM == 1u ? shares[index] : 1.0;
    // The sprite keeps the particle's full size.
    sphere.w = FOAM == 1u ? sphere.w / share : sphere.w;
    float widened;
    float axis = drawn_axis(sphere.w * frame.particle.z / frame.particle.x, -sphere.z, frame.thick_slope, widened);
    disc = vec4(sphere.xyz, 1.0 / axis);
    // All particles have the same volume: the thickness at a sprite's centre is multiplied by (drawn radius / own
    // radius)², so a smaller sprite holds as much water.
    float grown = frame.particle.x / sphere.w;
    amplitude = share * frame.particle.w * grown * grown / widened;
    vec2 reach = vec2(axis);
    conic = vec3(0.0);
    if (ELLIPSOIDS == 1u) {
        body.sphere.w = sphere.w;
        Disc ellipse = ellipsoid_disc(body, frame.particle.z / frame.particle.x, frame.thick_slope);
        conic = ellipse.conic;
        reach = ellipse.reach;
        amplitude = share * frame.particle.w * frame.particle.z * frame.particle.z / ellipse.area;
    }
    vec4 slopes = vec4(sphere.xy - reach, sphere.xy + reach) / -sphere.z;
    vec4 pixels = pixel_bounds(slopes, frame.thick_slope);
    pixels += vec4(-0.125, -0.125, 0.125, 0.125);
    pixels = clamp(pixels, vec4(-1.0), frame.thick_extent.xyxy + 1.0);
    vec2 at = 0.5 * (pixels.xy + pixels.zw);
    gl_PointSize = max(pixels.z - pixels.x, pixels.w - pixels.y);
    if (QUADS == 1u) {
        at = vec2((gl_VertexIndex & 1) == 0 ? pixels.x : pixels.z,
                  (gl_VertexIndex & 2) == 0 ? pixels.y : pixels.w);
    }
    gl_Position = vec4(at / frame.thick_extent.xy * 2.0 - 1.0, 0.5, 1.0);
    // A particle whose centre is nearer than the near plane has no sprite: it is moved off the screen.
    if (-sphere.z <= frame.depth.z) {
        gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
        gl_PointSize = 1.0;
    }
}
