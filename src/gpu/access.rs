//! Barriers: a short table of named uses, and two helpers. There is no tracker: the order of the passes is
//! fixed, so every barrier is written where it is needed, from the previous use to the next one, with stages,
//! access *and* layout.

use ash::vk;

use super::Gpu;
use super::image::{Image, aspect_of};

/// How an image or buffer is used at one point of a command buffer.
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

    /// The same stages, with contents discarded: for the first write in a frame, which has to wait for the last
    /// use in the previous frame and overwrites the whole image.
    pub const fn discarded(self) -> Self {
        // Only execution must be ordered after reads; after writes the access mask is needed too.
        Self { stage: self.stage, access: self.access, layout: Layout::UNDEFINED }
    }
}

/// Compute shader: sampled image.
pub const COMPUTE_SAMPLED: Access =
    Access::new(Stage::COMPUTE_SHADER, Mask::SHADER_SAMPLED_READ, Layout::SHADER_READ_ONLY_OPTIMAL);
/// Fragment shader: sampled image.
pub const FRAGMENT_SAMPLED: Access = Access::new(
    Stage::FRAGMENT_SHADER,
    Mask::SHADER_SAMPLED_READ,
    Layout::SHADER_READ_ONLY_OPTIMAL,
);
/// Compute shader: storage image or buffer, read.
pub const COMPUTE_READ: Access =
    Access::new(Stage::COMPUTE_SHADER, Mask::SHADER_STORAGE_READ, Layout::GENERAL);
/// Compute shader: storage image or buffer, written.
pub const COMPUTE_WRITE: Access =
    Access::new(Stage::COMPUTE_SHADER, Mask::SHADER_STORAGE_WRITE, Layout::GENERAL);
/// Compute shader: storage image or buffer, read and written (atomics).
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
/// Vertex shader: sampled image.
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
/// Colour attachment, read (load, blend) and written.
pub const COLOR_ATTACHMENT: Access = Access::new(
    Stage::COLOR_ATTACHMENT_OUTPUT,
    Mask::from_raw(Mask::COLOR_ATTACHMENT_READ.as_raw() | Mask::COLOR_ATTACHMENT_WRITE.as_raw()),
    Layout::COLOR_ATTACHMENT_OPTIMAL,
);
/// Depth attachment, tested and written.
pub const DEPTH_ATTACHMENT: Access = Access::new(
    Stage::from_raw(Stage::EARLY_FRAGMENT_TESTS.as_raw() | Stage::LATE_FRAGMENT_TESTS.as_raw()),
    Mask::from_raw(
        Mask::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | Mask::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    Layout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
);
/// Written by a clear or fill. ALL_TRANSFER, not CLEAR: layers before 1.3.240 book fills as copies.
pub const CLEAR: Access =
    Access::new(Stage::ALL_TRANSFER, Mask::TRANSFER_WRITE, Layout::TRANSFER_DST_OPTIMAL);
/// Source of a copy or blit.
pub const COPY_READ: Access =
    Access::new(Stage::ALL_TRANSFER, Mask::TRANSFER_READ, Layout::TRANSFER_SRC_OPTIMAL);
/// Destination of a copy or blit.
pub const COPY_WRITE: Access = CLEAR;
/// Nothing before: the contents are undefined and nobody uses them.
pub const NOTHING: Access = Access::new(Stage::NONE, Mask::NONE, Layout::UNDEFINED);

/// A barrier over the whole of an own image.
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
    /// Records one dependency of the barriers given.
    pub fn barriers(
        &self,
        cmd: vk::CommandBuffer,
        images: &[vk::ImageMemoryBarrier2<'_>],
        buffers: &[vk::BufferMemoryBarrier2<'_>],
    ) {
        let info = vk::DependencyInfo::default()
            .image_memory_barriers(images)
            .buffer_memory_barriers(buffers);
        // SAFETY: cmd is recording (contract); the handles live in their owners, which outlive
        // the slot (retire list).
        unsafe { self.device.cmd_pipeline_barrier2(cmd, &info) };
    }
}
