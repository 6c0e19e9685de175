//! A spy in the device's function table. It counts calls, tracks created and destroyed objects, and
//! lets a call fail. It also records the order in which commands use buffers, and can drop a
//! barrier. Only one test uses it at a time.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicI32, AtomicI64, AtomicPtr, AtomicU32, AtomicU64, Ordering::SeqCst};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::vk::{self, Handle};

use super::device::Gpu;

/// State of one function.
pub struct Function {
    pub name: &'static CStr,
    real: AtomicPtr<c_void>,
    calls: AtomicU32,
    /// Number of calls until it fails; 0: it does not.
    fails_in: AtomicU32,
    result: AtomicI32,
    /// Objects that it created, minus those that its counterpart destroyed.
    live: AtomicI64,
}

impl Function {
    const fn new(name: &'static CStr) -> Self {
        Self {
            name,
            real: AtomicPtr::new(std::ptr::null_mut()),
            calls: AtomicU32::new(0),
            fails_in: AtomicU32::new(0),
            result: AtomicI32::new(0),
            live: AtomicI64::new(0),
        }
    }

    /// Calls since the last reset.
    pub fn calls(&self) -> u32 {
        self.calls.load(SeqCst)
    }

    /// Lets the `nth` call from now on fail once (1 is the next).
    pub fn fail(&self, nth: u32, result: vk::Result) {
        self.result.store(result.as_raw(), SeqCst);
        self.fails_in.store(nth, SeqCst);
    }

    /// Whether the requested failure has not happened yet.
    pub fn pending(&self) -> bool {
        self.fails_in.load(SeqCst) > 0
    }

    fn called(&self) -> Option<vk::Result> {
        self.calls.fetch_add(1, SeqCst);
        let left = self.fails_in.load(SeqCst);
        if left == 0 {
            return None;
        }
        self.fails_in.store(left - 1, SeqCst);
        (left == 1).then(|| vk::Result::from_raw(self.result.load(SeqCst)))
    }
}

/// Stand-ins of the functions that return a result. `made` is the number of objects that a
/// successful call creates.
macro_rules! spied {
    ($(
        $id:ident $name:literal ($($arg:ident: $type:ty),*) made $made:expr $(, notes $note:expr)?;
    )*) => {
        $(
            pub static $id: Function = Function::new($name);
        )*
        mod stand_in {
            use super::*;
            $(
                #[allow(non_snake_case)] // named as Vulkan names them
                pub unsafe extern "system" fn $id($($arg: $type),*) -> vk::Result {
                    if let Some(result) = super::$id.called() {
                        return result;
                    }
                    $($note;)?
                    // SAFETY: the pointer is the driver's function of this signature.
                    let result = unsafe {
                        let real: unsafe extern "system" fn($($type),*) -> vk::Result =
                            std::mem::transmute(super::$id.real.load(SeqCst));
                        real($($arg),*)
                    };
                    if result == vk::Result::SUCCESS {
                        super::$id.live.fetch_add(i64::from($made), SeqCst);
                    }
                    result
                }
            )*
        }
        const WITH_RESULT: &[(&Function, *const c_void)] =
            &[$((&$id, stand_in::$id as *const c_void)),*];
    };
}

type P = *const c_void;

spied! {
    QUEUE_SUBMIT c"vkQueueSubmit" (q: vk::Queue, n: u32, s: P, f: u64) made 0;
    QUEUE_SUBMIT2 c"vkQueueSubmit2" (q: vk::Queue, n: u32, s: P, f: u64) made 0;
    QUEUE_WAIT_IDLE c"vkQueueWaitIdle" (q: vk::Queue) made 0;
    DEVICE_WAIT_IDLE c"vkDeviceWaitIdle" (d: vk::Device) made 0;
    WAIT_FOR_FENCES c"vkWaitForFences" (d: vk::Device, n: u32, f: P, all: u32, t: u64) made 0;
    WAIT_SEMAPHORES c"vkWaitSemaphores" (d: vk::Device, i: P, t: u64) made 0;
    ALLOCATE_MEMORY c"vkAllocateMemory" (d: vk::Device, i: P, a: P, o: P) made 1;
    MAP_MEMORY c"vkMapMemory" (d: vk::Device, m: u64, o: u64, s: u64, f: u32, p: P) made 0;
    BIND_BUFFER_MEMORY c"vkBindBufferMemory" (d: vk::Device, b: u64, m: u64, o: u64) made 0;
    BIND_IMAGE_MEMORY c"vkBindImageMemory" (d: vk::Device, b: u64, m: u64, o: u64) made 0;
    CREATE_IMAGE_VIEW c"vkCreateImageView" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_SAMPLER c"vkCreateSampler" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_SHADER_MODULE c"vkCreateShaderModule" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_SET_LAYOUT c"vkCreateDescriptorSetLayout" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_PIPELINE_LAYOUT c"vkCreatePipelineLayout" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_RENDER_PASS c"vkCreateRenderPass" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_FRAMEBUFFER c"vkCreateFramebuffer" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_COMMAND_POOL c"vkCreateCommandPool" (d: vk::Device, i: P, a: P, o: P) made 1;
    ALLOCATE_COMMAND_BUFFERS c"vkAllocateCommandBuffers" (d: vk::Device, i: P, o: P) made 0;
    CREATE_FENCE c"vkCreateFence" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_QUERY_POOL c"vkCreateQueryPool" (d: vk::Device, i: P, a: P, o: P) made 1;
    CREATE_GRAPHICS_PIPELINES c"vkCreateGraphicsPipelines"
        (d: vk::Device, c: u64, n: u32, i: P, a: P, o: P) made n as i32;
    CREATE_COMPUTE_PIPELINES c"vkCreateComputePipelines"
        (d: vk::Device, c: u64, n: u32, i: P, a: P, o: P) made n as i32;
    ALLOCATE_SETS c"vkAllocateDescriptorSets" (d: vk::Device, i: P, o: P) made 0;
    RESET_DESCRIPTOR_POOL c"vkResetDescriptorPool" (d: vk::Device, p: u64, f: u32) made 0,
        notes held(&SETS).clear();
}

/// Commands, which return nothing, and functions that destroy.
macro_rules! spied_void {
    ($(
        $id:ident $name:literal ($($arg:ident: $type:ty),*)
        $(undoes $maker:ident if $alive:ident)? $(notes $note:expr)?;
    )*) => {
        $(
            pub static $id: Function = Function::new($name);
        )*
        mod stand_in_void {
            use super::*;
            $(
                #[allow(non_snake_case)] // named as Vulkan names them
                pub unsafe extern "system" fn $id($($arg: $type),*) {
                    super::$id.called();
                    $(
                        if $alive != 0 {
                            super::$maker.live.fetch_sub(1, SeqCst);
                        }
                    )?
                    $($note;)?
                    // SAFETY: the pointer is the driver's function of this signature.
                    unsafe {
                        let real: unsafe extern "system" fn($($type),*) =
                            std::mem::transmute(super::$id.real.load(SeqCst));
                        real($($arg),*)
                    }
                }
            )*
        }
        const WITHOUT_RESULT: &[(&Function, *const c_void)] =
            &[$((&$id, stand_in_void::$id as *const c_void)),*];
    };
}

spied_void! {
    CMD_BIND_PIPELINE c"vkCmdBindPipeline" (c: vk::CommandBuffer, b: i32, p: u64);
    CMD_BIND_SETS c"vkCmdBindDescriptorSets"
        (c: vk::CommandBuffer, p: i32, l: u64, f: u32, n: u32, s: P, m: u32, d: P)
        notes bind(p, n, s);
    CMD_FILL c"vkCmdFillBuffer" (c: vk::CommandBuffer, b: u64, o: u64, s: u64, v: u32)
        notes use_of(b, By::Transfer);
    CMD_UPDATE c"vkCmdUpdateBuffer" (c: vk::CommandBuffer, b: u64, o: u64, s: u64, d: P)
        notes use_of(b, By::Transfer);
    CMD_DISPATCH c"vkCmdDispatch" (c: vk::CommandBuffer, x: u32, y: u32, z: u32)
        notes use_bound(By::Compute);
    CMD_DISPATCH_INDIRECT c"vkCmdDispatchIndirect" (c: vk::CommandBuffer, b: u64, o: u64)
        notes (use_bound(By::Compute), use_of(b, By::Indirect));
    CMD_DRAW_INDIRECT c"vkCmdDrawIndirect" (c: vk::CommandBuffer, b: u64, o: u64, n: u32, s: u32)
        notes (use_bound(By::Graphics), use_of(b, By::Indirect));
    CMD_BEGIN_PASS c"vkCmdBeginRenderPass" (c: vk::CommandBuffer, i: P, s: i32);
    CMD_RESET_QUERIES c"vkCmdResetQueryPool" (c: vk::CommandBuffer, p: u64, f: u32, n: u32);
    CMD_TIMESTAMP c"vkCmdWriteTimestamp2" (c: vk::CommandBuffer, s: u64, p: u64, q: u32);
    FREE_MEMORY c"vkFreeMemory" (d: vk::Device, h: u64, a: P) undoes ALLOCATE_MEMORY if h;
    DESTROY_BUFFER c"vkDestroyBuffer" (d: vk::Device, h: u64, a: P) undoes CREATE_BUFFER if h;
    DESTROY_IMAGE c"vkDestroyImage" (d: vk::Device, h: u64, a: P) undoes CREATE_IMAGE if h;
    DESTROY_IMAGE_VIEW c"vkDestroyImageView" (d: vk::Device, h: u64, a: P)
        undoes CREATE_IMAGE_VIEW if h;
    DESTROY_SAMPLER c"vkDestroySampler" (d: vk::Device, h: u64, a: P) undoes CREATE_SAMPLER if h;
    DESTROY_SHADER_MODULE c"vkDestroyShaderModule" (d: vk::Device, h: u64, a: P)
        undoes CREATE_SHADER_MODULE if h;
    DESTROY_DESCRIPTOR_POOL c"vkDestroyDescriptorPool" (d: vk::Device, h: u64, a: P)
        undoes CREATE_DESCRIPTOR_POOL if h;
    DESTROY_SET_LAYOUT c"vkDestroyDescriptorSetLayout" (d: vk::Device, h: u64, a: P)
        undoes CREATE_SET_LAYOUT if h;
    DESTROY_PIPELINE_LAYOUT c"vkDestroyPipelineLayout" (d: vk::Device, h: u64, a: P)
        undoes CREATE_PIPELINE_LAYOUT if h;
    DESTROY_RENDER_PASS c"vkDestroyRenderPass" (d: vk::Device, h: u64, a: P)
        undoes CREATE_RENDER_PASS if h;
    DESTROY_FRAMEBUFFER c"vkDestroyFramebuffer" (d: vk::Device, h: u64, a: P)
        undoes CREATE_FRAMEBUFFER if h;
    DESTROY_COMMAND_POOL c"vkDestroyCommandPool" (d: vk::Device, h: u64, a: P)
        undoes CREATE_COMMAND_POOL if h;
    DESTROY_FENCE c"vkDestroyFence" (d: vk::Device, h: u64, a: P) undoes CREATE_FENCE if h;
    DESTROY_QUERY_POOL c"vkDestroyQueryPool" (d: vk::Device, h: u64, a: P)
        undoes CREATE_QUERY_POOL if h;
    // Compute pipelines are counted together with graphics pipelines.
    DESTROY_PIPELINE c"vkDestroyPipeline" (d: vk::Device, h: u64, a: P)
        undoes CREATE_GRAPHICS_PIPELINES if h;
}

/// Functions that wait, submit, allocate or compile, which recording must not call.
pub static NOT_IN_A_RECORD: [&Function; 12] = [
    &QUEUE_SUBMIT,
    &QUEUE_SUBMIT2,
    &QUEUE_WAIT_IDLE,
    &DEVICE_WAIT_IDLE,
    &WAIT_FOR_FENCES,
    &WAIT_SEMAPHORES,
    &ALLOCATE_MEMORY,
    &MAP_MEMORY,
    &CREATE_SHADER_MODULE,
    &CREATE_GRAPHICS_PIPELINES,
    &CREATE_COMPUTE_PIPELINES,
    &FREE_MEMORY,
];

/// Functions that create objects and can fail.
pub static MAKERS: [&Function; 19] = [
    &ALLOCATE_MEMORY,
    &BIND_BUFFER_MEMORY,
    &BIND_IMAGE_MEMORY,
    &CREATE_BUFFER,
    &CREATE_IMAGE,
    &CREATE_IMAGE_VIEW,
    &CREATE_SAMPLER,
    &CREATE_SHADER_MODULE,
    &CREATE_DESCRIPTOR_POOL,
    &CREATE_SET_LAYOUT,
    &CREATE_PIPELINE_LAYOUT,
    &CREATE_RENDER_PASS,
    &CREATE_FRAMEBUFFER,
    &CREATE_COMMAND_POOL,
    &ALLOCATE_COMMAND_BUFFERS,
    &CREATE_FENCE,
    &CREATE_QUERY_POOL,
    &CREATE_GRAPHICS_PIPELINES,
    &CREATE_COMPUTE_PIPELINES,
];

/// The commands that the spy counts.
pub static COMMANDS: [&Function; 8] = [
    &CMD_BARRIER,
    &CMD_BIND_PIPELINE,
    &CMD_DISPATCH,
    &CMD_DISPATCH_INDIRECT,
    &CMD_DRAW_INDIRECT,
    &CMD_BEGIN_PASS,
    &CMD_RESET_QUERIES,
    &CMD_TIMESTAMP,
];

/// Written by hand, because it stores the capacity of the pool.
pub static CREATE_DESCRIPTOR_POOL: Function = Function::new(c"vkCreateDescriptorPool");
/// Capacity of the last pool, in sets.
pub static MAX_SETS: AtomicU32 = AtomicU32::new(0);

unsafe extern "system" fn create_descriptor_pool(d: vk::Device, i: P, a: P, o: P) -> vk::Result {
    if let Some(result) = CREATE_DESCRIPTOR_POOL.called() {
        return result;
    }
    // SAFETY: the driver's function, with a valid create info.
    let result = unsafe {
        let info = &*i.cast::<vk::DescriptorPoolCreateInfo<'_>>();
        MAX_SETS.store(info.max_sets, SeqCst);
        let real: unsafe extern "system" fn(vk::Device, P, P, P) -> vk::Result =
            std::mem::transmute(CREATE_DESCRIPTOR_POOL.real.load(SeqCst));
        real(d, i, a, o)
    };
    CREATE_DESCRIPTOR_POOL.live.fetch_add(i64::from(result == vk::Result::SUCCESS), SeqCst);
    result
}

/// The kind of command that uses a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum By {
    /// A fill or an update.
    Transfer,
    /// A dispatch whose descriptor set contains it.
    Compute,
    /// An indirect draw whose descriptor set contains it.
    Graphics,
    /// A draw or a dispatch that reads its arguments from it.
    Indirect,
}

/// A use of a buffer by a command, or a barrier.
#[derive(Clone, Copy, Debug)]
pub enum Event {
    Use {
        buffer: vk::Buffer,
        by: By,
    },
    /// A barrier for one buffer, or for all if none is given.
    Barrier {
        buffer: Option<vk::Buffer>,
        before: Scope,
        after: Scope,
    },
}

/// Stages and accesses of a barrier.
pub type Scope = (vk::PipelineStageFlags2, vk::AccessFlags2);

/// Events, while buffers are watched.
static EVENTS: Mutex<Option<Vec<Event>>> = Mutex::new(None);
/// Storage buffers by set and binding, of the sets written since a pool was reset. A set is bound
/// right after it was written.
static SETS: Mutex<BTreeMap<(u64, u32), vk::Buffer>> = Mutex::new(BTreeMap::new());
/// Bound sets of compute and of graphics.
static BOUND_SETS: [AtomicU64; 2] = [AtomicU64::new(0), AtomicU64::new(0)];
/// The buffer and the index of the barrier to drop.
static LEFT_OUT: Mutex<Option<(vk::Buffer, usize)>> = Mutex::new(None);

/// Starts to watch uses of buffers by fills, updates, dispatches and indirect draws, and all their
/// barriers.
pub fn watch() {
    *held(&EVENTS) = Some(Vec::new());
}

/// Stops watching, and returns the events.
pub fn take_events() -> Vec<Event> {
    held(&EVENTS).take().expect("watched")
}

fn note(event: Event) {
    if let Some(events) = &mut *held(&EVENTS) {
        events.push(event);
    }
}

/// The library's buffers that have this size.
pub fn buffers_of_size(bytes: u64) -> Vec<vk::Buffer> {
    let sizes = held(&SIZES);
    sizes.iter().filter(|(_, size)| **size == bytes).map(|b| vk::Buffer::from_raw(*b.0)).collect()
}

/// All buffers of the descriptor sets that contain this buffer.
pub fn buffers_beside(buffer: vk::Buffer) -> Vec<vk::Buffer> {
    let sets = held(&SETS);
    let with = sets.iter().filter(|(_, other)| **other == buffer).map(|(at, _)| at.0);
    let with: Vec<u64> = with.collect();
    sets.iter().filter(|(at, _)| with.contains(&at.0)).map(|(_, other)| *other).collect()
}

/// Drops the `nth` barrier (from 0) of a buffer in the next watch, so that neither the driver nor a
/// validation layer sees it.
pub fn leave_out(buffer: vk::Buffer, nth: usize) {
    *held(&LEFT_OUT) = Some((buffer, nth));
}

fn use_of(buffer: u64, by: By) {
    note(Event::Use { buffer: vk::Buffer::from_raw(buffer), by });
}

fn use_bound(by: By) {
    let set = BOUND_SETS[usize::from(by == By::Graphics)].load(SeqCst);
    let all: Vec<_> = held(&SETS).range((set, 0)..=(set, u32::MAX)).map(|b| *b.1).collect();
    all.into_iter().for_each(|buffer| use_of(buffer.as_raw(), by));
}

fn bind(point: i32, count: u32, sets: P) {
    let graphics = point == vk::PipelineBindPoint::GRAPHICS.as_raw();
    assert_eq!(count, 1, "sets at once");
    // SAFETY: the caller passed this number of handles.
    BOUND_SETS[usize::from(graphics)].store(unsafe { *sets.cast::<u64>() }, SeqCst);
}

/// Whether this barrier of the buffer is to be dropped.
fn is_left_out(buffer: vk::Buffer) -> bool {
    let events = held(&EVENTS);
    let Some(events) = &*events else { return false };
    let own =
        |event: &&Event| matches!(event, Event::Barrier { buffer: Some(of), .. } if *of == buffer);
    let before = events.iter().filter(own).count();
    held(&LEFT_OUT).take_if(|which| *which == (buffer, before)).is_some()
}

/// Written by hand, because it records the barriers.
pub static CMD_BARRIER: Function = Function::new(c"vkCmdPipelineBarrier2");
/// The image of each image barrier since the last reset.
static IMAGE_BARRIERS: Mutex<Vec<vk::Image>> = Mutex::new(Vec::new());

/// Barriers of an image since the last reset.
pub fn barriers_of(image: vk::Image) -> usize {
    held(&IMAGE_BARRIERS).iter().filter(|other| **other == image).count()
}

unsafe extern "system" fn cmd_barrier(c: vk::CommandBuffer, i: P) {
    CMD_BARRIER.called();
    // SAFETY: the driver's function, with a valid dependency info.
    unsafe {
        let info = *i.cast::<vk::DependencyInfo<'_>>();
        for n in 0..info.image_memory_barrier_count as usize {
            held(&IMAGE_BARRIERS).push((*info.p_image_memory_barriers.add(n)).image);
        }
        let mut given = Vec::new();
        for n in 0..info.buffer_memory_barrier_count as usize {
            let barrier = *info.p_buffer_memory_barriers.add(n);
            if is_left_out(barrier.buffer) {
                continue;
            }
            given.push(barrier);
            note(Event::Barrier {
                buffer: Some(barrier.buffer),
                before: (barrier.src_stage_mask, barrier.src_access_mask),
                after: (barrier.dst_stage_mask, barrier.dst_access_mask),
            });
        }
        for n in 0..info.memory_barrier_count as usize {
            let barrier = *info.p_memory_barriers.add(n);
            note(Event::Barrier {
                buffer: None,
                before: (barrier.src_stage_mask, barrier.src_access_mask),
                after: (barrier.dst_stage_mask, barrier.dst_access_mask),
            });
        }
        let info = info.buffer_memory_barriers(&given);
        let real: unsafe extern "system" fn(vk::CommandBuffer, P) =
            std::mem::transmute(CMD_BARRIER.real.load(SeqCst));
        real(c, (&raw const info).cast());
    }
}

/// Written by hand, because it remembers the cube.
pub static CREATE_IMAGE: Function = Function::new(c"vkCreateImage");
/// The last image created with six layers and mips: the environment's cube map, which is no layer
/// of a frame.
static CUBE: AtomicU64 = AtomicU64::new(0);

/// The environment's cube map of the renderer that was created last.
pub fn cube() -> vk::Image {
    vk::Image::from_raw(CUBE.load(SeqCst))
}

unsafe extern "system" fn create_image(d: vk::Device, i: P, a: P, o: P) -> vk::Result {
    if let Some(result) = CREATE_IMAGE.called() {
        return result;
    }
    // SAFETY: the driver's function, with a valid create info and room for the handle.
    let (result, cube) = unsafe {
        let real: unsafe extern "system" fn(vk::Device, P, P, P) -> vk::Result =
            std::mem::transmute(CREATE_IMAGE.real.load(SeqCst));
        let result = real(d, i, a, o);
        let info = &*i.cast::<vk::ImageCreateInfo<'_>>();
        let cube = info.array_layers == 6 && info.mip_levels > 1;
        (result, cube.then(|| *o.cast::<u64>()))
    };
    if result == vk::Result::SUCCESS {
        CREATE_IMAGE.live.fetch_add(1, SeqCst);
        CUBE.store(cube.unwrap_or(CUBE.load(SeqCst)), SeqCst);
    }
    result
}

/// Written by hand, because it stores the sizes.
pub static CREATE_BUFFER: Function = Function::new(c"vkCreateBuffer");
/// Sizes of the library's buffers.
static SIZES: Mutex<BTreeMap<u64, u64>> = Mutex::new(BTreeMap::new());

unsafe extern "system" fn create_buffer(d: vk::Device, i: P, a: P, o: P) -> vk::Result {
    if let Some(result) = CREATE_BUFFER.called() {
        return result;
    }
    // SAFETY: the driver's function, with a valid create info and room for the handle.
    unsafe {
        let real: unsafe extern "system" fn(vk::Device, P, P, P) -> vk::Result =
            std::mem::transmute(CREATE_BUFFER.real.load(SeqCst));
        let result = real(d, i, a, o);
        if result == vk::Result::SUCCESS {
            CREATE_BUFFER.live.fetch_add(1, SeqCst);
            let size = (*i.cast::<vk::BufferCreateInfo<'_>>()).size;
            held(&SIZES).insert(*o.cast::<u64>(), size);
        }
        result
    }
}

fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Written by hand, because it stores the bindings.
pub static UPDATE_SETS: Function = Function::new(c"vkUpdateDescriptorSets");
static BOUND: Mutex<Vec<Bound>> = Mutex::new(Vec::new());

/// A buffer in a descriptor set.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    pub kind: vk::DescriptorType,
    pub buffer: vk::Buffer,
    pub offset: u64,
    pub range: u64,
}

impl Bound {
    /// Number of bound bytes. `host` has the sizes of the host's buffers.
    pub fn bytes(&self, host: &[(vk::Buffer, u64)]) -> u64 {
        if self.range != vk::WHOLE_SIZE {
            return self.range;
        }
        let host = host.iter().find(|(buffer, _)| *buffer == self.buffer).map(|(_, size)| *size);
        let size = host.or_else(|| held(&SIZES).get(&self.buffer.as_raw()).copied());
        size.unwrap_or_else(|| panic!("of unknown size: {self:?}")) - self.offset
    }
}

/// Every buffer that was written to a descriptor set since the last call.
pub fn take_bound() -> Vec<Bound> {
    std::mem::take(&mut *held(&BOUND))
}

unsafe extern "system" fn update_sets(d: vk::Device, n: u32, w: P, copies: u32, c: P) {
    UPDATE_SETS.called();
    // SAFETY: the driver's function, with `n` valid writes; those of buffers have buffer infos.
    unsafe {
        let writes = std::slice::from_raw_parts(w.cast::<vk::WriteDescriptorSet<'_>>(), n as usize);
        for write in writes.iter().filter(|w| !w.p_buffer_info.is_null()) {
            let count = write.descriptor_count as usize;
            for info in std::slice::from_raw_parts(write.p_buffer_info, count) {
                let vk::DescriptorBufferInfo { buffer, offset, range } = *info;
                held(&BOUND).push(Bound { kind: write.descriptor_type, buffer, offset, range });
                if write.descriptor_type == vk::DescriptorType::STORAGE_BUFFER {
                    held(&SETS).insert((write.dst_set.as_raw(), write.dst_binding), buffer);
                }
            }
        }
        let real: unsafe extern "system" fn(vk::Device, u32, P, u32, P) =
            std::mem::transmute(UPDATE_SETS.real.load(SeqCst));
        real(d, n, w, copies, c);
    }
}

/// Written by hand, because it replaces timestamps.
pub static QUERY_RESULTS: Function = Function::new(c"vkGetQueryPoolResults");
static STAMPS: Mutex<Option<Stamps>> = Mutex::new(None);

/// A timestamp for each query.
pub type Stamps = Box<dyn Fn(usize) -> u64 + Send>;

/// Replaces the timestamps of queries from now on, by their number. `None`: the driver's values are
/// returned.
pub fn answer(stamps: Option<Stamps>) {
    *held(&STAMPS) = stamps;
}

#[allow(clippy::too_many_arguments)] // Vulkan's
unsafe extern "system" fn query_results(
    d: vk::Device,
    pool: u64,
    first: u32,
    n: u32,
    size: usize,
    data: *mut c_void,
    stride: u64,
    flags: u32,
) -> vk::Result {
    if let Some(result) = QUERY_RESULTS.called() {
        return result;
    }
    // SAFETY: the driver's function, and room for `n` results of 64 bits where they are asked for.
    unsafe {
        let real: unsafe extern "system" fn(
            vk::Device,
            u64,
            u32,
            u32,
            usize,
            *mut c_void,
            u64,
            u32,
        ) -> vk::Result = std::mem::transmute(QUERY_RESULTS.real.load(SeqCst));
        let result = real(d, pool, first, n, size, data, stride, flags);
        if let Some(stamps) = held(&STAMPS).as_ref().filter(|_| result == vk::Result::SUCCESS) {
            assert!(flags == vk::QueryResultFlags::TYPE_64.as_raw() && stride == 8);
            for i in 0..n as usize {
                data.cast::<u64>().add(i).write(stamps(first as usize + i));
            }
        }
        result
    }
}

const BY_HAND: &[(&Function, *const c_void)] = &[
    (&CREATE_BUFFER, create_buffer as *const c_void),
    (&UPDATE_SETS, update_sets as *const c_void),
    (&QUERY_RESULTS, query_results as *const c_void),
    (&CREATE_DESCRIPTOR_POOL, create_descriptor_pool as *const c_void),
    (&CREATE_IMAGE, create_image as *const c_void),
    (&CMD_BARRIER, cmd_barrier as *const c_void),
];

fn all() -> impl Iterator<Item = &'static (&'static Function, *const c_void)> {
    WITH_RESULT.iter().chain(WITHOUT_RESULT).chain(BY_HAND)
}

/// The device's functions with the spy in front.
pub fn functions(gpu: &Gpu) -> ash::Device {
    gpu.assert_own();
    let handle = gpu.device.handle();
    let load = |name: &CStr| -> *const c_void {
        // SAFETY: live instance and device.
        let real = unsafe { gpu.instance.get_device_proc_addr(handle, name.as_ptr()) };
        let real = real.map_or(std::ptr::null(), |f| f as *const c_void);
        match all().find(|(function, _)| function.name == name) {
            Some((function, stand_in)) if !real.is_null() => {
                function.real.store(real.cast_mut(), SeqCst);
                *stand_in
            }
            _ => real,
        }
    };
    // SAFETY: every pointer is the driver's or a stand-in of the same signature.
    unsafe { ash::Device::load_with(load, handle) }
}

/// Puts the spy between the library and a device of the test's own.
pub fn install(gpu: &mut Gpu) {
    let functions = functions(gpu);
    gpu.allocator = Arc::new(Mutex::new(gpu.make_allocator(&functions)));
    gpu.functions = functions;
    forget();
    reset();
}

/// Forgets live objects.
pub fn forget() {
    for (function, _) in all() {
        function.live.store(0, SeqCst);
    }
}

/// Forgets calls and requested failures.
pub fn reset() {
    for (function, _) in all() {
        function.calls.store(0, SeqCst);
        function.fails_in.store(0, SeqCst);
    }
    held(&IMAGE_BARRIERS).clear();
}

/// Objects that were created and not destroyed, except device memory (the allocator keeps blocks).
pub fn live() -> Vec<String> {
    let pipelines = [&CREATE_GRAPHICS_PIPELINES, &CREATE_COMPUTE_PIPELINES];
    let mut found: Vec<(&CStr, i64)> = all()
        .filter(|(f, _)| !std::ptr::eq(*f, &ALLOCATE_MEMORY))
        .filter(|(f, _)| !pipelines.iter().any(|p| std::ptr::eq(*f, *p)))
        .map(|(f, _)| (f.name, f.live.load(SeqCst)))
        .collect();
    found.push((c"pipelines", pipelines.iter().map(|p| p.live.load(SeqCst)).sum()));
    let shown = |(name, n): &(&CStr, i64)| format!("{n} of {}", name.to_string_lossy());
    found.iter().filter(|f| f.1 != 0).map(shown).collect()
}
