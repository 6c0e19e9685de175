#version 460
// Pass `radiance`, first part: replaces the fluid's depth by that of the smoothed surface, because the bumps of the
// fluid's spheres would occlude foam. `splat` uses the spheres, which exist before the smoothing and its tiles. Not
// in the paper, whose fluid surface is given.
// Reads: depth, smoothed, levels, depths of foam, fluid and scene. Writes: depth of the fluid.

#include "frame.glsl"
#include "level.glsl"
#include "smoothed_depth.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, rgba32f) uniform image2D occluders;
layout(set = 0, binding = 2) uniform sampler2D depth;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.extent.xy)))) {
        return;
    }
    vec4 there = imageLoad(occluders, pixel);
    // The host's own fluid is not smoothed.
    if (there.z < EMPTY && there.z == texelFetch(depth, pixel, 0).x) {
        there.z = smoothed_at(vec2(pixel) + 0.5, there.z);
        imageStore(occluders, pixel, there);
    }
}
