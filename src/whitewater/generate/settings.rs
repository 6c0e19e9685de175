//! Settings of whitewater emission (Ihmsen et al. 2012).

use crate::error::Error;
use crate::water::settings::{GREATEST, range};

crate::contract::with!(GeneratorConfig, GeneratorSettings);

/// Configuration of a [`Generator`](super::Generator). It determines how much memory is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct GeneratorConfig {
    /// Maximum number of fluid particles per step, at least 1.
    pub max_fluid: u32,
    /// Maximum stride in bytes of the buffers with the fluid particles' attributes, a multiple of 4, at least 12,
    /// default 16.
    pub max_stride: u32,
    /// Maximum number of whitewater particles alive at a time, at least 1. Particles beyond it are not emitted, but
    /// counted ([`Generator::counts`](super::Generator::counts)).
    pub max_particles: u32,
}

impl GeneratorConfig {
    /// The defaults for these maximum numbers of fluid and whitewater particles.
    pub fn new(max_fluid: u32, max_particles: u32) -> Self {
        Self { max_fluid, max_stride: 16, max_particles }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        for (field, value) in [
            ("GeneratorConfig.max_fluid", self.max_fluid),
            ("GeneratorConfig.max_particles", self.max_particles),
        ] {
            if value == 0 {
                return Err(Error::bad(field, "zero; it sizes the buffers"));
            }
        }
        if self.max_stride < 12 || !self.max_stride.is_multiple_of(4) {
            let why = format!("expected a multiple of 4 of at least 12, found {}", self.max_stride);
            return Err(Error::bad("GeneratorConfig.max_stride", why));
        }
        Ok(())
    }
}

/// Range of a potential over which emission rises linearly from none to the full rate (`τmin`, `τmax` of Eq. 1). The
/// paper's limits are an artist's choice, and limits that suit one simulation do not suit another. To find them, once
/// per simulation: record steps with any limits and a rate of 0, over frames in which the water moves fast; copy the
/// [`potentials`](super::Generator::potentials) to the host after each; then call
/// [`record_reset`](super::Generator::record_reset). A good maximum is the 99.9th percentile of a potential over these
/// frames; a good minimum is a tenth of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PotentialRange {
    /// Potential up to which nothing is emitted, [0, max).
    pub min: f32,
    /// Potential from which the full rate applies, (min, ∞).
    pub max: f32,
}

/// How a fluid emits spray, foam and bubbles, and how these move and age.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct GeneratorSettings {
    /// Spacing of the fluid's particles, scene units, (0, ∞). Particles nearer than two spacings are
    /// neighbours.
    pub spacing: f32,
    /// Range of the trapped-air potential (Ihmsen et al. 2012, Sec. 3.1.1) over which its emission rises from none to
    /// the full rate, scene units per second. The potential of a particle is a sum over its neighbours: the relative
    /// speed, weighted by a kernel of the distance and by a factor from 0 (the two move straight apart) to 2 (straight
    /// towards each other).
    pub trapped_air: PotentialRange,
    /// Range of the wave-crest potential (Sec. 3.1.2) over which the emission from wave crests rises from none to the
    /// full rate. The potential measures convex curvature, has no unit, and counts only where the surface moves
    /// outwards.
    pub wave_crest: PotentialRange,
    /// Range of the energy potential (Sec. 3.1.3), in (scene units per second)²: half the squared speed, which is the
    /// kinetic energy per mass. Over this range a factor on the emission from both other potentials rises from 0 to
    /// 1.
    pub energy: PotentialRange,
    /// Maximum emission of one fluid particle from trapped air, particles per second, [0, 1e12]. It is reached where
    /// both the trapped-air and the energy potential are at or above the maximum of their range. From all causes
    /// together, a fluid particle emits at most 64 particles per step.
    pub trapped_air_rate: f32,
    /// Maximum emission of one fluid particle from wave crests, particles per second, [0, 1e12]. It is reached where
    /// both the wave-crest and the energy potential are at or above the maximum of their range.
    pub wave_crest_rate: f32,
    /// Minimum lifetime of foam, seconds, (0, max_lifetime], default 2. Spray and bubbles do not age.
    pub min_lifetime: f32,
    /// Maximum lifetime of foam, seconds, [min_lifetime, ∞), default 5.
    pub max_lifetime: f32,
    /// Acceleration, scene units per second squared, default (0, −9.81, 0). Its length also sets the range of the
    /// fixed-point sums over neighbours: no neighbour counts with more than 512 √(length ·
    /// [`spacing`](Self::spacing)) scene units per second. A length of 0 counts as 9.81 there.
    pub gravity: [f32; 3],
    /// Acceleration of a bubble against gravity, as a multiple of [`gravity`](Self::gravity), [0, 64], default 2 (k_b
    /// of Eq. 7). It is the net acceleration, apart from [`drag`](Self::drag): gravity does not act on bubbles
    /// besides.
    pub buoyancy: f32,
    /// Share of the difference between the water's velocity and a bubble's velocity that the bubble takes on in each
    /// step, whatever the step's duration, [0, 1], default 0.8 (k_d of Eq. 7).
    pub drag: f32,
    /// Box (minimum and maximum corner) outside which whitewater particles are removed. With `None` (default), spray,
    /// which does not age, falls forever, and each particle of it occupies one of `max_particles`.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Seed of the random numbers, any value, default 0.
    pub seed: u32,
}

impl GeneratorSettings {
    /// These settings with the earth's gravity in scene units, from the number of scene units per metre and an up
    /// direction of unit length.
    #[must_use]
    pub fn with_gravity(self, units_per_metre: f32, up: [f32; 3]) -> Self {
        Self { gravity: up.map(|v| -9.81 * units_per_metre * v), ..self }
    }

    /// The defaults for a [`spacing`](Self::spacing) of the fluid's particles, with these limits of trapped air, wave
    /// crests and energy (in this order). `rate`, in particles per second, is the maximum emission of one fluid
    /// particle from trapped air, and also its maximum emission from wave crests; both together can reach twice the
    /// rate. A rate of 10 to 100 is a good start: a splash of ten thousand fluid particles then gives on the order of
    /// ten thousand whitewater particles.
    pub fn new(spacing: f32, limits: [PotentialRange; 3], rate: f32) -> Self {
        let [trapped_air, wave_crest, energy] = limits;
        Self {
            spacing,
            trapped_air,
            wave_crest,
            energy,
            trapped_air_rate: rate,
            wave_crest_rate: rate,
            min_lifetime: 2.0,
            max_lifetime: 5.0,
            gravity: [0.0, -9.81, 0.0],
            buoyancy: 2.0,
            drag: 0.8,
            bounds: None,
            seed: 0,
        }
    }

    /// Checks the ranges, as each step does.
    ///
    /// # Errors
    /// [`Error::BadInput`] with the field that is out of its documented range.
    pub fn check(&self) -> Result<(), Error> {
        range("GeneratorSettings.spacing", self.spacing, 1.0e-18, GREATEST)?;
        for (field, limits) in [
            ("GeneratorSettings.trapped_air", self.trapped_air),
            ("GeneratorSettings.wave_crest", self.wave_crest),
            ("GeneratorSettings.energy", self.energy),
        ] {
            let PotentialRange { min: least, max: most } = limits;
            if !(least >= 0.0 && most > least && most.is_finite() && (most - least) > 1.0e-30) {
                let why = format!(
                    "expected values from 0 on, the second above the first, found {least} to {most}"
                );
                return Err(Error::bad(field, why));
            }
        }
        range("GeneratorSettings.trapped_air_rate", self.trapped_air_rate, 0.0, GREATEST)?;
        range("GeneratorSettings.wave_crest_rate", self.wave_crest_rate, 0.0, GREATEST)?;
        let (short, long) = (self.min_lifetime, self.max_lifetime);
        if !(short > 0.0 && long >= short && long <= GREATEST) {
            let why = format!(
                "expected seconds, the second no less than the first, found {short} to {long}"
            );
            return Err(Error::bad("GeneratorSettings.max_lifetime", why));
        }
        range("GeneratorSettings.buoyancy", self.buoyancy, 0.0, 64.0)?;
        range("GeneratorSettings.drag", self.drag, 0.0, 1.0)?;
        if !self.gravity.iter().all(|v| v.is_finite()) {
            let why = format!("{:?}: not finite", self.gravity);
            return Err(Error::bad("GeneratorSettings.gravity", why));
        }
        if let Some([low, high]) = self.bounds
            && !low.iter().zip(high).all(|(low, high)| *low <= high)
        {
            let why = format!("expected the least corner first, found {low:?} to {high:?}");
            return Err(Error::bad("GeneratorSettings.bounds", why));
        }
        Ok(())
    }
}
