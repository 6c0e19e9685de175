// A host particle after pass `shape`: three words of world position, three each of the shapes (axes.glsl) of its water
// and of its spray. Needs nothing.

const uint SHAPED_WORDS = 9u;
