#version 460
// Passes `grid`, `advance`, `emit`, `blobs`, `heap` and `shape`, exclusive prefix sum, last part: within each block of
// 1024 values, from the sum of all blocks before it.
// Reads: counts, blocks, values. Writes: values.

#include "scan.glsl"

layout(local_size_x = SCAN_GROUP) in;

layout(set = 0, binding = 3, std430) buffer Values { uint values[]; };

void main() {
    uint end = numbers();
    for (uint block = gl_WorkGroupID.x; block * SCAN_BLOCK < end; block += gl_NumWorkGroups.x) {
        uint first = block * SCAN_BLOCK + SCAN_EACH * gl_LocalInvocationIndex;
        uint last = min(first + SCAN_EACH, end);
        uint own = 0u;
        for (uint i = first; i < last; ++i) {
            own = plus(own, counted(values[i]));
        }
        uint all;
        uint before = plus(blocks[block], sum_before(own, all));
        for (uint i = first; i < last; ++i) {
            uint value = values[i];
            values[i] = before;
            before = plus(before, counted(value));
        }
    }
}
