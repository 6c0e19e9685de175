#version 460
// Pass `near`, between its two dispatches over the particles: finds the distance up to which there are enough slots
// for blobs. If there are too few for the configured distance, the cross-fade from blobs to sprites moves nearer for
// all particles, so that no blob is cut off half-way.
// Reads: histogram. Writes: cross-fade distances.

#include "frame.glsl"
#include "crossfade_rings.glsl"

layout(local_size_x = 128) in;

layout(set = 0, binding = 6, std430) readonly buffer Numbers { uint numbers[]; };
layout(set = 0, binding = 11, std430) writeonly buffer Over { Crossfade crossfade; };
layout(push_constant, std430) uniform Push { uint room; } push;

const uint OWN = RINGS / 128u;
shared uint sums[128];

void main() {
    uint own = gl_LocalInvocationIndex;
    uint sum = 0u;
    for (uint i = 0u; i < OWN; ++i) {
        sum += numbers[own * OWN + i];
    }
    sums[own] = sum;
    barrier();
    if (own > 0u) {
        return;
    }
    uint before = 0u;
    uint ring = 0u;
    while (ring < RINGS && before + sums[ring / OWN] <= push.room) {
        before += sums[ring / OWN];
        ring += OWN;
    }
    uint last = min(ring + OWN, RINGS);
    while (ring < last && before + numbers[ring] <= push.room) {
        before += numbers[ring];
        ++ring;
    }
    float part = float(ring) / float(RINGS);
    crossfade = Crossfade(frame.whitewater.y * part, frame.whitewater.z * part, ring, before);
}
