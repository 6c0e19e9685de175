//! Draws the depth that the water is tested against: one sample at each pixel's centre, however many samples the colour
//! has.
//! Reads: vertices. Writes: the whole scene depth.

use ash::vk;

use super::Recording;
use super::opaque::DepthOnly;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::graveyard::Owned;
use crate::gpu::image::Image;
use crate::gpu::pass::{Attachment, Attachments, clear_depth};

pub struct Depth {
    pass: vk::RenderPass,
    pipeline: DepthOnly,
}

impl Depth {
    pub fn new(gpu: &Gpu, format: vk::Format) -> Result<Self, Error> {
        let depth = Attachment {
            format,
            samples: vk::SampleCountFlags::TYPE_1,
            load: vk::AttachmentLoadOp::CLEAR,
            store: vk::AttachmentStoreOp::STORE,
        };
        let attachments = Attachments { depth: Some(depth), ..Attachments::default() };
        let pass = gpu.render_pass("scene/depth", &attachments)?;
        Ok(Self { pipeline: DepthOnly::new(gpu, pass, 0.0)?, pass })
    }

    pub fn framebuffer(&self, gpu: &Gpu, depth: &Image) -> Result<Owned<vk::Framebuffer>, Error> {
        gpu.framebuffer("scene/depth", self.pass, depth.view, depth.extent)
    }

    pub fn record(&self, r: &Recording<'_>, target: vk::Framebuffer) {
        let clears = [clear_depth(r.view.far)];
        r.gpu.begin_pass_with(r.cmd, self.pass, target, r.area, &clears);
        self.pipeline.draw(r.gpu, r.cmd, r.geometry, r.view, r.geometry.count);
        r.gpu.end_pass(r.cmd);
    }
}
