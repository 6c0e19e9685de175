//! Framebuffers of one slot (a frame in flight). The depth pass draws to the frame's depth image, the colour
//! pass to the frame's colour image. If edges are smoothed, the colour pass draws to multisampled images of
//! the slot, which are resolved to the frame's colour image.

use ash::vk;

use super::SceneFrame;
use super::color::Color;
use super::depth::Depth;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};

pub struct Targets {
    pub depth: Owned<vk::Framebuffer>,
    pub color: Owned<vk::Framebuffer>,
    pub samples: Option<Samples>,
}

impl Targets {
    /// Creates the framebuffers of a slot for one recorded frame; the next frame may have other image views.
    /// `earlier`, the multisampled images of the slot's previous frame, which is complete, are reused if their size
    /// fits.
    pub fn new(
        gpu: &Gpu,
        frame: &SceneFrame<'_>,
        depth: &Depth,
        color: &Color,
        earlier: Option<Samples>,
    ) -> Result<Self, Error> {
        let fits = |samples: &Samples| samples.color.extent == frame.color.extent;
        let samples = match earlier {
            _ if color.samples == vk::SampleCountFlags::TYPE_1 => None,
            Some(samples) if fits(&samples) => Some(samples),
            _ => Some(Samples::new(gpu, frame, color.samples)?),
        };
        Ok(Self {
            depth: depth.framebuffer(gpu, frame.depth)?,
            color: color.framebuffer(gpu, frame, samples.as_ref())?,
            samples,
        })
    }
}

/// Multisampled colour and depth; their contents are not kept after the pass.
pub struct Samples {
    pub color: Image,
    pub depth: Image,
}

impl Samples {
    fn new(
        gpu: &Gpu,
        frame: &SceneFrame<'_>,
        samples: vk::SampleCountFlags,
    ) -> Result<Self, Error> {
        use vk::ImageUsageFlags as Usage;
        let image = |name, like: &Image, usage| {
            let desc = ImageDesc::new(name, like.extent, like.format, usage);
            Image::new(gpu, &ImageDesc { samples, ..desc })
        };
        Ok(Self {
            color: image("scene/samples", frame.color, Usage::COLOR_ATTACHMENT)?,
            depth: image("scene/depths", frame.depth, Usage::DEPTH_STENCIL_ATTACHMENT)?,
        })
    }
}
