//! Table `[generate]`: of `--whitewater generate`.

use serde::Deserialize;
use whitewater::foam::{GenerateSettings, Limits};

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GenerateTable {
    pub max_particles: Option<u32>,
    pub trapped_air: Option<[f32; 2]>,
    pub wave_crest: Option<[f32; 2]>,
    pub energy: Option<[f32; 2]>,
    /// Of trapped air and of wave crests, particles a second.
    pub rates: Option<[f32; 2]>,
    lifetime: Option<[f32; 2]>,
    gravity: Option<[f32; 3]>,
    buoyancy: Option<f32>,
    drag: Option<f32>,
    seed: Option<u32>,
}

impl GenerateTable {
    /// Puts what the table says over settings.
    pub fn apply(&self, settings: &mut GenerateSettings) {
        let limits = |[least, most]: [f32; 2]| Limits { least, most };
        settings.trapped_air = self.trapped_air.map_or(settings.trapped_air, limits);
        settings.wave_crest = self.wave_crest.map_or(settings.wave_crest, limits);
        settings.energy = self.energy.map_or(settings.energy, limits);
        if let Some([trapped_air, wave_crest]) = self.rates {
            settings.trapped_air_rate = trapped_air;
            settings.wave_crest_rate = wave_crest;
        }
        settings.lifetime = self.lifetime.unwrap_or(settings.lifetime);
        settings.gravity = self.gravity.unwrap_or(settings.gravity);
        settings.buoyancy = self.buoyancy.unwrap_or(settings.buoyancy);
        settings.drag = self.drag.unwrap_or(settings.drag);
        settings.seed = self.seed.unwrap_or(settings.seed);
    }
}
