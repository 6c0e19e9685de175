//! Settings of the bubble foam (Huszár, Szécsi, GPU-supported bubble and foam rendering).

use super::blob::BUBBLES;
use crate::error::Error;
use crate::water::settings::range;

crate::contract::with!(BubbleConfig, BubbleLook);

/// Most layers of blobs that are told apart in a pixel.
pub const MOST_LAYERS: u32 = 8;
/// Most thickness of a film in nanometres.
pub const MOST_FILM: f32 = 2000.0;

/// What of the bubble foam costs memory or pipelines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BubbleConfig {
    /// Most blobs a frame may have, 1 to 2^20. 64 bytes each.
    pub max_blobs: u32,
    /// Different blobs, 1 to 32, default 8: which of them one is its id decides.
    pub templates: u32,
    /// Bubbles of each, 8 to 256, default 227 (the source's 22 700 of a hundred).
    pub bubbles: u32,
    /// What they are made of, default 1.
    pub seed: u32,
    /// How a ray's first bubble is found.
    pub impostor: Impostor,
    /// Edge of a face of the impostor's map in texels, a multiple of 4 from 8 to 512; default as the impostor's.
    pub map: u32,
    /// Steps of the search along a ray, 1 to 64; default as the impostor's.
    pub steps: u32,
    /// Blobs of a pixel that are drawn one behind the other, 1 to 8, default 3. What lies farther only makes holes
    /// between them as opaque as it is.
    pub layers: u32,
    /// How they are sorted.
    pub sort: BubbleSort,
    /// The soap film.
    pub film: Film,
    /// Diffuse foam near the eye becomes blobs ([`BubbleLook::hand_over`]), at most `max_blobs` of them; frames then have no
    /// other blobs. Default false. With [`Config::diffuse`](crate::Config::diffuse); 36 bytes a blob more, the pass
    /// `near`.
    pub hand_over: bool,
}

impl BubbleConfig {
    /// The defaults for so many blobs.
    pub fn new(max_blobs: u32) -> Self {
        Self {
            max_blobs,
            templates: 8,
            bubbles: 227,
            seed: 1,
            impostor: Impostor::Ids,
            map: Impostor::Ids.map(),
            steps: Impostor::Ids.steps(),
            layers: 3,
            sort: BubbleSort::Tiles,
            film: Film::default(),
            hand_over: false,
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
        within("Config.bubbles.templates", self.templates, 1, 32)?;
        within("Config.bubbles.bubbles", self.bubbles, *BUBBLES.start(), *BUBBLES.end())?;
        within("Config.bubbles.map", self.map, 8, 512)?;
        if !self.map.is_multiple_of(4) {
            let why = format!("{}: a multiple of 4 expected", self.map);
            return Err(Error::bad("Config.bubbles.map", why));
        }
        within("Config.bubbles.steps", self.steps, 1, 64)?;
        within("Config.bubbles.layers", self.layers, 1, MOST_LAYERS)?;
        range("Config.bubbles.film.index", self.film.index, 1.0, 3.0)
    }
}

/// What stands for a blob's bubbles (Sec. 4.2, 4.3).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Impostor {
    /// How far from its middle its surface lies in each direction: 64 texels a side, at most 20 steps. No walls.
    Distance,
    /// Which bubble is outermost in each direction: 128 texels a side, 10 steps. Its sphere is met exactly, and there
    /// are walls. Default.
    Ids,
}

impl Impostor {
    /// The source's size of a face.
    pub fn map(self) -> u32 {
        match self {
            Self::Distance => 64,
            Self::Ids => 128,
        }
    }

    /// The source's number of steps.
    pub fn steps(self) -> u32 {
        match self {
            Self::Distance => 20,
            Self::Ids => 10,
        }
    }
}

/// How the nearest blobs of a pixel are found. Both give the same picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BubbleSort {
    /// Each pixel goes once through the blobs of its tile, front to back, and keeps the nearest. Default. There is room
    /// for 128 blobs a tile of 16×16 pixels in the mean and four tiles a blob besides: where it is full, the farthest are
    /// left out.
    Tiles,
    /// All blobs are drawn once a layer, behind what the layer before has found (depth peeling, Everitt 2001), and
    /// once more for how opaque they are: the source's way (Sec. 5). 22 bytes a pixel more.
    Peel,
}

/// The soap film (Sec. 3.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Refractive index of the soapy water, 1 to 3, default 1.4.
    pub index: f32,
    /// What one face of it reflects.
    pub fresnel: FilmFresnel,
    /// What of the light is looked at.
    pub spectrum: Spectrum,
}

impl Default for Film {
    fn default() -> Self {
        Self { index: 1.4, fresnel: FilmFresnel::Exact, spectrum: Spectrum::Whole }
    }
}

/// What one face of a film reflects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FilmFresnel {
    /// Fresnel's equations for both polarisations, and Airy's sum for each. Default.
    Exact,
    /// Schlick's approximation, and Airy's sum.
    Schlick,
    /// As printed: one less the cosine, and four times that times the squared sine, cut at 1. Its phase is half of
    /// the printed one, of the refracted ray.
    Source,
}

/// Which wavelengths a film is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Spectrum {
    /// Three: one for each of red, green and blue, as the source.
    Three,
    /// 81, from 380 to 780 nm. Default: it costs the same, a look into a table.
    Whole,
}

/// How bubble foam looks.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BubbleLook {
    /// Mean thickness of the films in nanometres, 1 to 2000, default 380.
    pub film: f32,
    /// How far bubbles' films differ from it, and each within itself, 0 to 1, default 0.35.
    pub variation: f32,
    /// How much thinner they are on top and thicker at the bottom, where they drain to, 0 to 1, default 0.35.
    pub drainage: f32,
    /// Distances from a blob's middle, in its radius, within which the core is opaque and beyond which it is gone, 0 ≤
    /// first < second ≤ 2, default 0.65 and 0.98 (Sec. 4.4).
    pub core: [f32; 2],
    /// Albedo of the core, linear RGB, 0 to 1, default 0.92 of each.
    pub albedo: [f32; 3],
    /// How much the pattern of small bubbles inside shows, 0 to 1, default 0.7.
    pub pattern: f32,
    /// Weight of the inverse normal in the look-up of the pattern, beside the place behind the bubble, 0 to 1, default
    /// 0.1 (v₂ and v₁ of Sec. 4.4): with more of it the cells become rings round each bubble's middle.
    pub distortion: f32,
    /// Weight of the blob's own normal beside the bubble's where the core is lit, 0 to 1, default 0.5 (Sec. 4.4).
    pub roundness: f32,
    /// Factor on what films reflect of the environment, [0, 8], default 1.
    pub reflection: f32,
    /// Exponent of the sun's highlight on films, 1 to 10 000, default 800.
    pub shininess: f32,
    /// Whether the walls between bubbles are drawn; default true. With [`Impostor::Ids`].
    pub walls: bool,
    /// Whether what lies behind the last layer plugs the holes (Sec. 5); default true.
    pub plug: bool,
    /// Blobs whose radius on the screen is less than so many pixels merge, 0 to 64, default 1; 0: none. Of them so few
    /// are left, each grown in the same measure, that they cover as much and are as large as that (Cook, Halstead,
    /// Planck, Ryu 2007, Stochastic Simplification of Aggregate Detail). Which ones go first, their ids decide; each shrinks
    /// before it goes.
    pub merge: f32,
    /// Where blobs take over from sprites of diffuse foam, with [`BubbleConfig::hand_over`].
    pub hand_over: HandOver,
}

/// Diffuse foam near the eye as blobs: Akinci et al. 2013 give foam up that is nearer than some metres. What is spray or
/// under water stays sprites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandOver {
    /// Up to this distance from the eye there are blobs alone, scene units, [0, ∞), default 2.
    pub near: f32,
    /// From there on sprites alone, above `near`, default 4. Between the two a blob grows as its sprite goes. Where more
    /// particles are nearer than there may be blobs, both distances are less.
    pub far: f32,
    /// Radius of a blob in that of its particle, (0, 100], default 1.
    pub size: f32,
}

impl Default for HandOver {
    fn default() -> Self {
        Self { near: 2.0, far: 4.0, size: 1.0 }
    }
}

impl Default for BubbleLook {
    fn default() -> Self {
        Self {
            film: 380.0,
            variation: 0.35,
            drainage: 0.35,
            core: [0.65, 0.98],
            albedo: [0.92; 3],
            pattern: 0.7,
            distortion: 0.1,
            roundness: 0.5,
            reflection: 1.0,
            shininess: 800.0,
            walls: true,
            plug: true,
            merge: 1.0,
            hand_over: HandOver::default(),
        }
    }
}

impl BubbleLook {
    pub(crate) fn check(&self) -> Result<(), Error> {
        range("Settings.bubbles.film", self.film, 1.0, MOST_FILM)?;
        range("Settings.bubbles.variation", self.variation, 0.0, 1.0)?;
        range("Settings.bubbles.drainage", self.drainage, 0.0, 1.0)?;
        range("Settings.bubbles.core", self.core[0], 0.0, 2.0)?;
        range("Settings.bubbles.core", self.core[1], 0.0, 2.0)?;
        if self.core[0] >= self.core[1] {
            let why = format!("{} is not less than {}", self.core[0], self.core[1]);
            return Err(Error::bad("Settings.bubbles.core", why));
        }
        for part in self.albedo {
            range("Settings.bubbles.albedo", part, 0.0, 1.0)?;
        }
        range("Settings.bubbles.pattern", self.pattern, 0.0, 1.0)?;
        range("Settings.bubbles.distortion", self.distortion, 0.0, 1.0)?;
        range("Settings.bubbles.roundness", self.roundness, 0.0, 1.0)?;
        range("Settings.bubbles.reflection", self.reflection, 0.0, 8.0)?;
        range("Settings.bubbles.shininess", self.shininess, 1.0, 10_000.0)?;
        range("Settings.bubbles.merge", self.merge, 0.0, 64.0)?;
        let HandOver { near, far, size } = self.hand_over;
        range("Settings.bubbles.hand_over.near", near, 0.0, 1.0e9)?;
        range("Settings.bubbles.hand_over.far", far, 1.0e-9, 1.0e9)?;
        if near >= far {
            let why = format!("{far} is not above near, {near}");
            return Err(Error::bad("Settings.bubbles.hand_over.far", why));
        }
        range("Settings.bubbles.hand_over.size", size, 1.0e-6, 100.0)
    }
}
