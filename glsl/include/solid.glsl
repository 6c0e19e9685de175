// Solids that blobs collide with. Needs nothing.
struct Solid {
    vec4 place; // of a plane its normal, of a box its middle; 0 or 1
    vec4 size;  // of a box half its edges; of a plane its distance from 0 along the normal
    vec4 turn;  // of a box, to the world
};
