//! Pass `noise`: the baseline's surface noise (van der Laan, Green, Sainz, I3D 2009, as the thesis tells
//! it in Sec. 2.5): detail finer than the particles, which moves with them.
//!
//! Each particle has one octave of gradient noise under a Gaussian, fixed to it by its id, less the deeper
//! it lies below the surface. The sum is a height on the front surface: `composite` turns its normals by
//! it and, as the baseline's foam, adds grey by its magnitude (glsl/include/ripples.glsl).
//! Decided, where what is known of the baseline leaves it open: the pattern lies along the world's axes;
//! the surface is that of the spheres before they are smoothed; the depth below it is of a particle's
//! nearest point, so that what is at the surface counts whole; sums are of whole steps, so that the order
//! does not show. The noise is about 0: a calm pool has as much of it as a fall.
//! Reads: the counts of `cull`, the host's particles, water depth. Writes: noise, R32F, 0 where there is
//! no water.

use ash::vk;
use bytemuck::NoUninit;
use gpu_allocator::MemoryLocation;

use super::Recording;
use super::cull::{self, LIST_USE, SphereList, Window};
use crate::contract::{Config, Particles};
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, FRAGMENT_SAMPLED,
    VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;

/// Bytes of a sprite.
const SPRITE: u64 = 16;
/// Workgroups of the list at most; more particles share them.
const MOST_GROUPS: u32 = 1024;

/// Last uses in a frame: by `composite`, or the host's copy of the layer.
const BEFORE: Access = FRAGMENT_SAMPLED.and(COPY_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    position_word: u32,
    position_stride: u32,
    density_word: u32,
    density_stride: u32,
    id_word: u32,
    id_stride: u32,
    chunk_first: u32,
}
shader::assert_layout!(
    shader::WATER_NOISE_LIST_COMP,
    "Push",
    Push {
        position_word,
        position_stride,
        density_word,
        density_stride,
        id_word,
        id_stride,
        chunk_first,
    }
);

/// The pass.
pub struct Noise {
    list: Pipeline,
    draw: Pipeline,
    sprites: Buffer,
    target: Target,
    /// Of its resolution.
    pub level: u32,
}

impl Noise {
    /// `level`: as [`Config::noise`].
    pub fn new(gpu: &Gpu, config: &Config, level: u32) -> Result<Self, Error> {
        let (chunk, chunks) = super::chunks(&gpu.limits, config);
        let target = Target::new(gpu, &desc(config, level), vk::AttachmentLoadOp::CLEAR)?;
        let draw = Pipeline::graphics(
            gpu,
            &Graphics {
                vertex: shader::WATER_NOISE_VERT,
                fragment: shader::WATER_NOISE_FRAG,
                topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                pass: target.pass.handle,
                blend: &[blend(vk::BlendOp::ADD)],
                constants: &[],
            },
        )?;
        Ok(Self {
            list: Pipeline::compute(gpu, shader::WATER_NOISE_LIST_COMP, &[])?,
            draw,
            sprites: Buffer::new(
                gpu,
                "water/noise/sprites",
                SPRITE * u64::from(chunk) * u64::from(chunks),
                vk::BufferUsageFlags::STORAGE_BUFFER,
                MemoryLocation::GpuOnly,
            )?,
            target,
            level,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.target.resize(gpu, &desc(config, self.level), retired)
    }

    /// The height, of which [`NoiseLook`](super::NoiseLook) says how much 1 is.
    pub fn image(&self) -> &Image {
        &self.target.image
    }

    /// `list`: of `cull`, for its counts. `depth`: of the water, sampled by fragments.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
        depth: &Image,
    ) -> Result<(), Error> {
        let scope = r.begin(c"noise");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (counts, sprites) = (list.counts.handle, self.sprites.handle);
        let before = [
            buffer(counts, LIST_USE, COMPUTE_READ_WRITE),
            buffer(sprites, VERTEX_READ, COMPUTE_WRITE),
        ];
        gpu.barriers(cmd, &[], &before);
        for index in 0..list.chunks {
            self.record_list(r, particles, list, index)?;
        }
        let after = [
            buffer(counts, COMPUTE_READ_WRITE, LIST_USE),
            buffer(sprites, COMPUTE_WRITE, VERTEX_READ),
        ];
        let to = [access::image(self.image(), BEFORE.discarded(), COLOR_ATTACHMENT)];
        gpu.barriers(cmd, &to, &after);
        self.target.begin(gpu, cmd, reduced(r.extent, self.level).into(), [0.0; 4]);
        for index in 0..list.chunks {
            let resources = [
                (0, r.uniforms),
                (1, self.chunk(list, index)),
                (2, Resource::Sampled(depth.view, gpu.samplers.nearest)),
            ];
            r.descriptors.bind(gpu, cmd, &self.draw, &resources)?;
            let arguments = list.chunk(index).arguments + cull::NOISE;
            // SAFETY: inside a render pass; the arguments are visible (barrier of the list).
            unsafe { gpu.device.cmd_draw_indirect(cmd, counts, arguments, 1, 16) };
        }
        gpu.end_pass(cmd);
        gpu.barriers(cmd, &[access::image(self.image(), COLOR_ATTACHMENT, FRAGMENT_SAMPLED)], &[]);
        r.end(scope);
        Ok(())
    }

    /// A chunk's part of the sprites.
    fn chunk(&self, list: &SphereList, index: u32) -> Resource {
        let bytes = SPRITE * u64::from(list.chunk_size);
        Resource::Buffer(self.sprites.handle, bytes * u64::from(index), bytes)
    }

    fn record_list(
        &self,
        r: &Recording<'_>,
        particles: &Particles,
        list: &SphereList,
        index: u32,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let first = index * list.chunk_size;
        // A stream that ends before the chunk has no particles in it: the count was clamped.
        let Some(positions) = Window::new(gpu, &particles.positions, first) else {
            return Ok(());
        };
        let [Some(densities), Some(ids)] =
            [&particles.densities, &particles.ids].map(|stream| positions.or(gpu, stream, first))
        else {
            return Ok(());
        };
        r.descriptors.bind(
            gpu,
            cmd,
            &self.list,
            &[
                (0, r.uniforms),
                (1, positions.resource),
                (2, densities.resource),
                (3, ids.resource),
                (4, list.chunk(index).counts),
                (5, self.chunk(list, index)),
            ],
        )?;
        self.list.push(
            gpu,
            cmd,
            &Push {
                position_word: positions.word,
                position_stride: positions.stride,
                density_word: densities.word,
                density_stride: densities.stride,
                id_word: ids.word,
                id_stride: ids.stride,
                chunk_first: first,
            },
        );
        let groups = list.chunk_size.div_ceil(self.list.local_size[0]).min(MOST_GROUPS);
        // SAFETY: outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, groups, 1, 1) };
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        (self.image().size, self.sprites.size)
    }
}

fn desc(config: &Config, level: u32) -> ImageDesc<'static> {
    let usage = vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::COLOR_ATTACHMENT
        | vk::ImageUsageFlags::TRANSFER_SRC;
    let extent = reduced(config.extent, level);
    ImageDesc::new("water/noise", extent, vk::Format::R32_SFLOAT, usage)
}
