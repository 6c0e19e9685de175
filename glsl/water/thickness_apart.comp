#version 460
// Pass `thickness`, compute path, with two layers of water: converts the sums of the layers to scene units, and
// removes the boundary between the layers in texels where all water belongs to one of them. Not in the thesis.
// Reads: sums, boundaries, scene depth. Writes: sheets (RGBA32F: front, back, window, boundary as found), boundaries.

#include "frame.glsl"
#include "kernel.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(constant_id = 9) const uint FOAM = 0;

layout(set = 0, binding = 1, std430) readonly buffer Sums { uvec2 sums[]; };
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D sheets;
layout(set = 0, binding = 3) uniform sampler2D scene_depth;
layout(set = 0, binding = 11, std430) buffer Boundaries { float boundaries[]; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(frame.thick_extent.xy)))) {
        return;
    }
    uint texels = uint(frame.thick_extent.x) * uint(frame.thick_extent.y);
    uint at = uint(p.y) * uint(frame.thick_extent.x) + uint(p.x);
    float all = metres(sums[at]);
    float front = metres(sums[at + (1u + FOAM) * texels]);
    float window = metres(sums[at + (2u + FOAM) * texels]);
    float scene = eye_depth(texelFetch(scene_depth, scene_texel((vec2(p) + 0.5) * frame.thick_extent.z), 0).x);
    // In fixed point the two sums are equal if no water is behind the boundary. `precise`: a fused multiply-add would
    // keep what the products above round off, so equal sums would differ. `max`: the sums come from two dispatches,
    // whose addends a driver may round differently, so the front layer's sum may exceed that of all water.
    precise float back = all - front;
    back = max(back, 0.0);
    float found = boundaries[at];
    bool two = keeps_boundary(found, front, back, scene);
    imageStore(sheets, p, vec4(two ? vec3(front, back, window) : vec3(all, 0.0, ONE_SHEET * all), found));
    if (!two) {
        boundaries[at] = EMPTY;
    }
}
