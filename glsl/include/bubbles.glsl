// Uniforms, blobs and screen tiles, shared by the passes of bubble foam. Needs frame.glsl. Reads: the uniform block
// of bubble foam.

#include "quaternion.glsl"

layout(set = 0, binding = 1, std140) uniform BubbleFrame {
    vec4 film;    // mean thickness in nm, variation, drainage; thickness of the film table's last row in nm
    vec4 core;    // radii where it is opaque and where it ends; weights of the inverse normal and of the blob's normal
    vec4 albedo;  // twice the core's albedo; strength of its pattern
    vec4 mirror;  // factor of reflections; exponent of the highlight; z 1: walls are drawn; w 1: holes are plugged
    vec4 sun;     // irradiance on a surface that faces the sun, over 2 pi
    vec4 sun_mirror; // the sun's highlight; radius in pixels below which blobs merge
    uvec4 tiles;  // tiles across and down, depth slices, capacity of the lists
    uvec4 kinds;  // number of different blobs; 0 0 0
} bubbly;

// A blob on the screen.
struct Blob {
    vec4 ball;      // centre relative to the eye along the world's axes; radius, -1 for an invalid blob
    vec4 turn;      // quaternion from the world to the blob's space
    uint template_;
    uint id;
    float nearest;  // eye depth of its nearest point, at least 0; -1 outside the view
    uint unused;
};

// Range and counts of all blobs.
struct BlobRange {
    uint nearest;  // bits of the depth of the nearest point of the nearest blob
    uint farthest; // the same for the farthest blob
    uint seen;     // blobs on the screen
    uint dropped;  // invalid blobs
    uint taken;    // entries in the tiles' lists; if there are more than fit, the farthest are lost
};

const int TILE = 16;

// Width of a depth slice, and the depth at which a slice begins.
float slice_width(BlobRange range) {
    return max(uintBitsToFloat(range.farthest) - uintBitsToFloat(range.nearest), 1.0e-6) / float(bubbly.tiles.z);
}

float slice_begin(BlobRange range, uint slice) {
    return uintBitsToFloat(range.nearest) + float(slice) * slice_width(range);
}

uint slice_of(BlobRange range, float depth) {
    float place = (depth - uintBitsToFloat(range.nearest)) / slice_width(range);
    uint slice = min(uint(max(place, 0.0)), bubbly.tiles.z - 1u);
    // Rounding may have given a depth the slice behind its own. The comparison with `slice_begin` itself corrects
    // this, so that no depth in a slice is less than the slice's beginning.
    return slice > 0u && depth < slice_begin(range, slice) ? slice - 1u : slice;
}

// Index of a tile's cell. Within a tile, nearer slices come first.
uint cell_of(uint slice, uvec2 tile) {
    return (slice * bubbly.tiles.y + tile.y) * bubbly.tiles.x + tile.x;
}
