//! Screen-space rendering of whitewater: spray, foam and bubbles that are particles of their own, by the
//! million (Akinci, Dippel, Akinci, Teschner, Screen Space Foam Rendering, 2013). One pass per file.

pub(crate) mod generate;
mod quads;
mod radiance;
pub(crate) mod settings;
pub(crate) mod splat;
pub(crate) mod streams;
mod tiles;

use crate::contract::{Access, Config, Layer, WhitewaterParticles};
use crate::environment::Environment;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::image::Image;
use crate::gpu::retire::RetireList;
use crate::water::{Recording, WaterLayers};
pub use generate::{Generator, GeneratorConfig, GeneratorSettings, PotentialRange};
#[cfg(feature = "diagnostics")]
pub use settings::{Irradiance, Occlusion, OcclusionReach, ShadowMixing, WhitewaterSplat};
#[cfg(not(feature = "diagnostics"))]
pub(crate) use settings::{Irradiance, WhitewaterSplat};
pub use settings::{Submerged, WhitewaterConfig, WhitewaterSettings};

/// The technique: its passes in the order of the frame.
pub(crate) struct Whitewater {
    sprites: splat::Sprites,
    radiance: radiance::Radiance,
}

impl Whitewater {
    pub fn new(gpu: &Gpu, config: &Config, whitewater: &WhitewaterConfig) -> Result<Self, Error> {
        Ok(Self {
            sprites: splat::Sprites::new(gpu, config, whitewater)?,
            radiance: radiance::Radiance::new(gpu, config, whitewater)?,
        })
    }

    /// Recreates the size-dependent state.
    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.sprites.resize(gpu, config, retired)?;
        self.radiance.resize(gpu, config, retired)
    }

    /// Pass `splat`: depth and thickness of whitewater. It runs as soon as the water's depth is known, because the
    /// classification of screen tiles needs its result.
    pub fn record_splat(
        &self,
        r: &mut Recording<'_>,
        particles: Option<&WhitewaterParticles>,
        water: &Image,
    ) -> Result<(), Error> {
        self.sprites.record(r, particles, water)
    }

    /// Records the passes `radiance` and `blur`, which compute the light on whitewater. `water` holds the depth
    /// images of the particles' water; `None` if the frame has none.
    pub fn record_radiance(
        &self,
        r: &mut Recording<'_>,
        environment: &Environment,
        water: Option<&WaterLayers<'_>>,
    ) -> Result<(), Error> {
        let surface =
            water.map(|WaterLayers { depth, smoothed, .. }| radiance::Surface { depth, smoothed });
        self.radiance.record(r, &self.sprites, environment, surface)
    }

    /// Access to the host's streams.
    pub fn reading(&self) -> Access {
        self.sprites.reading()
    }

    /// Images that `composite` reads: depth and intensity, thickness, light and shadow.
    pub fn layers(&self) -> [&Image; 3] {
        [self.sprites.occluders(), self.sprites.thickness(), self.radiance.image()]
    }

    /// The images that a frame of this size leaves for the host.
    pub fn kept(&self, extent: ash::vk::Extent2D) -> Vec<Layer> {
        let layer = |name, image: &Image| Layer {
            name,
            image: image.handle,
            view: image.view,
            format: image.format,
            extent,
            access: splat::AFTER,
        };
        vec![
            layer("whitewater", self.sprites.occluders()),
            layer("whitewater.thickness", self.sprites.thickness()),
            layer("whitewater.normal", self.sprites.normal()),
            layer("whitewater.irradiance", self.radiance.image()),
        ]
    }

    /// Bytes of images and of buffers.
    pub fn memory(&self) -> (u64, u64) {
        let (a, b) = (self.sprites.memory(), self.radiance.memory());
        (a.0 + b.0, a.1 + b.1)
    }
}
