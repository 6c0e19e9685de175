#version 460
// Pass `back`, first part: initial depth of the back layer (the farther of two layers of water) in its first level.
// In pixels with only one layer it is the depth of that layer, but only in tiles that have a boundary between two
// layers in or around them, where the smoothing of the back layer needs neighbours. Elsewhere it is EMPTY. Not in the
// thesis.
// Reads: boundaries, levels, depth. Writes: back.

#include "frame.glsl"
#include "level.glsl"
#include "sheets.glsl"

layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 3, r32f) uniform writeonly image2D back;

shared uint wanted;

// Whether there is a boundary in the tile or within a tile's width around it; from farther away smoothing has next to
// no effect. One pixel in each block of 8x8 is tested, because boundaries come from airs of cells of that size.
bool boundary_near(ivec2 corner, int edge) {
    ivec2 extent = ivec2(frame.extent.xy);
    ivec2 first = max((corner - 16) * edge, ivec2(0)) >> 3;
    ivec2 last = (min((corner + 32) * edge, extent) - 1) >> 3;
    for (int y = first.y + int(gl_LocalInvocationID.y); y <= last.y; y += 16) {
        for (int x = first.x + int(gl_LocalInvocationID.x); x <= last.x; x += 16) {
            if (boundary_at(min(8 * ivec2(x, y) + 4, extent - 1)) < EMPTY) {
                return true;
            }
        }
    }
    return false;
}

void main() {
    Level level = levels.level[BACK];
    int edge = int(level.texel.z);
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 16;
    if (any(greaterThanEqual(corner, level.rect.zw))) {
        return;
    }
    if (gl_LocalInvocationIndex == 0u) {
        wanted = 0u;
    }
    barrier();
    if (boundary_near(corner, edge)) {
        wanted = 1u;
    }
    barrier();
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(p, level.rect.zw))) {
        ivec2 pixel = min(p * edge + edge / 2, ivec2(frame.extent.xy) - 1);
        bool one = wanted == 1u && boundary_at(pixel) >= EMPTY;
        imageStore(back, p, vec4(one ? texelFetch(depth, pixel, 0).x : EMPTY));
    }
}
