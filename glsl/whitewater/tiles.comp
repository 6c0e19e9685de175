#version 460
// Pass `radiance`, second part: lists the 8x8 tiles that contain whitewater. Most of a picture has none, and on a CPU
// an empty workgroup costs a good part of a full one. One invocation per tile.
// Reads: foam depth. Writes: tiles.

#include "frame.glsl"
#include "whitewater_tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 1) uniform sampler2D occluders;

void main() {
    uvec2 tile = gl_GlobalInvocationID.xy;
    vec2 texel = 1.0 / vec2(textureSize(occluders, 0));
    // This may include texels outside the picture: pixels are tested again.
    vec4 nearest = vec4(EMPTY);
    for (uint i = 0u; i < 16u; ++i) {
        uvec2 four = 8u * tile + 2u * uvec2(i & 3u, i >> 2) + 1u;
        nearest = min(nearest, textureGather(occluders, vec2(four) * texel));
    }
    bool inside = all(lessThan(vec2(8u * tile), frame.extent.xy));
    if (inside && min(min(nearest.x, nearest.y), min(nearest.z, nearest.w)) < EMPTY) {
        add_tile(tile);
    }
}
