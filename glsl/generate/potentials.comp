#version 460
// Pass `potentials`: trapped-air potential and kinetic energy of each particle, and the surface normal (Ihmsen et al.
// 2012, Sec. 3.1).
// Reads: the grid, counts. Writes: normals, potentials.

#include "random.glsl"
#include "generate.glsl"
#include "neighbours.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 4, std430) readonly buffer CountBuffer { GenerateCounts counts; };
// xyz: surface normal of a particle at the surface, else 0. w: number of its neighbours.
layout(set = 0, binding = 5, std430) writeonly buffer Normals { vec4 normals[]; };
// For each fluid particle, in the host's order: trapped air, wave crest (0; pass `crest` adds it), energy, number of
// neighbours.
layout(set = 0, binding = 6, std430) writeonly buffer Potentials { vec4 potentials[]; };

// A particle is at the surface if the weighted mean of the vectors from its neighbours to it, in units of the support
// radius, is longer than this. The mean's length is 0.3 on a flat surface and 0 inside.
const float AT_SURFACE = 0.15;

void visit(uint i) {
    vec3 position = places[i].position;
    vec3 velocity = motions[i].velocity;
    uint neighbours = 0u;
    uint trapped = 0u;
    ivec3 away = ivec3(0);
    uint weights = 0u;
    for (int c = 0; c < 27; ++c) {
        ivec3 cell = neighbour_cell(position, c);
        uvec2 range = range_of(cell);
        for (uint j = range.x; j < range.y; ++j) {
            vec3 from = position - places[j].position;
            float d = length(from);
            if (j == i || !(d < support()) || !in_cell(places[j].position, cell)) {
                continue;
            }
            float weight = 1.0 - d / support();
            vec3 slower = velocity - motions[j].velocity;
            float speed = length(slower);
            // Computed as speed minus a projection, so that no zero vector is normalized.
            float air = d > 0.0 ? (speed - dot(slower, from) / d) * weight : 0.0;
            trapped += uint(clamp(air / speed_step(), 0.0, MOST_STEPS) + 0.5);
            away += ivec3(round(from / support() * (weight * STEPS)));
            weights += uint(weight * STEPS + 0.5);
            neighbours += 1u;
        }
    }
    float shift = length(vec3(away));
    bool surface = shift > AT_SURFACE * float(weights);
    normals[i] = vec4(surface ? vec3(away) / shift : vec3(0.0), float(neighbours));
    float energy = 0.5 * dot(velocity, velocity);
    potentials[motions[i].number] = vec4(float(trapped) * speed_step(), 0.0, energy, float(neighbours));
}

void main() {
    uint end = counts.sorted;
    for (uint i = gl_GlobalInvocationID.x; i < end; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
