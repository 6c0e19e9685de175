// Gradient noise (Perlin 2002), and the origin of each particle's own noise in it. Needs random.glsl.

// Three uniform numbers of an id, 0 to 1.
vec3 noise_phase(uint id) {
    uvec3 h = uvec3(pcg(3u * id), pcg(3u * id + 1u), pcg(3u * id + 2u)) >> 8;
    return vec3(h) * (1.0 / 16777216.0);
}

// Factors of a lattice point's coordinates in its hash: primes of xxHash. The products are combined and then mixed
// once, which takes few multiplications. (Perlin 2002 has three look-ups in a permutation table instead.)
const uvec3 LATTICE = uvec3(0x9E3779B1u, 0x85EBCA77u, 0xC2B2AE3Du);

// Dot product of `off` with one of the twelve directions from a cube's centre to its edges, which the hash selects.
// It uses selections instead of branches, because SwiftShader took minutes and gigabytes to compile branches within
// loops.
float lattice_gradient(uint joined, vec3 off) {
    uint h = ((joined ^ (joined >> 15)) * 0x27D4EB2Fu) >> 28;
    float u = mix(off.y, off.x, h < 8u);
    float v = mix(mix(off.z, off.x, (h & 13u) == 12u), off.y, h < 4u);
    return mix(u, -u, (h & 1u) != 0u) + mix(v, -v, (h & 2u) != 0u);
}

// Noise of a row along x, given the row's part of the hash.
float row_noise(uint x, uint row, vec3 off, float fade) {
    return mix(lattice_gradient(x ^ row, off),
               lattice_gradient((x + LATTICE.x) ^ row, off - vec3(1.0, 0.0, 0.0)), fade);
}

// xyz: gradient per cell; w: the noise.
vec4 gradient_noise_slope(vec3 p) {
    vec3 cell = floor(p);
    vec3 f = p - cell;
    vec3 fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    vec3 rise = 30.0 * f * f * (f - 1.0) * (f - 1.0);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 8; ++i) {
        vec3 side = vec3(i & 1, i >> 1 & 1, i >> 2);
        uvec3 at = uvec3(ivec3(cell + side)) * LATTICE;
        uint joined = at.x ^ at.y ^ at.z;
        vec3 gradient = vec3(lattice_gradient(joined, vec3(1.0, 0.0, 0.0)),
                             lattice_gradient(joined, vec3(0.0, 1.0, 0.0)),
                             lattice_gradient(joined, vec3(0.0, 0.0, 1.0)));
        float along = dot(gradient, f - side);
        vec3 part = mix(1.0 - fade, fade, side);
        vec3 change = (2.0 * side - 1.0) * rise;
        sum += part.x * part.y * part.z * vec4(gradient, along);
        sum.xyz += along * change * vec3(part.y * part.z, part.x * part.z, part.x * part.y);
    }
    return sum;
}

// Gradient noise with mean 0, between -1.04 and 1.04.
float gradient_noise(vec3 p) {
    vec3 cell = floor(p);
    vec3 f = p - cell;
    vec3 fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    uvec3 near = uvec3(ivec3(cell)) * LATTICE;
    uvec3 far = near + LATTICE;
    float a = mix(row_noise(near.x, near.y ^ near.z, f, fade.x),
                  row_noise(near.x, far.y ^ near.z, f - vec3(0.0, 1.0, 0.0), fade.x), fade.y);
    float b = mix(row_noise(near.x, near.y ^ far.z, f - vec3(0.0, 0.0, 1.0), fade.x),
                  row_noise(near.x, far.y ^ far.z, f - vec3(0.0, 1.0, 1.0), fade.x), fade.y);
    return mix(a, b, fade.z);
}
