// Which whitewater particles are drawn as blobs of bubble foam. Needs frame.glsl, whitewater.glsl. Reads: crossfade.

#include "crossfade_rings.glsl"

// Not read without blobs.
layout(set = 0, binding = 11, std430) readonly buffer Over { Crossfade crossfade; };

// Histogram bin of a distance; RINGS or more is too far for blobs.
uint ring_of(float distance_) {
    return distance_ < frame.whitewater.z ? min(uint(distance_ / frame.whitewater.z * float(RINGS)), RINGS - 1u) : RINGS;
}

// Fraction of a particle that is drawn as a sprite: for foam it falls from 1 at distance `far` to 0 at `near`, where
// blobs replace the sprites.
float kept_of(Whitewater p) {
    if (frame.whitewater.z > 0.0 && p.kind == FOAM) {
        float near = crossfade.near;
        float far = crossfade.far;
        return far > 0.0 ? smoothstep(near, far, length(p.centre)) : 1.0;
    }
    return 1.0;
}
