//! Twin of the rounding of contributions to fixed-point steps: x steps become `floor(x + c)`, where
//! c in [0, 1) is a random number of the particle and the texel. c only affects the last step: the
//! result is never a step off, and its mean over many particles is x.

use super::classify::pcg;
use glam::Vec3;

/// Seed of the random numbers.
const SEED: u32 = 0x57E9;
/// The R2 sequence (Roberts 2018): 1 over the plastic number and over its square, in units of
/// 2^-32.
const PLASTIC: f64 = 1.324_717_957_244_746;

/// Random bits of a particle, from its id.
pub fn chance(id: u32, number: u32) -> u32 {
    pcg(id.wrapping_add(pcg(number.wrapping_add(pcg(SEED)))))
}

/// Random bits of a particle without an id, from its position.
pub fn of_place(p: Vec3) -> u32 {
    chance(p.x.to_bits(), chance(p.y.to_bits(), p.z.to_bits()))
}

/// c from the particle's bits and a texel, with 24 bits.
pub fn rounding_up(chance: u32, x: usize, y: usize) -> f64 {
    let part = |power: i32| (4_294_967_296.0 / PLASTIC.powi(power)) as u32;
    let [x, y] = [(x, 1), (y, 2)].map(|(at, power)| (at as u32).wrapping_mul(part(power)));
    f64::from(chance.wrapping_add(x).wrapping_add(y) >> 8) / 16_777_216.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For any thickness, however thin, the mean over a square of texels is right to a thousandth
    /// of a step.
    #[test]
    fn the_mean_is_kept() {
        for (number, steps) in [0.003, 0.1, 0.5, 0.9, 7.25].into_iter().enumerate() {
            let place = |i: u32| Vec3::new(0.1 * i as f32, -2.0, number as f32);
            let texels =
                (0..64 * 64 * 16_u32).map(|i| (i, (i / 16 % 64) as usize, (i / 1024) as usize));
            let whole = texels
                .map(|(i, x, y)| (steps + rounding_up(of_place(place(i % 16)), x, y)).floor());
            let mean = whole.sum::<f64>() / f64::from(64 * 64 * 16);
            assert!((mean - steps).abs() < 1e-3, "{mean} of {steps}");
        }
    }
}
