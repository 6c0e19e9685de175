// A host particle after pass `shape`: three words of world position, three each of the shapes (axes.glsl) of its
// water and of its spray, and the sum of its neighbours' weights. In films the sum is raised, up to CROWDED;
// particles outside of the grid get CROWDED. Needs nothing.

const uint SHAPED_WORDS = 10u;
// A sum that stands for enough neighbours. With a reach of 4, real sums inside water exceed it.
const float CROWDED = 64.0;
