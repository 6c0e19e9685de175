// A chunk of the host's particles, for the passes that build the neighbour grid of `shape`. Needs random.glsl.
// Reads: the host's count, positions. Writes: buckets.

layout(set = 0, binding = 1, std430) readonly buffer HostCount { uint host_count; };
layout(set = 0, binding = 2, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 3, std430) buffer Buckets { uint buckets[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint chunk_first;
    uint chunk;           // most particles of the chunk
    uint count;           // number from the host, or the capacity
    uint from_gpu;        // 1: the count is in the buffer
    uint buckets;         // a power of two
    float cells;          // grid cells per unit of length
} push;

#include "cells.glsl"

uint particles_here() {
    uint total = push.from_gpu == 1u ? min(host_count, push.count) : push.count;
    return min(push.chunk, total - min(total, push.chunk_first));
}

vec3 position_of(uint i) {
    uint at = push.position_word + i * push.position_stride;
    return vec3(positions[at], positions[at + 1u], positions[at + 2u]);
}

// False for particles that are not finite or far beyond any scene: they are not in the grid and stay spheres.
bool takes_part(vec3 position) {
    // Comparisons with NaN are false.
    return all(lessThan(abs(position), vec3(min(1.0e18, 1073741824.0 / push.cells))));
}
