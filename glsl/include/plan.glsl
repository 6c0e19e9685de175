// The plan of one texel of the smoothing, in 32 bits: its number of iterations (low 9 bits) and its step size (23
// bits). It is made before the first iteration (the thesis decides anew in each iteration, Listing A.12). The step
// size is stored relative to the largest possible one: kappa = 1/4 for the rule ConstantWidth, epsilon = 0.053 r for
// the rules Source and Fixed, with the particles' drawn radius r.

const uint RULE_SOURCE = 0u;
const uint RULE_CONSTANT_WIDTH = 1u;
const uint RULE_FIXED = 2u;

const float SOURCE_STEP = 0.053;  // in units of r (thesis' demo: 0.05 at particle size 0.9375)
const float SOURCE_RADIUS = 4.8;  // r_w in units of r
const float MOST_KAPPA = 0.25;    // stability limit of the explicit step
const float MORE = 2.0;           // added iterations: at the stability limit a checkerboard never decays

uint plan_count(uint plan) {
    return plan & 511u;
}

float plan_step(uint plan) {
    return float(plan >> 9) * (1.0 / 8388607.0);
}

uint plan_pack(uint count, float share) {
    return count | (uint(clamp(share, 0.0, 1.0) * 8388607.0 + 0.5) << 9);
}
