#version 460
// Pass `noise`: a quad around each sprite (van der Laan et al. 2009), in the plane of its centre's depth.
// Reads: sprites. Writes: the quad's corners.

#include "frame.glsl"
#include "random.glsl"
#include "gradient_noise.glsl"

layout(set = 0, binding = 1, std430) readonly buffer Sprites { vec4 sprites[]; };

layout(location = 0) flat out vec3 centre;
layout(location = 1) flat out vec3 phase; // position of the centre in the noise

void main() {
    vec4 sprite = sprites[gl_InstanceIndex];
    centre = sprite.xyz;
    // Random positions in 64×64×64 cells of the noise, so that particles near each other have different
    // noise.
    phase = noise_phase(floatBitsToUint(sprite.w)) * 64.0;
    float edge = frame.noise_image.z;
    vec2 side = vec2((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0, (gl_VertexIndex & 2) == 0 ? -1.0 : 1.0);
    float depth = -centre.z;
    // The quad is one texel of the target wider than the sprite on each side, so that snapping of vertex
    // positions does not cut the sprite's footprint.
    vec2 reach = frame.noise.w + depth * edge * abs(frame.slope.xy);
    vec2 slope = (centre.xy + side * reach) / depth;
    vec2 texel = (slope - frame.slope.zw) / (frame.slope.xy * edge);
    gl_Position = vec4(texel / frame.noise_image.xy * 2.0 - 1.0, 0.5, 1.0);
}
