// Voxels of the density grid: a column a pixel, a voxel a sample of its ray, in bricks of a tile's slab.
// Needs view.glsl.

// Steps of a thickness of 1.
const float STEPS = 65536.0;
// From here on nothing is added: no number of particles on one spot is too many.
const uint HALF_FULL = 2147483648u;

uint voxel_of(uint brick, uint k, uvec2 pixel) {
    uvec2 place = pixel % TILE;
    return ((brick * view.samples.x + k) * TILE + place.y) * TILE + place.x;
}
