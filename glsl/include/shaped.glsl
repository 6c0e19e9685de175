// A host particle after pass `shape`: three words of world position, three each of the shapes (axes.glsl) of its water
// and of its spray, and the sum of its neighbours' weights; up to CROWDED in films, CROWDED
// outside of the grid. Needs nothing.

const uint SHAPED_WORDS = 10u;
// Stands for enough neighbours. With a reach of 4, sums inside water exceed it.
const float CROWDED = 64.0;
