#version 460
// Pass `grid`: counts the fluid particles in each bucket of the hash grid in which later passes find neighbours. It
// reads velocities because it leaves out particles with an invalid velocity.
// Reads: number of particles, positions, velocities. Writes: bucket counts; zeros as the potentials of each fluid
// particle and as its number of whitewater particles to emit.

#include "random.glsl"
#include "fluid.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 6, std430) writeonly buffer Wanted { uint wanted[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Potentials { vec4 potentials[]; };

void visit(uint i) {
    wanted[push.chunk_first + i] = 0u;
    potentials[push.chunk_first + i] = vec4(0.0);
    vec3 position;
    vec3 velocity;
    if (takes_part(i, position, velocity)) {
        atomicAdd(buckets[bucket_of(cell_of(position))], 1u);
    }
}

void main() {
    uint end = min(push.chunk, counts.fluid - min(counts.fluid, push.chunk_first));
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
