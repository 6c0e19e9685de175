#version 460
// Pass `motion`, first part, not in the sources: finds the nearest and the farthest visible surface of each texel's
// pixels, and clears the texel's sums.
// Reads: depth, foam depth and thickness, scene depth. Writes: fronts, sums.

#include "frame.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(push_constant, std430) uniform Push { uint level; } push;

#include "motion.glsl"
#include "surface_foam_texels.glsl"
#include "shown_foam.glsl"

layout(set = 0, binding = 3) uniform sampler2D depth;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, texel_extent()))) {
        return;
    }
    ivec2 last = min((texel + 1) * texel_edge(), ivec2(frame.extent.xy));
    float nearest = EMPTY;
    float farthest = 0.0;
    for (int y = texel.y * texel_edge(); y < last.y; ++y) {
        for (int x = texel.x * texel_edge(); x < last.x; ++x) {
            float z = min(texelFetch(depth, ivec2(x, y), 0).x, shown_foam(vec2(x, y) + 0.5));
            nearest = min(nearest, z);
            farthest = z < EMPTY ? max(farthest, z) : farthest;
        }
    }
    // A second surface must be 3 drawn radii behind the first: otherwise particles near the first would also be near
    // the second.
    bool other = nearest < EMPTY && farthest - nearest > 3.0 * frame.particle.x;
    uint at = texel_index(texel);
    fronts[at] = vec2(nearest, other ? farthest : EMPTY);
    for (uint surface = 0u; surface < surfaces(); ++surface) {
        for (uint i = 0u; i < 4u; ++i) {
            sums[sum_index(at, surface, i)] = 0u;
            sums[sum_index(at, surface, i) + 1u] = 0u;
        }
    }
}
