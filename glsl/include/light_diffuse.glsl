// Sums of the sun's map of whitewater: the thickness in fixed-point steps, that times the position along the light in
// whole texels, and that times the position again. The sums are exact in any order: the fourth word holds the carries
// of the two products, of the last one in its lower 22 bits.

const uint WORDS = 4u;
// Steps of a thickness of 1.
const float STEPS = 65536.0;
// From here on nothing is added: no number of particles on one spot is too many.
const uint FULL = 1u << 28;
// What the second word carries, in the fourth.
const uint CARRY = 1u << 22;
