// Share of the sunlight that is blocked on its way to foam. The blocked share is stored, not the visibility, so that
// texels without foam hold 0 and filtering across the foam's edge does not darken it. Needs sunlight.glsl.

float sun_lost(vec3 position, vec2 pixel) {
    return SHADOW + CAST > 0u ? 1.0 - dot(sunlight(position, pixel), vec3(1.0 / 3.0)) : 0.0;
}
