#version 460
// Pass `near`: near the camera, whitewater foam cross-fades to bubble blobs: a particle's blob grows as its sprite
// shrinks. (Akinci et al. 2013 draw no foam near the camera; blobs by Huszar, Szecsi.) Two dispatches over the
// particles: the first builds a histogram of their distances; the second writes blobs for the particles nearer than a
// distance, chosen so that there are enough slots for them.
// Reads: positions, kinds, radii, ages, ids, particle counts, cross-fade distances. Writes: histogram (first); count,
// spheres, orientations and ids of the blobs (second).

#include "frame.glsl"
#include "falloff.glsl"
#include "whitewater.glsl"
#include "random.glsl"
#include "crossfade.glsl"
#include "frustum.glsl"
#include "near_blob.glsl"

layout(local_size_x = 64) in;
// 0: count. 1: list.
layout(constant_id = 0) const uint GO = 0;

layout(push_constant, std430) uniform Push {
    uint position_word;
    uint position_stride;
    uint kind_word;
    uint kind_stride;
    uint radius_word;
    uint radius_stride;
    uint age_word;
    uint age_stride;
    uint id_word;
    uint id_stride;
    uint chunk_first;
    uint chunk;
    uint room; // capacity of blobs
} push;

#include "whitewater_streams.glsl"

layout(set = 0, binding = 6, std430) buffer Numbers { uint numbers[]; };
layout(set = 0, binding = 7, std430) readonly buffer Arguments { uvec4 arguments[]; };
layout(set = 0, binding = 8, std430) writeonly buffer Balls { vec4 balls[]; };
layout(set = 0, binding = 9, std430) writeonly buffer Turns { vec4 turns[]; };
layout(set = 0, binding = 10, std430) writeonly buffer BlobIds { uint blob_ids[]; };
layout(set = 0, binding = 12, std430) buffer Count { uint count; };

// A random rotation from the id.
vec4 turn_of(uint id) {
    vec4 q = vec4(uniform_of(1u, id, 0u), uniform_of(1u, id, 1u), uniform_of(1u, id, 2u), uniform_of(1u, id, 3u)) - 0.5;
    return dot(q, q) > 1.0e-4 ? normalize(q) : vec4(0.0, 0.0, 0.0, 1.0);
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= arguments[push.chunk].w) {
        return;
    }
    vec4 world = whitewater_world(i);
    Whitewater p = whitewater_whole(i, world);
    // Counting and listing must compute exactly the same value.
    precise float distance_ = length(p.centre);
    uint ring = ring_of(distance_);
    bool near = may_be_blob(p, distance_);
    if (GO == 0u) {
        if (near) {
            atomicAdd(numbers[ring], 1u);
        }
        return;
    }
    if (near && ring < crossfade.rings) {
        uint slot = atomicAdd(count, 1u);
        if (slot < push.room) {
            uint id = whitewater_id(i);
            // The blob takes over the area that the sprite loses.
            float part = sqrt(max(1.0 - kept_of(p), 0.0));
            balls[slot] = vec4(world.xyz, frame.whitewater_light.w * p.radius * p.life * part);
            turns[slot] = turn_of(id);
            blob_ids[slot] = id;
        }
    }
}
