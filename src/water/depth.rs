//! Pass `depth`: the frontmost water surface (thesis Sec. 4.6.1).
//!
//! Pass `depth` computes the exact nearest intersection of each pixel's ray with each sphere or ellipsoid. The thesis
//! offsets a billboard by N_z·r (the z component of the sphere's normal, times the radius), which is wrong off the
//! axis and near the camera. Two paths give the same picture: sprites with MIN blending, and a compute shader with
//! integer atomics on the same image.
//! Reads: the list of spheres of pass `front`. Writes: depth, R32F, EMPTY where there is no water.

use ash::vk;

use super::cull::{self, SphereList};
use super::{Recording, shape};
use crate::contract::Config;
use crate::error::Error;
use crate::frame::EMPTY;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COLOR_ATTACHMENT, COMPUTE_READ_WRITE, COPY_READ, FRAGMENT_SAMPLED,
};
use crate::gpu::descriptors::Resource;
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Graphics, Pipeline, blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::settings::Splat;

/// Last uses of the depth image in a frame, for which the next frame waits: by `composite` and by compute passes, or
/// a copy of the layer by the host.
const BEFORE: Access = FRAGMENT_SAMPLED.and(COPY_READ).and(COMPUTE_READ_WRITE);

enum Path {
    Raster {
        points: Pipeline,
        quads: Pipeline,
        pass: vk::RenderPass,
        framebuffer: Owned<vk::Framebuffer>,
    },
    Compute {
        small: Pipeline,
        large: Pipeline,
    },
}

/// The pass.
pub struct Depth {
    path: Path,
    /// Eye depth of the frontmost surface.
    pub image: Image,
}

/// Draws points or quads of a splat pass.
pub fn sprites(
    gpu: &Gpu,
    vertex: shader::Shader,
    fragment: shader::Shader,
    pass: vk::RenderPass,
    blend: &[vk::PipelineColorBlendAttachmentState],
    config: &Config,
) -> Result<(Pipeline, Pipeline), Error> {
    let make = |topology, quads| {
        let constants = &[(0, quads), (9, u32::from(config.surface_foam)), shape::constant(config)];
        Pipeline::graphics(gpu, &Graphics { vertex, fragment, topology, pass, blend, constants })
    };
    Ok((
        make(vk::PrimitiveTopology::POINT_LIST, 0)?,
        make(vk::PrimitiveTopology::TRIANGLE_STRIP, 1)?,
    ))
}

impl Depth {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let image = Self::image(gpu, config)?;
        let path = match config.depth_splat.unwrap_or(DEFAULT_SPLAT) {
            Splat::Raster => {
                let pass =
                    gpu.color_pass("water/depth", &[image.format], vk::AttachmentLoadOp::CLEAR)?;
                let (points, quads) = sprites(
                    gpu,
                    shader::WATER_DEPTH_VERT,
                    shader::WATER_DEPTH_FRAG,
                    pass,
                    &[blend(vk::BlendOp::MIN)],
                    config,
                )?;
                let framebuffer = gpu.framebuffer("water/depth", pass, image.view, image.extent)?;
                Path::Raster { points, quads, pass, framebuffer }
            }
            Splat::Compute => {
                let make = |large| {
                    let constants = [(0, large), shape::constant(config)];
                    Pipeline::compute(gpu, shader::WATER_DEPTH_COMP, &constants)
                };
                Path::Compute { small: make(0)?, large: make(1)? }
            }
        };
        Ok(Self { path, image })
    }

    fn image(gpu: &Gpu, config: &Config) -> Result<Image, Error> {
        Image::new(
            gpu,
            &ImageDesc {
                alias: Some(vk::Format::R32_UINT),
                ..ImageDesc::new(
                    "water/depth",
                    config.extent,
                    vk::Format::R32_SFLOAT,
                    vk::ImageUsageFlags::STORAGE
                        | vk::ImageUsageFlags::SAMPLED
                        | vk::ImageUsageFlags::COLOR_ATTACHMENT
                        | vk::ImageUsageFlags::TRANSFER_SRC
                        | vk::ImageUsageFlags::TRANSFER_DST,
                )
            },
        )
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let image = Self::image(gpu, config)?;
        if let Path::Raster { pass, framebuffer, .. } = &mut self.path {
            let new = gpu.framebuffer("water/depth", *pass, image.view, image.extent)?;
            retired.replace(framebuffer, new);
        }
        retired.replace(&mut self.image, image);
        Ok(())
    }

    /// Whether small sprites are drawn as points.
    pub fn uses_points(&self) -> bool {
        matches!(self.path, Path::Raster { .. })
    }

    /// Maximum size in pixels of a small sprite: the largest that can be drawn as a point, or on the compute path the
    /// largest that one invocation should process.
    pub fn point_limit(&self, gpu: &Gpu) -> f32 {
        match self.path {
            // The max point size, less the footprint's margin and the snapping.
            Path::Raster { .. } if gpu.enabled.large_points => gpu.limits.point_size_range[1] - 1.0,
            Path::Raster { .. } => 0.0,
            Path::Compute { .. } => 64.0,
        }
    }

    pub fn record(&self, r: &mut Recording<'_>, list: &SphereList) -> Result<(), Error> {
        let scope = r.begin(c"depth");
        let (gpu, cmd) = (r.gpu, r.cmd);
        match &self.path {
            Path::Raster { points, quads, pass, framebuffer } => {
                gpu.barriers(
                    cmd,
                    &[access::image(&self.image, BEFORE.discarded(), COLOR_ATTACHMENT)],
                    &[],
                );
                let area = r.extent.into();
                gpu.begin_pass(cmd, *pass, framebuffer.handle, area, [EMPTY, 0.0, 0.0, 0.0]);
                draw_sprites(r, list, points, quads, &[])?;
                gpu.end_pass(cmd);
                gpu.barriers(
                    cmd,
                    &[access::image(&self.image, COLOR_ATTACHMENT, COMPUTE_READ_WRITE)],
                    &[],
                );
            }
            Path::Compute { small, large } => {
                gpu.barriers(cmd, &[access::image(&self.image, BEFORE.discarded(), CLEAR)], &[]);
                gpu.clear_color(cmd, &self.image, [EMPTY, 0.0, 0.0, 0.0]);
                gpu.barriers(cmd, &[access::image(&self.image, CLEAR, COMPUTE_READ_WRITE)], &[]);
                dispatch_sprites(
                    r,
                    list,
                    small,
                    large,
                    &[(3, Resource::Storage(self.image.alias_view))],
                )?;
                gpu.barriers(
                    cmd,
                    &[access::image(&self.image, COMPUTE_READ_WRITE, COMPUTE_READ_WRITE)],
                    &[],
                );
            }
        }
        r.end(scope);
        Ok(())
    }
}

/// Spheres are splatted by compute by default, which is faster than by sprites, on lavapipe at every size and on an
/// H200 (docs/performance.md).
pub const DEFAULT_SPLAT: Splat = Splat::Compute;

/// Draws the sprites of all chunks inside a render pass: points, then quads.
pub fn draw_sprites(
    r: &mut Recording<'_>,
    list: &SphereList,
    points: &Pipeline,
    quads: &Pipeline,
    more: &[(u32, Resource)],
) -> Result<(), Error> {
    let (gpu, cmd) = (r.gpu, r.cmd);
    for (pipeline, offset) in [(points, cull::POINTS), (quads, cull::QUADS)] {
        for chunk in list.chunks() {
            let mut resources =
                vec![(0, r.uniforms), (1, chunk.spheres), (2, r.scene_depth), (6, chunk.shares)];
            resources.extend_from_slice(more);
            r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
            pipeline.push(gpu, cmd, &chunk.capacity);
            // SAFETY: inside a render pass; the arguments are visible since `cull`.
            unsafe {
                gpu.device.cmd_draw_indirect(
                    cmd,
                    list.counts.handle,
                    chunk.arguments + offset,
                    1,
                    16,
                );
            }
        }
    }
    Ok(())
}

/// Records two indirect dispatches for each chunk of the list: over its small sprites, with one invocation per
/// sprite, and over its large sprites, with one workgroup per sprite.
pub fn dispatch_sprites(
    r: &mut Recording<'_>,
    list: &SphereList,
    small: &Pipeline,
    large: &Pipeline,
    more: &[(u32, Resource)],
) -> Result<(), Error> {
    let (gpu, cmd) = (r.gpu, r.cmd);
    for (pipeline, offset) in [(small, cull::SMALL_GROUPS), (large, cull::LARGE_GROUPS)] {
        for chunk in list.chunks() {
            let mut resources =
                vec![(0, r.uniforms), (1, chunk.counts), (2, chunk.spheres), (6, chunk.shares)];
            resources.extend_from_slice(more);
            r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
            pipeline.push(gpu, cmd, &chunk.capacity);
            // SAFETY: outside a render pass; the arguments are visible since `cull`.
            unsafe {
                gpu.device.cmd_dispatch_indirect(cmd, list.counts.handle, chunk.arguments + offset);
            }
        }
    }
    Ok(())
}
