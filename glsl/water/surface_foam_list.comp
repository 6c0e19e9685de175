#version 460
// Pass `surface_foam`, first part: lists the particles with foam, in eye space (thesis Sec. 3.2.1, 4.6.2). A particle
// that its low density makes partly spray has only the rest of its foam.
// Reads: Counts (particles), positions, foam, velocities, ids, densities, members, shadow maps. Writes: Counts
// (foam), sprites.

#include "frame.glsl"
#include "frustum.glsl"
#include "counts.glsl"
#include "density.glsl"
#include "random.glsl"
#include "gradient_noise.glsl"
#include "surface_foam.glsl"
#include "pattern.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Amounts { float amounts[]; };
layout(set = 0, binding = 3, std430) readonly buffer Velocities { float velocities[]; };
layout(set = 0, binding = 4, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 5, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 6, std430) buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 7, std430) writeonly buffer Sprites { FoamSprite sprites[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint amount_word;
    uint amount_stride;
    uint velocity_word;
    uint velocity_stride; // 0: at rest
    uint id_word;
    uint id_stride;       // 0: no ids, the index in the frame instead
    uint density_word;
    uint density_stride;  // 0: no densities
    uint chunk_first;
    uint packets;         // 1: particles in no packet do not count
} push;

#define MEMBERS 8
#include "members.glsl"

void visit(uint index) {
    if (!is_member(index)) {
        return;
    }
    uint at = push.amount_word + index * push.amount_stride;
    // Comparisons with NaN are false.
    if (!(amounts[at] > 0.0)) {
        return;
    }
    float foam = min(amounts[at], 1.0);
    float age = amounts[at + 1u];
    if (push.density_stride > 0u) {
        float density = densities[push.density_word + index * push.density_stride];
        foam *= density > 0.0 ? bulk(density) : 1.0;
        if (!(foam > 0.0)) {
            return;
        }
    }
    at = push.position_word + index * push.position_stride;
    vec3 position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    at = push.velocity_word + index * push.velocity_stride;
    vec3 velocity = push.velocity_stride > 0u
        ? vec3(velocities[at], velocities[at + 1u], velocities[at + 2u]) : vec3(0.0);
    if (!(all(lessThan(abs(position), vec3(1.0e18))) && all(lessThan(abs(velocity), vec3(1.0e18))))) {
        return;
    }
    vec3 centre = (frame.view * vec4(position, 1.0)).xyz;
    // `reach`: upper bound of the half-axes of the particle's foam sprite, in scene units, for the test whether it is
    // in the view. A particle whose centre is behind the eye or before the near plane gets no sprite in any case.
    float texel = -centre.z * max(abs(frame.thick_slope.x), abs(frame.thick_slope.y));
    float reach = max(2.0 * FOAM_AXIS * frame.particle.x, LEAST_FOAM_AXIS * texel);
    if (-centre.z <= frame.depth.z || !in_frustum(centre, reach)) {
        return;
    }
    vec4 pattern = coarse_pattern(position, velocity, texel);
    pattern.xyz = mat3(frame.view) * pattern.xyz;
    uint id = push.id_stride > 0u ? ids[push.id_word + index * push.id_stride] : push.chunk_first + index;
    age = age > 0.0 && age < 1.0e6 ? age : 0.0;
    uint slot = atomicAdd(counts.foam, 1u);
    // The first sprite of each workgroup of the compute path.
    if (slot % FOAM_GROUP == 0u) {
        atomicAdd(counts.foam_groups[0], 1u);
    }
    sprites[slot] = FoamSprite(vec4(centre, foam), vec4(mat3(frame.view) * velocity, age),
                               vec4(uintBitsToFloat(id), sun_in_foam(centre), 0.0, 0.0), pattern);
}

void main() {
    uint count = counts.particles;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
