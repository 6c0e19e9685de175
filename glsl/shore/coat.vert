#version 460
// Pass `composite`, raster: a quad a tile that has foam on the scene's water.
// Reads: list. Writes: its corners.

#include "frame.glsl"

layout(set = 0, binding = 32, std430) readonly buffer List { uint list[]; };
layout(push_constant, std430) uniform Push {
    uint across; // tiles
    uint first;  // of the list
} push;

void main() {
    uint tile = list[push.first + gl_InstanceIndex];
    uvec2 corner = 8u * (uvec2(tile % push.across, tile / push.across) + uvec2(gl_VertexIndex & 1, gl_VertexIndex >> 1));
    vec2 pixel = min(vec2(corner), frame.extent.xy);
    gl_Position = vec4(pixel / frame.extent.xy * 2.0 - 1.0, 0.5, 1.0);
}
