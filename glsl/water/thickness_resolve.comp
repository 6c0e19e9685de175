#version 460
// Pass `thickness`, compute path, last part: fixed point to metres.
// Reads: sums, foam depth. Writes: thickness.

#include "frame.glsl"
#include "kernel.glsl"
#include "foam_share.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) readonly buffer Sums { uvec2 sums[]; };
// R32F, or with foam RG32F: written without being told.
layout(set = 0, binding = 2) uniform writeonly image2D thickness;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, ivec2(frame.thick_extent.xy)))) {
        uint at = uint(p.y) * uint(frame.thick_extent.x) + uint(p.x);
        uint texels = uint(frame.thick_extent.x) * uint(frame.thick_extent.y);
        float all = metres(sums[at]);
        // Without foam all of it is before it.
        float before = FOAM == 1u && foam_at(p) < EMPTY ? metres(sums[at + FOAM * texels]) : all;
        imageStore(thickness, p, vec4(all, before, 0.0, 0.0));
    }
}
