// Velocity of the foam over the screen: grids of nodes, each with the mean world velocity of the sprites near it. A
// sprite near the eye is wider than the cells of the finest grid, so at its rim no node near may have a velocity; the
// coarser grids have one there. Values are in fixed-point steps: sums are exact, whatever the order, unless a node is
// full. Needs frame.glsl.

// Distance between the nodes of the finest grid in pixels, number of grids, and ratio of the distances of successive
// grids.
const float DRIFT_CELL = 16.0;
const int DRIFT_GRIDS = 3;
const float DRIFT_RATIO = 4.0;
// Fixed-point steps: `DRIFT_WHOLE` for the weight of a whole sprite at a node, `DRIFT_STEPS` for a speed of one
// particle spacing per second. `DRIFT_MOST`: max speed along an axis, in steps.
const float DRIFT_WHOLE = 63.0;
const float DRIFT_STEPS = 2.0;
const float DRIFT_MOST = 1023.0;
// Sum of the weights at a node, in fixed-point steps, from which on the node is full and no sprite is added to it, so
// that sums of weighted velocities fit 32 bits: 16,000 whole sprites at one node.
const int DRIFT_FULL = 1 << 20;

// One of the grids.
struct DriftGrid {
    float cell;  // distance between nodes in pixels
    ivec2 nodes; // number of nodes
    uint first;  // its first word
};

ivec2 drift_nodes(float cell) {
    return ivec2(ceil(frame.extent.xy / cell)) + 1;
}

DriftGrid finest_drift() {
    return DriftGrid(DRIFT_CELL, drift_nodes(DRIFT_CELL), 0u);
}

DriftGrid coarser(DriftGrid grid) {
    float cell = DRIFT_RATIO * grid.cell;
    return DriftGrid(cell, drift_nodes(cell), grid.first + 4u * uint(grid.nodes.x * grid.nodes.y));
}

// First word of a node: the weight, then the weighted velocities.
uint drift_word(DriftGrid grid, ivec2 node) {
    return grid.first + 4u * uint(node.y * grid.nodes.x + node.x);
}
