//! Pass `peel`: finds the nearest blobs of each pixel, from front to back, and the maximum opacity of all its blobs
//! (Huszár, Szécsi, Sec. 5).
//!
//! Reads: blobs and lists, scene depth, impostors. Writes: layers, bubble depth.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::billboards::Billboards;
use super::lists::Lists;
use super::settings::{BubbleConfig, BubbleSort};
use super::templates::Templates;
use crate::contract::{Blobs, Config};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COMPUTE_READ, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ, FRAGMENT_SAMPLED, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::Recording;

/// Access to the depth.
pub const AFTER: Access = COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED);

/// Bytes of all pixels' layers and opacities.
pub fn layer_bytes(extent: vk::Extent2D, bubbles: &BubbleConfig) -> u64 {
    4 * u64::from(bubbles.layers + 1) * u64::from(extent.width) * u64::from(extent.height)
}

/// Size-dependent state.
struct Targets {
    layers: Buffer,
    depth: Image,
}

impl Targets {
    fn new(gpu: &Gpu, config: &Config, bubbles: &BubbleConfig) -> Result<Self, Error> {
        let usage = vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC;
        let format = vk::Format::R32_SFLOAT;
        Ok(Self {
            layers: Buffer::new(
                gpu,
                "bubbles/layers",
                layer_bytes(config.extent, bubbles),
                vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC,
                MemoryLocation::GpuOnly,
            )?,
            depth: Image::new(gpu, &ImageDesc::new("bubbles/depth", config.extent, format, usage))?,
        })
    }
}

/// Path that finds the nearest blobs.
enum Way {
    Tiles(Pipeline),
    Billboards(Box<Billboards>),
}

/// The pass.
pub struct Peel {
    way: Way,
    config: BubbleConfig,
    targets: Targets,
}

impl Peel {
    pub fn new(gpu: &Gpu, config: &Config, bubbles: &BubbleConfig) -> Result<Self, Error> {
        let way = match bubbles.sort {
            BubbleSort::Tiles => {
                let own = [(0, bubbles.layers)];
                let constants = [&own[..], &Templates::constants(bubbles)].concat();
                Way::Tiles(Pipeline::compute(gpu, shader::BUBBLES_PEEL_COMP, &constants)?)
            }
            BubbleSort::Peel => Way::Billboards(Box::new(Billboards::new(gpu, config, bubbles)?)),
        };
        Ok(Self { way, config: *bubbles, targets: Targets::new(gpu, config, bubbles)? })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let new = Targets::new(gpu, config, &self.config)?;
        retired.replace(&mut self.targets.layers, new.layers);
        retired.replace(&mut self.targets.depth, new.depth);
        match &mut self.way {
            Way::Tiles(_) => Ok(()),
            Way::Billboards(drawn) => drawn.resize(gpu, config, retired),
        }
    }

    /// Layers of each pixel, front to back, and the maximum opacity of all its blobs.
    pub fn layers(&self) -> &Buffer {
        &self.targets.layers
    }

    /// Words per pixel in that buffer.
    pub fn words(&self) -> u32 {
        self.config.layers + 1
    }

    /// Depth of the frontmost blob.
    pub fn depth(&self) -> &Image {
        &self.targets.depth
    }

    pub fn record(
        &self,
        r: &Recording<'_>,
        (lists, blobs): (&Lists, Option<&Blobs>),
        templates: &Templates,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let Targets { layers, depth } = &self.targets;
        let before = AFTER.and(COPY_READ).discarded();
        gpu.barriers(
            cmd,
            &[access::image(depth, before, COMPUTE_WRITE)],
            &[buffer(layers.handle, COMPUTE_READ, COMPUTE_WRITE)],
        );
        let [own, range, cells, list, spans] = lists.buffers().map(Resource::buffer);
        let bound = [
            (0, r.uniforms),
            (1, r.bubbles),
            (2, r.scene_depth),
            (3, own),
            (7, Resource::buffer(layers)),
            (11, Resource::storage(depth)),
        ];
        let bound = [&bound[..], &templates.resources(gpu)].concat();
        match &self.way {
            Way::Tiles(pipeline) => {
                let listed = [(4, range), (5, cells), (6, list), (12, spans)];
                r.descriptors.bind(gpu, cmd, pipeline, &[&bound[..], &listed].concat())?;
                r.dispatch_over(r.extent, pipeline.local_size);
            }
            Way::Billboards(drawn) => {
                drawn.record(r, lists.count(gpu, blobs), &bound, (layers, depth))?;
            }
        }
        gpu.barriers(
            cmd,
            &[access::image(depth, COMPUTE_WRITE, AFTER)],
            &[buffer(layers.handle, COMPUTE_WRITE, COMPUTE_READ)],
        );
        Ok(())
    }

    /// Bytes of images and of buffers.
    pub fn memory(&self) -> (u64, u64) {
        let drawn = match &self.way {
            Way::Tiles(_) => 0,
            Way::Billboards(drawn) => drawn.memory(),
        };
        (self.targets.depth.size + drawn, self.targets.layers.size)
    }
}
