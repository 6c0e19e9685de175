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

// Normalised depth: 0 at the nearest texel of the map, 1 - 4 r at the farthest. r (`shadow_filter.w`) is half the
// width of the ramp from light to shadow by which the Fourier series approximates the step of the depth comparison.
// Empty texels are placed at 1 - 2 r (`texel_place`), and the depths of shaded points are clamped to the range from
// -r to 1 - 3 r. The series is periodic, with further ramps of this width around differences of -1 and 1 between
// point and texel. With these margins no difference is nearer than r to -1 or 1.
float span_place(float depth, uvec4 span) {
    vec2 ends = vec2(along_light(uintBitsToFloat(span.x)), along_light(uintBitsToFloat(~span.y)));
    ends = frame.shadow_map.y > 0.0 ? ends : ends.yx;
    // A span below the precision of depths counts as none.
    float least = 1.0e-5 * max(abs(ends.x), abs(ends.y)) + 1.0e-30;
    return (along_light(depth) - ends.x) / max(ends.y - ends.x, least) * (1.0 - 4.0 * frame.shadow_filter.w);
}

// Returns the normalised depth of a texel with this depth. That of an empty texel is greater than that of every other
// texel and shaded point.
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
