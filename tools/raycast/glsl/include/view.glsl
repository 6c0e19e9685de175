// Constants of a picture (src/cells.rs writes them), and the positions of ray samples. Pixel centres lie at +0.5, row 0
// is on top, eye space looks down -z, and depth is the positive eye depth.
// Reads: the picture's block.

layout(set = 0, binding = 0, std140) uniform View {
    mat4 view;      // world -> eye
    vec4 slope;     // pixel -> slope (xy over depth): scale xy, offset zw
    vec4 lens;      // a pixel's width and height as slopes; near; thickness where a ray ends
    vec4 lattice;   // default radius; least radius / depth; depth where both radii are equal; slab thickness in radii
    vec4 intensity; // half and exponent
    uvec4 extent;   // width, height; tiles across and down
    uvec4 samples;  // per slab; 1: shifted from pixel to pixel
} view;

const float EMPTY = 1.0e10;

// Edge of a tile in pixels.
layout(constant_id = 1) const uint TILE = 8;

// Samples lie in slabs across the view, each of the same thickness in radii. The unit is the default radius near the
// eye, and the least drawn radius where that is larger. Returns the integral of 1 / radius from the eye to `depth`.
float along(float depth) {
    return depth <= view.lattice.z ? depth / view.lattice.x : (1.0 + log(depth / view.lattice.z)) / view.lattice.y;
}

// Depth of the near face of a slab.
float slab_depth(uint slab) {
    float u = float(slab) * view.lattice.w;
    return u * view.lattice.y <= 1.0 ? u * view.lattice.x : view.lattice.z * exp(u * view.lattice.y - 1.0);
}

// First and last slab that may have samples between two depths. The margin covers rounding: it may add a slab, but
// never drops one.
uvec2 slabs_between(float near, float far) {
    vec2 u = vec2(along(max(near, 0.0)), along(max(far, 0.0)));
    u += u * vec2(-4.0e-6, 4.0e-6);
    return uvec2(min(u / view.lattice.w, vec2(4.0e9)));
}

// Offset of a pixel's samples within their share of the slab, 0 to 1: the middle, or a value of the ordered 4 x 4
// pattern (Bayer 1973), which turns banding into fine noise.
float sample_place(uvec2 pixel) {
    if (view.samples.y == 0u) {
        return 0.5;
    }
    uint a = pixel.x ^ pixel.y;
    uint rank = (a & 1u) << 3 | (pixel.y & 1u) << 2 | (a & 2u) | (pixel.y & 2u) >> 1;
    return (float(rank) + 0.5) / 16.0;
}
