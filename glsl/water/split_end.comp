#version 460
// Pass `split`, last part: the arguments of `composite`, for tiles of each kind. Not in the thesis.
// Reads: lengths, levels. Writes: arguments: eight draws, then eight dispatches of groups of 8x8 pixels.

#include "frame.glsl"
#include "level.glsl"

layout(local_size_x = 1) in;

layout(set = 0, binding = 1, std430) readonly buffer Lengths { uint lengths[8]; };
layout(set = 0, binding = 2, std430) writeonly buffer Arguments { uvec4 arguments[]; };

// Size of the second dimension of a dispatch in tiles.
const uint ROW = 64u;

void main() {
    uint blocks = 2u * uint(levels.level[0].texel.z);
    for (uint i = 0u; i < 8u; ++i) {
        uint n = lengths[i];
        arguments[i] = uvec4(4u, n, 0u, 0u);
        arguments[8u + i] = uvec4(blocks * blocks, min(n, ROW), (n + ROW - 1u) / ROW, n);
    }
}
