#version 460
// Pass `composite`, compute: shades the pixels of the listed tiles that show water, foam, spray, whitewater particles
// or bubble foam; the source draws one quad over the screen (thesis Sec. 4.9.3). A tile has 16x16 texels of the first
// smoothing level, which are up to 64x64 pixels; several workgroups of 8x8 pixels share it. The dispatch counts tiles
// in its second and third dimension, because one dimension may be too short for all of them, and because with a loop
// over tiles one driver took ten seconds to compile the shader.
// Reads: inputs of shade.glsl, tile list and arguments. Writes: output.

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

layout(local_size_x = 8, local_size_y = 8) in;

// The host chooses the format, so the image has no format qualifier.
layout(set = 0, binding = 8) uniform writeonly image2D target;
layout(set = 0, binding = 9, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 10, std430) readonly buffer Arguments { uvec4 arguments[]; };
layout(push_constant, std430) uniform Push { uint first; } push; // index in the list

void shade_pixel(ivec2 pixel) {
    if (any(greaterThanEqual(pixel, ivec2(frame.extent.xy)))) {
        return;
    }
    float front = texelFetch(depth, pixel, 0).x;
    if (front < EMPTY || beside(vec2(pixel) + 0.5)) {
        imageStore(target, pixel + ivec2(frame.target.xy), vec4(shade(vec2(pixel) + 0.5, front), 1.0));
    }
}

void shade_block(int tile, int block) {
    ivec2 texel = ivec2(tile % levels.atlas.z, tile / levels.atlas.z) * 16;
    int edge = int(levels.level[0].texel.z);
    ivec2 corner = texel * edge + 8 * ivec2(block % (2 * edge), block / (2 * edge));
    shade_pixel(corner + ivec2(gl_LocalInvocationID.xy));
}

void main() {
    uint tiles = arguments[8u + 4u * NEAR + 2u * FOAM + SHEETS - 1u].w;
    uint i = gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y;
    // The last row may have fewer tiles.
    if (i < tiles) {
        shade_block(int(list[push.first + i]), int(gl_WorkGroupID.x));
    }
}
