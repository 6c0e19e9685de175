// Which whitewater particles are drawn as blobs of bubble foam. Needs frame.glsl, diffuse.glsl. Reads: hand-over.

#include "hand_over_rings.glsl"

// Not read without blobs.
layout(set = 0, binding = 11, std430) readonly buffer Over { HandOver hand_over; };

// RINGS or more: too far for blobs.
uint ring_of(float distance_) {
    return distance_ < frame.diffuse.z ? min(uint(distance_ / frame.diffuse.z * float(RINGS)), RINGS - 1u) : RINGS;
}

// Fraction of a particle that its sprite shows: less for foam near the eye.
float kept_of(Diffuse p) {
    if (frame.diffuse.z > 0.0 && p.kind == FOAM) {
        float near = hand_over.near;
        float far = hand_over.far;
        return far > 0.0 ? smoothstep(near, far, length(p.centre)) : 1.0;
    }
    return 1.0;
}
