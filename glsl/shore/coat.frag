#version 460
// Pass `composite`, raster: foam on the scene's water, where the particles' is not: that draws over it.
// Reads: scene colour, shoreline and contact foam. Writes: output.

#include "frame.glsl"
#include "scene_color.glsl"

layout(location = 0) out vec4 color;

void main() {
    vec2 pixel = gl_FragCoord.xy - frame.target.xy;
    vec2 coat = texelFetch(shore_foam, ivec2(pixel), 0).xy;
    if (coat.x + coat.y == 0.0) {
        discard;
    }
    color = vec4(scene_at(pixel), 1.0);
}
