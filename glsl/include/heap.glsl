// Constants, types and push constants that the passes of the blob simulation share (Huszar, Szecsi, Sec. 6). Needs
// nothing.

// Max number of blobs that are visited in a bucket, so that blobs heaped on one spot cannot hang a device. Those with
// the lowest ids are visited.
const uint MOST_IN_BUCKET = 128u;

// A blob, stored beside the others of its bucket.
struct Heaped {
    vec4 ball;  // world position, radius
    vec4 drift; // velocity; bits of its id
    vec4 spin;  // angular velocity; bits of its index in the streams
};

layout(push_constant, std430) uniform Push {
    vec4 gravity;      // scene units/s2; drag of the air 1/s
    vec4 pair;         // rest distance and reach in sums of radii; stiffness 1/s2, pull scene units/s2
    vec4 damping;      // of pairs along and across, of solids, 1/s; friction
    vec4 solid;        // contact distance in radii, stiffness 1/s2; time step in seconds; seconds in which halves separate
    vec4 water;        // level, relative density of foam; neighbour volume that keeps a blob whole, seconds without it
    vec4 field;        // first point of the distance field, size of its cells
    uvec4 field_size;  // its points on each axis (0: no field); number of solids
    uint blobs;
    uint buckets;      // a power of two
    float cells;       // grid cells per scene unit
    uint max_splits;     // max number of successive splits; there are 2^max_splits entries for each blob
} push;

#include "random.glsl"
#include "cells.glsl"

// Grid cell, also for blobs that have fallen very far.
ivec3 heap_cell(vec3 place) {
    return cell_of(clamp(place, -1.0e8 / push.cells, 1.0e8 / push.cells));
}
