#version 460
// Passes `tiles` and `scan`, second part: one group forms the prefix sums of the blocks, and stores the total after
// them.
// Reads: blocks. Writes: blocks.

#include "scan.glsl"

layout(local_size_x = GROUP) in;

void main() {
    uint end = (push.count + BLOCK - 1u) / BLOCK;
    uint before = 0u;
    for (uint first = 0u; first < end; first += GROUP) {
        uint block = first + gl_LocalInvocationIndex;
        uint own = block < end ? blocks[block] : 0u;
        uint all;
        uint sum = sum_before(own, all);
        if (block < end) {
            blocks[block] = before + sum;
        }
        before += all;
    }
    if (gl_LocalInvocationIndex == 0u) {
        blocks[end] = before;
    }
}
