// What the passes of moving blobs share (Huszar, Szecsi, Sec. 6). Needs nothing.

// Of a bucket no more are looked at, those of the lowest ids: blobs heaped on one spot must not hang a device.
const uint MOST_IN_BUCKET = 128u;

// A blob beside those of its bucket.
struct Heaped {
    vec4 ball;  // world, radius
    vec4 drift; // velocity; bits of its id
    vec4 spin;  // angular velocity; bits of its place in the streams
};

layout(push_constant, std430) uniform Push {
    vec4 gravity;      // m/s2; drag of the air 1/s
    vec4 pair;         // distance at rest and reach in sums of radii; stiffness 1/s2, pull m/s2
    vec4 damping;      // of pairs along and across, of solids, 1/s; friction
    vec4 solid;        // contact in radii, stiffness 1/s2; seconds; seconds in which halves part
    vec4 water;        // its level, density of foam over its own; volumes beside a blob that keep it whole, seconds without
    vec4 field;        // first point of the field of distances, edge of its cells
    uvec4 field_size;  // points each way; 0: none; solids
    uint blobs;
    uint buckets;      // a power of two
    float cells;       // of the grid in a metre
    uint halvings;     // at most, of what was one; there are 2^that places for each
} push;

#include "random.glsl"
#include "cells.glsl"

// However far it has fallen.
ivec3 heap_cell(vec3 place) {
    return cell_of(clamp(place, -1.0e8 / push.cells, 1.0e8 / push.cells));
}
