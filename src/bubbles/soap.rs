//! Pass `soap`: shades the films, walls and cores that `peel` has found (Huszár, Szécsi, Sec. 3.1, 4.4, 5).
//!
//! Reads: blobs, layers, templates, environment, irradiance, water depth, thickness, sunlight. Writes: bubbles,
//! premultiplied.

use ash::vk;

use super::lists::Lists;
use super::peel::{AFTER, Peel};
use super::settings::BubbleConfig;
use super::templates::Templates;
use crate::contract::Config;
use crate::environment::Environment;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ, FRAGMENT_SAMPLED};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::{Recording, WaterLayers};

/// The pass.
pub struct Soap {
    pipeline: Pipeline,
    image: Image,
}

impl Soap {
    pub fn new(gpu: &Gpu, config: &Config, bubbles: &BubbleConfig) -> Result<Self, Error> {
        let own = [(0, bubbles.layers)];
        let constants =
            [&own[..], &Templates::constants(bubbles), &crate::light::constants(config)].concat();
        Ok(Self {
            pipeline: Pipeline::compute(gpu, shader::BUBBLES_SOAP_COMP, &constants)?,
            image: Self::image_of(gpu, config)?,
        })
    }

    fn image_of(gpu: &Gpu, config: &Config) -> Result<Image, Error> {
        let usage = vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC;
        let format = vk::Format::R16G16B16A16_SFLOAT;
        Image::new(gpu, &ImageDesc::new("bubbles/soap", config.extent, format, usage))
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let image = Self::image_of(gpu, config)?;
        retired.replace(&mut self.image, image);
        Ok(())
    }

    /// Premultiplied colour, with opacity in A.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// Records the pass. `water` has the images of the water's depth and thickness. Both must be in the state
    /// `FRAGMENT_SAMPLED`, and are in it again after the pass.
    pub fn record(
        &self,
        r: &Recording<'_>,
        (lists, peel, templates): (&Lists, &Peel, &Templates),
        environment: &Environment,
        water: &WaterLayers<'_>,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let before = AFTER.and(COPY_READ).discarded();
        let read = [water.depth, water.thickness];
        let over = |from, to| read.map(|image| access::image(image, from, to));
        let [depth, thickness] = over(FRAGMENT_SAMPLED, COMPUTE_SAMPLED);
        let own = access::image(&self.image, before, COMPUTE_WRITE);
        gpu.barriers(cmd, &[own, depth, thickness], &[]);
        let linear = |image: &Image| Resource::Sampled(image.view, gpu.samplers.linear);
        let [shadow, light_thickness, basis, span, cast, soap] = r.sunlight.resources();
        let own = [
            (0, r.uniforms),
            (1, r.bubbles),
            (2, Resource::Sampled(water.depth.view, gpu.samplers.nearest)),
            (3, Resource::buffer(lists.buffers()[0])),
            (4, Resource::buffer(peel.layers())),
            (5, linear(&templates.table)),
            (6, linear(&templates.picture)),
            (7, Resource::Sampled(environment.levels.handle, gpu.samplers.linear)),
            (11, linear(&environment.irradiance)),
            (12, Resource::storage(&self.image)),
            (14, Resource::Sampled(water.thickness.view, gpu.samplers.nearest)),
            shadow,
            light_thickness,
            basis,
            span,
            cast,
            soap,
        ];
        let resources = [&own[..], &templates.resources(gpu)].concat();
        r.descriptors.bind(gpu, cmd, &self.pipeline, &resources)?;
        r.dispatch_over(r.extent, self.pipeline.local_size);
        let [depth, thickness] = over(COMPUTE_SAMPLED, FRAGMENT_SAMPLED);
        gpu.barriers(
            cmd,
            &[access::image(&self.image, COMPUTE_WRITE, AFTER), depth, thickness],
            &[],
        );
        Ok(())
    }
}
