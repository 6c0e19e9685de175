// Velocity of the foam over the screen: a grid of nodes, each with the mean world velocity of the sprites near it.
// Values are in fixed-point steps, so that sums are exact in any order. Needs frame.glsl.

// Distance between nodes in pixels.
const float DRIFT_CELL = 16.0;
// Fixed-point steps: `DRIFT_WHOLE` for the weight of a whole sprite at a node, `DRIFT_STEPS` for a speed of one
// particle spacing per second. `DRIFT_MOST`: max speed along an axis, in steps.
const float DRIFT_WHOLE = 63.0;
const float DRIFT_STEPS = 2.0;
const float DRIFT_MOST = 1023.0;
// Sum of the weights at a node, in fixed-point steps, from which on no sprite is added to the node, so that sums of
// weighted velocities fit 32 bits.
const int DRIFT_FULL = 1 << 20;

ivec2 drift_nodes() {
    return ivec2(ceil(frame.extent.xy / DRIFT_CELL)) + 1;
}

// First word of a node: the weight, then the weighted velocities.
uint drift_word(ivec2 node) {
    return 4u * uint(node.y * drift_nodes().x + node.x);
}
