//! Table `[diffuse]`.

use serde::{Deserialize, Serialize};
use whitewater::foam::{DiffuseLook, Mixing, Occlusion, Reach, Splat, Submerged};

use super::table::{table, words};

table! {
    /// Table `[diffuse]`.
    DiffuseTable of DiffuseLook
    keys {
        radius: f32,
        submerged: SubmergedTable,
        half: f32,
        exponent: f32,
        passes: u32,
        search: [f32; 2],
        density: f32,
        samples: [u32; 2],
        reach: ReachTable,
        opacity: [f32; 2],
        shadow: [f32; 3],
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
        /// Radii of foam, spray and bubbles of files, in the place of `radius`.
        radii: [f32; 3],
        /// As how many a particle of files is drawn, scattered about its place.
        copies: u32,
        /// Not of the look, as the next: they choose passes.
        occlusion: OcclusionWord,
        splat: SplatWord,
    }
}

words!(MixingWord of Mixing { Scaled, Source });
words!(OcclusionWord of Occlusion { Reference, Fast });
words!(SplatWord of Splat { Raster, Compute, Compute64 });

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SubmergedTable {
    Water,
    Falloff { most: f32, n: f32, m: f32 },
}

impl From<SubmergedTable> for Submerged {
    fn from(table: SubmergedTable) -> Self {
        match table {
            SubmergedTable::Water => Self::Water,
            SubmergedTable::Falloff { most, n, m } => Self::Falloff { most, n, m },
        }
    }
}

impl From<Submerged> for SubmergedTable {
    fn from(submerged: Submerged) -> Self {
        match submerged {
            Submerged::Water => Self::Water,
            Submerged::Falloff { most, n, m } => Self::Falloff { most, n, m },
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ReachTable {
    Radii(f32),
    Metres(f32),
}

impl From<ReachTable> for Reach {
    fn from(table: ReachTable) -> Self {
        match table {
            ReachTable::Radii(radii) => Self::Radii(radii),
            ReachTable::Metres(metres) => Self::Metres(metres),
        }
    }
}

impl From<Reach> for ReachTable {
    fn from(reach: Reach) -> Self {
        match reach {
            Reach::Radii(radii) => Self::Radii(radii),
            Reach::Metres(metres) => Self::Metres(metres),
        }
    }
}

impl DiffuseTable {
    /// How the shadow is sampled.
    pub fn occlusion(&self) -> Occlusion {
        self.occlusion.map_or(Occlusion::Fast, Into::into)
    }

    /// How particles become pixels; `None`: as the library chooses.
    pub fn splat(&self) -> Option<Splat> {
        self.splat.map(Into::into)
    }

    /// The table that says all of a look, and of the passes as this table does.
    pub fn all(&self, look: &DiffuseLook) -> Self {
        let Self { radii, copies, splat, .. } = *self;
        Self { occlusion: Some(self.occlusion().into()), radii, copies, splat, ..Self::of(look) }
    }
}
