#version 460
// Pass `shoreline`, second part: a list of the marked tiles, with the dispatch over them and the draw of their quads.
// Reads: marks. Writes: list, arguments.

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Marks { uint marks[]; };
layout(set = 0, binding = 1, std430) writeonly buffer List { uint list[]; };
// Groups in x, y, z, how many tiles; vertices, instances, first vertex, first instance.
layout(set = 0, binding = 2, std430) buffer Arguments { uint arguments[8]; };
layout(push_constant, std430) uniform Push { uint tiles; } push;

const uint MOST_GROUPS = 65535u; // of a dispatch, in each direction

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < push.tiles && marks[i] != 0u) {
        uint slot = atomicAdd(arguments[3], 1u);
        list[slot] = i;
        atomicAdd(arguments[5], 1u);
        atomicMax(arguments[0], min(slot + 1u, MOST_GROUPS));
        atomicMax(arguments[1], 1u + slot / MOST_GROUPS);
    }
}
