// Types shared by the passes that emit whitewater.

struct GenerateCounts {
    uint high;   // number of whitewater slots ever used; first, because drawing reads it
    uint fluid;  // fluid particles of the step
    uint sorted; // of those, the particles in the grid
    uint free;   // free slots among the used ones
    uint made;   // created in this step
    uint lost;   // in total, not created because no slot was free
};

#include "place.glsl"

// Its velocity, and its number in the step.
struct Motion {
    vec3 velocity;
    uint number;
};
