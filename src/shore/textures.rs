//! Pass `web`: computes two textures of shoreline and contact foam with all mip levels, once: the foam texture,
//! called web, and the noise. The web can be computed again from an image of the host.
//!
//! Reads: texels that the CPU computed, or the host's image of the web. Writes: the texture web (mean, mean of the
//! square, slope on each axis) and the noise, RGBA16F.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::settings::ShoreConfig;
use super::texture;
use crate::contract::HostImage;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COPY_READ, COPY_WRITE, FRAGMENT_SAMPLED,
    buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource, bind_set};
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;

/// Side length of the noise texture.
const NOISE: u32 = 256;
/// Access to all of them.
const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
/// Maximum number of mip levels of both, at 2048 and 256 texels.
const MOST_LEVELS: u32 = 12 + 9;

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    part: [f32; 4],
    size: u32,
    first: u32,
    before: u32,
}
shader::assert_layout!(shader::SHORE_TEXTURE_COMP, "Push", Push { part, size, first, before });

/// One texture: its floats as computed, its packed levels, its image.
struct Texture {
    edge: u32,
    first: Pipeline,
    next: Pipeline,
    floats: Buffer,
    halves: Buffer,
    image: Image,
    /// Descriptor sets, one per level.
    sets: Vec<vk::DescriptorSet>,
}

impl Texture {
    fn new(
        gpu: &Gpu,
        descriptors: &Descriptors,
        (name, edge, noise): (&str, u32, bool),
        floats: &[u8],
    ) -> Result<Self, Error> {
        let format = vk::Format::R16G16B16A16_SFLOAT;
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let extent = vk::Extent2D { width: edge, height: edge };
        let desc = ImageDesc::new(name, extent, format, usage);
        let pipeline = |from| {
            let constants = [(0, u32::from(noise)), (1, from)];
            Pipeline::compute(gpu, shader::SHORE_TEXTURE_COMP, &constants)
        };
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let mut own = Buffer::new(
            gpu,
            &format!("{name}/floats"),
            floats.len() as u64,
            storage,
            MemoryLocation::CpuToGpu,
        )?;
        own.mapped_mut()[..floats.len()].copy_from_slice(floats);
        let levels = edge.ilog2() + 1;
        let mut made = Self {
            edge,
            first: pipeline(1)?,
            next: pipeline(0)?,
            floats: own,
            halves: Buffer::new(
                gpu,
                &format!("{name}/halves"),
                8 * u64::from(level_begin(edge, levels)),
                storage | vk::BufferUsageFlags::TRANSFER_SRC,
                MemoryLocation::GpuOnly,
            )?,
            image: Image::new(gpu, &ImageDesc { mips: levels, ..desc })?,
            sets: Vec::new(),
        };
        // No image is read, so any can be bound.
        let any = Resource::Sampled(made.image.view, gpu.samplers.nearest);
        made.sets = (0..levels)
            .map(|level| {
                let pipeline = if level == 0 { &made.first } else { &made.next };
                descriptors.set(gpu, pipeline, &made.resources(any))
            })
            .collect::<Result<_, _>>()?;
        Ok(made)
    }

    fn resources(&self, image: Resource) -> [(u32, Resource); 3] {
        [(0, Resource::buffer(&self.floats)), (1, Resource::buffer(&self.halves)), (2, image)]
    }

    /// Records the computation of all mip levels of this texture and their copy to its image. If the first level
    /// comes from an image of the host, `host` holds the pipeline, the descriptor set and the part of the image for
    /// it.
    fn record(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        host: Option<(&Pipeline, vk::DescriptorSet, vk::Rect2D)>,
    ) {
        let halves = self.halves.handle;
        let both = COMPUTE_READ_WRITE;
        for (level, &set) in (0_u32..).zip(&self.sets) {
            let before = if level == 0 { COPY_READ } else { both };
            gpu.barriers(cmd, &[], &[buffer(halves, before, both)]);
            let own = if level == 0 { &self.first } else { &self.next };
            let (pipeline, set, rect) =
                host.filter(|_| level == 0).unwrap_or((own, set, vk::Rect2D::default()));
            pipeline.bind(gpu, cmd);
            bind_set(gpu, cmd, pipeline, set);
            let begin = |level| 2 * level_begin(self.edge, level);
            let size = self.edge >> level;
            let vk::Rect2D { offset, extent } = rect;
            let part = [offset.x, offset.y, extent.width as i32, extent.height as i32];
            let before = begin(level.saturating_sub(1));
            let part = part.map(|v| v as f32);
            pipeline.push(gpu, cmd, &Push { part, size, first: begin(level), before });
            let groups = size.div_ceil(8);
            // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
            unsafe { gpu.device.cmd_dispatch(cmd, groups, groups, 1) };
        }
        gpu.barriers(
            cmd,
            &[access::image(&self.image, AFTER.discarded(), COPY_WRITE)],
            &[buffer(halves, both, COPY_READ)],
        );
        let regions: Vec<_> = (0..self.sets.len() as u32)
            .map(|level| {
                let size = self.edge >> level;
                vk::BufferImageCopy::default()
                    .buffer_offset(8 * u64::from(level_begin(self.edge, level)))
                    .image_subresource(vk::ImageSubresourceLayers {
                        aspect_mask: vk::ImageAspectFlags::COLOR,
                        mip_level: level,
                        base_array_layer: 0,
                        layer_count: 1,
                    })
                    .image_extent(vk::Extent3D { width: size, height: size, depth: 1 })
            })
            .collect();
        // SAFETY: the buffer holds all levels (barrier), the image is in the layout.
        unsafe {
            gpu.device.cmd_copy_buffer_to_image(
                cmd,
                halves,
                self.image.handle,
                COPY_WRITE.layout,
                &regions,
            );
        }
        gpu.barriers(cmd, &[access::image(&self.image, COPY_WRITE, AFTER)], &[]);
    }

    fn memory(&self) -> (u64, u64) {
        (self.image.size, self.floats.size + self.halves.size)
    }
}

/// First texel of a level among all of them.
fn level_begin(edge: u32, level: u32) -> u32 {
    (0..level).map(|level| (edge >> level).pow(2)).sum()
}

/// The textures.
pub struct Textures {
    config: ShoreConfig,
    web: Texture,
    noise: Texture,
    /// The foam texture from an image of the host.
    hosts: Pipeline,
    _setup: Descriptors,
    sampler: Owned<vk::Sampler>,
}

impl Textures {
    pub fn new(gpu: &Gpu, config: &ShoreConfig) -> Result<Self, Error> {
        let web = texture::web(config.texture_size, config.seed);
        let noise = texture::noise(NOISE, config.seed);
        let repeat = vk::SamplerAddressMode::REPEAT;
        // Mip levels are not interpolated. Each level also stores the variance of the detail that it lacks, so the
        // foam computed from successive levels differs little.
        let sampler = vk::SamplerCreateInfo::default()
            .mag_filter(vk::Filter::LINEAR)
            .min_filter(vk::Filter::LINEAR)
            .mipmap_mode(vk::SamplerMipmapMode::NEAREST)
            .max_lod(vk::LOD_CLAMP_NONE)
            .address_mode_u(repeat)
            .address_mode_v(repeat)
            .address_mode_w(repeat);
        let setup = Descriptors::new(gpu, MOST_LEVELS)?;
        let texture = |what, floats| Texture::new(gpu, &setup, what, floats);
        Ok(Self {
            config: *config,
            web: texture(("shore/web", config.texture_size, false), bytemuck::cast_slice(&web))?,
            noise: texture(("shore/noise", NOISE, true), bytemuck::cast_slice(&noise))?,
            hosts: Pipeline::compute(gpu, shader::SHORE_TEXTURE_COMP, &[(0, 0), (1, 2)])?,
            _setup: setup,
            sampler: gpu.sampler("repeat, a level", &sampler)?,
        })
    }

    /// Whether they fit a configuration.
    pub fn fits(&self, config: &ShoreConfig) -> bool {
        (self.config.texture_size, self.config.seed) == (config.texture_size, config.seed)
    }

    /// Records the built-in textures.
    pub fn record_setup(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        gpu.begin_label(cmd, c"web");
        for texture in [&self.web, &self.noise] {
            let bound = access::image(&texture.image, AFTER.discarded(), AFTER);
            gpu.barriers(cmd, &[bound], &[]);
            texture.record(gpu, cmd, None);
        }
        gpu.end_label(cmd);
    }

    /// Records the web from an image of the host.
    pub fn record_foam_texture(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        image: &HostImage,
    ) -> Result<(), Error> {
        let sampled = Resource::Sampled(image.view, gpu.samplers.nearest);
        let set = descriptors.set(gpu, &self.hosts, &self.web.resources(sampled))?;
        gpu.begin_label(cmd, c"web");
        let barrier = |before, after| access::raw_image(image.image, image.aspect, before, after);
        gpu.barriers(cmd, &[barrier(image.before, COMPUTE_SAMPLED)], &[]);
        self.web.record(gpu, cmd, Some((&self.hosts, set, image.rect)));
        gpu.barriers(cmd, &[barrier(COMPUTE_SAMPLED, image.after)], &[]);
        gpu.end_label(cmd);
        Ok(())
    }

    pub fn web(&self) -> Resource {
        Resource::Sampled(self.web.image.view, self.sampler.handle)
    }

    pub fn noise(&self) -> Resource {
        Resource::Sampled(self.noise.image.view, self.sampler.handle)
    }

    /// Side lengths of foam texture and noise.
    pub fn edges(&self) -> [f32; 2] {
        [self.web.edge as f32, self.noise.edge as f32]
    }

    /// Bytes of images and of buffers.
    pub fn memory(&self) -> (u64, u64) {
        let (a, b) = (self.web.memory(), self.noise.memory());
        (a.0 + b.0, a.1 + b.1)
    }
}
