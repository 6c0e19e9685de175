#version 460
// Pass `fill` of the kernel ray-caster: lists the particles of each cell (counting sort). A cell's number is the index
// of its first entry before this pass, and the index after its last entry afterwards.
// Reads: records, tiles, starts, cells. Writes: cells, entries.

#include "view.glsl"
#include "tiles.glsl"
#include "ball.glsl"
#include "footprint.glsl"
#include "push.glsl"
#include "deposit.glsl"

layout(set = 0, binding = 4, std430) buffer Cells { uint cells[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Entries { uint entries[]; };

void visit(uint particle, uint cell) {
    uint place = atomicAdd(cells[cell], 1u);
    if (place < push.capacity) {
        entries[place] = particle;
    }
}
