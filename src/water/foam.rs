//! Pass `foam`: the frontmost foam and how much there is (thesis Sec. 3.2, 4.6.2 and 4.8).
//!
//! Particles with foam are sprites along their motion; where they are slow or come towards the eye
//! they turn into discs, smoothly (the source switches, which pops). The corners are pulled in the
//! vertex shader, the fragment meets the sprite's plane exactly. Thickness is in metres, as that of
//! the water: what a particle is foam of it is no water.
//! Nothing pops or flickers: sprites sink into the scene softly, the depth's sprite is whole before its foam can be seen, no sprite of the
//! thickness is narrower than what its texels can hold, finer noise fades, the front layer ends softly.
//! Spray is none: as the density falls `spray` takes over.
//! Reads: the counts of `cull`, the host's particles, scene depth. Writes: foam depth, R32F, EMPTY
//! where there is none; foam thickness, RG32F (all, and within a depth behind the frontmost),
//! RGBA32F where there are shadows (the third: what of that layer the sun lights; a mask apart).

use ash::vk;
use bytemuck::NoUninit;

use super::Recording;
use super::cull::{self, SphereList};
use super::settings::Shadows;
use super::sprites::{Over, Sprites};
use crate::contract::{Config, Particles};
use crate::error::Error;
use crate::frame::{EMPTY, reduced};
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_SAMPLED, COPY_READ, FRAGMENT_SAMPLED,
};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;

/// Bytes of a sprite.
pub const SPRITE: u64 = 48;

/// Both images are read by compute (`reduce`) and by what shades.
pub const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
/// Last uses in a frame: those, or the host's copy of the layer.
const BEFORE: Access = AFTER.and(COPY_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    position_word: u32,
    position_stride: u32,
    amount_word: u32,
    amount_stride: u32,
    velocity_word: u32,
    velocity_stride: u32,
    id_word: u32,
    id_stride: u32,
    density_word: u32,
    density_stride: u32,
    chunk_first: u32,
}
shader::assert_layout!(
    shader::WATER_FOAM_LIST_COMP,
    "Push",
    Push {
        position_word,
        position_stride,
        amount_word,
        amount_stride,
        velocity_word,
        velocity_stride,
        id_word,
        id_stride,
        density_word,
        density_stride,
        chunk_first,
    }
);

/// An image that sprites are blended into.
struct Blended {
    target: Target,
    pipeline: Pipeline,
    level: u32,
}

/// What an image is for.
#[derive(Clone, Copy)]
enum Kind {
    Depth,
    Thickness,
}

impl Blended {
    fn new(gpu: &Gpu, config: &Config, kind: Kind) -> Result<Self, Error> {
        let (fragment, thick, op) = match kind {
            Kind::Depth => (shader::WATER_FOAM_DEPTH_FRAG, 0, vk::BlendOp::MIN),
            Kind::Thickness => (shader::WATER_FOAM_THICKNESS_FRAG, 1, vk::BlendOp::ADD),
        };
        let target = Target::new(gpu, &desc(config, kind), vk::AttachmentLoadOp::CLEAR)?;
        let pipeline = Pipeline::graphics(
            gpu,
            &Graphics {
                vertex: shader::WATER_FOAM_VERT,
                fragment,
                topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                pass: target.pass.handle,
                blend: &[blend(op)],
                constants: &[(0, thick)],
            },
        )?;
        Ok(Self { target, pipeline, level: level(config, kind) })
    }

    /// Clears the image, and blends all sprites into it, if there are any.
    fn record(
        &self,
        r: &mut Recording<'_>,
        foam: &Foam,
        list: &SphereList,
        clear: f32,
        any: bool,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let to = COLOR_ATTACHMENT;
        gpu.barriers(cmd, &[access::image(&self.target.image, BEFORE.discarded(), to)], &[]);
        let area = reduced(r.extent, self.level).into();
        let clear = [clear, 0.0, 0.0, 0.0];
        self.target.begin(gpu, cmd, area, clear);
        if any {
            let more = [
                (2, r.scene_depth),
                (3, Resource::Sampled(foam.depth().view, gpu.samplers.nearest)),
            ];
            foam.sprites.draw(r, list, &self.pipeline, cull::FOAM, &more)?;
        }
        gpu.end_pass(cmd);
        gpu.barriers(cmd, &[access::image(&self.target.image, COLOR_ATTACHMENT, AFTER)], &[]);
        Ok(())
    }
}

fn desc(config: &Config, kind: Kind) -> ImageDesc<'static> {
    let (name, format) = match kind {
        Kind::Depth => ("water/foam/depth", vk::Format::R32_SFLOAT),
        Kind::Thickness => ("water/foam/thickness", thickness_format(config)),
    };
    let usage = vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::COLOR_ATTACHMENT
        | vk::ImageUsageFlags::TRANSFER_SRC;
    ImageDesc::new(name, reduced(config.extent, level(config, kind)), format, usage)
}

/// With room for what the sun lights, where something casts shadows on foam.
pub fn thickness_format(config: &Config) -> vk::Format {
    match (config.shadow, config.cast) {
        (None | Some(Shadows::Mask), None) => vk::Format::R32G32_SFLOAT,
        _ => vk::Format::R32G32B32A32_SFLOAT,
    }
}

fn level(config: &Config, kind: Kind) -> u32 {
    match kind {
        Kind::Depth => 0,
        Kind::Thickness => config.thickness_level,
    }
}

/// The pass.
pub struct Foam {
    sprites: Sprites,
    depth: Blended,
    thickness: Blended,
}

impl Foam {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let list = (shader::WATER_FOAM_LIST_COMP, &crate::light::constants(config)[..]);
        Ok(Self {
            sprites: Sprites::new(gpu, config, "water/foam/sprites", SPRITE, list)?,
            depth: Blended::new(gpu, config, Kind::Depth)?,
            thickness: Blended::new(gpu, config, Kind::Thickness)?,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.depth.target.resize(gpu, &desc(config, Kind::Depth), retired)?;
        self.thickness.target.resize(gpu, &desc(config, Kind::Thickness), retired)
    }

    /// Eye depth of the frontmost foam.
    pub fn depth(&self) -> &Image {
        &self.depth.target.image
    }

    /// Metres of foam.
    pub fn thickness(&self) -> &Image {
        &self.thickness.target.image
    }

    /// `list`: of `cull`, for its counts.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
    ) -> Result<(), Error> {
        let scope = r.begin(c"foam");
        let any = particles.foam.is_some();
        if any {
            let streams =
                [&particles.foam, &particles.velocities, &particles.ids, &particles.densities];
            let over = Over { particles, streams, binding: 1 };
            let sunlight = r.sunlight.resources();
            self.sprites.record(r, list, &over, &sunlight, |chunk_first, positions, streams| {
                let [amounts, velocities, ids, densities] = streams;
                Push {
                    position_word: positions.word,
                    position_stride: positions.stride,
                    amount_word: amounts.word,
                    amount_stride: amounts.stride,
                    velocity_word: velocities.word,
                    velocity_stride: velocities.stride,
                    id_word: ids.word,
                    id_stride: ids.stride,
                    density_word: densities.word,
                    density_stride: densities.stride,
                    chunk_first,
                }
            })?;
        }
        self.depth.record(r, self, list, EMPTY, any)?;
        self.thickness.record(r, self, list, 0.0, any)?;
        r.end(scope);
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        (self.depth().size + self.thickness().size, self.sprites.memory())
    }
}
