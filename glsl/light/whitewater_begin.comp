#version 460
// Passes `whitewater_light` and `near`, first part: computes the arguments of the indirect dispatches over the
// whitewater particles. Not in the paper.
// Reads: count. Writes: arguments.

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, std430) readonly buffer Count { uint count; };
// For each chunk the arguments of an indirect dispatch (xyz) and the number of particles (w).
layout(set = 0, binding = 2, std430) writeonly buffer Arguments { uvec4 arguments[]; };

layout(push_constant, std430) uniform Push {
    uint count;      // number from the host, or the capacity
    uint from_gpu;
    uint chunks;
    uint chunk_size;
    uint group_size;
} push;

#include "whitewater_chunks.glsl"

void main() {
    uint chunk = gl_GlobalInvocationID.x;
    if (chunk < push.chunks) {
        uint own = own_of(chunk);
        arguments[chunk] = uvec4((own + push.group_size - 1u) / push.group_size, 1u, 1u, own);
    }
}
