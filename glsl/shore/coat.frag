#version 460
// Pass `composite`, raster: foam on the scene's own water surface. Water of particles is drawn over it afterwards. The
// output keeps its alpha, which is that of the scene's colour.
// Reads: shoreline and contact foam; scene colour, if the output cannot be blended. Writes: output.

#include "frame.glsl"
#include "scene_color.glsl"

// 1: the foam is blended onto the output, which holds the scene's colour; alpha is the fraction of the scene that
// remains. 0: it is mixed here.
layout(constant_id = 0) const uint BLENDED = 1;

// Light of the foam, from the vertex shader. A CPU driver would read it again for each pixel from a uniform block.
layout(location = 0) flat in CoatLight light;
layout(location = 4) flat in vec2 target;

layout(location = 0) out vec4 color;

void main() {
    vec2 pixel = gl_FragCoord.xy - target;
    vec4 coat = texelFetch(shore_foam, ivec2(pixel), 0);
    if (BLENDED == 1u) {
        // Without foam the output is unchanged.
        color = vec4(coated(vec3(0.0), coat, light), uncovered(coat, light));
    } else {
        if (coat.x + coat.y == 0.0) {
            discard;
        }
        vec4 scene = filtered(scene_color, pixel * frame.scene_color.xy, frame.scene_origin.zw, frame.scene_color.zw);
        color = vec4(coated(scene.rgb, coat, light), scene.a);
    }
}
