// Value noise that leaves out what a pixel cannot show, for all shaders of pass `scene`. Needs nothing.

// Factors of a point's coordinates in its hash.
const uvec3 HASH = uvec3(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);

// Hashes of four points, in [0, 1), from the xor of each point's products. Four at once, because compilers inline each
// call.
vec4 hashed(uvec4 h) {
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    h ^= h >> 15;
    return vec4(h >> 8) / 16777216.0;
}

float hash(ivec3 p) {
    uvec3 h = uvec3(p) * HASH;
    return hashed(uvec4(h.x ^ h.y ^ h.z)).x;
}

// The xor of the products of x and y at the corners of a cell with this lowest corner: x varies fastest.
uvec4 corners(ivec2 p) {
    uvec2 x = uvec2(p.x, p.x + 1) * HASH.x, y = uvec2(p.y, p.y + 1) * HASH.y;
    return x.xyxy ^ y.xxyy;
}

// Value noise in [-1, 1].
float noise(vec3 p) {
    ivec3 i = ivec3(floor(p));
    vec3 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    uvec4 xy = corners(i.xy);
    uvec2 z = uvec2(i.z, i.z + 1) * HASH.z;
    vec4 level = mix(hashed(xy ^ z.x), hashed(xy ^ z.y), f.z);
    vec2 y = mix(level.xy, level.zw, f.y);
    return 2.0 * mix(y.x, y.y, f.x) - 1.0;
}

// The same on a plane.
float noise(vec2 p, int seed) {
    ivec2 i = ivec2(floor(p));
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    vec4 level = hashed(corners(i) ^ uint(seed) * HASH.z);
    vec2 y = mix(level.xy, level.zw, f.y);
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
