// What the passes of bubble foam share. Needs frame.glsl. Reads: the block of bubble foam.

#include "quaternion.glsl"

layout(set = 0, binding = 1, std140) uniform BubbleFrame {
    vec4 film;    // mean thickness in nm, variation, drainage; the film table's last row in nm
    vec4 core;    // where it is opaque and where gone; weights of the inverse normal and of the blob's own
    vec4 albedo;  // twice that of the core; how much its pattern shows
    vec4 mirror;  // factor on reflections; exponent of the highlight; 1 = walls, 1 = holes are plugged
    vec4 sun;     // its light on what faces it, over 2 pi
    vec4 sun_mirror; // its highlight; radius in pixels under which blobs merge
    uvec4 tiles;  // across, down, slices of depth, room in their lists
    uvec4 kinds;  // different blobs; 0 0 0
} bubbly;

// A blob on the screen.
struct Blob {
    vec4 ball;      // from the eye along the world's axes, radius; of what is no ball -1
    vec4 turn;      // quaternion, world to the blob's space
    uint template_;
    uint id;
    float nearest;  // eye depth of its nearest point, at least 0; beside the view -1
    uint unused;
};

// What is known of all of them.
struct BlobRange {
    uint nearest;  // bits of the depth of a blob's nearest point: of the first
    uint farthest; // and of the last
    uint seen;     // blobs on the screen
    uint dropped;  // those that are no balls
    uint taken;    // places in the tiles' lists; more than there is room for: the farthest are lost
};

const int TILE = 16;

// Slice of depth, and where one begins.
float slice_width(BlobRange range) {
    return max(uintBitsToFloat(range.farthest) - uintBitsToFloat(range.nearest), 1.0e-6) / float(bubbly.tiles.z);
}

float slice_begin(BlobRange range, uint slice) {
    return uintBitsToFloat(range.nearest) + float(slice) * slice_width(range);
}

uint slice_of(BlobRange range, float depth) {
    float place = (depth - uintBitsToFloat(range.nearest)) / slice_width(range);
    uint slice = min(uint(max(place, 0.0)), bubbly.tiles.z - 1u);
    // By the very numbers that `slice_begin` gives: what lies in a slice lies nowhere before it.
    return slice > 0u && depth < slice_begin(range, slice) ? slice - 1u : slice;
}

// Of a tile's list the blobs in a slice come after those of nearer ones.
uint cell_of(uint slice, uvec2 tile) {
    return (slice * bubbly.tiles.y + tile.y) * bubbly.tiles.x + tile.x;
}
