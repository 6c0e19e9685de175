#version 460
// Pass `shape`, last part: moves each particle towards the centre of its neighbours, so that thin layers of water and
// their rims are smooth (Yu and Turk 2013, Eq. 6). The mean displacement of the neighbourhood is subtracted (Vollmer,
// Mencl, Mueller 1999), because with Eq. 6 alone the whole surface moves inwards, and a body of water shrinks away
// from its walls. In this mean, large displacements have a large weight: they belong to particles at the surface.
// Reads: the grid, counts, shifts. Writes: shaped (positions).

#include "random.glsl"
#include "place.glsl"

layout(local_size_x = 64) in;

layout(push_constant, std430) uniform Push {
    float cells;   // grid cells per unit of length: 1 / reach
    uint buckets;  // a power of two
    float centred; // strength of the displacement
} push;

#include "grid.glsl"
#include "shaped.glsl"

layout(set = 0, binding = 3, std430) readonly buffer CountBuffer { uint sorted; };
layout(set = 0, binding = 4, std430) writeonly buffer Shaped { uint shaped[]; };
layout(set = 0, binding = 5, std430) readonly buffer Shifts { vec4 shifts[]; };

// Fixed-point steps per unit of the sums of displacements and weights. Addends are at most 1, so the sums over 27
// full buckets of the grid fit in 32 bits.
const float STEPS = 65536.0;

void visit(uint i) {
    vec3 position = places[i].position;
    vec4 own = shifts[i];
    float length_of_own = length(own.xyz);
    int weights = int(length_of_own * STEPS + 0.5);
    ivec3 sum = ivec3(round(own.xyz * (length_of_own * STEPS)));
    for (int c = 0; c < 27; ++c) {
        ivec3 cell = neighbour_cell(position, c);
        uvec2 range = range_of(cell);
        for (uint j = range.x; j < range.y; ++j) {
            vec3 to = (places[j].position - position) * push.cells;
            float d2 = dot(to, to);
            if (j == i || !(d2 < 1.0) || !in_cell(places[j].position, cell)) {
                continue;
            }
            vec3 shift = shifts[j].xyz;
            float weight = (1.0 - d2 * sqrt(d2)) * length(shift);
            weights += int(weight * STEPS + 0.5);
            sum += ivec3(round(shift * (weight * STEPS)));
        }
    }
    vec3 mean = weights > 0 ? vec3(sum) / float(weights) : vec3(0.0);
    vec3 centre = position + (own.xyz - mean) * (push.centred * own.w / push.cells);
    uint at = SHAPED_WORDS * places[i].id;
    for (uint k = 0u; k < 3u; ++k) {
        shaped[at + k] = floatBitsToUint(centre[k]);
    }
}

void main() {
    for (uint i = gl_GlobalInvocationID.x; i < sorted; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
