//! The environment that the water reflects: a picture or the built-in sky.

use ash::vk;

use super::Headless;
use super::transfer::staging;
use crate::contract::{HostImage, Slot};
use crate::environment::{EnvironmentSource, Equirectangular, Sky};
use crate::error::Error;
use crate::gpu::access::{self, COPY_WRITE};
use crate::gpu::graveyard::Destroy;
use crate::gpu::image::{Image, ImageDesc};

impl Headless {
    /// The built-in sky as environment.
    ///
    /// # Errors
    /// What Vulkan reports.
    pub fn sky(&mut self, sky: &Sky) -> Result<(), Error> {
        let source = EnvironmentSource::Sky(*sky);
        self.forget_scene();
        self.run(|this, cmd| {
            // SAFETY: cmd is recording; the slot's earlier work is done (every run waits).
            unsafe { this.renderer.record_environment(cmd, Slot(0), &source) }
        })
    }

    /// An equirectangular picture as environment: linear RGBA, row 0 up.
    ///
    /// # Errors
    /// A picture larger than the device's images may be, no memory, and what Vulkan reports.
    pub fn equirectangular(
        &mut self,
        extent: vk::Extent2D,
        pixels: &[[f32; 4]],
        scale: f32,
        turn: f32,
    ) -> Result<(), Error> {
        self.forget_scene();
        let most = self.gpu.limits.max_image_dimension2_d;
        if extent.width > most || extent.height > most {
            let found = format!("{}x{}", extent.width, extent.height);
            let why =
                format!("expected at most {most}x{most} texels on this device, found {found}");
            return Err(Error::bad("Equirectangular.image.extent", why));
        }
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let image =
            Image::new(&self.gpu, &ImageDesc::new("headless/equirect", extent, format, usage))?;
        let staging = staging(&self.gpu, bytemuck::cast_slice(pixels))?;
        let result = self.run(|this, cmd| {
            this.upload(cmd, &staging, &image, access::NOTHING, COPY_WRITE);
            let host = HostImage {
                image: image.handle,
                view: image.view,
                format,
                aspect: vk::ImageAspectFlags::COLOR,
                extent,
                rect: extent.into(),
                before: COPY_WRITE,
                after: access::COMPUTE_SAMPLED,
            };
            let source =
                EnvironmentSource::Equirectangular(Equirectangular { image: host, scale, turn });
            // SAFETY: as in `sky`.
            unsafe { this.renderer.record_environment(cmd, Slot(0), &source) }
        });
        staging.destroy(&self.gpu);
        image.destroy(&self.gpu);
        result
    }
}
