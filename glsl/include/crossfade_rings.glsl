// Distances at which blobs replace sprites of whitewater. Needs nothing.

// Bins of the distance histogram.
const uint RINGS = 1024u;

struct Crossfade {
    float near;  // nearer than this, only blobs
    float far;   // farther than this, only sprites; 0: no blobs anywhere
    uint rings;  // rings within the capacity
    uint blobs;
};
