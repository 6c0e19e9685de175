// Of the passes over particles and cells.
layout(push_constant, std430) uniform Push {
    uint count;    // particles
    uint cells;    // what there is room for
    uint capacity; // entries, or bricks
} push;
