// Value noise that leaves out what a pixel cannot show, for all shaders of pass `scene`. Needs nothing.

float hash(ivec3 p) {
    uint h = uint(p.x) * 0x8da6b343u ^ uint(p.y) * 0xd8163841u ^ uint(p.z) * 0xcb1ab31fu;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    h ^= h >> 15;
    return float(h >> 8) / 16777216.0;
}

// Value noise in [-1, 1].
float noise(vec3 p) {
    ivec3 i = ivec3(floor(p));
    vec3 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    vec4 low = vec4(hash(i), hash(i + ivec3(1, 0, 0)), hash(i + ivec3(0, 1, 0)), hash(i + ivec3(1, 1, 0)));
    ivec3 j = i + ivec3(0, 0, 1);
    vec4 high = vec4(hash(j), hash(j + ivec3(1, 0, 0)), hash(j + ivec3(0, 1, 0)), hash(j + ivec3(1, 1, 0)));
    vec4 z = mix(low, high, f.z);
    vec2 y = mix(z.xy, z.zw, f.y);
    return 2.0 * mix(y.x, y.y, f.x) - 1.0;
}

// The same on a plane.
float noise(vec2 p, int seed) {
    ivec2 i = ivec2(floor(p));
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    vec2 low = vec2(hash(ivec3(i, seed)), hash(ivec3(i + ivec2(1, 0), seed)));
    vec2 high = vec2(hash(ivec3(i + ivec2(0, 1), seed)), hash(ivec3(i + ivec2(1, 1), seed)));
    vec2 y = mix(low, high, f.y);
    return 2.0 * mix(y.x, y.y, f.x) - 1.0;
}

// Amplitude of a wave with this frequency after filtering with a footprint of this width, relative to before.
float kept(float width, float frequency) {
    return 1.0 - smoothstep(0.25, 0.9, width * frequency);
}

// Sum of octaves of value noise at `p`, the first with this frequency. An octave fades out while `width`, that of the
// pixel's footprint, grows from a quarter to 0.9 of its cells.
float octaves(vec3 p, float frequency, int count, float width) {
    float sum = 0.0;
    float amplitude = 0.5;
    for (int i = 0; i < count; ++i) {
        float share = kept(width, frequency);
        if (share <= 0.0) {
            break;
        }
        sum += amplitude * share * noise(p * frequency + float(i) * 19.7);
        amplitude *= 0.55;
        frequency *= 2.13;
    }
    return sum;
}
