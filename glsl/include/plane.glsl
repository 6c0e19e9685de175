// A sprite in a plane, given by unit vectors along its two axes, each divided by its half-axis, and by the plane's
// normal. Needs frame.glsl.

// Intersection of a ray with the sprite: position in half-axes, and eye depth. False if the ray misses the sprite's
// ellipse, meets it before the near plane, or sees it edge-on.
bool plane_hit(vec3 centre, vec3 along, vec3 across, vec3 normal, vec2 slope, out vec2 place, out float depth) {
    vec3 w = vec3(slope, -1.0);
    float q = dot(normal, w);
    depth = dot(normal, centre) / q;
    vec3 off = w * depth - centre;
    place = vec2(dot(off, along), dot(off, across));
    return abs(q) >= 1.0e-6 && depth >= frame.depth.z && dot(place, place) <= 1.0;
}
