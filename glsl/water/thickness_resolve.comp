#version 460
// Pass `thickness`, compute path, last part: converts the sums from fixed point to scene units. (The thesis
// blends.)
// Reads: sums. Writes: thickness (R32F).

#include "frame.glsl"
#include "kernel.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) readonly buffer Sums { uvec2 sums[]; };
layout(set = 0, binding = 2, r32f) uniform writeonly image2D thickness;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, ivec2(frame.thick_extent.xy)))) {
        uint at = uint(p.y) * uint(frame.thick_extent.x) + uint(p.x);
        imageStore(thickness, p, vec4(metres(sums[at])));
    }
}
