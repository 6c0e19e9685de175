//! Render passes of one subpass, and their framebuffers. Every attachment has the same layout before, in and after
//! its pass, so layouts change only at explicit barriers.

use ash::vk;

use super::Gpu;
use super::access::{CLEAR, whole};
use super::graveyard::{Grave, Owned};
use super::image::Image;
use crate::error::{Error, VkContext};

/// One attachment.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Attachment {
    /// Format.
    pub format: vk::Format,
    /// Number of samples per texel.
    pub samples: vk::SampleCountFlags,
    /// Load operation at the beginning of the pass.
    pub load: vk::AttachmentLoadOp,
    /// Store operation at its end.
    pub store: vk::AttachmentStoreOp,
}

/// Attachments of a pass. The views of a framebuffer and the clear values are in the order of these fields; fields
/// that are `None` are skipped.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Attachments {
    /// Colour attachment in COLOR_ATTACHMENT_OPTIMAL.
    pub color: Option<Attachment>,
    /// A second colour attachment.
    pub second: Option<Attachment>,
    /// Depth attachment in DEPTH_STENCIL_ATTACHMENT_OPTIMAL.
    pub depth: Option<Attachment>,
    /// Resolve attachment for the samples of `color`, in COLOR_ATTACHMENT_OPTIMAL.
    pub resolve: Option<Attachment>,
}

impl Gpu {
    /// A render pass, which the context creates once for each name and attachments.
    pub fn render_pass(
        &self,
        name: &str,
        attachments: &Attachments,
    ) -> Result<vk::RenderPass, Error> {
        self.passes.get((name.into(), *attachments), || self.make_pass(name, attachments))
    }

    fn make_pass(&self, name: &str, attachments: &Attachments) -> Result<vk::RenderPass, Error> {
        let color = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
        let depth = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        let mut descriptions = Vec::with_capacity(4);
        let mut add = |attachment: &Option<Attachment>, layout| {
            attachment.map(|attachment| {
                descriptions.push(
                    vk::AttachmentDescription::default()
                        .format(attachment.format)
                        .samples(attachment.samples)
                        .load_op(attachment.load)
                        .store_op(attachment.store)
                        .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
                        .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
                        .initial_layout(layout)
                        .final_layout(layout),
                );
                vk::AttachmentReference { attachment: descriptions.len() as u32 - 1, layout }
            })
        };
        let color_references: Vec<_> = [&attachments.color, &attachments.second]
            .into_iter()
            .filter_map(|attachment| add(attachment, color))
            .collect();
        let depth_reference = add(&attachments.depth, depth);
        let resolve_reference = add(&attachments.resolve, color);
        let mut subpass = vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&color_references);
        if let Some(reference) = &depth_reference {
            subpass = subpass.depth_stencil_attachment(reference);
        }
        if resolve_reference.is_some() {
            subpass = subpass.resolve_attachments(resolve_reference.as_slice());
        }
        let subpasses = [subpass];
        let info =
            vk::RenderPassCreateInfo::default().attachments(&descriptions).subpasses(&subpasses);
        // SAFETY: valid create info.
        let pass = unsafe { self.device.create_render_pass(&info, None) }
            .context(|| format!("vkCreateRenderPass {name}"))?;
        self.name(pass, name);
        Ok(pass)
    }

    /// A render pass with one or two colour attachments, whose contents are stored at its end.
    pub fn color_pass(
        &self,
        name: &str,
        formats: &[vk::Format],
        load: vk::AttachmentLoadOp,
    ) -> Result<vk::RenderPass, Error> {
        let samples = vk::SampleCountFlags::TYPE_1;
        let store = vk::AttachmentStoreOp::STORE;
        let at =
            |i: usize| formats.get(i).map(|&format| Attachment { format, samples, load, store });
        let (color, second) = (at(0), at(1));
        self.render_pass(name, &Attachments { color, second, ..Attachments::default() })
    }

    /// A framebuffer with one view.
    pub fn framebuffer(
        &self,
        name: &str,
        pass: vk::RenderPass,
        view: vk::ImageView,
        extent: vk::Extent2D,
    ) -> Result<Owned<vk::Framebuffer>, Error> {
        self.framebuffer_of(name, pass, &[view], extent)
    }

    /// A framebuffer with the views of a pass.
    pub fn framebuffer_of(
        &self,
        name: &str,
        pass: vk::RenderPass,
        views: &[vk::ImageView],
        extent: vk::Extent2D,
    ) -> Result<Owned<vk::Framebuffer>, Error> {
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(pass)
            .attachments(views)
            .width(extent.width)
            .height(extent.height)
            .layers(1);
        // SAFETY: pass and views fit each other (checked formats).
        let framebuffer = unsafe { self.device.create_framebuffer(&info, None) }
            .context(|| format!("vkCreateFramebuffer {name}"))?;
        self.name(framebuffer, name);
        Ok(self.own(framebuffer, Grave::Framebuffer))
    }

    /// Begins a colour pass over an area, and sets viewport and scissor to this area. `clear` is the value of all
    /// attachments that the pass clears.
    pub fn begin_pass(
        &self,
        cmd: vk::CommandBuffer,
        pass: vk::RenderPass,
        framebuffer: vk::Framebuffer,
        area: vk::Rect2D,
        clear: [f32; 4],
    ) {
        let clear = vk::ClearValue { color: vk::ClearColorValue { float32: clear } };
        self.begin_pass_with(cmd, pass, framebuffer, area, &[clear, clear]);
    }

    /// Begins a pass with any attachments over an area, and sets viewport and scissor to this area. `clears` has a
    /// value for each attachment.
    pub fn begin_pass_with(
        &self,
        cmd: vk::CommandBuffer,
        pass: vk::RenderPass,
        framebuffer: vk::Framebuffer,
        area: vk::Rect2D,
        clears: &[vk::ClearValue],
    ) {
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(pass)
            .framebuffer(framebuffer)
            .render_area(area)
            .clear_values(clears);
        let viewport = vk::Viewport {
            x: area.offset.x as f32,
            y: area.offset.y as f32,
            width: area.extent.width as f32,
            height: area.extent.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: cmd is recording outside a render pass; the objects are alive.
        unsafe {
            self.device.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
            self.device.cmd_set_viewport(cmd, 0, &[viewport]);
            self.device.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// Clears a whole colour image to one value, outside a pass; the image is in [`CLEAR`](super::access::CLEAR).
    pub fn clear_color(&self, cmd: vk::CommandBuffer, image: &Image, value: [f32; 4]) {
        let value = vk::ClearColorValue { float32: value };
        let all = [whole(vk::ImageAspectFlags::COLOR)];
        // SAFETY: cmd is recording outside a render pass; the image is in the layout.
        unsafe {
            self.device.cmd_clear_color_image(cmd, image.handle, CLEAR.layout, &value, &all);
        }
    }

    /// Ends the current pass.
    pub fn end_pass(&self, cmd: vk::CommandBuffer) {
        // SAFETY: cmd is recording inside a render pass.
        unsafe { self.device.cmd_end_render_pass(cmd) };
    }
}

/// The clear value of a depth attachment.
pub fn clear_depth(depth: f32) -> vk::ClearValue {
    vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 } }
}
