// Constants of pass `gaps`, which finds the air between two layers of water. It divides the depth behind each screen
// cell into slices and marks those near particles' centres; unmarked slices are air. Lengths are in particle
// spacings. Neighbouring particles in water are one spacing apart, in thin water one and a half; a gap of two and a
// half is air.

// Thickness of a slice. It is small, so that the boundary (the depth that separates two layers) moves little if the
// air becomes one slice wider or narrower.
const float SLICE = 0.125;
// Slices of a cell, 32 in a word.
const int WORDS = 8;
const int SLICES = 32 * WORDS;
// Largest number of airs (gaps along the depth of a cell) that are kept.
const int AIRS = 5;
// Words that hold a cell's airs: the cell's nearest depth; then a byte for the first slice of each air and a byte for
// the first slice of the water behind it; then a byte for the slice behind the last water, 255 if that water reaches
// the last slice.
const uint AIR_WORDS = 4u;
// Distance before and behind a sphere's centre within which it marks slices.
const float REACH = 0.8;
// Distance beside a sphere's silhouette within which it marks cells, measured to a cell's centre. So a cell counts
// every sphere whose centre is within a spacing of its own centre. Otherwise cells much smaller than the spheres
// would find air between the spheres of one body of water.
const float BESIDE = 0.35;
// Slices that water behind an air fills: up to the first number it is a drop, from the second on a body of water. One
// sphere marks 13 or 14.
const vec2 BODY = vec2(14.0, 22.0);
// Spheres with a radius below this, in drawn radii, are flying drops and mark nothing: they form no layer, and many
// of them would fill the air between layers.
const float DROP = 0.6;
