#version 460
// Pass `level`: the reduction again, for each level in use that is coarser than the configured
// one. Not in the source. Reads: levels, depth (occluded pixels emptied). Writes: both smoothing images,
// plan, work of the level's tiles.

#include "frame.glsl"
#include "plan.glsl"
#include "level.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 1) const uint RULE = 1;

layout(set = 0, binding = 1, r32f) uniform readonly image2D depth;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D smooth_a;
layout(set = 0, binding = 4, r32f) uniform writeonly image2D smooth_b;
layout(set = 0, binding = 5, r32ui) uniform writeonly uimage2D plan;
layout(set = 0, binding = 6, std430) writeonly buffer Tiles { uint tile_work[]; };

#include "foam_texels.glsl"
#include "beside.glsl"
#include "block.glsl"
#include "reduction.glsl"

shared uint most;

void main() {
    Level level = levels.level[gl_WorkGroupID.z];
    int edge = int(level.texel.z);
    bool configured = level.texel.z == frame.thick_extent.w;
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 16;
    if (level.texel.w == 0.0 || configured || any(greaterThanEqual(corner, level.rect.zw))) {
        return;
    }
    if (gl_LocalInvocationIndex == 0u) {
        most = 0u;
    }
    barrier();
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(block, level.rect.zw))) {
        ivec2 end = min((block + 1) * edge, ivec2(frame.extent.xy));
        float z = EMPTY;
        bool other = foam_beside(block * edge, edge);
        for (int y = block.y * edge; y < end.y; ++y) {
            for (int x = block.x * edge; x < end.x; ++x) {
                z = min(z, imageLoad(depth, ivec2(x, y)).x);
                other = other || spray_at(ivec2(x, y));
            }
        }
        z = block_depth(block * edge, end, z);
        float count;
        uint planned = plan_pixel(z, ray_slope(vec2(block) + 0.5, level.slope), level.texel.xy, count);
        ivec2 p = level.rect.xy + block;
        imageStore(smooth_a, p, vec4(z));
        imageStore(smooth_b, p, vec4(z));
        imageStore(plan, p, uvec4(planned));
        if (z < EMPTY || other) {
            atomicMax(most, plan_count(planned) + 1u);
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        ivec2 tile = level.rect.xy / 16 + ivec2(gl_WorkGroupID.xy);
        tile_work[tile.y * levels.atlas.z + tile.x] = most;
    }
}
