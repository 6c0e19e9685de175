//! Effects of water and foam on sunlight: coloured shadows of water, shadows of foam, caustics (the thesis' future
//! work). One pass per file: [`maps`] draws all particles of the water as the sun sees them, [`whitewater`] the
//! whitewater particles, [`caustics`] traces the refracted light, [`lit`] applies shadows and caustics to the host's
//! scene. Shaders of foam, spray and highlights read the maps directly (glsl/include/sunlight.glsl). [`convolution`]
//! filters the host's shadow map.

mod caustics;
mod convolution;
mod lit;
mod maps;
mod whitewater;

use ash::vk;

use crate::contract::{Config, HostImage, Layer, Particles, WhitewaterParticles};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{Access, FRAGMENT_SAMPLED};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::retire::RetireList;
use crate::water::settings::Shadows;
use crate::water::{Recording, SphereList};
use caustics::Caustics;
pub use convolution::{Convolution, Convolved, Convolving, convolution};
use lit::Lit;
use maps::Maps;
use whitewater::Whitewater;

/// Specialization constants of glsl/include/sunlight.glsl.
pub fn constants(config: &Config) -> [(u32, u32); 5] {
    let (shadow, terms) = match config.shadow {
        None => (0, 2),
        Some(Shadows::Mask) => (1, 2),
        Some(Shadows::Map) => (2, 2),
        Some(Shadows::Convolution(convolution)) => (3, convolution.terms),
    };
    let cast = config.light_map_size.is_some();
    let has_whitewater = cast && config.whitewater.is_some();
    let soaped = cast && config.bubbles.is_some();
    [
        (11, shadow),
        (12, u32::from(cast)),
        (13, terms),
        (21, u32::from(has_whitewater)),
        (23, u32::from(soaped)),
    ]
}

/// Resources of the sunlight at a point, for every shader that needs it.
#[derive(Clone, Copy)]
pub struct Sunlight {
    /// The host's shadow map or mask, or a stand-in.
    pub shadow: Resource,
    /// The light map's thickness, or a stand-in.
    pub thickness: Resource,
    /// Basis of a filtered shadow map and its span, or stand-ins.
    pub convolved: [Resource; 2],
    /// The map of whitewater, or a stand-in.
    pub whitewater: Resource,
    /// The blobs' shadow map, or a stand-in.
    pub bubbles: Resource,
}

impl Sunlight {
    /// Bindings of glsl/include/sunlight.glsl.
    pub fn resources(&self) -> [(u32, Resource); 6] {
        let [basis, span] = self.convolved;
        [
            (16, self.shadow),
            (17, self.thickness),
            (18, basis),
            (19, span),
            (24, self.whitewater),
            (27, self.bubbles),
        ]
    }
}

/// The passes.
pub struct Light {
    maps: Maps,
    whitewater: Option<Whitewater>,
    caustics: Caustics,
    lit: Lit,
}

impl Light {
    pub fn new(gpu: &Gpu, config: &Config, edge: u32) -> Result<Self, Error> {
        Ok(Self {
            maps: Maps::new(gpu, config, edge)?,
            whitewater: config
                .whitewater
                .map(|whitewater| Whitewater::new(gpu, &whitewater, edge))
                .transpose()?,
            caustics: Caustics::new(gpu, config, edge)?,
            lit: Lit::new(gpu, config)?,
        })
    }

    /// Recreates the size-dependent state.
    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.lit.resize(gpu, config, retired)
    }

    /// The thickness map, after [`record_maps`](Self::record_maps).
    pub fn thickness(&self, gpu: &Gpu) -> Resource {
        Resource::Sampled(self.maps.thickness.image().view, gpu.samplers.nearest)
    }

    /// The map of whitewater, if it casts shadows.
    pub fn whitewater(&self, gpu: &Gpu) -> Option<Resource> {
        let image = &self.whitewater.as_ref()?.image;
        Some(Resource::Sampled(image.view, gpu.samplers.nearest))
    }

    /// Passes `light`, `whitewater_light` and `caustics`, after `cull`, whose counts they use. The buffers of the
    /// whitewater particles are in the compute-read state afterwards.
    pub fn record_maps(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
        whitewater: Option<&WhitewaterParticles>,
    ) -> Result<(), Error> {
        self.maps.record(r, particles, list)?;
        if let Some(pass) = &self.whitewater {
            pass.record(r, whitewater, &self.maps)?;
        }
        self.caustics.record(r, &self.maps)
    }

    /// Pass `lit`. Afterwards the output holds the lit scene, and so does the returned image, which fragment
    /// and compute shaders can sample.
    pub fn record_lit(
        &self,
        r: &mut Recording<'_>,
        scene: &HostImage,
        output: &lit::Output,
        sunlight: &Sunlight,
    ) -> Result<&Image, Error> {
        self.lit.record(r, scene, output, sunlight, &self.caustics.image)?;
        Ok(self.lit.image())
    }

    /// Access to the scene's colour.
    pub const SCENE_USE: Access = lit::SCENE_USE;

    /// Layers for the host.
    pub fn layers(&self) -> Vec<Layer> {
        let layer = |name, image: &Image, access| Layer {
            name,
            image: image.handle,
            view: image.view,
            format: image.format,
            extent: image.extent,
            access,
        };
        let mut layers = vec![
            layer("light.front", self.maps.front.image(), maps::AFTER),
            layer("light.thickness", self.maps.thickness.image(), maps::AFTER),
            layer("light.caustics", &self.caustics.image, FRAGMENT_SAMPLED),
        ];
        let whitewater = self.whitewater.as_ref();
        layers.extend(whitewater.map(|pass| layer("light.whitewater", &pass.image, maps::AFTER)));
        layers
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        let (images, buffers) = self.caustics.memory();
        let (whitewater, words) = self.whitewater.as_ref().map_or((0, 0), Whitewater::memory);
        let maps = self.maps.front.image().size + self.maps.thickness.image().size;
        (images + maps + whitewater + self.lit.image().size, buffers + words)
    }
}

pub use lit::Output;

/// Number of descriptor sets per frame for whitewater that casts shadows.
pub fn whitewater_sets(limits: &vk::PhysicalDeviceLimits, config: &Config) -> u32 {
    match (config.light_map_size, &config.whitewater) {
        (Some(edge), Some(whitewater)) => whitewater::sets(limits, whitewater, edge),
        _ => 0,
    }
}

/// Description of a square light map.
fn map_desc(
    name: &str,
    edge: u32,
    format: vk::Format,
    usage: vk::ImageUsageFlags,
) -> ImageDesc<'_> {
    let extent = vk::Extent2D { width: edge, height: edge };
    let usage = usage | vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_SRC;
    ImageDesc::new(name, extent, format, usage)
}
