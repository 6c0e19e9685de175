#version 460
// Pass `split`, last part: the arguments of `composite`, for tiles of each kind, where the frame was smoothed at
// the configured level alone and where it was not. Not in the source.
// Reads: lengths, levels. Writes: arguments: eight draws, then eight dispatches of groups of 8x8 pixels.

#include "frame.glsl"
#include "level.glsl"

layout(local_size_x = 1) in;

layout(set = 0, binding = 1, std430) readonly buffer Lengths { uint lengths[4]; };
layout(set = 0, binding = 2, std430) writeonly buffer Arguments { uvec4 arguments[]; };

// Tiles in the second dimension of a dispatch.
const uint ROW = 64u;

void main() {
    Level level = levels.level[0];
    bool configured = level.texel.w == 1.0 && level.texel.z == frame.thick_extent.w;
    uint blocks = 2u * uint(levels.level[finer_level()].texel.z);
    for (uint i = 0u; i < 8u; ++i) {
        uint n = configured == (i < 4u) ? lengths[i & 3u] : 0u;
        arguments[i] = uvec4(4u, n, 0u, 0u);
        arguments[8u + i] = uvec4(blocks * blocks, min(n, ROW), (n + ROW - 1u) / ROW, n);
    }
}
