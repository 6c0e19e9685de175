#version 460
// Pass `spray`, first part: lists the particles in view that are fully or partly spray, in eye space (thesis Sec.
// 4.9.5).
// Reads: Counts (particles), positions, densities, velocities, ids, shapes, members of packets. Writes: Counts
// (droplets), sprites.

#include "frame.glsl"
#include "frustum.glsl"
#include "counts.glsl"
#include "density.glsl"
#include "axes.glsl"
#include "shaped.glsl"
#include "spray.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 2, std430) readonly buffer Densities { float densities[]; };
layout(set = 0, binding = 3, std430) readonly buffer Velocities { float velocities[]; };
layout(set = 0, binding = 4, std430) readonly buffer Ids { uint ids[]; };
layout(set = 0, binding = 5, std430) readonly buffer Shapes { uint shapes[]; };
layout(set = 0, binding = 6, std430) buffer CountBuffer { Counts counts; };
layout(set = 0, binding = 7, std430) writeonly buffer Sprites { SpraySprite sprites[]; };

layout(push_constant, std430) uniform Push {
    uint position_word;   // of the chunk's first particle
    uint position_stride; // in words
    uint density_word;
    uint density_stride;
    uint velocity_word;
    uint velocity_stride; // 0: at rest
    uint id_word;
    uint id_stride;       // 0: no ids, the index in the frame instead
    uint shape_word;
    uint shape_stride;    // 0: balls
    uint chunk_first;
    uint packets;         // 1: particles in no packet do not count
} push;

#define MEMBERS 8
#include "members.glsl"

void visit(uint index) {
    if (!is_member(index)) {
        return;
    }
    float density = densities[push.density_word + index * push.density_stride];
    // A density of 0 marks a particle that was just emitted and has no density yet: it is not spray. NaN counts as 0,
    // because comparisons with it are false.
    float share = density > 0.0 ? share_of_spray(density) : 0.0;
    if (!(share > 0.0)) {
        return;
    }
    uint at = push.position_word + index * push.position_stride;
    vec3 position = vec3(positions[at], positions[at + 1u], positions[at + 2u]);
    at = push.velocity_word + index * push.velocity_stride;
    vec3 velocity = push.velocity_stride > 0u
        ? vec3(velocities[at], velocities[at + 1u], velocities[at + 2u]) : vec3(0.0);
    if (!(all(lessThan(abs(position), vec3(1.0e18))) && all(lessThan(abs(velocity), vec3(1.0e18))))) {
        return;
    }
    vec3 centre = (frame.view * vec4(position, 1.0)).xyz;
    velocity = mat3(frame.view) * velocity;
    // The droplets of a particle lie within the scatter radius around its centre; `reach`, the radius for culling,
    // adds their sizes, streaks and shifts along the motion. A particle whose depth is at most the scatter radius is
    // not drawn, because it would fill the picture.
    uvec4 shape = uvec4(pack_axes(mat3(1.0)), floatBitsToUint(CROWDED));
    if (push.shape_stride > 0u) {
        at = push.shape_word + index * push.shape_stride;
        shape = uvec4(shapes[at], shapes[at + 1u], shapes[at + 2u], shapes[at + 3u]);
    }
    float mist = frame.spray_cloud.y * sqrt(axes_norm2(unpack_axes(shape.xyz)));
    float reach = frame.spray.z + max(LARGEST_DROPLET * frame.spray.y, mist)
                + length(velocity) * (0.5 * frame.spray.w + frame.spray_cloud.z);
    if (-centre.z <= max(frame.depth.z, frame.spray.z) || !in_frustum(centre, reach)) {
        return;
    }
    uint id = push.id_stride > 0u ? ids[push.id_word + index * push.id_stride] : push.chunk_first + index;
    uint droplets = uint(frame.density.w);
    uint slot = atomicAdd(counts.droplets, droplets) / droplets;
    sprites[slot] = SpraySprite(vec4(centre, share), vec4(velocity, uintBitsToFloat(id)), shape);
}

void main() {
    uint count = counts.particles;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) {
        visit(i);
    }
}
