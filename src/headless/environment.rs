//! The environment that the water reflects: a picture or the built-in sky.

use ash::vk;

use super::Headless;
use super::transfer::{check_texels, staging};
use crate::contract::{HostImage, Slot};
use crate::environment::{Environment, EnvironmentSource, Equirectangular, Sky};
use crate::error::Error;
use crate::gpu::access;
use crate::gpu::descriptors::Descriptors;
use crate::gpu::graveyard::Destroy;
use crate::gpu::image::{Image, ImageDesc};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// A picture in the form that a host passes.
fn host(image: &Image) -> HostImage {
    HostImage {
        image: image.handle,
        view: image.view,
        format: image.format,
        aspect: vk::ImageAspectFlags::COLOR,
        extent: image.extent,
        rect: image.extent.into(),
        before: access::COMPUTE_SAMPLED,
        after: access::COMPUTE_SAMPLED,
    }
}

/// Max number of descriptor sets for creating an environment.
const SETS: u32 = 2;

impl Headless {
    /// Sets the built-in sky as environment.
    ///
    /// # Errors
    /// A value of `sky` outside its range; Vulkan errors.
    pub fn sky(&mut self, sky: &Sky) -> Result<(), Error> {
        let source = EnvironmentSource::Sky(*sky);
        source.check()?;
        self.forget_scene();
        self.without_sun = None;
        self.record_environment(&source)
    }

    /// Records an environment and waits for it.
    fn record_environment(&mut self, source: &EnvironmentSource) -> Result<(), Error> {
        self.run(|this, cmd| {
            // SAFETY: cmd is recording; the slot's earlier work is done (every run waits).
            unsafe {
                this.renderer.collect(Slot(0));
                this.renderer.record_environment(cmd, Slot(0), source)
            }
        })
    }

    /// Sets an equirectangular image as environment: linear RGBA, row by row, the top row first. `scale` multiplies its
    /// radiance, and `turn` rotates it around the up direction, +y, in radians, as in [`Equirectangular`].
    ///
    /// # Errors
    /// The number of texels differs from `extent`; the picture exceeds the device's limit of image size; `scale` or
    /// `turn` is out of range; there is no memory for the picture; Vulkan errors.
    pub fn equirectangular(
        &mut self,
        extent: vk::Extent2D,
        pixels: &[[f32; 4]],
        scale: f32,
        turn: f32,
    ) -> Result<(), Error> {
        self.pictures(extent, pixels, None, (scale, turn))
    }

    /// Sets two equirectangular images as environment: `pixels` with the sun, and `without_sun`, the same image
    /// without it. Use it if the scene and [`Light`](crate::Light) describe the same sun, which would otherwise count
    /// twice. The image with the sun is seen as the sky and in the reflections of the particles' water. The image
    /// without it gives the environment's diffuse light on everything, and its reflections on the scene.
    ///
    /// # Errors
    /// Those of [`equirectangular`](Self::equirectangular); also if `pixels` and `without_sun` differ in length.
    pub fn equirectangular_with_sun(
        &mut self,
        extent: vk::Extent2D,
        pixels: &[[f32; 4]],
        without_sun: &[[f32; 4]],
        (scale, turn): (f32, f32),
    ) -> Result<(), Error> {
        if pixels.len() != without_sun.len() {
            let (expected, found) = (pixels.len(), without_sun.len());
            let why = format!("expected {expected} texels like the other picture, found {found}");
            return Err(Error::bad("Equirectangular.without_sun", why));
        }
        self.pictures(extent, pixels, Some(without_sun), (scale, turn))
    }

    fn pictures(
        &mut self,
        extent: vk::Extent2D,
        pixels: &[[f32; 4]],
        without_sun: Option<&[[f32; 4]]>,
        (scale, turn): (f32, f32),
    ) -> Result<(), Error> {
        check_texels(&self.gpu, "Equirectangular.image", extent, pixels.len())?;
        let shown = self.picture("headless/equirect", extent, pixels)?;
        let lights = without_sun
            .map(|pixels| self.picture("headless/equirect/without sun", extent, pixels))
            .transpose()?;
        let up = [0.0, 1.0, 0.0];
        let of = |image| Equirectangular { image, without_sun: None, scale, turn, up };
        let made = self.of_pictures(of, &shown, lights.as_ref());
        // The device has finished with them, or is lost.
        drop((shown, lights));
        self.gpu.bury();
        made
    }

    fn of_pictures(
        &mut self,
        of: impl Fn(HostImage) -> Equirectangular,
        shown: &Image,
        lights: Option<&Image>,
    ) -> Result<(), Error> {
        let map = Equirectangular { without_sun: lights.map(host), ..of(host(shown)) };
        let source = EnvironmentSource::Equirectangular(map);
        source.check()?;
        let mut without_sun = None;
        if let Some(lights) = lights {
            let mut own = Environment::new(&self.gpu, self.renderer.config())?;
            let descriptors = Descriptors::new(&self.gpu, SETS)?;
            let source = EnvironmentSource::Equirectangular(of(host(lights)));
            self.run(|this, cmd| {
                own.record_setup(&this.gpu, cmd);
                own.record(&this.gpu, cmd, &descriptors, &source)
            })?;
            without_sun = Some(own);
        }
        self.forget_scene();
        self.record_environment(&source)?;
        self.without_sun = without_sun;
        Ok(())
    }

    /// A picture on the device, uploaded.
    fn picture(
        &mut self,
        name: &'static str,
        extent: vk::Extent2D,
        pixels: &[[f32; 4]],
    ) -> Result<Image, Error> {
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let image = Image::new(&self.gpu, &ImageDesc::new(name, extent, FORMAT, usage))?;
        let staging = staging(&self.gpu, bytemuck::cast_slice(pixels))?;
        let uploaded = self.run(|this, cmd| {
            this.upload(cmd, &staging, &image, access::NOTHING, access::COMPUTE_SAMPLED);
            Ok(())
        });
        staging.destroy(&self.gpu);
        uploaded.map(|()| image)
    }
}
