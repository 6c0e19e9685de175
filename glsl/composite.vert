#version 460
// Pass `composite`, raster: one quad per listed tile, that is, per tile with water, foam, spray, whitewater particles
// or bubble foam. The thesis draws one quad over the screen (Sec. 4.9.3).
// Reads: tile list, levels. Writes: the quad's corners.

#include "frame.glsl"
#include "level.glsl"

layout(set = 0, binding = 9, std430) readonly buffer List { uint list[]; };
layout(push_constant, std430) uniform Push { uint first; } push; // index in the list

void main() {
    int tile = int(list[push.first + gl_InstanceIndex]);
    ivec2 texel = ivec2(tile % levels.atlas.z, tile / levels.atlas.z) * 16;
    texel += 16 * ivec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    vec2 pixel = min(vec2(texel) * levels.level[0].texel.z, frame.extent.xy);
    gl_Position = vec4(pixel / frame.extent.xy * 2.0 - 1.0, 0.5, 1.0);
}
