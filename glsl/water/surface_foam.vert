#version 460
// Pass `surface_foam`, raster path: a quad around each sprite, in its plane (thesis Sec. 4.6.2; Listing A.10 builds it
// in a geometry shader). The fragment shader cuts out the ellipse. If the plane is seen at a grazing angle, or the
// sprite comes nearer to the eye's plane than a quarter of its centre's depth, the quad is the bounding box of a
// sphere around the sprite.
// Reads: sprites. Writes: corners, the sprite's plane, noise and light.

#include "frame.glsl"
#include "sphere.glsl"
#include "random.glsl"
#include "whole_steps.glsl"
#include "gradient_noise.glsl"
#include "surface_foam.glsl"
#include "pattern.glsl"
#include "kernel.glsl"
#include "surface_foam_sprite.glsl"

// 0: depth. 1: thickness.
layout(constant_id = 0) const uint THICK = 0;

layout(set = 0, binding = 1, std430) readonly buffer Sprites { FoamSprite sprites[]; };

layout(location = 0) flat out vec3 centre;
layout(location = 1) flat out vec3 along;  // divided by its half-axis
layout(location = 2) flat out vec3 across;
layout(location = 3) flat out vec3 normal;
layout(location = 4) flat out float amount;
layout(location = 5) flat out FoamNoise noise;

void main() {
    FoamSprite sprite = sprites[gl_InstanceIndex];
    FoamPlane plane = foam_plane(sprite, THICK == 1u);
    centre = plane.centre;
    along = plane.e1 / plane.axes.x;
    across = plane.e2 / plane.axes.y;
    normal = plane.normal;
    amount = foam_amount(sprite, plane);
    noise = foam_noise(sprite, plane);

    vec4 scale = frame.thick_slope;
    vec2 extent = frame.thick_extent.xy;
    vec2 side = vec2((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0, (gl_VertexIndex & 2) == 0 ? -1.0 : 1.0);
    // One texel of the target wider on each side, so that snapping of vertex positions (to 1/16 pixel at worst) does
    // not cut the footprint, even if it is foreshortened.
    vec3 reach_a = plane.e1 * (plane.axes.x + plane.texel);
    vec3 reach_b = plane.e2 * (plane.axes.y + plane.texel);
    float depth = -centre.z;
    vec2 at;
    if (abs(dot(normal, centre)) > 0.3 * length(centre) && depth - abs(reach_a.z) - abs(reach_b.z) > 0.25 * depth) {
        vec3 corner = centre + side.x * reach_a + side.y * reach_b;
        at = (corner.xy / -corner.z - scale.zw) / scale.xy;
    } else {
        vec4 slopes;
        sphere_bounds(centre, plane.axes.x, slopes);
        vec4 pixels = pixel_bounds(slopes, scale) + vec4(-0.125, -0.125, 0.125, 0.125);
        pixels = clamp(pixels, vec4(-1.0), extent.xyxy + 1.0);
        at = mix(pixels.xy, pixels.zw, 0.5 + 0.5 * side);
    }
    gl_Position = vec4(at / extent * 2.0 - 1.0, 0.5, 1.0);
}
