//! Twin of the small waves on level water: sines in all directions, with lengths over three octaves
//! and one slope.

use super::smoothstep;
use crate::support::tolerance::U;
use glam::DVec3;
use std::f64::consts::TAU;

/// Number of sines.
const SINES: usize = 15;
/// Octaves that their lengths cover, from the longest on.
const OCTAVES: f64 = 3.0;
/// From each sine to the next, the angle of rotation; and the phase in cycles, times the number
/// squared.
const GOLDEN: f64 = 2.399_963_229_728_653;
const PHASE: f64 = 0.382;
/// Cosines between normal and vertical at which water has no waves, and all of them.
const LEVEL: (f64, f64) = (0.2, 0.7);
/// Waves per pixel at which a sine begins to fade, and at which it is gone.
const FADES: (f64, f64) = (0.2, 0.45);

/// The waves.
#[derive(Clone, Debug)]
pub struct Waves {
    up: DVec3,
    /// Slope of each sine.
    amplitude: f64,
    /// Cycles per length, and the phase in cycles.
    sines: Vec<(DVec3, f64)>,
}

impl Waves {
    /// From the root mean square of the slope, the longest wavelength, the time and the gravity.
    pub fn new(slope: f64, longest: f64, (time, gravity): (f64, f64), up: DVec3) -> Self {
        let up = up.normalize();
        let beside = if up.z.abs() < 0.9 { DVec3::Z } else { DVec3::X };
        let x = up.cross(beside).normalize();
        let y = x.cross(up);
        let sine = |i: usize| {
            let n = i as f64;
            let length = longest * 2.0_f64.powf(-OCTAVES * n / SINES as f64);
            let (sin, cos) = (GOLDEN * n).sin_cos();
            // Deep water: the angular frequency is the root of gravity times the wave number.
            let frequency = (gravity * TAU / length).sqrt() / TAU;
            ((x * cos + y * sin) / length, PHASE * n * n - frequency * time)
        };
        // The mean square of a sine is a half.
        let amplitude = slope / (0.5 * SINES as f64).sqrt();
        Self { up, amplitude, sines: (0..SINES).map(sine).collect() }
    }

    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Gradient of the height at a place, for pixels of this width.
    pub fn slope(&self, place: DVec3, pixel: f64) -> DVec3 {
        let of = |(k, phase): &(DVec3, f64)| {
            let whole = 1.0 - smoothstep(FADES.0, FADES.1, pixel * k.length());
            k.normalize() * (whole * (TAU * (k.dot(place) + phase)).cos())
        };
        self.amplitude * self.sines.iter().map(of).sum::<DVec3>()
    }

    /// Error of the slope in single precision: a phase is a sum of four products, with an error of
    /// 8u of them and of the place's products; the cosine errs by 2^-11.
    pub fn error(&self, place: DVec3) -> f64 {
        let of = |(k, _): &(DVec3, f64)| {
            TAU * 8.0 * U * (k.length() * place.length() + 1.0) + 2.0_f64.powi(-11)
        };
        self.amplitude * self.sines.iter().map(of).sum::<f64>()
    }

    /// Max change of the slope per length.
    pub fn steepest(&self) -> f64 {
        self.amplitude * self.sines.iter().map(|(k, _)| TAU * k.length()).sum::<f64>()
    }

    /// Fraction of the waves on water with this normal.
    pub fn level(&self, normal: DVec3) -> f64 {
        smoothstep(LEVEL.0, LEVEL.1, normal.dot(self.up))
    }

    /// Normal of water with waves, whose thickness is given in spacings.
    pub fn turn(&self, normal: DVec3, place: DVec3, pixel: f64, spacings: f64) -> DVec3 {
        let slope = self.slope(place, pixel) * self.level(normal) * smoothstep(1.0, 2.0, spacings);
        (normal - slope + slope.dot(normal) * normal).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::scenes::Random;

    /// The slope has the given root mean square, is equal along both horizontal axes, and has a
    /// mean of 0.
    #[test]
    fn waves_have_the_slope_that_is_said() {
        let waves = Waves::new(0.1, 0.5, (3.0, 9.81), DVec3::Y);
        let mut random = Random(8);
        let (mut square, mut mean) = (DVec3::ZERO, DVec3::ZERO);
        let count = 40_000;
        for _ in 0..count {
            let place = DVec3::from([0; 3].map(|_| f64::from(random.between(-300.0, 300.0))));
            let slope = waves.slope(place, 0.0);
            square += slope * slope / f64::from(count);
            mean += slope / f64::from(count);
        }
        // Means of 40 000 samples err by half a hundredth. Eight of fifteen directions favour one
        // axis, which has a tenth more.
        assert!((square.element_sum() / 0.01 - 1.0).abs() < 0.03, "{square}");
        assert!((square.x / square.z - 1.0).abs() < 0.2 && square.y == 0.0, "{square}");
        assert!(mean.length() < 0.003, "{mean}");
    }

    /// A crest moves with the speed of its length on deep water: the root of g L / 2 pi.
    #[test]
    fn crests_run_with_their_speed() {
        let at = |time: f64| Waves::new(0.1, 2.0, (time, 9.81), DVec3::Y);
        let (one, other) = (at(0.0), at(0.25));
        for ((k, before), (_, after)) in one.sines.iter().zip(&other.sines) {
            let speed = (9.81 / (TAU * k.length())).sqrt();
            // The phase moves with the crest.
            let moved = k.normalize() * speed * 0.25;
            assert!((k.dot(moved) + after - before).abs() < 1e-9, "{k}");
        }
    }
}
