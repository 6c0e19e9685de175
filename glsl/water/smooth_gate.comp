#version 460
// Pass `smooth`, form Query: converts the number of active pixels that a query counted in one block of iterations to
// the predicate of the next block: 1 if there are any, otherwise 0. (The predicate is not the number itself, because
// it also serves as a draw count, which devices limit.) The thesis decides on the CPU (Sec. 4.7, Listing A.11).
// Reads: query results. Writes: predicates.

layout(local_size_x = 1) in;

layout(set = 0, binding = 1, std430) readonly buffer Results { uint results[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Predicates { uint predicates[]; };

layout(push_constant, std430) uniform Push { uint block; } push;

void main() {
    predicates[(push.block + 1u) * 64u] = min(results[push.block], 1u);
}
