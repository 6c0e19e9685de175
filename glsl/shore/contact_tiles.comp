#version 460
// Pass `contact`: lists the 8x8 tiles that may contain contact foam, which is foam around objects, on the water of
// particles.
// Reads: depth, scene depth. Writes: list of tiles, the dispatch over it.

#include "frame.glsl"
#include "shore.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 3) uniform sampler2D depth;

#include "shore_lists.glsl"
#include "shore_tiles.glsl"

void main() {
    vec2 first = vec2(TILE * gl_GlobalInvocationID.xy);
    float part = EMPTY;
    for (int i = 0; i < 4; ++i) {
        vec2 corner = first + 0.5 + float(TILE - 1u) * vec2(i & 1, i >> 1);
        part = min(part, counted(vec3(ray_slope(corner, frame.slope), -1.0)));
    }
    vec2 texel = 1.0 / vec2(textureSize(scene_depth, 0));
    vec2 own = 1.0 / vec2(textureSize(depth, 0));
    // Least distance in depth, over the tile's pixels, from the front of the particles' water to the scene behind it.
    // The smoothed surface differs from the front by at most `frame.surface.w`, so this is subtracted.
    vec4 least = vec4(EMPTY);
    for (int i = 0; i < FOURS; ++i) {
        vec2 four = four_of(first, i);
        vec4 front = textureGather(depth, (four + 1.0) * own);
        vec4 scene = frame.depth.x / (scene_at_four(four, texel) + frame.depth.y);
        bvec4 both = bvec4(uvec4(lessThan(front, vec4(EMPTY))) & uvec4(greaterThan(scene, vec4(0.0))));
        least = min(least, mix(vec4(EMPTY), scene - front, both));
    }
    float near = min(min(least.x, least.y), min(least.z, least.w)) - frame.surface.w;
    // With a margin for rounding: pixels are tested again.
    if (all(lessThan(first, frame.extent.xy)) && near * part * shore.contact.y < 1.0 + 1.0e-4) {
        adds(5u);
    }
}
