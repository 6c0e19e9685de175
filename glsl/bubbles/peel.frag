#version 460
// Pass `peel`, one layer: in each pixel the nearest blob behind the one of the previous layer (depth peeling, Everitt
// 2001; Huszar, Szecsi, Sec. 5).
// Reads: inputs of billboard.glsl, the previous layer. Writes: depth and number of the layer.

#include "billboard.glsl"

layout(set = 0, binding = 4) uniform usampler2D before;
layout(push_constant, std430) uniform Push { uint layer; } push;

layout(location = 0) out uvec2 found;

void main() {
    Seen seen = seen_here();
    uint own = layer_of(blob_index, seen.id);
    uvec2 last = texelFetch(before, ivec2(gl_FragCoord.xy), 0).xy;
    // Blobs at the same depth are ordered by their numbers. In a pixel where the previous layer is empty, so is this
    // one.
    float nearer = uintBitsToFloat(last.x);
    bool behind = last.y != NO_LAYER && (seen.depth > nearer || (seen.depth == nearer && own > last.y));
    if (push.layer > 0u && !behind) {
        discard;
    }
    found = uvec2(floatBitsToUint(seen.depth), own);
    // Scaled by a power of two to below 1, which keeps all digits.
    gl_FragDepth = seen.depth * exp2(-40.0);
}
