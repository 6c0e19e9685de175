#version 460
// Pass `thickness`, compute path with foam, last part: converts the sums of two thicknesses from fixed point to scene
// units: that of all water, and that of the water in front of the frontmost foam (T_wf, thesis Sec. 3.2.2), which in
// texels without foam is that of all water too.
// Reads: sums, foam depth. Writes: thickness (RG32F).

#include "frame.glsl"
#include "kernel.glsl"
#include "surface_foam_share.glsl"
#include "surface_foam_front.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) readonly buffer Sums { uvec2 sums[]; };
// A format qualifier would need a feature (shaderStorageImageExtendedFormats), so there is none.
layout(set = 0, binding = 2) uniform writeonly image2D thickness;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, ivec2(frame.thick_extent.xy)))) {
        uint texels = uint(frame.thick_extent.x) * uint(frame.thick_extent.y);
        uint at = uint(p.y) * uint(frame.thick_extent.x) + uint(p.x);
        float all = metres(sums[at]);
        float before = foam_at(p) < EMPTY ? metres(sums[at + texels]) : all;
        imageStore(thickness, p, vec4(all, before, 0.0, 0.0));
    }
}
