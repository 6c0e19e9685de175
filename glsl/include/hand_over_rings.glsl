// Distances at which blobs replace sprites of whitewater. Needs nothing.

// Bins of the distance histogram.
const uint RINGS = 1024u;

struct HandOver {
    float near;  // nearer than that there are blobs alone
    float far;   // farther sprites alone; 0: nowhere are blobs
    uint rings;  // those that have room
    uint blobs;
};
