#version 460
// Pass `splat` by quads, first draw (Akinci et al. 2013, Sec. 2.1; pass 3): finds the frontmost particle by a depth
// test.
// Reads: words. Writes: bits of its depth, its search radius and normal.

#include "frame.glsl"
#include "falloff.glsl"
#include "whitewater.glsl"
#include "whitewater_words.glsl"
#include "whitewater_quad.glsl"

layout(location = 0) out uvec2 front;

void main() {
    Met m = meet();
    front = uvec2(floatBitsToUint(m.depth), with_of(search_of(m.p.radius, sprite.x), m.place, m.w));
    // The written depth is greater for nearer particles, and nearly as precise as the eye depth in `m`: like that it
    // is a float, and the division rounds once more. It is at most 1, which only a sphere reaches that almost touches
    // the eye's plane.
    gl_FragDepth = min(frame.depth.z / m.depth / 1048576.0, 1.0);
}
