// Two sheets (layers of water), one behind the other (passes `gaps` and `back`): for each texel of the thickness
// their boundary, the eye depth between them; EMPTY where there is only one sheet. Not in the thesis (its limitation,
// Fig. 5.13). Needs frame.glsl. Reads: boundaries.

// 1: there is one sheet everywhere; the buffer is not read.
layout(constant_id = 8) const uint SHEETS = 2;

layout(set = 0, binding = 11, std430) readonly buffer Boundaries { float boundaries[]; };

float boundary_of(ivec2 texel) {
    return boundaries[uint(texel.y) * uint(frame.thick_extent.x) + uint(texel.x)];
}

// Edge of a block in pixels, and its logarithm.
const int BLOCK = 16;
const int BLOCK_BITS = 4;

// The boundary at a full-resolution pixel.
float boundary_at(ivec2 pixel) {
    // The pixel is divided by the width of a texel in pixels, a power of two, by a shift: a float division may round
    // down, and CPUs have no vector division of integers.
    return boundary_of(pixel >> findMSB(int(frame.thick_extent.z)));
}
