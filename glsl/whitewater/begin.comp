#version 460
// Pass `splat`, first part: clears each pixel's words and stores in them the eye depths of scene and fluid, which
// particles read many times (Akinci et al. 2013, passes 1 and 2). It also computes the arguments of the dispatches
// over the particles.
// Reads: scene depth, water depth, depth of the host's own fluid, count. Writes: words, arguments.

#include "frame.glsl"
#include "whitewater_words.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
// Two entries per pixel.
layout(set = 0, binding = 1, std430) writeonly buffer Words { uvec4 words[]; };
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D water_depth;
layout(set = 0, binding = 4, std430) readonly buffer Count { uint count; };
// Four words for each chunk of whitewater particles. Compute paths: workgroups of an indirect dispatch (xyz) and
// number of particles (w). Quads: arguments of an indirect draw.
layout(set = 0, binding = 5, std430) writeonly buffer Arguments { uvec4 arguments[]; };
// Depth of the host's own fluid, in the camera's convention.
layout(set = 0, binding = 6) uniform sampler2D fluid_depth;

layout(push_constant, std430) uniform Push {
    vec4 fluid_at;   // its texels per pixel (0: none) and its first texel
    ivec2 fluid_end; // end of its texels
    uint count;      // number from the host, or the capacity
    uint from_gpu;
    uint chunks;
    uint chunk_size;
    uint group_size; // 0: quads
} push;

#include "whitewater_chunks.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (gl_GlobalInvocationID.y == 0u && gl_GlobalInvocationID.x < push.chunks) {
        uint chunk = gl_GlobalInvocationID.x;
        uint own = own_of(chunk);
        bool quads = push.group_size == 0u;
        uvec2 groups = uvec2((own + push.group_size - 1u) / max(push.group_size, 1u), 1u);
        arguments[chunk] = quads ? uvec4(4u, own, 0u, 0u) : uvec4(groups, 1u, own);
    }
    if (all(lessThan(pixel, ivec2(frame.extent.xy)))) {
        float scene = eye_depth(texelFetch(scene_depth, scene_texel(vec2(pixel) + 0.5), 0).x);
        float fluid = texelFetch(water_depth, pixel, 0).x;
        // With a reversed infinite depth, infinity is 1/0, or negative by rounding.
        scene = scene > 0.0 ? min(scene, EMPTY) : EMPTY;
        if (push.fluid_at.x > 0.0) {
            ivec2 texel = ivec2((vec2(pixel) + 0.5) * push.fluid_at.xy + push.fluid_at.zw);
            float host = eye_depth(texelFetch(fluid_depth, min(texel, push.fluid_end - 1), 0).x);
            fluid = min(fluid, host > 0.0 ? host : EMPTY);
        }
        uvec4 head;
        head[WITH] = 0xffffffffu;
        head[FRONT] = floatBitsToUint(scene);
        head[SCENE] = floatBitsToUint(scene);
        head[FLUID] = floatBitsToUint(fluid < scene ? fluid : EMPTY);
        uint at = words_of(pixel) / 4u;
        words[at] = head;
        words[at + SUMS / 4u] = uvec4(0u);
    }
}
