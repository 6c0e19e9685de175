#version 460
// Pass `advance`: moves the existing whitewater particles: spray flies, foam is advected by the water, bubbles rise in
// it; only foam ages (Ihmsen et al. 2012, Sec. 3.3 and 3.4).
// Reads: the grid, counts, whitewater particles. Writes: whitewater particles, flags of free slots.

#include "random.glsl"
#include "generate.glsl"
#include "neighbours.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { GenerateCounts counts; };
layout(set = 0, binding = 5, std430) buffer Particles { Whitewater particles[]; };
layout(set = 0, binding = 6, std430) buffer Drifts { Drift drifts[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Kinds { uint kinds[]; };
// 1 for each free slot.
layout(set = 0, binding = 8, std430) writeonly buffer Gone { uint gone[]; };

// No emission here, so the rate is 0.
float rate_of(uint j) {
    return 0.0;
}

#include "generate_water.glsl"

void visit(uint i) {
    Whitewater particle = particles[i];
    if (!(particle.age < 1.0)) {
        gone[i] = 1u;
        return;
    }
    vec3 velocity = drifts[i].velocity;
    vec3 gravity = vec3(push.gravity_x, push.gravity_y, push.gravity_z);
    Water water = water_at(particle.position);
    uint kind = kind_of(water.neighbours);
    if (kind == SPRAY) {
        velocity += push.dt * gravity;
    } else if (kind == BUBBLE) {
        velocity += push.drag * (water.velocity - velocity) - push.dt * push.buoyancy * gravity;
    } else {
        velocity = water.velocity;
        float life = mix(push.life_least, push.life_most, uniform_of(push.seed, drifts[i].id, 0u));
        particle.age += push.dt / life;
    }
    particle.position += push.dt * velocity;
    // Comparisons with NaN are false.
    bool inside = all(greaterThanEqual(particle.position, vec3(push.low_x, push.low_y, push.low_z)))
               && all(lessThanEqual(particle.position, vec3(push.high_x, push.high_y, push.high_z)));
    // Particles outside the grid's range are removed, as fluid particles are.
    inside = inside && all(lessThan(abs(particle.position), vec3(min(1.0e18, 2147483648.0 * push.spacing))));
    bool stays = inside && particle.age < 1.0;
    particle.age = stays ? particle.age : 1.0;
    particles[i] = particle;
    drifts[i].velocity = velocity;
    kinds[i] = kind;
    gone[i] = stays ? 0u : 1u;
}

void main() {
    uint end = counts.high;
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
