#version 460
// Pass `composite`: one quad a tile that holds water.
// Reads: tile list, levels.

#include "frame.glsl"
#include "level.glsl"

layout(set = 0, binding = 9, std430) readonly buffer List { uint list[]; };
layout(push_constant, std430) uniform Push { uint columns; } push;

void main() {
    uint tile = list[gl_InstanceIndex];
    ivec2 texel = ivec2(tile % push.columns, tile / push.columns) * 16;
    uint own = level_of(texel.y);
    Level level = levels.level[own];
    texel += 16 * ivec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) - level.rect.xy;
    vec2 pixel = min(vec2(texel) * level.texel.z, frame.extent.xy);
    gl_Position = vec4(pixel / frame.extent.xy * 2.0 - 1.0, 0.5, 1.0);
    // While two levels are in use each covers all of the water: draw it once.
    if (own != finer_level()) {
        gl_Position = vec4(2.0, 2.0, 0.5, 1.0);
    }
}
