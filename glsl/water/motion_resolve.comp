#version 460
// Pass `motion`, last part: motion vector of each pixel: position of its visible point minus the point's previous
// position, in pixels. Water and foam have their own motion and the camera's, the scene has only the camera's.
// Everything is computed as differences, so that zero motion is exactly zero and small motion is as exact as large
// motion. Not in the sources.
// Reads: fronts, sums, depth, foam depth and thickness, smoothed, levels, scene depth. Writes: motion.

#include "frame.glsl"
#include "level.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(push_constant, std430) uniform Push { uint level; } push;

#include "motion.glsl"
#include "surface_foam_texels.glsl"
#include "shown_foam.glsl"
#include "smoothed_depth.glsl"

layout(set = 0, binding = 3) uniform sampler2D depth;
// A format qualifier would need a feature (shaderStorageImageExtendedFormats), so there is none.
layout(set = 0, binding = 8) uniform writeonly image2D motion;

// A 64-bit sum as a float.
float sum_at(uint at) {
    uint low = sums[at];
    uint high = sums[at + 1u];
    bool negative = (high & 0x80000000u) != 0u;
    if (negative) {
        low = ~low + 1u;
        high = ~high + (low == 0u ? 1u : 0u);
    }
    float value = float(high) * 4294967296.0 + float(low);
    return negative ? -value : value;
}

// Of the texel's surfaces that have a weight, chooses the one nearest to depth z. Returns its weighted displacement
// and its weight; `away` is its distance from z.
vec4 texel_sums(ivec2 texel, float z, out float away) {
    uint at = texel_index(texel);
    vec2 front = fronts[at];
    away = 2.0 * EMPTY;
    uint nearer = 0u;
    float weight = 0.0;
    uint count = surfaces_of(front);
    for (uint surface = 0u; surface < count; ++surface) {
        float off = abs(front[surface] - z);
        float there = front[surface] < EMPTY ? sum_at(sum_index(at, surface, 3u)) : 0.0;
        bool better = there > 0.0 && off < away;
        away = better ? off : away;
        nearer = better ? surface : nearer;
        weight = better ? there : weight;
    }
    vec3 moved = vec3(sum_at(sum_index(at, nearer, 0u)), sum_at(sum_index(at, nearer, 1u)),
                      sum_at(sum_index(at, nearer, 2u)));
    return weight > 0.0 ? vec4(moved, weight) : vec4(0.0);
}

// Displacement since the previous frame, in spacings and eye space, of the surface at depth z. Bilinear over those of
// the four texels around the pixel that have a surface at about this depth; if none has, that of the texel, among
// sixteen, whose surface is nearest to z.
vec3 moved_at(vec2 pixel, float z) {
    vec2 h = pixel / float(texel_edge()) - 0.5;
    ivec2 base = ivec2(floor(h));
    vec2 f = h - vec2(base);
    vec4 w = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    ivec2 last = texel_extent() - 1;
    vec4 sum = vec4(0.0);
    // Loops instead of branches, for CPU drivers (docs/performance.md).
    int texels = z < EMPTY ? 4 : 0;
    for (int i = 0; i < texels; ++i) {
        ivec2 texel = base + ivec2(i & 1, i >> 1);
        if (all(greaterThanEqual(texel, ivec2(0))) && all(lessThanEqual(texel, last)) && w[i] > 0.0) {
            float away;
            vec4 there = texel_sums(texel, z, away);
            sum += away <= frame.surface.w ? w[i] * there : vec4(0.0);
        }
    }
    texels = z < EMPTY && sum.w == 0.0 ? 16 : 0;
    float least = 2.0 * EMPTY;
    for (int i = 0; i < texels; ++i) {
        ivec2 texel = clamp(base + ivec2(i & 3, i >> 2) - 1, ivec2(0), last);
        float away;
        vec4 there = texel_sums(texel, z, away);
        sum = away < least ? there : sum;
        least = min(least, away);
    }
    return sum.w > 0.0 ? sum.xyz / sum.w : vec3(0.0);
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(frame.extent.xy)))) {
        return;
    }
    vec2 pixel = vec2(p) + 0.5;
    vec2 slope = ray_slope(pixel, frame.slope);
    float water = texelFetch(depth, p, 0).x;
    float foam = shown_foam(pixel);
    float front = min(water, foam);
    float z = front;
    vec3 moved = moved_at(pixel, front) * frame.motion.y;
    if (front < EMPTY) {
        z = foam < water ? foam : smoothed_at(pixel, water);
    } else {
        float device = texelFetch(scene_depth, scene_texel(pixel), 0).x;
        float scene = eye_depth(device);
        // Without a scene the depth z is EMPTY too: with a reversed infinite depth, infinity is 1/0, or negative by
        // rounding.
        z = device == frame.before_lens.w || !(scene > 0.0 && scene < EMPTY) ? EMPTY : scene;
    }
    // The vector `change` is the visible point's position in the previous frame's eye space minus its position in
    // this frame's. For points at infinity both positions are directions.
    bool sky = z >= EMPTY;
    vec3 here = vec3(slope, -1.0) * (sky ? 1.0 : z) - moved;
    vec3 change = mat3(frame.before) * here - moved + (sky ? vec3(0.0) : frame.before[3].xyz);
    // A point that was behind the eye in the previous frame had no position on the screen. So that its vector stays
    // finite, the divisor is at least the depth of the near plane (for points at infinity, 1e-3).
    float before = max((sky ? 1.0 : z) - change.z, sky ? 1.0e-3 : frame.before_lens.z);
    vec2 slope_change = (change.xy + slope * change.z) / before;
    vec2 vector = slope * frame.lens_change.xy - frame.lens_change.zw - slope_change * frame.before_lens.xy;
    imageStore(motion, p, vec4(0.5 * frame.extent.xy * vector, 0.0, 0.0));
}
