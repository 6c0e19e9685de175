#version 460
// Pass `shape`, first part: counts the particles in each bucket of the grid that finds neighbours (Yu and Turk 2013
// do not say how neighbours are found).
// Reads: the host's count, positions. Writes: bucket counts; shaped: the spheres of particles that are not in the grid.

#include "random.glsl"
#include "shape_chunk.glsl"
#include "axes.glsl"
#include "shaped.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 4, std430) writeonly buffer Shaped { uint shaped[]; };

void visit(uint i) {
    vec3 position = position_of(i);
    if (takes_part(position)) {
        atomicAdd(buckets[bucket_of(cell_of(position))], 1u);
        return;
    }
    uint at = SHAPED_WORDS * (push.chunk_first + i);
    uvec3 axes = pack_axes(mat3(1.0));
    for (uint k = 0u; k < 3u; ++k) {
        shaped[at + k] = floatBitsToUint(position[k]);
        shaped[at + 3u + k] = axes[k];
        shaped[at + 6u + k] = axes[k];
    }
    shaped[at + 9u] = floatBitsToUint(CROWDED);
}

void main() {
    uint end = particles_here();
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
