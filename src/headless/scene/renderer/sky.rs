//! Draws the sky, and below the horizon the sea if the scene has one: one triangle at the far plane, behind all
//! meshes.
//! Reads: environment, irradiance, uniforms.

use ash::vk;

use super::opaque::{Opaque, set_depth_test};
use super::textures::Textures;
use super::{Recording, sea};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;

pub struct Sky(Pipeline);

impl Sky {
    pub fn new(
        gpu: &Gpu,
        pass: vk::RenderPass,
        samples: vk::SampleCountFlags,
        sea: u32,
    ) -> Result<Self, Error> {
        let opaque = Opaque {
            vertex: shader::HEADLESS_SKY_VERT,
            fragment: Some(shader::HEADLESS_SKY_FRAG),
            attributes: &[],
            pass,
            colored: true,
            samples,
            bias: 0.0,
            constants: &[(sea::CONSTANT, sea)],
        };
        opaque.pipeline(gpu).map(Self)
    }

    pub fn draw(&self, r: &Recording<'_>) -> Result<(), Error> {
        r.descriptors.bind(r.gpu, r.cmd, &self.0, &r.resources(Textures::WHITE))?;
        set_depth_test(r.gpu, r.cmd, r.view.far);
        // SAFETY: inside a render pass; the sky has no vertex input.
        unsafe { r.gpu.device.cmd_draw(r.cmd, 3, 1, 0, 0) };
        Ok(())
    }
}
