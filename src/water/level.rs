//! Pass `level`: chooses the resolution of the smoothing on the GPU: where the iterations would
//! pass the cap, the whole image goes coarser; one resolution an image, no seams.
//!
//! Not in the source, whose cap leaves near water rough. A level coarser needs a quarter of the
//! iterations for the same width. Before the switch the coarser level fades in, by the share of
//! the picture that is capped, not by time, so that a frame looks the same however it was come to.
//! The levels share the smoothing images, one above the other, and so does the back sheet's (pass
//! `back`); the tile list holds the tiles of those in use, so that every form of the smoothing runs
//! all in its one dispatch or draw.
//! Reads: how many pixels pass the cap, depth. Writes: levels, and for the coarser ones both
//! smoothing images, plan, each tile's work.

use ash::vk;
use bytemuck::{Pod, Zeroable};
use gpu_allocator::MemoryLocation;

use super::Recording;
use super::reduce::{Depths, PLAN_AFTER, Reduce, rule_constant};
use super::smooth::Smooth;
use super::tiles::{TILE, Tiles};
use crate::contract::{Config, SmoothingLevels};
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ,
    FRAGMENT_SAMPLED, INDIRECT, UNIFORM, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::settings::Rule;

/// Most levels coarser than the configured one.
pub const MOST_COARSENING: u32 = 3;

/// How the levels lie in the smoothing images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Atlas {
    /// Size of the images.
    pub extent: vk::Extent2D,
    /// Tiles a row.
    pub columns: u32,
    /// Rows of tiles.
    pub rows: u32,
    /// First row of texels of the second level and the back sheet's, a multiple of the tile's edge.
    pub second: u32,
    /// First column of the back sheet's level, a multiple of the tile's edge; the width where there
    /// is none.
    pub back: u32,
}

impl Atlas {
    /// The configured level on top, room for two half its size below it.
    pub fn new(config: &Config) -> Self {
        let first = reduced(config.extent, config.smoothing_level);
        let half = reduced(config.extent, config.smoothing_level + 1);
        let second = first.height.next_multiple_of(TILE);
        let (mut extent, mut back) = (first, first.width);
        if coarsening(config) > 0 || config.sheets > 1 {
            extent.height = second + half.height;
        }
        if config.sheets > 1 {
            back = half.width.next_multiple_of(TILE);
            extent.width = first.width.max(back + half.width);
        }
        let (columns, rows) = (extent.width.div_ceil(TILE), extent.height.div_ceil(TILE));
        Self { extent, columns, rows, second, back }
    }

    /// Number of tiles.
    pub fn tiles(&self) -> u32 {
        self.columns * self.rows
    }
}

/// Levels coarser that a configuration may go: the other rules are the source's, with its cap.
pub fn coarsening(config: &Config) -> u32 {
    if config.rule == Rule::ConstantWidth { config.coarsening } else { 0 }
}

shader::assert_layout!(shader::WATER_LEVEL_COMP, "Levels", SmoothingLevels { level, atlas });

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    atlas: [i32; 4],
    coarsening: u32,
    back: i32,
}

/// The pass.
pub struct Level {
    choose: Pipeline,
    /// There is none when the configuration never goes coarser.
    reduce: Option<Pipeline>,
    coarsening: u32,
    /// Pixels that pass the cap until one, two, three, more levels coarser.
    pub over: Buffer,
    /// [`SmoothingLevels`].
    pub levels: Buffer,
    /// The dispatch of the coarser reduction.
    arguments: Buffer,
}

impl Level {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        type Usage = vk::BufferUsageFlags;
        let make = |name, size, usage| {
            let usage = usage | Usage::STORAGE_BUFFER;
            Buffer::new(gpu, name, size, usage, MemoryLocation::GpuOnly)
        };
        let rule = [
            (1, rule_constant(config.rule)),
            (3, 1 << config.thickness_level),
            (9, u32::from(config.foam)),
            (10, u32::from(config.spray)),
            (20, u32::from(config.diffuse.is_some())),
        ];
        let coarsening = coarsening(config);
        let size = size_of::<SmoothingLevels>() as u64;
        Ok(Self {
            choose: Pipeline::compute(gpu, shader::WATER_LEVEL_COMP, &[])?,
            reduce: (coarsening > 0)
                .then(|| Pipeline::compute(gpu, shader::WATER_LEVEL_REDUCE_COMP, &rule))
                .transpose()?,
            coarsening,
            over: make("water/level/over", 16, Usage::TRANSFER_DST)?,
            levels: make("water/level", size, Usage::UNIFORM_BUFFER | Usage::TRANSFER_SRC)?,
            arguments: make("water/level/arguments", 16, Usage::INDIRECT_BUFFER)?,
        })
    }

    /// What the shaders of the smoothing bind.
    pub fn resource(&self) -> Resource {
        Resource::Buffer(self.levels.handle, 0, size_of::<SmoothingLevels>() as u64)
    }

    /// Both smoothing images and the plan come as `reduce` wrote them and leave so.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        depths: &Depths<'_>,
        reduce: &Reduce,
        smooth: &Smooth,
        tiles: &Tiles,
    ) -> Result<(), Error> {
        let scope = r.begin(c"level");
        let (gpu, cmd) = (r.gpu, r.cmd);
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.over.handle, COMPUTE_READ_WRITE, COMPUTE_READ),
                buffer(self.levels.handle, UNIFORM.and(COPY_READ), COMPUTE_WRITE),
                buffer(self.arguments.handle, INDIRECT, COMPUTE_WRITE),
            ],
        );
        r.descriptors.bind(
            gpu,
            cmd,
            &self.choose,
            &[
                (0, r.uniforms),
                (1, Resource::buffer(&self.over)),
                (2, Resource::buffer(&self.levels)),
                (3, Resource::buffer(&self.arguments)),
            ],
        )?;
        let Atlas { extent, columns, second, back, .. } = tiles.atlas;
        let atlas = [extent.width, extent.height, columns, second].map(|v| v as i32);
        let back = back as i32;
        self.choose.push(gpu, cmd, &Push { atlas, coarsening: self.coarsening, back });
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, 1, 1, 1) };
        if let Some(pipeline) = &self.reduce {
            self.record_coarser(r, pipeline, depths, reduce, smooth, tiles)?;
        } else {
            gpu.barriers(cmd, &[], &[buffer(self.levels.handle, COMPUTE_WRITE, UNIFORM)]);
        }
        gpu.barriers(
            cmd,
            &[
                access::image(
                    depths.water,
                    COMPUTE_READ_WRITE,
                    FRAGMENT_SAMPLED.and(COMPUTE_SAMPLED),
                ),
                access::image(&reduce.plan, COMPUTE_WRITE, PLAN_AFTER),
            ],
            &[buffer(tiles.work.handle, COMPUTE_WRITE, COMPUTE_READ)],
        );
        r.end(scope);
        Ok(())
    }

    /// The reduction again, where the dispatch that was just written says so.
    fn record_coarser(
        &self,
        r: &Recording<'_>,
        pipeline: &Pipeline,
        depths: &Depths<'_>,
        reduce: &Reduce,
        smooth: &Smooth,
        tiles: &Tiles,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        // What `reduce` wrote is written again, or left.
        let again = |image| access::image(image, COMPUTE_WRITE, COMPUTE_WRITE);
        gpu.barriers(
            cmd,
            &[
                access::image(depths.water, COMPUTE_READ_WRITE, COMPUTE_READ),
                again(&smooth.a),
                again(&smooth.b),
                again(&reduce.plan),
            ],
            &[
                buffer(self.levels.handle, COMPUTE_WRITE, UNIFORM),
                buffer(self.arguments.handle, COMPUTE_WRITE, INDIRECT),
                buffer(tiles.work.handle, COMPUTE_WRITE, COMPUTE_WRITE),
            ],
        );
        let [foam, spray, diffuse] = depths.beside(r);
        r.descriptors.bind(
            gpu,
            cmd,
            pipeline,
            &[
                (0, r.uniforms),
                (1, Resource::storage(depths.water)),
                (3, Resource::storage(&smooth.a)),
                (4, Resource::storage(&smooth.b)),
                (5, Resource::storage(&reduce.plan)),
                (6, Resource::buffer(&tiles.work)),
                (7, self.resource()),
                foam,
                spray,
                diffuse,
            ],
        )?;
        // SAFETY: as above; the arguments are visible (barrier).
        unsafe { gpu.device.cmd_dispatch_indirect(cmd, self.arguments.handle, 0) };
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        self.over.size + self.levels.size + self.arguments.size
    }
}
