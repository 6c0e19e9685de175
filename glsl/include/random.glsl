// Counter-based random numbers (PCG, O'Neill 2014; as a hash, Jarzynski and Olano 2020): the same
// in every run and on every device.

uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint w = ((s >> ((s >> 28) + 4u)) ^ s) * 277803737u;
    return (w >> 22) ^ w;
}

// Uniform in [0, 1) from a seed, a particle and a counter; exact in 24 bits.
float uniform_of(uint seed, uint id, uint n) {
    return float(pcg(id + pcg(n + pcg(seed))) >> 8) * (1.0 / 16777216.0);
}
