#version 460
// Pass `peel`, a layer: the nearest blob behind the layer before (depth peeling, Everitt 2001; Huszar, Szecsi, Sec. 5).
// Reads: what billboard.glsl reads, the layer before. Writes: depth and number of the layer.

#include "billboard.glsl"

layout(set = 0, binding = 4) uniform usampler2D before;
layout(push_constant, std430) uniform Push { uint layer; } push;

layout(location = 0) out uvec2 found;

void main() {
    Seen seen = seen_here();
    float nearer = push.layer > 0u ? uintBitsToFloat(texelFetch(before, ivec2(gl_FragCoord.xy), 0).x) : 0.0;
    if (seen.depth <= nearer) {
        discard;
    }
    found = uvec2(floatBitsToUint(seen.depth), layer_of(blob_index, seen.id));
    // Of all its digits, below 1.
    gl_FragDepth = seen.depth * exp2(-40.0);
}
