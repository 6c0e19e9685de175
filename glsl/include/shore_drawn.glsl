// The list of the tiles that have foam on the host's surface, for `composite`. Needs shore_lists.glsl.
// Reads: marks. Writes: list, arguments, marks.

// Of each tile 1 where it has foam.
layout(set = 0, binding = 11, std430) buffer Marks { uint marks[]; };

void draws(uint tile) {
    // The first of a tile's lists it; a group of the dispatch has one.
    if (atomicExchange(marks[tile], 1u) == 0u) {
        fills(4u, atomicAdd(arguments[1], 1u), tile, 1u);
    }
}
