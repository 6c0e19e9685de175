// Classification of a particle by its density: spray or bulk (thesis Sec. 4.9.5 has a hard threshold). Needs
// frame.glsl.

// 0 for pure spray to 1 for pure water or foam, over a range of densities.
float risen(float full, float density) {
    // The edges are never equal: GLSL leaves that undefined.
    float end = max(full, frame.density.x * 1.000001 + 1.0e-6);
    return smoothstep(frame.density.x, end, density);
}

float bulk(float density) {
    return risen(frame.density.y, density);
}

float share_of_spray(float density) {
    return 1.0 - risen(frame.density.z, density);
}

// Min value of torn_of: that of a particle that is entirely spray.
const float LEAST_TORN = 0.3;

// Returns which fraction of the largest number of droplets a particle gets (1 if that number is 1). `share` is the
// part of the particle that is spray: one that is just being torn (share up to 3/4) gets all droplets, fine ones; one
// that is entirely spray gets few, large ones. The amount of mist is scaled by the cube of this fraction.
float torn_of(float share) {
    return frame.density.w > 1.0 ? clamp(4.0 * (1.0 - share), LEAST_TORN, 1.0) : 1.0;
}
