// What whitewater particles leave in each pixel, next to each other: what goes with the frontmost, bits of its depth (the
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

// Search radius of a sphere with its middle at an eye-space depth, in the upper 16 bits: no more than a half can hold.
uint search_of(float radius, float z) {
    return packHalf2x16(vec2(0.0, min(radius * abs(frame.projection.y) / z, 60000.0)));
}

// Beside it the normal towards the eye where the sphere is met, (place, w), as the diamond |x| + |y| <= 1 turned to a
// square, in two times 8 bits. It is turned to the world once a pixel, not once a particle.
uint with_of(uint search, vec2 place, float w) {
    place /= abs(place.x) + abs(place.y) + w;
    ivec2 bits = ivec2(vec2(place.x + place.y, place.x - place.y) * 127.0 + 127.5);
    return search | uint(bits.x << 8 | bits.y);
}

// World normal, search radius.
vec4 unpack_with(uint with) {
    vec2 turned = vec2(with >> 8 & 255u, with & 255u) / 127.0 - 1.0;
    vec2 place = 0.5 * vec2(turned.x + turned.y, turned.x - turned.y);
    vec3 normal = vec3(place, max(1.0 - abs(place.x) - abs(place.y), 0.0));
    return vec4(normalize(mat3(frame.world) * normal), unpackHalf2x16(with).y);
}
