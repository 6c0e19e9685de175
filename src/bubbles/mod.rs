//! Bubble foam: blobs of soap bubbles by the thousand (Huszár, Szécsi, GPU-supported bubble and foam
//! rendering). One pass per file.

mod billboards;
mod blob;
mod cast;
mod heap;
mod lists;
mod near;
mod peel;
pub(crate) mod settings;
mod soap;
mod templates;

use std::sync::Arc;

use ash::vk;
use bytemuck::{Pod, Zeroable};

use crate::contract::{Blobs, Config, Frame, Layer, WhitewaterParticles};
use crate::environment::Environment;
use crate::error::Error;
use crate::frame::sun_on;
use crate::gpu::Gpu;
use crate::gpu::access::{Access, COMPUTE_READ};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::Image;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::{Recording, WaterLayers};
#[cfg(feature = "diagnostics")]
pub use blob::Blob;
pub use heap::{
    BlobSimulation, BlobSimulationConfig, BlobSimulationSettings, BlobSimulationStep,
    DistanceField, Solid,
};
pub(crate) use lists::buffers_of;
pub(crate) use near::sets as near_sets;
use settings::MOST_FILM;
pub use settings::{BubbleConfig, BubbleSettings, Crossfade};
#[cfg(feature = "diagnostics")]
pub use settings::{BubbleSort, Film, FilmFresnel, Impostor, Spectrum};
use templates::Templates;

/// Access to the host's streams.
pub(crate) const READING: Access = COMPUTE_READ;

/// The block `BubbleFrame` of `glsl/include/bubbles.glsl`, whose comments describe each member.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(crate) struct BubbleUniforms {
    film: [f32; 4],
    core: [f32; 4],
    albedo: [f32; 4],
    mirror: [f32; 4],
    sun: [f32; 4],
    sun_mirror: [f32; 4],
    tiles: [u32; 4],
    kinds: [u32; 4],
}
shader::assert_layout!(
    shader::BUBBLES_SOAP_COMP,
    "BubbleFrame",
    BubbleUniforms { film, core, albedo, mirror, sun, sun_mirror, tiles, kinds }
);

impl BubbleUniforms {
    pub fn new(frame: &Frame<'_>, config: &Config, bubbles: &BubbleConfig) -> Self {
        let look = &frame.settings.bubbles;
        let light = &frame.settings.light;
        let flag = |on: bool| f32::from(u8::from(on));
        let [r, g, b] = look.albedo.map(|part| 2.0 * part);
        let [x, y] = lists::tiles(frame.output.rect.extent);
        let [sun_r, sun_g, sun_b] = light.color;
        Self {
            film: [look.film, look.variation, look.drainage, MOST_FILM],
            core: [
                look.core_opaque_radius,
                look.core_outer_radius,
                look.distortion,
                look.roundness,
            ],
            albedo: [r, g, b, look.pattern],
            mirror: [look.reflection, look.shininess, flag(look.walls), flag(look.fill_holes)],
            sun: sun_on(frame.settings),
            sun_mirror: [sun_r, sun_g, sun_b, look.min_pixels],
            tiles: [x, y, lists::SLICES, lists::room(config.extent, bubbles)],
            kinds: [bubbles.variants, 0, 0, 0],
        }
    }
}

/// Sizes in bytes of the largest buffers that are bound as a whole: layers of all pixels, and lists of all tiles.
pub(crate) fn bytes_bound(extent: vk::Extent2D, bubbles: &BubbleConfig) -> (u64, u64) {
    (peel::layer_bytes(extent, bubbles), 4 * u64::from(lists::room(extent, bubbles)))
}

/// The technique: its passes in the order of the frame.
pub(crate) struct Bubbles {
    /// Results of the passes `film`, `impostor` and `core`, computed once. `Renderer::reconfigure` keeps them if the
    /// passes would give the same results with the new configuration.
    templates: Arc<Templates>,
    near: Option<near::Near>,
    lists: lists::Lists,
    cast: Option<cast::Cast>,
    peel: peel::Peel,
    soap: soap::Soap,
}

impl Bubbles {
    /// `before` is the previous state.
    pub fn new(
        gpu: &Gpu,
        config: &Config,
        bubbles: &BubbleConfig,
        before: Option<&Self>,
    ) -> Result<Self, Error> {
        let kept = before.map(|before| &before.templates).filter(|kept| kept.fits(bubbles));
        let templates = match kept {
            Some(kept) => kept.clone(),
            None => Arc::new(Templates::new(gpu, bubbles)?),
        };
        Ok(Self {
            templates,
            near: config
                .whitewater
                .filter(|_| bubbles.crossfade)
                .map(|whitewater| near::Near::new(gpu, &whitewater, bubbles))
                .transpose()?,
            lists: lists::Lists::new(gpu, config, bubbles)?,
            cast: cast::Cast::new(gpu, config)?,
            peel: peel::Peel::new(gpu, config, bubbles)?,
            soap: soap::Soap::new(gpu, config, bubbles)?,
        })
    }

    /// Recreates the size-dependent state.
    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.lists.resize(gpu, config, retired)?;
        self.peel.resize(gpu, config, retired)?;
        self.soap.resize(gpu, config, retired)
    }

    /// Whether the precomputed data is that of `other`.
    pub fn is_set_up_as(&self, other: Option<&Self>) -> bool {
        other.is_some_and(|other| Arc::ptr_eq(&self.templates, &other.templates))
    }

    pub fn record_setup(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        self.templates.record_setup(gpu, cmd);
    }

    /// Records pass `near`, if it is enabled. Returns whether it was: then the buffers of the whitewater particles
    /// are already acquired from the host, and in the compute-read state.
    pub fn record_near(
        &self,
        r: &mut Recording<'_>,
        particles: Option<&WhitewaterParticles>,
    ) -> Result<bool, Error> {
        match &self.near {
            Some(near) => near.record(r, particles).map(|()| true),
            None => Ok(false),
        }
    }

    /// The blobs made of whitewater foam, and the distances of the cross-fade.
    pub fn handed_over(&self) -> Option<(Blobs, Resource)> {
        self.near.as_ref().map(|near| (near.blobs(), near.over()))
    }

    /// Passes `blobs` and `cast`, before any pass that needs sunlight.
    pub fn record_lists(&self, r: &mut Recording<'_>, blobs: Option<&Blobs>) -> Result<(), Error> {
        let scope = r.begin(c"blobs");
        self.lists.record(r, blobs)?;
        r.end(scope);
        if let Some(cast) = &self.cast {
            let scope = r.begin(c"cast");
            cast.record(r, (&self.lists, blobs))?;
            r.end(scope);
        }
        Ok(())
    }

    /// The blobs' shadow map, if they cast shadows.
    pub fn cast(&self, gpu: &Gpu) -> Option<Resource> {
        self.cast.as_ref().map(|cast| cast.resource(gpu))
    }

    /// Pass `peel`. It runs before tile classification, which needs the blobs' depth.
    pub fn record_peel(&self, r: &mut Recording<'_>, blobs: Option<&Blobs>) -> Result<(), Error> {
        let scope = r.begin(c"peel");
        self.peel.record(r, (&self.lists, blobs), &self.templates)?;
        r.end(scope);
        Ok(())
    }

    /// Pass `soap`.
    pub fn record_soap(
        &self,
        r: &mut Recording<'_>,
        environment: &Environment,
        water: &WaterLayers<'_>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"soap");
        let made = (&self.lists, &self.peel, &*self.templates);
        self.soap.record(r, made, environment, water)?;
        r.end(scope);
        Ok(())
    }

    /// Depth of the frontmost blob, EMPTY where there is none.
    pub fn depth(&self) -> &Image {
        self.peel.depth()
    }

    /// Premultiplied colour, with opacity in A.
    pub fn image(&self) -> &Image {
        self.soap.image()
    }

    /// Returns the buffer that holds the layers of blobs and the maximum opacity of each pixel, and the number of
    /// 32-bit words per pixel in it.
    pub fn layers(&self) -> (vk::Buffer, u32) {
        (self.peel.layers().handle, self.peel.words())
    }

    /// Statistics of the blobs.
    pub fn counts(&self) -> vk::Buffer {
        self.lists.buffers()[1].handle
    }

    /// The layers of a frame of this size, for the host.
    pub fn kept(&self, extent: vk::Extent2D) -> Vec<Layer> {
        let film = &self.templates.table;
        let layer = |name, image: &Image, extent| Layer {
            name,
            image: image.handle,
            view: image.view,
            format: image.format,
            extent,
            access: peel::AFTER,
        };
        vec![
            layer("bubbles", self.peel.depth(), extent),
            layer("bubbles.color", self.soap.image(), extent),
            layer("bubbles.film", film, film.extent),
        ]
    }

    /// Bytes of images and of buffers.
    pub fn memory(&self) -> (u64, u64) {
        let (maps, bubbles) = self.templates.memory();
        let (depth, layers) = self.peel.memory();
        let cast = self.cast.as_ref().map_or(0, cast::Cast::memory);
        let near = self.near.as_ref().map_or(0, near::Near::memory);
        (
            maps + depth + cast + self.soap.image().size,
            bubbles + layers + self.lists.memory() + near,
        )
    }
}
