//! Draws the colour: meshes, then the sky where there are none. With several samples per pixel the pass has
//! its own depth buffer and is resolved; with one sample it uses the depth of the depth pass.

use ash::vk;

use super::super::Scene;
use super::super::bake::Batch;
use super::meshes::Meshes;
use super::opaque::DepthOnly;
use super::sky::Sky;
use super::targets::{Samples, Targets};
use super::textures::Textures;
use super::{Formats, Recording, SceneFrame, sea};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COLOR_ATTACHMENT, DEPTH_ATTACHMENT};
use crate::gpu::graveyard::Owned;
use crate::gpu::image::Image;
use crate::gpu::pass::{Attachment, Attachments, clear_depth};

/// Samples per pixel with smooth edges, if the device supports them.
const MANY: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_4;
const ONE: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_1;

pub struct Color {
    /// Samples per pixel.
    pub samples: vk::SampleCountFlags,
    pass: vk::RenderPass,
    /// Draws the depth of the samples before their colour, if there are several.
    first: Option<DepthOnly>,
    /// The opaque meshes and the ground.
    pub meshes: Meshes,
    sky: Sky,
}

impl Color {
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        batches: &[Batch],
        textures: &mut Textures,
        formats: Formats,
        antialias: bool,
    ) -> Result<Self, Error> {
        let counts =
            gpu.limits.framebuffer_color_sample_counts & gpu.limits.framebuffer_depth_sample_counts;
        let samples = if antialias && counts.contains(MANY) { MANY } else { ONE };
        let pass = gpu.render_pass("scene/color", &attachments(formats, samples))?;
        let first = match samples {
            ONE => None,
            _ => Some(DepthOnly::colored(gpu, pass, samples)?),
        };
        let meshes = Meshes::new(gpu, scene, batches, textures, pass, samples)?;
        let sky = Sky::new(gpu, pass, samples, sea::kind(scene))?;
        Ok(Self { samples, pass, first, meshes, sky })
    }

    /// `samples` are the multisampled images, if there are any.
    pub fn framebuffer(
        &self,
        gpu: &Gpu,
        frame: &SceneFrame<'_>,
        samples: Option<&Samples>,
    ) -> Result<Owned<vk::Framebuffer>, Error> {
        let views = match samples {
            Some(samples) => vec![samples.color.view, samples.depth.view, frame.color.view],
            None => vec![frame.color.view, frame.depth.view],
        };
        gpu.framebuffer_of("scene/color", self.pass, &views, frame.color.extent)
    }

    /// `depth` is the depth of the frame, drawn before.
    pub fn record(&self, r: &Recording<'_>, targets: &Targets, depth: &Image) -> Result<(), Error> {
        match &targets.samples {
            // Cleared each time: contents of the slot's previous frame are not needed.
            Some(Samples { color, depth }) => {
                let color = access::image(color, COLOR_ATTACHMENT.discarded(), COLOR_ATTACHMENT);
                let depth = access::image(depth, DEPTH_ATTACHMENT.discarded(), DEPTH_ATTACHMENT);
                r.gpu.barriers(r.cmd, &[color, depth], &[]);
            }
            // Tested against the depth of the depth pass.
            None => {
                let depth = access::image(depth, DEPTH_ATTACHMENT, DEPTH_ATTACHMENT);
                r.gpu.barriers(r.cmd, &[depth], &[]);
            }
        }
        // The sky covers everything, so the clear colour does not matter.
        let clears = [vk::ClearValue::default(), clear_depth(r.view.far)];
        r.gpu.begin_pass_with(r.cmd, self.pass, targets.color.handle, r.area, &clears);
        if let Some(first) = &self.first {
            // Depth first, because shading is expensive: only visible fragments are shaded.
            first.draw(r.gpu, r.cmd, r.geometry, r.view, r.geometry.count);
        }
        let drawn = self.meshes.draw(r).and_then(|()| self.sky.draw(r));
        r.gpu.end_pass(r.cmd);
        drawn
    }
}

fn attachments(formats: Formats, samples: vk::SampleCountFlags) -> Attachments {
    use vk::{AttachmentLoadOp as Load, AttachmentStoreOp as Store};
    let color = |samples, load, store| Attachment { format: formats.color, samples, load, store };
    let depth = |load, store| Attachment { format: formats.depth, samples, load, store };
    if samples == ONE {
        Attachments {
            color: Some(color(ONE, Load::CLEAR, Store::STORE)),
            depth: Some(depth(Load::LOAD, Store::STORE)),
            ..Attachments::default()
        }
    } else {
        Attachments {
            color: Some(color(samples, Load::CLEAR, Store::DONT_CARE)),
            depth: Some(depth(Load::CLEAR, Store::DONT_CARE)),
            resolve: Some(color(ONE, Load::DONT_CARE, Store::STORE)),
            ..Attachments::default()
        }
    }
}
