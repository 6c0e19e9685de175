// Depth of the smoothed water surface at a pixel, for passes that need nothing else of it. Needs frame.glsl,
// level.glsl.
// Reads: smoothed.

layout(set = 0, binding = 5) uniform sampler2D smoothed;

// Smoothed depth of the water surface at a pixel. It is the bilinear mean of the four texels around the pixel; texels
// whose depth is far from the pixel's own unsmoothed depth `front` lie on another surface and do not count.
float smoothed_at(vec2 pixel, float front) {
    float fade;
    uint finer = shown_level(nearness(front, ray_slope(pixel, frame.slope)), fade);
    Level level = levels.level[fade < 0.5 ? finer : finer + 1u];
    vec2 h = pixel / level.texel.z - 0.5;
    ivec2 base = ivec2(floor(h));
    vec2 f = h - vec2(base);
    vec4 w = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    float sum = 0.0;
    float all = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), level.rect.zw - 1);
        float off = texelFetch(smoothed, level.rect.xy + texel, 0).x - front;
        bool own = abs(off) <= frame.surface.w;
        sum += own ? w[i] * off : 0.0;
        all += own ? w[i] : 0.0;
    }
    return all > 0.0 ? front + sum / all : front;
}
