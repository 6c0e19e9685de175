//! Settings of the bubble foam (Huszár, Szécsi, GPU-supported bubble and foam rendering).

use super::blob::BUBBLES;
use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(BubbleConfig, BubbleSettings);

/// Maximum number of blob layers per pixel.
pub const MOST_LAYERS: u32 = 8;
/// Maximum thickness of a film, nanometres.
pub const MOST_FILM: f32 = 2000.0;

/// Configuration of bubble foam. It determines what memory and which pipelines are created.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BubbleConfig {
    /// Maximum number of blobs per frame, 1 to 2^20. Each takes 64 bytes.
    pub max_blobs: u32,
    /// Number of precomputed variants of a blob (a cluster of soap bubbles), 1 to 32, default 8. Each blob uses one,
    /// chosen by its id.
    pub variants: u32,
    /// Bubbles per variant, 8 to 256, default 227 (the paper's 22 700 in a hundred blobs).
    pub bubbles: u32,
    /// Seed of the variants, default 1.
    pub seed: u32,
    /// How the first bubble along a ray is found.
    #[cfg(feature = "diagnostics")]
    pub impostor: Impostor,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) impostor: Impostor,
    /// Side length in texels of a face of the impostor's cube map, a multiple of 4 from 8 to 512. Default 128, which
    /// is the paper's number for the default impostor; [`Impostor::map_size`] gives it for each impostor.
    #[cfg(feature = "diagnostics")]
    pub map_size: u32,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) map_size: u32,
    /// Maximum number of steps in the search for the first bubble along a ray, 1 to 64. Default 10, which is the
    /// paper's number for the default impostor; [`Impostor::steps`] gives it for each impostor. With
    /// [`Impostor::Distance`] a value below 9 counts as 9.
    #[cfg(feature = "diagnostics")]
    pub steps: u32,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) steps: u32,
    /// Number of layers: the nearest blobs of a pixel that are shaded and composited, 1 to 8, default 3. Blobs
    /// farther behind only fill holes that the layers leave ([`BubbleSettings::fill_holes`]).
    pub layers: u32,
    /// How the blobs of a pixel are sorted.
    #[cfg(feature = "diagnostics")]
    pub sort: BubbleSort,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) sort: BubbleSort,
    /// The soap film.
    #[cfg(feature = "diagnostics")]
    pub film: Film,
    #[cfg(not(feature = "diagnostics"))]
    pub(crate) film: Film,
    /// Draws the particles of whitewater foam near the camera as blobs, at most `max_blobs` of them
    /// ([`BubbleSettings::crossfade`] sets the distances). The host must then give no blobs of its own:
    /// [`Frame::bubbles`](crate::Frame::bubbles) has to be `None`. Default false. Needs
    /// [`Config::whitewater`](crate::Config::whitewater). It takes 36 more bytes per blob and adds the pass `near`.
    pub crossfade: bool,
}

impl BubbleConfig {
    /// The defaults for a maximum number of blobs.
    pub fn new(max_blobs: u32) -> Self {
        Self {
            max_blobs,
            variants: 8,
            bubbles: 227,
            seed: 1,
            impostor: Impostor::Ids,
            map_size: Impostor::Ids.map_size(),
            steps: Impostor::Ids.steps(),
            layers: 3,
            sort: BubbleSort::Tiles,
            film: Film::default(),
            crossfade: false,
        }
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        let within = |field, value: u32, least: u32, most: u32| {
            if (least..=most).contains(&value) {
                return Ok(());
            }
            Err(Error::bad(field, format!("expected {least} to {most}, found {value}")))
        };
        within("Config.bubbles.max_blobs", self.max_blobs, 1, 1 << 20)?;
        within("Config.bubbles.variants", self.variants, 1, 32)?;
        within("Config.bubbles.bubbles", self.bubbles, *BUBBLES.start(), *BUBBLES.end())?;
        within("Config.bubbles.map_size", self.map_size, 8, 512)?;
        if !self.map_size.is_multiple_of(4) {
            let why = format!("expected a multiple of 4, found {}", self.map_size);
            return Err(Error::bad("Config.bubbles.map_size", why));
        }
        within("Config.bubbles.steps", self.steps, 1, 64)?;
        within("Config.bubbles.layers", self.layers, 1, MOST_LAYERS)?;
        range("Config.bubbles.film.index", self.film.index, 1.0, 3.0)
    }
}

/// Precomputed representation of a blob's bubbles (Sec. 4.2, 4.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Impostor {
    /// A blob is drawn from a cube map of the distance from its centre to its surface: in the paper 64 texels per
    /// side, with at most 20 search steps along a ray. The walls between bubbles are not drawn.
    Distance,
    /// A blob is drawn from a cube map of the id of its outermost bubble in each direction: in the paper 128 texels
    /// per side, with 10 search steps along a ray. The ray is intersected exactly with the sphere of the bubble
    /// found, and the walls between bubbles are drawn. Default.
    Ids,
}

impl Impostor {
    /// The paper's side length of a face, texels.
    pub fn map_size(self) -> u32 {
        match self {
            Self::Distance => 64,
            Self::Ids => 128,
        }
    }

    /// The paper's number of steps.
    pub fn steps(self) -> u32 {
        match self {
            Self::Distance => 20,
            Self::Ids => 10,
        }
    }
}

/// How the nearest blobs of a pixel are found: by lists per tile, or by depth peeling. Both ways give the same
/// picture, unless so many blobs touch so many tiles that the lists are full.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum BubbleSort {
    /// The nearest blobs of a pixel come from a list of the blobs that touch its 16×16 tile: the pixel walks the list
    /// once, front to back. Default. All lists together have `128 · tiles + 4 · max_blobs` entries, one for each tile
    /// that a blob touches; if they do not suffice, the farthest blobs are dropped.
    Tiles,
    /// The nearest blobs of a pixel are found by depth peeling, as in the paper (Sec. 5; Everitt 2001): all blobs are
    /// drawn once per layer, and each draw keeps the nearest fragments behind the previous layer. Another draw finds
    /// the maximum opacity. Takes 22 bytes per pixel more than `Tiles`.
    Peel,
}

/// The soap film (Sec. 3.1).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub struct Film {
    /// Refractive index of the soapy water, 1 to 3, default 1.4.
    pub index: f32,
    /// Reflectance of one face of the film.
    pub fresnel: FilmFresnel,
    /// Wavelengths that are evaluated.
    pub spectrum: Spectrum,
}

impl Default for Film {
    fn default() -> Self {
        Self { index: 1.4, fresnel: FilmFresnel::Exact, spectrum: Spectrum::Whole }
    }
}

/// Reflectance of one face of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum FilmFresnel {
    /// Each of the film's two faces reflects by Fresnel's equations. For each polarisation, the film's reflectance is
    /// Airy's sum of the reflections in the film; the result is the mean of both polarisations. Default.
    Exact,
    /// A face reflects by Schlick's approximation of Fresnel's equations, the same for both polarisations. The film's
    /// reflectance is Airy's sum of the reflections in the film.
    Schlick,
    /// As in the paper: a face reflects `R = 1 − cos θ`, and the film `min(4 R sin²(φ / 2), 1)`, with φ the phase
    /// difference of the light from both faces. Unlike in print, where it is `sin² φ` with the angle outside the
    /// film, φ is that of the refracted ray.
    Source,
}

/// Wavelengths at which a film's interference is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // tests and tools alone choose
pub enum Spectrum {
    /// One wavelength each for red, green and blue, as in the paper.
    Three,
    /// A film's interference is evaluated at 81 wavelengths from 380 to 780 nm. Default. A pixel costs as much as
    /// with `Three`, because both are look-ups in a precomputed table.
    Whole,
}

/// Appearance of bubble foam.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BubbleSettings {
    /// Mean thickness of the films in nanometres, 1 to 2000, default 380.
    pub film: f32,
    /// Variation of the film thickness between bubbles and within each, relative to `film`, 0 to 1, default
    /// 0.35.
    pub variation: f32,
    /// Drainage: how much thinner films are at the top and thicker at the bottom, 0 to 1, default 0.35.
    pub drainage: f32,
    /// Distance from a blob's centre, in radii of the blob, within which its core (the foam behind the outer bubbles)
    /// is opaque, [0, core_outer_radius), default 0.65 (Sec. 4.4).
    pub core_opaque_radius: f32,
    /// Distance from a blob's centre, in radii of the blob, at which its core's opacity has fallen to 0,
    /// (core_opaque_radius, 2], default 0.98.
    pub core_outer_radius: f32,
    /// Albedo of the core, linear RGB, 0 to 1, default 0.92 of each.
    pub albedo: [f32; 3],
    /// Strength of the texture of small bubbles on the blob's core, 0 (none) to 1, default 0.7.
    pub pattern: f32,
    /// Weight w in the direction `(1 − w) v₁ + w v₂` in which the core's texture is looked up, 0 to 1, default 0.1
    /// (Sec. 4.4): v₁ points from the blob's centre to where the ray leaves the bubble, v₂ is the negated normal of
    /// the bubble where the ray enters it. Large values turn the texture's cells into rings around each bubble's
    /// centre.
    pub distortion: f32,
    /// Weight w of the normals in the lighting of the core, 0 to 1, default 0.5 (Sec. 4.4): its normal is
    /// `(1 − w) · bubble's + w · blob's`, normalized.
    pub roundness: f32,
    /// Factor on the light that films reflect from environment, sun and other foam, [0, 8], default 1.
    pub reflection: f32,
    /// Exponent of the sun's highlight on films, 1 to 10 000, default 800.
    pub shininess: f32,
    /// Whether the walls between bubbles are drawn. Default true.
    pub walls: bool,
    /// Whether blobs behind the last of the [`layers`](BubbleConfig::layers) fill the holes that the layers leave
    /// (Sec. 5). Default true.
    pub fill_holes: bool,
    /// Radius on the screen, in pixels, below which a random part of the blobs is left out and the rest is enlarged
    /// to about this radius, so that the covered area stays the same (Cook, Halstead, Planck, Ryu 2007, Stochastic
    /// Simplification of Aggregate Detail). 0 to 64, default 1, 0 = off. With growing distance more blobs vanish, in
    /// an order that their ids determine; each one shrinks before it vanishes.
    pub min_pixels: f32,
    /// Cross-fade of whitewater foam from sprites, far from the camera, to blobs near it: its two distances, and the
    /// radius of a blob relative to its particle. No effect without [`BubbleConfig::crossfade`].
    pub crossfade: Crossfade,
}

/// Cross-fade of the foam particles of whitewater: far from the camera they are sprites (flat discs), near it blobs
/// of bubble foam. (Akinci et al. 2013 show no foam so near.) The other two kinds of whitewater particles, spray and
/// single bubbles, are always sprites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossfade {
    /// Distance from the camera up to which foam consists of blobs only, scene units, [0, far), default 2.
    pub near: f32,
    /// Distance from the camera from which foam consists of sprites only, scene units, (near, 1e9], default 4. From
    /// here to `near`, blobs grow as sprites fade. If more foam particles on the screen are nearer than `far` than
    /// `max_blobs` allows, both distances shrink by the same factor.
    pub far: f32,
    /// Radius of a blob relative to its particle, (0, 100], default 1.
    pub size: f32,
}

impl Default for Crossfade {
    fn default() -> Self {
        Self { near: 2.0, far: 4.0, size: 1.0 }
    }
}

impl Default for BubbleSettings {
    fn default() -> Self {
        Self {
            film: 380.0,
            variation: 0.35,
            drainage: 0.35,
            core_opaque_radius: 0.65,
            core_outer_radius: 0.98,
            albedo: [0.92; 3],
            pattern: 0.7,
            distortion: 0.1,
            roundness: 0.5,
            reflection: 1.0,
            shininess: 800.0,
            walls: true,
            fill_holes: true,
            min_pixels: 1.0,
            crossfade: Crossfade::default(),
        }
    }
}

impl BubbleSettings {
    pub(crate) fn check(&self) -> Result<(), Error> {
        range("Settings.bubbles.film", self.film, 1.0, MOST_FILM)?;
        range("Settings.bubbles.variation", self.variation, 0.0, 1.0)?;
        range("Settings.bubbles.drainage", self.drainage, 0.0, 1.0)?;
        let (opaque, outer) = (self.core_opaque_radius, self.core_outer_radius);
        range("Settings.bubbles.core_opaque_radius", opaque, 0.0, 2.0)?;
        range("Settings.bubbles.core_outer_radius", outer, 0.0, 2.0)?;
        if opaque >= outer {
            let why = format!("{opaque} is not less than core_outer_radius, {outer}");
            return Err(Error::bad("Settings.bubbles.core_opaque_radius", why));
        }
        for part in self.albedo {
            range("Settings.bubbles.albedo", part, 0.0, 1.0)?;
        }
        range("Settings.bubbles.pattern", self.pattern, 0.0, 1.0)?;
        range("Settings.bubbles.distortion", self.distortion, 0.0, 1.0)?;
        range("Settings.bubbles.roundness", self.roundness, 0.0, 1.0)?;
        range("Settings.bubbles.reflection", self.reflection, 0.0, 8.0)?;
        range("Settings.bubbles.shininess", self.shininess, 1.0, 10_000.0)?;
        range("Settings.bubbles.min_pixels", self.min_pixels, 0.0, 64.0)?;
        let Crossfade { near, far, size } = self.crossfade;
        range("Settings.bubbles.crossfade.near", near, 0.0, 1.0e9)?;
        range("Settings.bubbles.crossfade.far", far, 1.0e-9, 1.0e9)?;
        if near >= far {
            let why = format!("{far} is not above near, {near}");
            return Err(Error::bad("Settings.bubbles.crossfade.far", why));
        }
        range("Settings.bubbles.crossfade.size", size, 1.0e-6, 100.0)
    }
}
