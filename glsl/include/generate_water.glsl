// The water at a point: weighted means of the velocity and emission rate of the particles around it. Needs
// neighbours.glsl, and rate_of(j): the emission rate of water particle j relative to the maximum, 0 to 1. Reads: the
// grid.

struct Water {
    vec3 velocity;   // 0 without water
    float rate;      // likewise
    uint neighbours; // number of particles within the support
    bool any;
};

float cubic_spline(float q) {
    float rest = 1.0 - q;
    return q <= 0.5 ? 6.0 * (q * q * q - q * q) + 1.0 : 2.0 * rest * rest * rest;
}

Water water_at(vec3 position) {
    uint neighbours = 0u;
    ivec3 sum = ivec3(0);
    uint weights = 0u;
    uint rates = 0u;
    for (int c = 0; c < 27; ++c) {
        ivec3 cell = neighbour_cell(position, c);
        uvec2 range = range_of(cell);
        for (uint j = range.x; j < range.y; ++j) {
            float d = distance(position, places[j].position);
            if (!(d < support()) || !in_cell(places[j].position, cell)) {
                continue;
            }
            float weight = cubic_spline(d / support());
            vec3 part = motions[j].velocity * (weight / speed_step());
            sum += ivec3(round(clamp(part, -MOST_STEPS, MOST_STEPS)));
            weights += uint(weight * STEPS + 0.5);
            rates += uint(weight * rate_of(j) * STEPS + 0.5);
            neighbours += 1u;
        }
    }
    Water water = Water(vec3(0.0), 0.0, neighbours, weights > 0u);
    if (weights > 0u) {
        water.velocity = vec3(sum) * (speed_step() * STEPS / float(weights));
        water.rate = float(rates) / float(weights);
    }
    return water;
}
