#version 460
// Pass `convolution`, second part: cosine and sine of two Fourier terms of the shadow map's depth (convolution.glsl),
// averaged over those texels of the shadow map that lie in one texel of the library's basis image.
// Reads: shadow map, span. Writes: one page (the two terms).

#include "frame.glsl"
#include "convolution.glsl"

layout(local_size_x = 16, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D shadow_map;
layout(set = 0, binding = 2, std140) uniform Span { uvec4 span; };
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2D page;

layout(push_constant, std430) uniform Push { int page; } push;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(frame.shadow_basis.xy)))) {
        return;
    }
    // The last block of a row or column may have fewer texels.
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
    imageStore(page, texel, sum / float((end.x - first.x) * (end.y - first.y)));
}
