#version 460
// Pass `lit`, last part: copies the lit scene to the output, before the fluid is composited over it.
// Reads: lit scene. Writes: output.

#include "frame.glsl"

layout(set = 0, binding = 1) uniform sampler2D lit;

layout(location = 0) out vec4 color;

void main() {
    color = texelFetch(lit, ivec2(gl_FragCoord.xy - frame.target.xy), 0);
}
