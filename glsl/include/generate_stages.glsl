// For a snapshot (a single frame of the fluid): moments in the past at which the water that has since flowed to a
// particle is evaluated. They span the longest lifetime of foam and lie denser towards the present. Needs
// generate.glsl, random.glsl.

const uint STAGES = 15u;
// Most whitewater particles per moment: six bits.
const uint MOST_OF_STAGE = 63u;

// Seconds before the snapshot.
float before(uint stage, uint id) {
    float part = (float(stage) + uniform_of(step_seed(), id, 0u)) / float(STAGES);
    return push.life_most * part * part;
}

// Seconds that a moment stands for.
float seconds_of(uint stage) {
    return push.life_most * float(2u * stage + 1u) / float(STAGES * STAGES);
}

// Position of its number: five per word.
uint shift_of(uint stage) {
    return 6u * (stage % 5u);
}
