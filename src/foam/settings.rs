//! Settings of whitewater: spray, foam and bubbles that are particles of their own (Akinci et al. 2013).

use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(DiffuseConfig, DiffuseLook);

/// Configuration of whitewater: what costs memory or pipelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DiffuseConfig {
    /// Maximum number of whitewater particles per frame, at least 1.
    pub max_particles: u32,
    /// Maximum stride of their streams in bytes, a multiple of 4, default 12.
    pub max_stride: u32,
    /// Whether frames may have [`DiffuseParticles::packets`](crate::DiffuseParticles::packets). Default false.
    pub packets: bool,
    /// How they are rasterized. `None`: the fastest as measured on lavapipe, [`Splat::Compute64`] where its
    /// feature is enabled, otherwise [`Splat::Compute`]. Not yet measured on GPUs.
    pub splat: Option<Splat>,
    /// How the environment lights them.
    pub irradiance: Irradiance,
    /// How their ambient occlusion is sampled.
    pub occlusion: Occlusion,
}

impl DiffuseConfig {
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
            return Err(Error::bad("Config.diffuse.max_particles", "zero; it sizes the buffers"));
        }
        if self.max_stride < 12 || !self.max_stride.is_multiple_of(4) {
            let why = format!("{}: a multiple of 4 from 12 on expected", self.max_stride);
            return Err(Error::bad("Config.diffuse.max_stride", why));
        }
        Ok(())
    }
}

/// How whitewater particles are rasterized. All paths give the same picture, the two compute paths to the last
/// bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Splat {
    /// One quad per particle with depth test and blending. 12 bytes per pixel more.
    Raster,
    /// One invocation per particle with 32-bit atomics, in two passes. The second writes the attributes of the
    /// frontmost.
    Compute,
    /// One invocation per particle with 64-bit atomics, in one pass. Needs
    /// [`buffer_int64_atomics`](crate::Enabled::buffer_int64_atomics).
    Compute64,
}

/// How ambient occlusion of foam by foam, water and scene is sampled (Sec. 2.4.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Occlusion {
    /// As printed: as many samples as the spheres have pixels, the same in every pixel.
    Reference,
    /// Each pixel of a 4×4 block evaluates 1/16 of [`DiffuseLook::samples`] (2 to 20 samples per sphere of any
    /// size); the blur recombines them. Samples come in opposite pairs, so that each pixel alone finds half of
    /// a half space occluded. Default.
    Fast,
}

/// How light of the environment reaches foam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Irradiance {
    /// One look-up per pixel in an irradiance map that is filtered once per environment, which the paper names
    /// as the faster way. Default.
    Prefiltered,
    /// Look-ups in the directions of the first occlusion pass' samples (Sec. 2.4.2), also if `passes` is 0.
    Sampled,
}

/// How particles behind the water's surface are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Submerged {
    /// The water in front of them attenuates them, as it does everything in it. Default.
    Water,
    /// The paper's falloff, `f(metres behind, most, n, m)` (Eq. 1 and Sec. 2.2), which reaches zero at `most`. The
    /// particles are then composited in front of the water.
    Falloff {
        /// Metres, (0, ∞), recommended 6 spacings.
        most: f32,
        /// Exponent, [0.1, 16], recommended 2.
        n: f32,
        /// Exponent, [0.1, 16], recommended 4.
        m: f32,
    },
}

/// Maximum distance between an occluder and the point that it occludes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// In search radii, (0, ∞), default 1.
    Radii(f32),
    /// In metres, (0, ∞); the paper: 5.
    Metres(f32),
}

/// How light and shadow combine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mixing {
    /// light × (1 − shadow): never negative, and independent of exposure. Default.
    Scaled,
    /// The paper's light − shadow, clamped to 1 before (Sec. 2.5).
    Source,
}

/// Appearance of whitewater. No effect without [`Config::diffuse`](crate::Config).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DiffuseLook {
    /// Radius of a particle without one of its own, scene units, (0, ∞), default 0.15 spacings (0.0075 for a
    /// spacing of 0.05). It is divided by 1 to [`sizes`](Self::sizes), chosen per particle; a bubble's is
    /// scaled by [`bubble_size`](Self::bubble_size).
    pub radius: f32,
    /// How particles behind the water's surface are drawn.
    pub submerged: Submerged,
    /// Thickness ρ_mod at which the intensity `ρ^e / (ρ_mod + ρ^e)` is one half (for e = 1), (0, 1e6], default
    /// 3 (Sec. 2.3).
    pub half: f32,
    /// Exponent e of the intensity, [0.1, 16], default 1.25.
    pub exponent: f32,
    /// Number of occlusion passes, each with a larger sphere, 0 to 8, default 3 (AO_#Passes, Sec. 2.4.1).
    pub passes: u32,
    /// Radii of those spheres, in particle radii: the first value, plus the second for each further pass. [0,
    /// 100], default 1 and 7 (AO_InitSRFac, AO_SRIncFac).
    pub search: [f32; 2],
    /// Samples per cubic pixel, [0, 16], default 0.5 (AO_SDens). For [`Occlusion::Reference`];
    /// [`Occlusion::Fast`] uses a fixed share of `samples` at any size.
    pub density: f32,
    /// Minimum and maximum number of samples per sphere, 1 to 512, default 16 and 512. The minimum applies to
    /// [`Occlusion::Reference`] only.
    pub samples: [u32; 2],
    /// Maximum distance between an occluder and the point behind it (AO_MaxOcclDist).
    pub reach: Reach,
    /// Opacity as occluders of the fluid's surface and of solids, 0 to 1, default 0.5 and 1.
    pub opacity: [f32; 2],
    /// Scale, exponent and offset that turn occlusion into shadow: [0, 16], [0.1, 16], [-1, 1], default 1, 1.5,
    /// -0.05.
    pub shadow: [f32; 3],
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
    pub mixing: Mixing,
}

impl DiffuseLook {
    /// The defaults for a particle spacing of the water.
    pub fn of_spacing(spacing: f32) -> Self {
        Self {
            radius: 0.15 * spacing,
            submerged: Submerged::Water,
            half: 3.0,
            exponent: 1.25,
            passes: 3,
            search: [1.0, 7.0],
            density: 0.5,
            samples: [16, 512],
            reach: Reach::Radii(1.0),
            opacity: [0.5, 1.0],
            shadow: [1.0, 1.5, -0.05],
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
            mixing: Mixing::Scaled,
        }
    }

    /// Whether particles differ from the paper's, or fade behind the water's surface as in the paper. Shaders have a
    /// variant for this.
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
        range("Settings.diffuse.radius", self.radius, 1.0e-9, f32::MAX)?;
        if let Submerged::Falloff { most, n, m } = self.submerged {
            range("Settings.diffuse.submerged.most", most, 1.0e-9, f32::MAX)?;
            range("Settings.diffuse.submerged.n", n, 0.1, 16.0)?;
            range("Settings.diffuse.submerged.m", m, 0.1, 16.0)?;
        }
        range("Settings.diffuse.half", self.half, 1.0e-6, 1.0e6)?;
        range("Settings.diffuse.exponent", self.exponent, 0.1, 16.0)?;
        range("Settings.diffuse.passes", self.passes as f32, 0.0, 8.0)?;
        for search in self.search {
            range("Settings.diffuse.search", search, 0.0, 100.0)?;
        }
        range("Settings.diffuse.density", self.density, 0.0, 16.0)?;
        let [least, most] = self.samples;
        range("Settings.diffuse.samples", least as f32, 1.0, 512.0)?;
        range("Settings.diffuse.samples", most as f32, least as f32, 512.0)?;
        let (Reach::Radii(reach) | Reach::Metres(reach)) = self.reach;
        range("Settings.diffuse.reach", reach, 1.0e-9, f32::MAX)?;
        let [scale, exponent, offset] = self.shadow;
        range("Settings.diffuse.shadow", scale, 0.0, 16.0)?;
        range("Settings.diffuse.shadow", exponent, 0.1, 16.0)?;
        range("Settings.diffuse.shadow", offset, -1.0, 1.0)?;
        for part in [self.opacity[0], self.opacity[1]] {
            range("Settings.diffuse.opacity", part, 0.0, 1.0)?;
        }
        range("Settings.diffuse.scale", self.scale, 0.0, 64.0)?;
        for (field, exponents) in [
            ("Settings.diffuse.foam_shape", self.foam_shape),
            ("Settings.diffuse.spray_shape", self.spray_shape),
            ("Settings.diffuse.bubble_shape", self.bubble_shape),
            ("Settings.diffuse.life", self.life),
        ] {
            exponents.into_iter().try_for_each(|exponent| range(field, exponent, 0.1, 16.0))?;
        }
        range("Settings.diffuse.sizes", self.sizes as f32, 1.0, 64.0)?;
        range("Settings.diffuse.bubble_size", self.bubble_size, 1.0e-6, 1.0)?;
        range("Settings.diffuse.blur", self.blur, 0.0, 16.0)?;
        for (shadow, albedo) in self.shadow_color.into_iter().zip(self.albedo) {
            range("Settings.diffuse.shadow_color", shadow, 0.0, 1.0)?;
            range("Settings.diffuse.albedo", albedo, 0.0, 1.0)?;
        }
        Ok(())
    }
}

impl Default for DiffuseLook {
    fn default() -> Self {
        Self::of_spacing(0.05)
    }
}
