#version 460
// Pass `grid`, first part: stores the number of particles of the step.
// Reads: the host's count. Writes: counts.

#include "random.glsl"
#include "generate.glsl"

layout(local_size_x = 1) in;
layout(constant_id = 0) const uint FROM_GPU = 0;

layout(set = 0, binding = 1, std430) readonly buffer HostCount { uint host_count; };
layout(set = 0, binding = 2, std430) buffer CountBuffer { GenerateCounts counts; };

void main() {
    // A host that knows the number of particles passes it as the capacity. A restored state of another generator (an
    // error of the host) may have too many used slots, so their number is clamped to the capacity.
    counts.high = min(counts.high, push.most);
    counts.fluid = FROM_GPU == 1u ? min(host_count, push.capacity) : push.capacity;
}
