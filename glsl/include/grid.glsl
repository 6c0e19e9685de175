// Particles by grid cell, in a hash table (Teschner et al. 2003). Cells are as wide as the support (the radius within
// which particles are neighbours). The list of particles is sorted by bucket. Needs random.glsl, place.glsl and the
// requirements of cells.glsl.
// Reads: the grid (ends of the buckets, places).
//
// The particles near a position are read like this:
//     for (int c = 0; c < 27; ++c) {
//         ivec3 cell = neighbour_cell(position, c);
//         uvec2 range = range_of(cell);
//         for (uint j = range.x; j < range.y; ++j) { if (in_cell(places[j].position, cell)) ... }
//     }

// Index behind the last particle of each bucket.
layout(set = 0, binding = 1, std430) readonly buffer Ends { uint ends[]; };
layout(set = 0, binding = 2, std430) readonly buffer Places { Place places[]; };

// Max number of particles that are read per bucket, so that particles heaped on one spot cannot hang a device. Water
// has eight particles in a cell that is two spacings wide.
const uint MOST_IN_BUCKET = 256u;

#include "cells.glsl"

ivec3 neighbour_cell(vec3 position, int c) {
    return cell_of(position) + ivec3(c % 3, c / 3 % 3, c / 9) - 1;
}

uvec2 range_of(ivec3 cell) {
    uint bucket = bucket_of(cell);
    uint begin = bucket > 0u ? ends[bucket - 1u] : 0u;
    return uvec2(begin, min(ends[bucket], begin + MOST_IN_BUCKET));
}

// Several cells share a bucket.
bool in_cell(vec3 position, ivec3 cell) {
    return all(equal(cell_of(position), cell));
}
