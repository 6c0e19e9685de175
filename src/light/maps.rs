//! Pass `light`: maps of water and surface foam as seen from the sun.
//!
//! Pass `light` draws every particle into maps as seen from the sun, independent of the camera, directly from the
//! host's streams, without a list. Particles in culled packets are included, because they cast shadows into the view.
//! Reads: the counts and the members of `cull` (which particles are in a packet), the host's particles. Writes:
//! front, R32F, position of the first surface along the light, in scene units; thickness, RGBA32F, of water and of
//! foam along the light in scene units, then each of the two multiplied by its position along the light.

use ash::vk;
use bytemuck::NoUninit;

use super::map_desc;
use crate::contract::{Config, Particles};
use crate::error::Error;
use crate::frame::EMPTY;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_SAMPLED, COPY_READ, FRAGMENT_SAMPLED, VERTEX_SAMPLED,
};
use crate::gpu::image::Image;
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::shader;
use crate::gpu::target::Target;
use crate::water::{self, Recording, SphereList, Window};

/// Access by compute, by shading passes, and by the vertex shader of spray.
pub const AFTER: Access = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED).and(VERTEX_SAMPLED);
/// Last uses of a light map (front or thickness) in a frame, for which the next frame waits: those of [`AFTER`], or a
/// copy of the layer by the host.
const BEFORE: Access = AFTER.and(COPY_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    position_word: u32,
    position_stride: u32,
    density_word: u32,
    density_stride: u32,
    foam_word: u32,
    foam_stride: u32,
    packets: u32,
}
shader::assert_layout!(
    [shader::LIGHT_FRONT_VERT, shader::LIGHT_THICKNESS_VERT],
    "Push",
    Push {
        position_word,
        position_stride,
        density_word,
        density_stride,
        foam_word,
        foam_stride,
        packets,
    }
);

/// A map that sprites are blended into.
pub struct Map {
    target: Target,
    pipeline: Pipeline,
    front: bool,
}

impl Map {
    fn new(gpu: &Gpu, config: &Config, edge: u32, front: bool) -> Result<Self, Error> {
        let (name, format) = match front {
            true => ("light/front", vk::Format::R32_SFLOAT),
            false => ("light/thickness", vk::Format::R32G32B32A32_SFLOAT),
        };
        let desc = map_desc(name, edge, format, vk::ImageUsageFlags::COLOR_ATTACHMENT);
        let target = Target::new(gpu, &desc, vk::AttachmentLoadOp::CLEAR)?;
        let (vertex, fragment, op) = match front {
            true => (shader::LIGHT_FRONT_VERT, shader::LIGHT_FRONT_FRAG, vk::BlendOp::MIN),
            false => (shader::LIGHT_THICKNESS_VERT, shader::LIGHT_THICKNESS_FRAG, vk::BlendOp::ADD),
        };
        let pipeline = Pipeline::graphics(
            gpu,
            &Graphics {
                vertex,
                fragment,
                topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                pass: target.pass,
                blend: &[blend(op)],
                constants: &[(9, u32::from(config.surface_foam))],
            },
        )?;
        Ok(Self { target, pipeline, front })
    }

    pub fn image(&self) -> &Image {
        &self.target.image
    }

    fn record(
        &self,
        r: &Recording<'_>,
        particles: &Particles,
        list: &SphereList,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let to = COLOR_ATTACHMENT;
        gpu.barriers(cmd, &[access::image(self.image(), BEFORE.discarded(), to)], &[]);
        let clear = [if self.front { EMPTY } else { 0.0 }, 0.0, 0.0, 0.0];
        self.target.begin(gpu, cmd, self.image().extent.into(), clear);
        for index in 0..list.chunks {
            let first = index * list.chunk_size;
            let others = [&particles.densities, &particles.surface_foam];
            let bound = Window::all(gpu, &particles.positions, others, first);
            // A stream that ends before the chunk has no particles in it: the count was clamped.
            let Some((positions, [densities, foam])) = bound else { break };
            let resources = [
                (0, r.uniforms),
                (1, positions.resource),
                (2, densities.resource),
                (3, foam.resource),
                (4, list.chunk(index).members),
            ];
            r.descriptors.bind(gpu, cmd, &self.pipeline, &resources)?;
            self.pipeline.push(
                gpu,
                cmd,
                &Push {
                    position_word: positions.word,
                    position_stride: positions.stride,
                    density_word: densities.word,
                    density_stride: densities.stride,
                    foam_word: foam.word,
                    foam_stride: foam.stride,
                    packets: u32::from(particles.packets.is_some()),
                },
            );
            let draw = list.chunk(index).arguments + water::CAST;
            // SAFETY: inside a render pass; the arguments are visible since `cull`.
            unsafe { gpu.device.cmd_draw_indirect(cmd, list.counts.handle, draw, 1, 16) };
        }
        gpu.end_pass(cmd);
        gpu.barriers(cmd, &[access::image(self.image(), COLOR_ATTACHMENT, AFTER)], &[]);
        Ok(())
    }
}

/// The pass.
pub struct Maps {
    pub front: Map,
    pub thickness: Map,
}

impl Maps {
    pub fn new(gpu: &Gpu, config: &Config, edge: u32) -> Result<Self, Error> {
        Ok(Self {
            front: Map::new(gpu, config, edge, true)?,
            thickness: Map::new(gpu, config, edge, false)?,
        })
    }

    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
    ) -> Result<(), Error> {
        let scope = r.begin(c"light");
        self.front.record(r, particles, list)?;
        self.thickness.record(r, particles, list)?;
        r.end(scope);
        Ok(())
    }
}
