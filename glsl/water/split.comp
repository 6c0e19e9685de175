#version 460
// Pass `split`: the tiles with water again, those of one sheet and those that hold a boundary apart,
// so that `composite` can shade the first with a shader that knows of one sheet alone.
// Not in the source.
// Reads: tile list and arguments, levels, boundaries. Writes: both lists, their lengths.

#include "frame.glsl"
#include "level.glsl"
#include "sheets.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 2, std430) readonly buffer Arguments { uvec4 arguments[]; };
// The second list begins in the middle.
layout(set = 0, binding = 3, std430) writeonly buffer Lists { uint lists[]; };
layout(set = 0, binding = 4, std430) buffer Lengths { uint lengths[2]; };

layout(push_constant, std430) uniform Push { uint tiles; } push; // at most

shared uint two;

void split(uint tile) {
    ivec2 texel = ivec2(tile % uint(levels.atlas.z), tile / uint(levels.atlas.z)) * 16;
    uint own = level_of(texel);
    // Others are not shaded.
    if (own != finer_level()) {
        return;
    }
    if (gl_LocalInvocationIndex == 0u) {
        two = 0u;
    }
    barrier();
    // A tile is 16 texels wide; one more to each side, which what is in front may be widened by.
    ivec4 rect = levels.level[own].rect;
    float edge = levels.level[own].texel.z;
    vec2 corner = vec2(texel - rect.xy) * edge;
    float scale = 1.0 / frame.thick_extent.z;
    ivec2 first = max(ivec2(floor((corner - edge) * scale)), ivec2(0));
    ivec2 last = min(ivec2(floor((corner + 17.0 * edge) * scale)), ivec2(frame.thick_extent.xy) - 1);
    last = SHEETS == 1u ? first - 1 : last;
    bool found = false;
    for (int y = first.y + int(gl_LocalInvocationID.y); y <= last.y; y += 8) {
        for (int x = first.x + int(gl_LocalInvocationID.x); x <= last.x; x += 8) {
            found = found || boundary_of(ivec2(x, y)) < EMPTY;
        }
    }
    if (found) {
        two = 1u;
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        lists[two * push.tiles + atomicAdd(lengths[two], 1u)] = tile;
    }
    barrier();
}

void main() {
    uint tiles = arguments[258].w;
    uint i = gl_WorkGroupID.x;
    // The condition last, as in smooth.comp.
    do {
        split(list[i]);
        i += gl_NumWorkGroups.x;
    } while (i < tiles);
}
