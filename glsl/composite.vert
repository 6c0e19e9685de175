#version 460
// Pass `composite`: one quad a tile that holds water.
// Reads: tile list.

#include "frame.glsl"

layout(set = 0, binding = 9, std430) readonly buffer List { uint list[]; };
layout(push_constant, std430) uniform Push { uint columns; } push;

void main() {
    uint tile = list[gl_InstanceIndex];
    vec2 corner = vec2(tile % push.columns, tile / push.columns) + vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    vec2 pixel = min(corner * 16.0 * frame.thick_extent.w, frame.extent.xy);
    gl_Position = vec4(pixel / frame.extent.xy * 2.0 - 1.0, 0.5, 1.0);
}
