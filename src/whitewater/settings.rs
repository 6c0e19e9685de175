//! Settings of whitewater: spray, foam and bubbles that are particles of their own (Akinci et al. 2013).

use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(WhitewaterConfig, WhitewaterSettings);

/// Configuration of whitewater, which determines memory and pipelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct WhitewaterConfig {
    /// Maximum number of whitewater particles per frame, at least 1.
    pub max_particles: u32,
    /// Maximum stride of their streams in bytes, a multiple of 4, default 12.
    pub max_stride: u32,
    /// Whether frames may have [`WhitewaterParticles::packets`](crate::WhitewaterParticles::packets). Default false.
    pub packets: bool,
    /// How they are rasterized. `None` selects the path that was the fastest on lavapipe:
    /// [`WhitewaterSplat::Compute64`] if its feature is enabled, otherwise [`WhitewaterSplat::Compute`]. Not yet
    /// measured on GPUs.
    #[cfg(feature = "diagnostics")]
    pub splat: Option<WhitewaterSplat>,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) splat: Option<WhitewaterSplat>,
    /// How the environment lights them.
    #[cfg(feature = "diagnostics")]
    pub irradiance: Irradiance,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) irradiance: Irradiance,
    /// How their ambient occlusion is sampled.
    #[cfg(feature = "diagnostics")]
    pub occlusion: Occlusion,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) occlusion: Occlusion,
}

impl WhitewaterConfig {
    /// The defaults for a maximum number of particles.
    pub fn new(max_particles: u32) -> Self {
        Self {
            max_particles,
            max_stride: 12,
            packets: false,
            splat: None,
            irradiance: Irradiance::Prefiltered,
            occlusion: Occlusion::Fast,
        }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        if self.max_particles == 0 {
            return Err(Error::bad(
                "Config.whitewater.max_particles",
                "zero; it sizes the buffers",
            ));
        }
        if self.max_stride < 12 || !self.max_stride.is_multiple_of(4) {
            let why = format!("expected a multiple of 4 of at least 12, found {}", self.max_stride);
            return Err(Error::bad("Config.whitewater.max_stride", why));
        }
        Ok(())
    }
}

/// How whitewater particles are rasterized. All paths give the same picture, the two compute paths to the last
/// bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum WhitewaterSplat {
    /// One quad per particle with depth test and blending. Takes 12 more bytes per pixel.
    Raster,
    /// One invocation per particle with 32-bit atomics, in two passes; the second writes the attributes of the
    /// frontmost particle.
    Compute,
    /// One invocation per particle with 64-bit atomics, in one pass. Needs
    /// [`buffer_int64_atomics`](crate::EnabledFeatures::buffer_int64_atomics).
    Compute64,
}

/// How ambient occlusion of foam by foam, water and scene is sampled (Sec. 2.4.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Occlusion {
    /// As printed: as many samples as the spheres have pixels, the same in every pixel.
    Reference,
    /// Each pixel of a 4×4 block evaluates a sixteenth of the samples, and the blur recombines them. A pixel takes 2 to 20
    /// per sphere, whatever the sphere's size: 1/16 of [`WhitewaterSettings::max_samples`], of which values over 320 count
    /// as 320. Samples come in opposite pairs, so that each pixel alone finds half of them occluded where a half
    /// space is solid. Default.
    Fast,
}

/// How light of the environment reaches foam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Irradiance {
    /// One look-up per pixel in an irradiance map that is filtered once per environment; the paper calls this the
    /// faster way. Default.
    Prefiltered,
    /// Look-ups in the directions of the first occlusion pass' samples (Sec. 2.4.2), also if `passes` is 0.
    Sampled,
}

/// How particles behind the water's surface are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Submerged {
    /// The water in front of them attenuates them, like everything in it. Default.
    Water,
    /// The paper's falloff, `f(distance behind, depth, n, m)` (Eq. 1 and Sec. 2.2), which reaches zero at `depth`. The
    /// particles are then composited in front of the water.
    Falloff {
        /// Metres, (0, ∞), recommended 6 spacings.
        depth: f32,
        /// Exponent, [0.1, 16], recommended 2.
        n: f32,
        /// Exponent, [0.1, 16], recommended 4.
        m: f32,
    },
}

/// Maximum distance between an occluder and the point that it occludes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum OcclusionReach {
    /// In search radii, (0, ∞), default 1.
    Radii(f32),
    /// In scene units, (0, ∞); the paper: 5 metres.
    Metres(f32),
}

/// How light and shadow combine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum ShadowMixing {
    /// light × (1 − shadow): never negative, and independent of exposure. Default.
    Scaled,
    /// The paper's light − shadow, clamped to 1 before (Sec. 2.5).
    Source,
}

/// Appearance of whitewater. No effect without [`Config::whitewater`](crate::Config).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WhitewaterSettings {
    /// Radius of particles without a radius stream, scene units, (0, ∞), default 0.15 spacings (0.0075 for a spacing of
    /// 0.05). It is divided by 1 to [`sizes`](Self::sizes), chosen per particle; a bubble's is scaled by
    /// [`bubble_size`](Self::bubble_size).
    pub radius: f32,
    /// How particles behind the water's surface are drawn.
    pub submerged: Submerged,
    /// Thickness ρ_mod at which the intensity `ρ^e / (ρ_mod + ρ^e)` is one half (for e = 1), (0, 1e6], default
    /// 3 (Sec. 2.3).
    pub half_intensity_thickness: f32,
    /// Exponent e of the intensity, [0.1, 16], default 1.25.
    pub exponent: f32,
    /// Number of occlusion passes, each with a larger sphere, 0 to 8, default 3 (AO_#Passes, Sec. 2.4.1).
    pub passes: u32,
    /// Radius of the first of those spheres in particle radii, [0, 100], default 1 (AO_InitSRFac).
    pub search_radius: f32,
    /// Increase of the sphere's radius from pass to pass, in particle radii, [0, 100], default 7 (AO_SRIncFac).
    pub search_radius_step: f32,
    /// Samples per cubic pixel, [0, 16], default 0.5 (AO_SDens). Used by `Occlusion::Reference`; the default mode uses
    /// a fixed share of the samples at any size.
    pub sample_density: f32,
    /// Minimum number of samples per sphere, 1 to `max_samples`, default 16. Used by `Occlusion::Reference` only.
    pub min_samples: u32,
    /// Maximum number of samples per sphere, `min_samples` to 512, default 512.
    pub max_samples: u32,
    /// Maximum distance between an occluder and the point behind it (AO_MaxOcclDist).
    #[cfg(feature = "diagnostics")]
    pub reach: OcclusionReach,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) reach: OcclusionReach,
    /// Opacity of the fluid's surface as an occluder, 0 to 1, default 0.5.
    pub fluid_opacity: f32,
    /// Opacity of the scene as an occluder, 0 to 1, default 1.
    pub scene_opacity: f32,
    /// Factor s of the shadow `s · occlusion^e + o`, [0, 16], default 1.
    pub shadow_scale: f32,
    /// Exponent e of the shadow, [0.1, 16], default 1.5.
    pub shadow_exponent: f32,
    /// Offset o of the shadow, [-1, 1], default -0.05.
    pub shadow_offset: f32,
    /// Colour that remains in shadow, linear RGB, 0 to 1, default a deep blue (0, 0, 0.2).
    pub shadow_color: [f32; 3],
    /// Albedo, linear RGB, 0 to 1, default 0.9.
    pub albedo: [f32; 3],
    /// Brightness relative to what the albedo reflects, [0, 64], default 1. Twice this value is the paper's
    /// C_IrrScale (Sec. 2.5), which exceeds 2 for values above 1.
    pub scale: f32,
    /// Exponents n and m of the shape `(1 − x^n)^m` of a foam particle, with x the distance from its centre in
    /// radii (Eq. 1, Sec. 2.2). [0.1, 16], default 2.25 and 1. Shapes, lives and sizes other than the defaults
    /// cost a few powers per pixel.
    pub foam_shape: [f32; 2],
    /// The same exponents for spray, default 1.5 and 1.
    pub spray_shape: [f32; 2],
    /// The same exponents for a bubble, whose thickness is 1 minus the shape. Default 2 and 1.
    pub bubble_shape: [f32; 2],
    /// Exponents n and m of the fade `(1 − a^n)^m` at the relative age a (Sec. 2.2). [0.1, 16], default 2 and
    /// 0.4.
    pub life: [f32; 2],
    /// A radius is divided by an integer from 1 to this, chosen by the particle's id, for variation. 1 to 64,
    /// default 5 (Sec. 2.1).
    pub sizes: u32,
    /// Radius of a bubble relative to the other particles, (0, 1], default 0.5 (Sec. 2.1).
    pub bubble_size: f32,
    /// Radius of the blur of light and shadow, in radii of the first occlusion sphere, [0, 16], default 1.5
    /// (Sec. 2.5). Up to 32 pixels every texel contributes; beyond that an evenly spaced subset, at least 11 on
    /// each side.
    pub blur: f32,
    /// How light and shadow combine.
    #[cfg(feature = "diagnostics")]
    pub mixing: ShadowMixing,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) mixing: ShadowMixing,
}

impl WhitewaterSettings {
    /// The defaults for a particle spacing of the water.
    pub fn of_spacing(spacing: f32) -> Self {
        Self {
            radius: 0.15 * spacing,
            submerged: Submerged::Water,
            half_intensity_thickness: 3.0,
            exponent: 1.25,
            passes: 3,
            search_radius: 1.0,
            search_radius_step: 7.0,
            sample_density: 0.5,
            min_samples: 16,
            max_samples: 512,
            reach: OcclusionReach::Radii(1.0),
            fluid_opacity: 0.5,
            scene_opacity: 1.0,
            shadow_scale: 1.0,
            shadow_exponent: 1.5,
            shadow_offset: -0.05,
            shadow_color: [0.0, 0.0, 0.2],
            albedo: [0.9; 3],
            scale: 1.0,
            foam_shape: [2.25, 1.0],
            spray_shape: [1.5, 1.0],
            bubble_shape: [2.0, 1.0],
            life: [2.0, 0.4],
            sizes: 5,
            bubble_size: 0.5,
            blur: 1.5,
            mixing: ShadowMixing::Scaled,
        }
    }

    /// Whether particles have shapes other than the paper's, or fade behind the water's surface as in the paper.
    /// Shaders have a variant for either.
    pub(crate) fn shaped(&self) -> bool {
        let sources = Self::default();
        let numbers = |look: &Self| {
            (
                [look.foam_shape, look.spray_shape, look.bubble_shape, look.life],
                look.sizes,
                look.bubble_size,
            )
        };
        self.submerged != Submerged::Water || numbers(self) != numbers(&sources)
    }

    /// Checks the ranges; the message names the field.
    pub(crate) fn check(&self) -> Result<(), Error> {
        range("Settings.whitewater.radius", self.radius, 1.0e-9, f32::MAX)?;
        if let Submerged::Falloff { depth, n, m } = self.submerged {
            range("Settings.whitewater.submerged.depth", depth, 1.0e-9, f32::MAX)?;
            range("Settings.whitewater.submerged.n", n, 0.1, 16.0)?;
            range("Settings.whitewater.submerged.m", m, 0.1, 16.0)?;
        }
        range(
            "Settings.whitewater.half_intensity_thickness",
            self.half_intensity_thickness,
            1.0e-6,
            1.0e6,
        )?;
        range("Settings.whitewater.exponent", self.exponent, 0.1, 16.0)?;
        range("Settings.whitewater.passes", self.passes as f32, 0.0, 8.0)?;
        range("Settings.whitewater.search_radius", self.search_radius, 0.0, 100.0)?;
        range("Settings.whitewater.search_radius_step", self.search_radius_step, 0.0, 100.0)?;
        range("Settings.whitewater.sample_density", self.sample_density, 0.0, 16.0)?;
        let (min, max) = (self.min_samples as f32, self.max_samples as f32);
        range("Settings.whitewater.min_samples", min, 1.0, 512.0)?;
        range("Settings.whitewater.max_samples", max, min, 512.0)?;
        let (OcclusionReach::Radii(reach) | OcclusionReach::Metres(reach)) = self.reach;
        range("Settings.whitewater.reach", reach, 1.0e-9, f32::MAX)?;
        range("Settings.whitewater.shadow_scale", self.shadow_scale, 0.0, 16.0)?;
        range("Settings.whitewater.shadow_exponent", self.shadow_exponent, 0.1, 16.0)?;
        range("Settings.whitewater.shadow_offset", self.shadow_offset, -1.0, 1.0)?;
        range("Settings.whitewater.fluid_opacity", self.fluid_opacity, 0.0, 1.0)?;
        range("Settings.whitewater.scene_opacity", self.scene_opacity, 0.0, 1.0)?;
        range("Settings.whitewater.scale", self.scale, 0.0, 64.0)?;
        for (field, exponents) in [
            ("Settings.whitewater.foam_shape", self.foam_shape),
            ("Settings.whitewater.spray_shape", self.spray_shape),
            ("Settings.whitewater.bubble_shape", self.bubble_shape),
            ("Settings.whitewater.life", self.life),
        ] {
            exponents.into_iter().try_for_each(|exponent| range(field, exponent, 0.1, 16.0))?;
        }
        range("Settings.whitewater.sizes", self.sizes as f32, 1.0, 64.0)?;
        range("Settings.whitewater.bubble_size", self.bubble_size, 1.0e-6, 1.0)?;
        range("Settings.whitewater.blur", self.blur, 0.0, 16.0)?;
        for (shadow, albedo) in self.shadow_color.into_iter().zip(self.albedo) {
            range("Settings.whitewater.shadow_color", shadow, 0.0, 1.0)?;
            range("Settings.whitewater.albedo", albedo, 0.0, 1.0)?;
        }
        Ok(())
    }
}

impl Default for WhitewaterSettings {
    fn default() -> Self {
        Self::of_spacing(0.05)
    }
}
