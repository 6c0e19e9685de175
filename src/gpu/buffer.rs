//! An own buffer.

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use super::Gpu;
use super::graveyard::{Grave, Graveyard};
use crate::error::{Error, VkContext};

/// A buffer with its memory.
pub struct Buffer {
    /// The buffer.
    pub handle: vk::Buffer,
    /// Bytes asked for.
    pub size: u64,
    allocation: Allocation,
    yard: Graveyard,
}

impl Buffer {
    /// Makes a buffer. `CpuToGpu` and `GpuToCpu` are mapped for good, and coherent.
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
                    "the device makes them of {} at most: fewer particles, or a smaller extent",
                    gpu.max_buffer_size
                ),
            });
        }
        let info = vk::BufferCreateInfo::default().size(size.max(4)).usage(usage);
        // SAFETY: valid create info.
        let handle = unsafe { gpu.device.create_buffer(&info, None) }
            .context(|| format!("vkCreateBuffer {name}"))?;
        // SAFETY: handle was just made.
        let requirements = unsafe { gpu.device.get_buffer_memory_requirements(handle) };
        let allocation = gpu.lock_allocator().allocate(&AllocationCreateDesc {
            name,
            requirements,
            location,
            linear: true,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        });
        let allocation = match allocation {
            Ok(allocation) => allocation,
            Err(source) => {
                // SAFETY: nothing uses the buffer yet.
                unsafe { gpu.device.destroy_buffer(handle, None) };
                return Err(Error::Allocation { name: name.into(), source });
            }
        };
        let yard = gpu.graveyard.clone();
        let buffer = Self { handle, size: requirements.size, allocation, yard };
        // SAFETY: the allocation meets the buffer's requirements and is bound once.
        let bound = unsafe {
            gpu.device.bind_buffer_memory(
                handle,
                buffer.allocation.memory(),
                buffer.allocation.offset(),
            )
        };
        bound.context(|| format!("vkBindBufferMemory {name}"))?;
        gpu.name(handle, name);
        Ok(buffer)
    }

    /// Bytes of a mapped buffer; empty for one that is not mapped.
    #[cfg(feature = "headless")]
    pub fn mapped(&self) -> &[u8] {
        self.allocation.mapped_slice().unwrap_or_default()
    }

    /// Writable bytes of a mapped buffer; empty for one that is not mapped.
    pub fn mapped_mut(&mut self) -> &mut [u8] {
        self.allocation.mapped_slice_mut().unwrap_or_default()
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        let memory = std::mem::take(&mut self.allocation);
        self.yard.push(Grave::Buffer(self.handle, memory));
    }
}
