// Three sums that each texel of the sun's map of whitewater accumulates: the thickness in fixed-point steps, the
// thickness times the position along the light in whole texels, and the thickness times the square of that position.
// The sums are exact in any order. The fourth word holds the carries of the second and third sum; those of the third
// are in its lower 22 bits.

const uint WORDS = 4u;
// Fixed-point steps per thickness of 1.
const float STEPS = 65536.0;
// Nothing more is added to a texel whose sum of thickness exceeds this, so no sum overflows if many particles lie on
// one spot.
const uint FULL = 1u << 28;
// Value in the fourth word of one carry of the second sum.
const uint CARRY = 1u << 22;
