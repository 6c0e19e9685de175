// Two sheets of water, one behind the other (passes `gaps` and `back`): for each texel of the
// thickness the eye depth between them, EMPTY where there is but one. Needs frame.glsl.

// 1: there is one sheet everywhere; the buffer is not read.
layout(constant_id = 8) const uint SHEETS = 2;

layout(set = 0, binding = 11, std430) readonly buffer Boundaries { float boundaries[]; };

float boundary_of(ivec2 texel) {
    return boundaries[uint(texel.y) * uint(frame.thick_extent.x) + uint(texel.x)];
}

// Edge of a block in pixels, and its logarithm.
const int BLOCK = 16;
const int BLOCK_BITS = 4;

// Of a full-resolution pixel.
float boundary_at(ivec2 pixel) {
    // A shift: a division of floats may come out below, of integers CPUs have no vectors for it.
    return boundary_of(pixel >> findMSB(int(frame.thick_extent.z)));
}

// Water in the window per water where there is no boundary: more than enough for one sheet.
const float ONE_SHEET = 1.0e6;

// What a sprite's centre at a depth adds to: front sheet, back sheet, the window between them, whose
// water says that they are one.
vec3 sheet_shares(float z, float boundary) {
    if (boundary >= EMPTY) {
        return vec3(1.0, 0.0, ONE_SHEET);
    }
    float spacing = frame.particle.y;
    float off = z - boundary;
    float back = smoothstep(-0.5 * spacing, 0.5 * spacing, off);
    return vec3(1.0 - back, back, 1.0 - smoothstep(0.5 * spacing, spacing, abs(off)));
}
