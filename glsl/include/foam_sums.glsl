// Sums of foam in whole steps (the compute path): of all foam, of what is behind the front layer, and of what
// in that layer the sun does not light. The others are mostly none, and added seldom.

// 1: something casts shadows on foam.
layout(constant_id = 1) const uint LIT = 0;
const uint SUMS = 2u + LIT;

// No sum is more: single precision holds all whole numbers up to it. It is 4096 spacings of foam or more, and
// leaves room for what 170 thousand invocations may add at once to one that is not yet full.
const uint FULL = 16777216u;
