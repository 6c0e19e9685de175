#version 460
// Pass `map`, heights: a host mesh drawn from above; the depth test keeps the highest surface at each texel's centre.
// Reads: the host's vertices and indices. Writes: positions in the map, heights as depths.

layout(set = 0, binding = 0, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 1, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant, std430) uniform Push {
    vec4 east;   // mesh space to map, -1 to 1
    vec4 north;
    vec4 height; // to depth, 0 to 1
    uint position_word;
    uint position_stride;
    uint index_word;
    uint index_stride; // 0: no indices, vertices in their order
    uint vertices;
} push;

// Vertex index of a triangle's corner; the number of vertices if the index is invalid.
uint vertex_of(uint corner) {
    uint i = push.index_stride > 0u ? indices[push.index_word + corner * push.index_stride] : corner;
    return min(i, push.vertices);
}

vec4 vertex_at(uint i) {
    uint at = push.position_word + i * push.position_stride;
    return vec4(positions[at], positions[at + 1u], positions[at + 2u], 1.0);
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
    // The heights of the vertices are clamped to the range of the map, so that a peak above it stays land.
    vec3 place = vec3(dot(push.east, vertex), dot(push.north, vertex), clamp(dot(push.height, vertex), 0.0, 1.0));
    gl_Position = there ? vec4(place, 1.0) : vec4(0.0, 0.0, -1.0, 1.0);
}
