#version 460
// Pass `split`, last part: writes the indirect arguments of `composite` for each of the eight kinds of tiles. Not in
// the thesis. A draw has one quad per tile. A dispatch has several workgroups of 8x8 pixels per tile, because a tile
// is 16x16 texels of the first smoothing level.
// Reads: lengths of the lists, levels (width of a texel). Writes: arguments: eight draws, then eight dispatches.

#include "frame.glsl"
#include "level.glsl"

layout(local_size_x = 1) in;

layout(set = 0, binding = 1, std430) readonly buffer Lengths { uint lengths[8]; };
layout(set = 0, binding = 2, std430) writeonly buffer Arguments { uvec4 arguments[]; };

// Max number of tiles along the second dimension (y) of a dispatch; the third (z) counts rows of this many tiles.
const uint ROW = 64u;

void main() {
    uint blocks = 2u * uint(levels.level[0].texel.z);
    for (uint i = 0u; i < 8u; ++i) {
        uint n = lengths[i];
        arguments[i] = uvec4(4u, n, 0u, 0u);
        arguments[8u + i] = uvec4(blocks * blocks, min(n, ROW), (n + ROW - 1u) / ROW, n);
    }
}
