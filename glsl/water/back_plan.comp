#version 460
// Pass `back`, last part: enters the back layer (the farther of two layers of water) in the levels of the smoothing:
// in its first level unchanged, in each coarser level that is needed as the nearest depth of each block of texels.
// Not in the thesis.
// Reads: back, levels, levels needed. Writes: both smoothing images, plan, work of the levels' tiles.

#include "frame.glsl"
#include "plan.glsl"
#include "level.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 1) const uint RULE = 1;

layout(set = 0, binding = 1, r32f) uniform readonly image2D back;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D smooth_a;
layout(set = 0, binding = 4, r32f) uniform writeonly image2D smooth_b;
layout(set = 0, binding = 5, r32ui) uniform writeonly uimage2D plan;
layout(set = 0, binding = 6, std430) writeonly buffer Tiles { uint tile_work[]; };
layout(set = 0, binding = 8, std430) readonly buffer Counts { Marked marked; };

#include "reduction.glsl"

shared uint most;

void main() {
    uint coarser = gl_WorkGroupID.z; // 0: the back layer's first level, which is as fine as the front layer's second
    Level level = levels.level[BACK + coarser];
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 16;
    if (any(greaterThanEqual(corner, level.rect.zw))) {
        return;
    }
    if (gl_LocalInvocationIndex == 0u) {
        most = 0u;
    }
    barrier();
    bool wanted = coarser == 0u || coarser < marked.needed;
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (wanted && all(lessThan(texel, level.rect.zw))) {
        float z = EMPTY;
        ivec2 end = min((texel + 1) << coarser, levels.level[BACK].rect.zw);
        for (int y = texel.y << coarser; y < end.y; ++y) {
            for (int x = texel.x << coarser; x < end.x; ++x) {
                z = min(z, imageLoad(back, ivec2(x, y)).x);
            }
        }
        bool coarsest = int(coarser) + 1 >= levels.atlas.w;
        uint planned = plan_pixel(z, vec2(texel), level, coarser + 1u, coarser == 0u, coarsest);
        ivec2 p = level.rect.xy + texel;
        imageStore(smooth_a, p, vec4(z));
        imageStore(smooth_b, p, vec4(z));
        imageStore(plan, p, uvec4(planned));
        if (planned > 0u) {
            atomicMax(most, plan_count(planned) + 1u);
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        ivec2 tile = level.rect.xy / 16 + ivec2(gl_WorkGroupID.xy);
        tile_work[tile.y * levels.atlas.z + tile.x] = most;
    }
}
