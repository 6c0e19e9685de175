#version 460
// Pass `grid`, last part: enters the particles in their buckets, in any order within a bucket.
// Reads: counts, positions, velocities, ids. Writes: buckets (begin of each, then its end), places, motions.

#include "random.glsl"
#include "fluid.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 6, std430) writeonly buffer Places { Place places[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Motions { Motion motions[]; };

void visit(uint i) {
    vec3 position;
    vec3 velocity;
    if (takes_part(i, position, velocity)) {
        uint number = push.chunk_first + i;
        uint id = push.id_stride > 0u ? ids[push.id_word + i * push.id_stride] : number;
        uint place = atomicAdd(buckets[bucket_of(cell_of(position))], 1u);
        places[place] = Place(position, id);
        motions[place] = Motion(velocity, number);
    }
}

void main() {
    uint end = min(push.chunk, counts.fluid - min(counts.fluid, push.chunk_first));
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
