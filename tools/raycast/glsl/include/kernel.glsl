// Distance at which a ray passes a ball's centre, and the ball's kernel there (src/lib.rs derives the kernels).

// 1 minus the squared distance of a ray from a centre, in radii.
float rest_of(vec3 centre, float inverse, vec2 slope) {
    vec2 d = (slope * centre.z - centre.xy) * inverse;
    return 1.0 - dot(d, d);
}

float kernel_at(vec3 kernel, float y) {
    return sqrt(y) * (kernel.x + y * (kernel.y + y * kernel.z));
}
