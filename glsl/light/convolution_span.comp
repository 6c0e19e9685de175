#version 460
// Pass `convolution`, first part: finds the least and the greatest depth of the shadow map's non-empty texels. The
// Fourier series of the depth comparison is defined between these two depths (src/light/convolution.rs; not in the
// source). A workgroup reads 128x128 texels.
// Reads: shadow map. Writes: span.

#include "frame.glsl"
#include "convolution.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D shadow_map;
layout(set = 0, binding = 2, std430) buffer Span { uvec4 span; };

void main() {
    ivec2 size = ivec2(frame.shadow_rect.zw);
    ivec2 first = ivec2(gl_WorkGroupID.xy) * 128 + ivec2(gl_LocalInvocationID.xy);
    uint least = NO_SPAN;
    uint most = 0u;
    for (int i = 0; i < 256; ++i) {
        ivec2 texel = first + 8 * ivec2(i & 15, i >> 4);
        if (all(lessThan(texel, size))) {
            float depth = texelFetch(shadow_map, texel + ivec2(frame.shadow_rect.xy), 0).x;
            // The bits of positive floats, taken as integers, are in the same order as the floats.
            uint bits = floatBitsToUint(clamp(depth, 0.0, 1.0));
            least = is_open(depth) ? least : min(least, bits);
            most = is_open(depth) ? most : max(most, bits);
        }
    }
    if (least != NO_SPAN) {
        atomicMin(span.x, least);
        atomicMin(span.y, ~most);
    }
}
