// Numbers of a picture (src/cells.rs writes them), and where the samples of its rays lie. Pixels have their middles
// at +0.5 and row 0 on top; eye space looks down -z; depth is the positive eye depth.
// Reads: the picture's block.

layout(set = 0, binding = 0, std140) uniform View {
    mat4 view;      // world -> eye
    vec4 slope;     // pixel -> slope (xy over depth): scale xy, offset zw
    vec4 lens;      // a pixel's width and height as slopes; near; thickness where a ray ends
    vec4 lattice;   // default radius; slope of the least radius; depth where they are equal; a slab in such radii
    vec4 intensity; // half and exponent
    uvec4 extent;   // width, height; tiles across and down
    uvec4 samples;  // of a slab; 1: shifted from pixel to pixel
} view;

const float EMPTY = 1.0e10;

// Edge of a tile in pixels.
layout(constant_id = 1) const uint TILE = 8;

// A ray's samples lie in slabs across the view, which are so many radii thick: of the default one near the eye, and
// of the least that is drawn from where that is larger on. The integral of 1 over that radius, from the eye on.
float along(float depth) {
    return depth <= view.lattice.z ? depth / view.lattice.x : (1.0 + log(depth / view.lattice.z)) / view.lattice.y;
}

// Depth where a slab begins.
float slab_depth(uint slab) {
    float u = float(slab) * view.lattice.w;
    return u * view.lattice.y <= 1.0 ? u * view.lattice.x : view.lattice.z * exp(u * view.lattice.y - 1.0);
}

// The first and the last slab that may have samples between two depths: rounding may add one, and takes none.
uvec2 slabs_between(float near, float far) {
    vec2 u = vec2(along(max(near, 0.0)), along(max(far, 0.0)));
    u += u * vec2(-4.0e-6, 4.0e-6);
    return uvec2(min(u / view.lattice.w, vec2(4.0e9)));
}

// Place of a pixel's samples in their share of the slab, 0 to 1: in the middle, or by the ordered pattern of 4 x 4
// (Bayer 1973), which turns the bands of samples that lie side by side into fine noise.
float sample_place(uvec2 pixel) {
    if (view.samples.y == 0u) {
        return 0.5;
    }
    uint a = pixel.x ^ pixel.y;
    uint rank = (a & 1u) << 3 | (pixel.y & 1u) << 2 | (a & 2u) | (pixel.y & 2u) >> 1;
    return (float(rank) + 0.5) / 16.0;
}
