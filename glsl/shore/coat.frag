#version 460
// Pass `composite`, raster: foam on the scene's water, where the particles' is not: that draws over it.
// Reads: shoreline and contact foam; scene colour, where the output cannot be blended with. Writes: output.

#include "frame.glsl"
#include "scene_color.glsl"

// 1: alpha is how much of the output stays, which is the scene's colour.
layout(constant_id = 0) const uint BLENDED = 1;

layout(location = 0) out vec4 color;

void main() {
    vec2 pixel = gl_FragCoord.xy - frame.target.xy;
    vec4 coat = texelFetch(shore_foam, ivec2(pixel), 0);
    if (coat.x + coat.y == 0.0) {
        discard;
    }
    color = BLENDED == 1u ? vec4(coated(vec3(0.0), coat), uncovered(coat)) : vec4(coated(uncoated_at(pixel), coat), 1.0);
}
