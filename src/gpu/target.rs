//! An image with a render pass that draws only to it.

use ash::vk;

use super::Gpu;
use super::graveyard::Owned;
use super::image::{Image, ImageDesc};
use super::retire::RetireList;
use crate::error::Error;

/// The image, its pass and its framebuffer.
pub struct Target {
    /// The image.
    pub image: Image,
    /// The pass, for pipelines.
    pub pass: vk::RenderPass,
    framebuffer: Owned<vk::Framebuffer>,
}

impl Target {
    /// Creates image, pass and framebuffer. `load` is the load operation of the pass.
    pub fn new(gpu: &Gpu, desc: &ImageDesc<'_>, load: vk::AttachmentLoadOp) -> Result<Self, Error> {
        let image = Image::new(gpu, desc)?;
        let pass = gpu.color_pass(desc.name, &[desc.format], load)?;
        let framebuffer = gpu.framebuffer(desc.name, pass, image.view, image.extent)?;
        Ok(Self { image, pass, framebuffer })
    }

    /// Replaces the image by one of another size.
    pub fn resize(
        &mut self,
        gpu: &Gpu,
        desc: &ImageDesc<'_>,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let image = Image::new(gpu, desc)?;
        let framebuffer = gpu.framebuffer(desc.name, self.pass, image.view, image.extent)?;
        retired.replace(&mut self.framebuffer, framebuffer);
        retired.replace(&mut self.image, image);
        Ok(())
    }

    /// Begins the pass over an area; the image is in COLOR_ATTACHMENT_OPTIMAL.
    pub fn begin(&self, gpu: &Gpu, cmd: vk::CommandBuffer, area: vk::Rect2D, clear: [f32; 4]) {
        gpu.begin_pass(cmd, self.pass, self.framebuffer.handle, area, clear);
    }
}
