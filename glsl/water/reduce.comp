#version 460
// Pass `reduce`: hides water behind the scene, takes the nearest surface of each block of pixels
// (but no drop's) and plans its smoothing: iterations and step, fixed from here on (thesis Sec. 3.1,
// Listing A.12).
// Reads: depth, scene depth. Writes: depth (occluded pixels emptied), both smoothing images, plan,
// work of every tile (its most iterations + 1; 0 without water), how many pixels pass the cap.

#include "frame.glsl"
#include "plan.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 0) const uint LEVEL = 1;
layout(constant_id = 1) const uint RULE = 1;

layout(set = 0, binding = 1, r32f) uniform image2D depth;
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D smooth_a;
layout(set = 0, binding = 4, r32f) uniform writeonly image2D smooth_b;
layout(set = 0, binding = 5, r32ui) uniform writeonly uimage2D plan;
layout(set = 0, binding = 6, std430) writeonly buffer Tiles { uint tile_work[]; };
// Pixels that pass the cap until the smoothing is one, two, three, more levels coarser.
layout(set = 0, binding = 8, std430) buffer Over { uint over[4]; };

layout(push_constant, std430) uniform Push { uint columns; } push; // tiles a row

#include "foam_texels.glsl"
#include "beside.glsl"
#include "block.glsl"
#include "reduction.glsl"

shared uint most;
shared uint tile_over[4];

// Depth of the block in front of the scene; whether something is drawn there that is no water.
float reduced(ivec2 block, out bool other) {
    ivec2 extent = ivec2(frame.extent.xy);
    other = foam_beside(block << LEVEL, 1 << LEVEL);
    float best = EMPTY;
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
                // Reversed infinite depth at infinity: 1/0, or negative by rounding.
                if (scene > 0.0 && z >= scene) {
                    imageStore(depth, pixel, vec4(EMPTY));
                } else {
                    best = min(best, z);
                }
            }
        }
    }
    // A pixel is no less than a quarter of four.
    return LEVEL < 2u ? best : block_depth(block << LEVEL, min((block + 1) << LEVEL, extent), best);
}

void main() {
    if (gl_LocalInvocationIndex < 4u) {
        tile_over[gl_LocalInvocationIndex] = 0u;
        most = 0u;
    }
    barrier();
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(block, ivec2(frame.extent.zw)))) {
        bool other;
        float z = reduced(block, other);
        float count;
        vec2 slope = ray_slope(vec2(block) + 0.5, frame.reduced_slope);
        uint planned = plan_pixel(z, slope, frame.texel.zw, count);
        imageStore(smooth_a, block, vec4(z));
        imageStore(smooth_b, block, vec4(z));
        imageStore(plan, block, uvec4(planned));
        // One more than the iterations: a tile with water and nothing to smooth is still drawn.
        if (z < EMPTY || other) {
            atomicMax(most, plan_count(planned) + 1u);
        }
        float cap = frame.smoothing.z;
        if (count > cap) {
            // Each level coarser divides the iterations by four.
            float excess = (count - MORE) / max(cap - MORE, 1.0);
            atomicAdd(tile_over[uint(clamp(ceil(0.5 * log2(excess)), 1.0, 4.0)) - 1u], 1u);
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        tile_work[gl_WorkGroupID.y * push.columns + gl_WorkGroupID.x] = most;
    }
    if (gl_LocalInvocationIndex < 4u && tile_over[gl_LocalInvocationIndex] > 0u) {
        atomicAdd(over[gl_LocalInvocationIndex], tile_over[gl_LocalInvocationIndex]);
    }
}
