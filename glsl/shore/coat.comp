#version 460
// Pass `composite`, compute: foam on the scene's water, a tile of 8x8 pixels a group, where the particles' is not: that is
// stored over it.
// Reads: list, scene colour, shoreline and contact foam. Writes: output.

#include "frame.glsl"
#include "scene_color.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Its format is the host's choice: written without being told.
layout(set = 0, binding = 8) uniform writeonly image2D target;
layout(set = 0, binding = 32, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 33, std430) readonly buffer Arguments { uint arguments[24]; };
layout(push_constant, std430) uniform Push {
    uint across; // tiles
    uint first;  // of the list
} push;

void main() {
    uint i = gl_WorkGroupID.y * 65535u + gl_WorkGroupID.x;
    bool listed = i < arguments[1];
    uint tile = list[push.first + (listed ? i : 0u)];
    ivec2 pixel = ivec2(8u * uvec2(tile % push.across, tile / push.across) + gl_LocalInvocationID.xy);
    bool inside = listed && all(lessThan(pixel, ivec2(frame.extent.xy)));
    vec4 coat = inside ? texelFetch(shore_foam, pixel, 0) : vec4(0.0);
    if (coat.x + coat.y > 0.0) {
        imageStore(target, pixel + ivec2(frame.target.xy), vec4(coated(uncoated_at(vec2(pixel) + 0.5), coat), 1.0));
    }
}
