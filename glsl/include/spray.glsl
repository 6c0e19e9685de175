// Spray as droplets around a particle (thesis Sec. 4.9.5 draws one sprite per particle).
// Needs frame.glsl, density.glsl.

struct SpraySprite {
    vec4 centre;   // eye-space position; fraction of the particle that is spray
    vec4 velocity; // eye-space velocity; bits of the id
    uvec4 shape;   // of its droplets and mist, in the world (axes.glsl); sum of its neighbours' weights
};

// Half-axes of droplets relative to frame.spray.y: that of the smallest, and that of the largest minus that of the
// smallest, both before they are divided by the square root of torn_of. Before that their mean is 0.6, and the mean of
// their squares 0.513.
const float SMALLEST_DROPLET = 0.36;
const float DROPLET_RANGE = 1.661;
// Half-axis of the largest droplet relative to frame.spray.y. A particle that is only spray has it, because there
// torn_of is LEAST_TORN.
const float LARGEST_DROPLET = (SMALLEST_DROPLET + DROPLET_RANGE) * inversesqrt(LEAST_TORN);
