#version 460
// Pass `peel`, opacity: of all blobs the most (Huszar, Szecsi, Sec. 5).
// Reads: what billboard.glsl reads. Writes: opacity, by blending with the larger.

#include "billboard.glsl"

layout(location = 0) out float opacity;

void main() {
    opacity = seen_here().opacity;
}
