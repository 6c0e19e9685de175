#version 460
// Pass `convolution`, second part: the basis of two terms, averaged over the map's texels in one of ours
// and over a box along x. Reads: shadow map, span. Writes: one page, filtered along x.

#include "frame.glsl"
#include "convolution.glsl"

layout(local_size_x = 16, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D shadow_map;
layout(set = 0, binding = 2, std140) uniform Span { uvec4 span; };
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2D across;

layout(push_constant, std430) uniform Push { int page; } push;

// The last block of a row or a column may have fewer texels.
vec4 block_mean(ivec2 texel) {
    int edge = int(frame.shadow_basis.z);
    ivec2 first = texel * edge;
    ivec2 end = min(first + edge, ivec2(frame.shadow_rect.zw));
    vec4 sum = vec4(0.0);
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
            float depth = texelFetch(shadow_map, ivec2(x, y) + ivec2(frame.shadow_rect.xy), 0).x;
            sum += waves(push.page, texel_place(depth, span));
        }
    }
    return sum / float((end.x - first.x) * (end.y - first.y));
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(frame.shadow_basis.xy);
    if (any(greaterThanEqual(texel, size))) {
        return;
    }
    float reach = frame.shadow_filter.x;
    int most = int(ceil(reach - 0.5));
    vec4 sum = vec4(0.0);
    for (int i = -most; i <= most; ++i) {
        float weight = min(reach + 0.5 - abs(float(i)), 1.0);
        sum += weight * block_mean(ivec2(clamp(texel.x + i, 0, size.x - 1), texel.y));
    }
    imageStore(across, texel, sum / (2.0 * reach));
}
