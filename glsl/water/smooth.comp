#version 460
// Pass `smooth`, form Tiles: one iteration of curvature flow over the tiles with work left.
// Reads: one smoothing image, plan, list. Writes: the other smoothing image.

#include "frame.glsl"
#include "plan.glsl"
#include "curvature.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 1) const uint RULE = 1;

layout(set = 0, binding = 1) uniform sampler2D source;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D target;
layout(set = 0, binding = 3) uniform usampler2D plan;
layout(set = 0, binding = 4, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 5, std430) readonly buffer Arguments { uvec4 arguments[]; };

layout(push_constant, std430) uniform Push {
    uint iteration; // from 1
    uint columns;   // tiles a row
} push;

float fetch(ivec2 p) {
    ivec2 last = ivec2(frame.extent.zw) - 1;
    bool outside = p.x < 0 || p.y < 0 || p.x > last.x || p.y > last.y;
    return outside ? EMPTY : texelFetch(source, p, 0).x;
}

void smooth_pixel(ivec2 p) {
    float z = texelFetch(source, p, 0).x;
    uint planned = texelFetch(plan, p, 0).x;
    if (plan_count(planned) >= push.iteration) {
        Stencil s;
        s.z = z;
        s.axis = vec4(fetch(p + ivec2(-1, 0)), fetch(p + ivec2(1, 0)),
                      fetch(p + ivec2(0, -1)), fetch(p + ivec2(0, 1)));
        if (RULE == RULE_CONSTANT_WIDTH) {
            s.corner = vec4(fetch(p + ivec2(-1, -1)), fetch(p + ivec2(1, -1)),
                            fetch(p + ivec2(-1, 1)), fetch(p + ivec2(1, 1)));
        }
        float unit = RULE == RULE_CONSTANT_WIDTH ? MOST_KAPPA : SOURCE_STEP * frame.particle.x;
        z = curvature_step(s, frame.texel.zw, frame.smoothing.y, RULE, unit * plan_step(planned));
    }
    imageStore(target, p, vec4(z));
}

void main() {
    uint tiles = arguments[push.iteration].w;
    for (uint i = gl_WorkGroupID.x; i < tiles; i += gl_NumWorkGroups.x) {
        uint tile = list[i];
        ivec2 p = ivec2(tile % push.columns, tile / push.columns) * 16 + ivec2(gl_LocalInvocationID.xy);
        if (all(lessThan(p, ivec2(frame.extent.zw)))) {
            smooth_pixel(p);
        }
    }
}
