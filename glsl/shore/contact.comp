#version 460
// Pass `contact`: foam around objects (Lettier, Foam) on the water of particles, placed on its smoothed surface.
// Reads: list of tiles, depth, smoothed, levels, scene depth, web, mask. Writes: contact foam, for pixels with some.
// `composite` evaluates the sunlight on this foam, because the host's water surface behind it may be lit differently.

#include "frame.glsl"
#include "level.glsl"
#include "smoothed_depth.glsl"
#include "shore.glsl"
#include "shoreline.glsl"
#include "contact.glsl"

// Four tiles per workgroup.
layout(local_size_x = 256) in;
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 8, rgba8) uniform image2D foam;

#include "shore_lists.glsl"

void main() {
    uint tile;
    bool listed = tile_of(5u, gl_LocalInvocationID.x / 64u, tile);
    uvec2 own = uvec2(gl_LocalInvocationID.x & 7u, gl_LocalInvocationID.x >> 3u & 7u);
    ivec2 texel = ivec2(first_of(tile) + own);
    if (!listed || any(greaterThanEqual(texel, ivec2(frame.extent.xy)))) {
        return;
    }
    float front = texelFetch(depth, texel, 0).x;
    vec2 pixel = vec2(texel) + 0.5;
    float scene = scene_of(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    vec3 ray = vec3(ray_slope(pixel, frame.slope), -1.0);
    // Lower bound of the contact distance: the smoothed surface, at which `far` is computed, is at most
    // `frame.surface.w` behind the unsmoothed one.
    float near = contact_distance(ray, front + frame.surface.w, scene) * shore.contact.y;
    bool go = front < EMPTY && scene > 0.0 && near < 1.0;
    for (; go; go = false) {
        float z = smoothed_at(pixel, front);
        // Here water is in front of the scene, and only the smoothing may have moved its surface behind it. The two
        // meet there, so a negative distance counts as 0 (contact_foam): without foam there would be gaps along the
        // objects. On the host's surface (shoreline.comp) a negative distance means that an object is in front of it.
        float far = contact_distance(ray, z, scene) * shore.contact.y;
        Water w = water_point(ray, z);
        float amount = far < 1.0 ? contact_foam(far, pattern_at(pixel, w.p, w.across).x) : 0.0;
        amount *= shore.mask_part.w;
        if (amount > 0.0) {
            vec4 there = imageLoad(foam, texel);
            imageStore(foam, texel, vec4(there.xyz, amount));
        }
    }
}
