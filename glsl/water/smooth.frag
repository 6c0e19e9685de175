#version 460
// Pass `smooth`, form Query: one iteration of curvature flow, or one of the two draws that go with it, a count of the
// active pixels and a copy (thesis Sec. 4.7, Listings A.11-A.13; the thesis counts fragments that it has not
// discarded).
// Reads: one smoothing image, plan. Writes: the other smoothing image.

#include "frame.glsl"
#include "plan.glsl"
#include "level.glsl"
#include "curvature.glsl"

layout(constant_id = 1) const uint RULE = 1;
// What the draw does. 0: an iteration. 1: counts the pixels that are active in an iteration (no colour writes). 2:
// copies one smoothing image to the other.
layout(constant_id = 2) const uint TASK = 0;

layout(set = 0, binding = 1) uniform sampler2D source;
layout(set = 0, binding = 2) uniform usampler2D plan;

layout(push_constant, std430) uniform Push {
    uint iteration; // from 1
    uint columns;   // tiles per row
    uint block;
} push;

layout(location = 0) flat in uint own;
layout(location = 0) out float moved;

#include "smoothing.glsl"

float fetch(ivec2 p, ivec4 rect) {
    ivec2 q = p - rect.xy;
    bool outside = q.x < 0 || q.y < 0 || q.x >= rect.z || q.y >= rect.w;
    return outside ? EMPTY : texelFetch(source, p, 0).x;
}

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    moved = texelFetch(source, p, 0).x;
    if (TASK == 2u) {
        return;
    }
    uint planned = texelFetch(plan, p, 0).x;
    bool active_here = plan_count(planned) >= push.iteration;
    // early_fragment_tests is not set: with it lavapipe would count discarded fragments.
    if (TASK == 1u) {
        if (!active_here) {
            discard;
        }
        return;
    }
    if (active_here) {
        Level level = levels.level[own];
        ivec4 rect = level.rect;
        Stencil s;
        s.z = moved;
        s.axis = vec4(fetch(p + ivec2(-1, 0), rect), fetch(p + ivec2(1, 0), rect),
                      fetch(p + ivec2(0, -1), rect), fetch(p + ivec2(0, 1), rect));
        s.corner = vec4(fetch(p + ivec2(-1, -1), rect), fetch(p + ivec2(1, -1), rect),
                        fetch(p + ivec2(-1, 1), rect), fetch(p + ivec2(1, 1), rect));
        moved = smooth_pixel(s, level, p - rect.xy, planned);
    }
}
