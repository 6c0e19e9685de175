// A host particle after pass `shape`: three words of world position, three each of the shapes (axes.glsl) of its water
// and of its spray, and the sum of its neighbours' weights; CROWDED in films and outside of the
// grid. Needs nothing.

const uint SHAPED_WORDS = 10u;
// More than most sums of weights: nothing depends on the number of neighbours.
const float CROWDED = 64.0;
