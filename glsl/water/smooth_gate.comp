#version 460
// Pass `smooth`, form Query: converts one block's sample count to the next block's predicate, 0 or 1. (It is never the
// count itself, because it also serves as a draw count, which devices limit.) The thesis decides on the CPU (Sec. 4.7,
// Listing A.11).
// Reads: query results. Writes: predicates.

layout(local_size_x = 1) in;

layout(set = 0, binding = 1, std430) readonly buffer Results { uint results[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Predicates { uint predicates[]; };

layout(push_constant, std430) uniform Push { uint block; } push;

void main() {
    predicates[(push.block + 1u) * 64u] = min(results[push.block], 1u);
}
