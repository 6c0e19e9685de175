//! Pass `spray`: particles too few together to be a body of water (thesis Sec. 4.3 and 4.10).
//!
//! What of a particle its density makes spray is drawn as droplets round it, each a sprite that faces
//! the eye and streaks along its motion; `composite` lays them over all else. The source draws one
//! sprite a particle, added to the picture, which shows as a disc near the eye. Sums of optical depth
//! need no order.
//! Reads: the counts of `cull`, the host's particles, scene depth, water depth. Writes: spray,
//! RG16F, optical depth of the droplets before scene and water, and how much of it the sun lights.

use ash::vk;
use bytemuck::NoUninit;
use gpu_allocator::MemoryLocation;

use super::Recording;
use super::cull::{self, LIST_USE, SphereList, Window};
use crate::contract::{Config, Particles, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ,
    FRAGMENT_SAMPLED, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;

/// Bytes of a sprite.
pub const SPRITE: u64 = 32;
/// Workgroups of the list at most; more particles share them.
const MOST_GROUPS: u32 = 1024;

/// Read by compute (`reduce`) and by what shades.
pub const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
/// Last uses in a frame: those, or the host's copy of the layer.
const BEFORE: Access = AFTER.and(COPY_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    position_word: u32,
    position_stride: u32,
    density_word: u32,
    density_stride: u32,
    velocity_word: u32,
    velocity_stride: u32,
    id_word: u32,
    id_stride: u32,
    chunk_first: u32,
}
shader::assert_layout!(
    shader::WATER_SPRAY_LIST_COMP,
    "Push",
    Push {
        position_word,
        position_stride,
        density_word,
        density_stride,
        velocity_word,
        velocity_stride,
        id_word,
        id_stride,
        chunk_first,
    }
);

/// The pass.
pub struct Spray {
    list: Pipeline,
    draw: Pipeline,
    sprites: Buffer,
    /// Optical depth, a full-resolution texel each.
    target: Target,
}

impl Spray {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let (chunk, chunks) = super::chunks(&gpu.limits, config);
        let target = Target::new(gpu, &desc(config), vk::AttachmentLoadOp::CLEAR)?;
        let draw = Pipeline::graphics(
            gpu,
            &Graphics {
                vertex: shader::WATER_SPRAY_VERT,
                fragment: shader::WATER_SPRAY_FRAG,
                topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                pass: target.pass.handle,
                blend: &[blend(vk::BlendOp::ADD)],
                constants: &crate::light::constants(config),
            },
        )?;
        Ok(Self {
            list: Pipeline::compute(gpu, shader::WATER_SPRAY_LIST_COMP, &[])?,
            draw,
            sprites: Buffer::new(
                gpu,
                "water/spray/sprites",
                SPRITE * u64::from(chunk) * u64::from(chunks),
                vk::BufferUsageFlags::STORAGE_BUFFER,
                MemoryLocation::GpuOnly,
            )?,
            target,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.target.resize(gpu, &desc(config), retired)
    }

    /// Optical depth of the droplets, and of those that the sun lights.
    pub fn image(&self) -> &Image {
        &self.target.image
    }

    /// `list`: of `cull`, for its counts. `depth`: of the water, as its pass left it; it comes back
    /// so.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
        depth: &Image,
    ) -> Result<(), Error> {
        let scope = r.begin(c"spray");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (counts, sprites) = (list.counts.handle, self.sprites.handle);
        if let Some(densities) = &particles.densities {
            let before = [
                buffer(counts, LIST_USE, COMPUTE_READ_WRITE),
                buffer(sprites, VERTEX_READ, COMPUTE_WRITE),
            ];
            gpu.barriers(cmd, &[], &before);
            for index in 0..list.chunks {
                self.record_list(r, particles, densities, list, index)?;
            }
            let after = [
                buffer(counts, COMPUTE_READ_WRITE, LIST_USE),
                buffer(sprites, COMPUTE_WRITE, VERTEX_READ),
            ];
            gpu.barriers(cmd, &[], &after);
        }
        let to = [
            access::image(self.image(), BEFORE.discarded(), COLOR_ATTACHMENT),
            access::image(depth, COMPUTE_READ_WRITE, FRAGMENT_SAMPLED),
        ];
        gpu.barriers(cmd, &to, &[]);
        let area = r.extent.into();
        let [shadow, thickness, basis, span] = r.sunlight.resources();
        self.target.begin(gpu, cmd, area, [0.0; 4]);
        for index in 0..if particles.densities.is_some() { list.chunks } else { 0 } {
            let resources = [
                (0, r.uniforms),
                (1, self.chunk(list, index)),
                (2, r.scene_depth),
                (3, Resource::Sampled(depth.view, gpu.samplers.nearest)),
                shadow,
                thickness,
                basis,
                span,
            ];
            r.descriptors.bind(gpu, cmd, &self.draw, &resources)?;
            let arguments = list.chunk(index).arguments + cull::SPRAY;
            // SAFETY: inside a render pass; the arguments are visible (barrier of the list).
            unsafe { gpu.device.cmd_draw_indirect(cmd, counts, arguments, 1, 16) };
        }
        gpu.end_pass(cmd);
        let back = [
            access::image(self.image(), COLOR_ATTACHMENT, AFTER),
            access::image(depth, FRAGMENT_SAMPLED, COMPUTE_READ_WRITE),
        ];
        gpu.barriers(cmd, &back, &[]);
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
        densities: &Stream,
        list: &SphereList,
        index: u32,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let first = index * list.chunk_size;
        // A stream that ends before the chunk has no particles in it: the count was clamped.
        let bound = [&particles.positions, densities].map(|stream| Window::new(gpu, stream, first));
        let [Some(positions), Some(densities)] = bound else {
            return Ok(());
        };
        let [Some(velocities), Some(ids)] =
            [&particles.velocities, &particles.ids].map(|stream| positions.or(gpu, stream, first))
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
                (3, velocities.resource),
                (4, ids.resource),
                (5, list.chunk(index).counts),
                (6, self.chunk(list, index)),
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
                velocity_word: velocities.word,
                velocity_stride: velocities.stride,
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

fn desc(config: &Config) -> ImageDesc<'static> {
    let usage = vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::COLOR_ATTACHMENT
        | vk::ImageUsageFlags::TRANSFER_SRC;
    // Every device blends it.
    ImageDesc::new("water/spray", config.extent, vk::Format::R16G16_SFLOAT, usage)
}
