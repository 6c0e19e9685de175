#version 460
// Pass `convolution`, last part: filters one page (two Fourier terms) along y with a box, after
// convolution_across.comp has filtered it along x, and adds a border of one texel around the page.
// Reads: one page, filtered along x. Writes: the page in the basis.

#include "frame.glsl"

layout(local_size_x = 16, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D across;
// The format depends on the configuration.
layout(set = 0, binding = 2) uniform writeonly image2D basis;

layout(push_constant, std430) uniform Push { int page; } push;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(frame.shadow_basis.xy);
    if (any(greaterThanEqual(at, size + 2))) {
        return;
    }
    ivec2 texel = clamp(at - 1, ivec2(0), size - 1);
    float reach = frame.shadow_filter.x;
    int most = int(ceil(reach - 0.5));
    vec4 sum = vec4(0.0);
    for (int i = -most; i <= most; ++i) {
        float weight = min(reach + 0.5 - abs(float(i)), 1.0);
        sum += weight * texelFetch(across, ivec2(texel.x, clamp(texel.y + i, 0, size.y - 1)), 0);
    }
    ivec2 corner = int(frame.shadow_basis.w) * ivec2(push.page >> 1, push.page & 1);
    imageStore(basis, corner + at, sum / (2.0 * reach));
}
