//! Clumps and strands of spray: a noise in world space that moves with the spray, with cells that are
//! longer along the motion. A density, relative to its mean, is e to the power of its octaves.

use super::super::surface_foam::{
    Off, Phase, TOLD_APART, VARIANCE, WRAP, noise, noise_reach, noise_rounding, noise_slope,
};
use crate::support::rounded::{self, Rounded, exact, off};
use crate::support::tolerance::U;

/// Cell width of the coarsest octave in spacings, ratio of the cell widths of successive octaves, and
/// number of octaves in mist and at a droplet.
const CLUMP: f64 = 3.0;
const FINER: f64 = 2.03;
pub const OCTAVES: [u32; 2] = [7, 3];
/// Excess of a cell's length over its width, relative to the way of the droplets along their
/// motion; the max ratio of length to width; the factor on the excess from octave to octave.
const STRAND_LENGTH: f64 = 4.0;
const MOST_STRAND: f64 = 4.0;
const ROUNDER: f64 = 0.75;
/// Cells are lengthened from the centre of a block this many cells wide, in its inner part only.
const BLOCK: f64 = 8.0;
const INNER: f64 = 0.8;
/// Ratio of the amplitudes of successive octaves, max amplitude, and max logarithm of the density.
const STRONGER: f64 = 1.4;
const MOST_AMPLITUDE: f64 = 4.0;
const MOST_CLUMP: f64 = 8.0;
/// A 24th of the noise's fourth cumulant, negated.
const FOURTH: f64 = 1.0e-4;

/// The clumps of a droplet or of mist.
#[derive(Clone, Copy, Debug)]
pub struct Clumps {
    /// Amplitude of the coarsest octave of the logarithm of the density.
    pub strength: f64,
    /// Seconds by which droplets are moved along their motion at most.
    pub stretch: f64,
    /// Rest spacing of the particles in world units.
    pub spacing: f64,
    /// The two phases of the noise, as of the foam's pattern.
    pub phases: [Phase; 2],
    /// Octaves from this number on are left out.
    pub octaves: u32,
}

impl Clumps {
    /// Density relative to its mean at a point of a particle with this centre and velocity, all in
    /// world space. `pixel`: width of a pixel there.
    pub fn at(&self, point: Off, (centre, velocity): (Off, Off), pixel: Rounded) -> Rounded {
        let width = CLUMP * self.spacing;
        // The width errs by 2u, a quotient by 6u of it.
        let over = |v: Off| Off { v: v.v / width, e: v.e / width + 8.0 * U * v.v.length() / width };
        let minus = |a: Off, b: Off| {
            let v = a.v - b.v;
            Off { v, e: a.e + b.e + U * v.length() }
        };
        let speed = velocity.length();
        let along = if speed.v > 0.0 { velocity.normalize() } else { velocity };
        let longer = off(STRAND_LENGTH * self.stretch / width, 8.0) * speed;
        let excess = longer.clamp(0.0, MOST_STRAND - 1.0);
        let (middle, apart) = (over(centre), over(minus(point, centre)));
        let wrapped = middle.v - WRAP * (middle.v / WRAP + 0.5).floor();
        let middle = Off { v: wrapped, ..middle };
        let mut places = self.phases.map(|phase| {
            let way = over(Off {
                v: velocity.v * phase.carried,
                e: velocity.e * phase.carried.abs()
                    + 4.0 * U * (velocity.v * phase.carried).length(),
            });
            let begun = minus(middle, way);
            let cell = (begun.v / BLOCK).floor();
            let block = BLOCK * (cell + 0.5);
            // At the border of a block, rounding may select the next block, but there the noise is
            // not lengthened and does not depend on the block.
            let rim = Rounded {
                v: 2.0 / BLOCK * (begun.v - block).abs().max_element(),
                e: 2.0 / BLOCK * (begun.e + 6.0 * U * begun.v.length()),
            };
            let inner = exact(1.0) - rounded::smoothstep(off(INNER, 1.0), exact(1.0), rim);
            let off = Off {
                v: begun.v - block + apart.v,
                e: begun.e + apart.e + 3.0 * U * (begun.v.length() + apart.v.length()),
            };
            (off, block + phase.began, excess * inner)
        });
        let (mut sum, mut finer, mut amplitude) = (exact(0.0), 1.0, exact(self.strength));
        for _ in 0..self.octaves {
            let (from, to) = TOLD_APART;
            let told = rounded::smoothstep(exact(from), exact(to), off(width / finer, 8.0) / pixel);
            for (phase, (off, block, excess)) in self.phases.iter().zip(&mut places) {
                let height = amplitude * self::off(phase.part, 2.0) * told;
                let on = off.dot(along) * (*excess / (exact(1.0) + *excess));
                *excess = *excess * exact(ROUNDER);
                let v = finer * (*block + off.v - on.v * along.v);
                let terms = block.length() + off.v.length() + on.v.abs();
                let e = off.e + on.e + (on.v.abs() + on.e) * (along.e + 2.0 * U) + 4.0 * U * terms;
                // Three sums; up to six products with the ratio, which is itself rounded.
                let apart = 3.0_f64.sqrt() * (finer * e + 10.0 * U * v.length());
                let near = noise_slope() * apart + noise_rounding();
                let noise = Rounded { v: noise(v), e: near.min(2.0 * noise_reach()) };
                let fourth = self::off(FOURTH, 1.0) * height * height;
                sum = sum + height * (noise - height * (exact(0.5 * VARIANCE) - fourth));
            }
            finer *= FINER;
            amplitude = (off(STRONGER, 1.0) * amplitude).clamp(0.0, MOST_AMPLITUDE);
        }
        let most = |v: f64| v.min(MOST_CLUMP);
        let (v, high, low) = (most(sum.v), most(sum.v + sum.e), most(sum.v - sum.e));
        Rounded { v, e: (high - v).max(v - low) }.exp()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::settings;
    use super::*;
    use crate::support::scenes::Random;
    use glam::DVec3;

    /// Clumps at points of a particle with a velocity.
    fn clumps(velocity: DVec3, strength: f64) -> impl Fn(DVec3, DVec3) -> f64 {
        let phases = settings().pattern.phases();
        let held = |v| Off { v, e: 0.0 };
        let clumps = Clumps { strength, stretch: 0.1, spacing: 0.5, phases, octaves: OCTAVES[0] };
        move |point, centre| clumps.at(held(point), (held(centre), held(velocity)), exact(1.0e-3)).v
    }

    /// Each octave keeps the mean at any amplitude: within 1 %, plus the sampling error.
    #[test]
    fn octaves_keep_the_mean() {
        let mut random = Random(3);
        let mut of = || f64::from(random.between(-900.0, 900.0));
        let all: Vec<f64> = (0..400_000).map(|_| noise(DVec3::new(of(), of(), of()))).collect();
        let count = all.len() as f64;
        for height in [0.5, 1.0, 2.0, 3.0, MOST_AMPLITUDE] {
            let lower = height * (0.5 * VARIANCE - FOURTH * height * height);
            let density = |noise: &f64| (height * (noise - lower)).exp();
            let mean = all.iter().map(density).sum::<f64>() / count;
            let square = all.iter().map(|x| (density(x) - mean).powi(2)).sum::<f64>() / count;
            let chance = 4.0 * (square / count).sqrt();
            assert!((mean - 1.0).abs() < 0.01 + chance, "{height}: {mean}, chance {chance}");
        }
    }

    /// The variance of the logarithm of the density is at most the sum of the octaves' variances, plus 5 % for
    /// sampling. Where a few points do not hold most of the spray, its mean is that of even spray: within 1 %, plus
    /// the sampling error of 40 000 points.
    #[test]
    fn clumps_keep_the_mean() {
        let mut random = Random(3);
        for strength in [0.25, 0.5, 1.3, 3.0] {
            let density = clumps(DVec3::new(3.0, 1.0, 0.0), strength);
            let all = (0..40_000).map(|_| {
                let mut of = || f64::from(random.between(-900.0, 900.0));
                let point = DVec3::new(of(), of(), of());
                density(point, point)
            });
            let all: Vec<f64> = all.collect();
            let moments = |of: fn(&f64) -> f64| {
                let mean = all.iter().map(of).sum::<f64>() / all.len() as f64;
                let square = all.iter().map(|x| (of(x) - mean).powi(2)).sum::<f64>();
                (mean, square / all.len() as f64)
            };
            let (mean, square) = moments(|x| *x);
            let chance = 4.0 * (square / all.len() as f64).sqrt();
            let few = strength > 0.5;
            assert!(
                few || (mean - 1.0).abs() < 0.01 + chance,
                "{strength}: {mean}, chance {chance}"
            );
            let octaves =
                (0..OCTAVES[0] as i32).map(|k| (strength * STRONGER.powi(k)).min(MOST_AMPLITUDE));
            let most = octaves.map(|it| VARIANCE * it * it).sum::<f64>();
            let (_, square) = moments(|x| x.ln());
            assert!((0.5 * most..1.05 * most).contains(&square), "{strength}: {square} of {most}");
        }
    }

    /// Particles of one block share their clumps. With lengthened cells those of another block have
    /// others; without motion, cells are not lengthened and all particles share their clumps.
    #[test]
    fn neighbours_share_their_clumps() {
        let density = clumps(DVec3::new(3.0, 1.0, 0.0), 2.0);
        // Blocks are 12 m wide. The velocity moves them by up to a quarter of a metre.
        let point = DVec3::new(5.8, 6.1, 5.9);
        let own = density(point, point);
        for near in [DVec3::X, DVec3::new(-0.6, 0.4, 0.9)] {
            assert!((density(point, point + near) / own - 1.0).abs() < 1e-9, "{near}");
        }
        let beside = point + 12.0 * DVec3::X;
        assert!((density(point, beside) / own - 1.0).abs() > 1e-3);
        let still = clumps(DVec3::ZERO, 2.0);
        assert!((still(point, beside) / still(point, point) - 1.0).abs() < 1e-9);
    }

    /// Across the border of a block densities do not jump: a tiny step changes them by little.
    #[test]
    fn clumps_do_not_jump_between_blocks() {
        let velocity = DVec3::new(3.0, 1.0, 0.0);
        let density = clumps(velocity, 2.0);
        let point = DVec3::new(5.8, 6.1, 5.9);
        // Both phases' borders: multiples of 12 m, moved by the way of each phase.
        for phase in settings().pattern.phases() {
            let border = 12.0 + (velocity * phase.carried).x;
            let of = |x: f64| density(point, DVec3::new(x, 6.1, 5.9));
            let jump = (of(border + 1e-7) / of(border - 1e-7)).ln().abs();
            assert!(jump < 1e-4, "{jump}");
        }
    }

    /// Densities stay similar over a longer way along the motion than across it; without motion,
    /// over equal ways. Compared is the root mean square change of the logarithm over a step half as
    /// long as the finest cell is wide.
    #[test]
    fn clumps_are_longer_along_the_motion() {
        let change = |velocity: DVec3, step: DVec3| {
            let density = clumps(velocity, 1.0);
            let mut random = Random(5);
            let all = (0..4000).map(|_| {
                let mut of = || f64::from(random.between(-90.0, 90.0));
                let point = DVec3::new(of(), of(), of());
                (density(point + 0.01 * step, point) / density(point, point)).ln().powi(2)
            });
            (all.sum::<f64>() / 4000.0).sqrt()
        };
        let fast = 20.0 * DVec3::X;
        let ratio = change(fast, DVec3::X) / change(fast, DVec3::Y);
        assert!(ratio < 0.75, "{ratio}");
        let still = change(DVec3::ZERO, DVec3::X) / change(DVec3::ZERO, DVec3::Y);
        assert!((still - 1.0).abs() < 0.1, "{still}");
    }
}
