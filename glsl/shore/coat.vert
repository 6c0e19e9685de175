#version 460
// Pass `composite`, raster: one quad per run (adjacent 8x8 tiles of a row) with foam on the scene's own water
// surface.
// Reads: list. Writes: the quad's corners, values that are constant over the quad.

#include "frame.glsl"
#include "coat_light.glsl"
#include "shore_runs.glsl"

layout(set = 0, binding = 32, std430) readonly buffer List { uint list[]; };
layout(push_constant, std430) uniform Push {
    uint across; // tiles
    uint first;  // index in the list
} push;

layout(location = 0) flat out CoatLight light;
layout(location = 4) flat out vec2 target;

void main() {
    light = coat_light();
    target = frame.target.xy;
    uint run = list[push.first + gl_InstanceIndex];
    uint tile = first_of_run(run);
    uvec2 to = uvec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * uvec2(tiles_of_run(run), 1u);
    uvec2 corner = 8u * (uvec2(tile % push.across, tile / push.across) + to);
    vec2 pixel = min(vec2(corner), frame.extent.xy);
    gl_Position = vec4(pixel / frame.extent.xy * 2.0 - 1.0, 0.5, 1.0);
}
