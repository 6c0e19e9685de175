//! Pass `caustics`: sunlight focused and spread by the water's surface (caustics mapping, Shah, Konttinen,
//! Pattanaik 2007, with one photon per texel instead of a mesh).
//!
//! Caustics: the light map's front, the first water surface as seen from the sun, is smoothed with the same width as
//! the water on the screen. At this surface the sunlight of each texel is refracted, and added, with integer atomics,
//! to the texel of the map where it leaves the water again. Sunlight that the host's scene blocks, according to its
//! shadow map, is left out.
//! Reads: front, thickness, shadow map. Writes: caustics, R32F, sunlight relative to that without water.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::map_desc;
use super::maps::Maps;
use crate::contract::Config;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ, COPY_WRITE,
    FRAGMENT_SAMPLED, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::Image;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::Recording;

/// The pass.
pub struct Caustics {
    smooth: Pipeline,
    refract: Pipeline,
    resolve: Pipeline,
    /// The front smoothed along x, and along both axes.
    smoothed: [Image; 2],
    photons: Buffer,
    /// The result.
    pub image: Image,
}

impl Caustics {
    pub fn new(gpu: &Gpu, config: &Config, edge: u32) -> Result<Self, Error> {
        let usage = vk::ImageUsageFlags::STORAGE;
        let image = |name| Image::new(gpu, &map_desc(name, edge, vk::Format::R32_SFLOAT, usage));
        Ok(Self {
            smooth: Pipeline::compute(gpu, shader::LIGHT_SMOOTH_COMP, &[])?,
            refract: Pipeline::compute(
                gpu,
                shader::LIGHT_CAUSTICS_COMP,
                &super::constants(config),
            )?,
            resolve: Pipeline::compute(gpu, shader::LIGHT_CAUSTICS_RESOLVE_COMP, &[])?,
            smoothed: [image("light/smoothed/x")?, image("light/smoothed")?],
            photons: Buffer::new(
                gpu,
                "light/photons",
                4 * u64::from(edge) * u64::from(edge),
                vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST,
                MemoryLocation::GpuOnly,
            )?,
            image: image("light/caustics")?,
        })
    }

    pub fn record(&self, r: &mut Recording<'_>, maps: &Maps) -> Result<(), Error> {
        let scope = r.begin(c"caustics");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let nearest = gpu.samplers.nearest;
        let sampled = |image: &Image| Resource::Sampled(image.view, nearest);
        let extent = self.image.extent;
        let front = sampled(maps.front.image());
        let photons = self.photons.handle;
        gpu.barriers(cmd, &[], &[buffer(photons, COMPUTE_READ, COPY_WRITE)]);
        // SAFETY: outside a render pass; the frame before has read it (barrier).
        unsafe { gpu.device.cmd_fill_buffer(cmd, photons, 0, vk::WHOLE_SIZE, 0) };

        let [across, smoothed] = &self.smoothed;
        for (vertical, source, image) in [(0, front, across), (1, sampled(across), smoothed)] {
            let before = COMPUTE_SAMPLED.discarded();
            gpu.barriers(cmd, &[access::image(image, before, COMPUTE_WRITE)], &[]);
            let resources = [(0, r.uniforms), (1, source), (2, Resource::storage(image))];
            r.descriptors.bind(gpu, cmd, &self.smooth, &resources)?;
            self.smooth.push(gpu, cmd, &i32::from(vertical == 1));
            r.dispatch_over(extent, self.smooth.local_size);
            gpu.barriers(cmd, &[access::image(image, COMPUTE_WRITE, COMPUTE_SAMPLED)], &[]);
        }

        gpu.barriers(cmd, &[], &[buffer(photons, COPY_WRITE, COMPUTE_READ_WRITE)]);
        let resources = [
            (0, r.uniforms),
            (1, sampled(smoothed)),
            (2, sampled(maps.thickness.image())),
            (3, Resource::buffer(&self.photons)),
            (16, r.sunlight.shadow),
            (18, r.sunlight.convolved[0]),
            (19, r.sunlight.convolved[1]),
        ];
        r.descriptors.bind(gpu, cmd, &self.refract, &resources)?;
        r.dispatch_over(extent, self.refract.local_size);

        let before = FRAGMENT_SAMPLED.and(COPY_READ).discarded();
        gpu.barriers(
            cmd,
            &[access::image(&self.image, before, COMPUTE_WRITE)],
            &[buffer(photons, COMPUTE_READ_WRITE, COMPUTE_READ)],
        );
        let resources = [
            (0, r.uniforms),
            (1, front),
            (2, Resource::storage(&self.image)),
            (3, Resource::buffer(&self.photons)),
        ];
        r.descriptors.bind(gpu, cmd, &self.resolve, &resources)?;
        r.dispatch_over(extent, self.resolve.local_size);
        gpu.barriers(cmd, &[access::image(&self.image, COMPUTE_WRITE, FRAGMENT_SAMPLED)], &[]);
        r.end(scope);
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        let smoothed: u64 = self.smoothed.iter().map(|image| image.size).sum();
        (smoothed + self.image.size, self.photons.size)
    }
}
