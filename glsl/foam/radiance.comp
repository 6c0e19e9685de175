#version 460
// Pass `radiance`: how much less light comes to the foam of a pixel for what stands round it, and what of the
// environment's it gathers (Akinci et al. 2013, Sec. 2.4; pass 6). Occlusion in as many spheres as there are
// passes, each wider, of points that all pixels share.
// The sun's light and its shadows, which the source has not, are ours.
// Reads: foam depth and intensity beside the depths of fluid and scene, foam normal, points, irradiance,
// environment, what sunlight.glsl reads. Writes: foam radiance.

#include "frame.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"
#include "octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// 1: the environment is asked at the points' directions, as in the source; 0: once, filtered before.
layout(constant_id = 0) const uint SAMPLED = 0;
// 1: each pixel of a block has a sixteenth of all points, and `blur` puts them together. All of them whatever the
// spheres' size, so that foam does not change with the distance: the first few points lie to one side.
layout(constant_id = 1) const uint FAST = 0;

layout(set = 0, binding = 1) uniform sampler2D occluders;
layout(set = 0, binding = 2) uniform sampler2D normals;
// Points of a unit sphere, and how much each counts.
layout(set = 0, binding = 3, std430) readonly buffer Points { vec4 points[]; };
// Octahedral, with a border of a texel.
layout(set = 0, binding = 4) uniform sampler2D irradiance;
layout(set = 0, binding = 5) uniform samplerCube environment;
// Light, shadow.
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D radiance;

// How much of a sample is hidden, over the most it may be: occluders that are too far before it don't count.
float hidden(vec4 there, float depth, float reach) {
    vec3 opacity = vec3(there.y, frame.diffuse_opacity.xy);
    vec3 before = depth - there.xzw;
    vec3 near = max(1.0 - before / reach, 0.0);
    return min(dot(mix(vec3(0.0), near * near * opacity, greaterThan(before, vec3(0.0))), vec3(1.0)), 1.0);
}

// Points of a sphere so many pixels wide: the first of them, and after the last.
uvec2 samples_of(float pixels, ivec2 pixel) {
    if (FAST == 1u) {
        uint count = max(uint(frame.diffuse_samples.y) / 16u, 1u);
        // Runs of the sequence, each of which fills the sphere; those of neighbours lie far from each other in it.
        uvec2 p = uvec2(pixel);
        uint x = p.x ^ p.y;
        uint run = (x & 1u) << 3 | (p.y & 1u) << 2 | (x & 2u) | (p.y & 2u) >> 1;
        return uvec2(run, run + 1u) * count;
    }
    float count = 4.0 / 3.0 * 3.14159265 * pixels * pixels * pixels * frame.diffuse_search.w;
    return uvec2(0u, uint(clamp(count, frame.diffuse_samples.x, frame.diffuse_samples.y) + 0.5));
}

// The environment's light over the hemisphere of a normal, 1/2 of one that is 1 everywhere.
vec3 gathered(vec3 normal, uvec2 run) {
    if (SAMPLED == 0u) {
        vec2 texels = vec2(textureSize(irradiance, 0));
        vec2 at = (0.5 * octahedral_place(normal) + 0.5) * (texels - 2.0) + 1.0;
        return textureLod(irradiance, at / texels, 0.0).rgb;
    }
    vec3 sum = vec3(0.0);
    for (uint i = run.x; i < run.y; ++i) {
        vec3 direction = mat3(frame.world) * normalize(points[i].xyz);
        float cosine = dot(direction, normal);
        direction -= 2.0 * min(cosine, 0.0) * normal;
        sum += abs(cosine) * textureLod(environment, direction, 0.0).rgb;
    }
    return sum / float(run.y - run.x);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.extent.xy)))) {
        return;
    }
    float depth = texelFetch(occluders, pixel, 0).x;
    if (depth >= EMPTY) {
        imageStore(radiance, pixel, vec4(0.0));
        return;
    }
    vec4 with = texelFetch(normals, pixel, 0);
    vec3 position = vec3(ray_slope(vec2(pixel) + 0.5, frame.slope) * depth, -depth);
    float metres = depth / abs(frame.projection.y); // of half the picture's height
    uint passes = uint(frame.diffuse_search.z);
    vec2 sum = vec2(0.0);
    uvec2 first = uvec2(0u, 1u);
    for (uint pass = 1u; pass <= passes; ++pass) {
        float search = with.w * (frame.diffuse_search.x + frame.diffuse_search.y * float(pass));
        float radius = search * metres;
        float reach = frame.diffuse_samples.z > 0.0 ? frame.diffuse_samples.z * radius : -frame.diffuse_samples.z;
        uvec2 run = samples_of(0.5 * search * frame.extent.y, pixel);
        first = pass == 1u ? run : first;
        for (uint i = run.x; i < run.y; ++i) {
            vec4 point = points[i];
            vec3 s = position + radius * point.xyz;
            vec2 at = (s.xy / -s.z - frame.slope.zw) / frame.slope.xy;
            bool seen = -s.z > frame.depth.z && all(greaterThanEqual(at, vec2(0.0)))
                && all(lessThan(at, frame.extent.xy));
            if (seen) {
                vec4 there = texelFetch(occluders, ivec2(at), 0);
                sum += point.w * vec2(hidden(there, -s.z, reach), 1.0);
            }
        }
    }
    // The environment is without the sun. Foam is soft: it is lit beyond where it is turned away.
    float turned = dot(mat3(frame.world) * frame.sun_direction.xyz, with.xyz);
    vec3 sun = frame.diffuse_sun.rgb * sunlight(position, vec2(pixel) + 0.5) * max((turned + 0.5) / 1.5, 0.0);
    vec3 light = gathered(with.xyz, first) + sun;
    float part = sum.y > 0.0 ? sum.x / sum.y : 0.0;
    float shadow = pow(max(part * frame.diffuse_opacity.z, 1.0e-20), frame.diffuse_opacity.w) + frame.diffuse_shadow.w;
    imageStore(radiance, pixel, vec4(light, clamp(shadow, 0.0, 1.0)));
}
