#version 460
// Pass `split`: sorts the tiles to shade, which are the listed tiles of the first level, by three properties: two
// layers of water, foam, and a visible coarser level of the smoothing. So `composite` can shade each of the eight
// kinds with the simplest shader that suffices. Not in the thesis.
// Reads: tile list and arguments, work, levels, boundaries, foam depth and thickness. Writes: eight lists, their
// lengths.

#include "frame.glsl"
#include "level.glsl"
#include "sheets.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// 1: there may be foam; otherwise it is not read.
layout(constant_id = 9) const uint FOAM = 0;

layout(set = 0, binding = 1, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 2, std430) readonly buffer Arguments { uvec4 arguments[]; };
// Eight lists of tiles, each with room for all tiles. 0: one layer of water; 1: two layers; 2, 3: the same with
// foam; 4 to 7: as 0 to 3, with coarser levels of the smoothing that may show.
layout(set = 0, binding = 3, std430) writeonly buffer Lists { uint lists[]; };
layout(set = 0, binding = 4, std430) buffer Lengths { uint lengths[8]; };
layout(set = 0, binding = 5) uniform sampler2D foam_depth;
layout(set = 0, binding = 6) uniform sampler2D foam_thickness;
layout(set = 0, binding = 8, std430) readonly buffer Tiles { uint tile_work[]; };

layout(push_constant, std430) uniform Push { uint tiles; } push; // number of tiles

shared uint kind;

void split(uint tile) {
    ivec2 texel = ivec2(tile % uint(levels.atlas.z), tile / uint(levels.atlas.z)) * 16;
    // Only tiles of the first level, which covers the picture, are shaded.
    if (any(greaterThanEqual(texel, levels.level[0].rect.zw))) {
        return;
    }
    uint near = tile_work[tile] >> 24;
    if (gl_LocalInvocationIndex == 0u) {
        kind = near << 2;
    }
    barrier();
    // The area examined is 16 texels wide, plus on each side one texel of the coarsest visible level, by which near
    // surfaces may be widened. It includes the thickness texels beside the tile, which are needed for interpolation.
    float edge = levels.level[0].texel.z;
    float wider = near == 0u ? edge : edge * exp2(float(tile_work[tile] >> 16 & 255u));
    vec2 corner = vec2(texel) * edge;
    float scale = 1.0 / frame.thick_extent.z;
    ivec2 first = max(ivec2(floor((corner - wider) * scale)), ivec2(0));
    ivec2 last = min(ivec2(floor((corner + 16.0 * edge + wider) * scale)), ivec2(frame.thick_extent.xy) - 1);
    last = SHEETS == 1u && FOAM == 0u ? first - 1 : last;
    uint found = 0u;
    for (int y = first.y + int(gl_LocalInvocationID.y); y <= last.y; y += 8) {
        for (int x = first.x + int(gl_LocalInvocationID.x); x <= last.x; x += 8) {
            ivec2 p = ivec2(x, y);
            if (SHEETS == 2u && boundary_of(p) < EMPTY) {
                found |= 1u;
            }
            // A texel has foam if the depth or the thickness shows it: the sprites of the depth are narrower, and a
            // thickness below one step is stored as 0.
            if (FOAM == 1u && (texelFetch(foam_depth, p, 0).x < EMPTY || texelFetch(foam_thickness, p, 0).x > 0.0)) {
                found |= 2u;
            }
        }
    }
    if (found > 0u) {
        atomicOr(kind, found);
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        lists[kind * push.tiles + atomicAdd(lengths[kind], 1u)] = tile;
    }
    barrier();
}

void main() {
    uint tiles = arguments[258].w;
    uint i = gl_WorkGroupID.x;
    // The condition is at the end, as in smooth.comp.
    do {
        split(list[i]);
        i += gl_NumWorkGroups.x;
    } while (i < tiles);
}
