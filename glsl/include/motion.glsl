// How far the surface in a texel has come since the frame before: sums over the particles near the
// frontmost surface of the texel's pixels, and near the farthest of them where that is another.
// Needs frame.glsl.

// 2: two surfaces a texel. 1: texels are pixels.
layout(constant_id = 0) const uint SURFACES = 2;

// Per texel the nearest and the farthest surface of its pixels; EMPTY where there is none, or no other.
layout(set = 0, binding = 1, std430) buffer Fronts { vec2 fronts[]; };
// Weight times displacement (x, y, z), then weight, of each texel, then the same of the farther
// surfaces: 64-bit integers in two's complement, the low word first. Their order is no matter.
layout(set = 0, binding = 2, std430) buffer Sums { uint sums[]; };

// Parts of a weight, and of a spacing, that sums count in. A thousand spacings fill a word.
const float MOTION_UNITS = 2097152.0;
const float MOST_SPACINGS = 1000.0;

uint texel_index(ivec2 texel) {
    return uint(texel.y) * uint(frame.thick_extent.x) + uint(texel.x);
}

// Of a sum of a texel of one of the surfaces; i: 0 to 3.
uint sum_index(uint texel, uint surface, uint i) {
    uint texels = uint(frame.thick_extent.x) * uint(frame.thick_extent.y);
    return 2u * (4u * (surface * texels + texel) + i);
}

// How near a depth is to a surface's: wholly to a radius from it, and to three at all. The frontmost
// sphere's centre is a radius behind its pole, that of the second layer two more.
float near_surface(float depth, float surface) {
    return 1.0 - smoothstep(frame.particle.x, 3.0 * frame.particle.x, abs(depth - surface));
}
