// Convolution shadow maps: the depths of a shadow map, normalised to the range between its nearest and farthest
// texel, and the Fourier basis in which comparisons with them are expanded (Annen et al. 2007, Sec. 3). Needs
// frame.glsl.

const float TWO_PI = 6.283185307;
// No texel: the initial value of the span.
const uint NO_SPAN = 0xffffffffu;

// Whether a texel is empty: at the far plane, or NaN.
bool is_open(float depth) {
    return frame.shadow_map.y > 0.0 ? !(depth < 1.0) : !(depth > 0.0);
}

// A depth that grows linearly away from the light.
float along_light(float depth) {
    return (frame.shadow_linear.x * depth + frame.shadow_linear.y)
        / (frame.shadow_linear.z * depth + frame.shadow_linear.w);
}

// The span of the map's depths stores the bits of the least depth in x, and the inverted bits of the greatest in y.
bool span_holds(uvec4 span) {
    return span.x != NO_SPAN;
}

// Normalised depth: 0 at the nearest texel, 1 - 4 r at the farthest, with the width r of the comparison's ramp
// (`shadow_filter.w`). The Fourier series is periodic, so both ends of the range keep a margin for the ramp.
float span_place(float depth, uvec4 span) {
    vec2 ends = vec2(along_light(uintBitsToFloat(span.x)), along_light(uintBitsToFloat(~span.y)));
    ends = frame.shadow_map.y > 0.0 ? ends : ends.yx;
    // A span below the precision of depths counts as none.
    float least = 1.0e-5 * max(abs(ends.x), abs(ends.y)) + 1.0e-30;
    return (along_light(depth) - ends.x) / max(ends.y - ends.x, least) * (1.0 - 4.0 * frame.shadow_filter.w);
}

// Position of a texel in the span; an empty one is behind all.
float texel_place(float depth, uvec4 span) {
    return is_open(depth) ? 1.0 - 2.0 * frame.shadow_filter.w : span_place(depth, span);
}

// cos c_k t and sin c_k t, with c_k = (2k - 1) pi, for the two terms k of a page (a part of the basis image). Whole
// turns are removed from the angles, because sines in shaders are precise only near 0.
vec4 waves(int page, float t) {
    vec2 turns = (vec2(0.5, 1.5) + 2.0 * float(page)) * t;
    vec2 angle = TWO_PI * (turns - round(turns));
    return vec4(cos(angle.x), sin(angle.x), cos(angle.y), sin(angle.y));
}
