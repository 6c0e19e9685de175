// Solids that blobs collide with. Needs nothing.
struct Solid {
    vec4 place; // plane: normal; box: centre; w: 0 plane, 1 box
    vec4 size;  // box: half its edges; plane: distance from the origin along the normal
    vec4 turn;  // box: rotation to the world
};
