//! Pass `cast`: the blobs' shadow map, so that blobs shadow each other, the scene and the water (not in the paper).
//!
//! Reads: blobs. Writes: the shadow map, each texel of which holds the distance in scene units along the light to the
//! first blob, measured from two radii of `Frame::light_volume` before its centre.

use ash::vk;

use super::lists::Lists;
use crate::contract::{Blobs, Config};
use crate::error::Error;
use crate::frame::EMPTY;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, FRAGMENT_SAMPLED, VERTEX_SAMPLED,
};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::Recording;

/// Access to the map: by every pass that needs sunlight.
const AFTER: Access = COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED).and(VERTEX_SAMPLED);

/// The pass.
pub struct Cast {
    pipeline: Pipeline,
    front: Image,
}

impl Cast {
    /// `None` if nothing casts shadows.
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Option<Self>, Error> {
        let Some(edge) = config.light_map_size else { return Ok(None) };
        let usage = vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_DST;
        // Half the size of the light's other maps, because shadows of blobs are soft.
        let extent = vk::Extent2D { width: edge / 2, height: edge / 2 };
        let desc = ImageDesc::new("bubbles/cast", extent, vk::Format::R32_SFLOAT, usage);
        let alias = Some(vk::Format::R32_UINT);
        Ok(Some(Self {
            pipeline: Pipeline::compute(gpu, shader::BUBBLES_CAST_COMP, &[])?,
            front: Image::new(gpu, &ImageDesc { alias, ..desc })?,
        }))
    }

    /// The map for glsl/include/sunlight.glsl.
    pub fn resource(&self, gpu: &Gpu) -> Resource {
        Resource::Sampled(self.front.view, gpu.samplers.nearest)
    }

    pub fn record(
        &self,
        r: &Recording<'_>,
        (lists, blobs): (&Lists, Option<&Blobs>),
    ) -> Result<(), Error> {
        let (gpu, cmd, image) = (r.gpu, r.cmd, &self.front);
        gpu.barriers(cmd, &[access::image(image, AFTER.discarded(), CLEAR)], &[]);
        gpu.clear_color(cmd, image, [EMPTY; 4]);
        gpu.barriers(cmd, &[access::image(image, CLEAR, COMPUTE_READ_WRITE)], &[]);
        let count = lists.count(gpu, blobs);
        let resources = [
            (0, r.uniforms),
            (1, r.bubbles),
            (3, Resource::buffer(lists.buffers()[0])),
            (4, Resource::Storage(image.alias_view)),
        ];
        r.descriptors.bind(gpu, cmd, &self.pipeline, &resources)?;
        self.pipeline.push(gpu, cmd, &count);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, count.div_ceil(64).max(1), 1, 1) };
        gpu.barriers(cmd, &[access::image(image, COMPUTE_READ_WRITE, AFTER)], &[]);
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        self.front.size
    }
}
