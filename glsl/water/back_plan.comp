#version 460
// Pass `back`, last part: the back sheet joins the levels of the smoothing, where its tiles are
// wanted. Not in the source. Reads: back, levels. Writes: both smoothing images, plan, work of the level's
// tiles.

#include "frame.glsl"
#include "plan.glsl"
#include "level.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 1) const uint RULE = 1;

layout(set = 0, binding = 1, r32f) uniform readonly image2D back;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D smooth_a;
layout(set = 0, binding = 4, r32f) uniform writeonly image2D smooth_b;
layout(set = 0, binding = 5, r32ui) uniform writeonly uimage2D plan;
layout(set = 0, binding = 6, std430) buffer Tiles { uint tile_work[]; };

#include "reduction.glsl"

shared uint wanted;
shared uint most;

void main() {
    Level level = levels.level[2];
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 16;
    if (any(greaterThanEqual(corner, level.rect.zw))) {
        return;
    }
    ivec2 tile = level.rect.xy / 16 + ivec2(gl_WorkGroupID.xy);
    if (gl_LocalInvocationIndex == 0u) {
        wanted = tile_work[tile.y * levels.atlas.z + tile.x];
        most = 0u;
    }
    barrier();
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, level.rect.zw))) {
        // Beside the wanted tiles there is nothing to smooth with.
        float z = wanted == 1u ? imageLoad(back, texel).x : EMPTY;
        float count;
        uint planned = plan_pixel(z, ray_slope(vec2(texel) + 0.5, level.slope), level.texel.xy, count);
        ivec2 p = level.rect.xy + texel;
        imageStore(smooth_a, p, vec4(z));
        imageStore(smooth_b, p, vec4(z));
        imageStore(plan, p, uvec4(planned));
        if (z < EMPTY) {
            atomicMax(most, plan_count(planned) + 1u);
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        tile_work[tile.y * levels.atlas.z + tile.x] = most;
    }
}
