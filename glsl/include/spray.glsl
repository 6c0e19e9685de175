// Spray as droplets around a particle (thesis Sec. 4.9.5 draws one sprite per particle). Needs frame.glsl.

struct SpraySprite {
    vec4 centre;   // eye-space position; fraction of the particle that is spray
    vec4 velocity; // eye-space velocity; bits of the id
    uvec4 shape;   // of its droplets and mist, in the world (axes.glsl); sum of its neighbours' weights
};

// Half-axis of the largest droplet, relative to the mean.
const float LARGEST_DROPLET = 2.74; // 1.5 over the root of LEAST_TORN
