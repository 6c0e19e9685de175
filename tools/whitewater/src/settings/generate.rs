//! Table `[generate]`, for `--whitewater generate`.

use serde::{Deserialize, Serialize};
use whitewater::{GeneratorSettings, PotentialRange};

use super::table::table;

table! {
    /// Table `[generate]`.
    GenerateTable of GeneratorSettings
    keys {
        trapped_air: Span,
        wave_crest: Span,
        energy: Span,
        min_lifetime: f32,
        max_lifetime: f32,
        gravity: [f32; 3],
        buoyancy: f32,
        drag: f32,
        seed: u32,
    }
    optional {}
    not { spacing, trapped_air_rate, wave_crest_rate, bounds }
    beside {
        max_particles: u32,
        /// Emission rates by trapped air and by wave crests, particles per second.
        rates: [f32; 2],
    }
}

/// Lower and upper limit of a potential.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Span([f32; 2]);

impl From<Span> for PotentialRange {
    fn from(Span([least, most]): Span) -> Self {
        Self { min: least, max: most }
    }
}

impl From<PotentialRange> for Span {
    fn from(PotentialRange { min: least, max: most }: PotentialRange) -> Self {
        Self([least, most])
    }
}

impl GenerateTable {
    /// Applies the table to settings.
    pub fn apply(&self, settings: &mut GeneratorSettings) {
        self.put(settings);
        if let Some([trapped_air, wave_crest]) = self.rates {
            settings.trapped_air_rate = trapped_air;
            settings.wave_crest_rate = wave_crest;
        }
    }

    /// The complete table of settings and the max number of particles.
    pub fn all(settings: &GeneratorSettings, max_particles: u32) -> Self {
        Self {
            max_particles: Some(max_particles),
            rates: Some([settings.trapped_air_rate, settings.wave_crest_rate]),
            ..Self::of(settings)
        }
    }
}
