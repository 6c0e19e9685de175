// Voxels of the density grid: one column per pixel, one voxel per ray sample. A brick holds the voxels of one slab of a
// tile. Needs view.glsl.

// Fixed-point steps per unit of thickness.
const float STEPS = 65536.0;
// Saturation: a voxel at this value takes no more, so that any number of particles on one spot cannot overflow.
const uint HALF_FULL = 2147483648u;

uint voxel_of(uint brick, uint k, uvec2 pixel) {
    uvec2 place = pixel % TILE;
    return ((brick * view.samples.x + k) * TILE + place.y) * TILE + place.x;
}
