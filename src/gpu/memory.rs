//! Device memory: the interface to the host's allocator, and the built-in one.

use std::any::Any;
use std::ptr::NonNull;
use std::sync::{Mutex, PoisonError};

use ash::vk;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator};

use crate::error::Error;

/// Where memory lies, and who accesses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryLocation {
    /// Device-local, never mapped.
    GpuOnly,
    /// Written by the CPU and read by the GPU: persistently mapped, host-coherent, and device-local if possible.
    CpuToGpu,
    /// Written by the GPU and read by the CPU: persistently mapped, host-coherent, and cached if possible.
    GpuToCpu,
}

/// Memory that an image or a buffer needs.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct MemoryRequest<'a> {
    /// Name of the object, as in debuggers.
    pub name: &'a str,
    /// Size, alignment and memory types.
    pub requirements: vk::MemoryRequirements,
    /// Location.
    pub location: MemoryLocation,
    /// True for buffers, false for images with optimal tiling. If the allocator puts both in one VkDeviceMemory
    /// it must keep the device's `bufferImageGranularity` between them.
    pub linear: bool,
}

/// A range of device memory for one object.
#[derive(Debug)]
pub struct Memory {
    memory: vk::DeviceMemory,
    offset: u64,
    mapped: Option<NonNull<u8>>,
    owner: Box<dyn Any + Send + Sync>,
}

// SAFETY: the mapped bytes belong to the object that owns the memory; it reads and writes them under its own borrow.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Memory {
    /// A range that begins `offset` bytes into `memory`. `mapped` points to its bytes, for locations that are
    /// mapped. `owner` is the allocator's own handle, which [`Allocate::free`] gets back from
    /// [`into_owner`](Self::into_owner).
    pub fn new(
        memory: vk::DeviceMemory,
        offset: u64,
        mapped: Option<NonNull<u8>>,
        owner: impl Any + Send + Sync,
    ) -> Self {
        Self { memory, offset, mapped, owner: Box::new(owner) }
    }

    /// The allocator's own handle; `None` if it has another type.
    pub fn into_owner<T: Any>(self) -> Option<T> {
        self.owner.downcast().ok().map(|owner| *owner)
    }

    /// The memory.
    pub fn memory(&self) -> vk::DeviceMemory {
        self.memory
    }

    /// Offset in bytes.
    pub fn offset(&self) -> u64 {
        self.offset
    }

    /// The mapped bytes.
    pub(crate) fn mapped(&self) -> Option<NonNull<u8>> {
        self.mapped
    }
}

/// An allocator of device memory, shared by everything created from a [`Context`](crate::Context). A host
/// implements it in a few lines around the allocator that it has (VMA, its own, any version of `gpu_allocator`)
/// and sets it with [`Host::with_allocator`](crate::Host::with_allocator).
///
/// Without an allocator from the host, the context creates a `gpu_allocator` of its own. A host can also hand in an
/// `Arc` of a `Mutex<gpu_allocator::vulkan::Allocator>`, of the version re-exported as `whitewater::gpu_allocator`,
/// which implements this trait.
///
/// The allocator is called only in construction, `reconfigure`, `resize`, `collect` and `destroy` of what a context
/// makes, from the thread that calls these.
///
/// # Safety
/// Memory from [`allocate`](Self::allocate) belongs to the device, has the requested type, size and alignment,
/// overlaps no other memory, and stays until [`free`](Self::free). It is persistently mapped and coherent if the
/// location says so.
pub unsafe trait Allocate: Send + Sync {
    /// Allocates memory for one object.
    ///
    /// # Errors
    /// Any error. It is returned inside [`Error::Allocation`] with the object's name.
    fn allocate(
        &self,
        request: &MemoryRequest<'_>,
    ) -> Result<Memory, Box<dyn std::error::Error + Send + Sync>>;

    /// Frees memory.
    ///
    /// # Safety
    /// `memory` comes from `allocate` of this allocator, and all objects bound to it have been destroyed.
    unsafe fn free(&self, memory: Memory);
}

// SAFETY: guaranteed by `gpu_allocator`.
unsafe impl Allocate for Mutex<Allocator> {
    fn allocate(
        &self,
        request: &MemoryRequest<'_>,
    ) -> Result<Memory, Box<dyn std::error::Error + Send + Sync>> {
        // A poisoned lock is accepted, because the allocator keeps its own state consistent.
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
        // SAFETY: bound once, by the requesting object; it is freed only with `free`.
        let (memory, offset) = (unsafe { own.memory() }, own.offset());
        let mapped = own.mapped_ptr().map(NonNull::cast);
        Ok(Memory::new(memory, offset, mapped, own))
    }

    unsafe fn free(&self, memory: Memory) {
        if let Some(own) = memory.into_owner::<Allocation>() {
            // This only fails with a damaged allocator, which then keeps the memory.
            let _ = self.lock().unwrap_or_else(PoisonError::into_inner).free(own);
        }
    }
}

/// Allocates memory for an object; an error contains the object's name.
pub fn allocate(from: &dyn Allocate, request: &MemoryRequest<'_>) -> Result<Memory, Error> {
    let name = request.name;
    from.allocate(request).map_err(|source| Error::Allocation { name: name.into(), source })
}
