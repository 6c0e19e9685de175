//! Table `[whitewater]`.

use serde::{Deserialize, Serialize};
use whitewater::{
    Occlusion, OcclusionReach, ShadowMixing, Submerged, WhitewaterSettings, WhitewaterSplat,
};

use super::table::{table, words};

table! {
    /// Table `[whitewater]`.
    WhitewaterTable of WhitewaterSettings
    keys {
        radius: f32,
        submerged: SubmergedTable,
        half_intensity_thickness: f32,
        exponent: f32,
        passes: u32,
        search_radius: f32,
        search_radius_step: f32,
        sample_density: f32,
        min_samples: u32,
        max_samples: u32,
        reach: ReachTable,
        fluid_opacity: f32,
        scene_opacity: f32,
        shadow_scale: f32,
        shadow_exponent: f32,
        shadow_offset: f32,
        shadow_color: [f32; 3],
        albedo: [f32; 3],
        scale: f32,
        foam_shape: [f32; 2],
        spray_shape: [f32; 2],
        bubble_shape: [f32; 2],
        life: [f32; 2],
        sizes: u32,
        bubble_size: f32,
        blur: f32,
        mixing: MixingWord,
    }
    optional {}
    not {}
    beside {
        /// Radii of foam, spray and bubbles from files; they replace `radius`.
        radii: [f32; 3],
        /// Number of particles that are drawn for each particle of a file, scattered around it.
        copies: u32,
        /// The keys `occlusion` and `splat` determine which passes run; they are not part of the
        /// look.
        occlusion: OcclusionWord,
        splat: SplatWord,
    }
}

words!(MixingWord of ShadowMixing { Scaled, Source });
words!(OcclusionWord of Occlusion { Reference, Fast });
words!(SplatWord of WhitewaterSplat { Raster, Compute, Compute64 });

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SubmergedTable {
    Water,
    Falloff { depth: f32, n: f32, m: f32 },
}

impl From<SubmergedTable> for Submerged {
    fn from(table: SubmergedTable) -> Self {
        match table {
            SubmergedTable::Water => Self::Water,
            SubmergedTable::Falloff { depth, n, m } => Self::Falloff { depth, n, m },
        }
    }
}

impl From<Submerged> for SubmergedTable {
    fn from(submerged: Submerged) -> Self {
        match submerged {
            Submerged::Water => Self::Water,
            Submerged::Falloff { depth, n, m } => Self::Falloff { depth, n, m },
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReachTable {
    Radii(f32),
    Metres(f32),
}

impl From<ReachTable> for OcclusionReach {
    fn from(table: ReachTable) -> Self {
        match table {
            ReachTable::Radii(radii) => Self::Radii(radii),
            ReachTable::Metres(metres) => Self::Metres(metres),
        }
    }
}

impl From<OcclusionReach> for ReachTable {
    fn from(reach: OcclusionReach) -> Self {
        match reach {
            OcclusionReach::Radii(radii) => Self::Radii(radii),
            OcclusionReach::Metres(metres) => Self::Metres(metres),
        }
    }
}

impl WhitewaterTable {
    /// How ambient occlusion is sampled.
    pub fn occlusion(&self) -> Occlusion {
        self.occlusion.map_or(Occlusion::Fast, Into::into)
    }

    /// How particles are rasterized; `None` is the library's choice.
    pub fn splat(&self) -> Option<WhitewaterSplat> {
        self.splat.map(Into::into)
    }

    /// The complete table of a look, with this table's configuration of passes.
    pub fn all(&self, look: &WhitewaterSettings) -> Self {
        let Self { radii, copies, splat, .. } = *self;
        Self { occlusion: Some(self.occlusion().into()), radii, copies, splat, ..Self::of(look) }
    }
}
