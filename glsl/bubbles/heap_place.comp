#version 460
// Pass `heap` (simulation of blobs), grid of neighbours: the first dispatch counts the blobs of each bucket, the
// second enters their indices. Between the two the counts are replaced by their exclusive prefix sums, which the
// second turns into inclusive ones.
// Reads: balls. Writes: buckets, order.

#include "heap.glsl"

layout(local_size_x = 64) in;
// 0: counts. 1: entries.
layout(constant_id = 0) const uint GO = 0;

layout(set = 0, binding = 0, std430) readonly buffer Balls { vec4 balls[]; };
layout(set = 0, binding = 5, std430) buffer Buckets { uint buckets[]; };
layout(set = 0, binding = 6, std430) writeonly buffer Order { uint order[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    // Invalid blobs are not in the grid.
    if (i >= push.blobs || balls[i].w <= 0.0) {
        return;
    }
    uint at = atomicAdd(buckets[bucket_of(heap_cell(balls[i].xyz))], 1u);
    if (GO == 1u) {
        order[at] = i;
    }
}
