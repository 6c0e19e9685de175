//! Pass `noise`: the baseline's surface noise (van der Laan, Green, Sainz, I3D 2009, as described in the
//! thesis, Sec. 2.5): detail finer than the particles, which moves with them.
//!
//! Each particle has one octave of gradient noise under a Gaussian. The particle's id selects its noise, which moves
//! with the particle and fades with the particle's depth below the surface. The sum over the particles is a height on
//! the front surface. `composite` turns the surface's normals by the slope of this height and, as the baseline's
//! foam, adds grey in proportion to its magnitude (glsl/include/ripples.glsl).
//!
//! The description of the baseline leaves some choices open. Here the noise is aligned with the world's axes, and the
//! surface is that of the unsmoothed spheres. The depth below it is that of a particle's nearest point, so particles
//! at the surface count fully. Sums use fixed-point steps, so the order of the particles does not matter. The noise
//! has a mean of zero and does not depend on motion: a calm pool has as much of it as a waterfall.
//! Reads: the counts of `cull`, the host's particles, water depth. Writes: noise, R32F, 0 where there is no
//! water.

use ash::vk;
use bytemuck::NoUninit;

use super::Recording;
use super::cull::{self, SphereList};
use super::sprites::{Over, Sprites};
use crate::contract::{Config, Particles};
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COPY_READ, FRAGMENT_SAMPLED, VERTEX_READ,
};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;

/// Bytes of a sprite.
const SPRITE: u64 = 16;

/// Last uses of the noise image in a frame, for which the next frame waits: by `composite`, or the host's copy of the
/// layer.
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
    packets: u32,
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
        packets,
    }
);

/// The pass.
pub struct Noise {
    sprites: Sprites,
    draw: Pipeline,
    target: Target,
    /// Number of halvings of its resolution.
    pub level: u32,
}

impl Noise {
    /// `level` has the meaning of [`Config::noise`].
    pub fn new(gpu: &Gpu, config: &Config, level: u32) -> Result<Self, Error> {
        let target = Target::new(gpu, &desc(config, level), vk::AttachmentLoadOp::CLEAR)?;
        let draw = Pipeline::graphics(
            gpu,
            &Graphics {
                vertex: shader::WATER_NOISE_VERT,
                fragment: shader::WATER_NOISE_FRAG,
                topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                pass: target.pass,
                blend: &[blend(vk::BlendOp::ADD)],
                constants: &[],
            },
        )?;
        let shader = shader::WATER_NOISE_LIST_COMP;
        Ok(Self {
            sprites: Sprites::new(
                gpu,
                config,
                "water/noise/sprites",
                SPRITE,
                (shader, &[]),
                VERTEX_READ,
            )?,
            draw,
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

    /// The height; [`SurfaceNoiseSettings`](super::SurfaceNoiseSettings) sets the scale.
    pub fn image(&self) -> &Image {
        &self.target.image
    }

    /// Records the pass for the particles in `list`, the list of pass `cull`, whose counts are read. `depth` is the
    /// image of the water's depth, which fragment shaders sample.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
        depth: &Image,
    ) -> Result<(), Error> {
        let scope = r.begin(c"noise");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let streams = [&particles.densities, &particles.ids];
        let over = Over { particles, streams, binding: 1 };
        self.sprites.record(r, list, &over, &[], |chunk_first, positions, [densities, ids]| {
            Push {
                position_word: positions.word,
                position_stride: positions.stride,
                density_word: densities.word,
                density_stride: densities.stride,
                id_word: ids.word,
                id_stride: ids.stride,
                chunk_first,
                packets: u32::from(particles.packets.is_some()),
            }
        })?;
        let to = COLOR_ATTACHMENT;
        gpu.barriers(cmd, &[access::image(self.image(), BEFORE.discarded(), to)], &[]);
        self.target.begin(gpu, cmd, reduced(r.extent, self.level).into(), [0.0; 4]);
        let water = Resource::Sampled(depth.view, gpu.samplers.nearest);
        self.sprites.draw(r, list, &self.draw, cull::NOISE, &[(2, water)])?;
        gpu.end_pass(cmd);
        gpu.barriers(cmd, &[access::image(self.image(), COLOR_ATTACHMENT, FRAGMENT_SAMPLED)], &[]);
        r.end(scope);
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        (self.image().size, self.sprites.memory())
    }
}

fn desc(config: &Config, level: u32) -> ImageDesc<'static> {
    let usage = vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::COLOR_ATTACHMENT
        | vk::ImageUsageFlags::TRANSFER_SRC;
    let extent = reduced(config.extent, level);
    ImageDesc::new("water/noise", extent, vk::Format::R32_SFLOAT, usage)
}
