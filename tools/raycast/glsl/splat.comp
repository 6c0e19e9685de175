#version 460
// Pass `splat` of the density grid: adds each particle to the voxels in it, in fixed point, so that the order of the
// particles cannot change a sum. The grid is that of Fraedrich et al. 2010: aligned with the view and in perspective.
// One invocation splats a small particle, the whole group a large one.
// Reads: records, tiles, starts, cells. Writes: voxels.

#include "view.glsl"
#include "tiles.glsl"
#include "ball.glsl"
#include "kernel.glsl"
#include "footprint.glsl"
#include "push.glsl"
#include "voxels.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 2, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 3, std430) readonly buffer Starts { uint starts[]; };
layout(set = 0, binding = 4, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 5, std430) buffer Voxels { uint voxels[]; };

// Most pixels that an invocation splats alone; larger particles are splatted by the whole group.
const int SMALL = 256;

shared uint large[gl_WorkGroupSize.x];
shared uint larges;

// Splats a pixel of a ball into one slab, whose samples begin at `depth` and are `dz` apart.
void splat(Ball ball, uvec2 pixel, uint slab, float depth, float dz) {
    float rest = rest_of(ball.centre, ball.inverse, (vec2(pixel) + 0.5) * view.slope.xy + view.slope.zw);
    uint tile = tile_of(pixel / TILE);
    uint near = tiles[4u * tile + NEAR];
    if (!(rest > 0.0) || slab < near || slab >= tiles[4u * tile + FAR]) {
        return;
    }
    uint cell = starts[tile] + slab - near;
    uint brick = cell > 0u ? cells[min(cell, push.cells) - 1u] : 0u;
    if (brick >= push.capacity || cell >= push.cells) {
        return;
    }
    float t = (depth + sample_place(pixel) * dz - ball.centre.z) * ball.inverse;
    float dt = dz * ball.inverse;
    ivec2 inside = samples_in(rest, t, dt, int(view.samples.x));
    for (int k = inside.x; k <= inside.y; ++k) {
        float q = t + float(k) * dt;
        uint steps = uint(min(dz * kernel_at(ball.kernel, max(rest - q * q, 0.0)) * STEPS + 0.5, 1.0e9));
        uint voxel = voxel_of(brick, uint(k), pixel);
        if (steps > 0u && atomicAdd(voxels[voxel], steps) >= HALF_FULL) {
            atomicAdd(voxels[voxel], 0u - steps);
        }
    }
}

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        larges = 0u;
    }
    barrier();
    uint i = gl_GlobalInvocationID.x;
    Ball ball = ball_of(min(i, max(push.count, 1u) - 1u));
    if (i < push.count && ball.radius > 0.0) {
        ivec4 box = pixels_of(ball.centre, ball.radius);
        ivec2 size = box.zw - box.xy + 1;
        if (size.x * size.y > SMALL) {
            large[atomicAdd(larges, 1u)] = i;
        } else {
            uvec2 slabs = slabs_between(ball.centre.z - ball.radius, ball.centre.z + ball.radius);
            for (uint slab = slabs.x; slab <= slabs.y; ++slab) {
                float depth = slab_depth(slab);
                float dz = (slab_depth(slab + 1u) - depth) / float(view.samples.x);
                for (int y = box.y; y <= box.w; ++y) {
                    for (int x = box.x; x <= box.z; ++x) {
                        splat(ball, uvec2(x, y), slab, depth, dz);
                    }
                }
            }
        }
    }
    barrier();
    ivec2 lane = ivec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
    for (uint j = 0u; j < larges; ++j) {
        Ball one = ball_of(large[j]);
        ivec4 box = pixels_of(one.centre, one.radius);
        uvec2 slabs = slabs_between(one.centre.z - one.radius, one.centre.z + one.radius);
        for (uint slab = slabs.x; slab <= slabs.y; ++slab) {
            float depth = slab_depth(slab);
            float dz = (slab_depth(slab + 1u) - depth) / float(view.samples.x);
            for (int y = box.y + lane.y; y <= box.w; y += 8) {
                for (int x = box.x + lane.x; x <= box.z; x += 8) {
                    splat(one, uvec2(x, y), slab, depth, dz);
                }
            }
        }
    }
}
