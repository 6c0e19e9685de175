//! Settings of the foam of diffuse particles (Akinci et al. 2013).

use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(DiffuseConfig, DiffuseLook);

/// What of the foam of diffuse particles costs memory or pipelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct DiffuseConfig {
    /// Most diffuse particles a frame may have, at least 1.
    pub max_particles: u32,
    /// Longest stride of their streams in bytes, a multiple of 4, default 12.
    pub max_stride: u32,
    /// Whether frames may come with [`DiffuseParticles::packets`](crate::DiffuseParticles::packets), default false.
    pub packets: bool,
    /// How they become pixels; `None`: what was measured to be the fastest, [`Splat::Compute64`] where the device has
    /// been made for it, else [`Splat::Compute`] (on lavapipe; GPUs are still to be).
    pub splat: Option<Splat>,
    /// Where the light of the environment is looked up.
    pub irradiance: Irradiance,
    /// How foam's own shadow is sampled.
    pub occlusion: Occlusion,
}

impl DiffuseConfig {
    /// The defaults for so many particles.
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

/// How diffuse particles become pixels. All ways give the same picture, the two by compute to the last bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Splat {
    /// A quad a particle, a depth test and blending. 12 bytes a pixel more.
    Raster,
    /// An invocation a particle with atomics of 32 bits, twice: the second for what goes with the frontmost.
    Compute,
    /// An invocation a particle with atomics of 64 bits, once. Needs
    /// [`buffer_int64_atomics`](crate::Enabled::buffer_int64_atomics).
    Compute64,
}

/// How the shadow is sampled that foam lies in among foam, water and scene (Sec. 2.4.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Occlusion {
    /// As printed: as many points as the spheres hold pixels, the same in every pixel.
    Reference,
    /// A sixteenth of the most points ([`DiffuseLook::samples`]), of 320 at most, 2 at least, in each pixel of a block of
    /// sixteen, which the blur puts together, in spheres of any size. They come in pairs opposite each other, so that each
    /// pixel by itself finds half of a half space hidden. Default.
    Fast,
}

/// How the light of the environment comes to foam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Irradiance {
    /// Once a pixel, from a map that is filtered once per environment (which the source names as the
    /// quicker way). Default.
    Prefiltered,
    /// At the directions of the first pass' samples (Sec. 2.4.2), whether or not there is such a pass.
    Sampled,
}

/// What becomes of particles behind the water's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Submerged {
    /// The water before them takes their light, as of all that is in it. Default.
    Water,
    /// The source's falloff, `f(metres behind, most, n, m)` (Eq. 1 and Sec. 2.2): none is left from `most`
    /// on. They lie before the water then.
    Falloff {
        /// Metres, (0, ∞); 6 spacings do.
        most: f32,
        /// Exponent, [0.1, 16]; 2 does.
        n: f32,
        /// Exponent, [0.1, 16]; 4 does.
        m: f32,
    },
}

/// How far an occluder may be before what it hides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// So many radii of the search, (0, ∞). Default 1.
    Radii(f32),
    /// Metres, (0, ∞); the source: 5.
    Metres(f32),
}

/// How light and shadow become colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mixing {
    /// Light less its share in shadow: not negative, and the same under any exposure. Default.
    Scaled,
    /// The source's: clamped to 1, less the shadow (Sec. 2.5).
    Source,
}

/// How the foam of diffuse particles looks. Of no effect without [`Config::diffuse`](crate::Config).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DiffuseLook {
    /// Radius of a particle without one, scene units, (0, ∞), default 0.15 of 0.05. It is divided by the
    /// particle's number ([`sizes`](Self::sizes)), a bubble's halved ([`bubble_size`](Self::bubble_size)).
    pub radius: f32,
    /// What the water takes.
    pub submerged: Submerged,
    /// ρ_mod of the intensity `ρ^e / (ρ_mod + ρ^e)`, (0, 1e6], default 3 (Sec. 2.3).
    pub half: f32,
    /// Its exponent e, [0.1, 16], default 1.25.
    pub exponent: f32,
    /// Occlusion is looked for in so many spheres, 0 to 8, default 3 (AO_#Passes, Sec. 2.4.1).
    pub passes: u32,
    /// Their radii in those of the particles: the first number and the second for each pass from 1 on, [0, 100]; default 1
    /// and 7 (AO_InitSRFac, AO_SRIncFac).
    pub search: [f32; 2],
    /// Samples a cubic pixel, [0, 16], default 0.5 (AO_SDens). With [`Occlusion::Reference`] alone:
    /// [`Occlusion::Fast`] has a share of the most samples, whatever the size.
    pub density: f32,
    /// Least and most samples of a sphere, 1 to 512, default 16 and 512. The least with [`Occlusion::Reference`] alone.
    pub samples: [u32; 2],
    /// How far before it an occluder hides a point (AO_MaxOcclDist).
    pub reach: Reach,
    /// Opacity of the fluid's surface and of solids as occluders, 0 to 1, default 0.5 and 1.
    pub opacity: [f32; 2],
    /// Scale, exponent and offset from occlusion to shadow, [0, 16], [0.1, 16], [-1, 1]; default 1, 1.5, -0.05.
    pub shadow: [f32; 3],
    /// Colour that stays in the shadow, linear RGB, 0 to 1, default a deep blue (0, 0, 0.2).
    pub shadow_color: [f32; 3],
    /// Albedo, linear RGB, 0 to 1, default 0.9.
    pub albedo: [f32; 3],
    /// What foam shines with over what its albedo sends back, [0, 64], default 1: twice both is the source's C_IrrScale
    /// (Sec. 2.5), more than 2 with a scale above 1.
    pub scale: f32,
    /// Exponents n and m of the shape `(1 − x^n)^m` of a particle of foam, x the distance from its middle in radii (Eq. 1,
    /// Sec. 2.2), [0.1, 16]; default 2.25 and 1. Other shapes, lives and sizes than the defaults cost a few powers.
    pub foam_shape: [f32; 2],
    /// The same of spray, default 1.5 and 1.
    pub spray_shape: [f32; 2],
    /// The same of a bubble, whose thickness is 1 less it, default 2 and 1.
    pub bubble_shape: [f32; 2],
    /// Exponents n and m of what is left of a particle, `(1 − a^n)^m` at the age a (Sec. 2.2), [0.1, 16]; default 2 and 0.4.
    pub life: [f32; 2],
    /// A radius is divided by 1 to so many, by the particle's number, 1 to 64, default 5 (Sec. 2.1).
    pub sizes: u32,
    /// Radius of a bubble in that of another particle, (0, 1], default 0.5 (Sec. 2.1).
    pub bubble_size: f32,
    /// Radius of the blur of light and shadow in that of the first sphere of the occlusion, [0, 16], default 1.5 (Sec. 2.5).
    /// Numbers that are up to 32 pixels away are all taken, beyond it some of them, at least 11 to a side, evenly spread.
    pub blur: f32,
    /// How they are mixed.
    pub mixing: Mixing,
}

impl DiffuseLook {
    /// The defaults for particles of water of a spacing.
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

    /// Whether particles are other than the source's, or fade as its do behind the water's surface: shaders have a variant
    /// for that.
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
