#version 460
// Pass `march` of the kernel ray-caster: sums the kernels of nearby particles at each sample of a ray (Ihmsen et al.
// 2012, Sec. 5). Each particle of a cell is visited once, and only the samples that lie in it are evaluated.
// Reads: records, tiles, starts, cells, entries, scene depth. Writes: thickness.

#include "view.glsl"
#include "tiles.glsl"
#include "ball.glsl"
#include "kernel.glsl"
#include "push.glsl"
#include "march.glsl"

layout(set = 0, binding = 5, std430) readonly buffer Entries { uint entries[]; };

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
    vec2 slope = (vec2(pixel) + 0.5) * view.slope.xy + view.slope.zw;
    float place = sample_place(pixel);
    int samples = int(view.samples.x);
    uint cell = starts[tile];
    uint begin = cell > 0u ? cells[cell - 1u] : 0u;
    for (uint slab = near; slab < far && cell < push.cells; ++slab, ++cell) {
        uint stop = min(cells[cell], push.capacity);
        if (stop > begin) {
            float depth = slab_depth(slab);
            float dz = (slab_depth(slab + 1u) - depth) / float(samples);
            float first = depth + place * dz;
            if (depth >= end || sum >= view.lens.w) {
                break;
            }
            int before = int(clamp(ceil((end - first) / dz), 0.0, float(samples)));
            float slab_sum = 0.0;
            for (uint entry = begin; entry < stop; ++entry) {
                uint i = entries[entry];
                vec4 where = records[2u * i];
                float inverse = 1.0 / where.w;
                float rest = rest_of(where.xyz, inverse, slope);
                float t = (first - where.z) * inverse;
                float dt = dz * inverse;
                // The ray misses most particles of the cell. As a loop without turns, a miss lets a CPU skip the body.
                ivec2 inside = samples_in(rest, t, dt, before);
                for (int k = inside.x; k <= inside.y; ++k) {
                    float q = t + float(k) * dt;
                    slab_sum += kernel_at(records[2u * i + 1u].xyz, max(rest - q * q, 0.0));
                }
            }
            sum += dz * slab_sum;
        }
        begin = stop;
    }
    thickness[at] = sum;
}
