//! A buffer and its memory.

use ash::vk;

use super::Gpu;
use super::graveyard::{Grave, Graveyard};
use super::memory::{self, Memory, MemoryLocation, MemoryRequest};
use crate::error::{Error, VkContext};

/// A buffer with its memory.
pub struct Buffer {
    /// The buffer.
    pub handle: vk::Buffer,
    /// Bytes of its memory: at least the requested size.
    pub size: u64,
    /// `Some` until drop.
    memory: Option<Memory>,
    yard: Graveyard,
}

impl Buffer {
    /// Creates a buffer. `CpuToGpu` and `GpuToCpu` are persistently mapped and coherent.
    pub fn new(
        gpu: &Gpu,
        name: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Self, Error> {
        if size > gpu.max_buffer_size {
            return Err(Error::Missing {
                what: format!("a buffer of {size} bytes, for {name}"),
                why: format!(
                    "the device's limit is {} bytes; choose fewer particles or a smaller extent",
                    gpu.max_buffer_size
                ),
            });
        }
        let info = vk::BufferCreateInfo::default().size(size.max(4)).usage(usage);
        // SAFETY: valid create info.
        let handle = unsafe { gpu.device.create_buffer(&info, None) }
            .context(|| format!("vkCreateBuffer {name}"))?;
        // SAFETY: the handle was just created.
        let requirements = unsafe { gpu.device.get_buffer_memory_requirements(handle) };
        let request = MemoryRequest { name, requirements, location, linear: true };
        let memory = match memory::allocate(gpu.allocator(), &request) {
            Ok(memory) => memory,
            Err(error) => {
                // SAFETY: nothing uses the buffer yet.
                unsafe { gpu.device.destroy_buffer(handle, None) };
                return Err(error);
            }
        };
        let (place, offset) = (memory.memory(), memory.offset());
        let yard = gpu.graveyard.clone();
        let buffer = Self { handle, size: requirements.size, memory: Some(memory), yard };
        // SAFETY: the memory meets the buffer's requirements and is bound once.
        let bound = unsafe { gpu.device.bind_buffer_memory(handle, place, offset) };
        bound.context(|| format!("vkBindBufferMemory {name}"))?;
        gpu.name(handle, name);
        Ok(buffer)
    }

    /// Bytes of a mapped buffer; empty for one that is not mapped.
    #[cfg(feature = "headless")]
    pub fn mapped(&self) -> &[u8] {
        match self.memory.as_ref().and_then(Memory::mapped) {
            // SAFETY: this number of bytes is mapped and belongs to this buffer.
            Some(from) => unsafe { std::slice::from_raw_parts(from.as_ptr(), self.size as usize) },
            None => &[],
        }
    }

    /// Writable bytes of a mapped buffer; empty for one that is not mapped.
    pub fn mapped_mut(&mut self) -> &mut [u8] {
        match self.memory.as_ref().and_then(Memory::mapped) {
            // SAFETY: this number of bytes is mapped and belongs to this buffer.
            Some(to) => unsafe { std::slice::from_raw_parts_mut(to.as_ptr(), self.size as usize) },
            None => &mut [],
        }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        let memory = self.memory.take();
        self.yard.push(Grave::Buffer(self.handle, memory));
    }
}
