#version 460
// Pass `convolution`, third part: filters one page (two Fourier terms) along x with a box; convolution_down.comp then
// filters it along y (Annen et al. 2007, without their mips). Reads: one page. Writes: the page, filtered along x.

#include "frame.glsl"

layout(local_size_x = 16, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D page;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D across;

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
        sum += weight * texelFetch(page, ivec2(clamp(texel.x + i, 0, size.x - 1), texel.y), 0);
    }
    imageStore(across, texel, sum / (2.0 * reach));
}
