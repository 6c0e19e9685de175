// Which tiles have foam on the host's surface, for `composite`. Reads, writes: marks.

// 1 for each tile with foam.
layout(set = 0, binding = 11, std430) buffer Marks { uint marks[]; };

void draws(uint tile) {
    // An atomic, because several invocations may set the same mark.
    atomicOr(marks[tile], 1u);
}
