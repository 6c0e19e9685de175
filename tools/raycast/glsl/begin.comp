#version 460
// Pass `prepare`, first part: marks each tile as empty, and finds the farthest depth of the scene in it.
// Reads: scene depth. Writes: tiles.

#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, std430) readonly buffer Scene { float scene[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Tiles { uint tiles[]; };

void main() {
    uint tile = gl_GlobalInvocationID.x;
    if (tile >= view.extent.z * view.extent.w) {
        return;
    }
    uvec2 first = TILE * uvec2(tile % view.extent.z, tile / view.extent.z);
    uvec2 end = min(first + TILE, view.extent.xy);
    float farthest = 0.0;
    for (uint y = first.y; y < end.y; ++y) {
        for (uint x = first.x; x < end.x; ++x) {
            farthest = max(farthest, scene[y * view.extent.x + x]);
        }
    }
    tiles[4u * tile + NEAR] = 0xffffffffu;
    tiles[4u * tile + FAR] = 0u;
    tiles[4u * tile + SCENE] = floatBitsToUint(farthest);
    tiles[4u * tile + SCENE_SLAB] = slabs_between(0.0, farthest).y;
}
