// One pixel of the reduced depth and its plan, for any level of the smoothing (thesis Sec. 3.1, Eq. 3.1
// with the half of its viewport; Listing A.12).
// Needs frame.glsl, plan.glsl and the constant RULE.

// Iterations before the cap, and the step's share of the largest, of a surface at depth z; c: world
// size of a pixel per depth.
float iterations(float z, vec2 slope, vec2 c, out float share) {
    float width = c.x * z; // of the pixel in the world
    if (RULE == RULE_CONSTANT_WIDTH) {
        float sigma = frame.smoothing.x / width;
        // Off the axis a pixel sees the surface foreshortened, flat pixels are nearer to each
        // other in y: more, smaller steps keep it stable.
        float shape = c.x / c.y;
        float spread = 1.0 + slope.x * slope.x + (1.0 + slope.y * slope.y) * shape * shape;
        float count = sigma > 0.0 ? ceil(spread * sigma * sigma) + MORE : 0.0;
        share = sigma * sigma / (2.0 * max(count, 1.0)) / MOST_KAPPA;
        return count;
    }
    float r = frame.particle.x;
    share = min(1.0, 0.25 * width / (SOURCE_STEP * r));
    return RULE == RULE_FIXED ? frame.smoothing.w : floor(SOURCE_RADIUS * r / width) + 1.0;
}

// The plan of a reduced pixel: 0 without water.
uint plan_pixel(float z, vec2 slope, vec2 c, out float count) {
    count = 0.0;
    if (z >= EMPTY) {
        return 0u;
    }
    float share;
    count = iterations(z, slope, c, share);
    return plan_pack(uint(min(count, frame.smoothing.z)), share);
}
