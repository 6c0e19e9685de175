#version 460
// Pass `shoreline`, second part: lists of the marked tiles by what they may have, with the dispatches over them, and one of
// all with the draw of their quads.
// Reads: marks. Writes: lists, arguments.

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Marks { uint marks[]; };
// Shoreline foam, contact foam, both, any.
layout(set = 0, binding = 1, std430) writeonly buffer List { uint list[]; };
// Vertices, instances, first vertex, first instance; of each of three lists groups in x, y, z and how many tiles.
layout(set = 0, binding = 2, std430) buffer Arguments { uint arguments[16]; };
layout(push_constant, std430) uniform Push {
    uint tiles;
    uint most; // of a list
} push;

const uint MOST_GROUPS = 65535u; // of a dispatch, in each direction

void main() {
    uint i = gl_GlobalInvocationID.x;
    uint mark = i < push.tiles ? marks[i] : 0u;
    if (mark != 0u) {
        list[3u * push.most + atomicAdd(arguments[1], 1u)] = i;
    }
    uint kind = mark & 3u;
    if (kind != 0u) {
        uint slot = atomicAdd(arguments[4u * kind + 3u], 1u);
        list[(kind - 1u) * push.most + slot] = i;
        atomicMax(arguments[4u * kind], min(slot + 1u, MOST_GROUPS));
        atomicMax(arguments[4u * kind + 1u], 1u + slot / MOST_GROUPS);
    }
}
