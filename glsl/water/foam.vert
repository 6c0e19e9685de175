#version 460
// Pass `foam`: a quad round each sprite; the ellipse is the fragment's. Reads: sprites.

#include "frame.glsl"
#include "sphere.glsl"
#include "foam.glsl"

// 0: depth, at full resolution. 1: thickness.
layout(constant_id = 0) const uint THICK = 0;

layout(set = 0, binding = 1, std430) readonly buffer Sprites { FoamSprite sprites[]; };

layout(location = 0) flat out vec3 centre;
layout(location = 1) flat out vec3 along;  // over its half-axis
layout(location = 2) flat out vec3 across;
layout(location = 3) flat out vec3 normal;
layout(location = 4) flat out vec4 look;   // amplitude; place in the noise

void main() {
    FoamSprite sprite = sprites[gl_InstanceIndex];
    vec3 e1;
    vec3 e2;
    float stretch = foam_axes(sprite, e1, e2);
    float foam = sprite.centre.w;
    float radius = frame.particle.x;
    float b = radius * FOAM_AXIS * (THICK == 1u ? 1.0 : min(2.0 * foam, 1.0));
    float a = b * (1.0 + stretch);
    centre = sprite.centre.xyz;
    along = e1 / a;
    across = e2 / b;
    normal = cross(e1, e2);
    // As a thickness sprite of water: the integral over the picture's plane is the volume.
    float facing = max(abs(normal.z), LEAST_FACING);
    float volume = frame.particle.w * frame.particle.z * frame.particle.z;
    vec3 phase = foam_phase(floatBitsToUint(sprite.rest.x)) * 64.0;
    look = vec4(foam * volume / (a * b * facing), phase + vec3(0.0, 0.0, sprite.velocity.w * frame.foam_noise.y));

    vec2 extent = THICK == 1u ? frame.thick_extent.xy : frame.extent.xy;
    vec4 slopes;
    sphere_bounds(centre, a, slopes);
    vec4 pixels = pixel_bounds(slopes, THICK == 1u ? frame.thick_slope : frame.slope);
    // Sub-pixel snapping (1/16 at worst) must not cut the footprint.
    pixels += vec4(-0.125, -0.125, 0.125, 0.125);
    pixels = clamp(pixels, vec4(-1.0), extent.xyxy + 1.0);
    vec2 at = vec2((gl_VertexIndex & 1) == 0 ? pixels.x : pixels.z,
                   (gl_VertexIndex & 2) == 0 ? pixels.y : pixels.w);
    gl_Position = vec4(at / extent * 2.0 - 1.0, 0.5, 1.0);
}
