#version 460
// Pass `gaps`, third part: lists the airs of each cell of 8x8 pixels. An air is a run of depth slices without water,
// at least NARROWEST long, that has water in front of it and behind it. Not in the thesis.
// Reads: nearest, marks. Writes: airs of the cells.

#include "frame.glsl"
#include "gaps.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, std430) readonly buffer Cells { uint cells[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Airs { uint airs[]; };

layout(push_constant, std430) uniform Push {
    int columns;
    int rows;
} push;

// The first slice, from slice `from` on, that holds water (with `marked`) or holds none (without); SLICES if no slice
// does.
int next(uint cell, int from, bool marked) {
    uint all = uint(push.columns * push.rows);
    for (int word = from >> 5; word < WORDS; ++word) {
        uint bits = cells[uint(1 + word) * all + cell];
        bits = (marked ? bits : ~bits) & (word == from >> 5 ? ~0u << (from & 31) : ~0u);
        if (bits != 0u) {
            return 32 * word + findLSB(bits);
        }
    }
    return SLICES;
}

// The first air from slice `from` on: its first slice, and the first slice of the water behind it; SLICES if there is
// no such slice.
ivec2 next_air(uint cell, int from) {
    ivec2 air = ivec2(from);
    do {
        air.x = next(cell, air.y, false);
        air.y = next(cell, air.x, true);
    } while (air.y < SLICES && air.y - air.x < NARROWEST);
    return air;
}

void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (p.x >= push.columns || p.y >= push.rows) {
        return;
    }
    uint cell = uint(p.y * push.columns + p.x);
    uvec3 words = uvec3(0u);
    ivec2 air = next_air(cell, 0);
    for (int i = 0; i <= AIRS && air.x > 0; ++i) {
        bool last = i == AIRS || air.y == SLICES;
        uint bytes = uint(min(air.x, SLICES - 1) | (last ? 0 : air.y << 8)) << (16 * (i & 1));
        words |= i < 2 ? uvec3(bytes, 0u, 0u) : i < 4 ? uvec3(0u, bytes, 0u) : uvec3(0u, 0u, bytes);
        air = last ? ivec2(0) : next_air(cell, air.y);
    }
    uint at = AIR_WORDS * cell;
    airs[at] = cells[cell];
    airs[at + 1u] = words.x;
    airs[at + 2u] = words.y;
    airs[at + 3u] = words.z;
}
