// Tiles of the picture. Each has four words: the first slab with particles, the slab after the last one, the bits of
// the farthest scene depth, and the slab of that depth. The slabs of all tiles are cells in one row; those of a tile
// begin at its entry of `starts`. Needs view.glsl.

const uint NEAR = 0u;
const uint FAR = 1u;
const uint SCENE = 2u;
const uint SCENE_SLAB = 3u;

uint tile_of(uvec2 tile) {
    return tile.y * view.extent.z + tile.x;
}
