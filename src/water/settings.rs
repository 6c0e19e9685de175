//! Settings of the layered water. Most lengths are in particle spacings or in drawn radii, which are a fixed part of
//! the spacing, so that the look does not change with the number of particles or the unit of length.

pub use super::wavelets::Wavelets;

/// Drawn radius divided by particle spacing, as in the thesis' demo.
pub const RADIUS_PER_SPACING: f32 = 0.656;

/// How particles are rasterized. Both paths give the same picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Splat {
    /// Particles are drawn as sprites with fixed-function blending. A sprite is a point, or a quad where the device
    /// cannot draw it as a point, for example because it is larger than the device's largest point. Sprites of surface
    /// foam are always quads.
    Raster,
    /// A compute shader with atomics.
    Compute,
}

/// How the pass `composite` computes the pixels that show water, foam or spray: with fragment shaders in a Vulkan
/// render pass or with a compute shader. Both give the same picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shading {
    /// The pixels are shaded in a render pass over the tiles that show water, foam, spray, whitewater particles or
    /// bubble foam. The output is a colour attachment.
    Raster,
    /// A compute shader over the same tiles. The output is a storage image.
    Compute,
}

/// Which shadow information the host hands in ([`Frame::shadow`](crate::Frame::shadow)), and how it is filtered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Shadows {
    /// A screen-space mask, 1 where the sun shines.
    Mask,
    /// A shadow map of the scene, with percentage-closer filtering.
    Map,
    /// The host's shadow map, converted by the pass `convolution` to a convolution shadow map as in the thesis. Such a
    /// map is filtered before the depth comparison, so a look-up costs the same for a shadow of any softness.
    Convolution(Convolution),
}

pub use crate::light::Convolution;

crate::contract::with!(
    WaterSettings,
    Wavelets,
    WeberSettings,
    SurfaceFoamSettings,
    SpraySettings,
    ShadowFilter
);
#[cfg(feature = "diagnostics")]
crate::contract::with!(SurfaceNoiseSettings);

/// Filter of the host's shadow map for [`Shadows::Convolution`] (Annen et al. 2007).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ShadowFilter {
    /// Width of the box filter of the shadow, in texels of the host's shadow map, [0, 256], default 3, which is the
    /// width of the filter of [`Shadows::Map`]. The filter is never narrower than a texel of the image that the pass
    /// `convolution` makes from this map.
    pub width: f32,
    /// Damping α of the Fourier terms, [0, 2], default 1. Without damping (0) the reconstructed visibility of the
    /// sun, which should be 1 in lit and 0 in shadowed areas, oscillates there by 0.05 (ringing). A `scale` above
    /// 1.12 removes this, because visibility is limited to 0 to 1. With more damping a shadow starts farther from its
    /// caster.
    pub damping: f32,
    /// Depth bias of the shadow, as a fraction of the depth over which the reconstructed visibility rises from one
    /// half to 1; [0, 1]. With 1, the default, a point that touches its occluder is lit. With 0 it is half in shadow,
    /// and shadows begin closer to their caster.
    pub offset: f32,
    /// Factor by which the reconstructed visibility is steepened around one half, [1, 4], default 1.25. The soft edge
    /// of a shadow becomes narrower by the same factor. With the default damping, values above 1.04 clip the
    /// remaining ringing.
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

/// Which parts of the picture the composite contains, as in the thesis' debug views. From `Background` to `Whole` each
/// value adds something to what the previous value shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum DebugView {
    /// The refracted scene.
    Background,
    /// Adds the water behind the frontmost foam.
    BackWater,
    /// Adds foam.
    SurfaceFoam,
    /// Adds the water in front of the frontmost foam. Where there is no foam, this is all water, or the front layer of
    /// two layers. Reflections, highlights and spray are still missing.
    FrontWater,
    /// Adds reflections, highlights and spray: the complete picture.
    #[default]
    Whole,
}

/// How many smoothing iterations a pixel gets, and how large its steps are.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Rule {
    /// The thesis' rule (Sec. 3.1): a pixel at depth d gets `⌊r_w / (C d)⌋ + 1` iterations, where r_w is a length in
    /// the world, 4.8 drawn radii, and the product `C d` is the width of the pixel in the world; at most
    /// [`Config::max_iterations`](crate::Config::max_iterations). Each iteration changes the pixel's depth in
    /// proportion to the surface's curvature.
    Source,
    /// Mean curvature flow. All water is smoothed over the same width, measured along its surface
    /// ([`WaterSettings::smoothing_width`]): near and far, facing the camera and seen at a grazing angle. Default.
    ConstantWidth,
    /// As van der Laan et al. (2009): every pixel with water gets this number of iterations. A number above
    /// [`Config::max_iterations`](crate::Config::max_iterations) counts as that maximum. The size of a step is that
    /// of [`Rule::Source`].
    Fixed(u32),
}

/// Implementation of the smoothing. All give the same surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Smoothing {
    /// One raster pass per iteration. In every fifth iteration an occlusion query counts the pixels that are still
    /// being smoothed; if there are none, the GPU skips the remaining iterations, by the mechanism that the [`Gate`]
    /// names.
    Query(Gate),
    /// One dispatch per iteration, over the tiles with pixels that are still being smoothed.
    Tiles,
    /// Each compute dispatch runs several iterations in shared memory, over the tiles with pixels that are still being
    /// smoothed.
    Fused,
}

/// How the GPU skips the remaining iterations of [`Smoothing::Query`] once an occlusion query has found that no pixel
/// is being smoothed any more. No variant waits for the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Gate {
    /// An indirect draw count (`drawIndirectCount`).
    DrawCount,
    /// Conditional rendering (`VK_EXT_conditional_rendering`).
    Predicate,
    /// The vertex shader moves the tiles off the screen. Needs no feature.
    VertexCull,
}

/// Uniform settings of the layered water.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WaterSettings {
    /// Rest distance between particles (twice the solver's particle radius), scene units, [1e-6, ∞), default
    /// 0.05.
    pub spacing: f32,
    /// Rest density in the unit of the density stream, [1e-6, ∞), default 1000.
    pub rest_density: f32,
    /// Particles whose density is below this fraction of the rest density are not drawn: they are spray, too few
    /// together to form a body of water. [0, ∞), default 0.35 (an isolated particle has 0.318 with the usual cubic
    /// spline). With [`Config::spray`](crate::Config), which draws spray, [`SpraySettings::all_spray_density`]
    /// replaces this fraction.
    pub density_threshold: f32,
    /// Fraction of the rest density at and above which a particle has its full radius. Down to `density_threshold` the
    /// radius falls to half. At least `density_threshold`, default 0.45. With [`Config::spray`](crate::Config),
    /// [`SpraySettings::full_water_density`] replaces it.
    pub density_full: f32,
    /// Width (standard deviation) of the smoothing along the surface in drawn radii (0.656 spacings each), [0, ∞),
    /// default 1.5. With 0.7 the particle lattice remains visible; with 2.5 water looks like silk. (The smoothing
    /// rules of the thesis and of van der Laan et al., which need the feature `diagnostics`, ignore this setting.)
    pub smoothing_width: f32,
    /// Where the depths of neighbouring pixels differ by more than this, there is a silhouette, and neither side is
    /// smoothed with the other. In drawn radii (0.656 spacings each), [0, ∞), default 5.3.
    pub depth_falloff: f32,
    /// Shape of the particles with [`Kernels::Ellipsoids`].
    pub ellipsoids: Ellipsoids,
    /// Thickness that one particle adds.
    #[cfg(feature = "diagnostics")]
    pub amplitude: Amplitude,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) amplitude: Amplitude,
    /// Optical properties.
    pub medium: Medium,
    /// Fresnel reflectance.
    pub fresnel: Fresnel,
    /// How reflection and highlight combine with the light that comes through the water. Default
    /// [`Compositing::Mixed`].
    #[cfg(feature = "diagnostics")]
    pub compositing: Compositing,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) compositing: Compositing,
    /// Appearance of the scene under water. Default [`Bed::Submerged`].
    #[cfg(feature = "diagnostics")]
    pub bed: Bed,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) bed: Bed,
    /// Factor on the displacement, by refraction, of what is seen through the water, [0, ∞), default 0.25. Whatever
    /// the factor, the displacement stays below a sixteenth of the picture's height. With [`Exit::TwoInterfaces`]
    /// factor and limit do not apply where there is no air between the water and the scene behind it: there the
    /// displacement follows from the index of refraction. Where there is air, they apply only to what is seen
    /// straight behind, not to what is seen along the refracted ray.
    pub refraction: f32,
    /// Strength of the sun's highlight, [0, ∞), default 1.
    pub specular: f32,
    /// Blinn-Phong exponent of the highlight, [1, ∞), default 1500.
    pub shininess: f32,
    /// Small waves on level water. Default none.
    pub wavelets: Wavelets,
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
            wavelets: Wavelets::default(),
        }
    }
}

impl WaterSettings {
    /// The water of the demo of the thesis (Bagar 2010) for a particle spacing: its unit of thickness, its colours and
    /// reflectance, its highlight of the sun, and its formula for putting these together; the scene is not darkened
    /// under water. The other settings have their defaults.
    pub fn thesis(spacing: f32) -> Self {
        let Medium::Source { base, falloff } = Medium::source(spacing) else {
            return Self::default();
        };
        Self {
            spacing,
            amplitude: Amplitude::Source,
            // The thesis' thickness is this many times that of the particles' volumes, so the falloff is divided by
            // it.
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

/// Number of particle volumes that a thickness sprite of [`Amplitude::Source`] holds: `(0.8·2a·π·J·a²) / spacing³`,
/// where the sprite's half-axis a is twice the drawn radius, and J = 0.34 is the mean of the kernel over its disc.
const SOURCE_VOLUMES: f32 = 3.86;

/// How reflection and the sun's highlight combine with the light that comes through the water from behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Compositing {
    /// With the reflectance F the result is `F·reflection + (1 − F)·light from behind + highlight`. Reflection and
    /// highlight fade out where water is thinner than a quarter of the drawn radius. The reflecting surface is that of
    /// the water in front of the frontmost foam, or, where no water is in front of it, that of the water behind it.
    /// Foam is placed at its mean depth, but with [`Medium::Source`] at the depth of the frontmost foam.
    Mixed,
    /// The thesis' composite (Listing A.20): reflection and highlight, times `clamp(1 − a_wf + a_f, 0, 1)·(1 − a_wf)`,
    /// are added to the full light from behind. `a_wf` is the transmittance of the water in front of the frontmost
    /// foam (with [`Medium::Source`] by the last component of its falloff, with other media the mean of the channels),
    /// and `a_f` is the transmittance of the foam. All foam is placed at the depth of the frontmost foam, and rays
    /// that are reflected downwards see the environment's ground.
    Source,
}

/// Appearance of the scene where it lies under water. It counts as fully under water where the thickness of the water
/// is at least 0.7 of the distance from the water's surface to the scene, as dry below 0.5, and as partly under water
/// in between.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Bed {
    /// The scene is darkened as a wet surface is (Lekner and Dorf 1988). With the surface's mean Fresnel reflectance
    /// F, the share `(1 − F)/n²` of the light that the scene scatters leaves the water; the rest is reflected at the
    /// water's surface and lights the scene again. The scene's albedo is estimated from its colour and
    /// [`Light::irradiance`](crate::Light::irradiance): a grey of albedo 0.4 keeps 0.65 of its brightness, white all
    /// of it. In addition the medium absorbs sunlight and skylight on their way down, and the scene's light on its
    /// refracted way to the camera. The index of refraction n belongs to the f0 of [`Fresnel::Schlick`]; it is 1.333
    /// with another variant.
    Submerged,
    /// The scene is as bright as if it were dry (the thesis). No water counts as touching the scene: [`Exit`] treats
    /// all water as having air behind it.
    Source,
}

/// What is visible through water with air behind it: jets, crowns, drops, sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Exit {
    /// The view ray refracts at the front surface of the water; at the water's far surface it refracts again or is
    /// totally reflected. Its directions follow from the slopes of both surfaces and the index of refraction of
    /// [`WaterSettings::fresnel`] (1.333 if that has none). A screen-space march of 4 steps finds the scene on the ray
    /// that leaves; a ray that meets no scene sees the environment (Wyman 2005). At most half of the light comes along
    /// this ray; the rest comes from the scene straight behind, displaced by [`WaterSettings::refraction`]. If a
    /// second layer of water, which touches the scene, lies behind the air ([`Config::sheets`](crate::Config)), mainly
    /// this layer is seen, displaced as by a weak prism. Where the water itself touches the scene, the scene is shown
    /// at the point where the ray refracted at the front surface meets it.
    TwoInterfaces,
    /// The scene straight behind, displaced by [`WaterSettings::refraction`] (the thesis).
    Straight,
}

/// Shape that each particle is drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kernels {
    /// A sphere, as in the thesis.
    Spheres,
    /// An ellipsoid of the same volume, fitted to the neighbours (Yu and Turk 2013) as
    /// [`WaterSettings::ellipsoids`] says: flat in a thin sheet, elongated in a stream, round inside the water. All
    /// particles count as neighbours, also those that the host has put in none of its [`Packets`](crate::Packets),
    /// which are not drawn. The ellipsoids give the depth of the water's surface (of both layers) and the thickness
    /// of the water. Light maps, surface foam, motion vectors and the separation of two layers of water still use
    /// spheres; spray has an ellipsoid of its own ([`SpraySettings::strand_ratio`]).
    Ellipsoids,
}

/// How ellipsoids are fitted. No effect without [`Kernels::Ellipsoids`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoids {
    /// Radius within which particles are neighbours, in spacings, [1, 4], default 2.5. A neighbour at distance d has
    /// the weight `1 − (d/reach)³`. The time of the pass `shape`, which fits the ellipsoids, grows with the cube of
    /// this radius.
    pub reach: f32,
    /// Maximum ratio of the longest to the shortest half-axis of a particle's ellipsoid, [1, 8], default 2.5 (Yu and
    /// Turk: 4). 1 gives spheres.
    pub ratio: f32,
    /// Sum of the neighbours' weights at and above which a particle is a complete ellipsoid, [0, 64], default 8. Below
    /// half of this sum it is a sphere, as small drops are (Yu and Turk: up to 25 neighbours); in between its shape
    /// changes gradually. With the default reach the sum is 2.8 in a line of particles, 11 in a single sheet of them,
    /// 32 inside water.
    pub fewest: f32,
    /// Factor on the radius of a particle whose neighbours' weights add up to at most 1.5, such as one with a single
    /// neighbour, [0.25, 1], default 1. While this sum goes on from 1.5 to 2.5, the factor rises to 1. (Yu and Turk:
    /// 0.5 for up to 25 neighbours.)
    pub lone: f32,
    /// Fraction of the way to the weighted centre of its neighbourhood by which a particle is moved, [0, 1], default
    /// 0.9 as in Yu and Turk. It smooths sheets and rims. Particles that stay spheres are not moved. The mean
    /// displacement of the neighbours is subtracted: without that, as in the paper, water would shrink away from its
    /// walls. With 0 the pass `shape` takes half the time.
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

/// Thickness (`height`) at the centre of the sprite that each particle adds to the image of water thickness.
/// Elsewhere the sprite adds `height·√(1 − ρ²)·exp(−2ρ²)`, where ρ is the distance from the centre relative to the
/// rim: 0 at the centre, 1 at the rim of the circle or ellipse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Amplitude {
    /// The sprite's integral is the particle's volume, spacing³. Thickness is then the length of the water along z in
    /// scene units, however many particles resolve the same water. Default.
    Volume,
    /// The thesis' 0.8 times the sprite's width (Listing A.15). A sprite then holds about four particle volumes, so
    /// the thickness is about four times that of [`Amplitude::Volume`].
    Source,
}

/// How light is absorbed, scattered and emitted on its way through the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Medium {
    /// Beer's law per channel, with single scattering of the ambient light.
    Physical {
        /// Absorption per scene unit, linear RGB, [0, ∞).
        absorption: [f32; 3],
        /// Scattering per scene unit, linear RGB, [0, ∞).
        scattering: [f32; 3],
    },
    /// Beer's law per channel, with multiple scattering. An infinitely deep body shows its diffuse reflectance under
    /// [`Light::irradiance`](crate::Light::irradiance). A thinner body shows the fraction of this reflectance that
    /// equals the fraction of the light from behind that it blocks.
    ///
    /// Scattering is isotropic (similarity relation), so a measured coefficient has to be reduced: for dense media
    /// such as milk multiply it by `1 - g` with the mean cosine g; for natural waters, whose reflectance depends on
    /// backscattering, use twice the backscattering coefficient. The reflectance of a half space is van de Hulst's
    /// `(1 - s)(1 - 0.139 s)/(1 + 1.17 s)`, `s = √(absorption/(absorption + scattering))` (Multiple Light Scattering,
    /// 1980), corrected for the light that its surface reflects back inside. The surface is shaded as a matte one by
    /// the sun, the scene's shadows and [`Light::shade`](crate::Light::shade). The fluid does not shadow itself.
    Turbid {
        /// Absorption per scene unit, linear RGB, [0, ∞).
        absorption: [f32; 3],
        /// Reduced scattering per scene unit, linear RGB, [0, ∞).
        scattering: [f32; 3],
        /// Radiance that an infinitely deep body emits, linear RGB, [0, ∞), for hot media such as lava.
        emission: [f32; 3],
    },
    /// The thesis' medium: `mix(base·exp(−k T), background, exp(−k_a T))` (thesis, Eq. 3.5 to 3.7), with the length T
    /// of the ray in the water, and the falloffs k of the colour and k_a of the background.
    Source {
        /// Colour of thin water, linear RGB, [0, 1].
        base: [f32; 3],
        /// Falloff per scene unit of colour (RGB) and background (A), [0, ∞).
        falloff: [f32; 4],
    },
}

/// Presets. Red, green and blue are 610, 550 and 465 nm, next to the dominant wavelengths of the primaries of Rec.
/// 709 (611, 549 and 464 nm), except where the publication measured with the three channels of a camera.
///
/// Absorption and scattering of the presets are per metre, those of [`WaterSettings::medium`] per scene unit. If a
/// scene unit is not a metre, use [`thinned(1.0 / units_per_metre)`](Self::thinned) of a preset;
/// [`Settings::new`](crate::Settings::new) does so for the default medium. If a scene is larger than what it shows,
/// such as a glass of beer simulated four metres wide, [`thinned`](Self::thinned) by the ratio of the real width to
/// the width in the scene gives the right picture.
impl Medium {
    /// Pure water: absorption by Pope and Fry (Applied Optics 36, 1997, Table 3), scattering by Morel (1974, fresh
    /// water). Colourless in a glass, blue over ten metres.
    pub const CLEAR: Self = Self::turbid([0.264, 0.0565, 0.0101], [0.000_94, 0.001_47, 0.003_04]);
    /// A pool: absorbs four times as much red and green as pure water and eleven times as much blue, so that a metre is
    /// visibly blue-green. Chosen by eye.
    pub const POOL: Self =
        Self::Physical { absorption: [1.1, 0.24, 0.11], scattering: [0.014, 0.03, 0.04] };
    /// A lake, green: 3 mg/m³ of chlorophyll, computed from the publications that [`OCEAN`](Self::OCEAN) names, and
    /// dissolved organic matter, which absorbs 0.4 per metre at 443 nm and at other wavelengths λ this times
    /// `exp(-0.0176 (λ - 443 nm))` (Babin et al., J. Geophys. Res. 108(C7), 2003).
    pub const LAKE: Self = Self::turbid([0.322, 0.165, 0.408], [0.0205, 0.0232, 0.0287]);
    /// Clear ocean, Jerlov's type IB: 0.1 mg/m³ of chlorophyll (Mobley, Light and Water, 1994). Absorption is that of
    /// Prieur and Sathyendranath (Limnol. Oceanogr. 26, 1981) as Mobley gives it (Eq. 3.27, Table 3.7). Scattering is
    /// that of sea water (Morel 1974) plus that of particles (Gordon and Morel 1983); of the latter the share 0.0183
    /// goes backwards (Petzold's particles). The diffuse attenuation that follows differs from Jerlov's table (Marine
    /// Optics, 1976, Table XXVII) by less than a fifth.
    pub const OCEAN: Self = Self::turbid([0.273, 0.0639, 0.0252], [0.0036, 0.004_55, 0.007_07]);
    /// A river, tan: 100 g/m³ of silt, which scatters 0.51 m²/g (Babin et al., Limnol. Oceanogr. 48, 2003), the share
    /// 0.0183 of it backwards, and absorbs 0.031 m²/g times `exp(-0.0123 (λ - 443 nm))`. Dissolved organic matter is
    /// as in [`LAKE`](Self::LAKE), but absorbs 1 per metre at 443 nm (Babin et al., J. Geophys. Res. 108(C7), 2003).
    pub const RIVER: Self = Self::turbid([0.715, 1.04, 3.05], [1.87, 1.87, 1.87]);
    /// A lake under a glacier, turquoise: 20 g/m³ of rock flour, fine and pale. The flour scatters 1 m²/g, twice as
    /// much as silt, and absorbs 0.003 m²/g at 443 nm, a tenth of what silt absorbs. Both numbers are estimates. With
    /// them the water absorbs red and the flour a little of the blue, which is how Aas and Bogen explain the colour
    /// (Water Resources Research 24, 1988).
    pub const GLACIER: Self = Self::turbid([0.272, 0.0726, 0.0559], [0.733, 0.733, 0.735]);
    /// Whole milk (Jensen et al., A Practical Model for Subsurface Light Transport, 2001, Fig. 5, whose numbers are
    /// per millimetre; reduced scattering; red, green and blue of a camera). Index of refraction 1.35.
    pub const MILK: Self = Self::turbid([1.1, 2.4, 14.0], [2550.0, 3210.0, 3770.0]);
    /// Lager (Narasimhan et al., Acquiring Scattering Properties of Participating Media by Dilution, 2006: Budweiser,
    /// measured with 2.9 litres of it in 23 litres and scaled to undiluted beer; scattering reduced by its mean
    /// cosine g; red, green and blue of a camera). Amber in a glass, black a metre deep. Index of refraction 1.345.
    pub const BEER: Self = Self::turbid([11.5, 24.9, 57.8], [0.0244, 0.0241, 0.0106]);
    /// Honey, amber. At 450 nm a solution of half a gram per millilitre is taken to have an absorbance of 0.5 per
    /// centimetre, which is scaled to undiluted honey. (Of real honeys Beretta et al., Analytica Chimica Acta 533,
    /// 2005, found 0.03 to 3.4.) With growing wavelength λ absorption falls as `exp(-λ / 82 nm)`. This slope is an
    /// estimate: it is the slope of beer, whose colour comes from the same reaction of sugars. No scattering. Index
    /// of refraction 1.49.
    pub const HONEY: Self = Self::turbid([45.8, 95.2, 268.0], [0.0; 3]);
    /// Blood with oxygen: absorption of 150 g/l of haemoglobin by Prahl's table of its molar extinction, reduced
    /// scattering `2200 (λ/500 nm)^-0.66` per metre (Jacques, Phys. Med. Biol. 58, 2013, Table 1). Index of
    /// refraction 1.38.
    pub const BLOOD: Self = Self::turbid([807.0, 23_000.0, 20_600.0], [1930.0, 2070.0, 2310.0]);
    /// Molten basalt of 1490 K, as hot as Kilauea's hottest fountains (1216 °C, 1959). Its emission follows Planck's
    /// law at the three wavelengths and has a luminance of 6800 cd/m², in a unit in which white paper in a full sun
    /// of 100 klx has a radiance of 1. It absorbs 2000 per metre (an estimate), so it is opaque. It has no crust, and
    /// its glow lights nothing else. Index of refraction 1.6.
    pub const LAVA: Self = Self::Turbid {
        absorption: [2000.0; 3],
        scattering: [0.0; 3],
        emission: [0.497, 0.148, 0.0139],
    };

    const fn turbid(absorption: [f32; 3], scattering: [f32; 3]) -> Self {
        Self::Turbid { absorption, scattering, emission: [0.0; 3] }
    }

    /// The thesis' demo, scaled to a particle spacing.
    pub fn source(spacing: f32) -> Self {
        let k = 0.138 / spacing;
        Self::Source { base: [0.306, 0.545, 0.957], falloff: [0.784 * k, 0.784 * k, 0.588 * k, k] }
    }

    /// The medium with absorption and scattering multiplied by `share`, [0, ∞). [`Medium::Source`] has neither; its
    /// falloffs are multiplied instead. A share of 0.1 dilutes the medium tenfold. It also gives the right look to a
    /// scene that is ten times as large as the object that it shows. Emission stays.
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

/// Reflectance of the surface, from the cosine between normal and view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fresnel {
    /// Schlick's approximation; water has f0 = 0.02.
    Schlick {
        /// Reflectance at normal incidence, [0, 1].
        f0: f32,
    },
    /// The thesis' `bias + scale·(1 − n·v)^power` (Listing A.19, with its sign corrected).
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
    /// The reflectance of a liquid by its index of refraction, [1, ∞): water 1.333, beer 1.345, milk 1.35,
    /// honey 1.49.
    pub const fn of_index(n: f32) -> Self {
        let root = (n - 1.0) / (n + 1.0);
        Self::Schlick { f0: root * root }
    }
}

/// Surface foam formation: which of the water's particles are foam, by Weber number.
///
/// `We = scale·ρ·|v − air|²`, with density ρ and velocity v of the particle. A particle whose number reaches the
/// threshold turns to foam within 0.25 to 0.5 seconds. Once it is foam and its number is below the threshold, the foam
/// dissolves ([`foam_lifetime`](Self::foam_lifetime)). Both times vary at random from particle to particle (thesis,
/// Sec. 3.2).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WeberSettings {
    /// Weber number at a density of 1 and a relative speed of 1, (0, ∞): the particle spacing divided by the surface
    /// tension ([`weber`](Self::weber)), or the factor of a reduced form ([`reduced`](Self::reduced)).
    pub scale: f32,
    /// Weber number at and above which a particle foams, (0, ∞). A value does not transfer between simulations: derive
    /// it from the data, for example as the 95th percentile of the particles' Weber numbers over a sequence. The host
    /// computes these as `scale·ρ·|v − air|²`.
    pub threshold: f32,
    /// Mean time that the foam of a particle takes to dissolve, once the particle's Weber number is below the
    /// threshold, seconds, (0, ∞), default 1. Before that, foam lasts. In this time its amount falls evenly from 1 to
    /// 0. For each particle the time is 0.5 to 1.5 times this setting.
    pub foam_lifetime: f32,
    /// World velocity of the air, scene units per second, finite, default 0.
    pub air: [f32; 3],
    /// Density that is used for all particles if there is no density stream, and for particles whose density is 0
    /// (just emitted), negative or NaN. (0, ∞), default 1000.
    pub rest_density: f32,
    /// Seed of the random times, any value, default 0.
    pub seed: u32,
}

/// Surface tension of water in air at 20 °C, N/m.
pub const SURFACE_TENSION: f32 = 0.0728;

impl WeberSettings {
    /// The full Weber number `ρ v² l / σ` in SI units: ρ is the particle's density, v its speed relative to the air,
    /// l the particle `spacing` in metres, and σ the surface tension of water. A particle foams at and above the
    /// Weber number `threshold`.
    pub fn weber(spacing: f32, threshold: f32) -> Self {
        Self { scale: spacing / SURFACE_TENSION, ..Self::reduced(1.0, threshold) }
    }

    /// The full Weber number `ρ v² l / σ` of water whose `spacing` l and speeds v are in scene units. A metre has
    /// `units_per_metre` scene units; densities are in kg/m³.
    pub fn weber_in(spacing: f32, units_per_metre: f32, threshold: f32) -> Self {
        let scale =
            spacing / (units_per_metre * units_per_metre * units_per_metre * SURFACE_TENSION);
        Self { scale, ..Self::reduced(1.0, threshold) }
    }

    /// The reduced form of the thesis' demo, `1e-5·ρ·v²`, where the unit of the speed v is 1/1.43 of the spacing per
    /// second. The demo's thresholds are 50 to 110, by default 80.
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
            ("WeberSettings.scale", self.scale),
            ("WeberSettings.threshold", self.threshold),
            ("WeberSettings.foam_lifetime", self.foam_lifetime),
            ("WeberSettings.rest_density", self.rest_density),
        ] {
            if !value.is_finite() || value <= 0.0 {
                return bad(field, format!("expected more than 0, found {value}"));
            }
        }
        if !self.air.iter().all(|v| v.is_finite()) {
            return bad("WeberSettings.air", format!("{:?}: not finite", self.air));
        }
        Ok(())
    }
}

/// Appearance of surface foam. Without [`Config::surface_foam`](crate::Config) only three of these settings have an
/// effect, and only on spray: [`pattern_period`](Self::pattern_period) and [`time`](Self::time) on
/// [`SpraySettings::clumps`], [`shadow`](Self::shadow) on [`SpraySettings::shade`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfaceFoamSettings {
    /// Extinction per scene unit of foam along the ray, [0, ∞), default 0.4 / spacing: foam that is two particles
    /// thick hides about half of what is behind it.
    pub extinction: f32,
    /// Rate k at which the colour changes from [`back_color`](Self::back_color) to [`front_color`](Self::front_color):
    /// the front colour has the weight `1 − exp(−k·t)`, where t is the thickness of the front layer along the ray. The
    /// front layer is the foam within [`front_depth`](Self::front_depth) behind the frontmost foam. Per scene unit,
    /// [0, ∞), default 0.15 / spacing. No effect if [`front_power`](Self::front_power) is above 0.
    pub front_extinction: f32,
    /// Exponent p of an alternative rule for the front colour (thesis Sec. 3.2), [0, 64]: the weight of
    /// [`front_color`](Self::front_color) is `(thickness of the front layer / front_depth)^p`, at most 1. With 0, the
    /// default, this rule is off and `front_extinction` applies.
    pub front_power: f32,
    /// How far the front layer reaches behind the frontmost foam, scene units, [0, ∞), default 60 spacings. It ends
    /// softly over one more spacing. (With the thesis' 7 spacings drops of foam in front of other foam show as discs,
    /// because at each drop the layer starts at the drop and ends before the other foam.)
    pub front_depth: f32,
    /// Speed at and above which a foam sprite is twice as long, along its motion, as it is wide. Slower sprites are
    /// shorter, down to discs at rest, and so are sprites that move along the view. Spacings per second, (0, ∞),
    /// default 21.
    pub motion_threshold: f32,
    /// Strength of a noise that varies the thickness within a foam sprite. Each sprite has its own noise, as in the
    /// thesis. 0 (off, default) to 1. The noise fades out where its cells are narrower than two texels of the
    /// thickness image, and is gone at one. Either this strength or [`pattern`](Self::pattern) has to be 0.
    pub noise: f32,
    /// Speed at which [`noise`](Self::noise) changes. A sprite shows a plane section of a three-dimensional noise,
    /// and this plane moves at right angles to itself: by so many cells of the noise per second of the particle's
    /// age, [0, 1e3], default 2.
    pub noise_rate: f32,
    /// Strength of a noise that gathers foam into clumps and moves with it, [0, 2], default 1, 0 = off. With 1, about
    /// a tenth of the foam's sprites are at least twice as thick as without the noise, and about a fifth at most a
    /// quarter as thick. Not in the thesis. Has to be 0 if [`noise`](Self::noise) is used.
    pub pattern: f32,
    /// Size of the largest clumps, spacings, [0.001, 1000], default 3.
    pub pattern_size: f32,
    /// Period in seconds in which all clumps are replaced by new ones, because the foam's motion stretches them, (0,
    /// 1e3], default 1. The [`lace`](Self::lace) and [`SpraySettings::clumps`] are renewed in the same period.
    pub pattern_period: f32,
    /// How much thin foam is torn into threads with clear holes between them, [0, 1]. The holes close where foam is
    /// thick. With 0, the default, thin foam is an even veil. On average, threads and holes together hide as much as
    /// the veil would. Not in the thesis.
    pub lace: f32,
    /// Edge length of the cells that contain the largest holes of the lace, spacings, [0.001, 1000], default 4. Where
    /// these cells are smaller than six pixels, the lace fades into smooth foam; at two pixels it is gone.
    pub lace_size: f32,
    /// How strongly the lace shades foam, [0, 2], default 0: threads are brighter, up to a factor of 1.2, and holes
    /// darker, down to a factor of 0.5. The shading also shows on thick foam, whose holes are closed. No effect if
    /// [`lace`](Self::lace) is 0. Not in the thesis.
    pub lace_shade: f32,
    /// Opacity of the layer of bubbles in the water under foam, as a fraction of the opacity of the foam without
    /// lace, [0, 1], default 0. The bubbles show between the threads of the lace and around the edge of foam. Not in
    /// the thesis.
    pub aeration: f32,
    /// Albedo of water with bubbles, linear RGB, 0 to 1, default 0.30, 0.62, 0.66: bubbles scatter all colours, and
    /// the water around them absorbs red.
    pub aerated_color: [f32; 3],
    /// Time of the frame in seconds, finite, default 0. It moves the noise of [`pattern`](Self::pattern) and the lace
    /// with the foam, and that of [`SpraySettings::clumps`] with the spray. If it stays constant, they stay in place,
    /// and foam and spray move through them.
    pub time: f64,
    /// Foam thinner than this fades out, because thin veils look like steam. Scene units, [0, ∞), default one
    /// spacing, 0 = off. Not in the thesis.
    pub min_thickness: f32,
    /// How strongly foam is shaded as a relief, whose height is the thickness of the front layer of foam
    /// ([`front_depth`](Self::front_depth)), [0, 2], default 0.35. Foam is brighter where the relief faces the sun
    /// and darker where it faces away. 0 = flat.
    pub normal_strength: f32,
    /// How strongly foam is shaded by the shape of the whole splash, [0, 1], default 0 = off. The shape around a point
    /// is found from the depths of the foam within six spacings. With 1, only skylight remains where the shape faces
    /// away from the sun, and in hollows all light is dimmed. Not in the thesis.
    pub shape: f32,
    /// Extinction of sunlight in foam, for the shadow that the foam casts, per scene unit, [0, ∞), default 0.25 /
    /// spacing. The default is less than that of [`extinction`](Self::extinction), because most of the light that
    /// foam scatters continues forwards. The shadow of spray is proportional to this value too:
    /// [`SpraySettings::shade`] is relative to it. No effect without [`Config::light_map_size`](crate::Config).
    pub shadow: f32,
    /// Limits [a, b] of the sum of a particle's neighbours' weights (see [`Ellipsoids::reach`]). A particle whose sum
    /// is at most a has no foam, one whose sum is at least b keeps all of its foam, and in between it keeps a part.
    /// Each limit is in [0, 64], b at least a. Default [0, 0]: off. Without the limits, foam on a few particles that
    /// fly together looks like a small star. With an [`Ellipsoids::reach`] of 2.5 a particle in a flat surface has a
    /// sum of about 21; sums grow about with the cube of the reach. The limits do not apply to particles in flat films
    /// that are one particle thick. No effect without [`Kernels::Ellipsoids`]. Not in the thesis.
    pub few_neighbours: [f32; 2],
    /// Albedo of thin foam, linear RGB, 0 to 1, default grey 0.65. (The thesis has no albedo: it blends a
    /// grey of 0.25 over its picture.)
    pub back_color: [f32; 3],
    /// Albedo of foam whose front layer is thick ([`front_extinction`](Self::front_extinction)), linear RGB, 0 to 1,
    /// default white 0.9. (The thesis has no albedo: it blends white over its picture.)
    pub front_color: [f32; 3],
}

impl SurfaceFoamSettings {
    /// The defaults for a particle spacing.
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
            lace_shade: 0.0,
            aeration: 0.0,
            aerated_color: [0.30, 0.62, 0.66],
            time: 0.0,
            min_thickness: spacing,
            normal_strength: 0.35,
            shape: 0.0,
            shadow: 0.25 / spacing,
            few_neighbours: [0.0; 2],
            back_color: [0.65; 3],
            front_color: [0.9; 3],
        }
    }

    /// The thesis' foam for a particle spacing: opaque, with a noise per sprite, without relief and without a shadow
    /// of its own. The extinctions are converted from the thesis' units: 1.43 of its units of length are a spacing,
    /// and in its unit of thickness a sprite holds about 33 particle volumes.
    pub fn thesis(spacing: f32) -> Self {
        let unit = 1.43 * 33.0 / spacing;
        Self {
            extinction: 0.5 * unit,
            front_extinction: unit / 3.0,
            front_depth: 7.0 * spacing,
            noise: 1.0,
            pattern: 0.0,
            min_thickness: 0.0,
            normal_strength: 0.0,
            shadow: 0.0,
            back_color: [0.25; 3],
            front_color: [1.0; 3],
            ..Self::of_spacing(spacing)
        }
    }

    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        range("Settings.surface_foam.extinction", self.extinction, 0.0, f32::MAX)?;
        range("Settings.surface_foam.front_extinction", self.front_extinction, 0.0, f32::MAX)?;
        range("Settings.surface_foam.front_power", self.front_power, 0.0, 64.0)?;
        range("Settings.surface_foam.front_depth", self.front_depth, 0.0, f32::MAX)?;
        range("Settings.surface_foam.motion_threshold", self.motion_threshold, 1.0e-6, f32::MAX)?;
        range("Settings.surface_foam.noise", self.noise, 0.0, 1.0)?;
        range("Settings.surface_foam.pattern", self.pattern, 0.0, 2.0)?;
        if self.noise > 0.0 && self.pattern > 0.0 {
            let why = format!(
                "{} beside Settings.surface_foam.pattern of {}: expected one of them, set the other to 0",
                self.noise, self.pattern
            );
            return Err(crate::error::Error::bad("Settings.surface_foam.noise", why));
        }
        range("Settings.surface_foam.pattern_size", self.pattern_size, 1.0e-3, 1.0e3)?;
        range("Settings.surface_foam.lace", self.lace, 0.0, 1.0)?;
        range("Settings.surface_foam.lace_size", self.lace_size, 1.0e-3, 1.0e3)?;
        range("Settings.surface_foam.lace_shade", self.lace_shade, 0.0, 2.0)?;
        range("Settings.surface_foam.aeration", self.aeration, 0.0, 1.0)?;
        for color in self.aerated_color {
            range("Settings.surface_foam.aerated_color", color, 0.0, 1.0)?;
        }
        range("Settings.surface_foam.pattern_period", self.pattern_period, 1.0e-3, 1.0e3)?;
        if !self.time.is_finite() {
            let why = format!("{}: not finite", self.time);
            return Err(crate::error::Error::bad("Settings.surface_foam.time", why));
        }
        range("Settings.surface_foam.shadow", self.shadow, 0.0, f32::MAX)?;
        range("Settings.surface_foam.min_thickness", self.min_thickness, 0.0, f32::MAX)?;
        range("Settings.surface_foam.normal_strength", self.normal_strength, 0.0, 2.0)?;
        range("Settings.surface_foam.shape", self.shape, 0.0, 1.0)?;
        range("Settings.surface_foam.noise_rate", self.noise_rate, 0.0, 1.0e3)?;
        let [few, many] = self.few_neighbours;
        range("Settings.surface_foam.few_neighbours", few, 0.0, 64.0)?;
        range("Settings.surface_foam.few_neighbours", many, few, 64.0)?;
        for (back, front) in self.back_color.into_iter().zip(self.front_color) {
            range("Settings.surface_foam.back_color", back, 0.0, 1.0)?;
            range("Settings.surface_foam.front_color", front, 0.0, 1.0)?;
        }
        Ok(())
    }
}

/// Appearance of the spray that [`Config::spray`](crate::Config) draws: particles too few together to form a body of
/// water.
///
/// As its density drops, a particle fades from water to spray. Spray is drawn as droplets around the particle's
/// centre, each stretched along its motion, and as mist: one wide faint sprite per particle for finer drops.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpraySettings {
    /// Opacity at the centre of a droplet at rest, [0, 1), default 0.5 (the thesis: 0.4).
    pub opacity: f32,
    /// Half-axis of a particle's droplet in drawn radii (0.656 spacings each) if [`droplets`](Self::droplets) is 1,
    /// [1e-6, 8], default 0.5 as in the thesis. If `droplets` is above 1, the half-axis of each droplet is random, from
    /// 0.36 to 2 times `size/√(0.31·droplets)` and on average 0.6 times that, so that together they cover about as
    /// much as the single droplet would. On a particle that is only spray they are 1.8 times as large.
    pub size: f32,
    /// Maximum half-axis of a droplet (without its motion blur), as a multiple of its distance from the camera plane,
    /// (0, 1]. Larger droplets are reduced to this size. The default 1 reduces none, because a droplet is not drawn if
    /// its half-axis is more than half of this distance. With a smaller value, droplets of particles that fly past the
    /// eye do not look like balls. No effect if [`droplets`](Self::droplets) is 1, and none on mist.
    pub max_angle: f32,
    /// Maximum number of droplets per particle, 1 (the thesis) to 64, default 16. If it is above 1, each particle has
    /// between a fifth and all of this number, chosen at random by its id. A particle that is more than three
    /// quarters spray has fewer and larger droplets, because torn water is many fine drops and an isolated particle a
    /// few large ones. For such a particle a factor falls from 1 at three quarters to 0.3 at 92.5 % spray and above.
    /// The number of droplets is multiplied by this factor, the optical depth of the mist by its cube.
    pub droplets: u32,
    /// Fraction of the rest density below which a particle is drawn only as spray, not as water, [0, ∞), default 0.6.
    /// A particle in a single row of particles, which has 0.48 with the usual cubic spline, is then spray.
    pub all_spray_density: f32,
    /// Fraction of the rest density at and above which a particle's water has its full radius and its surface foam is
    /// not reduced, at least `all_spray_density`, default 0.7. Down to `all_spray_density` the radius falls to half and
    /// the foam to nothing.
    pub full_water_density: f32,
    /// Fraction of the rest density at and above which a particle has no spray, at least `all_spray_density`, default
    /// 0.85. (In a sheet one particle thick the density is 0.70 of the rest density; with the defaults, particles
    /// there are about two thirds spray.) With [`Config::spray`](crate::Config), `all_spray_density` is used in place
    /// of [`WaterSettings::density_threshold`], and `full_water_density` in place of
    /// [`density_full`](WaterSettings::density_full).
    pub no_spray_density: f32,
    /// Maximum distance of droplets from the particle's centre, before [`stretch`](Self::stretch) moves them, in
    /// spacings, [0, 8], default 1.5; 0 as in the thesis.
    pub scatter_radius: f32,
    /// Each droplet is also moved along the particle's velocity, forwards or backwards, as far as the particle moves
    /// in a random time of at most this length, so that torn water flies in strands. Seconds, [0, 1], default 0.
    pub stretch: f32,
    /// Opacity at the centre of a particle's mist, [0, 1), default 0.05. Mist replaces the first of the particle's
    /// droplets; if [`droplets`](Self::droplets) is 1 there is no mist.
    pub mist: f32,
    /// Half-axis of the mist in spacings, [1e-6, 8], default 0.5.
    pub mist_size: f32,
    /// How strongly the droplets and mist of all particles gather in clumps and strands, [0, 3], default 0 = even. No
    /// effect if [`droplets`](Self::droplets) is 1.
    ///
    /// The natural logarithm of the spray's density, relative to its mean, is a sum of octaves of gradient noise:
    /// seven for mist, three for droplets. This setting is the amplitude of the coarsest octave; the amplitude of each
    /// further octave is 1.4 times that of the one before, up to 4. An octave's root mean square is 0.27 of its
    /// amplitude. The coarsest cells are three spacings wide, those of each further octave about half as wide; octaves
    /// with cells narrower than a pixel are left out. The logarithm is limited to at most 8. The density multiplies
    /// the optical depth of mist. A density below 1 leaves out droplets, one above 1 multiplies the droplets' optical
    /// depth.
    ///
    /// Particles that are near each other and move alike share the noise. It moves with them and restarts as the
    /// pattern of foam does ([`SurfaceFoamSettings::pattern_period`], [`SurfaceFoamSettings::time`]). The coarsest
    /// cells are longer along the motion than across it: by twice the length over which [`stretch`](Self::stretch)
    /// spreads the droplets, and up to 4 times as long as wide. Finer cells are less elongated.
    pub clumps: f32,
    /// Maximum ratio of the longest to the shortest half-axis of the ellipsoid that a particle's droplets and mist
    /// fill, [1, 8]. With 1, the default, mist is round, and the droplets of each particle fill a spindle of random
    /// direction and size. Above 1 the ellipsoid is fitted to the particle's neighbours, so that torn water is
    /// strands and sheets of droplets; a single neighbour is enough. Then particles with few neighbours also have
    /// less mist: a lone particle has none, and groups of two or three have next to none. No effect without
    /// [`Kernels::Ellipsoids`], or if [`droplets`](Self::droplets) is 1, because then a particle is a single droplet
    /// without mist.
    pub strand_ratio: f32,
    /// Limits [a, b] of the sum of a particle's neighbours' weights (see [`Ellipsoids::reach`]). A particle whose sum
    /// is at most a is only spray, whatever its density, because many solvers write the rest density for a lone drop
    /// too. If the sum is at least b, the density alone decides; in between the transition is gradual. Each limit is
    /// in [0, 64], b at least a. Default [0, 0]: off. With an [`Ellipsoids::reach`] of 2.5 each of eight particles
    /// close together has a sum of about 6, and a particle in an uneven sheet has 11; sums grow about with the cube of
    /// the reach. The limits do not apply to particles in flat films that are one particle thick. Nor do they apply to
    /// particles whose density is 0, that is, not known yet: these are water. No effect without
    /// [`Kernels::Ellipsoids`] and `Particles::densities`.
    pub few_neighbours: [f32; 2],
    /// Exposure time, by which each droplet becomes a streak along its motion, seconds, [0, 1], default 1/250. A
    /// longer streak is more transparent. (The water itself is drawn at one instant.)
    pub exposure: f32,
    /// Albedo, linear RGB, 0 to 1, default 0.95.
    pub color: [f32; 3],
    /// How dark the shadows of spray are: extinction of sunlight by a particle's spray, relative to that by an equal
    /// amount of foam ([`SurfaceFoamSettings::shadow`]), [0, 64], default 0.5. If [`droplets`](Self::droplets) is
    /// above 1, the extinction is also multiplied by the square of the factor that reduces the number of a particle's
    /// droplets, which is `0.3² = 0.09` for a particle that is only spray. The half-axis of the shadow of such a
    /// particle is at least 0.6 [`scatter_radius`](Self::scatter_radius). No effect without a map of the sunlight in
    /// the water ([`Config::light_map_size`](crate::Config)).
    pub shade: f32,
    /// Weight s of multiple scattering in the shadows on spray, [0, 1], default 0. The transmittance T of sunlight
    /// becomes `(1 − s)·T + s·T^¼` (an octave of Wrenninge, Kulla, Lundqvist 2013), because light that droplets
    /// scatter forwards penetrates farther.
    pub scattering: f32,
    /// Strength of screen-space self-shadowing, [0, 4], default 0. Each pixel of spray is compared with five points
    /// that lie towards the sun on the screen, at most a 22nd of the picture's height away. If the spray there is
    /// denser than at the pixel, the pixel is darker. If it is thinner, the pixel is brighter, but never brighter
    /// than in full sunlight. This shows shadows that are too fine for a light map. Where sunlight is lost, skylight
    /// is dimmed too, but less.
    pub relief: f32,
    /// Light that the middle of a glinting droplet sends to the eye in addition, relative to the sunlight that it
    /// scatters, [0, 64], default 0. A glint is 0.35 times as wide as its droplet and at least 1.4 pixels. On average
    /// one droplet in 32 glints. This is decided for each droplet by its particle's id and its number, so it does not
    /// change over time. There are no glints if [`droplets`](Self::droplets) is 1.
    pub glints: f32,
    /// Whether the light of spray is added to the light from behind (the thesis), without dimming it. Default false:
    /// spray is composited over what is behind.
    pub additive: bool,
}

impl Default for SpraySettings {
    fn default() -> Self {
        Self {
            opacity: 0.5,
            size: 0.5,
            max_angle: 1.0,
            droplets: 16,
            all_spray_density: 0.6,
            full_water_density: 0.7,
            no_spray_density: 0.85,
            scatter_radius: 1.5,
            stretch: 0.0,
            mist: 0.05,
            mist_size: 0.5,
            clumps: 0.0,
            strand_ratio: 1.0,
            few_neighbours: [0.0; 2],
            exposure: 1.0 / 250.0,
            color: [0.95; 3],
            shade: 0.5,
            scattering: 0.0,
            relief: 0.0,
            glints: 0.0,
            additive: false,
        }
    }
}

impl SpraySettings {
    /// The thesis' spray: one added sprite per particle.
    pub const SOURCE: Self = Self {
        opacity: 0.4,
        size: 0.5,
        max_angle: 1.0,
        droplets: 1,
        all_spray_density: 0.35,
        full_water_density: 0.45,
        no_spray_density: 0.35,
        scatter_radius: 0.0,
        stretch: 0.0,
        mist: 0.0,
        mist_size: 0.5,
        clumps: 0.0,
        strand_ratio: 1.0,
        few_neighbours: [0.0; 2],
        exposure: 1.0 / 60.0,
        color: [1.0; 3],
        shade: 0.5,
        scattering: 0.0,
        relief: 0.0,
        glints: 0.0,
        additive: true,
    };

    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        range("Settings.spray.opacity", self.opacity, 0.0, 1.0 - f32::EPSILON)?;
        range("Settings.spray.size", self.size, 1.0e-6, 8.0)?;
        range("Settings.spray.max_angle", self.max_angle, 1.0e-6, 1.0)?;
        range("Settings.spray.droplets", self.droplets as f32, 1.0, 64.0)?;
        let all = self.all_spray_density;
        range("Settings.spray.all_spray_density", all, 0.0, f32::MAX)?;
        range("Settings.spray.full_water_density", self.full_water_density, all, f32::MAX)?;
        range("Settings.spray.no_spray_density", self.no_spray_density, all, f32::MAX)?;
        range("Settings.spray.scatter_radius", self.scatter_radius, 0.0, 8.0)?;
        range("Settings.spray.stretch", self.stretch, 0.0, 1.0)?;
        range("Settings.spray.mist", self.mist, 0.0, 1.0 - f32::EPSILON)?;
        range("Settings.spray.mist_size", self.mist_size, 1.0e-6, 8.0)?;
        range("Settings.spray.clumps", self.clumps, 0.0, 3.0)?;
        range("Settings.spray.strand_ratio", self.strand_ratio, 1.0, 8.0)?;
        let [few, many] = self.few_neighbours;
        range("Settings.spray.few_neighbours", few, 0.0, 64.0)?;
        range("Settings.spray.few_neighbours", many, few, 64.0)?;
        range("Settings.spray.shade", self.shade, 0.0, 64.0)?;
        range("Settings.spray.scattering", self.scattering, 0.0, 1.0)?;
        range("Settings.spray.relief", self.relief, 0.0, 4.0)?;
        range("Settings.spray.glints", self.glints, 0.0, 64.0)?;
        range("Settings.spray.exposure", self.exposure, 0.0, 1.0)?;
        for color in self.color {
            range("Settings.spray.color", color, 0.0, 1.0)?;
        }
        Ok(())
    }
}

/// Appearance of the surface noise (van der Laan et al. 2009): ripples finer than the particles, which move with them.
/// No effect without [`Config::noise`](crate::Config::noise).
///
/// Each particle has its own gradient noise. The sum of these noises is a height on the front surface of the water,
/// and its slope turns the normals. The default is the publication's surface, on all water;
/// [`AIRBORNE`](Self::AIRBORNE) is for water in the air only. The publication's foam is grey where the height is far
/// above or below 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfaceNoiseSettings {
    /// Height that a noise value of 1 adds to the water's surface, in drawn radii (0.656 spacings each), [0, 16],
    /// default 0.336, 0 = flat. Only the normals follow this height; depth and outline stay. (The publication gives
    /// this number as the weight of the noise's derivatives, in a unit of its own.)
    pub weight: f32,
    /// How fast a particle's noise fades with the particle's depth below the surface: if the front of the particle is
    /// `drawn radius / falloff` below it, the noise has 1/e of its strength. [0, 64], default 2; 0 means no fading.
    pub falloff: f32,
    /// Half-axis of a particle's noise in drawn radii, [0.001, 8], default 2.
    pub size: f32,
    /// Number of cells of a particle's noise per drawn radius, [0.001, 16], default 1: somewhat finer than the particles.
    pub cells: f32,
    /// Fraction by which the height is reduced where the water lies on the scene, that is, where there is no air
    /// between the water and the scene behind it, [0, 1], default 0, as in the publication. With 1 only water in the
    /// air (jets, sheets, drops) has ripples, because a solver's particles are coarsest in the air; a pool keeps the
    /// simulated waves alone. [`foam`](Self::foam) is not reduced. No effect with `Bed::Source`.
    pub airborne: f32,
    /// Amount of the publication's foam where the noise is 1 or −1; elsewhere the amount is proportional to the noise's
    /// magnitude. An amount of 1 or more is full foam. [0, 64], default 0: no such foam.
    pub foam: f32,
    /// Albedo of that foam, linear RGB, 0 to 1, default grey 0.5.
    pub color: [f32; 3],
}

impl Default for SurfaceNoiseSettings {
    fn default() -> Self {
        Self {
            weight: 0.336,
            falloff: 2.0,
            size: 2.0,
            cells: 1.0,
            airborne: 0.0,
            foam: 0.0,
            color: [0.5; 3],
        }
    }
}

impl SurfaceNoiseSettings {
    /// Ripples on water in the air (jets, sheets, drops) and none on water that lies on the scene.
    /// [`weight`](Self::weight) and [`cells`](Self::cells) are chosen by eye: reflections in a jet break up, and the
    /// scene behind it can still be recognised.
    pub const AIRBORNE: Self = Self {
        weight: 0.33,
        falloff: 2.0,
        size: 2.0,
        cells: 0.7,
        airborne: 1.0,
        foam: 0.0,
        color: [0.5; 3],
    };

    #[cfg(feature = "diagnostics")]
    /// Noise on all water, in the air or not, with the publication's foam. `foam`, the strength of that foam, is 1
    /// here: the paper gives no number, and with 1 the foam is visible.
    pub const SOURCE: Self = Self {
        weight: 0.336,
        falloff: 2.0,
        size: 2.0,
        cells: 1.0,
        airborne: 0.0,
        foam: 1.0,
        color: [0.5; 3],
    };

    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), crate::error::Error> {
        range("Settings.noise.weight", self.weight, 0.0, 16.0)?;
        range("Settings.noise.falloff", self.falloff, 0.0, 64.0)?;
        range("Settings.noise.size", self.size, 1.0e-3, 8.0)?;
        range("Settings.noise.cells", self.cells, 1.0e-3, 16.0)?;
        range("Settings.noise.airborne", self.airborne, 0.0, 1.0)?;
        range("Settings.noise.foam", self.foam, 0.0, 64.0)?;
        for color in self.color {
            range("Settings.noise.color", color, 0.0, 1.0)?;
        }
        Ok(())
    }
}

/// Upper limit of a setting whose range is open: products of a few such numbers stay finite.
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

impl Default for SurfaceFoamSettings {
    fn default() -> Self {
        Self::of_spacing(0.05)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The constant is right: the mean of the kernel `√(1 − ρ²)·exp(−2ρ²)` over its unit disc is computed by the
    /// midpoint rule in u = ρ².
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
        // The constant is rounded to three digits.
        assert!((volumes - f64::from(SOURCE_VOLUMES)).abs() < 5.0e-3, "{volumes}");
    }

    /// Red, green and blue of the presets, nm.
    const WAVES: [f64; 3] = [610.0, 550.0, 465.0];
    /// Absorption of pure water at the three wavelengths `WAVES`, per metre (Pope and Fry 1997, Table 3).
    const WATER: [f64; 3] = [0.2644, 0.0565, 0.0101];
    /// Absorption of chlorophyll at the three wavelengths `WAVES`, divided by that at 440 nm (Mobley 1994, Table
    /// 3.7).
    const CHLOROPHYLL: [f64; 3] = [0.252, 0.357, 0.8935];

    /// Scattering of water (Morel 1974), from its value at 400 nm.
    fn molecules(at_400: f64) -> [f64; 3] {
        WAVES.map(|wave| at_400 * (400.0 / wave).powf(4.32))
    }

    const FRESH: f64 = 0.00583;
    const SEA: f64 = 0.00758;

    /// Absorption, and twice the backscattering, per metre at the wavelengths `WAVES`: of water with this much
    /// `chlorophyll` (mg/m³) and with `dissolved` matter (its absorption per metre at 443 nm). `water`: scattering of
    /// pure water at 400 nm.
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

    /// Absorption, and twice the backscattering, per metre at the wavelengths `WAVES`: of water with `grams` g/m³ of
    /// silt or rock flour, of which a gram absorbs `absorbs` m² (at 443 nm) and scatters `scatters` m².
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
        // From Narasimhan's table (per centimetre, times 100), scaled from the diluted to the undiluted beer.
        let diluted = |k: [f64; 3]| per_millimetre(k.map(|k| 0.01 * k * 23.0 / 2.9));
        let absorbed = diluted([0.1449, 0.3141, 0.7286]);
        let honey = WAVES.map(|wave| {
            let tenfold = std::f64::consts::LN_10;
            100.0 * tenfold * 0.5 * (1.4 / 0.5) * (-(wave - 450.0) / 82.0).exp()
        });
        // Molar extinction per centimetre, times grams per mole.
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
                // The presets are rounded to three digits.
                assert!((k - expected).abs() <= 0.01 * expected, "{name}: {k} is not {expected}");
            }
        }
        // Planck's law at one luminance, with Rec. 709 weights.
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

    /// The preset `OCEAN` attenuates sunlight with depth as Jerlov's table says, within a fifth. The attenuation is
    /// absorption plus backscattering, divided by the mean cosine of a high sun's light under water (Gordon 1989).
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
