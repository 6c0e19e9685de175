//! Projects the environment's irradiance to spherical harmonics, in each frame because the environment may change.
//! Reads: environment, uniforms. Writes: nine coefficients.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::Recording;
use super::textures::Textures;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COMPUTE_WRITE, FRAGMENT_READ};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;

pub struct Irradiance {
    coefficients: Buffer,
    pipeline: Pipeline,
}

impl Irradiance {
    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let size = 9 * size_of::<[f32; 4]>() as u64;
        Ok(Self {
            coefficients: Buffer::new(
                gpu,
                "scene/irradiance",
                size,
                usage,
                MemoryLocation::GpuOnly,
            )?,
            pipeline: Pipeline::compute(gpu, shader::HEADLESS_IRRADIANCE_COMP, &[])?,
        })
    }

    pub fn record(&self, r: &Recording<'_>) -> Result<(), Error> {
        let buffer = self.coefficients.handle;
        r.gpu.barriers(r.cmd, &[], &[access::buffer(buffer, FRAGMENT_READ, COMPUTE_WRITE)]);
        r.descriptors.bind(r.gpu, r.cmd, &self.pipeline, &r.resources(Textures::WHITE))?;
        // SAFETY: outside a render pass; pipeline and set are bound.
        unsafe { r.gpu.device.cmd_dispatch(r.cmd, 1, 1, 1) };
        r.gpu.barriers(r.cmd, &[], &[access::buffer(buffer, COMPUTE_WRITE, FRAGMENT_READ)]);
        Ok(())
    }

    pub fn resource(&self) -> Resource {
        Resource::buffer(&self.coefficients)
    }
}
