//! Pass `spray`: droplets of low-density particles, which are too few together to form a body of water (thesis
//! Sec. 4.3 and 4.9.5).
//!
//! A particle's density says which fraction of the particle is spray. This fraction is drawn as droplets around the
//! particle. Each droplet is a sprite that faces the camera and is stretched along its motion; `composite` lays the
//! droplets over everything else except bubble foam in front of the water. The thesis adds one sprite per particle to
//! the picture, which shows as a disc near the camera. A sum of optical depths up to 64 (4 with RG16F) does not depend
//! on their order, because each droplet adds a whole number of fixed-point steps. A distant droplet is widened to 1.4
//! pixels, and its optical depth is lower in proportion. The steps are so fine that it still adds several; fractions
//! of a step are rounded at random (glsl/include/whole_steps.glsl).
//! Reads: the counts of `cull`, the host's particles, scene depth, water depth, the sun's shadow maps. Writes: spray,
//! RG32F (or RG16F with coarser steps, if the device cannot blend RG32F): optical depth of the droplets in front of
//! scene and water, and the same weighted by sunlight.

use ash::vk;
use bytemuck::NoUninit;

use super::Recording;
use super::cull::{self, SphereList};
use super::sprites::{Over, Sprites};
use crate::contract::{Config, Particles, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COPY_READ,
    FRAGMENT_SAMPLED, VERTEX_READ,
};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;

/// Bytes of a sprite.
pub const SPRITE: u64 = 48;

/// Access of the passes that read the spray image: the compute pass `reduce` and the shading passes.
pub const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
/// Last uses of the spray image in a frame: those of [`AFTER`], or the host's copy of the layer.
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
    shape_word: u32,
    shape_stride: u32,
    chunk_first: u32,
    packets: u32,
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
        shape_word,
        shape_stride,
        chunk_first,
        packets,
    }
);

/// The pass.
pub struct Spray {
    sprites: Sprites,
    draw: Pipeline,
    /// Optical depth, at full resolution.
    target: Target,
}

impl Spray {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let target = Target::new(gpu, &desc(gpu, config), vk::AttachmentLoadOp::CLEAR)?;
        let single = [(34, u32::from(gpu.blends_pairs))];
        let constants = [&crate::light::constants(config)[..], &single].concat();
        let draw = Pipeline::graphics(
            gpu,
            &Graphics {
                vertex: shader::WATER_SPRAY_VERT,
                fragment: shader::WATER_SPRAY_FRAG,
                topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                pass: target.pass,
                blend: &[blend(vk::BlendOp::ADD)],
                constants: &constants,
            },
        )?;
        let shader = shader::WATER_SPRAY_LIST_COMP;
        Ok(Self {
            sprites: Sprites::new(
                gpu,
                config,
                "water/spray/sprites",
                SPRITE,
                (shader, &[]),
                VERTEX_READ,
            )?,
            draw,
            target,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.target.resize(gpu, &desc(gpu, config), retired)
    }

    /// Optical depth of the droplets, and the same weighted by sunlight.
    pub fn image(&self) -> &Image {
        &self.target.image
    }

    /// Records the pass. `shapes` are the shapes of the particles' spray, from pass `shape`; without them spray forms
    /// balls. `list` is the list of `cull`, whose counts are read. `depth` is the water's depth image. It must
    /// be in the state in which pass `depth` leaves it, and is in the same state after pass `spray`.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        shapes: &Option<Stream>,
        list: &SphereList,
        depth: &Image,
    ) -> Result<(), Error> {
        let scope = r.begin(c"spray");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let any = particles.densities.is_some();
        if any {
            let Particles { densities, velocities, ids, .. } = particles;
            let streams = [densities, velocities, ids, shapes];
            let over = Over { particles, streams, binding: 1 };
            self.sprites.record(r, list, &over, &[], |chunk_first, positions, streams| {
                let [densities, velocities, ids, shapes] = streams;
                Push {
                    position_word: positions.word,
                    position_stride: positions.stride,
                    density_word: densities.word,
                    density_stride: densities.stride,
                    velocity_word: velocities.word,
                    velocity_stride: velocities.stride,
                    id_word: ids.word,
                    id_stride: ids.stride,
                    shape_word: shapes.word,
                    shape_stride: shapes.stride,
                    chunk_first,
                    packets: u32::from(particles.packets.is_some()),
                }
            })?;
        }
        let to = [
            access::image(self.image(), BEFORE.discarded(), COLOR_ATTACHMENT),
            access::image(depth, COMPUTE_READ_WRITE, FRAGMENT_SAMPLED),
        ];
        gpu.barriers(cmd, &to, &[]);
        let area = r.extent.into();
        self.target.begin(gpu, cmd, area, [0.0; 4]);
        if any {
            let [shadow, thickness, basis, span, whitewater, soap] = r.sunlight.resources();
            let water = Resource::Sampled(depth.view, gpu.samplers.nearest);
            let sunlight = [shadow, thickness, basis, span, whitewater, soap];
            let more = [&[(2, r.scene_depth), (3, water)][..], &sunlight].concat();
            self.sprites.draw(r, list, &self.draw, cull::SPRAY, &more)?;
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

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        (self.image().size, self.sprites.memory())
    }
}

fn desc(gpu: &Gpu, config: &Config) -> ImageDesc<'static> {
    let usage = vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::COLOR_ATTACHMENT
        | vk::ImageUsageFlags::TRANSFER_SRC;
    // Every device can blend half floats.
    let (single, half) = (vk::Format::R32G32_SFLOAT, vk::Format::R16G16_SFLOAT);
    let format = if gpu.blends_pairs { single } else { half };
    ImageDesc::new("water/spray", config.extent, format, usage)
}
