// Sums of foam in whole steps (the compute path).

// No sum is more: single precision holds all whole numbers up to it. It is 4096 spacings of foam or more, and
// leaves room for what 170 thousand invocations may add at once to one that is not yet full.
const uint FULL = 16777216u;
