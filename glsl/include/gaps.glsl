// Depth slices of pass `gaps`, in spacings. Neighbours in water are one spacing apart, in thin parts one and a half;
// two and a half are air.

// Thin slices, so that a boundary moves little if an air becomes one slice wider or narrower.
const float SLICE = 0.125;
// Slices of a cell, 32 in a word.
const int WORDS = 8;
const int SLICES = 32 * WORDS;
// Airs of a cell that are kept.
const int AIRS = 5;
// Words of a cell's airs: its nearest depth; then, as bytes, the first slice of each air and of the water behind it. The
// end of the last water follows; 255 if it reaches the last slice.
const uint AIR_WORDS = 4u;
// Range marked before and behind a sphere's centre.
const float REACH = 0.8;
// Range marked beside a sphere's silhouette, less half a cell: all within a spacing of the cell's centre.
// Otherwise a cell much smaller than the spheres would see through between spheres of one body.
const float BESIDE = 0.35;
// Slices of a drop and of a body of water: one sphere marks 13 or 14.
const vec2 BODY = vec2(14.0, 22.0);
// Spheres below this, in drawn radii, are flying drops: they do not form a layer, and many of them would fill the air.
const float DROP = 0.6;
