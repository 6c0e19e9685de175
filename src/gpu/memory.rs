//! Device memory: what the library asks an allocator for, the host's or the built-in one.

use std::any::Any;
use std::ptr::NonNull;
use std::sync::{Mutex, PoisonError};

use ash::vk;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator};

use crate::error::Error;

/// Where memory lies and who touches it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryLocation {
    /// Device-local, never mapped.
    GpuOnly,
    /// Written by the CPU and read by the GPU: mapped for good, host-coherent, device-local where there is such.
    CpuToGpu,
    /// Written by the GPU and read by the CPU: mapped for good, host-coherent, cached where there is such.
    GpuToCpu,
}

/// What an image or a buffer needs.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct MemoryRequest<'a> {
    /// The object's name, as in debuggers.
    pub name: &'a str,
    /// Size, alignment and memory types.
    pub requirements: vk::MemoryRequirements,
    /// Where.
    pub location: MemoryLocation,
    /// True for buffers, false for images with optimal tiling: of the two kinds in one VkDeviceMemory the allocator keeps
    /// the device's `bufferImageGranularity`.
    pub linear: bool,
}

/// A piece of device memory for one object.
#[derive(Debug)]
pub struct Memory {
    memory: vk::DeviceMemory,
    offset: u64,
    mapped: Option<NonNull<u8>>,
    owner: Box<dyn Any + Send + Sync>,
}

// SAFETY: the mapped bytes are the object's that owns the memory, which reads and writes them by its own borrow.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Memory {
    /// From `offset` bytes of `memory` on; `mapped` points at these bytes, for the locations that are mapped. `owner` is the
    /// allocator's own handle, which it gets back in [`Allocate::free`] by [`into_owner`](Self::into_owner).
    pub fn new(
        memory: vk::DeviceMemory,
        offset: u64,
        mapped: Option<NonNull<u8>>,
        owner: impl Any + Send + Sync,
    ) -> Self {
        Self { memory, offset, mapped, owner: Box::new(owner) }
    }

    /// The allocator's own handle; `None` where it is of another type.
    pub fn into_owner<T: Any>(self) -> Option<T> {
        self.owner.downcast().ok().map(|owner| *owner)
    }

    /// The memory.
    pub fn memory(&self) -> vk::DeviceMemory {
        self.memory
    }

    /// Where in it, bytes.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// The mapped bytes.
    pub(crate) fn mapped(&self) -> Option<NonNull<u8>> {
        self.mapped
    }
}

/// An allocator of device memory, shared by all that is made from a [`Context`](crate::Context): the host's, in a few lines
/// round whatever it has (VMA, its own, `gpu_allocator` of any version), by
/// [`Host::with_allocator`](crate::Host::with_allocator).
///
/// Without one the context makes a `gpu_allocator` of its own. A `Mutex<gpu_allocator::vulkan::Allocator>` of the version
/// that this crate has ([`crate::gpu_allocator`]) is one too: hand in an `Arc` of it.
///
/// Called in construction, `reconfigure`, `resize`, `collect` and `destroy` alone, from the thread that calls these.
///
/// # Safety
/// The memory is of the device, of a type and size and at an alignment as asked for, overlaps no other, and stays until
/// [`free`](Self::free); it is mapped for good and coherent where the location says so.
pub unsafe trait Allocate: Send + Sync {
    /// Memory for one object.
    ///
    /// # Errors
    /// Any, [`Error::Allocation`] then brings it with the object's name.
    fn allocate(
        &self,
        request: &MemoryRequest<'_>,
    ) -> Result<Memory, Box<dyn std::error::Error + Send + Sync>>;

    /// Takes it back.
    ///
    /// # Safety
    /// It came from `allocate` of this allocator; what was bound to it is destroyed.
    unsafe fn free(&self, memory: Memory);
}

// SAFETY: as `gpu_allocator` keeps it.
unsafe impl Allocate for Mutex<Allocator> {
    fn allocate(
        &self,
        request: &MemoryRequest<'_>,
    ) -> Result<Memory, Box<dyn std::error::Error + Send + Sync>> {
        // A poisoned lock is taken all the same: the allocator's own state is not ours to judge.
        let mut allocator = self.lock().unwrap_or_else(PoisonError::into_inner);
        let own = allocator.allocate(&AllocationCreateDesc {
            name: request.name,
            requirements: request.requirements,
            location: match request.location {
                MemoryLocation::GpuOnly => gpu_allocator::MemoryLocation::GpuOnly,
                MemoryLocation::CpuToGpu => gpu_allocator::MemoryLocation::CpuToGpu,
                MemoryLocation::GpuToCpu => gpu_allocator::MemoryLocation::GpuToCpu,
            },
            linear: request.linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        })?;
        // SAFETY: bound once, by the object that asks; it goes back by `free` alone.
        let (memory, offset) = (unsafe { own.memory() }, own.offset());
        let mapped = own.mapped_ptr().map(NonNull::cast);
        Ok(Memory::new(memory, offset, mapped, own))
    }

    unsafe fn free(&self, memory: Memory) {
        if let Some(own) = memory.into_owner::<Allocation>() {
            // The only failure is a broken allocator; the memory then stays with it.
            let _ = self.lock().unwrap_or_else(PoisonError::into_inner).free(own);
        }
    }
}

/// Memory for an object, or the error with its name.
pub fn allocate(from: &dyn Allocate, request: &MemoryRequest<'_>) -> Result<Memory, Error> {
    let name = request.name;
    from.allocate(request).map_err(|source| Error::Allocation { name: name.into(), source })
}
