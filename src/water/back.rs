//! Pass `back`: depth of the back layer, the farther of two layers of water, where the front layer covers it.
//!
//! Not in the thesis. This depth has half the resolution of the front layer's smoothing (one level coarser), with one
//! sample per texel, because it is only seen through water. It is put into the smoothing images beside the front
//! layer's levels, so every form of the smoothing processes it. It is computed only in tiles near a boundary (the
//! depth that separates the two layers) that `thickness` has kept. The nearest boundary of each block of 16×16 pixels
//! is found first, so that most spheres need not be compared with each texel.
//! Reads: the list of `cull`, boundaries, depth. Writes: blocks, depth of the back layer; for its levels both
//! smoothing images, plan, each tile's work.

use ash::vk;

use super::cull::SphereList;
use super::depth::dispatch_sprites;
use super::gaps::{blocks_buffer, dispatch_blocks};
use super::level::{Level, coarsening};
use super::reduce::{PLAN_AFTER, rule_constant};
use super::smooth::Smooth;
use super::tiles::{TILE, Tiles};
use super::{Recording, shape};
use crate::contract::Config;
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, buffer};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;

/// The pass.
pub struct Back {
    nearest: Pipeline,
    begin: Pipeline,
    small: Pipeline,
    large: Pipeline,
    plan: Pipeline,
    /// Eye depth of the back layer, unsmoothed.
    image: Image,
    /// First smoothing level of the layer, and number of its levels.
    level: u32,
    levels: u32,
    /// Nearest boundary of each block of 16×16 pixels.
    blocks: Buffer,
}

/// Smoothing resources that the layer joins.
pub struct Into<'a> {
    pub smooth: &'a Smooth,
    pub plan: &'a Image,
    pub tiles: &'a Tiles,
    pub level: &'a Level,
}

impl Back {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let rule = [(1, rule_constant(config.rule))];
        let splat = |large| {
            let constants = [(0, large), shape::constant(config)];
            Pipeline::compute(gpu, shader::WATER_BACK_COMP, &constants)
        };
        Ok(Self {
            nearest: Pipeline::compute(gpu, shader::WATER_GAPS_BLOCKS_COMP, &[(0, 1)])?,
            begin: Pipeline::compute(gpu, shader::WATER_BACK_BEGIN_COMP, &[])?,
            small: splat(0)?,
            large: splat(1)?,
            plan: Pipeline::compute(gpu, shader::WATER_BACK_PLAN_COMP, &rule)?,
            image: Self::image(gpu, config)?,
            level: config.smoothing_level + 1,
            levels: coarsening(config).max(1),
            blocks: blocks_buffer(gpu, "water/back/blocks", config)?,
        })
    }

    fn image(gpu: &Gpu, config: &Config) -> Result<Image, Error> {
        Image::new(
            gpu,
            &ImageDesc {
                alias: Some(vk::Format::R32_UINT),
                ..ImageDesc::new(
                    "water/back",
                    reduced(config.extent, config.smoothing_level + 1),
                    vk::Format::R32_SFLOAT,
                    vk::ImageUsageFlags::STORAGE,
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
        let blocks = blocks_buffer(gpu, "water/back/blocks", config)?;
        retired.replace(&mut self.image, image);
        retired.replace(&mut self.blocks, blocks);
        Ok(())
    }

    /// Records pass `back`. The smoothing resources in `into` must be in the state in which pass `level` leaves them,
    /// and are in the same state after pass `back`.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        depth: &Image,
        list: &SphereList,
        boundaries: &Buffer,
        into: &Into<'_>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"back");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let Into { smooth, plan, tiles, level } = into;
        let extent = reduced(r.extent, self.level);
        let groups = [extent.width.div_ceil(TILE), extent.height.div_ceil(TILE)];
        let dispatch = |levels| {
            // SAFETY: outside a render pass, pipeline and set are bound.
            unsafe { gpu.device.cmd_dispatch(cmd, groups[0], groups[1], levels) };
        };
        dispatch_blocks(r, &self.nearest, boundaries, &self.blocks)?;
        let boundaries = Resource::buffer(boundaries);
        gpu.barriers(
            cmd,
            &[access::image(&self.image, COMPUTE_READ.discarded(), COMPUTE_WRITE)],
            &[],
        );
        r.descriptors.bind(
            gpu,
            cmd,
            &self.begin,
            &[
                (0, r.uniforms),
                (1, Resource::Sampled(depth.view, gpu.samplers.nearest)),
                (3, Resource::storage(&self.image)),
                (7, r.levels),
                (11, boundaries),
            ],
        )?;
        dispatch(1);

        gpu.barriers(cmd, &[access::image(&self.image, COMPUTE_WRITE, COMPUTE_READ_WRITE)], &[]);
        let more = [
            (3, Resource::Storage(self.image.alias_view)),
            (4, Resource::buffer(&self.blocks)),
            (7, r.levels),
            (11, boundaries),
        ];
        dispatch_sprites(r, list, &self.small, &self.large, &more)?;

        gpu.barriers(
            cmd,
            &[
                access::image(&self.image, COMPUTE_READ_WRITE, COMPUTE_READ),
                access::image(&smooth.a, COMPUTE_WRITE, COMPUTE_WRITE),
                access::image(&smooth.b, COMPUTE_WRITE, COMPUTE_WRITE),
                access::image(plan, PLAN_AFTER, COMPUTE_WRITE),
            ],
            &[buffer(tiles.work.handle, COMPUTE_READ, COMPUTE_WRITE)],
        );
        r.descriptors.bind(
            gpu,
            cmd,
            &self.plan,
            &[
                (0, r.uniforms),
                (1, Resource::storage(&self.image)),
                (3, Resource::storage(&smooth.a)),
                (4, Resource::storage(&smooth.b)),
                (5, Resource::storage(plan)),
                (6, Resource::buffer(&tiles.work)),
                (7, r.levels),
                (8, Resource::buffer(&level.marked)),
            ],
        )?;
        dispatch(self.levels);
        gpu.barriers(
            cmd,
            &[access::image(plan, COMPUTE_WRITE, PLAN_AFTER)],
            &[buffer(tiles.work.handle, COMPUTE_WRITE, COMPUTE_READ)],
        );
        r.end(scope);
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        (self.image.size, self.blocks.size)
    }
}
