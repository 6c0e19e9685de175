// Depth slices of pass `gaps`, in spacings. Neighbours in water are one spacing apart, in thin parts one and a half;
// two and a half are air.

const float SLICE = 0.5;
// Range marked before and behind a sphere's centre.
const float REACH = 0.75;
// Range marked beside a sphere's silhouette, less half a cell: all within a spacing of the cell's centre.
// Otherwise a cell much smaller than the spheres would see through between spheres of one body.
const float BESIDE = 0.35;
// Number of slices that is more than a drop: one sphere marks at most four.
const int BODY = 6;
// Spheres below this, in drawn radii, are flying drops: they do not form a layer, and many of them would fill the air.
const float DROP = 0.6;
