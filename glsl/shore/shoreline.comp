#version 460
// Pass `shoreline`: foam on the host's water surface: along shores by the map of distances or the bottom's slope (blog),
// and round what stands in it (Lettier, Foam).
// Not in the sources: no mesh; what a pixel covers of the foam, where they clip.
// Reads: list of tiles, scene depth, surface depth, noise, web, map, mask, what sunlight.glsl reads. Writes: shoreline
// foam, contact foam, what of the sun's light does not come there.

#include "frame.glsl"
#include "shore.glsl"
#include "shoreline.glsl"
#include "contact.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 8, rgba8) uniform image2D foam;
layout(set = 0, binding = 9, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 10, std430) readonly buffer Arguments { uvec4 arguments[4]; };
layout(push_constant, std430) uniform Push {
    uint across; // tiles
    uint most;   // of a list
} push;

// What tiles may have, 1: shoreline foam, 2: contact foam, 3: both. A pipeline each, not branches: a CPU runs them whole.
layout(constant_id = 1) const uint PARTS = 3;

#include "shore_light.glsl"
#include "shore_place.glsl"

// Where the depth alone is known: as far from the shore as the bottom's slope would have it.
float v_by_depth(vec2 pixel, vec3 ray, float scene) {
    vec3 places[3];
    places[0] = ray * scene;
    for (int i = 1; i < 3; ++i) {
        // Of the two beside a pixel the one whose depth is nearer to its own.
        vec2 to = i == 1 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
        float best = EMPTY;
        for (int k = -1; k < 2; k += 2) {
            vec2 beside = clamp(pixel + float(k) * to, vec2(0.5), frame.extent.xy - 0.5);
            float z = eye_depth(texelFetch(scene_depth, scene_texel(beside), 0).x);
            if (z > 0.0 && abs(z - scene) < abs(best - scene) && beside != pixel) {
                best = z;
                places[i] = vec3(ray_slope(beside, frame.slope), -1.0) * z;
            }
        }
        places[i] = best < EMPTY ? places[i] : places[0];
    }
    vec3 normal = cross(places[1] - places[0], places[2] - places[0]);
    float up = abs(dot(shore.height.xyz, normal));
    float level = sqrt(max(dot(normal, normal) - up * up, 0.0));
    float below = -dot(shore.height.xyz, places[0]) - shore.height.w;
    return v_of(-max(below, 0.0) * up / max(level, 1.0e-3 * up + 1.0e-20));
}

void main() {
    uint i = gl_WorkGroupID.y * 65535u + gl_WorkGroupID.x;
    bool inside = i < arguments[PARTS].w;
    uint tile = list[(PARTS - 1u) * push.most + (inside ? i : 0u)];
    uvec2 texel = 16u * uvec2(tile % push.across, tile / push.across) + gl_LocalInvocationID.xy;
    vec2 pixel = vec2(texel) + 0.5;
    inside = inside && all(lessThan(pixel, frame.extent.xy));
    pixel = min(pixel, frame.extent.xy - 0.5);
    vec3 ray = vec3(ray_slope(pixel, frame.slope), -1.0);
    float scene = eye_depth(texelFetch(scene_depth, scene_texel(pixel), 0).x);
    float z = surface_at(pixel, ray);
    bool own = inside && seen_before(z, scene);
    Water w = water_point(ray, own ? z : 1.0);
    float line = 0.0;
    if ((PARTS & 1u) != 0u) {
        vec2 dv = vec2(0.0);
        float v = mapped(w, dv);
        if (GENERAL == 1u && shore.reach.w > 2.5) {
            v = v_by_depth(pixel, ray, scene);
            dv = vec2(0.0);
        }
        v = clamp(v, 0.0, 2.0);
        line = own && v > 0.0 && v < 2.0 ? covered(shoreline_at(w.p, v, w.across, dv), pixel) : 0.0;
    }
    float amount = 0.0;
    if ((PARTS & 2u) != 0u) {
        float far = contact_distance(ray, z, scene) * shore.contact.x;
        float part = eased((1.0 - clamp(far, 0.0, 1.0)) * masked(pixel, w.p, width_of(w))) * shore.mask_part.z;
        amount = own && far >= 0.0 ? part : 0.0;
    }
    if (line + amount > 0.0) {
        // Where there is a strip its foam is here.
        float strip = PARTS == 2u ? imageLoad(foam, ivec2(texel)).x : 0.0;
        imageStore(foam, ivec2(texel), vec4(max(line, strip), amount, sun_lost(ray * z, pixel), 0.0));
    }
}
