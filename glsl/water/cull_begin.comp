#version 460
// Pass `cull`, first part: limits the number of particles to the capacity and initializes the indirect arguments of
// each chunk (the particles of one buffer binding). Not in the source, which culls on the CPU (thesis Sec. 4.3).
// Reads: the host's count. Writes: Counts of every chunk.

#include "counts.glsl"

layout(local_size_x = 32) in;

layout(set = 0, binding = 1, std430) readonly buffer HostCount { uint host_count; };
// Counts of all chunks: 256 bytes per chunk, so that the Counts of each chunk can be bound, and used as indirect
// arguments, separately.
layout(set = 0, binding = 2, std430) writeonly buffer AllCounts { uint words[]; };

layout(push_constant, std430) uniform Push {
    uint count;      // number from the host, or the capacity
    uint from_gpu;   // 1: the count is in the buffer
    uint chunks;
    uint chunk_size;
    uint packets;    // > 0: culling by packets, one workgroup per packet
    uint group_size;
} push;

void main() {
    uint chunk = gl_GlobalInvocationID.x;
    if (chunk >= push.chunks) {
        return;
    }
    uint total = push.from_gpu == 1u ? min(host_count, push.count) : push.count;
    uint first = min(chunk * push.chunk_size, total);
    uint here = min(total - first, push.chunk_size);
    uint groups = push.packets > 0u ? (here > 0u ? push.packets : 0u)
                                    : (here + push.group_size - 1u) / push.group_size;
    uint base = chunk * 64u;
    uint values[39] = uint[39](
        0u, 1u, 0u, 0u,
        4u, 0u, 0u, 0u,
        0u, 1u, 1u,
        0u, 1u, 1u,
        groups, 1u, 1u,
        here, 0u, 0u,
        4u, 0u, 0u, 0u,
        4u, 0u, 0u, 0u,
        4u, here, 0u, 0u,
        4u, 0u, 0u, 0u,
        0u, 1u, 1u);
    for (uint i = 0u; i < 39u; ++i) {
        words[base + i] = values[i];
    }
}
