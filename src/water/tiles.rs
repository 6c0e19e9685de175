//! Pass `tiles`: lists the tiles with work, 16×16 texels of the smoothing images each, in all levels of the
//! smoothing: tiles with water, and tiles that show only foam, spray, whitewater particles or bubble foam, which have
//! to be shaded too. It sorts them by their iteration counts, largest first, and writes the arguments of every draw
//! and dispatch over them.
//!
//! Not in the thesis, which draws full-screen quads. Iteration counts are known in advance, so the tiles that are
//! still active in iteration i are a prefix of the sorted list, and one counting sort gives the arguments of all
//! iterations.
//! Reads: each tile's work, levels. Writes: list, arguments.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::{Pod, Zeroable};

use super::Recording;
use super::level::Atlas;
use crate::contract::Config;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{COMPUTE_READ, COMPUTE_WRITE, INDIRECT, VERTEX_READ, buffer};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;

/// Side length of a tile in smoothing texels.
pub const TILE: u32 = 16;
/// Maximum number of workgroups over tiles; if there are more tiles, a group processes several.
pub const MOST_GROUPS: u32 = 65_535;
/// Bytes of all arguments, 16 each: the draw of the tiles with work, 257 dispatches for the iterations, the dispatch
/// over the tiles with work.
const ARGUMENTS: u64 = 16 * 259;
/// Byte offset of the last arguments.
pub const ALL_TILES: u64 = 16 * 258;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    tiles: u32,
    most_groups: u32,
}

/// The pass.
pub struct Tiles {
    pipeline: Pipeline,
    /// Work of each tile, row by row. Low 16 bits: the largest iteration count of the tile's texels plus 1, or 0 if
    /// nothing in it has to be smoothed or shaded. The high bits hold its smoothing levels.
    pub work: Buffer,
    /// Indices of the tiles with work, largest work first.
    pub list: Buffer,
    /// Arguments of indirect commands, four words each. `[0]`: a draw of the tiles in `list`, those with work (a
    /// strip of four vertices, one instance per tile). `[i]`, i from 1 to 257: the dispatch of smoothing iteration i;
    /// the fourth word is the number of tiles that this iteration processes. `[258]`: a dispatch over the tiles in
    /// `list`; the fourth word is their number.
    pub arguments: Buffer,
    /// Layout of the levels.
    pub atlas: Atlas,
}

impl Tiles {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let atlas = Atlas::of(gpu, config);
        let (work, list) = Self::sized(gpu, &atlas)?;
        Ok(Self {
            pipeline: Pipeline::compute(gpu, shader::WATER_TILES_COMP, &[])?,
            work,
            list,
            arguments: Buffer::new(
                gpu,
                "water/tiles/arguments",
                ARGUMENTS,
                vk::BufferUsageFlags::STORAGE_BUFFER
                    | vk::BufferUsageFlags::INDIRECT_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_SRC,
                MemoryLocation::GpuOnly,
            )?,
            atlas,
        })
    }

    fn sized(gpu: &Gpu, atlas: &Atlas) -> Result<(Buffer, Buffer), Error> {
        let make = |name| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
            Buffer::new(gpu, name, 4 * u64::from(atlas.tiles()), usage, MemoryLocation::GpuOnly)
        };
        Ok((make("water/tiles/work")?, make("water/tiles/list")?))
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let atlas = Atlas::of(gpu, config);
        let (work, list) = Self::sized(gpu, &atlas)?;
        retired.replace(&mut self.work, work);
        retired.replace(&mut self.list, list);
        self.atlas = atlas;
        Ok(())
    }

    pub fn record(&self, r: &mut Recording<'_>) -> Result<(), Error> {
        let scope = r.begin(c"tiles");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let readers = COMPUTE_READ.and(VERTEX_READ);
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.list.handle, readers, COMPUTE_WRITE),
                buffer(self.arguments.handle, COMPUTE_READ.and(INDIRECT), COMPUTE_WRITE),
            ],
        );
        r.descriptors.bind(
            gpu,
            cmd,
            &self.pipeline,
            &[
                (0, r.uniforms),
                (1, Resource::buffer(&self.work)),
                (2, Resource::buffer(&self.list)),
                (3, Resource::buffer(&self.arguments)),
                (7, r.levels),
            ],
        )?;
        self.pipeline.push(gpu, cmd, &Push { tiles: self.atlas.tiles(), most_groups: MOST_GROUPS });
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, 1, 1, 1) };
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.list.handle, COMPUTE_WRITE, readers),
                buffer(self.arguments.handle, COMPUTE_WRITE, COMPUTE_READ.and(INDIRECT)),
            ],
        );
        r.end(scope);
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        self.work.size + self.list.size + self.arguments.size
    }
}
