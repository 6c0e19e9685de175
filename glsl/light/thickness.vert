#version 460
// Pass `light`: the discs of particles for the map of thickness along the sunlight (light_sprite.glsl). Not in the
// thesis.
// Reads: positions, densities, foam, members. Writes: the quad's corners, the discs and their thickness.

#define FRONT 0
#include "light_sprite.glsl"
