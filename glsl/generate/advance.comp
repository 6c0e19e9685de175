#version 460
// Pass `advance`: what becomes of the diffuse particles that there are: spray flies, foam goes with the water, bubbles
// rise in it, and foam alone ages (Ihmsen et al. 2012, Sec. 3.3 and 3.4).
// Reads: the grid. Writes: diffuse particles, gone.

#include "random.glsl"
#include "generate.glsl"
#include "neighbours.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { GenerateCounts counts; };
layout(set = 0, binding = 5, std430) buffer Particles { Diffuse particles[]; };
layout(set = 0, binding = 6, std430) buffer Drifts { Drift drifts[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Kinds { uint kinds[]; };
// 1 in each slot that is free.
layout(set = 0, binding = 8, std430) writeonly buffer Gone { uint gone[]; };

float cubic_spline(float q) {
    float rest = 1.0 - q;
    return q <= 0.5 ? 6.0 * (q * q * q - q * q) + 1.0 : 2.0 * rest * rest * rest;
}

// Velocity of the water at a place, 0 where there is none; and how many of its particles are there.
vec3 water_at(vec3 position, out uint neighbours) {
    neighbours = 0u;
    ivec3 sum = ivec3(0);
    uint weights = 0u;
    for (int c = 0; c < 27; ++c) {
        ivec3 cell = neighbour_cell(position, c);
        uvec2 range = range_of(cell);
        for (uint j = range.x; j < range.y; ++j) {
            float d = distance(position, places[j].position);
            if (!(d < support()) || !in_cell(places[j].position, cell)) {
                continue;
            }
            float weight = cubic_spline(d / support());
            vec3 part = motions[j].velocity * (weight / speed_step());
            sum += ivec3(round(clamp(part, -MOST_STEPS, MOST_STEPS)));
            weights += uint(weight * STEPS + 0.5);
            neighbours += 1u;
        }
    }
    return weights > 0u ? vec3(sum) * (speed_step() * STEPS / float(weights)) : vec3(0.0);
}

void visit(uint i) {
    Diffuse particle = particles[i];
    if (!(particle.age < 1.0)) {
        gone[i] = 1u;
        return;
    }
    vec3 velocity = drifts[i].velocity;
    vec3 gravity = vec3(push.gravity_x, push.gravity_y, push.gravity_z);
    uint neighbours;
    vec3 water = water_at(particle.position, neighbours);
    uint kind = kind_of(neighbours);
    if (kind == SPRAY) {
        velocity += push.dt * gravity;
    } else if (kind == BUBBLE) {
        velocity += push.drag * (water - velocity) - push.dt * push.buoyancy * gravity;
    } else {
        velocity = water;
        float life = mix(push.life_least, push.life_most, uniform_of(push.seed, drifts[i].id, 0u));
        particle.age += push.dt / life;
    }
    particle.position += push.dt * velocity;
    // Comparisons with NaN are false.
    bool inside = all(greaterThanEqual(particle.position, vec3(push.low_x, push.low_y, push.low_z)))
               && all(lessThanEqual(particle.position, vec3(push.high_x, push.high_y, push.high_z)));
    // What has no cell is gone, as it is in the fluid.
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
