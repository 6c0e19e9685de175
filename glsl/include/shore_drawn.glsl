// The list of the tiles that have foam on the host's surface, for `composite`: its draw and its dispatch. Needs a push with
// across and most.
// Reads: marks. Writes: list, arguments, marks.

// Tiles that may have shoreline foam, contact foam, both; that have any; that may have contact foam on the particles' water.
layout(set = 0, binding = 9, std430) buffer Lists { uint list[]; };
// Vertices, instances, first vertex, first instance of the draw of the fourth; of the others groups in x, y, z and how many
// tiles; of the fourth groups in x, y, z.
layout(set = 0, binding = 10, std430) buffer Arguments { uint arguments[24]; };
// Of each tile 1 where it has foam.
layout(set = 0, binding = 11, std430) buffer Marks { uint marks[]; };

void draws(uint tile) {
    // The first of a tile's lists it.
    if (atomicExchange(marks[tile], 1u) == 0u) {
        uint slot = atomicAdd(arguments[1], 1u);
        list[3u * push.most + slot] = tile;
        atomicMax(arguments[16], min(slot + 1u, 65535u));
        atomicMax(arguments[17], 1u + slot / 65535u);
    }
}
