// Shared by the passes that emit whitewater (spray, foam, bubbles) from a fluid (Ihmsen, Akinci, Akinci, Teschner,
// Unified spray, foam and bubbles for particle-based fluids, 2012).
// Sums over neighbours use fixed-point steps: their order does not matter.

layout(push_constant, std430) uniform Push {
    float spacing;       // of the fluid's particles
    float dt;
    uint seed;
    uint number;         // of the step
    float gravity_x;
    float gravity_y;
    float gravity_z;
    float buoyancy;
    float drag;
    float trapped_least; // limits of a potential: its least, one over their difference
    float trapped_scale;
    float crest_least;
    float crest_scale;
    float energy_least;
    float energy_scale;
    float trapped_rate;  // particles a second
    float crest_rate;
    float life_least;
    float life_most;
    float low_x;         // bounds, outside of which none lives
    float low_y;
    float low_z;
    float high_x;
    float high_y;
    float high_z;
    uint buckets;        // a power of two
    uint most;           // slots of whitewater particles
    uint capacity;       // of fluid particles
    float cells;         // of the grid along a unit of length
} push;

#include "generate_types.glsl"

// A whitewater particle: its age is the share of its life that has passed, 1 of what is gone.
struct Diffuse {
    vec3 position;
    float age;
};
struct Drift {
    vec3 velocity;
    uint id;
};

const uint FOAM = 0u;
const uint SPRAY = 1u;
const uint BUBBLE = 2u;

// Of so many neighbours.
uint kind_of(uint neighbours) {
    return neighbours < 6u ? SPRAY : neighbours > 20u ? BUBBLE : FOAM;
}

// Steps of numbers around 1, and of speeds; no more of these are added at once.
const float STEPS = 65536.0;
const float MOST_STEPS = 131072.0;
float speed_step() {
    return sqrt(9.81 * push.spacing) / 256.0;
}

// A seed of the step.
uint step_seed() {
    return pcg(push.seed + pcg(push.number));
}
