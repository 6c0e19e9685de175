// What of the sun's light does not come to foam: where there is no foam it is 0 as where all comes, so that a filter between
// foam and none does not darken it. Needs sunlight.glsl.

float sun_lost(vec3 position, vec2 pixel) {
    return SHADOW + CAST > 0u ? 1.0 - dot(sunlight(position, pixel), vec3(1.0 / 3.0)) : 0.0;
}
