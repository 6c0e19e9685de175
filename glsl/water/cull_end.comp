#version 460
// Pass `cull`, last part: survivors to workgroups.
// Reads and writes: Counts of every chunk.

layout(local_size_x = 32) in;
layout(set = 0, binding = 1, std430) buffer AllCounts { uint words[]; };

layout(push_constant, std430) uniform Push {
    uint chunks;
    uint group_size;
    uint most_groups; // large sprites share workgroups beyond this
} push;

void main() {
    uint chunk = gl_GlobalInvocationID.x;
    if (chunk >= push.chunks) {
        return;
    }
    uint base = chunk * 64u;
    words[base + 8u] = (words[base] + push.group_size - 1u) / push.group_size;
    words[base + 11u] = min(words[base + 5u], push.most_groups);
}
