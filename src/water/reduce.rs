//! Pass `reduce`: removes water behind the scene from the depth, and downsamples the depth to the resolution of the
//! smoothing: to the nearest depth of each block of pixels, as in the thesis (Sec. 4.7), but in blocks of 4×4 pixels
//! or more not to the depth of a single drop. From this unsmoothed depth it computes the plan: each pixel's number of
//! smoothing iterations and their step size.
//!
//! Reads: water depth, scene depth; depths of surface foam, whitewater and bubble foam, and spray, to find the tiles
//! that show them. Writes: water depth (emptied where the scene hides the water), both smoothing images, plan, each
//! tile's work (what has to be done in it); clears the work of the coarser levels' tiles and the counters of the pass
//! `level`.

use ash::vk;

use super::Recording;
use super::level::{Atlas, Level, NONE_MARKED};
use super::smooth::Smooth;
use super::tiles::Tiles;
use crate::contract::Config;
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ,
    COPY_WRITE, FRAGMENT_SAMPLED, INDIRECT, buffer,
};
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::settings::Rule;

/// The plan after a frame: read by every form of the smoothing.
pub const PLAN_AFTER: Access = COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED);

/// Depths that are reduced.
pub struct Depths<'a> {
    pub water: &'a Image,
    /// Depth of surface foam, and the image of spray. Tiles that show foam or spray are shaded too, even without
    /// water.
    pub foam: Option<&'a Image>,
    pub spray: Option<&'a Image>,
    /// Whitewater depth.
    pub whitewater: Option<&'a Image>,
    /// Bubble-foam depth.
    pub bubbles: Option<&'a Image>,
}

impl Depths<'_> {
    /// Bindings of glsl/include/beside.glsl, with stand-ins for absent images.
    pub fn beside(&self, r: &Recording<'_>) -> [(u32, Resource); 4] {
        let nearest = r.gpu.samplers.nearest;
        let bound = |image: Option<&Image>| {
            image.map_or(r.scene_depth, |image| Resource::Sampled(image.view, nearest))
        };
        [
            (13, bound(self.foam)),
            (15, bound(self.spray)),
            (21, bound(self.whitewater)),
            (25, bound(self.bubbles)),
        ]
    }
}

/// The pass.
pub struct Reduce {
    pipeline: Pipeline,
    /// Iterations (9 bits) and step (23 bits) of each reduced pixel.
    pub plan: Image,
    /// The configured level of the smoothing.
    pub level: u32,
}

/// Iterations beyond those that stability requires (glsl/include/plan.glsl).
pub const MORE: u32 = 2;

/// Number of a rule in the shaders.
pub fn rule_constant(rule: Rule) -> u32 {
    match rule {
        Rule::Source => 0,
        Rule::ConstantWidth => 1,
        Rule::Fixed(_) => 2,
    }
}

impl Reduce {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let constants = [
            (0, config.smoothing_level),
            (1, rule_constant(config.rule)),
            (3, 1 << config.thickness_level),
            (9, u32::from(config.surface_foam)),
            (10, u32::from(config.spray)),
            (20, u32::from(config.whitewater.is_some())),
            (22, u32::from(config.bubbles.is_some())),
        ];
        Ok(Self {
            pipeline: Pipeline::compute(gpu, shader::WATER_REDUCE_COMP, &constants)?,
            plan: Self::plan(gpu, config)?,
            level: config.smoothing_level,
        })
    }

    fn plan(gpu: &Gpu, config: &Config) -> Result<Image, Error> {
        Image::new(
            gpu,
            &ImageDesc::new(
                "water/reduce/plan",
                Atlas::of(gpu, config).extent,
                vk::Format::R32_UINT,
                vk::ImageUsageFlags::STORAGE
                    | vk::ImageUsageFlags::SAMPLED
                    | vk::ImageUsageFlags::TRANSFER_SRC,
            ),
        )
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let plan = Self::plan(gpu, config)?;
        retired.replace(&mut self.plan, plan);
        Ok(())
    }

    /// `level` transitions what is written here.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        depths: &Depths<'_>,
        smooth: &Smooth,
        tiles: &Tiles,
        level: &Level,
    ) -> Result<(), Error> {
        let scope = r.begin(c"reduce");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (marked, work) = (level.marked.handle, tiles.work.handle);
        let read = COMPUTE_READ.and(INDIRECT);
        gpu.barriers(
            cmd,
            &[],
            &[buffer(marked, read, COPY_WRITE), buffer(work, COMPUTE_READ, COPY_WRITE)],
        );
        // SAFETY: outside a render pass; the frame before has read both (barrier).
        unsafe {
            gpu.device.cmd_update_buffer(cmd, marked, 0, bytemuck::bytes_of(&NONE_MARKED));
            gpu.device.cmd_fill_buffer(cmd, work, 0, vk::WHOLE_SIZE, 0);
        }
        let smooth_before = super::smooth::BEFORE.discarded();
        let plan_before = PLAN_AFTER.and(COPY_READ).discarded();
        gpu.barriers(
            cmd,
            &[
                access::image(&smooth.a, smooth_before, COMPUTE_WRITE),
                access::image(&smooth.b, smooth_before, COMPUTE_WRITE),
                access::image(&self.plan, plan_before, COMPUTE_WRITE),
            ],
            &[
                buffer(marked, COPY_WRITE, COMPUTE_READ_WRITE),
                buffer(work, COPY_WRITE, COMPUTE_READ_WRITE),
            ],
        );
        let [foam, spray, whitewater, bubbles] = depths.beside(r);
        r.descriptors.bind(
            gpu,
            cmd,
            &self.pipeline,
            &[
                (0, r.uniforms),
                (1, Resource::storage(depths.water)),
                (2, r.scene_depth),
                (3, Resource::storage(&smooth.a)),
                (4, Resource::storage(&smooth.b)),
                (5, Resource::storage(&self.plan)),
                (6, Resource::buffer(&tiles.work)),
                (7, r.levels),
                foam,
                spray,
                whitewater,
                bubbles,
            ],
        )?;
        r.dispatch_over(reduced(r.extent, self.level), self.pipeline.local_size);
        r.end(scope);
        Ok(())
    }
}
