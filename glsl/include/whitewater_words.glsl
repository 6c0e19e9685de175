// Words of each pixel that whitewater particles accumulate, next to each other: attributes of the frontmost particle
// and bits of its depth (together a 64-bit word, whose minimum belongs to the frontmost), bits of the scene's and the
// fluid's depths, and fixed-point sums of the thickness in front of the fluid's surface, of the thickness behind it,
// and of the latter weighted by its distance behind the surface. The last word is padding: a pixel has 32 bytes, one
// memory sector of a GPU. Needs frame.glsl.

const uint WITH = 0u;
const uint FRONT = 1u;
const uint SCENE = 2u;
const uint FLUID = 3u;
const uint SUMS = 4u;
const uint WORDS = 8u;

// Fixed-point steps per thickness of 1.
const float STEPS = 65536.0;
// Above this sum of thickness no more is added to it, so that any number of particles may lie on one spot.
const uint HALF_FULL = 2147483648u;

uint words_of(ivec2 pixel) {
    return WORDS * (uint(pixel.y) * uint(frame.extent.x) + uint(pixel.x));
}

// Search radius of a sphere with its centre at the eye depth z: its radius on the screen in halves of the picture's
// height, as a half float in the upper 16 bits, clamped to the range of half floats.
uint search_of(float radius, float z) {
    return packHalf2x16(vec2(0.0, min(radius * abs(frame.projection.y) / z, 60000.0)));
}

// Adds the sphere's normal (place, w) to a search radius. The normal faces the eye and is stored in two times 8 bits:
// its octahedral projection is the diamond |x| + |y| <= 1, rotated to a square. The rotation of normals to the world
// is done once per pixel, not per particle.
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
