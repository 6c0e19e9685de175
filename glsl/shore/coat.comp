#version 460
// Pass `composite`, compute: draws shoreline and contact foam on the scene's own water surface over the scene's
// colour, one workgroup per run (adjacent 8x8 tiles of a row). Particle water is drawn over it afterwards. The output
// keeps its alpha, which is that of the scene's colour.
// Reads: list, arguments, scene colour, shoreline and contact foam. Writes: output, for pixels with foam.

#include "frame.glsl"
#include "scene_color.glsl"
#include "shore_runs.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// The host chooses the format, so the image has no format qualifier.
layout(set = 0, binding = 8) uniform writeonly image2D target;
layout(set = 0, binding = 32, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 33, std430) readonly buffer Arguments { uint arguments[24]; };
layout(push_constant, std430) uniform Push {
    uint across; // tiles
    uint first;  // index in the list
} push;

void main() {
    uint i = gl_WorkGroupID.y * 65535u + gl_WorkGroupID.x;
    if (i >= arguments[1]) {
        return;
    }
    uint run = list[push.first + i];
    uint tile = first_of_run(run);
    ivec2 pixel = ivec2(8u * uvec2(tile % push.across, tile / push.across) + gl_LocalInvocationID.xy);
    int end = min(pixel.x + 8 * int(tiles_of_run(run)), int(frame.extent.x));
    for (; pixel.x < end && pixel.y < int(frame.extent.y); pixel.x += 8) {
        vec4 coat = texelFetch(shore_foam, pixel, 0);
        if (coat.x + coat.y > 0.0) {
            vec2 place = (vec2(pixel) + 0.5) * frame.scene_color.xy;
            vec4 scene = filtered(scene_color, place, frame.scene_origin.zw, frame.scene_color.zw);
            vec4 color = vec4(coated(scene.rgb, coat, coat_light()), scene.a);
            imageStore(target, pixel + ivec2(frame.target.xy), color);
        }
    }
}
