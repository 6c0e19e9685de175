// First and last pixel of the picture whose centres may lie in a ball. Needs view.glsl.
ivec4 pixels_of(vec3 centre, float radius) {
    vec2 middle = (centre.xy / centre.z - view.slope.zw) / view.slope.xy;
    // The margin covers rounding: it may add pixels, but never drops one.
    vec2 reach = radius / (centre.z * view.lens.xy) + 1.0e-3;
    vec2 first = clamp(ceil(middle - reach - 0.5), vec2(0.0), vec2(view.extent.xy));
    vec2 last = clamp(floor(middle + reach - 0.5), vec2(-1.0), vec2(view.extent.xy) - 1.0);
    return ivec4(first, last);
}
