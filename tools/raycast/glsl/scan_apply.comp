#version 460
// Passes `tiles` and `scan`, last part: prefix sums of the values within each block.
// Reads: blocks, values. Writes: values.

#include "scan.glsl"

layout(local_size_x = GROUP) in;
layout(set = 0, binding = 2, std430) buffer Values { uint values[]; };

void main() {
    uint first = gl_WorkGroupID.x * BLOCK + EACH * gl_LocalInvocationIndex;
    uint end = min(first + EACH, push.count);
    uint own = 0u;
    for (uint i = first; i < end; ++i) {
        own += amount_of(values[i]);
    }
    uint all;
    uint before = blocks[gl_WorkGroupID.x] + sum_before(own, all);
    for (uint i = first; i < end; ++i) {
        uint amount = amount_of(values[i]);
        values[i] = BRICKS == 1u ? before + amount : before;
        before += amount;
    }
}
