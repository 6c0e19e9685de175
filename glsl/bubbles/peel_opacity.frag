#version 460
// Pass `peel`, opacity: the maximum of the opacities of all blobs in a pixel (Huszar, Szecsi, Sec. 5).
// Reads: inputs of billboard.glsl. Writes: opacity, by MAX blending.

#include "billboard.glsl"

layout(location = 0) out float opacity;

void main() {
    opacity = seen_here().opacity;
}
