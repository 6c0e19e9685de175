// Which whitewater particles are drawn as blobs of bubble foam. Needs frame.glsl, diffuse.glsl. Reads: hand-over.

#include "hand_over_rings.glsl"

// Not read where there is none.
layout(set = 0, binding = 11, std430) readonly buffer Over { HandOver hand_over; };

// RINGS or more: no blob may be there.
uint ring_of(float distance_) {
    return distance_ < frame.diffuse.z ? min(uint(distance_ / frame.diffuse.z * float(RINGS)), RINGS - 1u) : RINGS;
}

// What of a particle is its sprite's: of foam near the eye less.
float kept_of(Diffuse p) {
    if (frame.diffuse.z > 0.0 && p.kind == FOAM) {
        float near = hand_over.near;
        float far = hand_over.far;
        return far > 0.0 ? smoothstep(near, far, length(p.centre)) : 1.0;
    }
    return 1.0;
}
