//! Command buffers are begun, submitted and waited for; several in sequence if the CPU reads queries back in
//! between.

use std::sync::Arc;

use ash::vk;

use crate::error::{Error, VkContext};
use crate::gpu::Gpu;
use crate::gpu::graveyard::{Grave, Owned};

/// A command pool, its first buffer, and a fence to wait for.
pub struct Commands {
    pub pool: Owned<vk::CommandPool>,
    pub buffer: vk::CommandBuffer,
    pub fence: Owned<vk::Fence>,
}

impl Commands {
    pub fn new(gpu: &Gpu, queue_family: u32) -> Result<Self, Error> {
        let info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: valid create infos on a live device, here and below.
        let pool = unsafe { gpu.device.create_command_pool(&info, None) }
            .context(|| "vkCreateCommandPool".into())?;
        let pool = gpu.own(pool, Grave::CommandPool);
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool.handle)
            .command_buffer_count(1);
        // SAFETY: as above.
        let buffer = unsafe { gpu.device.allocate_command_buffers(&info) }
            .context(|| "vkAllocateCommandBuffers".into())?[0];
        // SAFETY: as above.
        let fence = unsafe { gpu.device.create_fence(&vk::FenceCreateInfo::default(), None) }
            .context(|| "vkCreateFence".into())?;
        Ok(Self { pool, buffer, fence: gpu.own(fence, Grave::Fence) })
    }
}

/// Begins a command buffer that is submitted once.
pub fn begin(gpu: &Gpu, cmd: vk::CommandBuffer) -> Result<(), Error> {
    let info =
        vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
    // SAFETY: the command buffer is in its initial state.
    unsafe { gpu.device.begin_command_buffer(cmd, &info) }.context(|| "vkBeginCommandBuffer".into())
}

/// Ends a command buffer, submits it and waits for it.
pub fn submit(
    gpu: &Gpu,
    queue: vk::Queue,
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
) -> Result<(), Error> {
    let buffers = [cmd];
    let submits = [vk::SubmitInfo::default().command_buffers(&buffers)];
    let fences = [fence];
    let device = &gpu.device;
    // SAFETY: the command buffer is recording; the queue and the fence are used by one thread.
    unsafe {
        device.end_command_buffer(cmd).context(|| "vkEndCommandBuffer".into())?;
        device.queue_submit(queue, &submits, fence).context(|| "vkQueueSubmit".into())?;
        device.wait_for_fences(&fences, true, u64::MAX).context(|| "vkWaitForFences".into())?;
        device.reset_fences(&fences).context(|| "vkResetFences".into())
    }
}

/// The parts of a frame between which the host reads queries back.
pub struct Parts {
    pub gpu: Arc<Gpu>,
    pub queue: vk::Queue,
    pub fence: vk::Fence,
    pub pool: vk::CommandPool,
    pub spare: Vec<vk::CommandBuffer>,
    pub used: usize,
}

impl Parts {
    pub fn read_back(
        &mut self,
        cmd: vk::CommandBuffer,
        pool: vk::QueryPool,
        query: u32,
    ) -> Result<(vk::CommandBuffer, bool), Error> {
        submit(&self.gpu, self.queue, cmd, self.fence)?;
        let mut samples = [0u32];
        // SAFETY: the query was ended in the work that was just waited for.
        unsafe {
            self.gpu.device.get_query_pool_results(
                pool,
                query,
                &mut samples,
                vk::QueryResultFlags::WAIT,
            )
        }
        .context(|| "vkGetQueryPoolResults".into())?;
        if self.used == self.spare.len() {
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(self.pool)
                .command_buffer_count(1);
            // SAFETY: valid create info on a live device.
            let more = unsafe { self.gpu.device.allocate_command_buffers(&info) }
                .context(|| "vkAllocateCommandBuffers".into())?;
            self.spare.extend(more);
        }
        let next = self.spare[self.used];
        self.used += 1;
        begin(&self.gpu, next)?;
        Ok((next, samples[0] > 0))
    }
}
