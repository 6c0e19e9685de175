//! The baked vertices and indices on the device: uploaded once, drawn by every pass.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::super::Scene;
use super::super::bake::{Baked, Part, Vertex};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COPY_WRITE, VERTEX_INPUT};
use crate::gpu::buffer::Buffer;
use crate::headless::transfer::staging;

type Attribute = vk::VertexInputAttributeDescription;

const fn attribute(location: u32, format: vk::Format, offset: usize) -> Attribute {
    Attribute { location, binding: 0, format, offset: offset as u32 }
}

/// Vertices are contiguous.
pub const BINDINGS: [vk::VertexInputBindingDescription; 1] = [vk::VertexInputBindingDescription {
    binding: 0,
    stride: size_of::<Vertex>() as u32,
    input_rate: vk::VertexInputRate::VERTEX,
}];
/// The inputs of `scene.vert`; `around` is followed by `bulge`.
pub const VERTICES: [Attribute; 5] = [
    attribute(0, vk::Format::R32G32B32_SFLOAT, std::mem::offset_of!(Vertex, position)),
    attribute(1, vk::Format::R32G32B32_SFLOAT, std::mem::offset_of!(Vertex, normal)),
    attribute(2, vk::Format::R32G32_SFLOAT, std::mem::offset_of!(Vertex, uv)),
    attribute(3, vk::Format::R32G32B32A32_SFLOAT, std::mem::offset_of!(Vertex, light)),
    attribute(4, vk::Format::R32G32B32A32_SFLOAT, std::mem::offset_of!(Vertex, around)),
];
/// The input of `depth.vert`.
pub const POSITIONS: [Attribute; 1] = [VERTICES[0]];

pub struct Geometry {
    vertices: Data,
    indices: Data,
    /// Number of all indices.
    pub count: u32,
    /// Number of indices of the meshes that cast shadows; they come first.
    pub casters: u32,
}

impl Geometry {
    pub fn new(gpu: &Gpu, scene: &Scene, baked: &Baked) -> Result<Self, Error> {
        use vk::BufferUsageFlags as Usage;
        let placed = baked.placed(scene);
        let (vertices, indices) =
            (bytemuck::cast_slice(&placed), bytemuck::cast_slice(&baked.indices));
        Ok(Self {
            vertices: Data::new(gpu, "scene/vertices", vertices, Usage::VERTEX_BUFFER)?,
            indices: Data::new(gpu, "scene/indices", indices, Usage::INDEX_BUFFER)?,
            count: baked.indices.len() as u32,
            casters: {
                let meshes = baked.batches.iter().filter(|b| matches!(b.part, Part::Mesh(_)));
                meshes.map(|b| b.count).sum()
            },
        })
    }

    /// Copies both buffers to the device.
    pub fn record_upload(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        self.vertices.record_upload(gpu, cmd);
        self.indices.record_upload(gpu, cmd);
        let uploaded = |data: &Data| access::buffer(data.buffer.handle, COPY_WRITE, VERTEX_INPUT);
        gpu.barriers(cmd, &[], &[uploaded(&self.vertices), uploaded(&self.indices)]);
    }

    /// Drops the staging buffers.
    pub fn uploaded(&mut self) {
        (self.vertices.staging, self.indices.staging) = (None, None);
    }

    pub fn bind(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        let (vertices, indices) = (self.vertices.buffer.handle, self.indices.buffer.handle);
        // SAFETY: cmd is recording; the buffers live as long as self.
        unsafe {
            gpu.device.cmd_bind_vertex_buffers(cmd, 0, &[vertices], &[0]);
            gpu.device.cmd_bind_index_buffer(cmd, indices, 0, vk::IndexType::UINT32);
        }
    }
}

/// A device buffer and the mapped buffer that it is filled from, which is `None` without content and after the
/// upload.
struct Data {
    buffer: Buffer,
    staging: Option<Buffer>,
    bytes: u64,
}

impl Data {
    fn new(
        gpu: &Gpu,
        name: &str,
        contents: &[u8],
        usage: vk::BufferUsageFlags,
    ) -> Result<Self, Error> {
        let bytes = contents.len() as u64;
        let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
        Ok(Self {
            buffer: Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)?,
            staging: if bytes > 0 { Some(staging(gpu, contents)?) } else { None },
            bytes,
        })
    }

    fn record_upload(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        let Some(staging) = &self.staging else { return };
        let region = [vk::BufferCopy::default().size(self.bytes)];
        // SAFETY: cmd is recording; both buffers have room for the region.
        unsafe { gpu.device.cmd_copy_buffer(cmd, staging.handle, self.buffer.handle, &region) };
    }
}
