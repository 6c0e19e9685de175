#version 460
// Pass `resolve`: converts thickness to intensity (Akinci et al. 2013, Sec. 2.3).
// Reads: thickness. Writes: intensity.

#include "view.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 1, std430) readonly buffer Thickness { float thickness[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Intensity { float intensity[]; };

void main() {
    uint at = gl_GlobalInvocationID.x;
    if (at < view.extent.x * view.extent.y) {
        float rho = thickness[at];
        float power = rho > 0.0 ? pow(rho, view.intensity.y) : 0.0;
        intensity[at] = power / (view.intensity.x + power);
    }
}
