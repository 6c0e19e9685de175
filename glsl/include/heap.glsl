// What the passes of moving blobs share (Huszar, Szecsi, Sec. 6). Needs nothing.

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
    vec4 solid;        // contact in radii, stiffness 1/s2; edge of a cell in metres; seconds
    vec4 water;        // its level, density of foam over its own; 0 0
    vec4 field;        // first point of the field of distances, edge of its cells
    uvec4 field_size;  // points each way; 0: none; solids
    uint blobs;
    uint buckets;      // a power of two
} push;

ivec3 heap_cell(vec3 place) {
    // One quotient, whoever asks: in one pass and the other the same cell.
    precise vec3 at = place / push.solid.z;
    return ivec3(floor(clamp(at, -1.0e9, 1.0e9)));
}

uint heap_bucket(ivec3 cell) {
    uvec3 c = uvec3(cell) * uvec3(0x9E3779B1u, 0x85EBCA77u, 0xC2B2AE3Du);
    uint joined = c.x ^ c.y ^ c.z;
    return (joined ^ joined >> 15) & (push.buckets - 1u);
}
