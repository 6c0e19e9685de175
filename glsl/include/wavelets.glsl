// Small waves that particles do not resolve: a sum of sines over the level plane (src/water/wavelets.rs; Max 1981,
// "Vectorized procedural models for natural terrain"). Not in the thesis.
// Needs frame.glsl. Reads: nothing.

// Cosine of the angle between the water's normal and the vertical: up to the first value water has no waves, from the
// second on it has all of them.
const vec2 LEVEL_WATER = vec2(0.2, 0.7);
// Limits between which a wave fades out. They are widths of a pixel on the water, in wavelengths of the wave: up to
// the first limit the wave has its full height, from the second on it is absent.
const vec2 SMALL_WAVE = vec2(0.2, 0.45);

// Gradient of the waves' height at a point of the world. `pixel` is the width of a pixel on the water in scene units,
// below which waves fade out; with 0 all waves have their full height.
vec3 wavelet_slope(vec3 world, float pixel) {
    vec3 sum = vec3(0.0);
    for (int i = 0; i < frame.wavelets.length(); ++i) {
        vec4 wave = frame.wavelets[i];
        float cycles = length(wave.xyz);
        float shown = 1.0 - smoothstep(SMALL_WAVE.x, SMALL_WAVE.y, pixel * cycles);
        // Vulkan bounds the cosine's error within half a cycle of 0.
        float turn = fract(dot(wave.xyz, world) + wave.w) - 0.5;
        sum -= shown * cos(6.2831853 * turn) / cycles * wave.xyz;
    }
    return frame.texel.z * sum;
}

// Share of the waves on a surface with this normal, in eye space.
float wavelet_share(vec3 n) {
    return smoothstep(LEVEL_WATER.x, LEVEL_WATER.y, dot(n, frame.up.xyz * mat3(frame.world)));
}

// The normal `n`, tilted by `share` times the slope of the waves at the point `at`, in eye space. `pixel` is the
// width of a pixel on the water in scene units.
vec3 turned_by_wavelets(vec3 n, vec3 at, float share, float pixel) {
    vec3 slope = wavelet_slope((frame.world * vec4(at, 1.0)).xyz, pixel) * mat3(frame.world);
    return normalize(n - share * (slope - dot(slope, n) * n));
}

// The normal of a surface with waves on it, in eye space.
vec3 with_wavelets(vec3 n, vec3 at, float thick) {
    float share = wavelet_share(n) * smoothstep(frame.particle.y, 2.0 * frame.particle.y, thick);
    // A loop instead of a branch, for CPU drivers (docs/performance.md).
    bool any = frame.texel.z > 0.0 && share > 0.0;
    while (any) {
        float facing = max(-dot(n, normalize(at)), 0.05);
        n = turned_by_wavelets(n, at, share, frame.texel.y * -at.z / facing);
        any = false;
    }
    return n;
}
