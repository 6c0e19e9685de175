// Heights of the map over the water. Needs shore_map.glsl. Reads: heights.

// 0: depths of the rasterizer, 1: the host's image.
layout(constant_id = 0) const uint OWN = 0;

layout(set = 0, binding = 0) uniform sampler2D heights;

// Height above the water at the centre of a texel, in scene units; clamped at the map's edge.
float height_at(ivec2 texel) {
    texel = clamp(texel, ivec2(0), ivec2(push.size - 1));
    if (OWN == 0u) {
        // Scale and offset of the depths.
        return texelFetch(heights, texel, 0).x * push.part.x + push.part.y;
    }
    vec2 place = (vec2(texel) + 0.5) / float(push.size) * push.part.zw - 0.5;
    ivec2 base = ivec2(floor(place));
    vec2 f = place - vec2(base);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), ivec2(push.part.zw) - 1) + ivec2(push.part.xy);
        float weight = ((i & 1) == 0 ? 1.0 - f.x : f.x) * (i < 2 ? 1.0 - f.y : f.y);
        // A NaN with weight 0 must not count.
        sum += weight > 0.0 ? weight * texelFetch(heights, at, 0).x : 0.0;
    }
    // NaN counts as no land.
    return abs(sum) < 1.0e18 ? sum - push.level : -1.0e3;
}
