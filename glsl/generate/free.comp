#version 460
// Pass `advance`, last part: lists the free slots in order.
// Reads: counts, whitewater particles, flags of free slots (exclusive prefix sum). Writes: free slots.

#include "random.glsl"
#include "generate.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { GenerateCounts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Particles { Whitewater particles[]; };
layout(set = 0, binding = 3, std430) readonly buffer Gone { uint gone[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Free { uint free_slots[]; };

void visit(uint i) {
    if (!(particles[i].age < 1.0)) {
        free_slots[gone[i]] = i;
    }
}

void main() {
    uint end = counts.high;
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
