#version 460
// Passes `gaps` and `back`: computes for each block of 16x16 pixels the farthest (`gaps`) or the nearest (`back`)
// boundary, which is the depth that separates two layers of water. Most spheres are compared only with this value,
// not with every texel of the block. Not in the thesis. Reads: boundaries. Writes: blocks.

#include "frame.glsl"
#include "sheets.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// What is stored for a block of pixels. 0: its farthest boundary between two layers of water, or 0 if it has none. 1:
// its nearest boundary, or EMPTY if it has none.
layout(constant_id = 0) const uint NEAREST = 0;

layout(set = 0, binding = 1, std430) writeonly buffer Blocks { float blocks[]; };

void main() {
    ivec2 extent = ivec2(frame.extent.xy);
    ivec2 size = (extent + BLOCK - 1) / BLOCK;
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block, size))) {
        return;
    }
    int edge = BLOCK / int(frame.thick_extent.z);
    ivec2 first = block * edge;
    ivec2 last = min(first + edge, ivec2(frame.thick_extent.xy)) - 1;
    float best = NEAREST == 1u ? EMPTY : 0.0;
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            float boundary = boundary_of(ivec2(x, y));
            best = NEAREST == 1u ? min(best, boundary) : boundary < EMPTY ? max(best, boundary) : best;
        }
    }
    blocks[block.y * size.x + block.x] = best;
}
