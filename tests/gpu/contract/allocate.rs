//! An allocator from the host that calls `vkAllocateMemory` once per object, as in the simplest
//! engine.

use std::collections::HashMap;
use std::error::Error as AnyError;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use ash::vk;
use whitewater::water::Kernels;
use whitewater::{
    Allocate, Config, Error, Memory, MemoryLocation, MemoryRequest, WhitewaterConfig,
};

use super::water;
use crate::invariants::same_drawn;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, config, extent};
use crate::support::scenes::Lens;

/// An allocator that gives each object its own memory.
struct Dedicated {
    device: ash::Device,
    types: vk::PhysicalDeviceMemoryProperties,
    /// Names of the live objects, by the number in their memory's owner.
    alive: Mutex<HashMap<u64, String>>,
    made: AtomicU64,
    /// Refuses objects whose name begins with this.
    refused: Option<&'static str>,
}

/// The owner of a [`Memory`]: the object's number.
struct Number(u64);

impl Dedicated {
    fn new(gpu: &Gpu, refused: Option<&'static str>) -> Arc<Self> {
        // SAFETY: the handles are live.
        let types = unsafe { gpu.instance.get_physical_device_memory_properties(gpu.physical) };
        let device = gpu.functions.clone();
        Arc::new(Self { device, types, alive: Mutex::default(), made: AtomicU64::new(0), refused })
    }

    fn alive(&self) -> Vec<String> {
        self.alive.lock().unwrap().values().cloned().collect()
    }
}

// SAFETY: each object has its own VkDeviceMemory, of a type that it allows; host-visible memory is
// mapped and coherent.
unsafe impl Allocate for Dedicated {
    fn allocate(
        &self,
        request: &MemoryRequest<'_>,
    ) -> Result<Memory, Box<dyn AnyError + Send + Sync>> {
        if self.refused.is_some_and(|name| request.name.starts_with(name)) {
            return Err("refused by the test".into());
        }
        let mapped = request.location != MemoryLocation::GpuOnly;
        let wanted = match mapped {
            true => vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT,
            false => vk::MemoryPropertyFlags::DEVICE_LOCAL,
        };
        let index = self.types.memory_types_as_slice().iter().enumerate().find(|(i, kind)| {
            request.requirements.memory_type_bits & (1 << i) != 0
                && kind.property_flags.contains(wanted)
        });
        let (index, _) = index.ok_or("no memory type")?;
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(request.requirements.size)
            .memory_type_index(index as u32);
        // SAFETY: the allocation is valid, and the memory is mapped once and stays mapped.
        let (memory, pointer) = unsafe {
            let memory = self.device.allocate_memory(&info, None)?;
            let all = vk::WHOLE_SIZE;
            let flags = vk::MemoryMapFlags::empty();
            let map = || self.device.map_memory(memory, 0, all, flags);
            (memory, mapped.then(map).transpose()?)
        };
        let number = self.made.fetch_add(1, Ordering::Relaxed);
        self.alive.lock().unwrap().insert(number, request.name.into());
        Ok(Memory::new(memory, 0, pointer.and_then(|p| NonNull::new(p.cast())), Number(number)))
    }

    unsafe fn free(&self, memory: Memory) {
        let handle = memory.memory();
        let Number(number) = memory.into_owner().expect("of this allocator");
        self.alive.lock().unwrap().remove(&number).expect("freed once");
        // SAFETY: the caller promises that the memory is unused; freeing it also unmaps it.
        unsafe { self.device.free_memory(handle, None) };
    }
}

fn everything(size: vk::Extent2D) -> Config {
    config(size).with(|it| {
        it.kernels = Kernels::Ellipsoids;
        it.spray = true;
        it.whitewater = Some(WhitewaterConfig::new(64));
        it.motion = true;
    })
}

fn draw(gpu: &Gpu, size: vk::Extent2D) -> [Drawn; 2] {
    let mut rig = Rig::lit(gpu, &everything(size), 2);
    let first = rig.draw(&water(size, Lens::ReversedInfinite));
    let half = extent(size.width / 2, size.height / 2);
    rig.resize(half);
    [first, rig.draw(&water(half, Lens::ReversedInfinite))]
}

/// All memory comes from the host's allocator and goes back to it, and the pictures do not change.
#[test]
fn an_allocator_of_the_hosts_draws_the_same_bits() {
    let size = extent(65, 43);
    let expected = draw(&Gpu::own(), size);
    let mut gpu = Gpu::own();
    let own = Dedicated::new(&gpu, None);
    gpu.other_allocator = Some(own.clone());
    let found = draw(&gpu, size);
    for (found, expected) in found.iter().zip(&expected) {
        same_drawn("a host's allocator", found, expected);
    }
    assert!(own.made.load(Ordering::Relaxed) > 50, "all memory is asked of it");
    assert_eq!(own.alive(), Vec::<String>::new(), "all memory goes back to it");
    assert_eq!(gpu.allocations(), Vec::<String>::new(), "none is of another");
}

/// The error contains the allocator's message and the object's name; memory allocated before goes
/// back.
#[test]
fn what_an_allocator_refuses_is_named() {
    let mut gpu = Gpu::own();
    let own = Dedicated::new(&gpu, Some("water/thickness"));
    gpu.other_allocator = Some(own.clone());
    let error = Rig::try_new(&gpu, &everything(extent(65, 43)), 1).err().expect("refused");
    assert!(matches!(&error, Error::Allocation { .. }), "{error:?}");
    let text = error.to_string();
    assert!(text.contains("water/thickness") && text.contains("refused by the test"), "{text}");
    assert_eq!(own.alive(), Vec::<String>::new());
}
