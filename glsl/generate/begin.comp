#version 460
// Pass `grid`, first part: stores the number of fluid particles of this simulation step, and clamps the number of
// used slots for whitewater particles.
// Reads: the host's count, counts. Writes: counts.

#include "random.glsl"
#include "generate.glsl"

layout(local_size_x = 1) in;
layout(constant_id = 0) const uint FROM_GPU = 0;

layout(set = 0, binding = 1, std430) readonly buffer HostCount { uint host_count; };
layout(set = 0, binding = 2, std430) buffer CountBuffer { GenerateCounts counts; };

void main() {
    // `most` is the capacity for whitewater particles: a state that the host restores by mistake from another
    // generator may have more slots in use. `capacity` is that for fluid particles, or their number if the host knows
    // it.
    counts.high = min(counts.high, push.most);
    counts.fluid = FROM_GPU == 1u ? min(host_count, push.capacity) : push.capacity;
}
