// Sums of the sun's map of whitewater: the thickness in fixed-point steps, that times the position along the light in
// whole texels, and that times the position again. The sums are exact in any order: the fourth word holds the carries
// of the two products, of the last one in its lower 22 bits.

const uint WORDS = 4u;
// Fixed-point steps per thickness of 1.
const float STEPS = 65536.0;
// Nothing is added beyond this, so that any number of particles may lie on one spot.
const uint FULL = 1u << 28;
// Value in the fourth word of a carry of the second.
const uint CARRY = 1u << 22;
