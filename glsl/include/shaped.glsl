// A host particle after pass `shape`: three words of world position, three each of the shapes (axes.glsl) of its water
// and of its spray, and the sum of its neighbours' weights. Needs nothing.

const uint SHAPED_WORDS = 10u;
