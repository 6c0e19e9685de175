// The sun's share of the light on foam. Needs sunlight.glsl.

float sun_share(vec3 position, vec2 pixel) {
    return SHADOW + CAST > 0u ? dot(sunlight(position, pixel), vec3(1.0 / 3.0)) : 1.0;
}
