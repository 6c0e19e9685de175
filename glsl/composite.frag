#version 460
// Pass `composite`, raster: in the tiles' quads (composite.vert), shades the pixels that show water, foam, spray,
// whitewater particles or bubble foam. The thesis draws one quad over the screen (Sec. 4.9.3).
// Reads: inputs of shade.glsl. Writes: output.

#include "frame.glsl"
#include "medium.glsl"
#include "level.glsl"
#include "sheets.glsl"
#include "surface.glsl"
#include "panes.glsl"
#include "surface_foam_texels.glsl"
#include "beside.glsl"
#include "convolution.glsl"
#include "intensity.glsl"
#include "sunlight.glsl"
#include "shore_light.glsl"
#include "surface_noise.glsl"
#include "random.glsl"
#include "gradient_noise.glsl"
#include "scene_color.glsl"
#include "shade.glsl"

layout(location = 0) out vec4 color;

void main() {
    vec2 pixel = gl_FragCoord.xy - frame.target.xy;
    float front = texelFetch(depth, ivec2(pixel), 0).x;
    if (front >= EMPTY && !beside(pixel)) {
        discard;
    }
    color = vec4(shade(pixel, front), 1.0);
}
