#version 460
// Pass `shoreline`, last part: joins neighbouring 8x8 tiles of a row that have foam on the host's water surface to
// runs. `composite` draws one quad per run, which costs much less set-up than one per tile. Each invocation handles
// LONGEST tiles of a row, and a run does not continue in the tiles of another invocation.
// Reads: marks. Writes: list of runs, arguments.

layout(local_size_x = 8, local_size_y = 8) in;

#include "shore_lists.glsl"
#include "shore_runs.glsl"

layout(set = 0, binding = 11, std430) readonly buffer Marks { uint marks[]; };

void main() {
    uint x = LONGEST * gl_GlobalInvocationID.x;
    uint first = gl_GlobalInvocationID.y * push.across + x;
    uint foams = 0u;
    for (uint i = 0u; i < LONGEST; ++i) {
        // Beyond the frame's last row no tile is marked.
        if (x + i < push.across && first + i < push.most && marks[first + i] != 0u) {
            foams |= 1u << i;
        }
    }
    int count = bitCount(foams & ~(foams << 1));
    if (count > 0) {
        uint slot = atomicAdd(arguments[1], uint(count));
        dispatches(RUNS, slot + uint(count) - 1u, 1u);
        for (; foams != 0u; ++slot) {
            int start = findLSB(foams);
            int tiles = findLSB(~(foams >> start));
            lists(RUNS, slot, run_of(first + uint(start), uint(tiles)));
            foams &= ~(((1u << tiles) - 1u) << start);
        }
    }
}
