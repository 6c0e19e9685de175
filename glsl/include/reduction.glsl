// The plan (iterations and step size) of one texel of the reduced depth, for any level of the smoothing (thesis Sec.
// 3.1, Eq. 3.1 with the half of its viewport; Listing A.12).
// Needs frame.glsl, plan.glsl, level.glsl and the constant RULE.

// Number of iterations before the cap, and the step size relative to the largest, for a surface at depth z; `c` is
// the world size of a pixel per depth.
float iterations(float z, vec2 slope, vec2 c, out float share) {
    float width = c.x * z; // width of the pixel in the world
    if (RULE == RULE_CONSTANT_WIDTH) {
        float sigma = frame.smoothing.x / width;
        float count = sigma > 0.0 ? ceil(foreshortened(slope) * sigma * sigma) + MORE : 0.0;
        share = sigma * sigma / (2.0 * max(count, 1.0)) / MOST_KAPPA;
        return count;
    }
    float r = frame.particle.x;
    share = min(1.0, 0.25 * width / (SOURCE_STEP * r));
    return RULE == RULE_FIXED ? frame.smoothing.w : floor(SOURCE_RADIUS * r / width) + 1.0;
}

// Whether a level of the smoothing shows at a point, or would show if the point needed a quarter more or a fifth
// fewer iterations. `near` is the number of iterations that the point needs at level 0, divided by a quarter of the
// iteration limit. The margin puts the edges of a level's smoothed regions where the level does not show.
bool wanted_at(float near, uint level, bool finest, bool coarsest) {
    float here = near * exp2(-2.0 * float(level)); // in its own iterations
    return (finest || here >= 0.2) && (coarsest || here <= 2.5);
}

// The packed plan of the smoothing (number of iterations and step size) for a texel of a level of resolution (0 to
// 3). It is 0 without water, or where the picture does not show the level. `finest` and `coarsest` tell whether the
// level is the finest or coarsest of its layer of water.
uint plan_pixel(float z, vec2 pixel, Level at, uint level, bool finest, bool coarsest) {
    vec2 slope = ray_slope(pixel + 0.5, at.slope);
    if (z >= EMPTY || !wanted_at(nearness(z, slope), level, finest, coarsest)) {
        return 0u;
    }
    float share;
    float count = iterations(z, slope, at.texel.xy, share);
    return plan_pack(uint(min(count, frame.smoothing.z)), share);
}
