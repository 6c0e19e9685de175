// Spatial grid of the plain ray-caster: layers of depth, each with a lattice of cells across the view. A cell is CELL
// times as thick and as wide as the largest ball that may lie in it. Cells have one size near the eye; where the least
// drawn radius exceeds the default radius, they grow from layer to layer. Rows of cells are hashed: the hash gives the
// first bucket of a row. The cells of a row are adjacent buckets, so that neighbours in it are one contiguous run of
// particles. Needs view.glsl.

layout(constant_id = 2) const float CELL = 4.0;

layout(push_constant, std430) uniform Push {
    uint count; // particles; in `march` the rounds already done
    uint mask;  // buckets where a row may begin (a power of 2), minus 1
    uint span;  // buckets of a row; the one in the middle is on the axis
} push;

// Farthest distance across the view, in radii, of a ball's surface from its centre. A ball faces the eye: at d radii
// beside the centre and t behind it, d^2 + t^2 <= 1, a ray of slope s passes at d + s t.
vec2 flare() {
    vec2 widest = max(abs(view.slope.zw), abs(view.slope.zw + view.slope.xy * vec2(view.extent.xy)));
    return sqrt(1.0 + widest * widest);
}

uint layer_of(float depth) {
    return uint(min(along(depth) / CELL, 4.0e9));
}

// First and last layer whose balls may reach a depth. The margin covers rounding: it may add a layer, but never drops
// one.
uvec2 layers_about(float depth) {
    float growth = view.lattice.y;
    float near = min(depth - view.lattice.x, depth / (1.0 + growth));
    float far = growth < 1.0 ? max(depth + view.lattice.x, depth / (1.0 - growth)) : EMPTY;
    vec2 u = vec2(along(max(near, 0.0)), along(far));
    u += u * vec2(-4.0e-6, 4.0e-6);
    return uvec2(min(u / CELL, vec2(4.0e9)));
}

// Cells per unit of length across the view, in a layer. The largest ball at the far end of the layer sets the size,
// with a margin for rounding.
vec2 scale_of(uint layer) {
    vec2 scale = 1.0 / (1.001 * CELL * view.lattice.x * flare());
    float end = float(layer + 1u) * CELL * view.lattice.y;
    if (end > 1.0) {
        scale *= exp(1.0 - end);
    }
    return scale;
}

// Key that distinguishes a row from nearby rows: 16 bits of its vertical index, and 16 bits of its layer.
uint row_of(float down, uint layer) {
    return uint(int(clamp(floor(down), -1.0e9, 1.0e9))) & 0xffffu | layer << 16;
}

// Bucket before the first one of a row.
uint bucket_of(uint row) {
    uint hash = row * 0x9e3779b1u;
    hash = (hash ^ hash >> 15) * 0x85ebca77u;
    return (hash ^ hash >> 13) & push.mask;
}

// Position of a cell in its row, from 1 on. Cells beyond the last position share it.
uint across_of(float across) {
    float middle = float(push.span / 2u);
    return uint(clamp(floor(across) + middle, 1.0, float(push.span - 1u)));
}

// Bounding box of all balls. Its corners are stored as integers that grow outwards, so that atomicMax extends the box;
// 0 is empty.
uint outwards(float at) {
    uint bits = floatBitsToUint(at);
    return bits >> 31 == 1u ? ~bits : bits | 0x80000000u;
}

float inwards(uint number) {
    return uintBitsToFloat(number >> 31 == 1u ? number & 0x7fffffffu : ~number);
}
