// Push constants of the passes over particles and cells.
layout(push_constant, std430) uniform Push {
    uint count;    // particles
    uint cells;    // capacity of the cell buffer
    uint capacity; // capacity of the entries, or of the bricks
} push;
