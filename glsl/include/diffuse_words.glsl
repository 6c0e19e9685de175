// What diffuse particles leave in each pixel, next to each other: what goes with the frontmost, bits of its depth (the
// two are a word of 64 bits, whose least is the frontmost's), bits of the scene's and the fluid's depths, and sums in
// whole steps of what is before the fluid, behind it, and that by how far. The last is room: a pixel is 32 bytes, which
// lie in one sector of a GPU's memory.
// Needs frame.glsl.

const uint WITH = 0u;
const uint FRONT = 1u;
const uint SCENE = 2u;
const uint FLUID = 3u;
const uint SUMS = 4u;
const uint WORDS = 8u;

// Steps of a thickness of 1.
const float STEPS = 65536.0;
// From here on nothing is added: no number of particles on one spot is too many.
const uint HALF_FULL = 2147483648u;

uint words_of(ivec2 pixel) {
    return WORDS * (uint(pixel.y) * uint(frame.extent.x) + uint(pixel.x));
}

// Search radius in 16 bits, normal in two times 8 (octahedral).
uint pack_with(float search, vec3 n) {
    vec2 o = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 turned = (1.0 - abs(o.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(o, vec2(0.0)));
    o = n.z < 0.0 ? turned : o;
    uvec2 bits = uvec2(clamp(o * 127.0 + 127.5, vec2(0.0), vec2(254.0)));
    return packHalf2x16(vec2(search, 0.0)) << 16 | bits.x << 8 | bits.y;
}

// Of a sphere with its middle at an eye-space depth, where it is met: its normal in eye space.
uint with_of(float radius, float z, vec3 normal) {
    return pack_with(radius * abs(frame.projection.y) / z, normalize(mat3(frame.world) * normal));
}

vec4 unpack_with(uint with) {
    vec2 o = vec2(with >> 8 & 255u, with & 255u) / 127.0 - 1.0;
    vec3 n = vec3(o, 1.0 - abs(o.x) - abs(o.y));
    vec2 turned = (1.0 - abs(o.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(o, vec2(0.0)));
    n.xy = n.z < 0.0 ? turned : o;
    return vec4(normalize(n), unpackHalf2x16(with >> 16).x);
}
