// Constants of pass `gaps`, which finds the air between two layers of water. It divides the depth behind each screen
// cell into slices and marks those near particles' centres; a wide run of unmarked slices is air. Lengths are in
// particle spacings. Neighbouring particles in water are one spacing apart, in thin water one and a half. Where their
// places are random, as in many MPM and FLIP caches, two and a half occur inside water.

// Thickness of a depth slice, in particle spacings. It is small, so that the boundary (the depth that separates two
// layers of water) moves little if the air between them becomes one slice wider or narrower.
const float SLICE = 0.125;
// Slices of a cell, 32 in a word.
const int WORDS = 8;
const int SLICES = 32 * WORDS;
// Largest number of airs (gaps along the depth of a cell) that are kept.
const int AIRS = 5;
// Number of words that hold a cell's airs (gaps in depth between layers of water). The first word is the cell's
// nearest depth. Then each air has two bytes: its first slice, and the first slice of the water behind it. A last
// byte is the first slice behind the last water, or 255 if that water reaches the last slice.
const uint AIR_WORDS = 4u;
// Distance before and behind a sphere's centre within which it marks slices.
const float REACH = 0.8;
// Least number of slices of an air. A narrower run of unmarked slices counts as water.
const int NARROWEST = 4;
// Margin in particle spacings around the bounding box of a sphere's silhouette. The sphere marks the screen cells that
// the box touches and those with their centres in this margin, so that it reaches all cells within a spacing of its
// centre. Without the margin, cells much smaller than the spheres would find air inside one body of water.
const float BESIDE = 0.35;
// Numbers of depth slices that the water behind a gap fills: water with at most the first number is a drop, with at
// least the second a body of water, and in between partly one. One sphere marks 13 or 14 slices.
const vec2 BODY = vec2(14.0, 22.0);
// Spheres with a radius below this, in drawn radii, are flying drops and mark no depth slices as water: they form no
// layer, and many of them would fill the air between layers.
const float DROP = 0.6;
