#version 460
// Pass `smooth`, form Tiles: one iteration of curvature flow over the tiles with work left.
// Reads: one smoothing image, plan, list. Writes: the other smoothing image.

#include "frame.glsl"
#include "plan.glsl"
#include "curvature.glsl"

// An invocation smooths ROWS pixels of a column and keeps the three rows it needs in registers:
// three fetches a pixel in place of nine. 1 where threads are plenty, 16 where they are few.
layout(local_size_x = 16, local_size_y_id = 2) in;
layout(constant_id = 1) const uint RULE = 1;
layout(constant_id = 3) const int ROWS = 1;

layout(set = 0, binding = 1) uniform sampler2D source;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D target;
layout(set = 0, binding = 3) uniform usampler2D plan;
layout(set = 0, binding = 4, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 5, std430) readonly buffer Arguments { uvec4 arguments[]; };

layout(push_constant, std430) uniform Push {
    uint iteration; // from 1
    uint columns;   // tiles a row
} push;

#include "smoothing.glsl"

// Left, middle and right texel of a row; EMPTY outside the image.
vec3 fetch_row(ivec2 p, ivec2 last) {
    bool outside = p.y < 0 || p.y > last.y;
    int y = clamp(p.y, 0, last.y);
    vec3 row = vec3(texelFetch(source, ivec2(max(p.x - 1, 0), y), 0).x,
                    texelFetch(source, ivec2(p.x, y), 0).x,
                    texelFetch(source, ivec2(min(p.x + 1, last.x), y), 0).x);
    return vec3(outside || p.x == 0 ? EMPTY : row.x,
                outside ? EMPTY : row.y,
                outside || p.x == last.x ? EMPTY : row.z);
}

void smooth_column(ivec2 p, ivec2 last) {
    vec3 above = fetch_row(p - ivec2(0, 1), last);
    vec3 here = fetch_row(p, last);
    for (int k = 0; k < ROWS && p.y <= last.y; ++k) {
        vec3 below = fetch_row(p + ivec2(0, 1), last);
        uint planned = texelFetch(plan, p, 0).x;
        Stencil s;
        s.z = here.y;
        s.axis = vec4(here.x, here.z, above.y, below.y);
        s.corner = vec4(above.x, above.z, below.x, below.z);
        float moved = smooth_pixel(s, p, planned);
        float z = plan_count(planned) >= push.iteration ? moved : here.y;
        imageStore(target, p, vec4(z));
        above = here;
        here = below;
        ++p.y;
    }
}

void main() {
    uint tiles = arguments[push.iteration].w;
    ivec2 last = ivec2(frame.extent.zw) - 1;
    for (uint i = gl_WorkGroupID.x; i < tiles; i += gl_NumWorkGroups.x) {
        uint tile = list[i];
        ivec2 p = ivec2(tile % push.columns, tile / push.columns) * 16
                + ivec2(gl_LocalInvocationID.xy) * ivec2(1, ROWS);
        if (p.x <= last.x && p.y <= last.y) {
            smooth_column(p, last);
        }
    }
}
