//! The host's side of the contract: its own images, buffers, command buffers, barriers and slots.
//! It uses nothing of the library.

use ash::vk;
use whitewater::{Access, HostImage};

use super::device::Gpu;
use super::watchdog;

type Stage = vk::PipelineStageFlags2;
type Mask = vk::AccessFlags2;

/// Destination of a copy by the host.
pub const COPIED_TO: Access =
    Access::new(Stage::COPY, Mask::TRANSFER_WRITE, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
/// Source of a copy by the host.
pub const COPIED_FROM: Access =
    Access::new(Stage::COPY, Mask::TRANSFER_READ, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
/// The scene's colour image between the host's own passes.
pub const COLOR: Access = Access::new(
    Stage::COLOR_ATTACHMENT_OUTPUT,
    Mask::from_raw(Mask::COLOR_ATTACHMENT_READ.as_raw() | Mask::COLOR_ATTACHMENT_WRITE.as_raw()),
    vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
);
/// The scene's depth image between the host's own passes.
pub const DEPTH: Access = Access::new(
    Stage::from_raw(Stage::EARLY_FRAGMENT_TESTS.as_raw() | Stage::LATE_FRAGMENT_TESTS.as_raw()),
    Mask::from_raw(
        Mask::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | Mask::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
);
/// Buffers that the CPU writes.
pub const HOST_WRITE: Access = Access::new(Stage::HOST, Mask::HOST_WRITE, vk::ImageLayout::GENERAL);
/// Buffers that the CPU reads.
pub const HOST_READ: Access = Access::new(Stage::HOST, Mask::HOST_READ, vk::ImageLayout::GENERAL);
/// No earlier use.
pub const NOTHING: Access = Access::new(Stage::NONE, Mask::NONE, vk::ImageLayout::UNDEFINED);

/// An image of the host, and the state in which its own commands left it.
pub struct Texture {
    device: ash::Device,
    pub image: vk::Image,
    pub view: vk::ImageView,
    memory: vk::DeviceMemory,
    pub format: vk::Format,
    pub extent: vk::Extent2D,
    pub aspect: vk::ImageAspectFlags,
    pub state: Access,
}

impl Texture {
    /// The image as it is handed to a record, which expects and leaves it in `state`.
    pub fn host_image(&self) -> HostImage {
        HostImage::new(self.image, self.view, self.format, self.extent, self.state)
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        // SAFETY: the tests wait for all work before they drop its images.
        unsafe {
            self.device.destroy_image_view(self.view, None);
            self.device.destroy_image(self.image, None);
            self.device.free_memory(self.memory, None);
        }
    }
}

/// A mapped buffer of the host.
pub struct Data {
    device: ash::Device,
    pub buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    pointer: *mut u8,
    pub size: u64,
}

impl Data {
    /// Its bytes.
    pub fn bytes(&self) -> &[u8] {
        // SAFETY: it stays mapped, with `size` bytes.
        unsafe { std::slice::from_raw_parts(self.pointer, self.size as usize) }
    }

    /// Overwrites its first bytes.
    pub fn write(&mut self, bytes: &[u8]) {
        self.write_at(0, bytes);
    }

    /// Overwrites bytes from an offset on.
    pub fn write_at(&mut self, offset: u64, bytes: &[u8]) {
        assert!(offset + bytes.len() as u64 <= self.size);
        // SAFETY: it stays mapped and is large enough; there is no other reference while `self` is
        // borrowed.
        unsafe {
            let to = self.pointer.add(offset as usize);
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), to, bytes.len());
        }
    }
}

impl Drop for Data {
    fn drop(&mut self) {
        // SAFETY: as for `Texture`; freeing unmaps.
        unsafe {
            self.device.destroy_buffer(self.buffer, None);
            self.device.free_memory(self.memory, None);
        }
    }
}

/// Command buffers and fences, one of each per slot.
pub struct Stub {
    device: ash::Device,
    /// Whether the device has synchronization2.
    second: bool,
    queue: vk::Queue,
    memory_types: vk::PhysicalDeviceMemoryProperties,
    pool: vk::CommandPool,
    slots: Vec<(vk::CommandBuffer, vk::Fence, bool)>,
    utility: vk::CommandBuffer,
}

/// Bytes per texel of the formats used here; for depth-stencil formats, those of a copy of the
/// depth.
pub fn texel_size(format: vk::Format) -> u64 {
    match format {
        vk::Format::R32G32B32A32_SFLOAT => 16,
        vk::Format::R16G16B16A16_SFLOAT | vk::Format::R32G32_SFLOAT => 8,
        vk::Format::D16_UNORM => 2,
        _ => 4,
    }
}

/// The aspect for copies and views.
fn copy_aspect(aspect: vk::ImageAspectFlags) -> vk::ImageAspectFlags {
    match aspect.contains(vk::ImageAspectFlags::DEPTH) {
        true => vk::ImageAspectFlags::DEPTH,
        false => aspect,
    }
}

impl Stub {
    pub fn new(gpu: &Gpu, slots: u32) -> Self {
        let device = gpu.device.clone();
        let info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(gpu.queue_family)
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        // SAFETY: valid create infos on a live device.
        unsafe {
            let pool = device.create_command_pool(&info, None).expect("command pool");
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(slots + 1);
            let mut buffers = device.allocate_command_buffers(&info).expect("command buffers");
            let utility = buffers.pop().expect("one more than slots");
            let fence = vk::FenceCreateInfo::default();
            let slots = buffers
                .into_iter()
                .map(|cmd| (cmd, device.create_fence(&fence, None).expect("fence"), false))
                .collect();
            let memory_types = gpu.instance.get_physical_device_memory_properties(gpu.physical);
            let second = gpu.enabled.synchronization2;
            Self { device, second, queue: gpu.queue, memory_types, pool, slots, utility }
        }
    }

    fn allocate(
        &self,
        needs: vk::MemoryRequirements,
        flags: vk::MemoryPropertyFlags,
    ) -> vk::DeviceMemory {
        let types = self.memory_types.memory_types_as_slice();
        let index = (0..types.len())
            .find(|i| {
                needs.memory_type_bits & (1 << i) != 0 && types[*i].property_flags.contains(flags)
            })
            .expect("a memory type");
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needs.size)
            .memory_type_index(index as u32);
        // SAFETY: valid allocation.
        unsafe { self.device.allocate_memory(&info, None) }.expect("the host's memory")
    }

    /// An image with a view of its colour or depth.
    pub fn texture(
        &self,
        format: vk::Format,
        extent: vk::Extent2D,
        usage: vk::ImageUsageFlags,
    ) -> Texture {
        let aspect = match format {
            vk::Format::D32_SFLOAT | vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 => {
                vk::ImageAspectFlags::DEPTH
            }
            vk::Format::D32_SFLOAT_S8_UINT | vk::Format::D24_UNORM_S8_UINT => {
                vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
            }
            _ => vk::ImageAspectFlags::COLOR,
        };
        let copies = vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(extent.into())
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage | copies);
        // SAFETY: valid create infos; the memory fits the image and is bound once.
        unsafe {
            let image = self.device.create_image(&info, None).expect("image");
            let needs = self.device.get_image_memory_requirements(image);
            let memory = self.allocate(needs, vk::MemoryPropertyFlags::empty());
            self.device.bind_image_memory(image, memory, 0).expect("bind");
            let info = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range(copy_aspect(aspect)));
            let view = self.device.create_image_view(&info, None).expect("view");
            let device = self.device.clone();
            Texture { device, image, view, memory, format, extent, aspect, state: NOTHING }
        }
    }

    /// A mapped buffer with these bytes.
    pub fn data(&self, bytes: &[u8], usage: vk::BufferUsageFlags) -> Data {
        let size = (bytes.len() as u64).max(4);
        let mut data = self.sized(size, usage);
        data.write(bytes);
        data
    }

    /// A mapped buffer of this size.
    pub fn sized(&self, size: u64, usage: vk::BufferUsageFlags) -> Data {
        let info = vk::BufferCreateInfo::default().size(size).usage(usage);
        let flags = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        // SAFETY: valid create infos; the memory fits the buffer and is bound once.
        unsafe {
            let buffer = self.device.create_buffer(&info, None).expect("buffer");
            let needs = self.device.get_buffer_memory_requirements(buffer);
            let memory = self.allocate(needs, flags);
            self.device.bind_buffer_memory(buffer, memory, 0).expect("bind");
            let pointer = self
                .device
                .map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())
                .expect("map");
            Data { device: self.device.clone(), buffer, memory, pointer: pointer.cast(), size }
        }
    }

    fn start(&self, cmd: vk::CommandBuffer) {
        let info = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the command buffer is not in use (its fence was waited for).
        unsafe {
            self.device
                .reset_command_buffer(cmd, vk::CommandBufferResetFlags::empty())
                .expect("reset");
            self.device.begin_command_buffer(cmd, &info).expect("begin");
        }
    }

    fn submit(&self, cmd: vk::CommandBuffer, fence: vk::Fence) {
        let buffers = [cmd];
        let submit = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: the command buffer is recorded; one thread uses the queue.
        unsafe {
            self.device.end_command_buffer(cmd).expect("end");
            self.device.queue_submit(self.queue, &submit, fence).expect("submit");
        }
    }

    /// Records and submits commands and waits for them.
    pub fn run<T>(&self, record: impl FnOnce(vk::CommandBuffer) -> T) -> T {
        self.start(self.utility);
        let result = record(self.utility);
        self.submit(self.utility, vk::Fence::null());
        // SAFETY: live queue.
        watchdog::waiting(|| unsafe { self.device.queue_wait_idle(self.queue) }).expect("wait");
        result
    }

    /// Waits for a slot and begins its command buffer.
    pub fn begin(&mut self, slot: u32) -> vk::CommandBuffer {
        self.wait(slot);
        let cmd = self.slots[slot as usize].0;
        self.start(cmd);
        cmd
    }

    /// Submits a slot's command buffer, without waiting.
    pub fn end(&mut self, slot: u32) {
        let (cmd, fence, pending) = &mut self.slots[slot as usize];
        *pending = true;
        let (cmd, fence) = (*cmd, *fence);
        self.submit(cmd, fence);
    }

    /// Ends a slot's command buffer that is never submitted.
    pub fn throw_away(&mut self, slot: u32) {
        // SAFETY: the command buffer is recording.
        unsafe { self.device.end_command_buffer(self.slots[slot as usize].0) }.expect("end");
    }

    /// Waits until a slot's work is done.
    pub fn wait(&mut self, slot: u32) {
        let (_, fence, pending) = &mut self.slots[slot as usize];
        if std::mem::take(pending) {
            let fences = [*fence];
            // SAFETY: the fence was submitted.
            unsafe {
                watchdog::waiting(|| self.device.wait_for_fences(&fences, true, u64::MAX))
                    .expect("wait");
                self.device.reset_fences(&fences).expect("reset");
            }
        }
    }

    /// An image barrier.
    pub fn barrier(
        &self,
        cmd: vk::CommandBuffer,
        image: vk::Image,
        aspect: vk::ImageAspectFlags,
        before: Access,
        after: Access,
    ) {
        if !self.second {
            let barrier = [vk::ImageMemoryBarrier::default()
                .image(image)
                .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
                .old_layout(before.layout)
                .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)
                .new_layout(after.layout)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .subresource_range(range(aspect))];
            let all = vk::PipelineStageFlags::ALL_COMMANDS | vk::PipelineStageFlags::HOST;
            let flags = vk::DependencyFlags::empty();
            // SAFETY: cmd is recording, the image is alive.
            unsafe { self.device.cmd_pipeline_barrier(cmd, all, all, flags, &[], &[], &barrier) };
            return;
        }
        let barriers = [vk::ImageMemoryBarrier2::default()
            .image(image)
            .src_stage_mask(before.stage)
            .src_access_mask(before.access)
            .old_layout(before.layout)
            .dst_stage_mask(after.stage)
            .dst_access_mask(after.access)
            .new_layout(after.layout)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .subresource_range(range(aspect))];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: cmd is recording, the image is alive.
        unsafe { self.device.cmd_pipeline_barrier2(cmd, &info) };
    }

    /// A barrier over a whole buffer.
    fn buffer_barrier(
        &self,
        cmd: vk::CommandBuffer,
        buffer: vk::Buffer,
        before: Access,
        after: Access,
    ) {
        if !self.second {
            let barrier = [vk::BufferMemoryBarrier::default()
                .buffer(buffer)
                .size(vk::WHOLE_SIZE)
                .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
                .dst_access_mask(vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)];
            let all = vk::PipelineStageFlags::ALL_COMMANDS | vk::PipelineStageFlags::HOST;
            let flags = vk::DependencyFlags::empty();
            // SAFETY: cmd is recording, the buffer is alive.
            unsafe { self.device.cmd_pipeline_barrier(cmd, all, all, flags, &[], &barrier, &[]) };
            return;
        }
        let barriers = [vk::BufferMemoryBarrier2::default()
            .buffer(buffer)
            .size(vk::WHOLE_SIZE)
            .src_stage_mask(before.stage)
            .src_access_mask(before.access)
            .dst_stage_mask(after.stage)
            .dst_access_mask(after.access)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)];
        let info = vk::DependencyInfo::default().buffer_memory_barriers(&barriers);
        // SAFETY: cmd is recording, the buffer is alive.
        unsafe { self.device.cmd_pipeline_barrier2(cmd, &info) };
    }

    /// Copies bytes into a whole image, and leaves it in state `after`.
    pub fn upload(&self, texture: &mut Texture, bytes: &[u8], after: Access) {
        let texels = u64::from(texture.extent.width) * u64::from(texture.extent.height);
        assert_eq!(bytes.len() as u64, texels * texel_size(texture.format));
        let staging = self.data(bytes, vk::BufferUsageFlags::TRANSFER_SRC);
        self.run(|cmd| {
            let before = Access { layout: vk::ImageLayout::UNDEFINED, ..texture.state };
            self.barrier(cmd, texture.image, texture.aspect, before, COPIED_TO);
            // SAFETY: the image is in the copy's layout and the buffer has its size.
            unsafe {
                self.device.cmd_copy_buffer_to_image(
                    cmd,
                    staging.buffer,
                    texture.image,
                    COPIED_TO.layout,
                    &[region(texture.aspect, texture.extent.into())],
                );
            }
            self.barrier(cmd, texture.image, texture.aspect, COPIED_TO, after);
        });
        texture.state = after;
    }

    /// A new image with these texels.
    pub fn uploaded(
        &self,
        format: vk::Format,
        extent: vk::Extent2D,
        usage: vk::ImageUsageFlags,
        bytes: &[u8],
        after: Access,
    ) -> Texture {
        let mut texture = self.texture(format, extent, usage);
        self.upload(&mut texture, bytes, after);
        texture
    }

    /// Reads the bytes of an image, and restores the image's state.
    pub fn download(
        &self,
        image: vk::Image,
        format: vk::Format,
        aspect: vk::ImageAspectFlags,
        area: vk::Rect2D,
        state: Access,
    ) -> Vec<u8> {
        let texels = u64::from(area.extent.width) * u64::from(area.extent.height);
        let back = self.sized(texels * texel_size(format), vk::BufferUsageFlags::TRANSFER_DST);
        self.run(|cmd| self.record_download(cmd, image, aspect, area, state, &back));
        back.bytes().to_vec()
    }

    /// Reads the bytes of every mip level of a cube of edge `size`, face by face, and restores the
    /// image's state.
    pub fn download_cube(
        &self,
        image: vk::Image,
        format: vk::Format,
        size: u32,
        state: Access,
    ) -> Vec<Vec<u8>> {
        let color = vk::ImageAspectFlags::COLOR;
        let mips = 0..=size.ilog2();
        let bytes = |mip: u32| 6 * u64::from(size >> mip).pow(2) * texel_size(format);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let back: Vec<Data> = mips.map(|mip| self.sized(bytes(mip), usage)).collect();
        self.run(|cmd| {
            self.barrier(cmd, image, color, state, COPIED_FROM);
            for (mip, back) in back.iter().enumerate() {
                let extent = vk::Extent2D { width: size >> mip, height: size >> mip };
                let mut region = region(color, extent.into());
                region.image_subresource.mip_level = mip as u32;
                region.image_subresource.layer_count = 6;
                self.to_host(cmd, image, region, back);
            }
            self.barrier(cmd, image, color, COPIED_FROM, state);
        });
        back.iter().map(|mip| mip.bytes().to_vec()).collect()
    }

    /// Copies a region into a buffer and makes it visible to the CPU.
    fn to_host(
        &self,
        cmd: vk::CommandBuffer,
        image: vk::Image,
        region: vk::BufferImageCopy,
        back: &Data,
    ) {
        let layout = COPIED_FROM.layout;
        // SAFETY: cmd is recording, the image in the copy's layout, and the buffer has its size.
        unsafe {
            self.device.cmd_copy_image_to_buffer(cmd, image, layout, back.buffer, &[region]);
        }
        self.buffer_barrier(cmd, back.buffer, COPIED_TO, HOST_READ);
    }

    /// Records the copy of an image into a buffer that the CPU reads.
    pub fn record_download(
        &self,
        cmd: vk::CommandBuffer,
        image: vk::Image,
        aspect: vk::ImageAspectFlags,
        area: vk::Rect2D,
        state: Access,
        back: &Data,
    ) {
        self.barrier(cmd, image, aspect, state, COPIED_FROM);
        self.to_host(cmd, image, region(aspect, area), back);
        self.barrier(cmd, image, aspect, COPIED_FROM, state);
    }

    /// Records the copy of a buffer that a compute shader writes into a buffer that the CPU reads.
    pub fn record_buffer_copy(&self, cmd: vk::CommandBuffer, from: vk::Buffer, back: &Data) {
        let written = Access::new(
            Stage::COMPUTE_SHADER,
            Mask::SHADER_STORAGE_WRITE,
            vk::ImageLayout::GENERAL,
        );
        let region = [vk::BufferCopy::default().size(back.size)];
        self.buffer_barrier(cmd, from, written, COPIED_FROM);
        // SAFETY: cmd is recording; both buffers are alive and large enough.
        unsafe { self.device.cmd_copy_buffer(cmd, from, back.buffer, &region) };
        self.buffer_barrier(cmd, back.buffer, COPIED_TO, HOST_READ);
    }

    /// The device's functions, for commands that a test records itself.
    pub fn functions(&self) -> &ash::Device {
        &self.device
    }
}

impl Drop for Stub {
    fn drop(&mut self) {
        // SAFETY: the queue is idle before anything is destroyed.
        unsafe {
            let _ = self.device.device_wait_idle();
            for (_, fence, _) in &self.slots {
                self.device.destroy_fence(*fence, None);
            }
            self.device.destroy_command_pool(self.pool, None);
        }
    }
}

fn range(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: aspect,
        base_mip_level: 0,
        level_count: vk::REMAINING_MIP_LEVELS,
        base_array_layer: 0,
        layer_count: vk::REMAINING_ARRAY_LAYERS,
    }
}

fn region(aspect: vk::ImageAspectFlags, area: vk::Rect2D) -> vk::BufferImageCopy {
    vk::BufferImageCopy::default()
        .image_subresource(vk::ImageSubresourceLayers {
            aspect_mask: copy_aspect(aspect),
            mip_level: 0,
            base_array_layer: 0,
            layer_count: 1,
        })
        .image_offset(vk::Offset3D { x: area.offset.x, y: area.offset.y, z: 0 })
        .image_extent(area.extent.into())
}
