//! Settings of the layered water. Lengths scale with the particles: the look does not change with
//! resolution or unit.

/// Drawn radius over particle spacing, as in the source's demo.
pub const RADIUS_PER_SPACING: f32 = 0.656;

/// How particles become pixels. Both ways give the same picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Splat {
    /// Point sprites (quads where a point does not fit) with fixed-function blending.
    Raster,
    /// A compute shader with atomics.
    Compute,
}

/// How the pixels with water are shaded. Both ways give the same picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shading {
    /// A render pass over the tiles that hold water: the output is a colour attachment.
    Raster,
    /// A compute shader over the same tiles: the output is a storage image.
    Compute,
}

/// What the host says of the sun's shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shadows {
    /// A mask of the screen.
    Mask,
    /// A depth map as the light sees the scene, with percentage-closer filtering.
    Map,
    /// The same map, filtered before it is compared: shadows as soft as one likes, at one cost. The pass
    /// `convolution` (convolution shadow maps, which the thesis takes).
    Convolution(Convolution),
}

pub use crate::light::Convolution;

crate::contract::with!(WaterSettings, FoamSettings, FoamLook, SprayLook, ShadowFilter, NoiseLook);

/// Filter of the host's shadow map with [`Shadows::Convolution`] (Annen et al. 2007).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShadowFilter {
    /// Width of the box that the map is filtered by in texels of the map, [0, 256], default 3: the
    /// footprint of [`Shadows::Map`]. Texels of our images are the least there is.
    pub width: f32,
    /// Damping α of the series' terms, [0, 2], default 1. Without, light and shade ring by a twentieth;
    /// with more of it shadows begin later behind what casts them.
    pub damping: f32,
    /// Parts of the rise by which the comparison is moved away from the light, [0, 1]. Default 1: what
    /// touches its occluder is in the sun; 0: half in its shade, where it begins earlier.
    pub offset: f32,
    /// Factor about one half that makes the comparison steeper, [1, 4], default 1.25; it takes from the
    /// soft edge as much. Over 1.04 it clips what is left of the ringing.
    pub scale: f32,
}

impl Default for ShadowFilter {
    fn default() -> Self {
        Self { width: 3.0, damping: 1.0, offset: 1.0, scale: 1.25 }
    }
}

impl ShadowFilter {
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        range("Settings.shadow.width", self.width, 0.0, 256.0)?;
        range("Settings.shadow.damping", self.damping, 0.0, 2.0)?;
        range("Settings.shadow.offset", self.offset, 0.0, 1.0)?;
        range("Settings.shadow.scale", self.scale, 1.0, 4.0)
    }
}

/// How far the composite goes: each holds those before it (the source's debug views).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Ladder {
    /// The scene as it is refracted.
    Background,
    /// And the water behind the frontmost foam.
    BackWater,
    /// And foam.
    Foam,
    /// And the water before it, or all where there is none.
    FrontWater,
    /// And reflections, highlights and spray.
    #[default]
    Whole,
}

/// How many iterations a pixel of the smoothing gets, and how large its steps are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// The source's: r_w / (C d) iterations of curvature-proportional steps (thesis, Sec. 3.1).
    Source,
    /// Mean curvature flow to a constant width along the surface, whatever distance and slant.
    ConstantWidth,
    /// The baseline: the source's step, a fixed count for all pixels (van der Laan et al. 2009).
    Fixed(u32),
}

/// Form of the smoothing. All give the same surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Smoothing {
    /// Raster passes; an occlusion query every fifth iteration stops the rest on the GPU.
    Query(Gate),
    /// A dispatch an iteration, over the tiles that still have active pixels.
    Tiles,
    /// Several iterations a dispatch in shared memory, over the tiles that have active pixels.
    Fused,
}

/// What stops the iterations after the query said so. No gate waits for the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Gate {
    /// An indirect draw count (`drawIndirectCount`).
    DrawCount,
    /// Conditional rendering (`VK_EXT_conditional_rendering`).
    Predicate,
    /// The vertex shader moves the tiles off the screen; needs nothing.
    VertexCull,
}

/// Uniform settings of the layered water.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WaterSettings {
    /// Rest spacing of the particles (twice the solver's particle radius), scene units, [1e-6, ∞).
    pub spacing: f32,
    /// Rest density in the unit of the density stream, [1e-6, ∞), default 1000.
    pub rest_density: f32,
    /// Below this fraction of the rest density a particle is spray: left out (with
    /// [`Config::spray`](crate::Config) [`SprayLook::densities`] count instead). [0, ∞), default
    /// 0.35 (an isolated particle reads 0.318 with the usual cubic spline).
    pub density_threshold: f32,
    /// From this fraction on a particle has its full radius. Default 0.45.
    pub density_full: f32,
    /// Width of the smoothing along the surface in drawn radii, [0, ∞), default 1.5: at 0.7 the
    /// lattice of the particles shows, 2.5 is silk. (`ConstantWidth`; `Source` has its own 4.8.)
    pub smoothing_width: f32,
    /// Depth steps over this many drawn radii are silhouettes, not smoothed over. Default 5.3.
    pub depth_falloff: f32,
    /// Shapes of the particles, with [`Kernels::Ellipsoids`].
    pub ellipsoids: Ellipsoids,
    /// What a particle adds to the thickness.
    pub amplitude: Amplitude,
    /// Optical properties.
    pub medium: Medium,
    /// Fresnel reflectance.
    pub fresnel: Fresnel,
    /// How what the surface mirrors and its highlight come to what is behind. Default [`Compositing::Mixed`].
    pub compositing: Compositing,
    /// How the scene under the water looks. Default [`Bed::Submerged`].
    pub bed: Bed,
    /// Strength of the refraction's displacement, [0, ∞), default 0.25; it tends to a sixteenth of
    /// the picture's height.
    pub refraction: f32,
    /// Strength of the sun's highlight, [0, ∞), default 1.
    pub specular: f32,
    /// Blinn-Phong exponent of the highlight, [1, ∞), default 1500.
    pub shininess: f32,
}

impl Default for WaterSettings {
    fn default() -> Self {
        Self {
            spacing: 0.05,
            rest_density: 1000.0,
            density_threshold: 0.35,
            density_full: 0.45,
            smoothing_width: 1.5,
            depth_falloff: 5.3,
            ellipsoids: Ellipsoids::default(),
            amplitude: Amplitude::Volume,
            medium: Medium::POOL,
            fresnel: Fresnel::Schlick { f0: 0.02 },
            compositing: Compositing::Mixed,
            bed: Bed::Submerged,
            refraction: 0.25,
            specular: 1.0,
            shininess: 1500.0,
        }
    }
}

impl WaterSettings {
    /// The water of the thesis' demo for particles of a spacing: its unit of the thickness, colours, reflectance, highlight
    /// and composite.
    pub fn thesis(spacing: f32) -> Self {
        let Medium::Source { base, falloff } = Medium::source(spacing) else {
            return Self::default();
        };
        Self {
            spacing,
            amplitude: Amplitude::Source,
            // Of a thickness that is so many times the volume's.
            medium: Medium::Source { base, falloff: falloff.map(|k| k / SOURCE_VOLUMES) },
            fresnel: Fresnel::Source { bias: 0.1, scale: 0.4, power: 2.0 },
            compositing: Compositing::Source,
            bed: Bed::Source,
            shininess: 80.0,
            ..Self::default()
        }
    }

    /// Drawn radius of a particle, scene units.
    pub fn radius(&self) -> f32 {
        RADIUS_PER_SPACING * self.spacing
    }
}

/// Particle volumes that a thickness sprite of [`Amplitude::Source`] holds: `0.8·2a·π·J·a²` over spacing³, of a half-axis
/// a of twice the drawn radius and the kernel's integral J = 0.34.
const SOURCE_VOLUMES: f32 = 3.86;

/// How what the surface mirrors and the sun's highlight come to what is behind them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Compositing {
    /// What is mirrored takes the place of as much of the light from behind; the highlight is added. Less of both where
    /// water is thinner than a quarter of the drawn radius. The surface is that of the water before the frontmost foam,
    /// where there is any, else of that behind; foam lies where its middle is.
    Mixed,
    /// The source's (thesis, Listing A.20): both are added to all the light from behind, weighted by
    /// `sat(1 − a_wf + a_f)·(1 − a_wf)`, where `a_wf` and `a_f` are what comes through the water before the frontmost
    /// foam (by [`Medium::Source`]'s last falloff; of a physical medium the mean of the channels) and through the foam.
    /// All foam is at the frontmost, and rays that are mirrored down see the environment's ground.
    Source,
}

/// How the scene looks where it lies under the water: where that fills seven tenths or more of the room before it, the
/// less the nearer to a half.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bed {
    /// As darker as it is for being wet (Lekner and Dorf 1988): by the reflectance of the surface on the way in, its radiance
    /// over n² on the way out, and what is thrown back inside, by a reflectance of its own that is told from its colour and
    /// [`Light::irradiance`](crate::Light::irradiance). Grey of 0.4 keeps 0.65, white all, but for what the medium takes
    /// of the light on its way down, sun and sky, and on its bent way to the eye. The index of refraction n is that of
    /// [`Fresnel::Schlick`]'s f0, else 1.333.
    Submerged,
    /// As if it were dry, behind the water straight on (the thesis).
    Source,
}

/// What is seen through water with air behind it: jets, crowns, drops, sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Exit {
    /// Light is bent where it enters the water and where it leaves it, by the slope of both surfaces and the index of
    /// refraction n that [`Bed`] says, or totally reflected there; what it meets of the scene is looked for on the screen, in 4
    /// steps, and the rest is the environment (Wyman 2005).
    TwoInterfaces,
    /// The scene straight behind, displaced by [`WaterSettings::refraction`] (the thesis), as that is under water with both.
    Straight,
}

/// What of a particle is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kernels {
    /// A sphere, as in the thesis.
    Spheres,
    /// An ellipsoid of the same volume by where its neighbours are (Yu and Turk 2013): flat in a sheet, long in a stream, round inside
    /// the water; as [`WaterSettings::ellipsoids`] says. Of particles in packets all that there are count as neighbours, also those in
    /// no packet. The light's maps, foam, spray, motion vectors, and what tells two sheets apart go by spheres still.
    Ellipsoids,
}

/// How ellipsoids come from neighbours. Of no effect without [`Kernels::Ellipsoids`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoids {
    /// Radius within which particles are neighbours, in spacings, [1, 4], default 2.5. They count by `1 − (d/reach)³`. The time
    /// that the pass takes grows with its cube.
    pub reach: f32,
    /// Longest half-axis over the shortest, at most, [1, 8], default 2.5 (the source: 4). 1: spheres.
    pub ratio: f32,
    /// Sum of the neighbours' weights from which on a particle is an ellipsoid, [0, 64], default 8: there are 2.9 in a line
    /// of particles, 11 in a sheet of one layer, 32 inside. Up to half of it a particle is a sphere, as small drops are (the
    /// source: up to 25 neighbours).
    pub fewest: f32,
    /// Radius of a particle with so few neighbours that it is a sphere, in what it would be, [0.25, 1], default 1 (the
    /// source: 0.5). It holds the same volume.
    pub lone: f32,
    /// How far a particle is drawn on the way to the middle of itself and its neighbours, less what these are on average, at the
    /// surface above all (by the source water would shrink from its walls); [0, 1], default 0.9 as the source. Sheets and
    /// rims are smooth. 0 saves half the time of the pass.
    pub centred: f32,
}

impl Default for Ellipsoids {
    fn default() -> Self {
        Self { reach: 2.5, ratio: 2.5, fewest: 8.0, lone: 1.0, centred: 0.9 }
    }
}

impl Ellipsoids {
    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        range("Settings.water.ellipsoids.reach", self.reach, 1.0, 4.0)?;
        range("Settings.water.ellipsoids.ratio", self.ratio, 1.0, 8.0)?;
        range("Settings.water.ellipsoids.fewest", self.fewest, 0.0, 64.0)?;
        range("Settings.water.ellipsoids.lone", self.lone, 0.25, 1.0)?;
        range("Settings.water.ellipsoids.centred", self.centred, 0.0, 1.0)
    }
}

/// Steps of the march of [`Exit::TwoInterfaces`].
pub(crate) const EXIT_STEPS: u32 = 4;

/// Index of refraction of water.
pub(crate) const WATER_INDEX: f32 = 1.333;

/// Height of a particle's thickness sprite `√(1 − ρ²)·exp(−2ρ²)` at its centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Amplitude {
    /// Its integral over the sprite is the particle's volume, spacing³: the thickness is metres of
    /// water, and does not depend on how many particles resolve it. Default.
    Volume,
    /// The source's 0.8 times the sprite's width (thesis, Listing A.15): a sprite holds about four
    /// particle volumes, and finer particles make more water.
    Source,
}

/// How light is lost and gained on its way through the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Medium {
    /// Beer's law per channel, with single scattering of the ambient light.
    Physical {
        /// Absorption per metre, linear RGB, [0, ∞).
        absorption: [f32; 3],
        /// Scattering per metre, linear RGB, [0, ∞).
        scattering: [f32; 3],
    },
    /// Beer's law per channel, with multiple scattering: an endless body of it looks as bright as its diffuse reflectance
    /// makes it in [`Light::irradiance`](crate::Light::irradiance), and less of it less, by the share of the light from
    /// behind that it takes.
    ///
    /// Scattering is taken as isotropic (similarity relation), so that a coefficient that was measured has to be reduced: of
    /// dense media, as milk, `(1 - g)` of it by the mean cosine g; of natural waters, whose reflectance goes by what is
    /// scattered backwards, twice the backscattering coefficient. The reflectance of a half space is van de Hulst's
    /// `(1 - s)(1 - 0.139 s)/(1 + 1.17 s)`, `s = √(absorption/(absorption + scattering))` (Multiple Light Scattering, 1980),
    /// and what the surface throws back inside is added as [`Bed::Submerged`] says. The surface is shaded as a matte one by
    /// the sun, the scene's shadows and [`Light::shade`](crate::Light::shade); shadows of the fluid on itself are not.
    Turbid {
        /// Absorption per metre, linear RGB, [0, ∞).
        absorption: [f32; 3],
        /// Reduced scattering per metre, linear RGB, [0, ∞).
        scattering: [f32; 3],
        /// Radiance that an endless body of it emits, linear RGB, [0, ∞): of hot media, as lava.
        emission: [f32; 3],
    },
    /// The source's: `mix(base·exp(−k T), background, exp(−k_a T))` (thesis, Eq. 3.5 to 3.7).
    Source {
        /// Colour of thin water, linear RGB, [0, 1].
        base: [f32; 3],
        /// Falloff per metre of colour (RGB) and background (A), [0, ∞).
        falloff: [f32; 4],
    },
}

/// Presets. Red, green and blue are 610, 550 and 465 nm, next to the dominant wavelengths of the primaries of Rec. 709 (611,
/// 549 and 464 nm), but where the source measured with the three channels of a camera. The numbers hold for metres: of a
/// scene that is drawn larger than it is meant, as a glass of beer simulated four metres wide, [`thinned`](Self::thinned)
/// makes the same picture.
impl Medium {
    /// Pure water: absorption by Pope and Fry (Applied Optics 36, 1997, Table 3), scattering by Morel (1974, fresh water).
    /// Colourless in a glass, blue over ten metres.
    pub const CLEAR: Self = Self::turbid([0.264, 0.0565, 0.0101], [0.000_94, 0.001_47, 0.003_04]);
    /// A pool: three times denser than pure water, so that a metre of it is visibly blue-green. By eye.
    pub const POOL: Self =
        Self::Physical { absorption: [1.1, 0.24, 0.11], scattering: [0.014, 0.03, 0.04] };
    /// A lake, green: 3 mg/m³ of chlorophyll as in [`OCEAN`](Self::OCEAN), and dissolved organic matter of 0.4 per metre at
    /// 443 nm, falling by 0.0176 per nm (Babin et al., J. Geophys. Res. 108(C7), 2003).
    pub const LAKE: Self = Self::turbid([0.322, 0.165, 0.408], [0.0205, 0.0232, 0.0287]);
    /// Clear ocean, Jerlov's type IB: 0.1 mg/m³ of chlorophyll (Mobley, Light and Water, 1994), absorption by Prieur and
    /// Sathyendranath (Limnol. Oceanogr. 26, 1981) as Mobley has it (Eq. 3.27, Table 3.7), scattering by Gordon and Morel
    /// (1983), of which 0.0183 is backwards (Petzold's particles), and that of sea water (Morel 1974). Its diffuse
    /// attenuation is that of Jerlov's table (Marine Optics, 1976, Table XXVII) to a fifth.
    pub const OCEAN: Self = Self::turbid([0.273, 0.0639, 0.0252], [0.0036, 0.004_55, 0.007_07]);
    /// A river, tan: 100 g/m³ of silt, which scatters 0.51 m²/g (Babin et al., Limnol. Oceanogr. 48, 2003), 0.0183 of it
    /// backwards, and absorbs 0.031 m²/g at 443 nm, falling by 0.0123 per nm; dissolved organic matter of 1 per metre there
    /// (Babin et al., J. Geophys. Res. 108(C7), 2003).
    pub const RIVER: Self = Self::turbid([0.715, 1.04, 3.05], [1.87, 1.87, 1.87]);
    /// A lake under a glacier, turquoise: 20 g/m³ of rock flour, fine and pale. It scatters 1 m²/g, twice what silt does,
    /// and absorbs 0.003 m²/g at 443 nm, a tenth; estimates, so that water takes the red and flour a little of the blue, by
    /// which Aas and Bogen explain the colour (Water Resources Research 24, 1988).
    pub const GLACIER: Self = Self::turbid([0.272, 0.0726, 0.0559], [0.733, 0.733, 0.735]);
    /// Whole milk (Jensen et al., A Practical Model for Subsurface Light Transport, 2001, Fig. 5: per millimetre, reduced
    /// scattering; red, green and blue of a camera). Index of refraction 1.35.
    pub const MILK: Self = Self::turbid([1.1, 2.4, 14.0], [2550.0, 3210.0, 3770.0]);
    /// Lager (Narasimhan et al., Acquiring Scattering Properties of Participating Media by Dilution, 2006: Budweiser, from
    /// the dilution of 2.9 litres in 23 to the bottle; scattering reduced by its g; three channels of a camera). Amber in a
    /// glass, black a metre deep. Index of refraction 1.345.
    pub const BEER: Self = Self::turbid([11.5, 24.9, 57.8], [0.0244, 0.0241, 0.0106]);
    /// Honey, amber: an absorbance of 0.5 at 450 nm of a centimetre of half a gram per millilitre (Beretta et al., Analytica
    /// Chimica Acta 533, 2005, found 0.03 to 3.4), falling by e within 82 nm. That slope is an estimate: it is that of beer,
    /// whose colour comes from the same reaction of sugars. Clear. Index of refraction 1.49.
    pub const HONEY: Self = Self::turbid([45.8, 95.2, 268.0], [0.0; 3]);
    /// Blood, with oxygen: 150 g/l of haemoglobin by Prahl's table of its molar extinction, reduced scattering
    /// 2200 (λ/500 nm)^-0.66 per metre (Jacques, Phys. Med. Biol. 58, 2013, Table 1). Index of refraction 1.38.
    pub const BLOOD: Self = Self::turbid([807.0, 23_000.0, 20_600.0], [1930.0, 2070.0, 2310.0]);
    /// Molten basalt of 1490 K, as Kilauea's hottest fountains (1216 °C, 1959): Planck's law at the three wavelengths, whose
    /// luminance is 6800 cd/m², where a radiance of 1 is white paper in a full sun of 100 klx; opaque, absorbing 2000 per metre (an estimate). It has no crust and lights
    /// nothing but itself. Index of refraction 1.6.
    pub const LAVA: Self = Self::Turbid {
        absorption: [2000.0; 3],
        scattering: [0.0; 3],
        emission: [0.497, 0.148, 0.0139],
    };

    const fn turbid(absorption: [f32; 3], scattering: [f32; 3]) -> Self {
        Self::Turbid { absorption, scattering, emission: [0.0; 3] }
    }

    /// The source's demo for particles of this spacing.
    pub fn source(spacing: f32) -> Self {
        let k = 0.138 / spacing;
        Self::Source { base: [0.306, 0.545, 0.957], falloff: [0.784 * k, 0.784 * k, 0.588 * k, k] }
    }

    /// The medium with so much of what absorbs and scatters in a metre, [0, ∞): 0.1 is tenfold dilution, or a scene that is
    /// ten times as large as what it stands for. What it emits stays.
    pub fn thinned(self, share: f32) -> Self {
        let times = |k: [f32; 3]| k.map(|k| share * k);
        match self {
            Self::Physical { absorption, scattering } => {
                Self::Physical { absorption: times(absorption), scattering: times(scattering) }
            }
            Self::Turbid { absorption, scattering, emission } => Self::Turbid {
                absorption: times(absorption),
                scattering: times(scattering),
                emission,
            },
            Self::Source { base, falloff } => {
                Self::Source { base, falloff: falloff.map(|k| share * k) }
            }
        }
    }
}

/// Share of light that the surface reflects, from the cosine between normal and view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// Schlick's approximation; water has f0 = 0.02.
    Schlick {
        /// Reflectance at normal incidence, [0, 1].
        f0: f32,
    },
    /// The source's `bias + scale·(1 − n·v)^power` (thesis, Listing A.19 with its sign mended).
    Source {
        /// Default 0.1.
        bias: f32,
        /// Default 0.4.
        scale: f32,
        /// Default 2.
        power: f32,
    },
}

impl Fresnel {
    /// Of a liquid of an index of refraction, [1, ∞): water 1.333, beer 1.345, milk 1.35, honey 1.49.
    pub const fn of_index(n: f32) -> Self {
        let root = (n - 1.0) / (n + 1.0);
        Self::Schlick { f0: root * root }
    }
}

/// Foam formation: which particles are foam, by Weber number.
///
/// `We = scale·ρ·|v − air|²`; a particle foams while it is at the threshold or above, with times to
/// come and go that differ from particle to particle (thesis, Sec. 3.2).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FoamSettings {
    /// Weber number per density and squared speed, (0, ∞): the particle's diameter over the surface
    /// tension ([`weber`](Self::weber)), or another reduced form.
    pub scale: f32,
    /// Weber number from which on a particle foams, (0, ∞). It does not transfer between
    /// simulations: take it from the data, such as the 95th percentile over a sequence.
    pub threshold: f32,
    /// Mean seconds that foam takes to dissolve, (0, ∞), default 1; each particle 0.5 to 1.5 of it.
    pub foam_lifetime: f32,
    /// World velocity of the air, default 0.
    pub air: [f32; 3],
    /// Density where no stream gives one, or gives 0 (a particle just emitted), (0, ∞), default 1000.
    pub rest_density: f32,
    /// Of the random times.
    pub seed: u32,
}

/// Surface tension of water in air at 20 °C, N/m.
pub const SURFACE_TENSION: f32 = 0.0728;

impl FoamSettings {
    /// The full Weber number `ρ v² l / σ` of particles of a spacing (m), in SI units.
    pub fn weber(spacing: f32, threshold: f32) -> Self {
        Self { scale: spacing / SURFACE_TENSION, ..Self::reduced(1.0, threshold) }
    }

    /// The same number of particles of a spacing in scene units, with speeds in these, in a world of so many units a metre.
    pub fn weber_in(spacing: f32, units_per_metre: f32, threshold: f32) -> Self {
        let scale =
            spacing / (units_per_metre * units_per_metre * units_per_metre * SURFACE_TENSION);
        Self { scale, ..Self::reduced(1.0, threshold) }
    }

    /// The reduced form of the source's demo, `1e-5·ρ·v²` with v in 1/1.43 spacings per second; its
    /// thresholds are 50 to 110, default 80.
    pub fn reduced(spacing: f32, threshold: f32) -> Self {
        let speed = 1.43 / spacing;
        Self {
            scale: 1.0e-5 * speed * speed,
            threshold,
            foam_lifetime: 1.0,
            air: [0.0; 3],
            rest_density: 1000.0,
            seed: 0,
        }
    }

    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        let bad = |field, why: String| Err(crate::error::Error::bad(field, why));
        for (field, value) in [
            ("FoamSettings.scale", self.scale),
            ("FoamSettings.threshold", self.threshold),
            ("FoamSettings.foam_lifetime", self.foam_lifetime),
            ("FoamSettings.rest_density", self.rest_density),
        ] {
            if !value.is_finite() || value <= 0.0 {
                return bad(field, format!("more than 0 expected, found {value}"));
            }
        }
        if !self.air.iter().all(|v| v.is_finite()) {
            return bad("FoamSettings.air", format!("{:?}: not finite", self.air));
        }
        Ok(())
    }
}

/// How foam looks. Of no effect without [`Config::foam`](crate::Config).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FoamLook {
    /// Light that foam takes away, per metre of it along the ray, [0, ∞), default 0.4 / spacing: two layers hide
    /// half.
    pub extinction: f32,
    /// How fast its colour turns to that of the front with the foam right behind the frontmost, per
    /// metre, [0, ∞), default 0.15 / spacing.
    pub front_extinction: f32,
    /// Power p of the source's other rule, [0, 64]: the front colour's share is the foam there over the
    /// layer's depth, to the power p. 0 (default): the rule above.
    pub front_power: f32,
    /// Depth of that layer, scene units, [0, ∞), default 60 spacings (the source's 7 shows drops
    /// before the foam as discs: it begins anew behind each); it ends within a spacing more.
    pub front_depth: f32,
    /// Speed at which a sprite is stretched to twice its width, spacings a second, (0, ∞), default 21.
    pub motion_threshold: f32,
    /// Strength of a noise of its own in each sprite that tears it, as the source has it, 0 (none, default) to 1; it
    /// fades where its cells are less than two texels of the thickness wide. In the place of the pattern: of the two
    /// one has to be 0.
    pub noise: f32,
    /// Cells of that noise that pass in a second of a particle's age, [0, 1e3], default 2.
    pub noise_rate: f32,
    /// How much thicker it is here than there by a noise in space that the foam carries along, [0, 2], default 1: a
    /// tenth of it is twice as thick or more, a tenth a quarter or less. Not in the source; 0: none of that, as a
    /// [`noise`](Self::noise) needs it.
    pub pattern: f32,
    /// Width of the largest of the clumps, spacings, (0, 1e3], default 3.
    pub pattern_size: f32,
    /// Seconds after which a clump is drawn out and another has taken its place, (0, 1e3], default 1.
    pub pattern_period: f32,
    /// How much thin foam is torn into threads with clear holes between them, which close where there is much of it, [0, 1]:
    /// as much of the picture is hidden as by smooth foam. Default 0: none of that, thin foam is a veil. Not in the source.
    pub lace: f32,
    /// Width of the cells of the largest holes, spacings, (0, 1e3], default 4. Those of less than two pixels are not drawn.
    pub lace_size: f32,
    /// The time of the frame in seconds, by which the pattern moves on; default 0. One that stands still leaves the
    /// pattern where it is in space, and foam moves through it.
    pub time: f64,
    /// Thickness below which foam is less than it is, scene units, [0, ∞), default a spacing: a veil
    /// reads as steam. Not in the source; 0: none of that.
    pub veil: f32,
    /// How much its shape shows: light lost where its front layer is turned from the sun, [0, 2],
    /// default 0.35.
    pub relief: f32,
    /// How much the light on it goes by the shape of a whole splash, [0, 1]: the foam within six spacings turns it to the sun
    /// or away, which leaves it the sky's light, and dims the sky in hollows. Default 0: not at all. Not in the source.
    pub shape: f32,
    /// Sunlight that it takes from what is behind it, per metre, [0, ∞), default 0.25 / spacing: less than
    /// its extinction, for most of the light goes on.
    pub shadow: f32,
    /// Albedo of thin foam and of thick one, linear RGB, 0 to 1, default grey 0.65 and white 0.9 (the
    /// source's are colours on the screen, 0.25 and 1).
    pub back_color: [f32; 3],
    /// As above.
    pub front_color: [f32; 3],
}

impl FoamLook {
    /// The defaults for particles of a spacing.
    pub fn of_spacing(spacing: f32) -> Self {
        Self {
            extinction: 0.4 / spacing,
            front_extinction: 0.15 / spacing,
            front_power: 0.0,
            front_depth: 60.0 * spacing,
            motion_threshold: 21.0,
            noise: 0.0,
            noise_rate: 2.0,
            pattern: 1.0,
            pattern_size: 3.0,
            pattern_period: 1.0,
            lace: 0.0,
            lace_size: 4.0,
            time: 0.0,
            veil: spacing,
            relief: 0.35,
            shape: 0.0,
            shadow: 0.25 / spacing,
            back_color: [0.65; 3],
            front_color: [0.9; 3],
        }
    }

    /// The thesis' foam for particles of a spacing: a noise of each sprite's own, opaque and without relief. Its numbers
    /// are per unit of its own thickness and length (1.43 of them are a spacing); a sprite of it holds about 33 particle
    /// volumes.
    pub fn thesis(spacing: f32) -> Self {
        let unit = 1.43 * 33.0 / spacing;
        Self {
            extinction: 0.5 * unit,
            front_extinction: unit / 3.0,
            front_depth: 7.0 * spacing,
            noise: 1.0,
            pattern: 0.0,
            veil: 0.0,
            relief: 0.0,
            shadow: 0.0,
            back_color: [0.25; 3],
            front_color: [1.0; 3],
            ..Self::of_spacing(spacing)
        }
    }

    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        range("Settings.foam.extinction", self.extinction, 0.0, f32::MAX)?;
        range("Settings.foam.front_extinction", self.front_extinction, 0.0, f32::MAX)?;
        range("Settings.foam.front_power", self.front_power, 0.0, 64.0)?;
        range("Settings.foam.front_depth", self.front_depth, 0.0, f32::MAX)?;
        range("Settings.foam.motion_threshold", self.motion_threshold, 1.0e-6, f32::MAX)?;
        range("Settings.foam.noise", self.noise, 0.0, 1.0)?;
        range("Settings.foam.pattern", self.pattern, 0.0, 2.0)?;
        if self.noise > 0.0 && self.pattern > 0.0 {
            let why = format!(
                "{} beside Settings.foam.pattern of {}: expected one of them, set the other to 0",
                self.noise, self.pattern
            );
            return Err(crate::error::Error::bad("Settings.foam.noise", why));
        }
        range("Settings.foam.pattern_size", self.pattern_size, 1.0e-3, 1.0e3)?;
        range("Settings.foam.lace", self.lace, 0.0, 1.0)?;
        range("Settings.foam.lace_size", self.lace_size, 1.0e-3, 1.0e3)?;
        range("Settings.foam.pattern_period", self.pattern_period, 1.0e-3, 1.0e3)?;
        if !self.time.is_finite() {
            let why = format!("{}: not finite", self.time);
            return Err(crate::error::Error::bad("Settings.foam.time", why));
        }
        range("Settings.foam.shadow", self.shadow, 0.0, f32::MAX)?;
        range("Settings.foam.veil", self.veil, 0.0, f32::MAX)?;
        range("Settings.foam.relief", self.relief, 0.0, 2.0)?;
        range("Settings.foam.shape", self.shape, 0.0, 1.0)?;
        range("Settings.foam.noise_rate", self.noise_rate, 0.0, 1.0e3)?;
        for (back, front) in self.back_color.into_iter().zip(self.front_color) {
            range("Settings.foam.back_color", back, 0.0, 1.0)?;
            range("Settings.foam.front_color", front, 0.0, 1.0)?;
        }
        Ok(())
    }
}

/// How spray looks: particles that are too few together to be a body of water. Of no effect without
/// [`Config::spray`](crate::Config).
///
/// As its density falls a particle becomes spray, until it is nothing else. It is drawn as droplets round its centre, each streaking along its motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SprayLook {
    /// Share of the light that the middle of a droplet at rest takes away, [0, 1), default 0.5 (the
    /// source: 0.4).
    pub opacity: f32,
    /// Half-axis of a particle's spray in drawn radii, (0, 8], default 0.5 as the source. Its
    /// droplets together are about as large.
    pub size: f32,
    /// The most droplets that a particle is drawn as, 1 (the source) to 64, default 16. If it is more than 1, each particle has
    /// between a fifth and all of them, by its id.
    pub droplets: u32,
    /// Fractions of the rest density, rising, [0, ∞): below the first a particle is nothing but
    /// spray, from the second on its water has its full radius and its foam is whole, from the third
    /// on it is no spray. Default 0.6, 0.7, 0.85: lines of particles are spray (0.48 with the usual
    /// cubic spline), sheets of one layer (0.70) hardly. They take the place of
    /// [`WaterSettings::density_threshold`] and [`density_full`](WaterSettings::density_full).
    pub densities: [f32; 3],
    /// How far they lie from its centre at most, in spacings, [0, 8], default 1.5; 0: nowhere else
    /// (the source).
    pub spread: f32,
    /// Droplets are also spread along the particle's velocity, by as far as it moves in up to so many seconds, forwards and
    /// backwards: [0, 1], default 0. So torn water flies in strands.
    pub stretch: f32,
    /// Share of the light that the middle of a particle's mist takes away where half of the particle is spray, [0, 1), default
    /// 0.05. There is less mist where the water is whole, and 0.15 of it where all is spray: lone drops are not misty. Mist
    /// takes the place of the first droplet where there are several.
    pub mist: f32,
    /// Half-axis of that mist in spacings, (0, 8], default 0.5.
    pub mist_size: f32,
    /// Seconds of motion that a droplet streaks over, [0, 1], default 1/250, as the water is drawn at an instant; as it is longer it is
    /// thinner.
    pub shutter: f32,
    /// Albedo, linear RGB, 0 to 1, default 0.95.
    pub color: [f32; 3],
    /// Its light is added to that from behind (the source), not laid over it (default).
    pub additive: bool,
}

impl Default for SprayLook {
    fn default() -> Self {
        Self {
            opacity: 0.5,
            size: 0.5,
            droplets: 16,
            densities: [0.6, 0.7, 0.85],
            spread: 1.5,
            stretch: 0.0,
            mist: 0.05,
            mist_size: 0.5,
            shutter: 1.0 / 250.0,
            color: [0.95; 3],
            additive: false,
        }
    }
}

impl SprayLook {
    /// As the source has it: a sprite a particle, added.
    pub const SOURCE: Self = Self {
        opacity: 0.4,
        size: 0.5,
        droplets: 1,
        densities: [0.35, 0.45, 0.35],
        spread: 0.0,
        stretch: 0.0,
        mist: 0.0,
        mist_size: 0.5,
        shutter: 1.0 / 60.0,
        color: [1.0; 3],
        additive: true,
    };

    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        range("Settings.spray.opacity", self.opacity, 0.0, 1.0 - f32::EPSILON)?;
        range("Settings.spray.size", self.size, 1.0e-6, 8.0)?;
        range("Settings.spray.droplets", self.droplets as f32, 1.0, 64.0)?;
        let [all, full, none] = self.densities;
        range("Settings.spray.densities", all, 0.0, f32::MAX)?;
        range("Settings.spray.densities", full, all, f32::MAX)?;
        range("Settings.spray.densities", none, all, f32::MAX)?;
        range("Settings.spray.spread", self.spread, 0.0, 8.0)?;
        range("Settings.spray.stretch", self.stretch, 0.0, 1.0)?;
        range("Settings.spray.mist", self.mist, 0.0, 1.0 - f32::EPSILON)?;
        range("Settings.spray.mist_size", self.mist_size, 1.0e-6, 8.0)?;
        range("Settings.spray.shutter", self.shutter, 0.0, 1.0)?;
        for color in self.color {
            range("Settings.spray.color", color, 0.0, 1.0)?;
        }
        Ok(())
    }
}

/// How the baseline's surface noise looks. Of no effect without [`Config::noise`](crate::Config).
///
/// Each particle has a gradient noise of its own, which moves with it; together they are a height on the
/// front surface of the water that turns its normals, and the baseline's foam: grey where it is high or
/// low.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NoiseLook {
    /// Height that a noise of 1 has, in drawn radii, [0, 16], default 0.336 (the source of the number has
    /// it as the weight of the derivatives, in a unit of its own). 0: flat.
    pub weight: f32,
    /// How fast a particle's noise falls with its depth below the surface: by e within the drawn radius
    /// over this. [0, 64], default 2.
    pub falloff: f32,
    /// Half-axis of a particle's noise in drawn radii, (0, 8], default 2.
    pub size: f32,
    /// Cells of the octave in a drawn radius, (0, 16], default 1: somewhat finer than the particles.
    pub cells: f32,
    /// Share of the foam's light that a noise of 1 adds to the picture, up to all of it, [0, 64]; default
    /// 0: no such foam.
    pub foam: f32,
    /// Its albedo, linear RGB, 0 to 1, default grey 0.5.
    pub color: [f32; 3],
}

impl Default for NoiseLook {
    fn default() -> Self {
        Self { weight: 0.336, falloff: 2.0, size: 2.0, cells: 1.0, foam: 0.0, color: [0.5; 3] }
    }
}

impl NoiseLook {
    /// As the baseline has it, with its foam. How much grey, is not known: so that it shows.
    pub const SOURCE: Self =
        Self { weight: 0.336, falloff: 2.0, size: 2.0, cells: 1.0, foam: 1.0, color: [0.5; 3] };

    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        range("Settings.noise.weight", self.weight, 0.0, 16.0)?;
        range("Settings.noise.falloff", self.falloff, 0.0, 64.0)?;
        range("Settings.noise.size", self.size, 1.0e-3, 8.0)?;
        range("Settings.noise.cells", self.cells, 1.0e-3, 16.0)?;
        range("Settings.noise.foam", self.foam, 0.0, 64.0)?;
        for color in self.color {
            range("Settings.noise.color", color, 0.0, 1.0)?;
        }
        Ok(())
    }
}

/// Of a setting whose range says no end: products of a few such numbers are still numbers.
pub(crate) const GREATEST: f32 = 1.0e12;

/// Checks a setting; the message names the field.
pub(crate) fn range(
    field: &'static str,
    value: f32,
    least: f32,
    most: f32,
) -> Result<(), crate::error::Error> {
    let most = most.min(GREATEST);
    if value >= least && value <= most {
        return Ok(());
    }
    let why = format!("expected {least} to {most}, found {value}");
    Err(crate::error::Error::bad(field, why))
}

impl Default for FoamLook {
    fn default() -> Self {
        Self::of_spacing(0.05)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The kernel `√(1 − ρ²)·exp(−2ρ²)` over a disc, by midpoints of u = ρ².
    #[test]
    fn a_sprite_of_the_source_holds_as_many_volumes() {
        let steps = 10_000_u32;
        let kernel = |i: u32| {
            let u = (f64::from(i) + 0.5) / f64::from(steps);
            (1.0 - u).sqrt() * (-2.0 * u).exp()
        };
        let mean = (0..steps).map(kernel).sum::<f64>() / f64::from(steps);
        let half_axis = 2.0 * f64::from(RADIUS_PER_SPACING);
        let height = 0.8 * 2.0 * half_axis;
        let volumes = height * std::f64::consts::PI * mean * half_axis * half_axis;
        // Three digits are said.
        assert!((volumes - f64::from(SOURCE_VOLUMES)).abs() < 5.0e-3, "{volumes}");
    }

    /// Red, green and blue of the presets, nm.
    const WAVES: [f64; 3] = [610.0, 550.0, 465.0];
    /// Absorption of pure water there, per metre (Pope and Fry 1997, Table 3).
    const WATER: [f64; 3] = [0.2644, 0.0565, 0.0101];
    /// Absorption of chlorophyll there over that at 440 nm (Mobley 1994, Table 3.7).
    const CHLOROPHYLL: [f64; 3] = [0.252, 0.357, 0.8935];

    /// Scattering of water (Morel 1974), from what it is at 400 nm.
    fn molecules(at_400: f64) -> [f64; 3] {
        WAVES.map(|wave| at_400 * (400.0 / wave).powf(4.32))
    }

    const FRESH: f64 = 0.00583;
    const SEA: f64 = 0.00758;

    /// Water of so much chlorophyll, mg/m³, and dissolved matter, per metre at 443 nm: absorption, and twice what is
    /// scattered backwards.
    fn alive(chlorophyll: f64, dissolved: f64, water: f64) -> [[f64; 3]; 2] {
        let molecules = molecules(water);
        let absorption = [0, 1, 2].map(|i| {
            let own = WATER[i] + 0.06 * CHLOROPHYLL[i] * chlorophyll.powf(0.65);
            let yellow = 0.2 * (-0.014 * (WAVES[i] - 440.0)).exp();
            own * (1.0 + yellow) + dissolved * (-0.0176 * (WAVES[i] - 443.0)).exp()
        });
        let scattering = [0, 1, 2].map(|i| {
            let particles = 0.3 * chlorophyll.powf(0.62) * 550.0 / WAVES[i];
            2.0 * (0.0183 * particles + 0.5 * molecules[i])
        });
        [absorption, scattering]
    }

    /// The same of so many g/m³ of flour that absorbs and scatters so much, m²/g.
    fn silted(grams: f64, [absorbs, scatters]: [f64; 2], dissolved: f64) -> [[f64; 3]; 2] {
        let molecules = molecules(FRESH);
        let absorption = [0, 1, 2].map(|i| {
            let silt = grams * absorbs * (-0.0123 * (WAVES[i] - 443.0)).exp();
            WATER[i] + silt + dissolved * (-0.0176 * (WAVES[i] - 443.0)).exp()
        });
        let scattering = [0, 1, 2].map(|i| 2.0 * (0.0183 * scatters * grams + 0.5 * molecules[i]));
        [absorption, scattering]
    }

    fn coefficients(medium: Medium) -> [[f64; 3]; 2] {
        match medium {
            Medium::Turbid { absorption, scattering, .. } => {
                [absorption, scattering].map(|k| k.map(f64::from))
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn presets_are_what_their_sources_say() {
        let per_millimetre = |k: [f64; 3]| k.map(|k| 1000.0 * k);
        // Of Narasimhan's table, per centimetre hundredth, at the dilution.
        let diluted = |k: [f64; 3]| per_millimetre(k.map(|k| 0.01 * k * 23.0 / 2.9));
        let absorbed = diluted([0.1449, 0.3141, 0.7286]);
        let honey = WAVES.map(|wave| {
            let tenfold = std::f64::consts::LN_10;
            100.0 * tenfold * 0.5 * (1.4 / 0.5) * (-(wave - 450.0) / 82.0).exp()
        });
        // Molar extinction per centimetre, grams per mole.
        let blood = [1506.0, 43_016.0, 38_500.0]
            .map(|molar| 100.0 * std::f64::consts::LN_10 * molar * 150.0 / 64_500.0);
        let cells = WAVES.map(|wave| 2200.0 * (wave / 500.0_f64).powf(-0.66));
        for (name, preset, [absorption, scattering]) in [
            ("clear", Medium::CLEAR, [WATER, molecules(FRESH)]),
            ("lake", Medium::LAKE, alive(3.0, 0.4, FRESH)),
            ("ocean", Medium::OCEAN, alive(0.1, 0.0, SEA)),
            ("river", Medium::RIVER, silted(100.0, [0.031, 0.51], 1.0)),
            ("glacier", Medium::GLACIER, silted(20.0, [0.003, 1.0], 0.0)),
            (
                "milk",
                Medium::MILK,
                [[0.0011, 0.0024, 0.014], [2.55, 3.21, 3.77]].map(per_millimetre),
            ),
            ("beer", Medium::BEER, [absorbed, [0.0244, 0.0241, 0.0106]]),
            ("honey", Medium::HONEY, [honey, [0.0; 3]]),
            ("blood", Medium::BLOOD, [blood, cells]),
        ] {
            let found = coefficients(preset);
            for (k, expected) in found.iter().flatten().zip([absorption, scattering].concat()) {
                // Three digits are said.
                assert!((k - expected).abs() <= 0.01 * expected, "{name}: {k} is not {expected}");
            }
        }
        // Planck's law, of one luminance; Rec. 709 weighs the three.
        let Medium::Turbid { emission, .. } = Medium::LAVA else { panic!() };
        let second = 1.438_8e7; // nm K
        let planck = WAVES.map(|wave| (-second / (wave * 1490.0)).exp() / (wave / 610.0).powi(5));
        for (found, at) in emission.iter().zip(planck) {
            let expected = 0.497 * at / planck[0];
            assert!((f64::from(*found) - expected).abs() < 0.02 * expected, "{emission:?}");
        }
        let luminance: f64 =
            emission.iter().zip([0.2126, 0.7152, 0.0722]).map(|(e, w)| f64::from(*e) * w).sum();
        let paper = 1.0e5 / std::f64::consts::PI;
        assert!((luminance * paper / 6770.0 - 1.0).abs() < 0.01, "{luminance}");
    }

    /// Jerlov's own table says how the sun's light fails with depth: what is absorbed or thrown back, over the mean cosine of
    /// a high sun under water (Gordon 1989).
    #[test]
    fn the_ocean_is_jerlovs() {
        let table = [
            (450.0, 0.036),
            (475.0, 0.033),
            (500.0, 0.042),
            (525.0, 0.054),
            (550.0, 0.072),
            (575.0, 0.099),
            (600.0, 0.245),
            (625.0, 0.315),
        ];
        let [absorption, scattering] = coefficients(Medium::OCEAN);
        for i in 0..3 {
            let next = table.iter().position(|(wave, _)| *wave >= WAVES[i]).expect("listed");
            let ((from, low), (to, high)) = (table[next - 1], table[next]);
            let jerlov = low + (high - low) * (WAVES[i] - from) / (to - from);
            let ours = 1.04 * (absorption[i] + 0.5 * scattering[i]) / 0.9;
            assert!((ours / jerlov - 1.0).abs() < 0.2, "{} nm: {ours} and {jerlov}", WAVES[i]);
        }
    }

    #[test]
    fn thinner_is_less_of_all() {
        let Medium::Turbid { absorption, scattering, emission } = Medium::LAVA.thinned(0.5) else {
            panic!()
        };
        assert_eq!((absorption, scattering), ([1000.0; 3], [0.0; 3]));
        assert_eq!(Medium::LAVA.thinned(1.0), Medium::LAVA);
        assert!(emission[0] > 0.3, "what shines is as hot");
        let Medium::Source { base, falloff } = Medium::source(0.138).thinned(0.5) else { panic!() };
        assert_eq!((base, falloff[3]), ([0.306, 0.545, 0.957], 0.5));
    }
}
