#version 460
// Pass `count`: counts the particles that overlap each cell. With bricks, cells are only marked as occupied.
// Reads: records, tiles, starts. Writes: cells.

#include "view.glsl"
#include "tiles.glsl"
#include "ball.glsl"
#include "footprint.glsl"
#include "push.glsl"
#include "deposit.glsl"

layout(constant_id = 0) const uint BRICKS = 0;
layout(set = 0, binding = 4, std430) buffer Cells { uint cells[]; };

void visit(uint particle, uint cell) {
    if (BRICKS == 0u) {
        atomicAdd(cells[cell], 1u);
    } else if (cells[cell] == 0u) {
        atomicMax(cells[cell], 1u);
    }
}
