// The fluid's particles by the cells of a grid, for the passes that make whitewater particles, and how they move. Needs
// generate.glsl, random.glsl.
// Reads: the grid (where buckets end, places, motions).

#include "grid.glsl"

layout(set = 0, binding = 3, std430) readonly buffer Motions { Motion motions[]; };

float support() {
    return 2.0 * push.spacing;
}
