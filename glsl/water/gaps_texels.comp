#version 460
// Pass `gaps`, last part: cells to texels of the thickness, bilinear between those cells that have a
// boundary. Not in the thesis. Reads: boundaries of the cells, spread. Writes: boundaries.

#include "frame.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1, std430) readonly buffer Spread { float spread[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Boundaries { float boundaries[]; };

layout(push_constant, std430) uniform Push {
    int columns;
    int rows;
} push;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(frame.thick_extent.xy)))) {
        return;
    }
    vec2 at = (vec2(p) + 0.5) * (frame.thick_extent.z / 8.0) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    float sum = 0.0;
    float weight = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        ivec2 q = clamp(base + corner, ivec2(0), ivec2(push.columns, push.rows) - 1);
        float there = spread[q.y * push.columns + q.x];
        vec2 share = mix(1.0 - f, f, vec2(corner));
        float w = there < EMPTY ? share.x * share.y : 0.0;
        sum += w > 0.0 ? w * there : 0.0;
        weight += w;
    }
    boundaries[uint(p.y) * uint(frame.thick_extent.x) + uint(p.x)] = weight > 0.0 ? sum / weight : EMPTY;
}
