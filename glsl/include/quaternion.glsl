// Rotation of vectors by unit quaternions, the real part last. Needs nothing.

vec3 turned(vec4 q, vec3 v) {
    return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

vec4 turned_back(vec4 q) {
    return vec4(-q.xyz, q.w);
}
