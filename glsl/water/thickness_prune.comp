#version 460
// Pass `thickness`, raster path, with two layers of water: removes the boundary (the depth that separates the
// layers) in texels where all water belongs to one layer, as thickness_apart.comp does on the compute path. Not in
// the thesis.
// Reads: thickness, sheets, boundaries, scene depth. Writes: sheets (RGBA32F: thickness of the front layer, of the
// back layer, and of the water near the boundary; the boundary as found), boundaries.

#include "frame.glsl"
#include "kernel.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 2, rgba32f) uniform image2D sheets;
layout(set = 0, binding = 3) uniform sampler2D scene_depth;
layout(set = 0, binding = 4) uniform sampler2D thickness;
layout(set = 0, binding = 11, std430) buffer Boundaries { float boundaries[]; };

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, ivec2(frame.thick_extent.xy)))) {
        return;
    }
    uint at = uint(p.y) * uint(frame.thick_extent.x) + uint(p.x);
    vec4 blended = imageLoad(sheets, p);
    // Less than half a fixed-point step counts as no water. The compute path rounds each sprite, so its sums can differ
    // from these by a few steps.
    float unit = frame.particle.w / UNITS;
    vec2 sums = mix(blended.xy, vec2(0.0), lessThan(blended.xy, vec2(0.5 * unit)));
    float scene = eye_depth(texelFetch(scene_depth, scene_texel((vec2(p) + 0.5) * frame.thick_extent.z), 0).x);
    float found = boundaries[at];
    bool two = keeps_boundary(found, sums.x, sums.y, scene);
    float all = texelFetch(thickness, p, 0).x;
    imageStore(sheets, p, vec4(two ? blended.xyz : vec3(all, 0.0, ONE_SHEET * all), found));
    if (!two) {
        boundaries[at] = EMPTY;
    }
}
