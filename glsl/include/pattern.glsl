// Noise by which foam forms clumps, and which moves with the foam. Differences in velocity stretch the noise, so it
// restarts before this shows; two phases cross-fade, so that no restart shows either (flow maps, Vlachos 2010; Neyret
// 2003). Not in the thesis, where each sprite has its own noise and many overlapping sprites average to a mist. The
// two coarse octaves are evaluated per sprite, the finest per texel. Needs frame.glsl, gradient_noise.glsl.

// Widths of the noise cells of the pattern's two coarse octaves and of its finest one, divided by the width of the
// first octave's cells; and the amplitudes of the three octaves.
const vec3 OCTAVES = vec3(1.0, 0.53, 0.23);
const vec3 HEIGHTS = vec3(1.0, 0.7, 1.1);
// Mean square of the noise.
const float VARIANCE = 0.073;
// Max logarithm of the pattern (a factor on the amount of foam) at a foam sprite's centre, and max change of this
// logarithm from the centre to the sprite's rim. With larger values a single sprite would show as a disc.
const float MOST_PATTERN = 1.0;
// The pattern repeats after this many cells of the first octave, centred on the world's origin, so that single
// precision resolves positions within a cell.
const float WRAP = 65536.0;

// Weight of a noise whose cells are `cell` scene units wide: 0 if a cell is narrower than one texel (`texel`), 1 if
// it is wider than two.
float told_apart(float cell, float texel) {
    return smoothstep(1.0, 2.0, cell / texel);
}

// Position of a point in a phase of an octave, given its velocity.
vec3 pattern_place(vec3 position, vec3 velocity, uint phase, uint octave) {
    float width = frame.particle.y * frame.foam_octaves.x;
    vec3 place = position / width;
    place -= WRAP * floor(place / WRAP + 0.5);
    vec3 way = velocity * (frame.foam_pattern.w * frame.foam_phases[2u + phase] / width);
    return (place - way + frame.foam_octaves[1u + phase]) / OCTAVES[octave];
}

// The two coarse octaves of the pattern at a point. The pattern multiplies the amount of foam by a factor with a mean
// of 1. w: the factor's logarithm, then limited to MOST_PATTERN. xyz: gradient of the unlimited logarithm per scene unit.
vec4 coarse_pattern(vec3 position, vec3 velocity, float texel) {
    vec4 sum = vec4(0.0);
    float square = 0.0;
    for (uint i = 0u; i < 4u; ++i) {
        uint phase = i & 1u;
        uint octave = i >> 1;
        float width = frame.particle.y * frame.foam_octaves.x * OCTAVES[octave];
        float height = frame.foam_pattern.x * HEIGHTS[octave] * told_apart(width, texel);
        vec4 noise = gradient_noise_slope(pattern_place(position, velocity, phase, octave));
        sum += height * frame.foam_phases[phase] * vec4(noise.xyz / width, noise.w);
        square += 0.5 * height * height;
    }
    return vec4(sum.xyz, min(sum.w - 0.5 * VARIANCE * square, MOST_PATTERN));
}
