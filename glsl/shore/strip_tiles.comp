#version 460
// Pass `shoreline`: marks the 8x8 tiles that contain foam of a strip (the host's mesh along the shore), after the
// strip was drawn.
// Reads: foam. Writes: marks.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8) uniform sampler2D foam;

#include "shore_drawn.glsl"

layout(push_constant, std430) uniform Push {
    uvec2 tiles; // of the frame, across and down
} push;

const uint TILE = 8u; // pixels

void main() {
    uvec2 tile = gl_GlobalInvocationID.xy;
    vec2 size = vec2(textureSize(foam, 0));
    // Pixels beside the frame are 0, because the strip is drawn only in the frame. Beyond the image's edge its last
    // pixels are repeated.
    vec4 most = vec4(0.0);
    for (int i = 0; i < 16; ++i) {
        most = max(most, textureGather(foam, vec2(TILE * tile + 2u * uvec2(i & 3, i >> 2) + 1u) / size));
    }
    // The dispatch is rounded up to whole workgroups, and beyond the frame's tiles `marks` may end.
    if (all(lessThan(tile, push.tiles)) && dot(most, vec4(1.0)) > 0.0) {
        draws(tile.y * push.tiles.x + tile.x);
    }
}
