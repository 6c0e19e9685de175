// Fixed-point addends of sums, so that sums are exact in any order. Fractions of a step are rounded up or down
// stochastically, which keeps the mean. Rounding to nearest would lose everything below half a step, and distant
// sprites, widened to a pixel, are that thin. The random number depends on particle and texel, not on time: nothing
// flickers. Needs random.glsl.

// Random bits of a particle, from its id and a number.
uint chance_of(uint id, uint number) {
    return pcg(id + pcg(number + pcg(0x57E9u)));
}

// Number r, 0 to 1, that is added to a value in steps before it is rounded down, so that a fraction of a step of at
// least 1 - r is rounded up. r is distributed evenly over texels (R2 sequence, Roberts 2018, in 32 bits), so that the
// sum over a sprite is nearly exact.
float rounding_up(uint chance, ivec2 texel) {
    uvec2 at = uvec2(texel) * uvec2(0xC13FA9A9u, 0x91E10DA5u);
    return float((chance + at.x + at.y) >> 8) * (1.0 / 16777216.0);
}
