// Which tiles have foam on the host's surface, for `composite`. Reads, writes: marks.

// Of each tile 1 where it has foam.
layout(set = 0, binding = 11, std430) buffer Marks { uint marks[]; };

void draws(uint tile) {
    // An atomic, because several invocations may do it.
    atomicOr(marks[tile], 1u);
}
