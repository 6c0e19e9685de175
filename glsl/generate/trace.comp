#version 460
// Pass `trace`, only for a snapshot (a single frame): number of whitewater particles that a steady flow would have
// left at each water particle. The water's path is followed backwards through the velocities of this one frame, and
// the emission along it is summed. (Ihmsen et al. 2012 simulate sequences only.)
// Reads: the grid, counts, emission rates. Writes: stages (in place of normals), number of particles to emit.

#include "random.glsl"
#include "generate.glsl"
#include "neighbours.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { GenerateCounts counts; };
// The fourth word is the number of neighbours and is kept.
layout(set = 0, binding = 5, std430) buffer Stages { uvec4 stages[]; };
layout(set = 0, binding = 6, std430) readonly buffer Rates { float rates[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Wanted { uint wanted[]; };

float rate_of(uint j) {
    return rates[j];
}

#include "generate_water.glsl"
#include "generate_stages.glsl"

// Returns the fraction of foam that is still alive `seconds` after its emission: lifetimes are uniformly distributed
// between min and max.
float left_of(float seconds) {
    float rest = push.life_most - seconds;
    return seconds < push.life_least ? 1.0 : clamp(rest / max(push.life_most - push.life_least, 1.0e-20), 0.0, 1.0);
}

void visit(uint i) {
    uint id = places[i].id;
    vec3 position = places[i].position;
    vec3 velocity = motions[i].velocity;
    float most = push.trapped_rate + push.crest_rate;
    float last = 0.0;
    uint all = 0u;
    uvec3 words = uvec3(0u);
    for (uint stage = 0u; stage < STAGES; ++stage) {
        float seconds = before(stage, id);
        position -= (seconds - last) * velocity;
        last = seconds;
        Water water = water_at(position);
        if (!water.any) {
            break;
        }
        velocity = water.velocity;
        float make = min(most * water.rate * seconds_of(stage) * left_of(seconds), float(MOST_OF_STAGE));
        float one = uniform_of(step_seed(), id, 1u + stage) < fract(make) ? 1.0 : 0.0;
        uint made = uint(min(floor(make) + one, float(MOST_OF_STAGE)));
        words[stage / 5u] |= made << shift_of(stage);
        all += made;
    }
    stages[i].xyz = words;
    wanted[motions[i].number] = all;
}

void main() {
    uint end = counts.sorted;
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
