//! Table `[diffuse]`.

use serde::Deserialize;
use whitewater::foam::{DiffuseLook, Mixing, Occlusion, Reach, Splat, Submerged};

#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DiffuseTable {
    radius: Option<f32>,
    submerged: Option<SubmergedTable>,
    half: Option<f32>,
    exponent: Option<f32>,
    passes: Option<u32>,
    search: Option<[f32; 2]>,
    density: Option<f32>,
    samples: Option<[u32; 2]>,
    reach: Option<ReachTable>,
    opacity: Option<[f32; 2]>,
    shadow: Option<[f32; 3]>,
    shadow_color: Option<[f32; 3]>,
    albedo: Option<[f32; 3]>,
    mixing: Option<MixingTable>,
    /// Not of the look, as the next: they choose passes.
    occlusion: Option<OcclusionTable>,
    splat: Option<SplatTable>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum SubmergedTable {
    Water,
    Falloff { most: f32, n: f32, m: f32 },
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ReachTable {
    Radii(f32),
    Metres(f32),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum MixingTable {
    Scaled,
    Source,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum OcclusionTable {
    Reference,
    Fast,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SplatTable {
    Raster,
    Compute,
    Compute64,
}

impl DiffuseTable {
    /// How the shadow is sampled.
    pub fn occlusion(&self) -> Occlusion {
        match self.occlusion {
            Some(OcclusionTable::Reference) => Occlusion::Reference,
            Some(OcclusionTable::Fast) | None => Occlusion::Fast,
        }
    }

    /// How particles become pixels; `None`: as the library chooses.
    pub fn splat(&self) -> Option<Splat> {
        self.splat.map(|table| match table {
            SplatTable::Raster => Splat::Raster,
            SplatTable::Compute => Splat::Compute,
            SplatTable::Compute64 => Splat::Compute64,
        })
    }

    /// Puts what the table says over a look.
    pub fn apply(&self, look: &mut DiffuseLook) {
        look.radius = self.radius.unwrap_or(look.radius);
        look.submerged = self.submerged.map_or(look.submerged, |table| match table {
            SubmergedTable::Water => Submerged::Water,
            SubmergedTable::Falloff { most, n, m } => Submerged::Falloff { most, n, m },
        });
        look.half = self.half.unwrap_or(look.half);
        look.exponent = self.exponent.unwrap_or(look.exponent);
        look.passes = self.passes.unwrap_or(look.passes);
        look.search = self.search.unwrap_or(look.search);
        look.density = self.density.unwrap_or(look.density);
        look.samples = self.samples.unwrap_or(look.samples);
        look.reach = self.reach.map_or(look.reach, |table| match table {
            ReachTable::Radii(radii) => Reach::Radii(radii),
            ReachTable::Metres(metres) => Reach::Metres(metres),
        });
        look.opacity = self.opacity.unwrap_or(look.opacity);
        look.shadow = self.shadow.unwrap_or(look.shadow);
        look.shadow_color = self.shadow_color.unwrap_or(look.shadow_color);
        look.albedo = self.albedo.unwrap_or(look.albedo);
        look.mixing = self.mixing.map_or(look.mixing, |table| match table {
            MixingTable::Scaled => Mixing::Scaled,
            MixingTable::Source => Mixing::Source,
        });
    }
}

/// The table of a look.
pub fn to_toml(look: &DiffuseLook) -> String {
    let submerged = match look.submerged {
        Submerged::Water => "'water'".into(),
        Submerged::Falloff { most, n, m } => {
            format!("{{ falloff = {{ most = {most:?}, n = {n:?}, m = {m:?} }} }}")
        }
    };
    let reach = match look.reach {
        Reach::Radii(radii) => format!("{{ radii = {radii:?} }}"),
        Reach::Metres(metres) => format!("{{ metres = {metres:?} }}"),
    };
    let mixing = match look.mixing {
        Mixing::Scaled => "scaled",
        Mixing::Source => "source",
    };
    format!(
        "[diffuse]\nradius = {:?}\nsubmerged = {submerged}\nhalf = {:?}\nexponent = {:?}\n\
         passes = {}\nsearch = {:?}\ndensity = {:?}\nsamples = {:?}\nreach = {reach}\n\
         opacity = {:?}\nshadow = {:?}\nshadow_color = {:?}\nalbedo = {:?}\nmixing = '{mixing}'\n",
        look.radius,
        look.half,
        look.exponent,
        look.passes,
        look.search,
        look.density,
        look.samples,
        look.opacity,
        look.shadow,
        look.shadow_color,
        look.albedo,
    )
}
