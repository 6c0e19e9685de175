// A fluid particle as stored in the neighbour grid. Needs nothing.

struct Place {
    vec3 position;
    uint id;
};
