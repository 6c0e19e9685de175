// Pass `motion`, not in the sources: motion of the surface in a texel since the previous frame. Sums are over the
// particles near the frontmost surface of the texel's pixels, and near the farthest if that is another one. Needs
// frame.glsl and the push constant `level`, the number of halvings.
// Reads and writes: fronts, sums.

// For each texel the nearest and the farthest surface of its pixels; EMPTY if there is none, or no second one.
layout(set = 0, binding = 1, std430) buffer Fronts { vec2 fronts[]; };
// For each texel: weight times displacement (x, y, z), then weight; then the same for the farther surfaces.
// 64-bit integers in two's complement, low word first, so the order of additions does not matter.
layout(set = 0, binding = 2, std430) buffer Sums { uint sums[]; };

// Fixed-point steps of a weight times a spacing. A thousand spacings fill a word.
const float MOTION_UNITS = 2097152.0;
const float MOST_SPACINGS = 1000.0;

int texel_edge() {
    return 1 << push.level;
}

// Two surfaces, or one if texels are pixels.
uint surfaces() {
    return push.level == 0u ? 1u : 2u;
}

// Number of surfaces of a texel. A loop instead of a branch, for CPU drivers (docs/performance.md).
uint surfaces_of(vec2 front) {
    return front.y < EMPTY ? 2u : 1u;
}

ivec2 texel_extent() {
    return (ivec2(frame.extent.xy) + (texel_edge() - 1)) >> int(push.level);
}

// Transform from texel to slope.
vec4 texel_slope() {
    return vec4(frame.slope.xy * float(texel_edge()), frame.slope.zw);
}

uint texel_index(ivec2 texel) {
    return uint(texel.y * texel_extent().x + texel.x);
}

// Index of a sum of a texel and surface; i: 0 to 3.
uint sum_index(uint texel, uint surface, uint i) {
    ivec2 extent = texel_extent();
    return 2u * (4u * (surface * uint(extent.x * extent.y) + texel) + i);
}

// Weight of a depth near a surface: 1 up to one radius from it, 0 from three radii. The centre of the frontmost
// sphere is one radius behind its pole, that of the second layer two more.
float near_surface(float depth, float surface) {
    return 1.0 - smoothstep(frame.particle.x, 3.0 * frame.particle.x, abs(depth - surface));
}
