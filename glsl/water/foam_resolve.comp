#version 460
// Pass `foam`, compute path, last part: whole steps to metres.
// Reads: sums. Writes: foam thickness (RG32F).

#include "frame.glsl"
#include "foam_sums.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) readonly buffer Sums { uvec2 sums[]; };
// Of a format that shaders may only be told of by a feature: written without being told.
layout(set = 0, binding = 2) uniform writeonly image2D thickness;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, ivec2(frame.thick_extent.xy)))) {
        uint at = uint(p.y) * uint(frame.thick_extent.x) + uint(p.x);
        uvec2 steps = min(sums[at], uvec2(FULL));
        vec2 both = vec2(steps.x, steps.x - steps.y) * frame.foam_back.w;
        imageStore(thickness, p, vec4(both, 0.0, 0.0));
    }
}
