// The arithmetic of one smoothing iteration in one pixel (by curvature.glsl), shared by every form
// of the pass `smooth`.
// Needs frame.glsl, plan.glsl, level.glsl, curvature.glsl and the constant RULE.

// `pixel` counts from the corner of its level.
float smooth_pixel(Stencil s, Level level, ivec2 pixel, uint planned) {
    float share = plan_step(planned);
    if (RULE == RULE_CONSTANT_WIDTH) {
        vec2 slope = ray_slope(vec2(pixel) + 0.5, level.slope);
        return flow_step(s, slope, level.slope.xy, frame.smoothing.y, MOST_KAPPA * share);
    }
    float epsilon = SOURCE_STEP * frame.particle.x * share;
    return source_step(s, level.texel.xy, frame.smoothing.y, epsilon);
}
