// Share of the sunlight on foam that is blocked; 0 where there is no foam, so that filtering between foam and none does
// not darken it. Needs sunlight.glsl.

float sun_lost(vec3 position, vec2 pixel) {
    return SHADOW + CAST > 0u ? 1.0 - dot(sunlight(position, pixel), vec3(1.0 / 3.0)) : 0.0;
}
