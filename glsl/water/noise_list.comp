#version 460
// Pass `noise`, first part: lists the particles in the view that are not only spray, in eye space. (Omitting the
// particles that pass `front` finds hidden saved nothing, because spheres too small to cover a cell of 4x4 pixels
// hide nothing.)
// Reads: Counts (particles), positions, densities, ids, members. Writes: Counts (noise), sprites.

#include "frame.glsl"
#include "frustum.glsl"
#include "counts.glsl"
#include "density.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 3, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 4, std430) buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 5, std430) writeonly buffer Sprites { vec4 sprites[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint density_word;
    uint density_stride;  // 0: no densities
    uint id_word;
    uint id_stride;       // 0: no ids, the index in the frame instead
    uint chunk_first;
    uint packets;         // 1: particles in no packet do not count
} push;

#define MEMBERS 6
#include "members.glsl"

void visit(uint index) {
    if (!is_member(index)) {
        return;
    }
    if (push.density_stride > 0u) {
        float density = densities[push.density_word + index * push.density_stride];
        // As in cull.comp, a density of 0 marks a particle that was just emitted. Such a particle is not spray, nor
        // is one whose density is NaN.
        if (density > 0.0 && density < frame.density.x) {
            return;
        }
    }
    uint at = push.position_word + index * push.position_stride;
    vec3 position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    if (!(all(lessThan(abs(position), vec3(1.0e18))))) {
        return;
    }
    vec3 centre = (frame.view * vec4(position, 1.0)).xyz;
    // 1.5 bounds half the diagonal of the quad.
    if (-centre.z <= frame.depth.z || !in_frustum(centre, 1.5 * frame.noise.w)) {
        return;
    }
    uint id = push.id_stride > 0u ? ids[push.id_word + index * push.id_stride] : push.chunk_first + index;
    sprites[atomicAdd(counts.noise, 1u)] = vec4(centre, uintBitsToFloat(id));
}

void main() {
    uint count = counts.particles;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
