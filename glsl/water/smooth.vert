#version 460
// Pass `smooth`, form Query: one quad a tile that holds water, gated by the block's predicate.
// Reads: tile list, predicates.

#include "frame.glsl"

// 1: the vertex shader is the gate.
layout(constant_id = 0) const uint CULL = 0;

layout(set = 0, binding = 3, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 4, std430) readonly buffer Predicates { uint predicates[]; };

layout(push_constant, std430) uniform Push {
    uint iteration; // from 1
    uint columns;   // tiles a row
    uint block;
} push;

void main() {
    uint tile = list[gl_InstanceIndex];
    vec2 corner = vec2(tile % push.columns, tile / push.columns) + vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    vec2 pixel = min(corner * 16.0, frame.extent.zw);
    gl_Position = vec4(pixel / frame.extent.zw * 2.0 - 1.0, 0.5, 1.0);
    // 256 bytes a predicate.
    if (CULL == 1u && predicates[push.block * 64u] == 0u) {
        gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
    }
}
