#version 460
// Pass `crest`: wave-crest potential (curvature where the surface moves outwards), and from all potentials the number
// of whitewater particles to emit (Ihmsen et al. 2012, Sec. 3.1 and 3.2).
// Reads: the grid, counts, normals, potentials. Writes: potentials, emission rates, number of particles to emit (for a
// snapshot, pass `trace` replaces it).

#include "random.glsl"
#include "generate.glsl"
#include "neighbours.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { GenerateCounts counts; };
layout(set = 0, binding = 5, std430) readonly buffer Normals { vec4 normals[]; };
layout(set = 0, binding = 6, std430) buffer Potentials { vec4 potentials[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Wanted { uint wanted[]; };
// Fraction of the max emission rate, in the grid's order.
layout(set = 0, binding = 8, std430) writeonly buffer Rates { float rates[]; };

// A particle may be in a wave crest if the cosine of the angle between its velocity and its surface normal is at
// least this.
const float ALONG = 0.6;
// Max number of whitewater particles that a fluid particle emits in a step. (A snapshot has another max:
// generate_stages.glsl.)
const float MOST_MADE = 64.0;

// Curvature of the surface from convex neighbours only, which are those below the tangent plane.
uint bend(vec3 position, vec3 normal) {
    uint sum = 0u;
    for (int c = 0; c < 27; ++c) {
        ivec3 cell = neighbour_cell(position, c);
        uvec2 range = range_of(cell);
        for (uint j = range.x; j < range.y; ++j) {
            vec3 to = places[j].position - position;
            float d = length(to);
            vec3 other = normals[j].xyz;
            if (dot(to, normal) < 0.0 && d < support() && dot(other, other) > 0.0
                && in_cell(places[j].position, cell)) {
                sum += uint(max(1.0 - dot(normal, other), 0.0) * (1.0 - d / support()) * STEPS + 0.5);
            }
        }
    }
    return sum;
}

float phi(float potential, float least, float scale) {
    return clamp((potential - least) * scale, 0.0, 1.0);
}

void visit(uint i) {
    vec3 velocity = motions[i].velocity;
    vec3 normal = normals[i].xyz;
    uint number = motions[i].number;
    vec4 found = potentials[number];
    if (dot(normal, normal) > 0.0 && dot(velocity, normal) >= ALONG * length(velocity) && found.z > 0.0) {
        found.y = float(bend(places[i].position, normal)) / STEPS;
        potentials[number].y = found.y;
    }
    float rate = push.trapped_rate * phi(found.x, push.trapped_least, push.trapped_scale)
               + push.crest_rate * phi(found.y, push.crest_least, push.crest_scale);
    rate *= phi(found.z, push.energy_least, push.energy_scale);
    rates[i] = rate / max(push.trapped_rate + push.crest_rate, 1.0e-20);
    float make = min(rate * push.dt, MOST_MADE);
    float one = uniform_of(step_seed(), places[i].id, 0u) < fract(make) ? 1.0 : 0.0;
    wanted[number] = uint(min(floor(make) + one, MOST_MADE));
}

void main() {
    uint end = counts.sorted;
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
