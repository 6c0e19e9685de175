// A sprite in a plane: its axes divided by their half-axes, and the plane's normal. Needs frame.glsl.

// Intersection of a ray with the plane: position in half-axes, and depth; false if there is none.
bool plane_hit(vec3 centre, vec3 along, vec3 across, vec3 normal, vec2 slope, out vec2 place, out float depth) {
    vec3 w = vec3(slope, -1.0);
    float q = dot(normal, w);
    depth = dot(normal, centre) / q;
    vec3 off = w * depth - centre;
    place = vec2(dot(off, along), dot(off, across));
    return abs(q) >= 1.0e-6 && depth >= frame.depth.z && dot(place, place) <= 1.0;
}
