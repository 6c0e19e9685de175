//! Pass `lit`: applies the shadows and caustics of water and foam to the host's scene. The result is written to an
//! image, which pass `composite` samples for the view through the water, and to the output.
//!
//! If the host has drawn the scene into the output image itself, the lit image replaces the copy that pass `scene`
//! would make. Which share of a pixel's light comes from the sun is unknown, so the share on level ground is used
//! ([`Light`](crate::Light)).
//! Reads: scene colour and depth, the light's maps, caustics. Writes: lit scene; the whole output.

use ash::vk;

use super::Sunlight;
use crate::composite::way;
use crate::contract::{Config, HostImage};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, Access, COLOR_ATTACHMENT, COMPUTE_SAMPLED, FRAGMENT_SAMPLED};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, no_blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::gpu::target::Target;
use crate::water::Recording;
use crate::water::settings::Shading;

/// Access to the scene's colour.
pub const SCENE_USE: Access = FRAGMENT_SAMPLED;

/// Destination of the lit scene.
pub struct Output {
    /// View of the output.
    pub view: vk::ImageView,
    /// Its image.
    pub image: vk::Image,
    /// All aspects of the image.
    pub aspect: vk::ImageAspectFlags,
    /// Its framebuffer, or null.
    pub target: vk::Framebuffer,
    /// The area of the view within the image.
    pub area: vk::Rect2D,
    /// State of the output image before pass `lit` (`before`), and the state that `composite` expects after it
    /// (`after`).
    pub before: Access,
    pub after: Access,
}

enum Out {
    Raster { pass: vk::RenderPass, pipeline: Pipeline },
    Compute { pipeline: Pipeline },
}

/// The pass.
pub struct Lit {
    /// The lit scene, with the view at its origin.
    target: Target,
    pipeline: Pipeline,
    out: Out,
}

impl Lit {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let target = Target::new(gpu, &desc(config), vk::AttachmentLoadOp::DONT_CARE)?;
        let triangle = |fragment, pass, constants: &[(u32, u32)]| {
            Pipeline::graphics(
                gpu,
                &Graphics {
                    vertex: shader::LIGHT_COVER_VERT,
                    fragment,
                    topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                    pass,
                    blend: &[no_blend()],
                    constants,
                },
            )
        };
        let out = match way(config) {
            Shading::Raster => {
                let format = config.output_format;
                let pass = gpu.color_pass("lit/out", &[format], vk::AttachmentLoadOp::LOAD)?;
                Out::Raster { pipeline: triangle(shader::LIGHT_LIT_OUT_FRAG, pass, &[])?, pass }
            }
            Shading::Compute => {
                Out::Compute { pipeline: Pipeline::compute(gpu, shader::LIGHT_LIT_OUT_COMP, &[])? }
            }
        };
        let (pass, constants) = (target.pass, super::constants(config));
        Ok(Self { pipeline: triangle(shader::LIGHT_LIT_FRAG, pass, &constants)?, target, out })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.target.resize(gpu, &desc(config), retired)
    }

    /// The lit scene.
    pub fn image(&self) -> &Image {
        &self.target.image
    }

    pub fn record(
        &self,
        r: &mut Recording<'_>,
        scene: &HostImage,
        output: &Output,
        sunlight: &Sunlight,
        caustics: &Image,
    ) -> Result<(), Error> {
        let scope = r.begin(c"lit");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let read = FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED);
        gpu.barriers(cmd, &[access::image(self.image(), read.discarded(), COLOR_ATTACHMENT)], &[]);
        let [shadow, thickness, basis, span, whitewater, soap] = sunlight.resources();
        let resources = [
            (0, r.uniforms),
            (1, Resource::Sampled(scene.view, gpu.samplers.linear)),
            (2, r.scene_depth),
            (3, Resource::Sampled(caustics.view, gpu.samplers.nearest)),
            shadow,
            thickness,
            basis,
            span,
            whitewater,
            soap,
        ];
        self.target.begin(gpu, cmd, r.extent.into(), [0.0; 4]);
        r.descriptors.bind(gpu, cmd, &self.pipeline, &resources)?;
        // SAFETY: inside the render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_draw(cmd, 3, 1, 0, 0) };
        gpu.end_pass(cmd);
        let to = [
            access::image(self.image(), COLOR_ATTACHMENT, read),
            access::raw_image(output.image, output.aspect, output.before, output.after),
        ];
        gpu.barriers(cmd, &to, &[]);

        let lit = (1, Resource::Sampled(self.image().view, gpu.samplers.nearest));
        match &self.out {
            Out::Raster { pass, pipeline } => {
                gpu.begin_pass(cmd, *pass, output.target, output.area, [0.0; 4]);
                r.descriptors.bind(gpu, cmd, pipeline, &[(0, r.uniforms), lit])?;
                // SAFETY: as above.
                unsafe { gpu.device.cmd_draw(cmd, 3, 1, 0, 0) };
                gpu.end_pass(cmd);
            }
            Out::Compute { pipeline } => {
                let resources = [(0, r.uniforms), lit, (8, Resource::Storage(output.view))];
                r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
                r.dispatch_over(r.extent, pipeline.local_size);
            }
        }
        // The fluid is drawn over it.
        let over = output.after;
        let out = access::raw_image(output.image, output.aspect, over, over);
        gpu.barriers(cmd, &[out], &[]);
        r.end(scope);
        Ok(())
    }
}

fn desc(config: &Config) -> ImageDesc<'static> {
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::COLOR_ATTACHMENT;
    // Every device can draw to this format and filter it.
    ImageDesc::new("lit", config.extent, vk::Format::R16G16B16A16_SFLOAT, usage)
}
