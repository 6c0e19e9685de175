#version 460
// Pass `shoreline`: the host's strip of foam, whose vertices have a place and v (blog, Sec. IV).
// Reads: the host's streams. Writes: eye position, v.

#include "frame.glsl"

layout(set = 0, binding = 8, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 9, std430) readonly buffer Across { float across[]; };
layout(set = 0, binding = 10, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant, std430) uniform Push {
    uint position_word;
    uint position_stride;
    uint v_word;
    uint v_stride;
    uint index_word;
    uint index_stride; // 0: none, vertices in their order
    uint vertices;
} push;

layout(location = 0) out vec3 eye;
layout(location = 1) out float v;

void main() {
    uint i = uint(gl_VertexIndex);
    i = push.index_stride > 0u ? indices[push.index_word + i * push.index_stride] : i;
    bool there = i < push.vertices;
    i = there ? i : 0u;
    uint at = push.position_word + i * push.position_stride;
    vec3 world = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    v = across[push.v_word + i * push.v_stride];
    eye = (frame.view * vec4(world, 1.0)).xyz;
    vec2 clip = frame.projection.xy * eye.xy + frame.projection.zw * eye.z;
    // Clipped at the near plane; else its depth is compared with the scene's where it is shaded.
    bool finite = all(lessThan(abs(vec4(eye, v)), vec4(1.0e18)));
    gl_Position = there && finite ? vec4(clip, -eye.z - frame.depth.z, -eye.z) : vec4(0.0, 0.0, -1.0, 1.0);
}
