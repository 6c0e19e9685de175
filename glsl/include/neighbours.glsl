// The fluid's particles by grid cell, with their motion, for the passes that emit whitewater particles. Needs
// generate.glsl, random.glsl.
// Reads: the grid (ends of the buckets, places, motions).

#include "grid.glsl"

layout(set = 0, binding = 3, std430) readonly buffer Motions { Motion motions[]; };

float support() {
    return 2.0 * push.spacing;
}
