// Shared by the passes that emit whitewater (spray, foam, bubbles) from a fluid (Ihmsen, Akinci, Akinci, Teschner,
// Unified spray, foam and bubbles for particle-based fluids, 2012). Sums over neighbours are in fixed-point steps, so
// the order of their terms does not matter.

layout(push_constant, std430) uniform Push {
    float spacing;       // of the fluid's particles
    float dt;
    uint seed;
    uint number;         // number of the step
    float gravity_x;
    float gravity_y;
    float gravity_z;
    float buoyancy;
    float drag;
    float trapped_least; // limits of a potential: minimum, 1 / (maximum - minimum)
    float trapped_scale;
    float crest_least;
    float crest_scale;
    float energy_least;
    float energy_scale;
    float trapped_rate;  // particles per second
    float crest_rate;
    float life_least;
    float life_most;
    float low_x;         // bounds outside of which particles are removed
    float low_y;
    float low_z;
    float high_x;
    float high_y;
    float high_z;
    uint buckets;        // number of buckets, a power of two
    uint most;           // capacity of whitewater particles
    uint capacity;       // capacity of fluid particles
    float cells;         // grid cells per unit of length
    float gravity;       // length of gravity, which sets the step of speeds; 9.81 without gravity
} push;

#include "generate_types.glsl"

// A whitewater particle. Its age is the fraction of its life that has passed; 1 means that it is gone.
struct Whitewater {
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

// Kind by the number of neighbours.
uint kind_of(uint neighbours) {
    return neighbours < 6u ? SPRAY : neighbours > 20u ? BUBBLE : FOAM;
}

// Fixed-point steps for sums of numbers around 1, and of speeds. Speeds are in units of the scene, so their step grows
// with gravity and spacing.
const float STEPS = 65536.0;
const float MOST_STEPS = 131072.0;
float speed_step() {
    return sqrt(push.gravity * push.spacing) / 256.0;
}

// Seed of the step.
uint step_seed() {
    return pcg(push.seed + pcg(push.number));
}
