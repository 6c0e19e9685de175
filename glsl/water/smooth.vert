#version 460
// Pass `smooth`, form Query: one quad per listed tile (tiles.comp). A predicate per block of iterations tells
// whether any pixel is still active; if none is, no quad is drawn. (The source draws one quad over the image until
// the CPU has read a query: thesis Sec. 4.7, Listing A.11.)
// Reads: tile list, predicates. Writes: the quad's corners.

#include "frame.glsl"
#include "level.glsl"

// 1: the vertex shader is the gate.
layout(constant_id = 0) const uint CULL = 0;

layout(set = 0, binding = 3, std430) readonly buffer List { uint list[]; };
layout(set = 0, binding = 4, std430) readonly buffer Predicates { uint predicates[]; };

layout(location = 0) flat out uint own; // level of the tile

layout(push_constant, std430) uniform Push {
    uint iteration; // from 1
    uint columns;   // tiles per row
    uint block;
} push;

void main() {
    uint tile = list[gl_InstanceIndex];
    ivec2 corner = ivec2(tile % push.columns, tile / push.columns) * 16;
    own = level_of(corner);
    ivec4 rect = levels.level[own].rect;
    ivec2 pixel = min(corner + 16 * ivec2(gl_VertexIndex & 1, gl_VertexIndex >> 1), rect.xy + rect.zw);
    gl_Position = vec4(vec2(pixel) / vec2(levels.atlas.xy) * 2.0 - 1.0, 0.5, 1.0);
    // 256 bytes per predicate.
    if (CULL == 1u && predicates[push.block * 64u] == 0u) {
        gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
    }
}
