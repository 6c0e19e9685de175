// Whether a sphere may be on the screen (thesis Sec. 4.3, Listing A.5). Needs frame.glsl.
bool in_frustum(vec3 centre, float radius) {
    bool inside = true;
    for (int i = 0; i < 6; ++i) {
        inside = inside && dot(frame.planes[i].xyz, centre) + frame.planes[i].w >= -radius;
    }
    return inside;
}
