#version 460
// Pass `gaps`, fourth part: dilation: cells without a boundary take one from cells nearby, weighted by squared distance.
// Not in the thesis. Reads: boundaries of the cells. Writes: the same, dilated.

#include "frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, std430) readonly buffer Found { float found[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Spread { float spread[]; };

layout(push_constant, std430) uniform Push {
    int columns;
    int rows;
} push;

const int NEAR = 1;

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (p.x >= push.columns || p.y >= push.rows) {
        return;
    }
    float own = found[p.y * push.columns + p.x];
    if (own >= EMPTY) {
        ivec2 first = max(p - NEAR, ivec2(0));
        ivec2 last = min(p + NEAR, ivec2(push.columns, push.rows) - 1);
        float sum = 0.0;
        float weight = 0.0;
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                float there = found[y * push.columns + x];
                vec2 off = vec2(x, y) - vec2(p);
                float w = there < EMPTY ? 1.0 / max(dot(off, off), 1.0) : 0.0;
                sum += w > 0.0 ? w * there : 0.0;
                weight += w;
            }
        }
        own = weight > 0.0 ? sum / weight : EMPTY;
    }
    spread[p.y * push.columns + p.x] = own;
}
