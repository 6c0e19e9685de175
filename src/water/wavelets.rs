//! Small waves on level water: a sum of sines, whose slope the passes `composite` and `caustics` add to the surface
//! (sum of sines, Max 1981; dispersion of deep water). Not in the thesis.

use std::f64::consts::TAU;

use glam::Vec3;

use super::settings::range;
use crate::error::Error;

/// Waves that particles do not resolve. They tilt the normals of level water and focus its caustics, but do not
/// displace it.
///
/// They are 15 sines in all directions, each with the same slope. From one to the next the length falls by a fifth of
/// an octave, so the longest is seven times the shortest. All waves fade out on inclined water: they are full up to
/// 45 degrees, and gone from 78 degrees on. Two more limits hold in the picture, but not for caustics. On thin water
/// all waves fade out: they are full from two particle spacings of thickness on, and gone at one. A single sine fades
/// out where it is short on the screen: it is full from a length of five pixels on, and gone at two.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Wavelets {
    /// Root mean square of the slope, [0, 0.5], default 0: none. Clean water in a breeze of 2 m/s has 0.1 (Cox and
    /// Munk 1954).
    pub slope: f32,
    /// Length of the longest waves, scene units, [1e-6, ∞), default 0.2. The shortest are a seventh of it.
    pub length: f32,
    /// Time in seconds, finite, default 0. It moves the waves at the speed of gravity waves on deep water.
    pub time: f64,
    /// Gravity, scene units per second squared, [0, ∞), default 9.81.
    pub gravity: f32,
}

impl Default for Wavelets {
    fn default() -> Self {
        Self { slope: 0.0, length: 0.2, time: 0.0, gravity: 9.81 }
    }
}

/// Number of sines.
pub(crate) const WAVELETS: usize = 15;

impl Wavelets {
    pub(crate) fn check(&self) -> Result<(), Error> {
        range("Settings.water.wavelets.slope", self.slope, 0.0, 0.5)?;
        range("Settings.water.wavelets.length", self.length, 1.0e-6, f32::MAX)?;
        range("Settings.water.wavelets.gravity", self.gravity, 0.0, f32::MAX)?;
        if self.time.is_finite() {
            return Ok(());
        }
        let why = format!("{}: not finite", self.time);
        Err(Error::bad("Settings.water.wavelets.time", why))
    }

    /// Amplitude of each sine's slope.
    pub(crate) fn amplitude(&self) -> f32 {
        self.slope * (2.0 / WAVELETS as f32).sqrt()
    }

    /// For each sine: wave vector in the world, cycles per scene unit; phase in cycles.
    pub(crate) fn sines(&self, up: Vec3) -> [[f32; 4]; WAVELETS] {
        let beside = if up.z.abs() < 0.9 { Vec3::Z } else { Vec3::X };
        let across = up.cross(beside).normalize_or(Vec3::X);
        let along = across.cross(up);
        std::array::from_fn(|i| {
            let length = self.length * (-3.0 * i as f32 / WAVELETS as f32).exp2();
            // The golden angle, so that no direction repeats.
            let around = 2.399_963_2 * i as f32;
            let cycles = (around.cos() * across + around.sin() * along) / length;
            let rate = (f64::from(self.gravity) / (TAU * f64::from(length))).sqrt();
            let phase = 0.382 * (i * i) as f64 - rate * self.time;
            cycles.extend(phase.rem_euclid(1.0) as f32).to_array()
        })
    }
}
