#version 460
// Pass `tiles`: number of slabs from each tile's first to its last slab with particles.
// Reads: tiles. Writes: starts.

#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Starts { uint starts[]; };

void main() {
    uint tile = gl_GlobalInvocationID.x;
    if (tile < view.extent.z * view.extent.w) {
        uint near = tiles[4u * tile + NEAR];
        uint far = tiles[4u * tile + FAR];
        starts[tile] = far > near ? far - near : 0u;
    }
}
