#version 460
// Pass `smooth`, form Tiles: one iteration of curvature flow (thesis Sec. 3.1, 4.7, Listing A.13) over the tiles that
// still have iterations to do. The thesis draws one quad over the image.
// Reads: one smoothing image, plan, list. Writes: the other smoothing image.

#include "frame.glsl"
#include "plan.glsl"
#include "level.glsl"
#include "curvature.glsl"

// An invocation smooths two columns of ROWS rows each: one gather reads 2x2 texels, and rows that the next texels
// need again stay in registers. ROWS is 2 on devices with many threads and 16 on those with few.
layout(local_size_x = 8, local_size_y_id = 2) in;
layout(constant_id = 1) const uint RULE = 1;
layout(constant_id = 3) const int ROWS = 2;

layout(set = 0, binding = 1) uniform sampler2D source;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D target;
layout(set = 0, binding = 3) uniform usampler2D plan;
layout(set = 0, binding = 4, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 5, std430) readonly buffer Arguments { uvec4 arguments[]; };

layout(push_constant, std430) uniform Push {
    uint iteration; // from 1
    uint columns;   // tiles per row
} push;

#include "smoothing.glsl"

// Texels x - 1 to x + 2 of the rows y and y + 1; EMPTY outside the level.
void fetch_rows(ivec2 p, ivec2 first, ivec2 last, out vec4 row0, out vec4 row1) {
    vec2 texel = 1.0 / vec2(levels.atlas.xy);
    vec4 g0 = textureGather(source, vec2(p.x, p.y + 1) * texel);
    vec4 g1 = textureGather(source, vec2(p.x + 2, p.y + 1) * texel);
    row0 = vec4(g0.wz, g1.wz);
    row1 = vec4(g0.xy, g1.xy);
    bvec4 outside = bvec4(p.x < first.x + 1, false, p.x + 1 > last.x, p.x + 2 > last.x);
    row0 = mix(row0, vec4(EMPTY), outside);
    row1 = mix(row1, vec4(EMPTY), outside);
    row0 = p.y < first.y || p.y > last.y ? vec4(EMPTY) : row0;
    row1 = p.y + 1 > last.y ? vec4(EMPTY) : row1;
}

void smooth_at(Level level, ivec2 p, ivec2 last, uint planned, vec3 above, vec3 here, vec3 below) {
    Stencil s;
    s.z = here.y;
    s.axis = vec4(here.x, here.z, above.y, below.y);
    s.corner = vec4(above.x, above.z, below.x, below.z);
    float moved = smooth_pixel(s, level, p - level.rect.xy, planned);
    float z = plan_count(planned) >= push.iteration ? moved : here.y;
    if (p.x <= last.x && p.y <= last.y) {
        imageStore(target, p, vec4(z));
    }
}

void smooth_columns(Level level, ivec2 p, ivec2 last) {
    vec2 texel = 1.0 / vec2(levels.atlas.xy);
    ivec2 first = level.rect.xy;
    vec4 a;
    vec4 b;
    fetch_rows(p - ivec2(0, 1), first, last, a, b);
    int k = 0;
    // The loop's condition is at its end, for CPU drivers as in main; the first row of the columns always lies in the
    // level.
    do {
        vec4 c;
        vec4 d;
        fetch_rows(p + ivec2(0, 1), first, last, c, d);
        uvec4 planned = textureGather(plan, vec2(p + 1) * texel);
        smooth_at(level, p, last, planned.w, a.xyz, b.xyz, c.xyz);
        smooth_at(level, p + ivec2(1, 0), last, planned.z, a.yzw, b.yzw, c.yzw);
        smooth_at(level, p + ivec2(0, 1), last, planned.x, b.xyz, c.xyz, d.xyz);
        smooth_at(level, p + ivec2(1, 1), last, planned.y, b.yzw, c.yzw, d.yzw);
        a = c;
        b = d;
        p.y += 2;
        k += 2;
    } while (k < ROWS && p.y <= last.y);
}

void main() {
    uint tiles = arguments[push.iteration].w;
    uint i = gl_WorkGroupID.x;
    // The loop's condition is at its end: with it at the top, a CPU driver executes the body once more without active
    // invocations. This form is correct because every workgroup has a tile.
    do {
        uint tile = list[i];
        ivec2 corner = ivec2(tile % push.columns, tile / push.columns) * 16;
        Level level = levels.level[level_of(corner)];
        ivec2 last = level.rect.xy + level.rect.zw - 1;
        ivec2 p = corner + ivec2(gl_LocalInvocationID.xy) * ivec2(2, ROWS);
        if (p.x <= last.x && p.y <= last.y) {
            smooth_columns(level, p, last);
        }
        i += gl_NumWorkGroups.x;
    } while (i < tiles);
}
