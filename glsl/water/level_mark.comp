#version 460
// Pass `level`, first part: marks, in each coarser level of the smoothing (resolution), the tiles with water near
// enough to need that level and the tiles beside them. One invocation per tile of the first level.
// Reads: levels, work of the tiles. Writes: marks and list of the coarser levels' tiles, levels needed.

#include "frame.glsl"
#include "level.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Word of each smoothing tile. For the finest level pass `reduce` wrote it (iterations, coarsest level needed). For a
// coarser level, until its tile is computed: 2 if something in the tile needs it, 1 next to such a tile, otherwise 0.
layout(set = 0, binding = 6, std430) buffer Tiles { uint tile_work[]; };
layout(set = 0, binding = 8, std430) buffer Counts { Marked marked; };
layout(set = 0, binding = 9, std430) writeonly buffer List { uint list[]; };

void mark(ivec2 own, uint coarsest) {
    for (uint i = 1u; i <= coarsest; ++i) {
        ivec4 rect = levels.level[i].rect;
        ivec2 over = own >> i;
        for (int k = 0; k < 9; ++k) {
            ivec2 at = over + ivec2(k % 3, k / 3) - 1;
            if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(16 * at, rect.zw))) {
                at += rect.xy / 16;
                uint tile = uint(at.y * levels.atlas.z + at.x);
                if (atomicMax(tile_work[tile], k == 4 ? 2u : 1u) == 0u) {
                    uint slot = atomicAdd(marked.count, 1u);
                    list[slot] = tile;
                    atomicMax(marked.groups[0], min(slot + 1u, MOST_GROUPS));
                    atomicMax(marked.groups[1], 1u + slot / MOST_GROUPS);
                }
            }
        }
    }
}

void main() {
    ivec2 own = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(16 * own, levels.level[0].rect.zw))) {
        return;
    }
    uint coarsest = tile_work[own.y * levels.atlas.z + own.x] >> 16 & 0xffu;
    if (coarsest > 0u) {
        atomicMax(marked.needed, coarsest);
        mark(own, coarsest);
    }
}
