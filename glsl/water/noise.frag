#version 460
// Pass `noise` (van der Laan et al. 2009): each particle adds one octave of noise that moves with it. The octave is
// weighted by a kernel around the particle's centre and fades with the particle's depth below the surface. Reads:
// water depth. Writes: noise (R32F), summed; 0 where there is no water.

#include "frame.glsl"
#include "random.glsl"
#include "gradient_noise.glsl"
#include "surface_noise.glsl"

layout(location = 0) flat in vec3 centre;
layout(location = 1) flat in vec3 phase;

layout(set = 0, binding = 2) uniform sampler2D water_depth;

layout(location = 0) out float noise;

void main() {
    float depth = -centre.z;
    vec2 slope = ray_slope(gl_FragCoord.xy * frame.noise_image.z, frame.slope);
    // Offset of the pixel's ray from the particle's centre, in the plane of the centre's depth, as for thickness
    // sprites.
    vec2 off = slope * depth - centre.xy;
    vec2 place = off / frame.noise.w;
    float rho2 = dot(place, place);
    float surface = texelFetch(water_depth, noise_pixel(ivec2(gl_FragCoord.xy)), 0).x;
    if (surface >= EMPTY || rho2 >= 1.0) {
        discard;
    }
    // How far the particle's nearest point is behind the surface, in scene units: at 0 or less the particle counts
    // fully.
    float below = max(depth - frame.particle.x - surface, 0.0);
    float amount = noise_kernel(rho2) * exp(-below * frame.noise.z);
    // Along the world's axes, so that it does not turn with the camera.
    vec3 at = mat3(frame.world) * vec3(off, 0.0) * frame.noise_image.w + phase;
    noise = floor(amount * gradient_noise(at) * NOISE_PARTS + 0.5) / NOISE_PARTS;
}
