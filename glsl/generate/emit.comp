#version 460
// Pass `emit`: new whitewater particles, in a cylinder along the path of each fluid particle in the step (Ihmsen et
// al. 2012, Sec. 3.2). They take the free slots in the order of the fluid's particles. For a snapshot (a single frame
// without steps before it) the cylinder is one spacing long and begins at the fluid particle, and foam gets an age: the
// part of its life that has passed since the moment (stage) at which a steady flow would have emitted it.
// Reads: places and motions of the grid, counts, normals or stages, number of particles to emit (exclusive prefix sum),
// free slots. Writes: whitewater particles.

#include "random.glsl"
#include "generate.glsl"

layout(local_size_x = 64) in;
// 1: for a snapshot.
layout(constant_id = 0) const uint SNAPSHOT = 0;

layout(set = 0, binding = 1, std430) readonly buffer CountBuffer { GenerateCounts counts; };
layout(set = 0, binding = 2, std430) readonly buffer Places { Place places[]; };
layout(set = 0, binding = 3, std430) readonly buffer Motions { Motion motions[]; };
layout(set = 0, binding = 4, std430) readonly buffer Normals { uvec4 normals[]; };
layout(set = 0, binding = 5, std430) readonly buffer Wanted { uint wanted[]; };
layout(set = 0, binding = 6, std430) readonly buffer Free { uint free_slots[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Particles { Whitewater particles[]; };
layout(set = 0, binding = 8, std430) writeonly buffer Drifts { Drift drifts[]; };
layout(set = 0, binding = 9, std430) writeonly buffer Kinds { uint kinds[]; };

#include "generate_stages.glsl"

// Two axes that are perpendicular to a third (Duff et al. 2017).
void axes_of(vec3 z, out vec3 x, out vec3 y) {
    float side = z.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + z.z);
    float b = z.x * z.y * a;
    x = vec3(1.0 + side * z.x * z.x * a, side * b, -side * z.x);
    y = vec3(b, side + z.y * z.y * a, -z.y);
}

void visit(uint i) {
    uint number = motions[i].number;
    uint first = wanted[number];
    uint end = number + 1u < counts.fluid ? wanted[number + 1u] : counts.made;
    if (first >= end) {
        return;
    }
    vec3 velocity = motions[i].velocity;
    float speed = length(velocity);
    // In a snapshot a particle at rest may emit too, where foam has flowed to it. The cylinder is then a disc with the
    // axis +y.
    vec3 ahead = speed > 0.0 ? velocity / speed : vec3(0.0, 1.0, 0.0);
    float way = SNAPSHOT == 0u ? push.dt * speed : speed > 0.0 ? push.spacing : 0.0;
    vec3 x;
    vec3 y;
    axes_of(ahead, x, y);
    uint seed = step_seed();
    uint id = places[i].id;
    // The emitting fluid particle counts as a neighbour in the choice of the new particle's kind, as it will in later
    // steps.
    uint kind = kind_of(uint(uintBitsToFloat(normals[i].w)) + 1u);
    // In a snapshot, the first random numbers are used by the stages.
    uint random = SNAPSHOT == 0u ? 1u : 32u;
    uint stage = 0u;
    uint of_stage = normals[i].x & MOST_OF_STAGE;
    for (uint k = 0u; first + k < end; ++k) {
        while (SNAPSHOT == 1u && of_stage == 0u && stage + 1u < STAGES) {
            ++stage;
            of_stage = normals[i][stage / 5u] >> shift_of(stage) & MOST_OF_STAGE;
        }
        --of_stage;
        uint order = first + k;
        // The room is computed as a difference, because the sum of slots and new particles may overflow 32 bits.
        uint beyond = order - min(order, counts.free);
        if (order >= counts.free && beyond >= push.most - min(counts.high, push.most)) {
            return;
        }
        uint slot = order < counts.free ? free_slots[order] : counts.high + beyond;
        float radius = 0.5 * push.spacing * sqrt(uniform_of(seed, id, 4u * k + random));
        float along = way * uniform_of(seed, id, 4u * k + random + 1u);
        // The random angle is taken from −π to π, not from 0 to 2π, because sines are precise only near 0; the minus
        // sign of `off` makes up for the half turn.
        float turn = 6.28318531 * (uniform_of(seed, id, 4u * k + random + 2u) - 0.5);
        vec3 off = -radius * (cos(turn) * x + sin(turn) * y);
        float age = 0.0;
        if (SNAPSHOT == 1u && kind == FOAM) {
            float seconds = before(stage, id);
            float least = max(push.life_least, seconds);
            age = seconds / mix(least, push.life_most, uniform_of(seed, id, 4u * k + random + 3u));
        }
        particles[slot] = Whitewater(places[i].position + off + along * ahead, age);
        // Files hold ids of 31 bits.
        drifts[slot] = Drift(velocity + off, pcg(id + pcg(4u * k + random + 3u + pcg(seed))) >> 1);
        kinds[slot] = kind;
    }
}

void main() {
    uint end = counts.sorted;
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
