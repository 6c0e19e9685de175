#version 460
// Pass `foam`: a quad round each sprite, in its plane (thesis Sec. 4.6.2; Listing A.10 does it in a geometry
// shader); the ellipse is the fragment's. Seen from its edge,
// or through the near plane, it is the box of a sphere round it.
// Reads: sprites. Writes: corners, the sprite's plane and noise.

#include "frame.glsl"
#include "sphere.glsl"
#include "random.glsl"
#include "gradient_noise.glsl"
#include "foam.glsl"

// 0: depth, at full resolution. 1: thickness.
layout(constant_id = 0) const uint THICK = 0;

layout(set = 0, binding = 1, std430) readonly buffer Sprites { FoamSprite sprites[]; };

layout(location = 0) flat out vec3 centre;
layout(location = 1) flat out vec3 along;  // over its half-axis
layout(location = 2) flat out vec3 across;
layout(location = 3) flat out vec3 normal;
layout(location = 4) flat out vec4 look;   // amplitude; place in the noise
layout(location = 5) flat out vec2 torn;   // strength of the noise; share of the sun's light

// Over the foam, that of the depth: whole before there is enough foam to be seen, for what is behind the
// frontmost foam and what is before it changes at its outline.
const float DEPTH_GROWTH = 8.0;

void main() {
    FoamSprite sprite = sprites[gl_InstanceIndex];
    vec3 e1;
    vec3 e2;
    float stretch = foam_axes(sprite, e1, e2);
    float foam = sprite.centre.w;
    float radius = frame.particle.x;
    float b = radius * FOAM_AXIS * (THICK == 1u ? 1.0 : min(DEPTH_GROWTH * foam, 1.0));
    float a = b * (1.0 + stretch);
    vec4 scale = THICK == 1u ? frame.thick_slope : frame.slope;
    float depth = -sprite.centre.z;
    float pixel = depth * max(abs(scale.x), abs(scale.y));
    torn = vec2(0.0, sprite.rest.y);
    if (THICK == 1u) {
        // Cells of less than a texel cannot be told from each other; those of two are seen whole.
        torn.x = frame.foam_noise.x * smoothstep(1.0, 2.0, b / (NOISE_CELLS * pixel));
        a = max(a, LEAST_FOAM_AXIS * pixel);
        b = max(b, LEAST_FOAM_AXIS * pixel);
    }
    centre = sprite.centre.xyz;
    along = e1 / a;
    across = e2 / b;
    normal = cross(e1, e2);
    // As a thickness sprite of water: the integral over the picture's plane is the volume.
    float facing = max(abs(normal.z), LEAST_FACING);
    float volume = frame.particle.w * frame.particle.z * frame.particle.z;
    vec3 phase = noise_phase(floatBitsToUint(sprite.rest.x)) * 64.0;
    look = vec4(foam * volume / (a * b * facing), phase + vec3(0.0, 0.0, sprite.velocity.w * frame.foam_noise.y));

    vec2 extent = THICK == 1u ? frame.thick_extent.xy : frame.extent.xy;
    vec2 side = vec2((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0, (gl_VertexIndex & 2) == 0 ? -1.0 : 1.0);
    // A pixel more: snapping (1/16 at worst) must not cut the footprint, even foreshortened.
    vec3 reach_a = e1 * (a + pixel);
    vec3 reach_b = e2 * (b + pixel);
    vec2 at;
    if (abs(dot(normal, centre)) > 0.3 * length(centre) && depth - abs(reach_a.z) - abs(reach_b.z) > 0.25 * depth) {
        vec3 corner = centre + side.x * reach_a + side.y * reach_b;
        at = (corner.xy / -corner.z - scale.zw) / scale.xy;
    } else {
        vec4 slopes;
        sphere_bounds(centre, a, slopes);
        vec4 pixels = pixel_bounds(slopes, scale) + vec4(-0.125, -0.125, 0.125, 0.125);
        pixels = clamp(pixels, vec4(-1.0), extent.xyxy + 1.0);
        at = mix(pixels.xy, pixels.zw, 0.5 + 0.5 * side);
    }
    gl_Position = vec4(at / extent * 2.0 - 1.0, 0.5, 1.0);
}
