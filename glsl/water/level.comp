#version 460
// Pass `level`: chooses the resolution of the smoothing. Where more of the picture than OVER would
// pass the cap, it goes a level coarser (a quarter of the iterations); before that the coarser
// level fades in. By the view, not by time: a frame looks the same however it was come to.
// The back sheet, seen through the front one alone, takes the next coarser level. Not in the source, which
// caps.
// Reads: how many pixels pass the cap. Writes: levels, the dispatch of the coarser reduction.

#include "frame.glsl"

layout(local_size_x = 1) in;

struct Level {
    ivec4 rect;
    vec4 slope;
    vec4 texel;
};

layout(set = 0, binding = 1, std430) readonly buffer Over { uint over[4]; };
layout(set = 0, binding = 2, std430) writeonly buffer Levels {
    Level level[3];
    ivec4 atlas;
} levels;
layout(set = 0, binding = 3, std430) writeonly buffer Arguments { uvec4 arguments; };

layout(push_constant, std430) uniform Push {
    ivec4 atlas;
    uint coarsening; // most levels coarser
    int back;        // first column of the back sheet's level; the images' width: there is none
} push;

// Share of the picture's pixels that may be capped: less is hardly seen, and one drop before the
// lens shall not cost the whole picture its resolution.
const float OVER = 1.0 / 16.0;
// Fades shorter than this are not worth a second smoothing.
const float LEAST = 1.0 / 64.0;

void main() {
    float pixels = frame.extent.z * frame.extent.w;
    float wanted = 0.0;
    for (uint k = 0u; k < push.coarsening; ++k) {
        uint capped = 0u;
        for (uint j = k; j < 4u; ++j) {
            capped += over[j];
        }
        wanted += smoothstep(0.25 * OVER, OVER, float(capped) / pixels);
    }
    uint fine = uint(wanted + LEAST);
    float fade = wanted - float(fine);
    fade = fade > LEAST ? fade : 0.0;

    uvec3 groups = uvec3(0u, 0u, 2u);
    for (uint i = 0u; i < 3u; ++i) {
        // A level lies in the first half of the images or in the second, by its parity.
        uint coarser = i < 2u && (fine & 1u) == i ? fine : fine + 1u;
        float scale = float(1u << coarser);
        int edge = int(frame.thick_extent.w * scale);
        ivec2 size = (ivec2(frame.extent.xy) + edge - 1) / edge;
        float weight = coarser == fine ? 1.0 - fade : fade;
        if (i == 2u) {
            weight = push.back < push.atlas.x ? 1.0 : 0.0;
        }
        levels.level[i].rect = ivec4(i == 2u ? push.back : 0, i == 0u ? 0 : push.atlas.w, size);
        levels.level[i].slope = frame.reduced_slope * vec4(scale, scale, 1.0, 1.0);
        levels.level[i].texel = vec4(frame.texel.zw * scale, frame.thick_extent.w * scale, weight);
        if (i < 2u && coarser > 0u && weight > 0.0) {
            groups.xy = max(groups.xy, (uvec2(size) + 15u) / 16u);
        }
    }
    levels.atlas = push.atlas;
    arguments = uvec4(groups, 0u);
}
