#version 460
// Pass `level`: repeats the reduction of pass `reduce` for each level of the smoothing (resolution) that is coarser
// than the configured one, in tiles whose water is near enough to need that level. Not in the thesis, whose limit on
// the number of iterations leaves near water rough.
// Reads: levels, depth (occluded pixels emptied), marks and list of the levels' tiles. Writes: both smoothing images,
// plan, work of the levels' tiles.

#include "frame.glsl"
#include "plan.glsl"
#include "level.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 1) const uint RULE = 1;

layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D smooth_a;
layout(set = 0, binding = 4, r32f) uniform writeonly image2D smooth_b;
layout(set = 0, binding = 5, r32ui) uniform writeonly uimage2D plan;
layout(set = 0, binding = 6, std430) buffer Tiles { uint tile_work[]; };
layout(set = 0, binding = 8, std430) readonly buffer Counts { Marked marked; };
layout(set = 0, binding = 9, std430) readonly buffer List { uint list[]; };

#include "block.glsl"
#include "reduction.glsl"

shared uint most;

void main() {
    uint slot = gl_WorkGroupID.y * MOST_GROUPS + gl_WorkGroupID.x;
    if (slot >= marked.count) {
        return;
    }
    uint index = list[slot];
    uint mark = tile_work[index];
    ivec2 corner = ivec2(int(index) % levels.atlas.z, int(index) / levels.atlas.z) * 16;
    uint level = level_of(corner);
    Level own = levels.level[level];
    int edge = int(own.texel.z);
    if (gl_LocalInvocationIndex == 0u) {
        most = 0u;
    }
    barrier();
    ivec2 block = corner - own.rect.xy + ivec2(gl_LocalInvocationID.xy);
    if (all(lessThan(block, own.rect.zw))) {
        // `mark` is 2 in tiles that need this level. Other tiles, which only neighbour one of these, are filled with
        // EMPTY: they do not contribute to the smoothing.
        float z = EMPTY;
        ivec2 end = mark == 2u ? min((block + 1) * edge, ivec2(frame.extent.xy)) : ivec2(0);
        for (int y = block.y * edge; y < end.y; ++y) {
            for (int x = block.x * edge; x < end.x; ++x) {
                z = min(z, imageLoad(depth, ivec2(x, y)).x);
            }
        }
        z = block_depth(block * edge, end, z);
        uint planned = plan_pixel(z, vec2(block), own, level, false, level == uint(levels.atlas.w));
        ivec2 p = own.rect.xy + block;
        imageStore(smooth_a, p, vec4(z));
        imageStore(smooth_b, p, vec4(z));
        imageStore(plan, p, uvec4(planned));
        if (planned > 0u) {
            atomicMax(most, plan_count(planned) + 1u);
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        tile_work[index] = most;
    }
}
