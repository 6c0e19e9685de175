#version 460
// Passes `grid`, `advance`, `emit`, `blobs`, `heap` and `shape`, exclusive prefix sum, first part: the sum of each
// block of 1024 values.
// Reads: counts, values. Writes: blocks.

#include "scan.glsl"

layout(local_size_x = SCAN_GROUP) in;

layout(set = 0, binding = 3, std430) readonly buffer Values { uint values[]; };

void main() {
    uint end = numbers();
    for (uint block = gl_WorkGroupID.x; block * SCAN_BLOCK < end; block += gl_NumWorkGroups.x) {
        uint first = block * SCAN_BLOCK + SCAN_EACH * gl_LocalInvocationIndex;
        uint own = 0u;
        for (uint i = first; i < min(first + SCAN_EACH, end); ++i) {
            own = plus(own, counted(values[i]));
        }
        uint all;
        sum_before(own, all);
        if (gl_LocalInvocationIndex == 0u) {
            blocks[block] = all;
        }
    }
}
