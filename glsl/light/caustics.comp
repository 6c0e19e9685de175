#version 460
// Pass `caustics`: for each texel of the light map (water seen from the sun), refracts the sunlight at the water's
// front surface and adds it to the texel of the map where it leaves the water again, usually at the ground (caustics
// mapping, Shah et al. 2007, without its mesh). No light enters where the host's scene shadows the water; without
// this test, light would enter through the water's side at a wall and spread along the bed.
// Reads: smoothed front, thickness, shadow map or its basis and span. Writes: photons, fixed point, summed.

#include "frame.glsl"
#include "convolution.glsl"
#include "scene_shadow.glsl"
#include "wavelets.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1) uniform sampler2D smoothed;
layout(set = 0, binding = 2) uniform sampler2D thickness;
layout(set = 0, binding = 3, std430) buffer Photons { uint photons[]; };

// Fixed-point steps per texel's light.
const float UNITS = 4096.0;
// Refractive index of water relative to air.
const float INDEX = 1.333;
// The slope of the water surface is a difference between texels this far to either side: SOFT times the water's
// thickness along the light, from 1 to MOST_SOFT texels. Shorter waves are ignored: they focus light far above the
// bed. On the bed their light is nearly uniform again, and ripples too small for the particles spread what is left.
const float SOFT = 1.0 / 16.0;
const int MOST_SOFT = 8;

// Eye-space position of a point at `place` (0 to 1) in the light's maps and at `depth` along the light, in scene
// units. This inverts `to_light`, whose rows are orthogonal.
vec3 eye_at(vec2 place, float depth) {
    mat4 rows = transpose(frame.to_light);
    vec3 off = vec3(place, depth) - vec3(rows[0].w, rows[1].w, rows[2].w);
    return rows[0].xyz * (off.x / dot(rows[0].xyz, rows[0].xyz)) + rows[1].xyz * (off.y / dot(rows[1].xyz, rows[1].xyz))
         + rows[2].xyz * (off.z / dot(rows[2].xyz, rows[2].xyz));
}

// Tilts the water surface's normal `n` by the small waves (wavelets.glsl). `n` and the result are in the axes of the
// light map. No wave is left out as too small for a pixel, because waves of any size focus light.
vec3 with_waves(vec3 n, vec2 place, float depth) {
    mat3 rows = transpose(mat3(frame.to_light));
    mat3 axes = mat3(normalize(rows[0]), normalize(rows[1]), normalize(rows[2]));
    vec3 eye = axes * n;
    float share = wavelet_share(eye);
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    bool any = frame.texel.z > 0.0 && share > 0.0;
    while (any) {
        n = turned_by_wavelets(eye, eye_at(place, depth), share, 0.0) * axes;
        any = false;
    }
    return n;
}

float front_at(ivec2 texel, float here) {
    float there = texelFetch(smoothed, clamp(texel, ivec2(0), ivec2(frame.light_map.x) - 1), 0).x;
    return abs(there - here) <= frame.smoothing.y ? there : here;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    int size = int(frame.light_map.x);
    if (any(greaterThanEqual(texel, ivec2(size)))) {
        return;
    }
    float here = texelFetch(smoothed, texel, 0).x;
    if (here >= EMPTY) {
        return;
    }
    // In these axes the light goes along +z.
    vec2 deep = texelFetch(thickness, texel, 0).xy;
    int reach = clamp(int(SOFT * deep.x / frame.light_map.y + 0.5), 1, MOST_SOFT);
    ivec2 aside = ivec2(reach, 0);
    vec2 rise = vec2(front_at(texel + aside.xy, here) - front_at(texel - aside.xy, here),
                     front_at(texel + aside.yx, here) - front_at(texel - aside.yx, here))
              / (2.0 * float(reach) * frame.light_map.y);
    vec3 n = with_waves(normalize(vec3(rise, -1.0)), (vec2(texel) + 0.5) / float(size), here);
    vec3 bent = refract(vec3(0.0, 0.0, 1.0), n, 1.0 / INDEX);
    // Distance along which refraction moves the light aside: the water's thickness, but reduced, down to 0, for drops
    // and thin layers of water, because light that they focus diverges again before it reaches the ground, and by
    // foam, because it scatters the light.
    float lens = deep.x * smoothstep(frame.particle.y, 4.0 * frame.particle.y, deep.x)
               * exp(-4.0 * frame.shade.w * deep.y);
    // Visibility of the sun: from the host's shadow map. It is 1 if the host gives none, or a shadow mask instead,
    // because a mask has the shadow per pixel of the picture and not per texel of this light map.
    float sun = SHADOW > 1u ? past_scene(eye_at((vec2(texel) + 0.5) / float(size), here), vec2(0.0)) : 1.0;
    vec2 at = vec2(texel) + bent.xy / max(bent.z, 0.2) * (lens / frame.light_map.y);
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    for (int i = 0; i < 4; ++i) {
        ivec2 t = base + ivec2(i & 1, i >> 1);
        float part = ((i & 1) == 0 ? 1.0 - f.x : f.x) * (i < 2 ? 1.0 - f.y : f.y);
        if (all(greaterThanEqual(t, ivec2(0))) && all(lessThan(t, ivec2(size)))) {
            atomicAdd(photons[t.y * size + t.x], uint(part * sun * UNITS + 0.5));
        }
    }
}
