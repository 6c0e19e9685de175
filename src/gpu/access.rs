//! Barriers: a short table of named uses, and two helpers. There is no tracker: the order of the passes is
//! fixed, so every barrier is written where it is needed, from the previous use to the next one, with stages,
//! access *and* layout.

use ash::vk;

use super::Gpu;
use super::image::{Image, aspect_of};

/// How an image or buffer is used at one point of a command buffer. On a device without synchronization2 the library
/// translates it to the stages and accesses of Vulkan 1.0. In a host's own barriers of that kind `SHADER_READ` stands
/// for sampled and storage reads, `SHADER_WRITE` for storage writes, and `TRANSFER` for copies and clears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Pipeline stages of the use.
    pub stage: vk::PipelineStageFlags2,
    /// Kinds of memory access.
    pub access: vk::AccessFlags2,
    /// Image layout during the use (ignored for buffers).
    pub layout: vk::ImageLayout,
}

type Stage = vk::PipelineStageFlags2;
type Mask = vk::AccessFlags2;
type Layout = vk::ImageLayout;

impl Access {
    /// Any use.
    pub const fn new(stage: Stage, access: Mask, layout: Layout) -> Self {
        Self { stage, access, layout }
    }

    /// Both uses at once, in the layout of `self`.
    pub const fn and(self, other: Self) -> Self {
        Self {
            stage: Stage::from_raw(self.stage.as_raw() | other.stage.as_raw()),
            access: Mask::from_raw(self.access.as_raw() | other.access.as_raw()),
            layout: self.layout,
        }
    }

    /// This use with the image's contents discarded, as the state before the first write in a frame that overwrites
    /// the whole image. The write has to wait for the last use in the previous frame, but needs none of its contents.
    pub const fn discarded(self) -> Self {
        // Only execution must be ordered after reads; after writes the access mask is needed too.
        Self { stage: self.stage, access: self.access, layout: Layout::UNDEFINED }
    }
}

/// Compute shader: sampled image, in the layout `SHADER_READ_ONLY_OPTIMAL`.
pub const COMPUTE_SAMPLED: Access =
    Access::new(Stage::COMPUTE_SHADER, Mask::SHADER_SAMPLED_READ, Layout::SHADER_READ_ONLY_OPTIMAL);
/// Fragment shader: sampled image, in the layout `SHADER_READ_ONLY_OPTIMAL`.
pub const FRAGMENT_SAMPLED: Access = Access::new(
    Stage::FRAGMENT_SHADER,
    Mask::SHADER_SAMPLED_READ,
    Layout::SHADER_READ_ONLY_OPTIMAL,
);
/// Compute shader: storage image (layout `GENERAL`) or buffer, read.
pub const COMPUTE_READ: Access =
    Access::new(Stage::COMPUTE_SHADER, Mask::SHADER_STORAGE_READ, Layout::GENERAL);
/// Compute shader: storage image (layout `GENERAL`) or buffer, written.
pub const COMPUTE_WRITE: Access =
    Access::new(Stage::COMPUTE_SHADER, Mask::SHADER_STORAGE_WRITE, Layout::GENERAL);
/// Compute shader: storage image (layout `GENERAL`) or buffer, read and written (atomics).
pub const COMPUTE_READ_WRITE: Access = COMPUTE_READ.and(COMPUTE_WRITE);
/// Vertex shader: storage buffer, read.
pub const VERTEX_READ: Access =
    Access::new(Stage::VERTEX_SHADER, Mask::SHADER_STORAGE_READ, Layout::GENERAL);
/// Any shader: uniform buffer, read.
pub const UNIFORM: Access = Access::new(
    Stage::from_raw(
        Stage::COMPUTE_SHADER.as_raw()
            | Stage::VERTEX_SHADER.as_raw()
            | Stage::FRAGMENT_SHADER.as_raw(),
    ),
    Mask::UNIFORM_READ,
    Layout::GENERAL,
);
/// Vertex shader: sampled image, in the layout `SHADER_READ_ONLY_OPTIMAL`.
pub const VERTEX_SAMPLED: Access =
    Access::new(Stage::VERTEX_SHADER, Mask::SHADER_SAMPLED_READ, Layout::SHADER_READ_ONLY_OPTIMAL);
/// Fragment shader: storage buffer, read.
pub const FRAGMENT_READ: Access =
    Access::new(Stage::FRAGMENT_SHADER, Mask::SHADER_STORAGE_READ, Layout::GENERAL);
/// Vertices and indices.
#[cfg(feature = "headless")]
pub const VERTEX_INPUT: Access = Access::new(
    Stage::from_raw(Stage::VERTEX_ATTRIBUTE_INPUT.as_raw() | Stage::INDEX_INPUT.as_raw()),
    Mask::from_raw(Mask::VERTEX_ATTRIBUTE_READ.as_raw() | Mask::INDEX_READ.as_raw()),
    Layout::GENERAL,
);
/// Indirect draw or dispatch arguments, or a draw count.
pub const INDIRECT: Access =
    Access::new(Stage::DRAW_INDIRECT, Mask::INDIRECT_COMMAND_READ, Layout::GENERAL);
/// The predicate of conditional rendering.
pub const PREDICATE: Access = Access::new(
    Stage::CONDITIONAL_RENDERING_EXT,
    Mask::CONDITIONAL_RENDERING_READ_EXT,
    Layout::GENERAL,
);
/// Colour attachment, read (load, blend) and written: stage `COLOR_ATTACHMENT_OUTPUT`, layout
/// `COLOR_ATTACHMENT_OPTIMAL`.
pub const COLOR_ATTACHMENT: Access = Access::new(
    Stage::COLOR_ATTACHMENT_OUTPUT,
    Mask::from_raw(Mask::COLOR_ATTACHMENT_READ.as_raw() | Mask::COLOR_ATTACHMENT_WRITE.as_raw()),
    Layout::COLOR_ATTACHMENT_OPTIMAL,
);
/// Depth attachment, tested and written: stages `EARLY_FRAGMENT_TESTS` and `LATE_FRAGMENT_TESTS`, layout
/// `DEPTH_STENCIL_ATTACHMENT_OPTIMAL`.
pub const DEPTH_ATTACHMENT: Access = Access::new(
    Stage::from_raw(Stage::EARLY_FRAGMENT_TESTS.as_raw() | Stage::LATE_FRAGMENT_TESTS.as_raw()),
    Mask::from_raw(
        Mask::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | Mask::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
);
/// Written by a clear or fill, in the layout `TRANSFER_DST_OPTIMAL`. The stage is ALL_TRANSFER and not CLEAR, because
/// validation layers before 1.3.240 treat a fill as a copy.
pub const CLEAR: Access =
    Access::new(Stage::ALL_TRANSFER, Mask::TRANSFER_WRITE, Layout::TRANSFER_DST_OPTIMAL);
/// Source of a copy or blit: stage `ALL_TRANSFER`, layout `TRANSFER_SRC_OPTIMAL`.
pub const COPY_READ: Access =
    Access::new(Stage::ALL_TRANSFER, Mask::TRANSFER_READ, Layout::TRANSFER_SRC_OPTIMAL);
/// Destination of a copy or blit: stage `ALL_TRANSFER`, layout `TRANSFER_DST_OPTIMAL`.
pub const COPY_WRITE: Access = CLEAR;
/// No previous use: the contents are undefined.
pub const NOTHING: Access = Access::new(Stage::NONE, Mask::NONE, Layout::UNDEFINED);

/// A barrier over the whole of one of our images.
pub fn image(image: &Image, before: Access, after: Access) -> vk::ImageMemoryBarrier2<'static> {
    raw_image(image.handle, aspect_of(image.format), before, after)
}

/// A barrier over every mip and layer of any image.
pub fn raw_image(
    handle: vk::Image,
    aspect: vk::ImageAspectFlags,
    before: Access,
    after: Access,
) -> vk::ImageMemoryBarrier2<'static> {
    vk::ImageMemoryBarrier2::default()
        .image(handle)
        .src_stage_mask(before.stage)
        .src_access_mask(before.access)
        .old_layout(before.layout)
        .dst_stage_mask(after.stage)
        .dst_access_mask(after.access)
        .new_layout(after.layout)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .subresource_range(whole(aspect))
}

/// All levels and layers of an image.
pub fn whole(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: aspect,
        base_mip_level: 0,
        level_count: vk::REMAINING_MIP_LEVELS,
        base_array_layer: 0,
        layer_count: vk::REMAINING_ARRAY_LAYERS,
    }
}

/// A barrier over a whole buffer.
pub fn buffer(
    handle: vk::Buffer,
    before: Access,
    after: Access,
) -> vk::BufferMemoryBarrier2<'static> {
    vk::BufferMemoryBarrier2::default()
        .buffer(handle)
        .size(vk::WHOLE_SIZE)
        .src_stage_mask(before.stage)
        .src_access_mask(before.access)
        .dst_stage_mask(after.stage)
        .dst_access_mask(after.access)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
}

impl Gpu {
    /// Records one dependency with these barriers.
    pub fn barriers(
        &self,
        cmd: vk::CommandBuffer,
        images: &[vk::ImageMemoryBarrier2<'_>],
        buffers: &[vk::BufferMemoryBarrier2<'_>],
    ) {
        let info = vk::DependencyInfo::default()
            .image_memory_barriers(images)
            .buffer_memory_barriers(buffers);
        self.dependency(cmd, &info);
    }

    /// Records one dependency, with the functions that the device has.
    pub fn dependency(&self, cmd: vk::CommandBuffer, info: &vk::DependencyInfo<'_>) {
        match self.synchronization {
            // SAFETY: cmd is recording outside a render pass (contract); the handles live in their owners, which
            // outlive the slot (retire list).
            Synchronization::Second { barrier, .. } => unsafe { barrier(cmd, info) },
            // SAFETY: as above.
            Synchronization::First => unsafe { self.first_dependency(cmd, info) },
        }
    }

    /// Records a dependency with the function of Vulkan 1.0. It has one pair of stage masks for all barriers of a
    /// call, so each barrier also waits for the stages of the others; none waits for fewer stages than its own.
    ///
    /// # Safety
    /// Those of `vkCmdPipelineBarrier2`.
    unsafe fn first_dependency(&self, cmd: vk::CommandBuffer, info: &vk::DependencyInfo<'_>) {
        // SAFETY: pointers and counts belong together, as set by ash's builders; without elements the pointer is
        // null.
        let (all, buffers, images) = unsafe {
            (
                slice(info.p_memory_barriers, info.memory_barrier_count),
                slice(info.p_buffer_memory_barriers, info.buffer_memory_barrier_count),
                slice(info.p_image_memory_barriers, info.image_memory_barrier_count),
            )
        };
        let stages = (all.iter().map(|b| (b.src_stage_mask, b.dst_stage_mask)))
            .chain(buffers.iter().map(|b| (b.src_stage_mask, b.dst_stage_mask)))
            .chain(images.iter().map(|b| (b.src_stage_mask, b.dst_stage_mask)));
        let (before, after) = stages
            .fold((Stage::NONE, Stage::NONE), |sum, stage| (sum.0 | stage.0, sum.1 | stage.1));
        let all: Vec<_> = (all.iter())
            .map(|b| {
                vk::MemoryBarrier::default()
                    .src_access_mask(first_access(b.src_access_mask))
                    .dst_access_mask(first_access(b.dst_access_mask))
            })
            .collect();
        let buffers: Vec<_> = (buffers.iter())
            .map(|b| {
                vk::BufferMemoryBarrier::default()
                    .buffer(b.buffer)
                    .offset(b.offset)
                    .size(b.size)
                    .src_access_mask(first_access(b.src_access_mask))
                    .dst_access_mask(first_access(b.dst_access_mask))
                    .src_queue_family_index(b.src_queue_family_index)
                    .dst_queue_family_index(b.dst_queue_family_index)
            })
            .collect();
        let images: Vec<_> = (images.iter())
            .map(|b| {
                vk::ImageMemoryBarrier::default()
                    .image(b.image)
                    .subresource_range(b.subresource_range)
                    .old_layout(b.old_layout)
                    .new_layout(b.new_layout)
                    .src_access_mask(first_access(b.src_access_mask))
                    .dst_access_mask(first_access(b.dst_access_mask))
                    .src_queue_family_index(b.src_queue_family_index)
                    .dst_queue_family_index(b.dst_queue_family_index)
            })
            .collect();
        // SAFETY: guaranteed by the caller.
        unsafe {
            self.device.cmd_pipeline_barrier(
                cmd,
                first_stage(before, vk::PipelineStageFlags::TOP_OF_PIPE),
                first_stage(after, vk::PipelineStageFlags::BOTTOM_OF_PIPE),
                vk::DependencyFlags::empty(),
                &all,
                &buffers,
                &images,
            );
        }
    }
}

/// Functions for barriers and timestamps.
#[derive(Clone, Copy)]
pub enum Synchronization {
    /// `synchronization2`, of Vulkan 1.3 or of the extension.
    Second {
        /// `vkCmdPipelineBarrier2`.
        barrier: vk::PFN_vkCmdPipelineBarrier2,
        /// `vkCmdWriteTimestamp2`.
        timestamp: vk::PFN_vkCmdWriteTimestamp2,
    },
    /// The functions of Vulkan 1.0.
    First,
}

/// # Safety
/// `slice` requires that `pointer` points to `count` elements; it may be null if `count` is 0.
unsafe fn slice<'a, T>(pointer: *const T, count: u32) -> &'a [T] {
    match count {
        0 => &[],
        // SAFETY: guaranteed by the caller.
        count => unsafe { std::slice::from_raw_parts(pointer, count as usize) },
    }
}

/// Converts stage flags of synchronization2 to those of Vulkan 1.0. The low 32 flags are the same; each of the high
/// 32 is a part of an older flag, which replaces it. Without any flag the result is `nothing`.
fn first_stage(stage: Stage, nothing: vk::PipelineStageFlags) -> vk::PipelineStageFlags {
    type First = vk::PipelineStageFlags;
    let mut first = First::from_raw(stage.as_raw() as u32);
    let transfer = Stage::COPY | Stage::RESOLVE | Stage::BLIT | Stage::CLEAR;
    let input = Stage::INDEX_INPUT | Stage::VERTEX_ATTRIBUTE_INPUT;
    let mut rest = Stage::from_raw(stage.as_raw() & !0xffff_ffff);
    for (parts, whole) in [
        (transfer, First::TRANSFER),
        (input, First::VERTEX_INPUT),
        (Stage::PRE_RASTERIZATION_SHADERS, First::ALL_GRAPHICS),
        // Newer flags that a host may use.
        (rest & !(transfer | input | Stage::PRE_RASTERIZATION_SHADERS), First::ALL_COMMANDS),
    ] {
        if rest.intersects(parts) {
            first |= whole;
            rest &= !parts;
        }
    }
    if first.is_empty() { nothing } else { first }
}

/// Converts access flags of synchronization2 to those of Vulkan 1.0.
fn first_access(access: Mask) -> vk::AccessFlags {
    type First = vk::AccessFlags;
    let mut first = First::from_raw(access.as_raw() as u32);
    let read = Mask::SHADER_SAMPLED_READ | Mask::SHADER_STORAGE_READ;
    let mut rest = Mask::from_raw(access.as_raw() & !0xffff_ffff);
    for (parts, whole) in [
        (read, First::SHADER_READ),
        (Mask::SHADER_STORAGE_WRITE, First::SHADER_WRITE),
        (rest & !(read | Mask::SHADER_STORAGE_WRITE), First::MEMORY_READ | First::MEMORY_WRITE),
    ] {
        if rest.intersects(parts) {
            first |= whole;
            rest &= !parts;
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Converted to Vulkan 1.0, each use of the table has stages that fit its accesses, and loses no access.
    #[test]
    fn vulkan_1_0_has_every_use() {
        use vk::{AccessFlags as A, PipelineStageFlags as S};
        let of = |access: Access| {
            (first_stage(access.stage, S::TOP_OF_PIPE), first_access(access.access))
        };
        assert_eq!(of(COMPUTE_SAMPLED), (S::COMPUTE_SHADER, A::SHADER_READ));
        let written = A::SHADER_READ | A::SHADER_WRITE;
        assert_eq!(of(COMPUTE_READ_WRITE), (S::COMPUTE_SHADER, written));
        assert_eq!(of(CLEAR), (S::TRANSFER, A::TRANSFER_WRITE));
        assert_eq!(of(INDIRECT), (S::DRAW_INDIRECT, A::INDIRECT_COMMAND_READ));
        assert_eq!(of(NOTHING), (S::TOP_OF_PIPE, A::empty()));
        let copied = Access::new(Stage::COPY, Mask::TRANSFER_READ, Layout::GENERAL);
        assert_eq!(of(copied), (S::TRANSFER, A::TRANSFER_READ));
        let input = Stage::INDEX_INPUT | Stage::VERTEX_ATTRIBUTE_INPUT | Stage::HOST;
        assert_eq!(first_stage(input, S::empty()), S::VERTEX_INPUT | S::HOST);
        let newer = Stage::from_raw(1 << 45) | Stage::COPY;
        assert_eq!(first_stage(newer, S::empty()), S::TRANSFER | S::ALL_COMMANDS);
        assert_eq!(first_access(Mask::from_raw(1 << 45)), A::MEMORY_READ | A::MEMORY_WRITE);
        let before = Stage::PRE_RASTERIZATION_SHADERS;
        assert_eq!(first_stage(before, S::empty()), S::ALL_GRAPHICS);
    }
}
