#version 460
// Pass `gaps`, third part: for each cell the middle of the air in front of the last body of water that is behind air, or
// in front of the first drop if there is no such body. Both walls of a crown are thus one layer, and the pool behind them
// the other. Not in the thesis.
// Reads: nearest, marks. Writes: boundaries of the cells.

#include "frame.glsl"
#include "gaps.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Found { float found[]; };

layout(push_constant, std430) uniform Push {
    int columns;
    int rows;
} push;

float boundary_of(uint cell) {
    uint marks = cells[uint(push.columns * push.rows) + cell];
    int middle = 0; // doubled
    // There is always an end behind the marks, because shifts bring zeros.
    int air = findLSB(~marks);
    while (air > 0 && air < 32 && (marks >> air) != 0u) {
        int water = air + findLSB(marks >> air);
        int end = water + findLSB(~(marks >> water));
        bool body = end - water >= BODY || end == 32;
        middle = body || middle == 0 ? air + water : middle;
        air = end;
    }
    return middle > 0 ? uintBitsToFloat(cells[cell]) + float(middle) * (0.5 * SLICE * frame.particle.y)
                      : EMPTY;
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (p.x >= push.columns || p.y >= push.rows) {
        return;
    }
    uint cell = uint(p.y * push.columns + p.x);
    found[cell] = boundary_of(cell);
}
