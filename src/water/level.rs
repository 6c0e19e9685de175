//! Pass `level`: the reduction again at coarser resolutions, for what is so near that its iterations
//! would pass the cap. Each pixel shows the level that its distance asks for, and between two of them
//! goes from one to the other.
//!
//! Not in the source, whose cap leaves near water rough. A level coarser needs a quarter of the
//! iterations for the same width. The levels share the smoothing images, and so do those of the back
//! sheet (pass `back`); the tile list holds the tiles of all of them, so that every form of the smoothing
//! runs all in its one dispatch or draw.
//! Reads: depth, each tile's work. Writes: marks and list of the tiles that are made, the coarsest level needed; for
//! those tiles both smoothing images, plan, each tile's work.

use ash::vk;
use gpu_allocator::MemoryLocation;

use super::Recording;
use super::reduce::{Depths, PLAN_AFTER, Reduce, rule_constant};
use super::smooth::Smooth;
use super::tiles::{TILE, Tiles};
use crate::contract::{Config, SmoothingLevel, SmoothingLevels};
use crate::error::Error;
use crate::frame::{Lens, reduced};
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, FRAGMENT_SAMPLED,
    INDIRECT, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::settings::{Rule, WaterSettings};

/// Most levels coarser than the configured one.
pub const MOST_COARSENING: u32 = 3;
/// The first of the back sheet among the levels.
const BACK: usize = 4;
/// The next level fades in from this part of the most iterations on, until at twice that it is alone. The width is 6
/// to 8 texels then, 3 to 4 of the next one, which still has all that is left of the surface.
const FADE: f32 = 0.25;

/// No groups, one in each of the other directions, no tile, no level: `Marked` of glsl/include/level.glsl.
pub const NONE_MARKED: [u32; 5] = [0, 1, 1, 0, 0];

/// Levels coarser that a configuration may go: the other rules are the source's, with its cap.
pub fn coarsening(config: &Config) -> u32 {
    if config.rule == Rule::ConstantWidth { config.coarsening } else { 0 }
}

/// The levels that a configuration has, in the order in which they are placed: which of
/// [`SmoothingLevels`], and how much coarser than the first.
fn levels(config: &Config) -> impl Iterator<Item = (usize, u32)> {
    let (coarsening, two) = (coarsening(config), config.sheets > 1);
    (0..=MOST_COARSENING).flat_map(move |coarser| {
        let front = (coarser <= coarsening).then_some((coarser as usize, coarser));
        // The back sheet's first is the second, whether the front one has it or not.
        let wanted = two && coarser > 0 && coarser <= coarsening.max(1);
        let back = wanted.then(|| (BACK + coarser as usize - 1, coarser));
        front.into_iter().chain(back)
    })
}

/// How the levels lie in the smoothing images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Atlas {
    /// Size of the images.
    pub extent: vk::Extent2D,
    /// Tiles a row.
    pub columns: u32,
    /// Rows of tiles.
    pub rows: u32,
    /// Tiles of the first level, all columns of them.
    pub first: u32,
    /// First texel of each level, multiples of the tile's edge.
    origins: [[u32; 2]; 7],
}

impl Atlas {
    /// In rows: the first level in one, the others beside each other as far as it is wide.
    pub fn new(config: &Config) -> Self {
        let first = reduced(config.extent, config.smoothing_level);
        let (mut extent, mut origins) = (first, [[0; 2]; 7]);
        let (mut x, mut row) = (first.width, [0, first.height]);
        for (i, coarser) in levels(config).skip(1) {
            let size = reduced(config.extent, config.smoothing_level + coarser);
            if x + size.width > first.width {
                (x, row) = (0, [row[1].next_multiple_of(TILE); 2]);
            }
            origins[i] = [x, row[0]];
            row[1] = row[1].max(row[0] + size.height);
            extent.width = extent.width.max(x + size.width);
            extent.height = extent.height.max(row[1]);
            x = (x + size.width).next_multiple_of(TILE);
        }
        let (columns, rows) = (extent.width.div_ceil(TILE), extent.height.div_ceil(TILE));
        let first = columns * first.height.div_ceil(TILE);
        Self { extent, columns, rows, first, origins }
    }

    /// Number of tiles.
    pub fn tiles(&self) -> u32 {
        self.columns * self.rows
    }
}

impl SmoothingLevels {
    /// Of a frame of a size.
    pub(crate) fn new(
        config: &Config,
        lens: &Lens,
        full: vk::Extent2D,
        water: &WaterSettings,
    ) -> Self {
        let atlas = Atlas::new(config);
        let pixel = lens.pixel(full);
        let mut level = [SmoothingLevel::default(); 7];
        for (i, coarser) in levels(config) {
            let size = reduced(full, config.smoothing_level + coarser);
            let edge = (1 << (config.smoothing_level + coarser)) as f32;
            let [x, y] = atlas.origins[i];
            level[i] = SmoothingLevel {
                rect: [x, y, size.width, size.height].map(|v| v as i32),
                slope: lens.slope(full, edge).to_array(),
                texel: [pixel[0] * edge, pixel[1] * edge, edge, 0.0],
            };
        }
        let sigma = water.smoothing_width * water.radius() / level[0].texel[0];
        let cap = config.max_iterations.saturating_sub(super::reduce::MORE).max(1) as f32;
        let vk::Extent2D { width, height } = atlas.extent;
        Self {
            level,
            atlas: [width, height, atlas.columns, coarsening(config)].map(|v| v as i32),
            near: [
                sigma * sigma / (FADE * cap),
                (pixel[0] / pixel[1]).powi(2),
                water.depth_falloff * water.radius(),
                0.0,
            ],
        }
    }
}

shader::assert_layout!(shader::WATER_LEVEL_COMP, "Levels", SmoothingLevels { level, atlas, near });

struct Parts {
    mark: Pipeline,
    reduce: Pipeline,
}

/// The pass.
pub struct Level {
    /// There are none when the configuration never goes coarser.
    parts: Option<Parts>,
    /// What is to be made, [`NONE_MARKED`] from `reduce` on.
    pub marked: Buffer,
}

impl Level {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let coarsening = coarsening(config);
        let rule = [(1, rule_constant(config.rule))];
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::TRANSFER_DST;
        let parts = || -> Result<_, Error> {
            Ok(Parts {
                mark: Pipeline::compute(gpu, shader::WATER_LEVEL_MARK_COMP, &[])?,
                reduce: Pipeline::compute(gpu, shader::WATER_LEVEL_COMP, &rule)?,
            })
        };
        Ok(Self {
            parts: (coarsening > 0).then(parts).transpose()?,
            marked: Buffer::new(gpu, "water/level/marked", 4 * 5, usage, MemoryLocation::GpuOnly)?,
        })
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
        let work = buffer(tiles.work.handle, COMPUTE_READ_WRITE, COMPUTE_READ_WRITE);
        if let Some(Parts { mark, .. }) = &self.parts {
            // In the place of the list that `tiles` writes.
            let list = buffer(tiles.list.handle, COMPUTE_READ.and(VERTEX_READ), COMPUTE_WRITE);
            gpu.barriers(cmd, &[], &[work, list]);
            r.descriptors.bind(
                gpu,
                cmd,
                mark,
                &[
                    (0, r.uniforms),
                    (6, Resource::buffer(&tiles.work)),
                    (7, r.levels),
                    (8, Resource::buffer(&self.marked)),
                    (9, Resource::buffer(&tiles.list)),
                ],
            )?;
            // A tile is 16 texels wide and high.
            r.dispatch_over(reduced(r.extent, reduce.level + 4), mark.local_size);
        }
        let marked = buffer(self.marked.handle, COMPUTE_READ_WRITE, COMPUTE_READ.and(INDIRECT));
        gpu.barriers(cmd, &[], &[marked]);
        if let Some(Parts { reduce: pipeline, .. }) = &self.parts {
            // What `reduce` wrote is beside what is written here.
            let beside = |image| access::image(image, COMPUTE_WRITE, COMPUTE_WRITE);
            gpu.barriers(
                cmd,
                &[
                    access::image(depths.water, COMPUTE_READ_WRITE, COMPUTE_READ),
                    beside(&smooth.a),
                    beside(&smooth.b),
                    beside(&reduce.plan),
                ],
                &[work, buffer(tiles.list.handle, COMPUTE_WRITE, COMPUTE_READ)],
            );
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
                    (7, r.levels),
                    (8, Resource::buffer(&self.marked)),
                    (9, Resource::buffer(&tiles.list)),
                ],
            )?;
            // SAFETY: cmd is recording outside a render pass, pipeline and set are bound; the groups are visible (barrier).
            unsafe { gpu.device.cmd_dispatch_indirect(cmd, self.marked.handle, 0) };
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
            &[buffer(tiles.work.handle, COMPUTE_READ_WRITE, COMPUTE_READ)],
        );
        r.end(scope);
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        self.marked.size
    }
}
