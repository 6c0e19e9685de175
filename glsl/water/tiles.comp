#version 460
// Pass `tiles`: sorts the tiles with work by iteration count, largest first, so that the tiles still active in
// iteration i are a prefix of the list; writes the arguments of every iteration's dispatch. A tile has work if it
// holds water that is smoothed or shaded, and also if it shows only foam, spray, whitewater particles or bubble foam,
// which `composite` shades without smoothing. A counting sort by one workgroup. Not in the thesis.
// Reads: work of every tile (maximum iterations + 1, or 0 for no work), levels. Writes: list, arguments.

#include "frame.glsl"
#include "level.glsl"

layout(local_size_x = 256) in;

layout(set = 0, binding = 1, std430) readonly buffer Tiles { uint tile_work[]; };
layout(set = 0, binding = 2, std430) writeonly buffer List { uint list[]; };
// Arguments of indirect commands. [0]: a draw of all n tiles with work (4, n, 0, 0). [1] to [257]: dispatches {x, 1,
// 1, n} of each iteration over n tiles. [258]: a dispatch over all tiles with work.
layout(set = 0, binding = 3, std430) writeonly buffer Arguments { uvec4 arguments[]; };

layout(push_constant, std430) uniform Push {
    uint tiles;
    uint most_groups;
} push;

// Work of a tile; 0 for tiles that no level covers.
uint work_of(uint tile) {
    ivec2 corner = ivec2(int(tile) % levels.atlas.z, int(tile) / levels.atlas.z) * 16;
    return level_of(corner) < LEVELS ? tile_work[tile] & 0xffffu : 0u;
}

shared uint histogram[512];
shared uint first[512];

void main() {
    uint lane = gl_LocalInvocationIndex;
    histogram[lane] = 0u;
    histogram[lane + 256u] = 0u;
    barrier();
    for (uint i = lane; i < push.tiles; i += 256u) {
        uint n = work_of(i);
        if (n > 0u) {
            atomicAdd(histogram[n], 1u);
        }
    }
    barrier();
    if (lane == 0u) {
        uint sum = 0u;
        for (int n = 511; n >= 0; --n) {
            first[n] = sum;
            sum += histogram[n];
        }
        arguments[0] = uvec4(4u, sum, 0u, 0u);
        arguments[258] = uvec4(min(sum, push.most_groups), 1u, 1u, sum);
    }
    barrier();
    // Iteration i, from 1, runs the tiles that need at least max(i - 1, 1) iterations. The one iteration more than
    // needed copies all pixels of a tile, so that both images hold the result.
    for (uint i = lane + 1u; i <= 257u; i += 256u) {
        uint least = max(i, 2u);
        uint n = first[least] + histogram[least];
        arguments[i] = uvec4(min(n, push.most_groups), 1u, 1u, n);
    }
    barrier();
    for (uint i = lane; i < push.tiles; i += 256u) {
        uint n = work_of(i);
        if (n > 0u) {
            list[atomicAdd(first[n], 1u)] = i;
        }
    }
}
