// The thickness kernel: N_z exp(-2 rho^2), N_z = sqrt(1 - rho^2) (thesis Listing A.15; Eq. 3.4
// lacks the square). Its integral over the unit disc is pi J, J = 0.3400030.

float thickness_kernel(float rho2) {
    return rho2 > 1.0 ? 0.0 : sqrt(1.0 - rho2) * exp(-2.0 * rho2);
}

// rho^2 of the point where the ray meets the plane of the sprite's centre.
float thickness_rho2(vec2 slope, vec3 centre, float inverse_axis) {
    vec2 off = (slope * -centre.z - centre.xy) * inverse_axis;
    return dot(off, off);
}
