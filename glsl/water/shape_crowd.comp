#version 460
// Pass `shape`, optional last part: lowers the surface foam and the density of particles with few neighbours, by the
// sum of the neighbours' weights. A few particles that fly together hold no air, so they have no foam. They are
// spray, although many solvers write the rest density for them. Not in the thesis.
// Reads: the host's count, foam amounts and ages, densities, shaped. Writes: foam (amount, age), densities.

#include "shaped.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer HostCount { uint host_count; };
layout(set = 0, binding = 2, std430) readonly buffer Amounts { float amounts[]; };
layout(set = 0, binding = 3, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 4, std430) readonly buffer Shaped { uint shaped[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Foam { vec2 foam[]; };
layout(set = 0, binding = 6, std430) writeonly buffer DensitiesOut { float densities_out[]; };

layout(push_constant, std430) uniform Push {
    uint amount_word;    // of the chunk's first particle
    uint amount_stride;  // in words; 0: no foam
    uint density_word;
    uint density_stride; // 0: no densities
    uint chunk_first;
    uint chunk;          // most particles of the chunk
    uint count;          // number from the host, or the capacity
    uint from_gpu;       // 1: the buffer has the number
    float foam_few;      // sum of the neighbours' weights up to which a particle has no foam,
    float foam_many;     // and from which on it has all of its foam
    float spray_few;     // sum up to which its density is at most `alone`,
    float spray_many;    // and from which on it is unchanged
    float alone;         // highest density of a particle without neighbours
} push;

// The edges are never equal: GLSL leaves that undefined.
float share_of(float few, float many, float beside) {
    return smoothstep(few, max(many, few * 1.000001 + 1.0e-6), beside);
}

void visit(uint i) {
    uint at = push.chunk_first + i;
    float beside = uintBitsToFloat(shaped[SHAPED_WORDS * at + 9u]);
    if (push.amount_stride > 0u) {
        uint own = push.amount_word + i * push.amount_stride;
        foam[at] = vec2(amounts[own] * share_of(push.foam_few, push.foam_many, beside), amounts[own + 1u]);
    }
    if (push.density_stride > 0u) {
        float density = densities[push.density_word + i * push.density_stride];
        densities_out[at] = mix(min(density, push.alone), density, share_of(push.spray_few, push.spray_many, beside));
    }
}

void main() {
    uint total = push.from_gpu == 1u ? min(host_count, push.count) : push.count;
    uint end = min(push.chunk, total - min(total, push.chunk_first));
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
