//! Settings of the generator of diffuse particles (Ihmsen et al. 2012).

use crate::error::Error;
use crate::water::settings::{GREATEST, range};

crate::contract::with!(GenerateConfig, GenerateSettings);

/// What fixes the memory of a [`Generator`](super::Generator).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct GenerateConfig {
    /// Most particles of the fluid in a step, at least 1.
    pub max_fluid: u32,
    /// Longest stride of their streams in bytes, a multiple of 4, default 16.
    pub max_stride: u32,
    /// Most diffuse particles at a time, at least 1. Those beyond are not made, and counted.
    pub max_particles: u32,
}

impl GenerateConfig {
    /// The defaults for so many particles of the fluid and so many diffuse ones.
    pub fn new(max_fluid: u32, max_particles: u32) -> Self {
        Self { max_fluid, max_stride: 16, max_particles }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        for (field, value) in [
            ("GenerateConfig.max_fluid", self.max_fluid),
            ("GenerateConfig.max_particles", self.max_particles),
        ] {
            if value == 0 {
                return Err(Error::bad(field, "zero; it sizes the buffers"));
            }
        }
        if self.max_stride < 12 || !self.max_stride.is_multiple_of(4) {
            let why = format!("{}: a multiple of 4 from 12 on expected", self.max_stride);
            return Err(Error::bad("GenerateConfig.max_stride", why));
        }
        Ok(())
    }
}

/// From where on a potential makes diffuse particles, and where it does so fully (`τmin`, `τmax` of Eq. 1): they
/// do not transfer between simulations. The source's limits are an artist's; the 99.9th percentile of a
/// sequence's potentials ([`Generator::potentials`](super::Generator::potentials)) and a tenth of it do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// None is made up to it, [0, most).
    pub least: f32,
    /// From it on as many as the rate says, (least, ∞).
    pub most: f32,
}

/// What of a fluid turns into spray, foam and bubbles, and what becomes of them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GenerateSettings {
    /// Spacing of the fluid's particles, scene units, (0, ∞). Neighbours are nearer than two.
    pub spacing: f32,
    /// Limits of the speed at which neighbours meet, weighted and summed (Sec. 3.1.1), scene units per second.
    pub trapped_air: Limits,
    /// Limits of how much the surface bends where it moves outwards (Sec. 3.1.2), no unit.
    pub wave_crest: Limits,
    /// Limits of half the squared speed (Sec. 3.1.3 per mass), squared scene units per second.
    pub energy: Limits,
    /// Diffuse particles a second that a particle of the fluid makes of trapped air at most, [0, 1e18]; of all it
    /// makes 64 a step at most.
    pub trapped_air_rate: f32,
    /// The same of wave crests.
    pub wave_crest_rate: f32,
    /// Seconds that foam lives, least and most, (0, ∞), default 2 and 5; spray and bubbles do not age.
    pub lifetime: [f32; 2],
    /// Acceleration, scene units per second squared, default (0, −9.81, 0).
    pub gravity: [f32; 3],
    /// How many times gravity lifts a bubble, [0, 64], default 2 (k_b of Eq. 7).
    pub buoyancy: f32,
    /// What share of the water's velocity a bubble takes on in a step, [0, 1], default 0.8 (k_d of Eq. 7).
    pub drag: f32,
    /// Box outside of which none lives, least and most corner; default `None`: spray, which does not age, falls for
    /// ever then, and its room is not free.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Of the random numbers.
    pub seed: u32,
}

impl GenerateSettings {
    /// With the earth's gravity in a world of so many units a metre with a direction up, of unit length.
    #[must_use]
    pub fn with_gravity(self, units_per_metre: f32, up: [f32; 3]) -> Self {
        Self { gravity: up.map(|v| -9.81 * units_per_metre * v), ..self }
    }

    /// The defaults for limits of trapped air, wave crests and energy, and a rate of both.
    pub fn new(spacing: f32, limits: [Limits; 3], rate: f32) -> Self {
        let [trapped_air, wave_crest, energy] = limits;
        Self {
            spacing,
            trapped_air,
            wave_crest,
            energy,
            trapped_air_rate: rate,
            wave_crest_rate: rate,
            lifetime: [2.0, 5.0],
            gravity: [0.0, -9.81, 0.0],
            buoyancy: 2.0,
            drag: 0.8,
            bounds: None,
            seed: 0,
        }
    }

    /// Checks the ranges; the message names the field.
    /// What each step checks: for a host that wants to know before.
    ///
    /// # Errors
    /// What is not in the range that its field tells.
    pub fn check(&self) -> Result<(), Error> {
        let most = 1.0e18;
        range("GenerateSettings.spacing", self.spacing, 1.0e-18, 1.0e18)?;
        for (field, limits) in [
            ("GenerateSettings.trapped_air", self.trapped_air),
            ("GenerateSettings.wave_crest", self.wave_crest),
            ("GenerateSettings.energy", self.energy),
        ] {
            let Limits { least, most } = limits;
            if !(least >= 0.0 && most > least && most.is_finite() && (most - least) > 1.0e-30) {
                let why = format!("{least} to {most}: from 0 on, the second more than the first");
                return Err(Error::bad(field, why));
            }
        }
        range("GenerateSettings.trapped_air_rate", self.trapped_air_rate, 0.0, most)?;
        range("GenerateSettings.wave_crest_rate", self.wave_crest_rate, 0.0, most)?;
        let [short, long] = self.lifetime;
        if !(short > 0.0 && long >= short && long <= GREATEST) {
            let why = format!("{short} to {long}: seconds expected, the second no less");
            return Err(Error::bad("GenerateSettings.lifetime", why));
        }
        range("GenerateSettings.buoyancy", self.buoyancy, 0.0, 64.0)?;
        range("GenerateSettings.drag", self.drag, 0.0, 1.0)?;
        if !self.gravity.iter().all(|v| v.is_finite()) {
            let why = format!("{:?}: not finite", self.gravity);
            return Err(Error::bad("GenerateSettings.gravity", why));
        }
        if let Some([low, high]) = self.bounds
            && !low.iter().zip(high).all(|(low, high)| *low <= high)
        {
            let why = format!("{low:?} to {high:?}: the least corner first");
            return Err(Error::bad("GenerateSettings.bounds", why));
        }
        Ok(())
    }
}
