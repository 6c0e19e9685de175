// A host particle after pass `shape`: three words of world position, three of shape (axes.glsl). Needs nothing.

const uint SHAPED_WORDS = 6u;
