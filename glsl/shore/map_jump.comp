#version 460
// Pass `map`, one step of jump flooding (Rong, Tan 2006): each texel takes the nearest of nine seeds (points of the
// shore line), its own and those of the eight texels that are `jump` texels away along rows, columns and diagonals.
// Reads: one buffer of seeds, within the window. Writes: the other.

#include "shore_map.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, std430) readonly buffer Before { uint before[]; };
layout(set = 0, binding = 1, std430) writeonly buffer After { uint after[]; };

void main() {
    ivec2 texel;
    if (!texel_of(gl_GlobalInvocationID.xy, texel)) {
        return;
    }
    vec2 own = vec2(texel) + 0.5;
    float nearest = 1.0e30;
    uint best = NONE;
    ivec2 end = push.window.xy + push.window.zw;
    for (int i = 0; i < 9; ++i) {
        ivec2 at = texel + push.jump * (ivec2(i % 3, i / 3) - 1);
        bool inside = all(greaterThanEqual(at, push.window.xy)) && all(lessThan(at, end));
        uint seed = inside ? before[at.y * push.size + at.x] : NONE;
        vec2 to = place_of(seed) - own;
        float square = seed == NONE ? 1.0e29 : dot(to, to);
        // If two seeds are equally near, the one with the lower value wins, so that the order of the nine texels does
        // not matter.
        bool better = square < nearest || square == nearest && seed < best;
        best = better ? seed : best;
        nearest = better ? square : nearest;
    }
    after[texel.y * push.size + texel.x] = best;
}
