#version 460
// Pass `radiance`: ambient occlusion and environment light of the whitewater in each pixel (Akinci et al. 2013, Sec.
// 2.4; pass 6). Occlusion is sampled at points in several spheres around the visible point, each larger than the one
// before. Without FAST all pixels have the same points. Not in the paper: the sun's light and shadows, and the normal
// of particles whose radius is less than a pixel. A pixel's centre hits an arbitrary point of such a particle's
// sphere, and shading by the normal there makes far foam look like salt and pepper. Instead the normal is the
// direction in which the samples of the occlusion find open space, so that a plume is lit as one body. For a radius
// between one and two pixels both normals are mixed.
// Reads: tiles with foam, depths of foam, fluid and scene, foam intensity, foam normal, points, irradiance,
// environment, inputs of sunlight.glsl. Writes: foam normal, foam radiance.

#include "frame.glsl"
#include "falloff.glsl"
#include "whitewater.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"
#include "octahedral.glsl"
#include "whitewater_tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// 1: light of the environment is the mean of look-ups in the directions of the points, as in the paper; 0: it is one
// look-up in the irradiance map.
layout(constant_id = 0) const uint SAMPLED = 0;
// 1: each pixel of a 4x4 block uses a sixteenth of the points, and `blur` combines the pixels. A sixteenth consists
// of pairs of opposite points, so an occluder that fills half of the sphere hides half of the points, whatever its
// slope. Isolated foam needs that, because it gets no help from its neighbours' points. The number of points does not
// depend on the size of the spheres, so that foam does not change with the distance.
layout(constant_id = 1) const uint FAST = 0;
// Max number of points of all sixteen pixels together.
const float FAST_SAMPLES = 320.0;

layout(set = 0, binding = 1) uniform sampler2D occluders;
// xyz: normal; w: search radius.
layout(set = 0, binding = 2, rgba16f) uniform image2D normals;
// Points of a unit sphere, and their weights. With FAST the buffer holds one of each pair of opposite points.
layout(set = 0, binding = 3, std430) readonly buffer Points { vec4 points[]; };
// Octahedral, with a border of one texel.
layout(set = 0, binding = 4) uniform sampler2D irradiance;
layout(set = 0, binding = 5) uniform samplerCube environment;
// rgb: light; a: shadow.
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D radiance;

// Weight of the direction to the eye. It is added to the open direction (where the samples are least occluded), which
// is arbitrary in haze that is equally dense on all sides.
const float TO_EYE = 0.02;

// Occlusion of a point of a sphere. x: from 0 to 1; an occluder counts less the farther it is in front of the point,
// and not at all from the distance `reach` on. y: the same with occluders at any distance counted fully.
vec2 hidden(vec4 there, float depth, float reach) {
    vec3 opacity = vec3(there.y, frame.whitewater_opacity.xy);
    vec3 before = depth - there.xzw;
    // `near` is clamped to 1: a layer without water or foam has the depth EMPTY, so far behind the point that the
    // square of `near` would overflow.
    vec3 near = clamp(1.0 - before / reach, 0.0, 1.0);
    opacity = mix(vec3(0.0), opacity, greaterThan(before, vec3(0.0)));
    return min(vec2(dot(near * near, opacity), dot(vec3(1.0), opacity)), 1.0);
}

vec4 point_of(uint i) {
    if (FAST == 0u) {
        return points[i];
    }
    vec4 one = points[i >> 1];
    return vec4((i & 1u) == 0u ? one.xyz : -one.xyz, one.w);
}

// The points that a pixel uses for one sphere, whose number is `pass` and whose radius is `pixels`: index of the
// first point, and index after the last.
uvec2 samples_of(float pixels, ivec2 pixel, uint pass) {
    if (FAST == 1u) {
        uint count = 2u * max(uint(min(frame.whitewater_samples.y, FAST_SAMPLES)) / 32u, 1u);
        // For each sphere (pass) a pixel uses a run of the sequence of points, and each run fills the sphere. The
        // runs of neighbouring pixels, and those of a pixel's spheres, are far apart in the sequence, so that three
        // spheres together have three times the points.
        uvec2 p = uvec2(pixel);
        uint x = p.x ^ p.y;
        uint run = (x & 1u) << 3 | (p.y & 1u) << 2 | (x & 2u) | (p.y & 2u) >> 1;
        run = run + 5u * pass & 15u;
        return uvec2(run, run + 1u) * count;
    }
    float count = 4.0 / 3.0 * 3.14159265 * pixels * pixels * pixels * frame.whitewater_search.w;
    return uvec2(0u, uint(clamp(count, frame.whitewater_samples.x, frame.whitewater_samples.y) + 0.5));
}

// Search radius of a pass in half heights of the picture.
float search_of(float foam, uint pass) {
    return foam * (frame.whitewater_search.x + frame.whitewater_search.y * float(pass));
}

// Light of the environment over the hemisphere of a normal, weighted by the cosine; 1/2 if the environment is 1
// everywhere. With FAST, a pixel has few directions, so the sum is divided by twice the sum of their cosines, and not
// by their number: then the result is exactly 1/2.
vec3 gathered(vec3 normal, uvec2 run) {
    if (SAMPLED == 0u) {
        vec2 at = octahedral_texture_place(normal, textureSize(irradiance, 0));
        return textureLod(irradiance, at, 0.0).rgb;
    }
    vec3 sum = vec3(0.0);
    float cosines = 0.0;
    for (uint i = run.x; i < run.y; ++i) {
        vec3 direction = mat3(frame.world) * normalize(point_of(i).xyz);
        float cosine = dot(direction, normal);
        direction -= 2.0 * min(cosine, 0.0) * normal;
        sum += abs(cosine) * textureLod(environment, direction, 0.0).rgb;
        cosines += abs(cosine);
    }
    return sum / (FAST == 1u ? max(2.0 * cosines, 1.0e-6) : float(run.y - run.x));
}

void main() {
    ivec2 pixel;
    if (!tile_pixel(pixel)) {
        return;
    }
    float depth = texelFetch(occluders, pixel, 0).x;
    if (depth >= EMPTY) {
        return;
    }
    vec4 with = imageLoad(normals, pixel);
    vec3 position = vec3(ray_slope(vec2(pixel) + 0.5, frame.slope) * depth, -depth);
    float metres = depth / abs(frame.projection.y); // scene units per half height of the picture
    uint passes = uint(frame.whitewater_search.z);
    vec3 sum = vec3(0.0);
    // Sums of the points' vectors: weighted by occlusion at any distance, and unweighted.
    vec3 dark = vec3(0.0);
    vec3 whole = vec3(0.0);
    for (uint pass = 1u; pass <= passes; ++pass) {
        float search = search_of(with.w, pass);
        float radius = search * metres;
        float reach = frame.whitewater_samples.z > 0.0 ? frame.whitewater_samples.z * radius : -frame.whitewater_samples.z;
        uvec2 run = samples_of(0.5 * search * frame.extent.y, pixel, pass);
        for (uint i = run.x; i < run.y; ++i) {
            vec4 point = point_of(i);
            vec3 s = position + radius * point.xyz;
            vec2 at = (s.xy / -s.z - frame.slope.zw) / frame.slope.xy;
            bool seen = -s.z > frame.depth.z && all(greaterThanEqual(at, vec2(0.0)))
                && all(lessThan(at, frame.extent.xy));
            if (seen) {
                vec4 there = texelFetch(occluders, ivec2(at), 0);
                vec2 parts = hidden(there, -s.z, reach);
                sum += point.w * vec3(parts, 1.0);
                dark += point.w * parts.y * point.xyz;
                whole += point.w * point.xyz;
            }
        }
    }
    vec2 parts = sum.z > 0.0 ? sum.xy / sum.z : vec2(0.0);
    // The open direction: the weighted sum of the vectors to the samples, each times the mean occlusion of all minus
    // its own, plus a little of the direction to the eye.
    vec3 open = parts.y * whole - dark + vec3(0.0, 0.0, max(TO_EYE * sum.z, 1.0e-6));
    float told = told_of(0.5 * with.w * frame.extent.y);
    vec3 facing = mix(mat3(frame.world) * normalize(open), with.xyz, told);
    // Two opposite vectors have no mean.
    vec3 normal = dot(facing, facing) > 1.0e-6 ? normalize(facing) : with.xyz;
    if (told < 1.0) {
        imageStore(normals, pixel, vec4(normal, with.w));
    }
    // Sunlight is added, because the environment does not contain the sun. Foam scatters light, so it is lit up to an
    // angle of 120° between its normal and the sun, instead of 90°.
    float turned = dot(mat3(frame.world) * frame.sun_direction.xyz, normal);
    vec3 sun = frame.whitewater_sun.rgb * sunlight(position, vec2(pixel) + 0.5) * max((turned + 0.5) / 1.5, 0.0);
    // With SAMPLED the environment is looked up in the directions of the points of the first sphere, even if `passes`
    // is 0 and no occlusion is sampled.
    uvec2 first = samples_of(0.5 * search_of(with.w, 1u) * frame.extent.y, pixel, 1u);
    vec3 light = gathered(normal, first) + sun;
    float share = parts.x * frame.whitewater_opacity.z;
    // pow() of 0 is NaN with some drivers.
    float shadow = (share > 0.0 ? pow(share, frame.whitewater_opacity.w) : 0.0) + frame.whitewater_shadow.w;
    imageStore(radiance, pixel, vec4(light, clamp(shadow, 0.0, 1.0)));
}
