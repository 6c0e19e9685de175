// Depth slices of pass `gaps`, in spacings. Neighbours in water are one spacing apart, in thin parts one and a half;
// two and a half are air.

const float SLICE = 0.5;
// What a sphere marks before and behind its centre.
const float REACH = 0.75;
// What it marks beside its silhouette, less half a cell: all within a spacing of the cell's middle.
// Else a cell much smaller than the spheres looks through between those of one body.
const float BESIDE = 0.35;
// Slices that are more than a drop: one sphere marks four at most.
const int BODY = 6;
// Spheres of less than this, in drawn radii, are drops that fly: of themselves they are no sheet, and many would fill the air.
const float DROP = 0.6;
