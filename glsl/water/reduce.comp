#version 460
// Pass `reduce`: hides water behind the scene, takes the nearest surface of each block of pixels
// and plans its smoothing: iterations and step, fixed from here on (spec: Sec. 3.1, Listing A.12).
// Reads: depth, scene depth. Writes: depth (occluded pixels emptied), both smoothing images, plan,
// work of every tile (its most iterations + 1; 0 without water).

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

shared uint most;

// Nearest surface of the block in front of the scene.
float nearest(ivec2 block) {
    ivec2 extent = ivec2(frame.extent.xy);
    float best = EMPTY;
    for (int y = 0; y < (1 << LEVEL); ++y) {
        for (int x = 0; x < (1 << LEVEL); ++x) {
            ivec2 pixel = (block << LEVEL) + ivec2(x, y);
            if (pixel.x >= extent.x || pixel.y >= extent.y) {
                continue;
            }
            float z = imageLoad(depth, pixel).x;
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
    return best;
}

uint plan_pixel(float z, vec2 slope) {
    float width = frame.texel.z * z; // of the pixel in the world
    float cap = frame.smoothing.z;
    if (RULE == RULE_CONSTANT_WIDTH) {
        float sigma = frame.smoothing.x / width;
        // Off the axis a pixel sees the surface foreshortened, flat pixels are nearer to each
        // other in y: more, smaller steps keep it stable.
        float shape = frame.texel.z / frame.texel.w;
        float spread = 1.0 + slope.x * slope.x + (1.0 + slope.y * slope.y) * shape * shape;
        float count = sigma > 0.0 ? ceil(spread * sigma * sigma) + MORE : 0.0;
        float kappa = sigma * sigma / (2.0 * max(count, 1.0));
        return plan_pack(uint(min(count, cap)), kappa / MOST_KAPPA);
    }
    float r = frame.particle.x;
    float count = RULE == RULE_FIXED ? frame.smoothing.w : floor(SOURCE_RADIUS * r / width) + 1.0;
    float share = min(1.0, 0.25 * width / (SOURCE_STEP * r));
    return plan_pack(uint(min(count, cap)), share);
}

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        most = 0u;
    }
    barrier();
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(block, ivec2(frame.extent.zw)))) {
        float z = nearest(block);
        uint planned = z < EMPTY ? plan_pixel(z, ray_slope(vec2(block) + 0.5, frame.reduced_slope)) : 0u;
        imageStore(smooth_a, block, vec4(z));
        imageStore(smooth_b, block, vec4(z));
        imageStore(plan, block, uvec4(planned));
        // One more than the iterations: a tile with water and nothing to smooth is still drawn.
        if (z < EMPTY) {
            atomicMax(most, plan_count(planned) + 1u);
        }
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u) {
        tile_work[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = most;
    }
}
