#version 460
// Pass `march` of the density grid: sums the voxels of each ray, in the bricks that have particles.
// Reads: tiles, starts, cells, voxels, scene depth. Writes: thickness.

#include "view.glsl"
#include "tiles.glsl"
#include "push.glsl"
#include "voxels.glsl"
#include "march.glsl"

layout(set = 0, binding = 5, std430) readonly buffer Voxels { uint voxels[]; };

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uint tile = tile_of(gl_WorkGroupID.xy);
    uint near = tiles[4u * tile + NEAR];
    uint far = tiles[4u * tile + FAR];
    if (near >= far || any(greaterThanEqual(pixel, view.extent.xy))) {
        return;
    }
    uint at = pixel.y * view.extent.x + pixel.x;
    float sum = thickness[at];
    float end = scene[at];
    float place = sample_place(pixel);
    int samples = int(view.samples.x);
    uint cell = starts[tile];
    uint brick = cell > 0u ? cells[cell - 1u] : 0u;
    for (uint slab = near; slab < far && cell < push.cells; ++slab, ++cell) {
        uint next = min(cells[cell], push.capacity);
        if (next > brick) {
            float depth = slab_depth(slab);
            float dz = (slab_depth(slab + 1u) - depth) / float(samples);
            if (depth >= end || sum >= view.lens.w) {
                break;
            }
            int before = int(clamp(ceil((end - depth) / dz - place), 0.0, float(samples)));
            for (int k = 0; k < before; ++k) {
                sum += float(voxels[voxel_of(brick, uint(k), pixel)]) / STEPS;
            }
        }
        brick = next;
    }
    thickness[at] = sum;
}
