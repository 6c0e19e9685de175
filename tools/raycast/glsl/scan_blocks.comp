#version 460
// Passes `tiles` and `scan`, first part: the sum of each block.
// Reads: values. Writes: blocks.

#include "scan.glsl"

layout(local_size_x = GROUP) in;
layout(set = 0, binding = 2, std430) readonly buffer Values { uint values[]; };

void main() {
    uint first = gl_WorkGroupID.x * BLOCK + EACH * gl_LocalInvocationIndex;
    uint own = 0u;
    for (uint i = first; i < min(first + EACH, push.count); ++i) {
        own += amount_of(values[i]);
    }
    uint all;
    sum_before(own, all);
    if (gl_LocalInvocationIndex == 0u) {
        blocks[gl_WorkGroupID.x] = all;
    }
}
