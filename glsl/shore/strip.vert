#version 460
// Pass `shoreline`: the host's strip, a mesh along the shore whose vertices have a position and the shore coordinate
// v, 0 at the sea's edge of the foam to 2 inland (blog, Sec. IV).
// Reads: the host's streams. Writes: corners with eye position and v.

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
    uint index_stride; // 0: no indices, vertices in their order
    uint vertices;
} push;

layout(location = 0) out vec3 eye;
layout(location = 1) out float v;

// Vertex index of a triangle's corner; the number of vertices if the index is invalid.
uint vertex_of(uint corner) {
    uint i = push.index_stride > 0u ? indices[push.index_word + corner * push.index_stride] : corner;
    return min(i, push.vertices);
}

// World position and v.
vec4 vertex_at(uint i) {
    uint at = push.position_word + i * push.position_stride;
    return vec4(positions[at], positions[at + 1u], positions[at + 2u], across[push.v_word + i * push.v_stride]);
}

void main() {
    uint own = uint(gl_VertexIndex);
    // If a corner of a triangle is invalid, all three are moved outside the clip volume, so that it is not drawn:
    // moving only that corner would draw a different triangle.
    bool there = true;
    vec4 vertex = vec4(0.0);
    for (uint k = 0u; k < 3u; ++k) {
        uint corner = own - own % 3u + k;
        uint i = vertex_of(corner);
        bool known = i < push.vertices;
        vec4 other = vertex_at(known ? i : 0u);
        there = there && known && all(lessThan(abs(other), vec4(1.0e18)));
        vertex = corner == own ? other : vertex;
    }
    v = vertex.w;
    eye = (frame.view * vec4(vertex.xyz, 1.0)).xyz;
    vec2 clip = frame.projection.xy * eye.xy + frame.projection.zw * eye.z;
    // In depth, triangles are clipped only at the near plane, not at the far plane; shading compares their depth with
    // the scene's.
    gl_Position = there ? vec4(clip, -eye.z - frame.depth.z, -eye.z) : vec4(0.0, 0.0, -1.0, 1.0);
}
