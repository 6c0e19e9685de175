#version 460
// Pass `foam`, compute path, last part: whole steps to metres.
// Reads: sums. Writes: foam thickness (RG32F, or RGBA32F: what of the front layer the sun lights).

#include "frame.glsl"
#include "foam_sums.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) readonly buffer Sums { uint sums[]; };
// Of a format that shaders may only be told of by a feature: written without being told.
layout(set = 0, binding = 2) uniform writeonly image2D thickness;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, ivec2(frame.thick_extent.xy)))) {
        uint at = SUMS * (uint(p.y) * uint(frame.thick_extent.x) + uint(p.x));
        uint all = min(sums[at], FULL);
        uint front = all - min(sums[at + 1u], all);
        uint lit = LIT == 1u ? front - min(sums[at + 2u], front) : 0u;
        imageStore(thickness, p, vec4(all, front, lit, 0.0) * frame.foam_back.w);
    }
}
