#version 460
// Pass `gaps`, fourth part: dilates the airs (depth ranges without water between two layers): a cell without an air
// takes the airs of a cell beside it or, if those have none, of a diagonal neighbour. Not in the thesis. Reads: airs.
// Writes: airs, dilated.

#include "frame.glsl"
#include "gaps.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, std430) readonly buffer Airs { uint airs[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Spread { uint spread[]; };

layout(push_constant, std430) uniform Push {
    int columns;
    int rows;
} push;

const ivec2 AROUND[8] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1), ivec2(-1), ivec2(1, -1), ivec2(-1, 1),
                                ivec2(1));

bool has_air(uint cell) {
    return (airs[AIR_WORDS * cell + 1u] >> 8) != 0u;
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (p.x >= push.columns || p.y >= push.rows) {
        return;
    }
    uint own = uint(p.y * push.columns + p.x);
    uint from = own;
    for (int i = 0; i < 8 && !has_air(from); ++i) {
        ivec2 q = p + AROUND[i];
        bool inside = all(greaterThanEqual(q, ivec2(0))) && q.x < push.columns && q.y < push.rows;
        from = inside ? uint(q.y * push.columns + q.x) : from;
    }
    // The sign of the cell's nearest depth marks airs that were taken from another cell.
    spread[AIR_WORDS * own] = airs[AIR_WORDS * from] | (from == own ? 0u : 0x80000000u);
    for (uint i = 1u; i < AIR_WORDS; ++i) {
        spread[AIR_WORDS * own + i] = airs[AIR_WORDS * from + i];
    }
}
