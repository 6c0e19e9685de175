#version 460
// Pass `shape`, second part: enters the particles in their buckets, in any order within a bucket.
// Reads: the host's count, positions. Writes: buckets (begin of each, then its end), places.

#include "random.glsl"
#include "shape_chunk.glsl"
#include "place.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 4, std430) writeonly buffer Places { Place places[]; };

void visit(uint i) {
    vec3 position = position_of(i);
    if (takes_part(position)) {
        places[atomicAdd(buckets[bucket_of(cell_of(position))], 1u)] = Place(position, push.chunk_first + i);
    }
}

void main() {
    uint end = particles_here();
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
