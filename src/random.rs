//! Random numbers that are the same for a seed on every machine.

/// The hash of `glsl/include/random.glsl` (PCG, O'Neill 2014).
pub fn pcg(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// Uniform numbers in [0, 1): the hash of a counter.
pub struct Random {
    seed: u32,
    counter: u32,
}

impl Random {
    pub fn new(seed: u32) -> Self {
        Self { seed: pcg(seed), counter: 0 }
    }

    pub fn next(&mut self) -> f64 {
        self.counter += 1;
        f64::from(pcg(self.seed.wrapping_add(pcg(self.counter))) >> 8) / f64::from(1 << 24)
    }
}
