// Cells in space of the plain ray-caster: layers of depth, in each of them a lattice across the view. A cell is CELL
// times as thick and as wide as the largest ball that may be there: everywhere the same, but grows with the depth,
// layer by layer, where the least radius that is drawn is more than the default one. A hash of its row tells the bucket where
// a row of cells begins; a row's cells are buckets side by side, so that neighbours in it are one run of particles.
// Needs view.glsl.

layout(constant_id = 2) const float CELL = 4.0;

layout(push_constant, std430) uniform Push {
    uint count; // particles; of `march` the rounds before
    uint mask;  // buckets where a row may begin, less 1: a power of 2
    uint span;  // buckets of a row; the one in the middle is on the axis
} push;

// Most of a ball that faces the eye is as far across the view from its centre, in radii: with d radii beside
// it and t behind it, d^2 + t^2 <= 1, a ray of slope s is at d + s t.
vec2 flare() {
    vec2 widest = max(abs(view.slope.zw), abs(view.slope.zw + view.slope.xy * vec2(view.extent.xy)));
    return sqrt(1.0 + widest * widest);
}

uint layer_of(float depth) {
    return uint(min(along(depth) / CELL, 4.0e9));
}

// The first and the last layer with centres of balls that may reach a depth: rounding may add one, and takes none.
uvec2 layers_about(float depth) {
    float growth = view.lattice.y;
    float near = min(depth - view.lattice.x, depth / (1.0 + growth));
    float far = growth < 1.0 ? max(depth + view.lattice.x, depth / (1.0 - growth)) : EMPTY;
    vec2 u = vec2(along(max(near, 0.0)), along(far));
    u += u * vec2(-4.0e-6, 4.0e-6);
    return uvec2(min(u / CELL, vec2(4.0e9)));
}

// Cells of a layer to a unit of length across the view; of the largest ball at its far end, and some for rounding.
vec2 scale_of(uint layer) {
    vec2 scale = 1.0 / (1.001 * CELL * view.lattice.x * flare());
    float end = float(layer + 1u) * CELL * view.lattice.y;
    if (end > 1.0) {
        scale *= exp(1.0 - end);
    }
    return scale;
}

// Tells a row from those near it: 16 bits of how far down it is, and of its layer.
uint row_of(float down, uint layer) {
    return uint(int(clamp(floor(down), -1.0e9, 1.0e9))) & 0xffffu | layer << 16;
}

// The bucket before a row's first.
uint bucket_of(uint row) {
    uint hash = row * 0x9e3779b1u;
    hash = (hash ^ hash >> 15) * 0x85ebca77u;
    return (hash ^ hash >> 13) & push.mask;
}

// A place in its row, from 1 on. Those too far out for one share the last.
uint across_of(float across) {
    float middle = float(push.span / 2u);
    return uint(clamp(floor(across) + middle, 1.0, float(push.span - 1u)));
}

// The box of all balls: its corners, as numbers that are the larger the farther out: of nothing 0.
uint outwards(float at) {
    uint bits = floatBitsToUint(at);
    return bits >> 31 == 1u ? ~bits : bits | 0x80000000u;
}

float inwards(uint number) {
    return uintBitsToFloat(number >> 31 == 1u ? number & 0x7fffffffu : ~number);
}
