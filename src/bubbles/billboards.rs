//! Pass `peel` by billboards (Huszár, Szécsi, Sec. 5): depth peeling (Everitt 2001). All blobs are drawn once per
//! layer, keeping only fragments behind the previous layer, and once more for the maximum opacity.
//!
//! Reads: blobs, scene depth, impostors. Writes: layers, bubble depth.

use ash::vk;

use super::settings::BubbleConfig;
use super::templates::Templates;
use crate::contract::Config;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_SAMPLED, COMPUTE_WRITE, DEPTH_ATTACHMENT,
    FRAGMENT_SAMPLED, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Resource, bind_set};
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pass::{Attachment, Attachments};
use crate::gpu::pipeline::{Graphics, Pipeline, blend, no_blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::Recording;

const LAYER: vk::Format = vk::Format::R32G32_UINT;
const OPACITY: vk::Format = vk::Format::R16_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// Access to a drawn layer: by the next layer, and to store it.
const READ: Access = COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED);

/// Size-dependent state.
struct Targets {
    /// The previous layer and this one, alternating.
    layers: [Image; 2],
    depth: Image,
    opacity: Image,
    layer_targets: [Owned<vk::Framebuffer>; 2],
    opacity_target: Owned<vk::Framebuffer>,
}

impl Targets {
    fn new(
        gpu: &Gpu,
        extent: vk::Extent2D,
        layer_pass: vk::RenderPass,
        opacity_pass: vk::RenderPass,
    ) -> Result<Self, Error> {
        use vk::ImageUsageFlags as Usage;
        let image =
            |name, format, usage| Image::new(gpu, &ImageDesc::new(name, extent, format, usage));
        let drawn = Usage::COLOR_ATTACHMENT | Usage::SAMPLED;
        let layers =
            [image("bubbles/peel/even", LAYER, drawn)?, image("bubbles/peel/odd", LAYER, drawn)?];
        let depth = image("bubbles/peel/depth", DEPTH, Usage::DEPTH_STENCIL_ATTACHMENT)?;
        let opacity = image("bubbles/peel/opacity", OPACITY, drawn)?;
        let target = |layer: &Image| {
            let views = [layer.view, depth.view];
            gpu.framebuffer_of("bubbles/peel/layer", layer_pass, &views, extent)
        };
        let name = "bubbles/peel/opacity";
        Ok(Self {
            layer_targets: [target(&layers[0])?, target(&layers[1])?],
            opacity_target: gpu.framebuffer(name, opacity_pass, opacity.view, extent)?,
            layers,
            depth,
            opacity,
        })
    }
}

/// The draws.
pub struct Billboards {
    layer_pass: vk::RenderPass,
    opacity_pass: vk::RenderPass,
    layer: Pipeline,
    opacity: Pipeline,
    keep: Pipeline,
    targets: Targets,
    layers: u32,
}

impl Billboards {
    pub fn new(gpu: &Gpu, config: &Config, bubbles: &BubbleConfig) -> Result<Self, Error> {
        let clear = vk::AttachmentLoadOp::CLEAR;
        let attachment = |format, store| Attachment {
            format,
            samples: vk::SampleCountFlags::TYPE_1,
            load: clear,
            store,
        };
        let attachments = Attachments {
            color: Some(attachment(LAYER, vk::AttachmentStoreOp::STORE)),
            depth: Some(attachment(DEPTH, vk::AttachmentStoreOp::DONT_CARE)),
            ..Attachments::default()
        };
        let layer_pass = gpu.render_pass("bubbles/peel/layer", &attachments)?;
        let opacity_pass = gpu.color_pass("bubbles/peel/opacity", &[OPACITY], clear)?;
        let constants = Templates::constants(bubbles);
        let graphics = |fragment, pass: vk::RenderPass, blend: &[_], passes| {
            let desc = Graphics {
                vertex: shader::BUBBLES_PEEL_VERT,
                fragment,
                topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                pass,
                blend,
                constants: &constants,
            };
            Pipeline::tested(gpu, &desc, passes)
        };
        let less = Some(vk::CompareOp::LESS);
        let (layer_frag, opacity_frag) =
            (shader::BUBBLES_PEEL_FRAG, shader::BUBBLES_PEEL_OPACITY_FRAG);
        let layers = [(0, bubbles.layers)];
        let kept = [&layers[..], &constants].concat();
        Ok(Self {
            layer: graphics(layer_frag, layer_pass, &[no_blend()], less)?,
            opacity: graphics(opacity_frag, opacity_pass, &[blend(vk::BlendOp::MAX)], None)?,
            keep: Pipeline::compute(gpu, shader::BUBBLES_PEEL_KEEP_COMP, &kept)?,
            targets: Targets::new(gpu, config.extent, layer_pass, opacity_pass)?,
            layer_pass,
            opacity_pass,
            layers: bubbles.layers,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let passes = [self.layer_pass, self.opacity_pass];
        let new = Targets::new(gpu, config.extent, passes[0], passes[1])?;
        let old = &mut self.targets;
        for (old, new) in old.layer_targets.iter_mut().zip(new.layer_targets) {
            retired.replace(old, new);
        }
        retired.replace(&mut old.opacity_target, new.opacity_target);
        for (old, new) in old.layers.iter_mut().zip(new.layers) {
            retired.replace(old, new);
        }
        retired.replace(&mut old.depth, new.depth);
        retired.replace(&mut old.opacity, new.opacity);
        Ok(())
    }

    /// Records pass `peel` by billboards for `count` blobs with the resources `bound`. `kept` are the buffer of the
    /// pixels' layers and the image of the blobs' depth, which the pass writes. Both must be in the compute-write
    /// state, and are in the same state after the pass.
    pub fn record(
        &self,
        r: &Recording<'_>,
        count: u32,
        bound: &[(u32, Resource)],
        kept: (&Buffer, &Image),
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let Targets { layers, depth, opacity, .. } = &self.targets;
        let sampled = |image: &Image| Resource::Sampled(image.view, gpu.samplers.nearest);
        let nothing = [
            vk::ClearValue { color: vk::ClearColorValue { uint32: [u32::MAX; 4] } },
            vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: 1.0, stencil: 0 } },
        ];
        let none = [vk::ClearValue::default()];
        // These are bound before anything was drawn to them, but not read.
        let unread = [&layers[1], opacity].map(|i| access::image(i, READ.discarded(), READ));
        gpu.barriers(cmd, &unread, &[]);
        for number in 0..=self.layers {
            let (own, other) = ((number % 2) as usize, (1 - number % 2) as usize);
            let peels = number < self.layers;
            let drawn = if peels { &layers[own] } else { opacity };
            let mut before = vec![access::image(drawn, READ.discarded(), COLOR_ATTACHMENT)];
            if peels {
                before.push(access::image(depth, DEPTH_ATTACHMENT.discarded(), DEPTH_ATTACHMENT));
            }
            gpu.barriers(cmd, &before, &[]);
            let resources = [bound, &[(4, sampled(&layers[other]))]].concat();
            let (pass, target, pipeline, clears) = if peels {
                (self.layer_pass, &self.targets.layer_targets[own], &self.layer, &nothing[..])
            } else {
                (self.opacity_pass, &self.targets.opacity_target, &self.opacity, &none[..])
            };
            let set = r.descriptors.set(gpu, pipeline, &resources)?;
            gpu.begin_pass_with(cmd, pass, target.handle, r.extent.into(), clears);
            pipeline.bind(gpu, cmd);
            bind_set(gpu, cmd, pipeline, set);
            if peels {
                pipeline.push(gpu, cmd, &number);
            }
            // SAFETY: inside the render pass; pipeline and set are bound.
            unsafe { gpu.device.cmd_draw(cmd, 4, count, 0, 0) };
            gpu.end_pass(cmd);
            gpu.barriers(cmd, &[access::image(drawn, COLOR_ATTACHMENT, READ)], &[]);
            // A validation layer assumes that all dispatches may write the same texels.
            let (written, front) = kept;
            gpu.barriers(
                cmd,
                &[access::image(front, COMPUTE_WRITE, COMPUTE_WRITE)],
                &[buffer(written.handle, COMPUTE_WRITE, COMPUTE_WRITE)],
            );
            let layer = if peels { drawn } else { &layers[other] };
            let resources = [bound, &[(4, sampled(layer)), (5, sampled(opacity))]].concat();
            r.descriptors.bind(gpu, cmd, &self.keep, &resources)?;
            self.keep.push(gpu, cmd, &number);
            r.dispatch_over(r.extent, self.keep.local_size);
        }
        Ok(())
    }

    /// Bytes of images.
    pub fn memory(&self) -> u64 {
        let Targets { layers, depth, opacity, .. } = &self.targets;
        layers.iter().map(|image| image.size).sum::<u64>() + depth.size + opacity.size
    }
}
