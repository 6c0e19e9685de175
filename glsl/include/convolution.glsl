// Normalised depths of a shadow map, between its nearest and farthest texel, and the Fourier basis of comparisons with
// them (Annen et al. 2007, Sec. 3). Needs frame.glsl.

const float TWO_PI = 6.283185307;
// No texel: what the span begins with.
const uint NO_SPAN = 0xffffffffu;

// Nothing is there: as far as depth goes, or not a number.
bool is_open(float depth) {
    return frame.shadow_map.y > 0.0 ? !(depth < 1.0) : !(depth > 0.0);
}

// Grows evenly away from the light.
float along_light(float depth) {
    return (frame.shadow_linear.x * depth + frame.shadow_linear.y)
        / (frame.shadow_linear.z * depth + frame.shadow_linear.w);
}

// The span holds the bits of the least depth and, inverted, those of the greatest.
bool span_holds(uvec4 span) {
    return span.x != NO_SPAN;
}

// 0 at the nearest texel, 1 - 4 ramps at the farthest: as the series turns back to where it began, both
// ends keep the room that it takes to rise.
float span_place(float depth, uvec4 span) {
    vec2 ends = vec2(along_light(uintBitsToFloat(span.x)), along_light(uintBitsToFloat(~span.y)));
    ends = frame.shadow_map.y > 0.0 ? ends : ends.yx;
    // Less than depths are exact to is no span.
    float least = 1.0e-5 * max(abs(ends.x), abs(ends.y)) + 1.0e-30;
    return (along_light(depth) - ends.x) / max(ends.y - ends.x, least) * (1.0 - 4.0 * frame.shadow_filter.w);
}

// Place of a texel; an open one is behind all.
float texel_place(float depth, uvec4 span) {
    return is_open(depth) ? 1.0 - 2.0 * frame.shadow_filter.w : span_place(depth, span);
}

// cos c_k t, sin c_k t of a page's two terms, c_k = (2k - 1) pi. Whole turns are left out: shaders know
// sines but about 0.
vec4 waves(int page, float t) {
    vec2 turns = (vec2(0.5, 1.5) + 2.0 * float(page)) * t;
    vec2 angle = TWO_PI * (turns - round(turns));
    return vec4(cos(angle.x), sin(angle.x), cos(angle.y), sin(angle.y));
}
