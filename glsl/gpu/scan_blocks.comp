#version 460
// Passes `grid`, `advance`, `emit`, `blobs`, `heap` and `shape`, exclusive prefix sum, second part: over the sums of
// the blocks, by one workgroup.
// Reads: counts, blocks. Writes: blocks, the total in counts.

#include "scan.glsl"

layout(local_size_x = SCAN_GROUP) in;

void main() {
    uint end = (numbers() + SCAN_BLOCK - 1u) / SCAN_BLOCK;
    uint before = 0u;
    for (uint first = 0u; first < end; first += SCAN_GROUP) {
        uint block = first + gl_LocalInvocationIndex;
        uint own = block < end ? blocks[block] : 0u;
        uint all;
        uint sum = sum_before(own, all);
        if (block < end) {
            blocks[block] = plus(before, sum);
        }
        before = plus(before, all);
    }
    if (gl_LocalInvocationIndex == 0u) {
        counts[push.total] = before;
    }
}
