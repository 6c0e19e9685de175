// A host particle after pass `shape`: three words of world position, three each of the shapes (axes.glsl) of its water
// and of its spray, and the sum of its neighbours' weights, or CROWDED. Needs nothing.

const uint SHAPED_WORDS = 10u;
// Marks spray that does not depend on the number of its neighbours.
const float CROWDED = 64.0;
