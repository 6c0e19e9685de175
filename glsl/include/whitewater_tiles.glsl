// List of the tiles of 8x8 pixels that show whitewater particles, and arguments of the dispatch over these tiles,
// with one group per tile. Needs frame.glsl.
// Reads, writes: tiles.

// Words 0 to 2 are the numbers of workgroups in x, y, z of an indirect dispatch, word 3 is the number of listed
// tiles, and from word 4 on come the tiles' indices, counted row by row over the screen.
layout(set = 0, binding = 9, std430) buffer Tiles { uint tiles[]; };

const uint FIRST_TILE = 4u;
const uint MOST_GROUPS = 65535u; // limit of a dispatch, on each axis

uint tiles_across() {
    return (uint(frame.extent.x) + 7u) / 8u;
}

void add_tile(uvec2 tile) {
    uint slot = atomicAdd(tiles[3], 1u);
    tiles[FIRST_TILE + slot] = tile.y * tiles_across() + tile.x;
    atomicMax(tiles[0], min(slot + 1u, MOST_GROUPS));
    atomicMax(tiles[1], 1u + slot / MOST_GROUPS);
}

// Finds the pixel of this invocation in the 8x8 tile that its workgroup processes. False if the workgroup has no tile
// or the pixel is outside the picture.
bool tile_pixel(out ivec2 pixel) {
    uint slot = gl_WorkGroupID.y * MOST_GROUPS + gl_WorkGroupID.x;
    bool listed = slot < tiles[3];
    uint tile = tiles[FIRST_TILE + (listed ? slot : 0u)];
    pixel = ivec2(8u * uvec2(tile % tiles_across(), tile / tiles_across()) + gl_LocalInvocationID.xy);
    return listed && all(lessThan(pixel, ivec2(frame.extent.xy)));
}
