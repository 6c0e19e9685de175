//! Tables `[water]`, `[surface_foam]`, `[spray]`, `[shadow]`, `[noise]` and `[light]`.

use serde::{Deserialize, Serialize};
use whitewater::water::{
    Amplitude, Bed, Compositing, Convolution, Ellipsoids, Exit, Fresnel, Kernels, Medium,
    ShadowFilter, Shadows, WaterSettings, Wavelets,
};
use whitewater::water::{SpraySettings, SurfaceFoamSettings, SurfaceNoiseSettings, WeberSettings};
use whitewater::{Config, Light};

use super::medium::{Liquid, MediumName};
use super::table::{table, words};
use crate::args::Foaming;

table! {
    /// Table `[water]`.
    WaterTable of WaterSettings
    keys {
        spacing: f32,
        rest_density: f32,
        density_threshold: f32,
        density_full: f32,
        smoothing_width: f32,
        depth_falloff: f32,
        amplitude: AmplitudeWord,
        fresnel: FresnelTable,
        compositing: CompositingWord,
        bed: BedWord,
        refraction: f32,
        specular: f32,
        shininess: f32,
    }
    optional {}
    not { medium, ellipsoids, wavelets }
    beside {
        medium: MediumTable,
        /// Steps of the march for reflections, which configure pass `composite` and are not part of the settings.
        mirror_steps: u32,
        exit: ExitWord,
        kernels: KernelWord,
    }
}

words!(AmplitudeWord of Amplitude { Volume, Source });
words!(CompositingWord of Compositing { Mixed, Source });
words!(ExitWord of Exit { TwoInterfaces, Straight });
words!(KernelWord of Kernels { Spheres, Ellipsoids });
words!(BedWord of Bed { Submerged, Source });

/// A medium by name or by its coefficients.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(
    untagged,
    expecting = "medium: expected clear, pool, lake, ocean, river, glacier, milk, beer, honey, blood, lava or source, also as \
                 'beer:0.05', {absorption=[r,g,b], scattering=[r,g,b]}, {absorption=[r,g,b], reduced_scattering=[r,g,b]} or \
                 {base=[r,g,b], falloff=[r,g,b,a]}"
)]
pub enum MediumTable {
    Named(MediumName),
    Physical(Physical),
    Turbid(Turbid),
    Source(Source),
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Physical {
    absorption: [f32; 3],
    scattering: [f32; 3],
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Turbid {
    absorption: [f32; 3],
    reduced_scattering: [f32; 3],
    #[serde(default)]
    emission: [f32; 3],
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Source {
    base: [f32; 3],
    falloff: [f32; 4],
}

impl MediumTable {
    /// The medium, for particles of this spacing.
    fn medium(self, spacing: f32) -> Medium {
        match self {
            Self::Named(name) => name.medium(spacing),
            Self::Physical(Physical { absorption, scattering }) => {
                Medium::Physical { absorption, scattering }
            }
            Self::Turbid(Turbid { absorption, reduced_scattering, emission }) => {
                Medium::Turbid { absorption, scattering: reduced_scattering, emission }
            }
            Self::Source(Source { base, falloff }) => Medium::Source { base, falloff },
        }
    }
}

impl From<Medium> for MediumTable {
    fn from(medium: Medium) -> Self {
        match medium {
            Medium::Physical { absorption, scattering } => {
                Self::Physical(Physical { absorption, scattering })
            }
            Medium::Turbid { absorption, scattering, emission } => {
                Self::Turbid(Turbid { absorption, reduced_scattering: scattering, emission })
            }
            Medium::Source { base, falloff } => Self::Source(Source { base, falloff }),
        }
    }
}

/// Reflectance, by the numbers of either form.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(untagged, expecting = "fresnel: expected {f0=0.02} or {bias=0.1, scale=0.4, power=2}")]
pub enum FresnelTable {
    Schlick(Schlick),
    Source(Biased),
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Schlick {
    f0: f32,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Biased {
    bias: f32,
    scale: f32,
    power: f32,
}

impl From<FresnelTable> for Fresnel {
    fn from(table: FresnelTable) -> Self {
        match table {
            FresnelTable::Schlick(Schlick { f0 }) => Self::Schlick { f0 },
            FresnelTable::Source(Biased { bias, scale, power }) => {
                Self::Source { bias, scale, power }
            }
        }
    }
}

impl From<Fresnel> for FresnelTable {
    fn from(fresnel: Fresnel) -> Self {
        match fresnel {
            Fresnel::Schlick { f0 } => Self::Schlick(Schlick { f0 }),
            Fresnel::Source { bias, scale, power } => Self::Source(Biased { bias, scale, power }),
        }
    }
}

impl WaterTable {
    /// The liquid of a named medium.
    pub fn liquid(&self) -> Option<Liquid> {
        match self.medium {
            Some(MediumTable::Named(name)) => Some(name.liquid()),
            _ => None,
        }
    }

    /// Applies the table, including the medium, to settings.
    pub fn apply(&self, water: &mut WaterSettings) {
        self.put(water);
        water.medium = self.medium.map_or(water.medium, |medium| medium.medium(water.spacing));
    }

    /// Steps of the march for reflections of the scene; the default depends on the preset.
    pub fn mirror_steps(&self, thesis: bool) -> u32 {
        let standard = Config::new(Default::default(), Default::default(), 0).mirror_steps;
        self.mirror_steps.unwrap_or(if thesis { 0 } else { standard })
    }

    /// Makes light go straight on where it leaves water for air ([`Exit::Straight`]), unless the settings file sets
    /// `exit`.
    pub fn leave_straight(&mut self) {
        self.exit.get_or_insert(Exit::Straight.into());
    }

    pub fn exit(&self, straight: bool) -> Exit {
        let standard = Config::new(Default::default(), Default::default(), 0).exit;
        self.exit.map_or(if straight { Exit::Straight } else { standard }, Into::into)
    }

    /// Shape of the drawn particles (spheres or ellipsoids); the default depends on the preset.
    pub fn kernels(&self, thesis: bool) -> Kernels {
        let standard = if thesis { Kernels::Spheres } else { Kernels::Ellipsoids };
        self.kernels.map_or(standard, Into::into)
    }

    /// Whether the table sets that shape.
    pub fn says_kernels(&self) -> bool {
        self.kernels.is_some()
    }

    /// The complete table, with this table's configuration of passes. `matte`: only the water was drawn.
    pub fn all(&self, water: &WaterSettings, thesis: bool, matte: bool) -> Self {
        Self {
            medium: Some(water.medium.into()),
            mirror_steps: Some(self.mirror_steps(thesis)),
            exit: Some(self.exit(thesis || matte).into()),
            kernels: Some(self.kernels(thesis).into()),
            ..Self::of(water)
        }
    }
}

table! {
    /// Table `[ellipsoids]`, for particles with `[water] kernels = 'ellipsoids'`.
    EllipsoidTable of Ellipsoids
    keys { reach: f32, ratio: f32, fewest: f32, lone: f32, centred: f32 }
    optional {}
    not {}
    beside {}
}

table! {
    /// Table `[wavelets]`: small waves on level water.
    WaveletTable of Wavelets
    keys { slope: f32, length: f32, gravity: f32 }
    optional {}
    not { time }
    beside {}
}

table! {
    /// Table `[surface_foam]`.
    SurfaceFoamTable of SurfaceFoamSettings
    keys {
        extinction: f32,
        front_extinction: f32,
        front_depth: f32,
        motion_threshold: f32,
        noise: f32,
        noise_rate: f32,
        pattern: f32,
        pattern_size: f32,
        pattern_period: f32,
        lace: f32,
        lace_size: f32,
        lace_shade: f32,
        aeration: f32,
        aerated_color: [f32; 3],
        front_power: f32,
        min_thickness: f32,
        few_neighbours: [f32; 2],
        normal_strength: f32,
        shape: f32,
        shadow: f32,
        back_color: [f32; 3],
        front_color: [f32; 3],
    }
    optional {}
    not { time }
    beside {
        /// This key and the following ones are not part of the look; they set which water foams. `by` selects the
        /// speed in the Weber number.
        by: FoamBy,
        /// Speed of the eddies that particles do not resolve, divided by the particle's speed relative to the frame's
        /// mean velocity, 0 to 1; only with `by` of air. Where neighbours move alike there are no eddies. Default 0.17.
        turbulence: f32,
        /// Unit of the Weber number.
        weber: Weber,
        /// Weber number from which water foams, unless the command line sets it.
        threshold: f32,
        /// Mean lifetime of foam in seconds.
        lifetime: f32,
        /// Velocity of the air, scene units per second.
        air: [f32; 3],
        /// Seed of the random lifetimes.
        seed: u32,
    }
}

/// Unit of the Weber number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Weber {
    /// The Weber number as the source's demo reduces it, which does not depend on the unit of length.
    Reduced,
    /// `ρ v² l / σ` in SI units.
    Full,
}

/// The speed in the Weber number that decides which water foams.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FoamBy {
    /// The speed at which neighbours approach a particle is the speed in the Weber number: trapped air (Ihmsen et al.
    /// 2012).
    Air,
    /// The particle's speed through the air (Bagar 2010).
    Speed,
}

impl SurfaceFoamTable {
    /// Returns the speed in the Weber number, from `by` in the settings file. By default it is that of trapped air,
    /// but the particles' own speed with the thesis' preset, a threshold or wind.
    pub fn by(&self, wanted: Foaming, thesis: bool) -> FoamBy {
        let own = thesis || self.threshold.is_some() || self.air.is_some();
        let own = own || matches!(wanted, Foaming::From(_));
        self.by.unwrap_or(if own { FoamBy::Speed } else { FoamBy::Air })
    }

    /// Settings of foam formation; the threshold is the table's, or 1.
    pub fn formation(&self, water: &WaterSettings) -> WeberSettings {
        let threshold = self.threshold.unwrap_or(1.0);
        let standard = match self.weber {
            Some(Weber::Full) => WeberSettings::weber(water.spacing, threshold),
            Some(Weber::Reduced) | None => WeberSettings::reduced(water.spacing, threshold),
        };
        standard.with(|it| {
            it.foam_lifetime = self.lifetime.unwrap_or(standard.foam_lifetime);
            it.air = self.air.unwrap_or(standard.air);
            it.seed = self.seed.unwrap_or(standard.seed);
            it.rest_density = water.rest_density;
        })
    }

    /// Returns the complete table: the look from `look`; threshold, lifetime, air and seed from `found` or, without
    /// it, from this table; `by`, `turbulence` and `weber` from this table. What the table lacks is the default.
    pub fn all(&self, look: &SurfaceFoamSettings, found: Option<&WeberSettings>) -> Self {
        let said = self.formation(&WaterSettings::default());
        // The other values are found, or follow from the spacing.
        let WeberSettings { foam_lifetime, air, seed, .. } = *found.unwrap_or(&said);
        Self {
            by: Some(self.by.unwrap_or(FoamBy::Speed)),
            turbulence: Some(self.turbulence.unwrap_or(0.0)),
            weber: Some(self.weber.unwrap_or(Weber::Reduced)),
            threshold: found.map_or(self.threshold, |found| Some(found.threshold)),
            lifetime: Some(foam_lifetime),
            air: Some(air),
            seed: Some(seed),
            ..Self::of(look)
        }
    }
}

table! {
    /// Table `[spray]`.
    SprayTable of SpraySettings
    keys {
        opacity: f32,
        size: f32,
        max_angle: f32,
        droplets: u32,
        all_spray_density: f32,
        full_water_density: f32,
        no_spray_density: f32,
        scatter_radius: f32,
        stretch: f32,
        mist: f32,
        mist_size: f32,
        clumps: f32,
        strand_ratio: f32,
        few_neighbours: [f32; 2],
        shade: f32,
        scattering: f32,
        relief: f32,
        glints: f32,
        exposure: f32,
        color: [f32; 3],
        additive: bool,
    }
    optional {}
    not {}
    beside {}
}

table! {
    /// Table `[shadow]`, for the scene's shadow map. The last four keys determine passes.
    ShadowTable of ShadowFilter
    keys { width: f32, damping: f32, offset: f32, scale: f32 }
    optional {}
    not {}
    beside { filter: FilterWord, terms: u32, texels: u32, bits: u32 }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FilterWord {
    Pcf,
    Convolution,
}

impl ShadowTable {
    /// Filter of the scene's shadow map; the default depends on the preset.
    pub fn passes(&self, thesis: bool) -> Shadows {
        match self.filtered(thesis) {
            FilterWord::Convolution => Shadows::Convolution(self.convolution()),
            FilterWord::Pcf => Shadows::Map,
        }
    }

    fn filtered(&self, thesis: bool) -> FilterWord {
        let standard = if thesis { FilterWord::Convolution } else { FilterWord::Pcf };
        self.filter.unwrap_or(standard)
    }

    fn convolution(&self) -> Convolution {
        let Convolution { terms, texels, bits } = Convolution::default();
        Convolution {
            terms: self.terms.unwrap_or(terms),
            texels: self.texels.unwrap_or(texels),
            bits: self.bits.unwrap_or(bits),
        }
    }

    /// The complete table of a filter, with this table's configuration of passes.
    pub fn all(&self, filter: &ShadowFilter, thesis: bool) -> Self {
        let Convolution { terms, texels, bits } = self.convolution();
        Self {
            filter: Some(self.filtered(thesis)),
            terms: Some(terms),
            texels: Some(texels),
            bits: Some(bits),
            ..Self::of(filter)
        }
    }
}

table! {
    /// Table `[noise]`.
    NoiseTable of SurfaceNoiseSettings
    keys {
        weight: f32,
        falloff: f32,
        size: f32,
        cells: f32,
        airborne: f32,
        foam: f32,
        color: [f32; 3],
    }
    optional {}
    not {}
    beside {}
}

table! {
    /// Table `[light]`.
    LightTable of Light
    keys {
        direction: [f32; 3],
        color: [f32; 3],
        ambient: [f32; 3],
        irradiance: [f32; 3],
        shade: [f32; 3],
    }
    optional {}
    not {}
    beside {}
}
