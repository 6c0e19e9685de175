#version 460
// Passes `gaps` and `back`: the farthest or the nearest boundary (depth that separates two layers of water) in each
// block of 16x16 pixels, so that most spheres need not read the texels of the block. Not in the thesis. Reads:
// boundaries. Writes: blocks.

#include "frame.glsl"
#include "sheets.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// 0: the farthest boundary of the block, or 0 if it has none. 1: the nearest boundary, or EMPTY if it has none.
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
