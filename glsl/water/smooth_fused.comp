#version 460
// Pass `smooth`, form Fused: eight iterations per dispatch in shared memory, over the tiles that still have
// iterations to do. A tile of 16x16 texels is smoothed in a window of 32x32: each iteration makes one more row of
// texels along the window's rim invalid, so after eight iterations the tile itself is still valid. The arithmetic is
// that of the other forms (thesis Sec. 4.7, Listing A.13); this form is not in the thesis.
// Reads: one smoothing image, plan, list. Writes: the other smoothing image.

#include "frame.glsl"
#include "plan.glsl"
#include "level.glsl"
#include "curvature.glsl"

const int STEPS = 8;
const int SIDE = 16 + 2 * STEPS;

layout(local_size_x = 32, local_size_y = 8) in;
layout(constant_id = 1) const uint RULE = 1;

layout(set = 0, binding = 1) uniform sampler2D source;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D target;
layout(set = 0, binding = 3) uniform usampler2D plan;
layout(set = 0, binding = 4, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 5, std430) readonly buffer Arguments { uvec4 arguments[]; };

layout(push_constant, std430) uniform Push {
    uint iteration; // the first one, from 1
    uint columns;   // tiles per row
    uint arguments_index;
} push;

#include "smoothing.glsl"

shared float window[2][SIDE * SIDE];

void smooth_tile(uint tile) {
    ivec2 corner = ivec2(tile % push.columns, tile / push.columns) * 16;
    Level level = levels.level[level_of(corner)];
    ivec2 first = level.rect.xy;
    ivec2 last = first + level.rect.zw - 1;
    corner -= STEPS;
    ivec2 lane = ivec2(gl_LocalInvocationID.xy);
    uint planned[4];
    for (int k = 0; k < 4; ++k) {
        ivec2 at = lane + ivec2(0, 8 * k);
        ivec2 p = corner + at;
        bool inside = all(greaterThanEqual(p, first)) && all(lessThanEqual(p, last));
        ivec2 q = clamp(p, first, last);
        window[0][at.y * SIDE + at.x] = inside ? texelFetch(source, q, 0).x : EMPTY;
        window[1][at.y * SIDE + at.x] = EMPTY;
        planned[k] = inside ? texelFetch(plan, q, 0).x : 0u;
    }
    barrier();
    for (int step = 0; step < STEPS; ++step) {
        int from = step & 1;
        for (int k = 0; k < 4; ++k) {
            ivec2 at = lane + ivec2(0, 8 * k);
            int i = at.y * SIDE + at.x;
            float z = window[from][i];
            bool rim = any(lessThanEqual(at, ivec2(step))) || any(greaterThanEqual(at, ivec2(SIDE - 1 - step)));
            if (!rim && plan_count(planned[k]) >= push.iteration + uint(step)) {
                Stencil s;
                s.z = z;
                s.axis = vec4(window[from][i - 1], window[from][i + 1],
                              window[from][i - SIDE], window[from][i + SIDE]);
                s.corner = vec4(window[from][i - SIDE - 1], window[from][i - SIDE + 1],
                                window[from][i + SIDE - 1], window[from][i + SIDE + 1]);
                z = smooth_pixel(s, level, corner + at - first, planned[k]);
            }
            window[1 - from][i] = z;
        }
        barrier();
    }
    for (int k = 1; k < 3; ++k) {
        ivec2 at = lane + ivec2(0, 8 * k);
        ivec2 p = corner + at;
        bool mine = at.x >= STEPS && at.x < STEPS + 16;
        if (mine && all(lessThanEqual(p, last))) {
            imageStore(target, p, vec4(window[STEPS & 1][at.y * SIDE + at.x]));
        }
    }
    barrier();
}

void main() {
    uint tiles = arguments[push.arguments_index].w;
    for (uint i = gl_WorkGroupID.x; i < tiles; i += gl_NumWorkGroups.x) {
        smooth_tile(list[i]);
    }
}
