#version 460
// Pass `caustics`: light refracted by the water, from each texel of the light's map to where it leaves
// the water again, which is mostly the ground (caustics mapping, Shah et al. 2007, without its mesh).
// Reads: smoothed front, thickness. Writes: photons, fixed point, summed.

#include "frame.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1) uniform sampler2D smoothed;
layout(set = 0, binding = 2) uniform sampler2D thickness;
layout(set = 0, binding = 3, std430) buffer Photons { uint photons[]; };

// Parts of a texel's light.
const float UNITS = 4096.0;
// Of water over that of air.
const float INDEX = 1.333;

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
    // The light goes along +z here.
    float wide = 2.0 * frame.light_map.y;
    vec2 rise = vec2(front_at(texel + ivec2(1, 0), here) - front_at(texel - ivec2(1, 0), here),
                     front_at(texel + ivec2(0, 1), here) - front_at(texel - ivec2(0, 1), here)) / wide;
    vec3 bent = refract(vec3(0.0, 0.0, 1.0), normalize(vec3(rise, -1.0)), 1.0 / INDEX);
    vec2 deep = texelFetch(thickness, texel, 0).xy;
    // Drops and thin sheets are no lenses: what they gather is spread again before it lands. Foam
    // scatters it.
    float lens = deep.x * smoothstep(frame.particle.y, 4.0 * frame.particle.y, deep.x)
               * exp(-4.0 * frame.shade.w * deep.y);
    vec2 at = vec2(texel) + bent.xy / max(bent.z, 0.2) * (lens / frame.light_map.y);
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    for (int i = 0; i < 4; ++i) {
        ivec2 t = base + ivec2(i & 1, i >> 1);
        float part = ((i & 1) == 0 ? 1.0 - f.x : f.x) * (i < 2 ? 1.0 - f.y : f.y);
        if (all(greaterThanEqual(t, ivec2(0))) && all(lessThan(t, ivec2(size)))) {
            atomicAdd(photons[t.y * size + t.x], uint(part * UNITS + 0.5));
        }
    }
}
