// Input of the passes that build the neighbour grid: the host's fluid particles, bound chunk by chunk (in ranges).
// Needs random.glsl.
// Reads: positions, velocities, ids, counts. Writes: buckets.

#include "generate_types.glsl"

layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Velocities { float velocities[]; };
layout(set = 0, binding = 3, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { GenerateCounts counts; };
layout(set = 0, binding = 5, std430) buffer Buckets { uint buckets[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint velocity_word;
    uint velocity_stride;
    uint id_word;
    uint id_stride;       // 0: no ids, the index in the step instead
    uint chunk_first;
    uint chunk;           // most particles of the chunk
    float spacing;
    float cells;
    uint buckets;
} push;

#include "cells.glsl"

// Particles that are not finite, or far beyond any scene, are ignored.
bool takes_part(uint i, out vec3 position, out vec3 velocity) {
    uint at = push.position_word + i * push.position_stride;
    position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    at = push.velocity_word + i * push.velocity_stride;
    velocity = vec3(velocities[at], velocities[at + 1u], velocities[at + 2u]);
    // Comparisons with NaN are false.
    float far = min(1.0e18, 2147483648.0 * push.spacing);
    return all(lessThan(abs(position), vec3(far))) && all(lessThan(abs(velocity), vec3(1.0e18)));
}
