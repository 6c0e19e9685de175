// A particle of the host's as pass `shape` leaves it: three words of its world position, three of its shape (axes.glsl). Needs
// nothing.

const uint SHAPED_WORDS = 6u;
