#version 460
// Pass `shoreline`: foam on the host's water surface: along shores, by the map of distances or by the slope of the
// ground (blog), and around objects (Lettier, Foam). Differs from both sources: there is no mesh, and a pixel may be
// covered in part, where the sources clip.
// Reads: lists of tiles, scene depth, surface depth, noise, foam texture, map, mask, shoreline foam of the strip,
// inputs of sunlight.glsl. Writes: shoreline foam, contact foam, blocked share of sunlight, marks.

#extension GL_EXT_control_flow_attributes : require
#include "frame.glsl"
#include "shore.glsl"
#include "shoreline.glsl"
#include "contact.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"

// Four tiles per workgroup, 2x2 pixels per invocation.
layout(local_size_x = 64) in;
layout(set = 0, binding = 2) uniform sampler2D scene_depth;
layout(set = 0, binding = 8, rgba8) uniform image2D foam;

#include "shore_lists.glsl"
#include "shore_drawn.glsl"

// Kinds of foam that this pipeline computes: 1 shoreline, 2 contact (around objects), 3 both. One pipeline each
// instead of branches, for CPU drivers (docs/performance.md).
layout(constant_id = 1) const uint PARTS = 3;

#include "shore_light.glsl"
#include "shore_place.glsl"

// Foam farther away than this eye depth, in scene units, is left out. Up to here the squares of changes per pixel are
// finite in single precision, even if the view ray is nearly level.
const float FARTHEST = 1.0e9;

// The shore coordinate v (0 at the sea's edge of the foam, 1 at the shore line, 2 inland) without a map: by the
// horizontal distance from the surface point at depth `z` to the plane of the bed behind it, which is also right for
// walls. v is 0, as far from the shore, if the surface is seen from below, because the scene behind it is then no bed,
// and if the plane is unknown, because on one of the screen axes no neighbouring pixel shows a scene.
float v_by_depth(vec2 pixel, vec3 ray, float z, float scene) {
    vec3 places[3];
    places[0] = ray * scene;
    bool known = true;
    for (int i = 1; i < 3; ++i) {
        // For the slope of the bed, takes on each screen axis the one of the two neighbouring pixels whose depth is
        // nearer to the pixel's own.
        vec2 to = i == 1 ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
        float best = EMPTY;
        for (int k = -1; k < 2; k += 2) {
            vec2 beside = clamp(pixel + float(k) * to, vec2(0.5), frame.extent.xy - 0.5);
            float next = scene_of(texelFetch(scene_depth, scene_texel(beside), 0).x);
            if (next > 0.0 && abs(next - scene) < abs(best - scene) && beside != pixel) {
                best = next;
                places[i] = vec3(ray_slope(beside, frame.slope), -1.0) * next;
            }
        }
        known = known && best < EMPTY;
        places[i] = best < EMPTY ? places[i] : places[0];
    }
    vec3 normal = cross(places[1] - places[0], places[2] - places[0]);
    float up = abs(dot(shore.height.xyz, normal));
    float level = sqrt(max(dot(normal, normal) - up * up, 0.0));
    // Distance of the surface point from the plane, times the normal's length.
    float off = max(1.0 - z / scene, 0.0) * abs(dot(normal, places[0]));
    float v = v_of(-off / max(level, 1.0e-3 * up + 1.0e-20));
    return known && dot(shore.height.xyz, ray) < 0.0 ? v : 0.0;
}

// The surface at a pixel; at the depth FARTHEST if it is farther away or not seen.
Water water_at(vec2 pixel) {
    vec3 ray = vec3(ray_slope(pixel, frame.slope), -1.0);
    float z = surface_at(pixel, ray);
    return water_point(ray, z > 0.0 ? min(z, FARTHEST) : FARTHEST);
}

// Shades a pixel; `device` is the scene's device depth.
bool shaded(uvec2 texel, bool listed, float device, Mixed mixed, float v, float pattern) {
    vec2 pixel = vec2(texel) + 0.5;
    bool inside = listed && all(lessThan(pixel, frame.extent.xy));
    pixel = min(pixel, frame.extent.xy - 0.5);
    vec3 ray = vec3(ray_slope(pixel, frame.slope), -1.0);
    float scene = scene_of(device);
    float z = surface_at(pixel, ray);
    bool own = inside && z < FARTHEST && seen_before(z, scene);
    float line = 0.0;
    if ((PARTS & 1u) != 0u) {
        line = own && v > 0.0 && v < 2.0 ? covered(mixed, pixel) : 0.0;
    }
    float amount = 0.0;
    if ((PARTS & 2u) != 0u) {
        float far = contact_distance(ray, z, scene) * shore.contact.x;
        float part = contact_foam(far, pattern) * shore.mask_part.z;
        amount = own && far >= 0.0 ? part : 0.0;
    }
    bool foams = line + amount > 0.0;
    if (foams) {
        // If the host gives a strip (a mesh along the shore), its shoreline foam is already in the image and is kept.
        float strip = PARTS == 2u ? imageLoad(foam, ivec2(texel)).x : 0.0;
        imageStore(foam, ivec2(texel), vec4(max(line, strip), amount, sun_lost(ray * z, pixel), 0.0));
    }
    return foams;
}

// One pixel of a surface of any shape.
bool shaded_alone(uvec2 texel, bool listed) {
    vec2 pixel = min(vec2(texel) + 0.5, frame.extent.xy - 0.5);
    Water w = water_at(pixel);
    float device = texelFetch(scene_depth, scene_texel(pixel), 0).x;
    Mixed mixed;
    float v = 0.0;
    float pattern = 0.0;
    if ((PARTS & 1u) != 0u) {
        vec2 dv;
        v = mapped(w, dv);
        if (shore.reach.w > 2.5) {
            float scene = scene_of(device);
            v = scene > 0.0 ? v_by_depth(pixel, w.ray, surface_at(pixel, w.ray), scene) : 0.0;
            dv = vec2(0.0);
        }
        v = clamp(v, 0.0, 2.0);
        mixed = mixed_at(place_at(w.p, w.across, dv), v, vec2(0.0));
    }
    if ((PARTS & 2u) != 0u) {
        pattern = pattern_at(pixel, w.p, w.across).x;
    }
    return shaded(texel, listed, device, mixed, v, pattern);
}

// Shades the foam of 2x2 pixels of a level surface at once; values that change little between them are computed once.
bool shaded_together(uvec2 first, bool listed) {
    vec2 middle = vec2(first) + 1.0;
    Water w = water_at(middle);
    vec2 dv = vec2(0.0);
    float v = 0.0;
    Place place;
    vec3 pattern = vec3(0.0);
    if ((PARTS & 1u) != 0u) {
        v = mapped(w, dv);
        dv = v > 0.0 ? dv : vec2(0.0);
        place = place_at(w.p, w.across, dv);
    }
    if ((PARTS & 2u) != 0u) {
        pattern = pattern_at(middle, w.p, w.across);
    }
    vec2 texture_size = vec2(textureSize(scene_depth, 0));
    vec4 devices = textureGather(scene_depth, (middle + frame.scene_origin.xy) / texture_size).wzxy;
    bool foams = false;
    // The loop over the four pixels is unrolled, because in a loop a CPU driver reads buffers for each lane
    // separately.
    [[unroll]] for (int i = 0; i < 4; ++i) {
        uvec2 to = uvec2(i & 1, i >> 1);
        vec2 off = vec2(to) - 0.5;
        float here = v + dot(dv, off);
        Mixed mixed;
        if ((PARTS & 1u) != 0u) {
            mixed = mixed_at(place, clamp(here, 0.0, 2.0), off);
        }
        foams = shaded(first + to, listed, devices[i], mixed, here, pattern.x + dot(pattern.yz, off)) || foams;
    }
    return foams;
}

void main() {
    uint tile;
    bool listed = tile_of(PARTS, gl_LocalInvocationID.x / 16u, tile);
    uvec2 quad = uvec2(gl_LocalInvocationID.x & 3u, gl_LocalInvocationID.x >> 2u & 3u);
    uvec2 first = first_of(tile) + 2u * quad;
    bool foams = false;
    if (GENERAL == 0u) {
        foams = shaded_together(first, listed);
    } else {
        for (uint k = 0u; k < 4u; ++k) {
            foams = shaded_alone(first + uvec2(k & 1u, k >> 1), listed) || foams;
        }
    }
    if (foams) {
        draws(tile);
    }
}
