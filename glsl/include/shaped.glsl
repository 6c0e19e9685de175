// A host particle after pass `shape`: three words of world position, three each of the shapes (axes.glsl) of its
// water and of its spray, and the sum of its neighbours' weights. In films the sum is raised, up to CROWDED;
// particles outside of the grid get CROWDED. Needs nothing.

const uint SHAPED_WORDS = 10u;
// Value of the sum of neighbours' weights that stands for enough neighbours. Inside water the sum is 32 with a reach
// of 2.5 spacings, and more than this value with 4.
const float CROWDED = 64.0;
