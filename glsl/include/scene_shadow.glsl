// Shadow of the host's scene at a point, from its shadow map or mask. (Thesis Sec. 4.9.4 uses convolution shadow
// maps.)
// Needs frame.glsl, convolution.glsl. Reads: shadow map or mask, its basis and span.

// Source of the shadow. 0: no shadow, 1: a mask of the screen, 2: a shadow map, 3: its Fourier basis.
layout(constant_id = 11) const uint SHADOW = 0;
// Number of terms of the Fourier basis.
layout(constant_id = 13) const int TERMS = 16;

layout(set = 0, binding = 16) uniform sampler2D shadow_map;
layout(set = 0, binding = 18) uniform sampler2D shadow_basis;
layout(set = 0, binding = 19, std140) uniform Span { uvec4 span; };

// Position of a point in the shadow map, 0 to 1, and its depth. Outside the map, where `inside` is false, everything
// is lit.
vec3 shadow_place(vec3 eye, out bool inside) {
    vec4 clip = frame.shadow * vec4(eye + frame.sun_direction.xyz * frame.shadow_map.x, 1.0);
    vec3 at = clip.xyz / clip.w;
    inside = clip.w > 0.0 && all(greaterThanEqual(at, vec3(0.0))) && all(lessThanEqual(at, vec3(1.0)));
    return at;
}

// Visibility of the sun by a convolution shadow map: the truncated Fourier series of the depth comparison, from a
// basis image that is already filtered.
float convolved_at(vec3 eye) {
    bool inside;
    vec3 at = shadow_place(eye, inside);
    float ramp = frame.shadow_filter.w;
    float d = clamp(span_place(at.z, span) - frame.shadow_filter.z, -ramp, 1.0 - 3.0 * ramp);
    // One texel of each page is its border.
    vec2 texel = at.xy * frame.shadow_rect.zw / frame.shadow_basis.z;
    texel = 1.0 + clamp(texel, vec2(0.5), frame.shadow_basis.xy - 0.5);
    vec2 whole = vec2(textureSize(shadow_basis, 0));
    float lit = 0.5;
    for (int page = 0; page < TERMS / 2; ++page) {
        vec2 corner = frame.shadow_basis.w * vec2(page >> 1, page & 1);
        vec4 basis = textureLod(shadow_basis, (texel + corner) / whole, 0.0);
        vec4 wave = waves(page, d);
        vec4 turned = basis.yxwz * wave;
        vec2 weight = (page & 1) == 0 ? frame.shadow_weight[page >> 1].xy : frame.shadow_weight[page >> 1].zw;
        lit += dot(weight, turned.xz - turned.yw);
    }
    return inside && span_holds(span) ? clamp(lit, 0.0, 1.0) : 1.0;
}

// Mean of nine bilinearly filtered depth comparisons, one texel apart (percentage-closer filtering, Reeves et al.
// 1987). Together they read 4x4 texels.
float shadow_map_at(vec3 eye) {
    bool inside;
    vec3 at = shadow_place(eye, inside);
    ivec2 last = ivec2(frame.shadow_rect.zw) - 1;
    vec2 texel = clamp(at.xy, 0.0, 1.0) * frame.shadow_rect.zw - 0.5;
    vec2 base = floor(texel);
    vec2 f = texel - base;
    float lit = 0.0;
    for (int y = -1; y <= 2; ++y) {
        for (int x = -1; x <= 2; ++x) {
            ivec2 t = clamp(ivec2(base) + ivec2(x, y), ivec2(0), last) + ivec2(frame.shadow_rect.xy);
            float wx = x == -1 ? 1.0 - f.x : (x == 2 ? f.x : 1.0);
            float wy = y == -1 ? 1.0 - f.y : (y == 2 ? f.y : 1.0);
            // Nearer to the light means less depth, or more if it is reversed.
            float behind = (at.z - texelFetch(shadow_map, t, 0).x) * frame.shadow_map.y;
            lit += behind > 0.0 ? 0.0 : wx * wy;
        }
    }
    return inside ? lit / 9.0 : 1.0;
}

// Visibility of the sun at a point, considering the host's scene only.
float past_scene(vec3 eye, vec2 pixel) {
    if (SHADOW == 1u) {
        vec2 texel = clamp(pixel / frame.extent.xy, 0.0, 1.0) * frame.shadow_rect.zw;
        ivec2 t = min(ivec2(texel), ivec2(frame.shadow_rect.zw) - 1) + ivec2(frame.shadow_rect.xy);
        return clamp(texelFetch(shadow_map, t, 0).x, 0.0, 1.0);
    }
    if (SHADOW == 3u) {
        return convolved_at(eye);
    }
    return SHADOW == 2u ? shadow_map_at(eye) : 1.0;
}
