#version 460
// Pass `map`, seeds: for each texel, the nearest point at which the shore line crosses a segment from the texel's
// centre to one of the centres of its four neighbours.
// Reads: heights. Writes: seeds.

#include "shore_map.glsl"
#include "shore_height.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 1, std430) writeonly buffer Seeds { uint seeds[]; };

void main() {
    ivec2 texel;
    if (!texel_of(gl_GlobalInvocationID.xy, texel)) {
        return;
    }
    float own = height_at(texel);
    float nearest = 2.0;
    uint seed = NONE;
    for (int i = 0; i < 4; ++i) {
        ivec2 to = (i < 2 ? ivec2(1, 0) : ivec2(0, 1)) * (1 - 2 * (i & 1));
        float other = height_at(texel + to);
        // Positive heights are land.
        if ((own > 0.0) != (other > 0.0)) {
            float part = own / (own - other);
            vec2 place = vec2(texel) + 0.5 + part * vec2(to);
            if (part < nearest) {
                nearest = part;
                uvec2 at = uvec2(clamp(place * 16.0 + 0.5, vec2(0.0), vec2(65535.0)));
                seed = at.x | at.y << 16;
            }
        }
    }
    seeds[texel.y * push.size + texel.x] = seed;
}
