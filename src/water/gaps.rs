//! Pass `gaps`: for each texel of the thickness the boundary between two layers of water: a depth in the air that
//! lies between them.
//!
//! Two layers are not in the thesis, whose thickness and refraction treat all water behind a pixel as one body (its
//! limitation, Fig. 5.13): a drop in front of a pool is then as dark and refracts as much as the pool.
//!
//! In each cell of 8×8 pixels, depth is divided into 256 slices of an eighth of a spacing. They begin at the cell's
//! nearest sphere and reach 32 spacings. Every sphere, except small flying drops, marks the slices within 0.8
//! spacings of its centre. A run of unmarked slices between marked ones is air if it is at least half a spacing long.
//! Shorter runs also occur inside water whose particles lie at random. Water beyond the 32 spacings counts as in the
//! last slice, so air there is not found. Marks need no sorting: a cell is nine words, written with atomics, for any
//! number of particles. A cell without air copies the air of a cell beside it.
//!
//! A texel of the thickness chooses the first wide air that lies behind the surface that the texel shows and in front
//! of a body of water. The four cells around the texel vote with bilinear weights. If a drop flies in front of a
//! crown of water in front of a pool, the boundary at the drop lies between drop and crown, and beside the drop
//! between crown and pool. Where two layers touch, `thickness` finds water around the boundary; there `composite`
//! merges them smoothly.
//! Reads: the lists of `front` and `cull`, depth. Writes: boundaries, the farthest of each block of texels.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::{Pod, Zeroable};

use super::cull::SphereList;
use super::depth::dispatch_sprites;
use super::{Recording, shape};
use crate::contract::Config;
use crate::error::Error;
use crate::frame::{EMPTY, reduced};
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, FRAGMENT_READ,
    buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::Image;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;

/// Side length of a cell in pixels.
const CELL: u32 = 8;
/// Words of a cell's marks (gaps.glsl).
const MARKS: u64 = 8;
/// Words of a cell's airs (gaps.glsl).
const AIRS: u64 = 4;
/// Side length of a block in pixels.
const BLOCK: u32 = 16;

/// The constant of sheets.glsl.
pub fn sheets_constant(config: &Config) -> (u32, u32) {
    (8, config.sheets)
}

/// Access of the passes that read the boundaries between layers: `thickness`, `back` and `split`, and `composite` as a
/// compute or a fragment shader.
pub const READ: Access = COMPUTE_READ.and(FRAGMENT_READ);

/// The pass.
pub struct Gaps {
    /// Pipelines for small and large spheres.
    nearest: [Pipeline; 2],
    marks: [Pipeline; 2],
    find: Pipeline,
    spread: Pipeline,
    texels: Pipeline,
    farthest: Pipeline,
    /// Nearest depths of all cells, then the marks of all cells.
    cells: Buffer,
    /// `found`: the runs of depth slices that are air, for every cell. `spread_out`: the same runs after cells
    /// without air have copied those of a neighbour.
    found: Buffer,
    spread_out: Buffer,
    /// Boundary of each thickness texel: an eye depth between its two layers; EMPTY where there is only one layer.
    pub boundaries: Buffer,
    /// Farthest boundary of each block of 16×16 pixels, for `thickness`.
    pub blocks: Buffer,
    level: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    columns: u32,
    rows: u32,
}

fn blocks(extent: vk::Extent2D) -> vk::Extent2D {
    vk::Extent2D { width: extent.width.div_ceil(BLOCK), height: extent.height.div_ceil(BLOCK) }
}

/// Bytes of the largest buffer that is bound as a whole.
pub fn bytes_bound(config: &Config) -> u64 {
    let thick = reduced(config.extent, config.thickness_level);
    let boundaries = 4 * u64::from(thick.width) * u64::from(thick.height);
    boundaries.max(4 * (1 + MARKS) * Push::new(config.extent).cells())
}

impl Push {
    fn new(extent: vk::Extent2D) -> Self {
        Self { columns: extent.width.div_ceil(CELL), rows: extent.height.div_ceil(CELL) }
    }

    fn cells(&self) -> u64 {
        u64::from(self.columns) * u64::from(self.rows)
    }
}

impl Gaps {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let make = |marks| {
            let make = |large| {
                let constants = [(0, large), (1, marks), shape::constant(config)];
                Pipeline::compute(gpu, shader::WATER_GAPS_COMP, &constants)
            };
            Ok::<_, Error>([make(0)?, make(1)?])
        };
        let [cells, found, spread_out, boundaries, blocks] = Self::sized(gpu, config)?;
        Ok(Self {
            nearest: make(0)?,
            marks: make(1)?,
            find: Pipeline::compute(gpu, shader::WATER_GAPS_FIND_COMP, &[])?,
            spread: Pipeline::compute(gpu, shader::WATER_GAPS_SPREAD_COMP, &[])?,
            texels: Pipeline::compute(gpu, shader::WATER_GAPS_TEXELS_COMP, &[])?,
            farthest: Pipeline::compute(gpu, shader::WATER_GAPS_BLOCKS_COMP, &[(0, 0)])?,
            cells,
            found,
            spread_out,
            boundaries,
            blocks,
            level: config.thickness_level,
        })
    }

    fn sized(gpu: &Gpu, config: &Config) -> Result<[Buffer; 5], Error> {
        type Usage = vk::BufferUsageFlags;
        let cells = Push::new(config.extent).cells();
        let thick = reduced(config.extent, config.thickness_level);
        let texels = u64::from(thick.width) * u64::from(thick.height);
        let make = |name, size, usage| {
            let usage = usage | Usage::STORAGE_BUFFER;
            Buffer::new(gpu, name, size, usage, MemoryLocation::GpuOnly)
        };
        Ok([
            make("water/gaps/cells", 4 * (1 + MARKS) * cells, Usage::TRANSFER_DST)?,
            make("water/gaps/found", 4 * AIRS * cells, Usage::empty())?,
            make("water/gaps/spread", 4 * AIRS * cells, Usage::empty())?,
            make("water/gaps/boundaries", 4 * texels, Usage::TRANSFER_SRC)?,
            blocks_buffer(gpu, "water/gaps/blocks", config)?,
        ])
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let [cells, found, spread_out, boundaries, blocks] = Self::sized(gpu, config)?;
        retired.replace(&mut self.cells, cells);
        retired.replace(&mut self.found, found);
        retired.replace(&mut self.spread_out, spread_out);
        retired.replace(&mut self.boundaries, boundaries);
        retired.replace(&mut self.blocks, blocks);
        Ok(())
    }

    /// `front` is the list of the spheres that can be visible; it suffices to find the nearest sphere of each cell.
    /// `all` is the list of all spheres on the screen, hidden ones too; they mark the depth slices that hold water.
    /// `depth` still contains water that the scene hides; `reduce` removes it later.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        front: &SphereList,
        all: &SphereList,
        depth: &Image,
    ) -> Result<(), Error> {
        let scope = r.begin(c"gaps");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let push = Push::new(r.extent);
        let words = 4 * push.cells();
        let handle = self.cells.handle;
        gpu.barriers(cmd, &[], &[buffer(handle, COMPUTE_READ, CLEAR)]);
        // SAFETY: outside a render pass; the frame before has read the cells (barrier).
        unsafe {
            gpu.device.cmd_fill_buffer(cmd, handle, 0, words, EMPTY.to_bits());
            gpu.device.cmd_fill_buffer(cmd, handle, words, MARKS * words, 0);
        }
        gpu.barriers(cmd, &[], &[buffer(handle, CLEAR, COMPUTE_READ_WRITE)]);
        let bound = [(3, Resource::buffer(&self.cells))];
        let [small, large] = &self.nearest;
        dispatch_sprites(r, front, small, large, &bound)?;
        gpu.barriers(cmd, &[], &[buffer(handle, COMPUTE_READ_WRITE, COMPUTE_READ_WRITE)]);
        let [small, large] = &self.marks;
        dispatch_sprites(r, all, small, large, &bound)?;

        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(handle, COMPUTE_READ_WRITE, COMPUTE_READ),
                buffer(self.found.handle, COMPUTE_READ, COMPUTE_WRITE),
                buffer(self.spread_out.handle, COMPUTE_READ, COMPUTE_WRITE),
                buffer(self.boundaries.handle, READ.and(COPY_READ), COMPUTE_WRITE),
            ],
        );
        let cells = vk::Extent2D { width: push.columns, height: push.rows };
        for (pipeline, from, to, extent) in [
            (&self.find, &self.cells, &self.found, cells),
            (&self.spread, &self.found, &self.spread_out, cells),
            (&self.texels, &self.spread_out, &self.boundaries, reduced(r.extent, self.level)),
        ] {
            let bound = [
                (0, r.uniforms),
                (1, Resource::buffer(from)),
                (2, Resource::buffer(to)),
                (3, Resource::storage(depth)),
            ];
            r.descriptors.bind(gpu, cmd, pipeline, &bound)?;
            pipeline.push(gpu, cmd, &push);
            r.dispatch_over(extent, pipeline.local_size);
            gpu.barriers(cmd, &[], &[buffer(to.handle, COMPUTE_WRITE, READ)]);
        }
        // `reduce` writes the depth.
        let read = access::image(depth, COMPUTE_READ, COMPUTE_READ_WRITE);
        gpu.barriers(cmd, &[read], &[]);
        dispatch_blocks(r, &self.farthest, &self.boundaries, &self.blocks)?;
        r.end(scope);
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        let found = self.cells.size + self.found.size + self.spread_out.size;
        found + self.boundaries.size + self.blocks.size
    }
}

/// A buffer with one value per block, for `dispatch_blocks`.
pub fn blocks_buffer(gpu: &Gpu, name: &str, config: &Config) -> Result<Buffer, Error> {
    let blocks = blocks(config.extent);
    let size = 4 * u64::from(blocks.width) * u64::from(blocks.height);
    Buffer::new(gpu, name, size, vk::BufferUsageFlags::STORAGE_BUFFER, MemoryLocation::GpuOnly)
}

/// Computes the farthest or the nearest boundary between layers in each block of 16×16 pixels; `pipeline` decides
/// which (gaps_blocks.comp).
pub fn dispatch_blocks(
    r: &Recording<'_>,
    pipeline: &Pipeline,
    boundaries: &Buffer,
    to: &Buffer,
) -> Result<(), Error> {
    r.gpu.barriers(r.cmd, &[], &[buffer(to.handle, COMPUTE_READ, COMPUTE_WRITE)]);
    let bound = [(0, r.uniforms), (1, Resource::buffer(to)), (11, Resource::buffer(boundaries))];
    r.descriptors.bind(r.gpu, r.cmd, pipeline, &bound)?;
    r.dispatch_over(blocks(r.extent), pipeline.local_size);
    r.gpu.barriers(r.cmd, &[], &[buffer(to.handle, COMPUTE_WRITE, COMPUTE_READ)]);
    Ok(())
}
