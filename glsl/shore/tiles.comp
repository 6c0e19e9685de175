#version 460
// Pass `shoreline`, first part: the tiles of 16x16 pixels in which there may be foam on the host's surface, by sixteen
// pixels at a time. Not in the sources: most of a picture has none, and what tells is much less than what it is.
// Reads: scene depth, surface depth, map of distances. Writes: marks.

#include "frame.glsl"
#include "shore.glsl"
#include "shore_place.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 8, std430) buffer Marks { uint marks[]; };
layout(push_constant, std430) uniform Push { uint across; } push; // tiles

// Eye depths of the scene at four pixels from one on: as they are gathered.
vec4 scene_at_four(ivec2 first) {
    vec2 middle = min(vec2(first) + 1.0, frame.scene_depth.zw - 0.5) + frame.scene_origin.xy;
    vec4 four = textureGather(scene_depth, middle / vec2(textureSize(scene_depth, 0)));
    // Not a texel a pixel.
    if (GENERAL == 1u) {
        for (int i = 0; i < 4; ++i) {
            ivec2 to = ivec2(i == 1 || i == 2, i < 2);
            four[i] = texelFetch(scene_depth, scene_texel(vec2(first + to) + 0.5), 0).x;
        }
    }
    return frame.depth.x / (four + frame.depth.y);
}

// Whether contact foam may be on any of four pixels, and whether the surface is seen in any.
bvec2 four_at(ivec2 first) {
    vec4 scene = scene_at_four(first);
    float most = shore.mask_part.z > 0.0 ? shore.contact.x : EMPTY;
    bvec2 found = bvec2(false);
    for (int i = 0; i < 4; ++i) {
        vec2 pixel = vec2(first) + vec2(i == 1 || i == 2 ? 1.5 : 0.5, i < 2 ? 1.5 : 0.5);
        vec3 ray = vec3(ray_slope(pixel, frame.slope), -1.0);
        float z = surface_at(pixel, ray);
        bool seen = seen_before(z, scene[i]);
        // No farther than by any measure.
        float part = shore.contact.w == 2.0 ? -dot(shore.height.xyz, ray) : 1.0;
        bool near = seen && scene[i] > 0.0 && (scene[i] - z) * part * most < 1.0;
        found = bvec2(found.x || near, found.y || seen);
    }
    return found;
}

void main() {
    ivec2 first = 4 * ivec2(gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(vec2(first), frame.extent.xy));
    bvec2 found = bvec2(false);
    for (int i = 0; i < 4; ++i) {
        ivec2 four = min(first + 2 * ivec2(i & 1, i >> 1), ivec2(frame.extent.xy) - 1);
        bvec2 here = four_at(four);
        found = bvec2(found.x || here.x, found.y || here.y);
    }
    vec2 pixel = min(vec2(first) + 2.0, frame.extent.xy - 0.5);
    vec3 ray = vec3(ray_slope(pixel, frame.slope), -1.0);
    Water w = water_point(ray, surface_at(pixel, ray));
    vec2 texel = (w.p - shore.map.xy) * shore.map.z;
    vec2 inner = clamp(texel, vec2(0.0), vec2(max(shore.map.w - 1.0, 0.0)));
    // The texel's middle is less than one and a half away, no pixel's more than two and a half.
    float off = 1.5 / max(shore.map.z, 1.0e-9) + 2.5 * (length(w.across[0]) + length(w.across[1]));
    float distance = texelFetch(map, ivec2(inner), 0).x;
    bool band = (distance - off) * shore.reach.y < 1.0 && (distance + off) * shore.reach.x > -1.0
        && length(texel - inner) < off * max(shore.map.z, 1.0e-9);
    bool line = found.y && (shore.reach.w > 2.5 || shore.reach.w == 2.0 && (band || shore.surface_part.z > 1.5));
    // A strip may be anywhere.
    uint mark = (line ? 1u : 0u) | (found.x ? 2u : 0u) | (shore.reach.w == 1.0 ? 4u : 0u);
    if (mark != 0u && inside) {
        atomicOr(marks[uint(first.y >> 4) * push.across + uint(first.x >> 4)], mark);
    }
}
