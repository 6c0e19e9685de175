//! Part of pass `radiance`: lists the screen tiles that contain whitewater. Light and shadow are computed only for
//! these, because most of a picture has no whitewater. The paper has no such list.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use crate::contract::Config;
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{Access, COMPUTE_READ, COMPUTE_READ_WRITE, COPY_WRITE, INDIRECT, buffer};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::Image;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::Recording;

/// Number of halvings from pixels to tiles: tiles are 8×8 (glsl/include/whitewater_tiles.glsl).
const LEVEL: u32 = 3;
/// Arguments of an empty dispatch, followed by a tile count of 0 (glsl/include/whitewater_tiles.glsl).
const NONE: [u32; 4] = [0, 0, 1, 0];
/// State after the list is complete.
const READ: Access = COMPUTE_READ.and(INDIRECT);

/// The tiles of a frame.
pub struct Tiles {
    pipeline: Pipeline,
    list: Buffer,
}

fn list(gpu: &Gpu, config: &Config) -> Result<Buffer, Error> {
    let vk::Extent2D { width, height } = reduced(config.extent, LEVEL);
    let bytes = 4 * (NONE.len() as u64 + u64::from(width) * u64::from(height));
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER
        | vk::BufferUsageFlags::INDIRECT_BUFFER
        | vk::BufferUsageFlags::TRANSFER_DST;
    Buffer::new(gpu, "whitewater/radiance/tiles", bytes, usage, MemoryLocation::GpuOnly)
}

impl Tiles {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let pipeline = Pipeline::compute(gpu, shader::WHITEWATER_TILES_COMP, &[])?;
        Ok(Self { pipeline, list: list(gpu, config)? })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        retired.replace(&mut self.list, list(gpu, config)?);
        Ok(())
    }

    /// Lists the tiles. `occluders` contains the foam's depth; compute shaders sample it.
    pub fn record(&self, r: &Recording<'_>, occluders: &Image) -> Result<(), Error> {
        let (gpu, cmd, list) = (r.gpu, r.cmd, self.list.handle);
        gpu.barriers(cmd, &[], &[buffer(list, READ, COPY_WRITE)]);
        // SAFETY: outside a render pass; the frame before has read it (barrier).
        unsafe { gpu.device.cmd_update_buffer(cmd, list, 0, bytemuck::bytes_of(&NONE)) };
        gpu.barriers(cmd, &[], &[buffer(list, COPY_WRITE, COMPUTE_READ_WRITE)]);
        let occluders = Resource::Sampled(occluders.view, gpu.samplers.nearest);
        let resources = [(0, r.uniforms), (1, occluders), (9, self.resource())];
        r.descriptors.bind(gpu, cmd, &self.pipeline, &resources)?;
        r.dispatch_over(reduced(r.extent, LEVEL), self.pipeline.local_size);
        gpu.barriers(cmd, &[], &[buffer(list, COMPUTE_READ_WRITE, READ)]);
        Ok(())
    }

    /// The list, for binding 9 of shaders that use it.
    pub fn resource(&self) -> Resource {
        Resource::buffer(&self.list)
    }

    /// Dispatches one group per tile with the bound pipeline.
    pub fn dispatch(&self, r: &Recording<'_>) {
        // SAFETY: outside a render pass, pipeline and set are bound; the arguments are visible since `record`.
        unsafe { r.gpu.device.cmd_dispatch_indirect(r.cmd, self.list.handle, 0) };
    }

    /// Bytes of buffers.
    pub fn memory(&self) -> u64 {
        self.list.size
    }
}
