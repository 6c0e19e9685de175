// Tiles of the picture: four words of each are the first slab with particles, the one after the last, bits of the
// farthest depth of the scene, and the slab of that. Their slabs are cells, in one row: those of a tile from `starts`
// on. Needs view.glsl.

const uint NEAR = 0u;
const uint FAR = 1u;
const uint SCENE = 2u;
const uint SCENE_SLAB = 3u;

uint tile_of(uvec2 tile) {
    return tile.y * view.extent.z + tile.x;
}
