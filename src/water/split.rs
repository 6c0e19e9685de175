//! Pass `split`: which of the tiles with water hold two sheets.
//!
//! Not in the source. Shading two sheets costs twice what shading one does; where both stand in one
//! shader, a CPU, and in part a GPU, pays for two everywhere.
//! Reads: the list of `tiles`, boundaries. Writes: two lists, the arguments of `composite`.

use ash::vk;
use gpu_allocator::MemoryLocation;

use super::Recording;
use super::gaps::{Gaps, sheets_constant};
use super::level::{Atlas, Level};
use super::tiles::{ALL_TILES, Tiles};
use crate::contract::Config;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_WRITE, FRAGMENT_READ, INDIRECT,
    VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;

/// The pass.
pub struct Split {
    split: Pipeline,
    end: Pipeline,
    /// Tiles of one sheet, then from the middle on those of two.
    pub lists: Buffer,
    lengths: Buffer,
    /// Four draws and four dispatches: one sheet and two at the configured level alone, the same
    /// elsewhere.
    pub arguments: Buffer,
    middle: u32,
}

impl Split {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        type Usage = vk::BufferUsageFlags;
        let make = |name, size, usage| {
            let usage = usage | Usage::STORAGE_BUFFER;
            Buffer::new(gpu, name, size, usage, MemoryLocation::GpuOnly)
        };
        Ok(Self {
            split: Pipeline::compute(gpu, shader::WATER_SPLIT_COMP, &[sheets_constant(config)])?,
            end: Pipeline::compute(gpu, shader::WATER_SPLIT_END_COMP, &[])?,
            lists: Self::lists(gpu, config)?,
            lengths: make("water/split/lengths", 8, Usage::TRANSFER_DST)?,
            arguments: make("water/split/arguments", 8 * 16, Usage::INDIRECT_BUFFER)?,
            middle: Atlas::new(config).tiles(),
        })
    }

    fn lists(gpu: &Gpu, config: &Config) -> Result<Buffer, Error> {
        let size = 8 * u64::from(Atlas::new(config).tiles());
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        Buffer::new(gpu, "water/split/lists", size, usage, MemoryLocation::GpuOnly)
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let lists = Self::lists(gpu, config)?;
        self.middle = Atlas::new(config).tiles();
        retired.replace(&mut self.lists, lists);
        Ok(())
    }

    /// Where the list of the tiles with two sheets begins.
    pub fn middle(&self) -> u32 {
        self.middle
    }

    pub fn record(
        &self,
        r: &mut Recording<'_>,
        tiles: &Tiles,
        level: &Level,
        gaps: Option<&Gaps>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"split");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let lengths = self.lengths.handle;
        // Fragments too: `composite` binds it in place of boundaries where there are none.
        let readers = COMPUTE_READ.and(VERTEX_READ).and(FRAGMENT_READ);
        gpu.barriers(cmd, &[], &[buffer(lengths, COMPUTE_READ, COPY_WRITE)]);
        // SAFETY: outside a render pass; the frame before has read it (barrier).
        unsafe { gpu.device.cmd_fill_buffer(cmd, lengths, 0, vk::WHOLE_SIZE, 0) };
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(lengths, COPY_WRITE, COMPUTE_READ_WRITE),
                buffer(self.lists.handle, readers, COMPUTE_WRITE),
                buffer(self.arguments.handle, COMPUTE_READ.and(INDIRECT), COMPUTE_WRITE),
            ],
        );
        r.descriptors.bind(
            gpu,
            cmd,
            &self.split,
            &[
                (0, r.uniforms),
                (1, Resource::buffer(&tiles.list)),
                (2, Resource::buffer(&tiles.arguments)),
                (3, Resource::buffer(&self.lists)),
                (4, Resource::buffer(&self.lengths)),
                (7, level.resource()),
                // Without it is not read: any buffer will do.
                (11, Resource::buffer(gaps.map_or(&tiles.list, |gaps| &gaps.boundaries))),
            ],
        )?;
        let count = self.middle;
        self.split.push(gpu, cmd, &count);
        // SAFETY: outside a render pass, pipeline and set are bound; the arguments are visible since
        // `tiles`.
        unsafe { gpu.device.cmd_dispatch_indirect(cmd, tiles.arguments.handle, ALL_TILES) };
        gpu.barriers(cmd, &[], &[buffer(lengths, COMPUTE_READ_WRITE, COMPUTE_READ)]);
        r.descriptors.bind(
            gpu,
            cmd,
            &self.end,
            &[
                (1, Resource::buffer(&self.lengths)),
                (2, Resource::buffer(&self.arguments)),
                (0, r.uniforms),
                (7, level.resource()),
            ],
        )?;
        // SAFETY: as above.
        unsafe { gpu.device.cmd_dispatch(cmd, 1, 1, 1) };
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.lists.handle, COMPUTE_WRITE, readers),
                buffer(self.arguments.handle, COMPUTE_WRITE, COMPUTE_READ.and(INDIRECT)),
            ],
        );
        r.end(scope);
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        self.lists.size + self.lengths.size + self.arguments.size
    }
}
