#version 460
// Pass `map`, heights: a mesh of the host's from above; the highest of each texel is kept.
// Reads: the host's vertices. Writes: places in the map, heights as depths.

layout(set = 0, binding = 0, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 1, std430) readonly buffer Indices { uint indices[]; };
layout(push_constant, std430) uniform Push {
    vec4 east;   // mesh's space -> the map, -1 to 1
    vec4 north;
    vec4 height; // -> depth, 0 to 1
    uint position_word;
    uint position_stride;
    uint index_word;
    uint index_stride; // 0: none, vertices in their order
    uint vertices;
} push;

void main() {
    uint i = uint(gl_VertexIndex);
    i = push.index_stride > 0u ? indices[push.index_word + i * push.index_stride] : i;
    bool there = i < push.vertices;
    uint at = push.position_word + (there ? i : 0u) * push.position_stride;
    vec4 own = vec4(positions[at], positions[at + 1u], positions[at + 2u], 1.0);
    there = there && all(lessThan(abs(own), vec4(1.0e18)));
    // What is higher or lower than the range is as high as that: an island's peak is land.
    vec3 place = vec3(dot(push.east, own), dot(push.north, own), clamp(dot(push.height, own), 0.0, 1.0));
    gl_Position = there ? vec4(place, 1.0) : vec4(0.0, 0.0, -1.0, 1.0);
}
