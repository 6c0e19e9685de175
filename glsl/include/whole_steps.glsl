// What fragments add to a sum as whole steps, so that sums are exact in any order: rounded up or down by chance, with the
// chance that keeps the mean. To the nearest, all that is less than half a step would be lost: what is far away, for a
// sprite that is widened to a pixel is thin. By chance of the particle and the texel, not of the time: it does not
// flicker. Needs random.glsl.

// Bits of a particle by what it is known by.
uint chance_of(uint id, uint number) {
    return pcg(id + pcg(number + pcg(0x57E9u)));
}

// From what on a part of a step is a whole one, in a texel: 1 - that of 0 to 1. From texel to texel as even as can be
// (the R2 sequence, Roberts 2018, in 32 bits), so that those of one sprite together are nearly what they should be.
float rounding_up(uint chance, ivec2 texel) {
    uvec2 at = uvec2(texel) * uvec2(0xC13FA9A9u, 0x91E10DA5u);
    return float((chance + at.x + at.y) >> 8) * (1.0 / 16777216.0);
}
