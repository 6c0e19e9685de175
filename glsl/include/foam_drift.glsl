// Velocity of the foam on the screen: a grid of nodes, each with the mean world velocity of nearby sprites.
// Fixed-point steps: sums are exact in any order. Needs frame.glsl.

// Pixels from node to node.
const float DRIFT_CELL = 16.0;
// Steps of a whole sprite in the middle of a node, and of a speed of a spacing a second; the most of the latter.
const float DRIFT_WHOLE = 63.0;
const float DRIFT_STEPS = 2.0;
const float DRIFT_MOST = 1023.0;
// Of weights, from which on nothing is added: steps of velocities that are as fast as they come fit 32 bits.
const int DRIFT_FULL = 1 << 20;

ivec2 drift_nodes() {
    return ivec2(ceil(frame.extent.xy / DRIFT_CELL)) + 1;
}

// Its words: the weight, and the weighted velocities.
uint drift_word(ivec2 node) {
    return 4u * uint(node.y * drift_nodes().x + node.x);
}
