// Clumps and strands of spray: a noise in world space that particles share if they are near each other and move alike.
// (If each particle had its own noise, many overlapping particles would average to cotton.) The noise moves with the
// spray and restarts as in pattern.glsl. Its cells are longer along the motion, so that fast spray flies in strands.
// Not in the thesis. Needs frame.glsl, gradient_noise.glsl, pattern.glsl.

// Width of the coarsest octave's cells in spacings.
const float CLUMP = 3.0;
// Number of octaves.
const uint CLUMP_OCTAVES = 7u;
// Ratio of the cell widths of two successive octaves. With 2 the lattices, on which the noise is 0, would coincide.
const float FINER = 2.03;
// A cell of the coarsest octave is longer than wide by this many times the farthest way that droplets are moved along
// their motion (`SpraySettings::stretch`).
const float STRAND_LENGTH = 4.0;
// Max ratio of a cell's length to its width.
const float MOST_STRAND = 4.0;
// Each octave's cells are rounder than the next coarser ones: the ratio of length to width, minus 1, is multiplied by
// this. (If the cells of all octaves are equally long, spray looks like feathers.)
const float ROUNDER = 0.75;
// Width of a block in cells of the coarsest octave. Space is divided into cubic blocks, and cells are lengthened from
// the centre of their block. From a centre far away, small differences in the direction of motion would displace the
// noise of neighbours by many cells.
const float BLOCK = 8.0;
// At a block's border cells are not lengthened, because the noise would jump there from one block to the next. The
// lengthening begins to decrease at this part of the way from the centre to the border.
const float INNER = 0.8;
// Each octave's amplitude is this many times that of the next coarser one, up to MOST_AMPLITUDE: spray looks grainy
// rather than cloudy. (With equal amplitudes it looks like wool.)
const float STRONGER = 1.4;
const float MOST_AMPLITUDE = 4.0;
// A 24th of the noise's fourth cumulant, negated. (The third is 0.) Measured on four million points.
const float FOURTH = 1.0e-4;
// Max logarithm of the density.
const float MOST_CLUMP = 8.0;

// Density of spray at a point, relative to its mean. The point belongs to a particle with the centre `particle` and
// the velocity `velocity`. Octaves with cells narrower than `pixel`, and all from number `octaves` on, are left out.
float clumps_at(vec3 point, vec3 particle, vec3 velocity, float pixel, uint octaves) {
    float coarsest = CLUMP * frame.particle.y;
    float speed = length(velocity);
    vec3 along = speed > 0.0 ? velocity / speed : vec3(0.0);
    float longer = min(STRAND_LENGTH * frame.spray_cloud.z * speed / coarsest, MOST_STRAND - 1.0);
    vec3 centre = particle / coarsest;
    vec3 apart = (point - particle) / coarsest;
    centre -= WRAP * floor(centre / WRAP + 0.5);
    float sum = 0.0;
    for (uint phase = 0u; phase < 2u; ++phase) {
        float part = frame.foam_phases[phase];
        vec3 way = velocity * (frame.foam_pattern.w * frame.foam_phases[2u + phase] / coarsest);
        vec3 began = centre - way;
        vec3 block = BLOCK * (floor(began / BLOCK) + 0.5);
        vec3 off = began - block + apart;
        vec3 rim = abs(began - block) * (2.0 / BLOCK);
        float excess = longer * (1.0 - smoothstep(INNER, 1.0, max(rim.x, max(rim.y, rim.z))));
        float on = dot(off, along);
        block += frame.foam_octaves[1u + phase];
        float finer = 1.0;
        float amplitude = frame.spray_mist.x;
        float height = part * amplitude * told_apart(coarsest, pixel);
        for (uint k = 0u; k < octaves && height > 0.0; ++k) {
            vec3 at = finer * (block + off - along * (on * excess / (1.0 + excess)));
            // The logarithm of the mean of exp(height * noise), to the fourth order, is subtracted: it keeps the mean.
            float lower = height * (0.5 * VARIANCE - FOURTH * height * height);
            sum += height * (gradient_noise(at) - lower);
            finer *= FINER;
            excess *= ROUNDER;
            amplitude = min(STRONGER * amplitude, MOST_AMPLITUDE);
            height = part * amplitude * told_apart(coarsest / finer, pixel);
        }
    }
    return exp(min(sum, MOST_CLUMP));
}
