// The foam that a pixel shows, of pass `foam`. Needs frame.glsl. Reads: foam depth and thickness.

// 1: there may be foam; else it is not read.
layout(constant_id = 9) const uint FOAM = 0;

layout(set = 0, binding = 4) uniform sampler2D foam_depth;
layout(set = 0, binding = 9) uniform sampler2D foam_thickness;

// Depth of the frontmost foam where it hides half of what is behind it or more, else EMPTY: a veil moves
// as what shows through.
float shown_foam(ivec2 pixel) {
    if (FOAM == 0u) {
        return EMPTY;
    }
    // As `composite` has it.
    vec2 h = (vec2(pixel) + 0.5) / frame.thick_extent.z - 0.5;
    ivec2 base = ivec2(floor(h));
    vec2 f = h - vec2(base);
    ivec2 last = ivec2(frame.thick_extent.xy) - 1;
    float t = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        vec2 w = mix(1.0 - f, f, vec2(side));
        t += w.x * w.y * texelFetch(foam_thickness, clamp(base + side, ivec2(0), last), 0).x;
    }
    bool hides = frame.foam.x * t * smoothstep(0.0, frame.foam_noise.w, t) >= 0.69314718;
    return hides ? texelFetch(foam_depth, pixel, 0).x : EMPTY;
}
