//! What water and foam do to the sunlight: shadows in the water's colours, shadows of foam, caustics
//! (the thesis' future work). A pass a file: [`maps`] splats all particles as the sun sees them,
//! [`caustics`] follows the refracted light, [`lit`] lays both on the host's scene; foam, spray and
//! highlights read the maps themselves (glsl/include/sunlight.glsl). [`convolution`] filters the host's
//! shadow map.

mod caustics;
mod convolution;
mod lit;
mod maps;

use ash::vk;

use crate::contract::{Config, HostImage, Layer, Particles};
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

/// Specialisation constants of glsl/include/sunlight.glsl.
pub fn constants(config: &Config) -> [(u32, u32); 3] {
    let (shadow, terms) = match config.shadow {
        None => (0, 2),
        Some(Shadows::Mask) => (1, 2),
        Some(Shadows::Map) => (2, 2),
        Some(Shadows::Convolution(convolution)) => (3, convolution.terms),
    };
    [(11, shadow), (12, u32::from(config.cast.is_some())), (13, terms)]
}

/// What of the sun's light reaches a point, for every shader that asks.
#[derive(Clone, Copy)]
pub struct Sunlight {
    /// The host's shadow map or mask; anything where there is none.
    pub shadow: Resource,
    /// Ours; anything where there is none.
    pub thickness: Resource,
    /// Basis of a filtered shadow map, and its span; any image and buffer where there is none.
    pub convolved: [Resource; 2],
}

impl Sunlight {
    /// As glsl/include/sunlight.glsl binds it.
    pub fn resources(&self) -> [(u32, Resource); 4] {
        let [basis, span] = self.convolved;
        [(16, self.shadow), (17, self.thickness), (18, basis), (19, span)]
    }
}

/// The three passes.
pub struct Light {
    maps: Maps,
    caustics: Caustics,
    lit: Lit,
}

impl Light {
    pub fn new(gpu: &Gpu, config: &Config, edge: u32) -> Result<Self, Error> {
        Ok(Self {
            maps: Maps::new(gpu, config, edge)?,
            caustics: Caustics::new(gpu, edge)?,
            lit: Lit::new(gpu, config)?,
        })
    }

    /// Replaces what depends on the extent.
    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.lit.resize(gpu, config, retired)
    }

    /// What shaders read, once [`record_maps`](Self::record_maps) is recorded.
    pub fn thickness(&self, gpu: &Gpu) -> Resource {
        Resource::Sampled(self.maps.thickness.image().view, gpu.samplers.nearest)
    }

    /// `light` and `caustics`, after `cull`, whose counts they take.
    pub fn record_maps(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
    ) -> Result<(), Error> {
        self.maps.record(r, particles, list)?;
        self.caustics.record(r, &self.maps)
    }

    /// `lit`: the output holds the lit scene afterwards, as does the image that is handed back, for
    /// fragments and compute to sample.
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

    /// How the scene's colour is read.
    pub const SCENE_USE: Access = lit::SCENE_USE;

    /// Layers for the host.
    pub fn layers(&self) -> [Layer; 3] {
        let layer = |name, image: &Image, access| Layer {
            name,
            image: image.handle,
            view: image.view,
            format: image.format,
            extent: image.extent,
            access,
        };
        [
            layer("light.front", self.maps.front.image(), maps::AFTER),
            layer("light.thickness", self.maps.thickness.image(), maps::AFTER),
            layer("light.caustics", &self.caustics.image, FRAGMENT_SAMPLED),
        ]
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        let (images, buffers) = self.caustics.memory();
        let maps = self.maps.front.image().size + self.maps.thickness.image().size;
        (images + maps + self.lit.image().size, buffers)
    }
}

pub use lit::Output;

/// A square image of the light's.
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
