// Intersects the ray of a fragment with the plane of its flat sprite. Needs frame.glsl and the outputs of
// surface_foam.vert or spray.vert.

#include "plane.glsl"

layout(location = 0) flat in vec3 centre;
layout(location = 1) flat in vec3 along;
layout(location = 2) flat in vec3 across;
layout(location = 3) flat in vec3 normal;

bool sprite_hit(vec2 slope, out vec2 place, out float depth) {
    return plane_hit(centre, along, across, normal, slope, place, depth);
}
