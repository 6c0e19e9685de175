#version 460
// Pass `reduce`: rejects water behind the scene, takes for each block of pixels the depth of the nearest surface (but
// not of a single drop), and plans the smoothing of that depth: the number of iterations and the step size, fixed
// from here on (thesis Sec. 3.1, Listing A.12).
// Reads: depth, scene depth, levels, images of beside.glsl. Writes: depth (occluded pixels emptied); of the first
// level both smoothing images, plan, work of its tiles.

#include "frame.glsl"
#include "plan.glsl"
#include "level.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 0) const uint LEVEL = 1;
layout(constant_id = 1) const uint RULE = 1;

layout(set = 0, binding = 1, r32f) uniform image2D depth;
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D smooth_a;
layout(set = 0, binding = 4, r32f) uniform writeonly image2D smooth_b;
layout(set = 0, binding = 5, r32ui) uniform writeonly uimage2D plan;
// Work of each tile. Bits 0 to 15: 0 if there is nothing to shade in the tile, otherwise one more than the tile's max
// number of iterations. So they are 1 in a tile in which nothing is smoothed, such as one without water that shows
// foam, spray, whitewater particles or bubble foam. Bits 16 to 23: the coarsest smoothing level that the tile's water
// needs, 0 for the first. Bit 24: 1 if a level coarser than the first may be visible in the tile.
layout(set = 0, binding = 6, std430) writeonly buffer Tiles { uint tile_work[]; };

#include "surface_foam_texels.glsl"
#include "beside.glsl"
#include "block.glsl"
#include "reduction.glsl"

shared uint most;
shared uint nearest_bits;

// The depth that represents a block of pixels for the smoothing: that of its nearest water in front of the scene,
// single drops ignored. `best` is the nearest depth, drops included; `other` tells whether something other than water
// is drawn in the block.
float reduced(ivec2 block, out float best, out bool other) {
    ivec2 extent = ivec2(frame.extent.xy);
    other = foam_beside(block << LEVEL, 1 << LEVEL);
    best = EMPTY;
    for (int y = 0; y < (1 << LEVEL); ++y) {
        for (int x = 0; x < (1 << LEVEL); ++x) {
            ivec2 pixel = (block << LEVEL) + ivec2(x, y);
            if (pixel.x >= extent.x || pixel.y >= extent.y) {
                continue;
            }
            float z = imageLoad(depth, pixel).x;
            other = other || spray_at(pixel);
            if (z < EMPTY) {
                float scene = eye_depth(texelFetch(scene_depth, scene_texel(vec2(pixel) + 0.5), 0).x);
                // With a reversed infinite depth, infinity is 1/0, or negative by rounding.
                if (scene > 0.0 && z >= scene) {
                    imageStore(depth, pixel, vec4(EMPTY));
                } else {
                    best = min(best, z);
                }
            }
        }
    }
    // A surface counts as a drop if it covers less than a quarter of those pixels of the block that show water, so a
    // block of up to four pixels has none.
    return LEVEL < 2u ? best : block_depth(block << LEVEL, min((block + 1) << LEVEL, extent), best);
}

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        nearest_bits = 0u;
        most = 0u;
    }
    barrier();
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(block, ivec2(frame.extent.zw)))) {
        float nearest;
        bool other;
        float z = reduced(block, nearest, other);
        uint planned = plan_pixel(z, vec2(block), levels.level[0], 0u, true, levels.atlas.w == 0);
        imageStore(smooth_a, block, vec4(z));
        imageStore(smooth_b, block, vec4(z));
        imageStore(plan, block, uvec4(planned));
        // A tile's work is its iterations + 1, because a tile with nothing to smooth still has to be shaded.
        if (z < EMPTY || other) {
            atomicMax(most, plan_count(planned) + 1u);
        }
        float near = nearness(nearest, ray_slope(vec2(block) + 0.5, levels.level[0].slope));
        if (levels.atlas.w > 0 && near >= 0.8) {
            atomicMax(nearest_bits, floatBitsToUint(near));
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        float near = uintBitsToFloat(nearest_bits);
        uint coarsest = near < 0.8 ? 0u : min(uint(0.5 * log2(1.25 * near)) + 1u, uint(levels.atlas.w));
        // A coarser level shows from a nearness of 1 on. The limit is 0.9, because a pixel's ray may be almost a
        // texel away from its block's.
        uint shows = near < 0.9 ? 0u : 1u;
        tile_work[gl_WorkGroupID.y * levels.atlas.z + gl_WorkGroupID.x] = most | coarsest << 16 | shows << 24;
    }
}
