#version 460
// Pass `fill` of the kernel ray-caster: which particles each cell has (counting sort). Before it the number of a cell
// is where its particles begin, after it where they end.
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
