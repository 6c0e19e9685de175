//! Settings of whitewater: spray, foam and bubbles that are particles of their own (Akinci et al. 2013).

use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(WhitewaterConfig, WhitewaterSettings);

/// Configuration of whitewater. It determines what memory and which pipelines are created.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct WhitewaterConfig {
    /// Maximum number of whitewater particles per frame, at least 1.
    pub max_particles: u32,
    /// Maximum stride in bytes, from particle to particle, of the host's buffers with whitewater attributes, a
    /// multiple of 4, at least 12, default 16: the largest stride of the buffers of a
    /// [`Generator`](crate::Generator).
    pub max_stride: u32,
    /// Whether frames may give the particles in groups that are culled as a whole
    /// ([`WhitewaterParticles::packets`](crate::WhitewaterParticles::packets)). Default false.
    pub packets: bool,
    /// How whitewater is rasterized. `None` selects the path that was the fastest on lavapipe, a CPU driver:
    /// [`WhitewaterSplat::Compute64`] if its feature is enabled, otherwise [`WhitewaterSplat::Compute`]. Not yet
    /// measured on GPUs.
    #[cfg(feature = "diagnostics")]
    pub splat: Option<WhitewaterSplat>,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) splat: Option<WhitewaterSplat>,
    /// How the environment lights whitewater.
    #[cfg(feature = "diagnostics")]
    pub irradiance: Irradiance,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) irradiance: Irradiance,
    /// How the ambient occlusion of whitewater is sampled.
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
            max_stride: 16,
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

/// How whitewater particles are rasterized. All paths give the same picture, and the two compute paths even give the
/// same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum WhitewaterSplat {
    /// One quad per particle with depth test and blending. Takes 12 bytes per pixel more than the compute paths.
    Raster,
    /// One compute invocation per particle with 32-bit atomics, in two passes: the first finds depth and thickness,
    /// the second writes the attributes of each pixel's frontmost particle.
    Compute,
    /// One compute invocation per particle with 64-bit atomics, in one pass. Needs
    /// [`buffer_int64_atomics`](crate::EnabledFeatures::buffer_int64_atomics).
    Compute64,
}

/// How the ambient occlusion of foam is sampled (Sec. 2.4.1). Foam is occluded by other foam, by water and by the
/// scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Occlusion {
    /// As in the paper: the number of occlusion samples of a sphere is proportional to its volume on the screen, in
    /// cubic pixels ([`WhitewaterSettings::sample_density`]), but at least [`WhitewaterSettings::min_samples`] and at
    /// most [`WhitewaterSettings::max_samples`]. All pixels use the same sample positions in the unit sphere.
    Reference,
    /// Each pixel of a 4×4 block evaluates a sixteenth of the samples, and the blur recombines them. A pixel takes
    /// `min(max_samples, 320) / 16` samples per sphere, rounded down to an even number but at least 2 (so at most
    /// 20), whatever the sphere's size ([`WhitewaterSettings::max_samples`]). Samples come in opposite pairs: a plane
    /// through the sphere's centre has exactly half of each pixel's samples behind it, whatever its slope. (How much
    /// such a sample is occluded falls with its distance behind the plane.) Default.
    Fast,
}

/// How light of the environment reaches foam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Irradiance {
    /// The environment's light is one look-up per pixel in an irradiance map, which is filtered once per environment;
    /// the paper calls this the faster way. Default.
    Prefiltered,
    /// One look-up in the environment for each sample of the first occlusion sphere, in the sample's direction, or,
    /// if that points behind the foam's surface, in its mirror image in front (Sec. 2.4.2). This needs no occlusion
    /// passes: [`WhitewaterSettings::passes`] may be 0.
    Sampled,
}

/// How particles behind the water's surface are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Submerged {
    /// The water in front of the submerged particles attenuates their light, as it attenuates everything behind it.
    /// Default.
    Water,
    /// The paper's falloff (Eq. 1 and Sec. 2.2): the thickness of a particle at a distance d behind the surface is
    /// multiplied by `(1 − (d / depth)^n)^m`, which reaches 0 at `depth`. The particles are then composited in front
    /// of the water, which does not attenuate them.
    Falloff {
        /// Scene units, (0, ∞), recommended 6 spacings.
        depth: f32,
        /// Exponent, [0.1, 16], recommended 2.
        n: f32,
        /// Exponent, [0.1, 16], recommended 4.
        m: f32,
    },
}

/// Reach of the ambient occlusion on whitewater: the depth difference between an occluder and a point behind it from
/// which on the occluder does not darken the point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum OcclusionReach {
    /// Multiple of the radius of the occlusion sphere ([`WhitewaterSettings::search_radius`]), which differs from pass
    /// to pass, (0, ∞), default 1.
    Radii(f32),
    /// In scene units, (0, ∞); the paper: 5 metres.
    Metres(f32),
}

/// How the light that whitewater reflects and the shadow on it combine. In both formulas `shadow`, the shadow from
/// ambient occlusion, is already multiplied by `1 − shadow_color` ([`WhitewaterSettings::shadow_color`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum ShadowMixing {
    /// Light that remains: `light · (1 − shadow)`, never negative, and proportional to the light, whatever the
    /// exposure. Default.
    Scaled,
    /// `max(min(light, 1) − shadow, 0)`, the paper's difference (Sec. 2.5).
    Source,
}

/// Appearance of whitewater. No effect without [`Config::whitewater`](crate::Config).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct WhitewaterSettings {
    /// Radius of particles that have none of their own, scene units, (0, ∞), default 0.15 spacings (0.0075 for a
    /// spacing of 0.05). Every particle's radius is divided by an integer from 1 to [`sizes`](Self::sizes); a
    /// bubble's is also multiplied by [`bubble_size`](Self::bubble_size).
    pub radius: f32,
    /// How particles behind the water's surface are drawn.
    pub submerged: Submerged,
    /// Constant ρ_mod of the intensity `ρ^e / (ρ_mod + ρ^e)`, the opacity of foam of a thickness ρ (Sec. 2.3),
    /// (0, 1e6], default 3. The intensity is one half where `ρ^e = ρ_mod`; thickness has no unit.
    pub half_intensity_thickness: f32,
    /// Exponent e of the intensity (opacity) of foam, `ρ^e / (ρ_mod + ρ^e)`, [0.1, 16], default 1.25.
    pub exponent: f32,
    /// Number of ambient-occlusion passes, 0 to 8, default 3 (AO_#Passes, Sec. 2.4.1). Each pass samples a larger
    /// sphere around the particle.
    pub passes: u32,
    /// Constant part of the occlusion spheres' radii, [0, 100], default 1 (AO_InitSRFac): the sphere of occlusion
    /// pass k = 1, 2, … has a radius of `search_radius + k · search_radius_step` particle radii.
    pub search_radius: f32,
    /// Increase of the occlusion sphere's radius from pass to pass, in particle radii, [0, 100], default 7
    /// (AO_SRIncFac). See [`search_radius`](Self::search_radius).
    pub search_radius_step: f32,
    /// Occlusion samples per cubic pixel of the sphere's volume, [0, 16], default 0.5 (AO_SDens). Used by
    /// `Occlusion::Reference` (feature `diagnostics`) only; otherwise the number of samples is the same at any size.
    pub sample_density: f32,
    /// Minimum number of samples per sphere, 1 to `max_samples`, default 16. Used by `Occlusion::Reference` (feature
    /// `diagnostics`) only.
    pub min_samples: u32,
    /// Maximum number of occlusion samples, `min_samples` to 512, default 512. By default the 16 pixels of a 4×4
    /// block share the samples of a sphere, and the maximum is for all 16 together; they take at least 32 and at most
    /// 320. With `Occlusion::Reference` (feature `diagnostics`) each pixel takes up to this many samples per sphere.
    pub max_samples: u32,
    /// Depth difference between an occluder and a point behind it at which the occlusion has fallen to 0
    /// (AO_MaxOcclDist).
    #[cfg(feature = "diagnostics")]
    pub reach: OcclusionReach,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) reach: OcclusionReach,
    /// Opacity of the fluid's surface as an occluder, 0 to 1, default 0.5.
    pub fluid_opacity: f32,
    /// Opacity of the scene as an occluder, 0 to 1, default 1.
    pub scene_opacity: f32,
    /// Factor s of the shadow `(s · occlusion)^e + o`, [0, 16], default 1.
    pub shadow_scale: f32,
    /// Exponent e of the shadow `(s · occlusion)^e + o`, [0.1, 16], default 1.5.
    pub shadow_exponent: f32,
    /// Offset o of the shadow `(s · occlusion)^e + o`, [-1, 1], default -0.05.
    pub shadow_offset: f32,
    /// Share of the light that foam in full shadow (occlusion) keeps, linear RGB, 0 to 1, default a deep blue (0, 0,
    /// 0.2).
    pub shadow_color: [f32; 3],
    /// Albedo, linear RGB, 0 to 1, default 0.9.
    pub albedo: [f32; 3],
    /// Factor on the light that foam reflects, [0, 64], default 1: exactly what its albedo reflects. The paper's
    /// C_IrrScale (Sec. 2.5) is twice this value.
    pub scale: f32,
    /// Exponents n and m of the thickness `(1 − x^n)^m` of a foam particle, with x the distance from its centre in
    /// radii (Eq. 1, Sec. 2.2). [0.1, 16], default 2.25 and 1. If `foam_shape`, `spray_shape`, `bubble_shape`,
    /// `life`, `sizes` or `bubble_size` differs from its default, or `submerged` is [`Submerged::Falloff`], shaders
    /// evaluate a few powers more per pixel of each particle.
    pub foam_shape: [f32; 2],
    /// Exponents n and m of the thickness `(1 − x^n)^m` of a spray particle, with x the distance from its centre in
    /// radii. [0.1, 16], default 1.5 and 1.
    pub spray_shape: [f32; 2],
    /// Exponents n and m of the thickness `1 − (1 − x^n)^m` of a bubble, with x the distance from its centre in
    /// radii: 0 at the centre, greatest at the rim. [0.1, 16], default 2 and 1.
    pub bubble_shape: [f32; 2],
    /// Exponents n and m of the factor `(1 − a^n)^m` on a particle's thickness at the relative age a, 0 (new) to 1
    /// (gone) (Sec. 2.2). [0.1, 16], default 2 and 0.4.
    pub life: [f32; 2],
    /// Number of sizes of particles, 1 to 64, default 5 (Sec. 2.1): for variation, each radius is divided by an
    /// integer from 1 to this number, chosen by the particle's id.
    pub sizes: u32,
    /// Factor on the radius of bubbles, relative to foam and spray, (0, 1], default 0.5 (Sec. 2.1).
    pub bubble_size: f32,
    /// Radius of the blur of light and shadow, in radii of the first occlusion sphere, [0, 16], default 1.5
    /// (Sec. 2.5). The blur reaches at least 4 pixels, even with 0, except with `Occlusion::Reference` (feature
    /// `diagnostics`). A blur radius of up to 32 pixels uses every texel; a larger one uses evenly spaced texels, at
    /// least 11 on each side.
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

    /// Whether shapes, life or sizes of particles differ from the paper's, or particles fade behind the water's
    /// surface as in the paper. Shaders have one variant for this and a faster one for all other cases.
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
