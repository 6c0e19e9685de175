//! Pass `level`: repeats pass `reduce` at coarser resolutions (levels of the smoothing), for water so near to the
//! camera that smoothing it at the configured resolution would take more than a quarter of the
//! `Config::max_iterations` iterations. Each pixel shows the level that its distance selects, or blends two levels.
//!
//! The pass `level` is not in the thesis, where the limit on iterations leaves near water rough. The next coarser level
//! of the smoothing needs a quarter of the iterations for the same width. All levels, including those of the back
//! layer (pass `back`), lie beside each other in the smoothing images. The tile list holds the tiles of all levels, so
//! every form of the smoothing processes all of them in one dispatch or draw.
//! Reads: depth, each tile's work. Writes: marks and list of the required tiles, the coarsest required level; for
//! those tiles both smoothing images, plan, each tile's work.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::Recording;
use super::reduce::{Depths, PLAN_AFTER, Reduce, rule_constant};
use super::smooth::Smooth;
use super::tiles::{TILE, Tiles};
use crate::contract::Config;
use crate::diagnostics::{SmoothingLevel, SmoothingLevels};
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

/// Maximum number of levels coarser than the configured one.
pub const MOST_COARSENING: u32 = 3;
/// Index of the back layer's first level.
const BACK: usize = 4;
/// Fraction of the maximum number of iterations at which the next coarser level begins to fade in. At twice this
/// fraction and above, only the coarser level is shown. In between, the width of the smoothing is 6 to 8 texels of
/// the finer level, and so 3 to 4 texels of the coarser one, which therefore resolves all detail that the smoothing
/// leaves.
const FADE: f32 = 0.25;

/// Initial value of `Marked` (glsl/include/level.glsl): a dispatch of no groups in x and one in y and z, no marked
/// tile, no coarser level needed.
pub const NONE_MARKED: [u32; 5] = [0, 1, 1, 0, 0];

/// Number of a configuration's smoothing levels that are coarser than its first level. Only the rule
/// [`Rule::ConstantWidth`] has such levels. With the other rules the result is 0: as in the thesis, the front layer is
/// smoothed at the first level only, and a pixel that would need more than `max_iterations` stays rougher.
pub fn coarsening(config: &Config) -> u32 {
    if config.rule == Rule::ConstantWidth { config.coarsening } else { 0 }
}

/// The smoothing levels of a configuration, finest first, as they are placed in the image: index in
/// [`SmoothingLevels`], and number of halvings from the first level.
fn levels(config: &Config) -> impl Iterator<Item = (usize, u32)> {
    let (coarsening, two) = (coarsening(config), config.sheets > 1);
    (0..=MOST_COARSENING).flat_map(move |coarser| {
        let front = (coarser <= coarsening).then_some((coarser as usize, coarser));
        // The back layer begins at the second level, even if the front layer does not have that level.
        let wanted = two && coarser > 0 && coarser <= coarsening.max(1);
        let back = wanted.then(|| (BACK + coarser as usize - 1, coarser));
        front.into_iter().chain(back)
    })
}

/// Size of an image that holds all levels of the smoothing, and first texel of each in it.
type Placed = ([u32; 2], [[u32; 2]; 7]);

fn in_rows(sizes: &[(usize, vk::Extent2D)]) -> Placed {
    let (_, first) = sizes[0];
    let (mut extent, mut origins) = ([first.width, first.height], [[0; 2]; 7]);
    let (mut x, mut row) = (first.width, [0, first.height]);
    for &(i, size) in &sizes[1..] {
        if x + size.width > first.width {
            (x, row) = (0, [row[1].next_multiple_of(TILE); 2]);
        }
        origins[i] = [x, row[0]];
        row[1] = row[1].max(row[0] + size.height);
        extent = [extent[0].max(x + size.width), extent[1].max(row[1])];
        x = (x + size.width).next_multiple_of(TILE);
    }
    (extent, origins)
}

/// Places the levels, the largest first, each where the image grows least. Candidates are the left edge and the right
/// edges of the placed levels in x, the top and their bottom edges in y. `None` if a level does not fit in an image
/// of at most `most` texels per side.
fn anywhere(sizes: &[(usize, vk::Extent2D)], most: u32) -> Option<Placed> {
    let (mut extent, mut origins) = ([0; 2], [[0; 2]; 7]);
    let mut taken: Vec<[[u32; 2]; 2]> = Vec::new();
    for &(i, size) in sizes {
        let size = [size.width, size.height];
        let ends = |axis: usize| std::iter::once(0).chain(taken.iter().map(move |r| r[1][axis]));
        let places = ends(0).flat_map(|x| ends(1).map(move |y| [x, y]));
        let grown = |at: [u32; 2]| [0, 1].map(|k| extent[k].max(at[k] + size[k]));
        let free = |at: [u32; 2]| {
            let over = |[low, high]: &[[u32; 2]; 2]| {
                (0..2).all(|k| at[k] < high[k] && low[k] < at[k] + size[k])
            };
            grown(at).iter().all(|edge| *edge <= most) && !taken.iter().any(over)
        };
        let area = |at: [u32; 2]| grown(at).map(u64::from).iter().product::<u64>();
        let at = places.filter(|at| free(*at)).min_by_key(|at| area(*at))?;
        (extent, origins[i]) = (grown(at), at);
        taken.push([at, [0, 1].map(|k| (at[k] + size[k]).next_multiple_of(TILE))]);
    }
    Some((extent, origins))
}

/// Layout of the levels in the smoothing images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Atlas {
    /// Size of the images.
    pub extent: vk::Extent2D,
    /// Tiles per row.
    pub columns: u32,
    /// Rows of tiles.
    pub rows: u32,
    /// Tiles of the first level.
    pub first: u32,
    /// First texel of each level, a multiple of the tile size.
    origins: [[u32; 2]; 7],
}

impl Atlas {
    /// Lays the levels out in rows: the first level in one row, below it the others, beside each other in rows no
    /// wider than the first. If the rows together are higher than `most` texels, levels are placed wherever they fit;
    /// if they do not fit at all, the layout exceeds this limit.
    pub fn new(config: &Config, most: u32) -> Self {
        let first = reduced(config.extent, config.smoothing_level);
        let sizes: Vec<_> = levels(config)
            .map(|(i, coarser)| (i, reduced(config.extent, config.smoothing_level + coarser)))
            .collect();
        let rows = in_rows(&sizes);
        let fits = |(extent, _): &([u32; 2], _)| extent.iter().all(|edge| *edge <= most);
        let ([width, height], origins) =
            Some(rows).filter(fits).or_else(|| anywhere(&sizes, most)).unwrap_or(rows);
        let (columns, rows) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let first = first.width.div_ceil(TILE) * first.height.div_ceil(TILE);
        Self { extent: vk::Extent2D { width, height }, columns, rows, first, origins }
    }

    /// The layout on a device.
    pub fn of(gpu: &Gpu, config: &Config) -> Self {
        Self::within(config, &gpu.limits)
    }

    /// The layout within a device's limits for attachments.
    pub fn within(config: &Config, limits: &vk::PhysicalDeviceLimits) -> Self {
        let drawn = limits.max_framebuffer_width.min(limits.max_framebuffer_height);
        let [x, y] = limits.max_viewport_dimensions;
        Self::new(config, limits.max_image_dimension2_d.min(drawn).min(x).min(y))
    }

    /// Number of tiles.
    pub fn tiles(&self) -> u32 {
        self.columns * self.rows
    }
}

impl SmoothingLevels {
    /// The levels of a frame of this size.
    pub(crate) fn new(
        config: &Config,
        lens: &Lens,
        full: vk::Extent2D,
        water: &WaterSettings,
        atlas: &Atlas,
    ) -> Self {
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
    /// `None` if the configuration has no coarser levels.
    parts: Option<Parts>,
    /// Marks of the required tiles, [`NONE_MARKED`] after `reduce`.
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

    /// Records the pass `level`. Both smoothing images and the plan (iteration count and step of each pixel) must be in
    /// the state in which pass `reduce` leaves them, and are in the same state after pass `level`.
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
            // This list replaces that of `tiles`.
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
            // `reduce` wrote other parts of the same images.
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
            // SAFETY: cmd is recording outside a render pass, pipeline and set are bound; the groups are visible
            // (barrier).
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that no two levels share a tile, that the first level is at the corner, and that none exceeds the
    /// device's limit.
    fn assert_placed(config: &Config, most: u32) {
        let atlas = Atlas::new(config, most);
        let name = format!("{:?} of {most}: {atlas:?}", config.extent);
        let vk::Extent2D { width, height } = atlas.extent;
        assert!(width <= most && height <= most, "{name}");
        let rects: Vec<_> = levels(config)
            .map(|(i, coarser)| {
                let size = reduced(config.extent, config.smoothing_level + coarser);
                let [x, y] = atlas.origins[i];
                assert!(x + size.width <= width && y + size.height <= height, "{i}, {name}");
                assert!(x % TILE == 0 && y % TILE == 0, "{i}, {name}");
                let tiles = |from: u32, texels: u32| from / TILE..(from + texels).div_ceil(TILE);
                (tiles(x, size.width), tiles(y, size.height))
            })
            .collect();
        assert_eq!(rects[0], (0..rects[0].0.end, 0..rects[0].1.end), "{name}");
        assert_eq!(atlas.first, rects[0].0.end * rects[0].1.end);
        for (i, a) in rects.iter().enumerate() {
            for b in &rects[..i] {
                let apart = |a: &std::ops::Range<u32>, b: &std::ops::Range<u32>| {
                    a.end <= b.start || b.end <= a.start
                };
                assert!(apart(&a.0, &b.0) || apart(&a.1, &b.1), "{name}");
            }
        }
    }

    #[test]
    fn the_levels_fit_the_devices_images() {
        let edges = [1, 2, 15, 16, 17, 100, 1080, 2336, 2720, 4095, 4096];
        for (width, height) in edges.iter().flat_map(|w| edges.map(|h| (*w, h))) {
            for (sheets, coarsening) in [(1, 0), (2, 0), (2, 1), (2, 2), (1, 3), (2, 3)] {
                let extent = vk::Extent2D { width, height };
                let of = |smoothing_level| Config {
                    smoothing_level,
                    sheets,
                    coarsening,
                    ..Config::new(extent, vk::Format::R16G16B16A16_SFLOAT, 1)
                };
                // Partial tiles may add one tile to each row and column.
                let most = 4096;
                for level in [1, 2] {
                    assert_placed(&of(level), most);
                }
                if width.min(height) <= 2720
                    && (width.max(height) <= 2720 || width.min(height) < 1300)
                {
                    assert_placed(&of(0), most);
                }
            }
        }
    }

    /// If the levels fit in rows, they are placed in rows.
    #[test]
    fn levels_lie_in_rows_where_these_fit() {
        let extent = vk::Extent2D { width: 1920, height: 1080 };
        let config = Config::new(extent, vk::Format::R16G16B16A16_SFLOAT, 1);
        let [small, large] = [4096, 16384].map(|most| Atlas::new(&config, most));
        assert_eq!(small, large);
        assert_eq!(small.extent.width, 960);
    }
}
