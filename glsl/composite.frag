#version 460
// Pass `composite`, raster: shades the pixels with water of the tiles' quads.
// Reads: what shade.glsl reads. Writes: output.

#include "frame.glsl"
#include "level.glsl"
#include "surface.glsl"
#include "shade.glsl"

layout(location = 0) out vec4 color;

void main() {
    float front = texelFetch(depth, ivec2(gl_FragCoord.xy), 0).x;
    if (front >= EMPTY) {
        discard;
    }
    color = vec4(shade(gl_FragCoord.xy, front), 1.0);
}
