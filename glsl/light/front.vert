#version 460
// Pass `light`: the discs of particles for the map of the first water, foam or spray that sunlight meets
// (light_sprite.glsl). Not in the thesis.
// Reads: positions, densities, foam, members. Writes: the quad's corners, the discs.

#define FRONT 1
#include "light_sprite.glsl"
