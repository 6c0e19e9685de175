#version 460
// Pass `cull`, last part: computes the arguments of dispatches over the visible particles, which are the numbers
// of workgroups for small and for large sprites, from the counts that `cull` has left for each chunk. Indirect
// draws need no conversion: they take these counts as they are. Not in the thesis, which only draws.
// Reads: Counts of every chunk. Writes: their dispatch arguments.

layout(local_size_x = 32) in;
layout(set = 0, binding = 1, std430) buffer AllCounts { uint words[]; };

layout(push_constant, std430) uniform Push {
    uint chunks;
    uint group_size;
    uint most_groups; // large sprites share workgroups beyond this
    uint capacity;    // of a chunk's list
} push;

void main() {
    uint chunk = gl_GlobalInvocationID.x;
    if (chunk >= push.chunks) {
        return;
    }
    uint base = chunk * 64u;
    // Packets that overlap, against the contract, may give more entries than the list holds.
    uint small = min(words[base], push.capacity);
    uint large = min(words[base + 5u], push.capacity - small);
    words[base] = small;
    words[base + 5u] = large;
    // If a chunk has only large sprites, one workgroup is still dispatched for small ones: in pass `front` this
    // workgroup also copies the large sprites to the list of the front.
    words[base + 8u] = max((small + push.group_size - 1u) / push.group_size, min(large, 1u));
    words[base + 11u] = min(large, push.most_groups);
}
