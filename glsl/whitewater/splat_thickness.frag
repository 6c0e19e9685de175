#version 460
// Pass `splat` by quads, second draw (Akinci et al. 2013, Sec. 2.2; pass 4): thickness, by additive blending.
// Reads: words. Writes: thickness in front of the fluid, behind it, and the latter weighted by its distance behind
// the fluid's surface.

#include "frame.glsl"
#include "falloff.glsl"
#include "whitewater.glsl"
#include "whitewater_words.glsl"
#include "whitewater_quad.glsl"

layout(location = 0) out vec4 shares;

void main() {
    Met m = meet();
    float amount = whitewater_amount(m.p, m.f, m.rr);
    vec3 all = whitewater_shares(amount, m.depth, uintBitsToFloat(words[m.at + FLUID]));
    // Thicknesses are rounded to whole steps of 1 / STEPS, as in the compute path, so that their sums up to 256 are
    // exact in any order.
    shares = vec4(floor(all * STEPS + 0.5) / STEPS, 0.0);
}
