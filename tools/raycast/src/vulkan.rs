//! Buffers, compute pipelines and frames of passes on a [`Device`]: the base of all ray-casters.

use std::sync::PoisonError;

use whitewater::ash::vk;
use whitewater::gpu_allocator::MemoryLocation;
use whitewater::gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use whitewater::headless::Device;
use whitewater::{Error, Timing};

/// Most timed scopes of a frame.
const MOST_SCOPES: u32 = 512;
/// Most dispatches of a frame.
const MOST_DISPATCHES: u32 = 1024;
/// Most storage buffers of a pass.
const MOST_BUFFERS: u32 = 7;

/// Use of a buffer: stages and accesses.
#[derive(Clone, Copy)]
pub struct Use(vk::PipelineStageFlags2, vk::AccessFlags2);

/// Read by shaders.
pub const READ: Use =
    Use(vk::PipelineStageFlags2::COMPUTE_SHADER, vk::AccessFlags2::SHADER_STORAGE_READ);
/// Written by shaders.
pub const WRITE: Use =
    Use(vk::PipelineStageFlags2::COMPUTE_SHADER, vk::AccessFlags2::SHADER_STORAGE_WRITE);
/// Read and written by shaders.
pub const UPDATE: Use = Use(
    vk::PipelineStageFlags2::COMPUTE_SHADER,
    vk::AccessFlags2::from_raw(
        vk::AccessFlags2::SHADER_STORAGE_READ.as_raw()
            | vk::AccessFlags2::SHADER_STORAGE_WRITE.as_raw(),
    ),
);
/// Fill with a constant. The stage is all transfers, because validation layers misjudge the stage of clears.
pub const FILL: Use = Use(vk::PipelineStageFlags2::ALL_TRANSFER, vk::AccessFlags2::TRANSFER_WRITE);
/// Source of a copy.
pub const COPY: Use = Use(vk::PipelineStageFlags2::ALL_TRANSFER, vk::AccessFlags2::TRANSFER_READ);
const HOST: Use = Use(vk::PipelineStageFlags2::HOST, vk::AccessFlags2::HOST_READ);

trait VkContext<T> {
    fn context(self, call: &str) -> Result<T, Error>;
}

impl<T> VkContext<T> for Result<T, vk::Result> {
    fn context(self, call: &str) -> Result<T, Error> {
        self.map_err(|result| Error::Vulkan { call: call.into(), result })
    }
}

/// A storage buffer. Dropping frees it, so wait for all work that uses it first.
pub struct Buffer<'d> {
    device: &'d Device,
    /// Vulkan's handle.
    pub handle: vk::Buffer,
    /// Its size in bytes.
    pub size: u64,
    allocation: Option<Allocation>,
}

impl<'d> Buffer<'d> {
    /// Makes a buffer of at least 16 bytes.
    pub fn new(
        device: &'d Device,
        name: &str,
        size: u64,
        location: MemoryLocation,
    ) -> Result<Self, Error> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::UNIFORM_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
        let size = size.max(16);
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        // SAFETY: valid create info on a live device.
        let handle = unsafe { device.device.create_buffer(&info, None) }
            .context(&format!("vkCreateBuffer {name}"))?;
        let mut buffer = Self { device, handle, size, allocation: None };
        // SAFETY: a live buffer.
        let requirements = unsafe { device.device.get_buffer_memory_requirements(handle) };
        let allocation = device
            .allocator
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .allocate(&AllocationCreateDesc {
                name,
                requirements,
                location,
                linear: true,
                allocation_scheme: AllocationScheme::GpuAllocatorManaged,
            })
            .map_err(|source| Error::Allocation { name: name.into(), source: Box::new(source) })?;
        let (memory, offset) =
            // SAFETY: the memory is bound once, below.
            unsafe { (allocation.memory(), allocation.offset()) };
        buffer.allocation = Some(allocation);
        // SAFETY: the memory fits and was not bound before.
        unsafe { device.device.bind_buffer_memory(handle, memory, offset) }
            .context(&format!("vkBindBufferMemory {name}"))?;
        Ok(buffer)
    }

    /// Makes a buffer with `bytes`, written by the CPU.
    pub fn with(device: &'d Device, name: &str, bytes: &[u8]) -> Result<Self, Error> {
        let mut buffer = Self::new(device, name, bytes.len() as u64, MemoryLocation::CpuToGpu)?;
        if let Some(to) = buffer.allocation.as_mut().and_then(|a| a.mapped_slice_mut()) {
            to[..bytes.len()].copy_from_slice(bytes);
        }
        Ok(buffer)
    }

    fn words(&self, count: usize) -> Vec<u32> {
        let bytes = self.allocation.as_ref().and_then(|a| a.mapped_slice()).unwrap_or_default();
        bytes.chunks_exact(4).take(count).map(bytemuck::pod_read_unaligned).collect()
    }
}

impl Drop for Buffer<'_> {
    fn drop(&mut self) {
        // SAFETY: all work was waited for.
        unsafe { self.device.device.destroy_buffer(self.handle, None) };
        if let Some(allocation) = self.allocation.take() {
            let mut allocator =
                self.device.allocator.lock().unwrap_or_else(PoisonError::into_inner);
            // Freeing fails only for another allocator's memory.
            let _ = allocator.free(allocation);
        }
    }
}

/// A compute pipeline. Binding 0 is the picture's block, the others are storage buffers.
pub struct Pass<'d> {
    device: &'d Device,
    pipeline: vk::Pipeline,
    layout: vk::PipelineLayout,
    set_layout: vk::DescriptorSetLayout,
    buffers: u32,
}

impl<'d> Pass<'d> {
    /// Makes a pipeline from SPIR-V, with `buffers` storage buffers and these specialization constants.
    pub fn new(
        device: &'d Device,
        name: &'static str,
        code: &[u8],
        buffers: u32,
        constants: &[(u32, u32)],
    ) -> Result<Self, Error> {
        let mut pass = Self {
            device,
            pipeline: vk::Pipeline::null(),
            layout: vk::PipelineLayout::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            buffers,
        };
        let bindings: Vec<_> = (0..=buffers)
            .map(|binding| {
                let kind = match binding {
                    0 => vk::DescriptorType::UNIFORM_BUFFER,
                    _ => vk::DescriptorType::STORAGE_BUFFER,
                };
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding)
                    .descriptor_type(kind)
                    .descriptor_count(1)
                    .stage_flags(vk::ShaderStageFlags::COMPUTE)
            })
            .collect();
        let vulkan = &device.device;
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: valid create infos on a live device, here and below.
        pass.set_layout = unsafe { vulkan.create_descriptor_set_layout(&info, None) }
            .context(&format!("vkCreateDescriptorSetLayout {name}"))?;
        let set_layouts = [pass.set_layout];
        let push = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
            .size(size_of::<[u32; 3]>() as u32)];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&set_layouts)
            .push_constant_ranges(&push);
        // SAFETY: as above.
        pass.layout = unsafe { vulkan.create_pipeline_layout(&info, None) }
            .context(&format!("vkCreatePipelineLayout {name}"))?;
        let words: Vec<u32> = code.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: as above.
        let module = unsafe { vulkan.create_shader_module(&info, None) }
            .context(&format!("vkCreateShaderModule {name}"))?;
        let (ids, values): (Vec<u32>, Vec<u32>) = constants.iter().copied().unzip();
        let entry = |(i, id): (u32, &u32)| vk::SpecializationMapEntry {
            constant_id: *id,
            offset: 4 * i,
            size: 4,
        };
        let entries: Vec<_> = (0..).zip(&ids).map(entry).collect();
        let specialization = vk::SpecializationInfo::default()
            .map_entries(&entries)
            .data(bytemuck::cast_slice(&values));
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"main")
            .specialization_info(&specialization);
        let info = [vk::ComputePipelineCreateInfo::default().stage(stage).layout(pass.layout)];
        // SAFETY: as above.
        let made =
            unsafe { vulkan.create_compute_pipelines(vk::PipelineCache::null(), &info, None) };
        // SAFETY: the pipeline does not need it any more.
        unsafe { vulkan.destroy_shader_module(module, None) };
        let made = made
            .map_err(|(_, result)| result)
            .context(&format!("vkCreateComputePipelines {name}"))?;
        pass.pipeline = made[0];
        Ok(pass)
    }
}

impl Drop for Pass<'_> {
    fn drop(&mut self) {
        let vulkan = &self.device.device;
        // SAFETY: all work was waited for; null handles are ignored.
        unsafe {
            vulkan.destroy_pipeline(self.pipeline, None);
            vulkan.destroy_pipeline_layout(self.layout, None);
            vulkan.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}

/// Command buffer, timestamps and descriptor sets of one frame at a time.
pub struct Queue<'d> {
    device: &'d Device,
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
    sets: vk::DescriptorPool,
    /// Null if the queue family has no timestamps.
    queries: vk::QueryPool,
    timestamp_mask: u64,
    timestamp_period: f64,
}

impl<'d> Queue<'d> {
    /// Makes everything for one frame at a time.
    pub fn new(device: &'d Device) -> Result<Self, Error> {
        // SAFETY: live handles.
        let (limits, families) = unsafe {
            let instance = &device.instance;
            (
                instance.get_physical_device_properties(device.physical).limits,
                instance.get_physical_device_queue_family_properties(device.physical),
            )
        };
        let bits = families[device.queue_family as usize].timestamp_valid_bits;
        let mut queue = Self {
            device,
            pool: vk::CommandPool::null(),
            cmd: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            sets: vk::DescriptorPool::null(),
            queries: vk::QueryPool::null(),
            timestamp_mask: if bits == 0 { 0 } else { u64::MAX >> (64 - bits.min(64)) },
            timestamp_period: f64::from(limits.timestamp_period),
        };
        let vulkan = &device.device;
        let info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(device.queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: valid create infos on a live device, here and below.
        queue.pool =
            unsafe { vulkan.create_command_pool(&info, None) }.context("vkCreateCommandPool")?;
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(queue.pool)
            .command_buffer_count(1);
        // SAFETY: as above.
        queue.cmd = unsafe { vulkan.allocate_command_buffers(&info) }
            .context("vkAllocateCommandBuffers")?[0];
        // SAFETY: as above.
        queue.fence = unsafe { vulkan.create_fence(&vk::FenceCreateInfo::default(), None) }
            .context("vkCreateFence")?;
        let size = |ty, count| vk::DescriptorPoolSize { ty, descriptor_count: count };
        let sizes = [
            size(vk::DescriptorType::UNIFORM_BUFFER, MOST_DISPATCHES),
            size(vk::DescriptorType::STORAGE_BUFFER, MOST_DISPATCHES * MOST_BUFFERS),
        ];
        let info =
            vk::DescriptorPoolCreateInfo::default().max_sets(MOST_DISPATCHES).pool_sizes(&sizes);
        // SAFETY: as above.
        queue.sets = unsafe { vulkan.create_descriptor_pool(&info, None) }
            .context("vkCreateDescriptorPool")?;
        if bits > 0 {
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(2 * MOST_SCOPES);
            // SAFETY: as above.
            queue.queries =
                unsafe { vulkan.create_query_pool(&info, None) }.context("vkCreateQueryPool")?;
        }
        Ok(queue)
    }

    /// Records, submits and waits. Returns the time of each scope.
    pub fn run(
        &self,
        record: impl FnOnce(&mut Frame<'_>) -> Result<(), Error>,
    ) -> Result<Vec<Timing>, Error> {
        let vulkan = &self.device.device;
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the work before was waited for.
        unsafe {
            vulkan
                .reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty())
                .context("vkResetCommandPool")?;
            vulkan
                .reset_descriptor_pool(self.sets, vk::DescriptorPoolResetFlags::empty())
                .context("vkResetDescriptorPool")?;
            vulkan.begin_command_buffer(self.cmd, &begin).context("vkBeginCommandBuffer")?;
            if self.timestamp_mask > 0 {
                vulkan.cmd_reset_query_pool(self.cmd, self.queries, 0, 2 * MOST_SCOPES);
            }
        }
        let mut frame = Frame { queue: self, names: Vec::new(), dispatches: 0 };
        record(&mut frame)?;
        let names = frame.names;
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(self.cmd)];
        let submits = [vk::SubmitInfo2::default().command_buffer_infos(&buffers)];
        let fences = [self.fence];
        // SAFETY: the command buffer is recording; queue and fence are used by one thread.
        unsafe {
            vulkan.end_command_buffer(self.cmd).context("vkEndCommandBuffer")?;
            vulkan
                .queue_submit2(self.device.queue, &submits, self.fence)
                .context("vkQueueSubmit2")?;
            vulkan.wait_for_fences(&fences, true, u64::MAX).context("vkWaitForFences")?;
            vulkan.reset_fences(&fences).context("vkResetFences")?;
        }
        self.times(&names)
    }

    fn times(&self, names: &[&'static str]) -> Result<Vec<Timing>, Error> {
        if names.is_empty() || self.timestamp_mask == 0 {
            return Ok(Vec::new());
        }
        let mut raw = vec![0u64; 2 * names.len()];
        // SAFETY: 64-bit results of queries that were written by work that is done.
        unsafe {
            self.device.device.get_query_pool_results(
                self.queries,
                0,
                &mut raw,
                vk::QueryResultFlags::TYPE_64,
            )
        }
        .context("vkGetQueryPoolResults")?;
        let span = |from: u64, to: u64| {
            (to.wrapping_sub(from) & self.timestamp_mask) as f64 * self.timestamp_period
        };
        let timing = |(name, pair): (&&'static str, &[u64])| Timing {
            name,
            start: span(raw[0], pair[0]),
            nanoseconds: span(pair[0], pair[1]),
        };
        Ok(names.iter().zip(raw.chunks_exact(2)).map(timing).collect())
    }

    /// Reads `count` words that shaders wrote, from word `first` on.
    pub fn read(&self, from: &Buffer<'_>, first: u64, count: usize) -> Result<Vec<u32>, Error> {
        let size = 4 * count as u64;
        let to = Buffer::new(self.device, "read back", size, MemoryLocation::GpuToCpu)?;
        self.run(|frame| {
            frame.barrier(&[(from, WRITE, COPY)]);
            let region = vk::BufferCopy { src_offset: 4 * first, dst_offset: 0, size };
            // SAFETY: the command buffer is recording; both buffers hold the region.
            unsafe {
                self.device.device.cmd_copy_buffer(self.cmd, from.handle, to.handle, &[region])
            };
            frame.barrier(&[(&to, FILL, HOST)]);
            Ok(())
        })?;
        Ok(to.words(count))
    }
}

impl Drop for Queue<'_> {
    fn drop(&mut self) {
        let vulkan = &self.device.device;
        // SAFETY: all work was waited for; null handles are ignored.
        unsafe {
            vulkan.destroy_query_pool(self.queries, None);
            vulkan.destroy_descriptor_pool(self.sets, None);
            vulkan.destroy_fence(self.fence, None);
            vulkan.destroy_command_pool(self.pool, None);
        }
    }
}

/// A frame that is being recorded.
pub struct Frame<'q> {
    queue: &'q Queue<'q>,
    names: Vec<&'static str>,
    dispatches: u32,
}

impl Frame<'_> {
    /// Times the commands that `record` records.
    pub fn scope(
        &mut self,
        name: &'static str,
        record: impl FnOnce(&mut Self) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let index = self.names.len() as u32;
        let timed = index < MOST_SCOPES && self.queue.timestamp_mask > 0;
        if timed {
            self.names.push(name);
        }
        let stamp = |query| {
            if timed {
                // SAFETY: the command buffer is recording; the query was reset at its begin.
                unsafe {
                    self.queue.device.device.cmd_write_timestamp2(
                        self.queue.cmd,
                        vk::PipelineStageFlags2::ALL_COMMANDS,
                        self.queue.queries,
                        query,
                    );
                }
            }
        };
        stamp(2 * index);
        let end = 2 * index + 1;
        let (queue, result) = (self.queue, record(self));
        if timed {
            // SAFETY: as above.
            unsafe {
                queue.device.device.cmd_write_timestamp2(
                    queue.cmd,
                    vk::PipelineStageFlags2::ALL_COMMANDS,
                    queue.queries,
                    end,
                );
            }
        }
        result
    }

    /// Adds a barrier between two uses of each buffer.
    pub fn barrier(&mut self, uses: &[(&Buffer<'_>, Use, Use)]) {
        let barriers: Vec<_> = uses
            .iter()
            .map(|(buffer, from, to)| {
                vk::BufferMemoryBarrier2::default()
                    .buffer(buffer.handle)
                    .size(vk::WHOLE_SIZE)
                    .src_stage_mask(from.0)
                    .src_access_mask(from.1)
                    .dst_stage_mask(to.0)
                    .dst_access_mask(to.1)
                    .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            })
            .collect();
        let info = vk::DependencyInfo::default().buffer_memory_barriers(&barriers);
        // SAFETY: the command buffer is recording outside a render pass.
        unsafe { self.queue.device.device.cmd_pipeline_barrier2(self.queue.cmd, &info) };
    }

    /// Fills a buffer with zeros.
    pub fn clear(&mut self, buffer: &Buffer<'_>) {
        // SAFETY: the command buffer is recording outside a render pass.
        unsafe {
            self.queue.device.device.cmd_fill_buffer(
                self.queue.cmd,
                buffer.handle,
                0,
                vk::WHOLE_SIZE,
                0,
            );
        }
    }

    /// Dispatches a pass with the picture's block, storage buffers from binding 1 on, and push constants.
    pub fn dispatch(
        &mut self,
        pass: &Pass<'_>,
        block: &Buffer<'_>,
        buffers: &[&Buffer<'_>],
        push: [u32; 3],
        groups: [u32; 2],
    ) -> Result<(), Error> {
        if groups.contains(&0) {
            return Ok(());
        }
        debug_assert_eq!(buffers.len(), pass.buffers as usize);
        self.dispatches += 1;
        if self.dispatches > MOST_DISPATCHES {
            let why = format!("more than {MOST_DISPATCHES} dispatches: a coarser step needs fewer");
            return Err(Error::BadInput { field: "Settings.step", why });
        }
        let vulkan = &self.queue.device.device;
        let layouts = [pass.set_layout];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(self.queue.sets)
            .set_layouts(&layouts);
        // SAFETY: the pool has room for MOST_DISPATCHES sets.
        let set = unsafe { vulkan.allocate_descriptor_sets(&info) }
            .context("vkAllocateDescriptorSets")?[0];
        let infos: Vec<_> = std::iter::once(block)
            .chain(buffers.iter().copied())
            .map(|buffer| {
                [vk::DescriptorBufferInfo::default().buffer(buffer.handle).range(vk::WHOLE_SIZE)]
            })
            .collect();
        let writes: Vec<_> = (0..)
            .zip(&infos)
            .map(|(binding, info)| {
                let kind = match binding {
                    0 => vk::DescriptorType::UNIFORM_BUFFER,
                    _ => vk::DescriptorType::STORAGE_BUFFER,
                };
                vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(binding)
                    .descriptor_type(kind)
                    .buffer_info(info)
            })
            .collect();
        let (cmd, point) = (self.queue.cmd, vk::PipelineBindPoint::COMPUTE);
        // SAFETY: the command buffer is recording; set, pipeline and buffers outlive its execution, which is
        // waited for.
        unsafe {
            vulkan.update_descriptor_sets(&writes, &[]);
            vulkan.cmd_bind_pipeline(cmd, point, pass.pipeline);
            vulkan.cmd_bind_descriptor_sets(cmd, point, pass.layout, 0, &[set], &[]);
            vulkan.cmd_push_constants(
                cmd,
                pass.layout,
                vk::ShaderStageFlags::COMPUTE,
                0,
                bytemuck::bytes_of(&push),
            );
            vulkan.cmd_dispatch(cmd, groups[0], groups[1], 1);
        }
        Ok(())
    }
}
