//! Pass `splat` by quads (Akinci et al. 2013, Sec. 2.1 and 2.2): the paper's own path, with the fixed functions of a
//! GPU. It finds the frontmost particle by a depth test, then sums thickness by blending. A vertex shader builds the
//! quad of each particle, so that no list of quads is stored.
//! Reads: the host's streams, words. Writes: depth bits and attributes of the frontmost particle, thickness.

use ash::vk;

use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COLOR_ATTACHMENT, COMPUTE_SAMPLED, DEPTH_ATTACHMENT};
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pass::{Attachment, Attachments};
use crate::gpu::pipeline::{Graphics, Pipeline, blend, no_blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::Recording;

const FRONT: vk::Format = vk::Format::R32G32_UINT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// Size-dependent state.
struct Targets {
    fronts: Image,
    depth: Image,
    front: Owned<vk::Framebuffer>,
    thickness: Owned<vk::Framebuffer>,
}

impl Targets {
    fn new(gpu: &Gpu, passes: [vk::RenderPass; 2], thickness: &Image) -> Result<Self, Error> {
        use vk::ImageUsageFlags as Usage;
        let extent = thickness.extent;
        let image =
            |name, format, usage| Image::new(gpu, &ImageDesc::new(name, extent, format, usage));
        let fronts =
            image("whitewater/splat/fronts", FRONT, Usage::COLOR_ATTACHMENT | Usage::SAMPLED)?;
        let depth = image("whitewater/splat/depth", DEPTH, Usage::DEPTH_STENCIL_ATTACHMENT)?;
        let [front, sums] = passes;
        let views = [fronts.view, depth.view];
        Ok(Self {
            front: gpu.framebuffer_of("whitewater/splat/front", front, &views, extent)?,
            thickness: gpu.framebuffer(
                "whitewater/splat/thickness",
                sums,
                thickness.view,
                extent,
            )?,
            fronts,
            depth,
        })
    }
}

/// The draws of the pass.
pub struct Quads {
    front_pass: vk::RenderPass,
    thickness_pass: vk::RenderPass,
    /// Pipelines for default and for other particle shapes (glsl/include/whitewater.glsl).
    front: [Pipeline; 2],
    thickness: [Pipeline; 2],
    targets: Targets,
}

impl Quads {
    pub fn new(gpu: &Gpu, thickness: &Image) -> Result<Self, Error> {
        let clear = vk::AttachmentLoadOp::CLEAR;
        let attachment = |format, store| Attachment {
            format,
            samples: vk::SampleCountFlags::TYPE_1,
            load: clear,
            store,
        };
        let attachments = Attachments {
            color: Some(attachment(FRONT, vk::AttachmentStoreOp::STORE)),
            depth: Some(attachment(DEPTH, vk::AttachmentStoreOp::DONT_CARE)),
            ..Attachments::default()
        };
        let front_pass = gpu.render_pass("whitewater/splat/front", &attachments)?;
        let thickness_pass =
            gpu.color_pass("whitewater/splat/thickness", &[thickness.format], clear)?;
        let graphics = |fragment, pass: vk::RenderPass, blend: &[_], passes| {
            let shaped = |shaped: u32| {
                let desc = Graphics {
                    vertex: shader::WHITEWATER_SPLAT_VERT,
                    fragment,
                    topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                    pass,
                    blend,
                    constants: &[(3, shaped)],
                };
                Pipeline::tested(gpu, &desc, passes)
            };
            Ok::<_, Error>([shaped(0)?, shaped(1)?])
        };
        Ok(Self {
            front: graphics(
                shader::WHITEWATER_SPLAT_FRONT_FRAG,
                front_pass,
                &[no_blend()],
                Some(vk::CompareOp::GREATER),
            )?,
            thickness: graphics(
                shader::WHITEWATER_SPLAT_THICKNESS_FRAG,
                thickness_pass,
                &[blend(vk::BlendOp::ADD)],
                None,
            )?,
            targets: Targets::new(gpu, [front_pass, thickness_pass], thickness)?,
            front_pass,
            thickness_pass,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        thickness: &Image,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let new = Targets::new(gpu, [self.front_pass, self.thickness_pass], thickness)?;
        let old = &mut self.targets;
        retired.replace(&mut old.front, new.front);
        retired.replace(&mut old.thickness, new.thickness);
        retired.replace(&mut old.fronts, new.fronts);
        retired.replace(&mut old.depth, new.depth);
        Ok(())
    }

    /// Depth bits (all ones if there is none) and attributes of each pixel's frontmost particle. The image is a
    /// colour attachment after `record`.
    pub fn fronts(&self) -> &Image {
        &self.targets.fronts
    }

    /// Records both draws of quads. `thickness` is the barrier that makes the thickness image a colour attachment.
    /// `draw` draws all particles with the pipeline that it is given.
    pub fn record(
        &self,
        r: &Recording<'_>,
        thickness: vk::ImageMemoryBarrier2<'static>,
        draw: impl Fn(&Pipeline) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let Targets { fronts, depth, .. } = &self.targets;
        let before = [
            access::image(fronts, COMPUTE_SAMPLED.discarded(), COLOR_ATTACHMENT),
            access::image(depth, DEPTH_ATTACHMENT.discarded(), DEPTH_ATTACHMENT),
            thickness,
        ];
        gpu.barriers(cmd, &before, &[]);
        let nothing = [
            vk::ClearValue { color: vk::ClearColorValue { uint32: [u32::MAX; 4] } },
            vk::ClearValue::default(),
        ];
        let targets = &self.targets;
        let passes = [
            (self.front_pass, &targets.front, &nothing[..], &self.front),
            (self.thickness_pass, &targets.thickness, &nothing[1..], &self.thickness),
        ];
        for (pass, framebuffer, clears, pipeline) in passes {
            let area = r.extent.into();
            gpu.begin_pass_with(cmd, pass, framebuffer.handle, area, clears);
            let drawn = draw(&pipeline[usize::from(r.shaped)]);
            gpu.end_pass(cmd);
            drawn?;
        }
        Ok(())
    }

    /// Bytes of images.
    pub fn memory(&self) -> u64 {
        self.targets.fronts.size + self.targets.depth.size
    }
}
