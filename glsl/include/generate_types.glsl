// Types shared by the passes that emit whitewater.

struct GenerateCounts {
    uint high;   // slots of whitewater particles that were ever used: first, drawing starts from it
    uint fluid;  // particles of the step
    uint sorted; // of them those that take part
    uint free;   // of the used slots those whose particle is gone
    uint made;   // in the step
    uint lost;   // for want of slots, in all
};

#include "place.glsl"

// And its number in the step.
struct Motion {
    vec3 velocity;
    uint number;
};
