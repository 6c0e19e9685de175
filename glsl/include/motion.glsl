// Pass `motion`, not in the sources: motion of the surface in a texel since the previous frame. The motion is a mean
// over the particles near the frontmost surface that the texel's pixels show, and another mean over those near the
// farthest such surface if it is a different one. Needs frame.glsl and the push constant `level`: a texel is 2^level
// pixels wide.
// Reads and writes: fronts, sums.

// For each texel the eye depths of the nearest and of the farthest surface that its pixels show. x is EMPTY without a
// surface, y without a second one.
layout(set = 0, binding = 1, std430) buffer Fronts { vec2 fronts[]; };
// For each texel four sums over particles: weight times displacement (x, y, z), and weight. Those of all nearest
// surfaces come first, then those of all farthest ones. They are 64-bit integers in two's complement, low word first,
// so the order of additions does not matter.
layout(set = 0, binding = 2, std430) buffer Sums { uint sums[]; };

// Fixed-point steps in the sums for a weight of 1 times a displacement of one particle spacing; and the largest
// displacement of a particle, in spacings. The two multiplied fill a signed 32-bit word.
const float MOTION_UNITS = 2097152.0;
const float MOST_SPACINGS = 1000.0;

int texel_edge() {
    return 1 << push.level;
}

// Surfaces for which there are sums: two, or one if a texel is a single pixel.
uint surfaces() {
    return push.level == 0u ? 1u : 2u;
}

// Number of surfaces that a texel's pixels show, from the texel's entry in `fronts` (1 also without any). It bounds a
// loop, because CPU drivers run branches slowly (docs/performance.md).
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

// Weight of a particle with its centre at `depth` in the mean motion of a surface. It falls from 1 to 0 between one and
// three drawn radii from the surface. The sphere that forms the surface has its centre within one radius of it, and so
// counts in full. The next layer of spheres lies about one spacing (1.5 radii) deeper, and counts in part.
float near_surface(float depth, float surface) {
    return 1.0 - smoothstep(frame.particle.x, 3.0 * frame.particle.x, abs(depth - surface));
}
