// A particle of the fluid, as the grid of neighbours has it: what is of it. Needs nothing.

struct Place {
    vec3 position;
    uint id;
};
