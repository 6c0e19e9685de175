#version 460
// Pass `heap`, order: sorts the blobs of each bucket of the neighbour grid by id, so that sums over them are the same
// in every run. Only the blobs with the lowest ids, MOST_IN_BUCKET of them, are sorted, and only they are read as
// neighbours later: with all blobs on one spot a full sort would hang a device.
// Reads: balls, drifts, spins, ids, buckets, order. Writes: order, heaped.

#include "heap.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std430) readonly buffer Balls { vec4 balls[]; };
layout(set = 0, binding = 2, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 3, std430) readonly buffer Drifts { vec4 drifts[]; };
layout(set = 0, binding = 4, std430) readonly buffer Spins { vec4 spins[]; };
layout(set = 0, binding = 5, std430) readonly buffer Buckets { uint buckets[]; };
layout(set = 0, binding = 6, std430) buffer Order { uint order[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Heap { Heaped heaped[]; };

void main() {
    uint bucket = gl_GlobalInvocationID.x;
    if (bucket >= push.buckets) {
        return;
    }
    uint begin = bucket > 0u ? buckets[bucket - 1u] : 0u;
    uint end = buckets[bucket];
    // Only the first ones are read as neighbours, so the rest need no order.
    uint sorted_end = min(end, begin + MOST_IN_BUCKET);
    for (uint i = begin; i < end; ++i) {
        uint own = order[i];
        uint at = i;
        bool kept = i < sorted_end;
        if (!kept && ids[own] < ids[order[sorted_end - 1u]]) {
            at = sorted_end - 1u;
            order[i] = order[at];
            kept = true;
        }
        while (kept && at > begin && ids[order[at - 1u]] > ids[own]) {
            order[at] = order[at - 1u];
            --at;
        }
        order[at] = own;
    }
    for (uint i = begin; i < end; ++i) {
        uint own = order[i];
        heaped[i] = Heaped(balls[own], vec4(drifts[own].xyz, uintBitsToFloat(ids[own])),
                           vec4(spins[own].xyz, uintBitsToFloat(own)));
    }
}
