// Where blobs take over from sprites of whitewater particles. Needs nothing.

// Distances that are told apart.
const uint RINGS = 1024u;

struct HandOver {
    float near;  // nearer than that there are blobs alone
    float far;   // farther sprites alone; 0: nowhere are blobs
    uint rings;  // those that have room
    uint blobs;
};
