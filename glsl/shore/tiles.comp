#version 460
// Pass `shoreline`, first part: the tiles of 16x16 pixels in which there may be foam on the host's surface, by four pixels
// at a time. Not in the sources: most of a picture has none, and what tells is much less than what it is.
// Reads: scene depth, surface depth, map of distances. Writes: marks.

#include "frame.glsl"
#include "shore.glsl"
#include "shore_place.glsl"

layout(local_size_x = 16, local_size_y = 8) in;
// 1: all tiles.
layout(constant_id = 0) const uint ALL = 0;

layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 8, std430) buffer Marks { uint marks[]; };
layout(push_constant, std430) uniform Push { uint across; } push; // tiles

// Eye depths of the scene at four pixels from one on: as they are gathered.
vec4 scene_at_four(ivec2 first) {
    bool same = all(equal(frame.scene_depth.xy, vec2(1.0)));
    vec2 middle = min(vec2(first) + 1.0, frame.scene_depth.zw - 0.5) + frame.scene_origin.xy;
    vec4 four = textureGather(scene_depth, middle / vec2(textureSize(scene_depth, 0)));
    for (int i = same ? 4 : 0; i < 4; ++i) {
        ivec2 to = ivec2(i == 1 || i == 2, i < 2);
        four[i] = texelFetch(scene_depth, scene_texel(vec2(first + to) + 0.5), 0).x;
    }
    return frame.depth.x / (four + frame.depth.y);
}

void main() {
    ivec2 first = 2 * ivec2(gl_GlobalInvocationID.xy);
    bool inside = all(lessThan(vec2(first), frame.extent.xy));
    first = min(first, ivec2(frame.extent.xy) - 1);
    vec4 scene = scene_at_four(first);
    bool some = ALL == 1u || shore.reach.w == 1.0;
    bool seen = false;
    float most = shore.mask_part.z > 0.0 ? shore.contact.x : EMPTY;
    vec3 ray;
    float z = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 pixel = vec2(first) + vec2(i == 1 || i == 2 ? 1.5 : 0.5, i < 2 ? 1.5 : 0.5);
        ray = vec3(ray_slope(pixel, frame.slope), -1.0);
        z = surface_at(pixel, ray);
        bool here = seen_before(z, scene[i]);
        seen = seen || here;
        // No farther than by any measure.
        float part = shore.contact.w == 2.0 ? -dot(shore.height.xyz, ray) : 1.0;
        some = some || here && scene[i] > 0.0 && (scene[i] - z) * part * most < 1.0;
    }
    some = some || seen && shore.reach.w > 2.5;
    for (bool go = seen && !some && shore.reach.w == 2.0; go; go = false) {
        Water w = water_point(ray, z);
        vec2 texel = (w.p - shore.map.xy) * shore.map.z;
        // The texel's middle is less than one away, the other pixels three at most.
        float off = 1.5 / shore.map.z + 3.0 * (length(w.across[0]) + length(w.across[1]));
        vec2 last = vec2(shore.map.w - 1.0);
        float distance = texelFetch(map, ivec2(clamp(texel, vec2(0.0), last)), 0).x;
        float beside = distance + length(texel - clamp(texel, vec2(0.0), last)) / shore.map.z;
        some = (distance - off) * shore.reach.y < 1.0 && (distance + off) * shore.reach.x > -1.0 && beside - distance < off;
    }
    if (some && inside) {
        atomicOr(marks[uint(first.y >> 4) * push.across + uint(first.x >> 4)], 1u);
    }
}
