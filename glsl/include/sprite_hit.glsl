// The fragment of a sprite in a plane: needs frame.glsl and what foam.vert and spray.vert hand on.

layout(location = 0) flat in vec3 centre;
layout(location = 1) flat in vec3 along;
layout(location = 2) flat in vec3 across;
layout(location = 3) flat in vec3 normal;

// Where the ray meets the sprite's plane: place in half-axes, and depth; false where it does not.
bool sprite_hit(vec2 slope, out vec2 place, out float depth) {
    vec3 w = vec3(slope, -1.0);
    float q = dot(normal, w);
    depth = dot(normal, centre) / q;
    vec3 off = w * depth - centre;
    place = vec2(dot(off, along), dot(off, across));
    return abs(q) >= 1.0e-6 && depth >= frame.depth.z && dot(place, place) <= 1.0;
}
