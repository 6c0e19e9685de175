#version 460
// Pass `lit`: the scene with the shadows and caustics of water and foam (lit.glsl; caustics are the thesis' future
// work, Sec. 6.2).
// Reads: scene colour and depth, caustics, inputs of sunlight.glsl. Writes: the whole lit scene.

#include "frame.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"
#include "lit.glsl"

layout(location = 0) out vec4 color;

void main() {
    color = lit_at(gl_FragCoord.xy);
}
