//! Pass `split`: sorts the tiles that are shaded into eight lists, by whether they hold two layers of water, foam,
//! and coarser smoothing levels.
//!
//! Not in the thesis. Shading two layers costs twice as much as shading one, and foam adds another half. With a
//! single shader for all tiles a CPU, and partly a GPU, would pay that cost in every tile.
//! Reads: the list of `tiles`, their work, boundaries, foam depth and thickness. Writes: eight lists, the arguments
//! of `composite`.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::Recording;
use super::gaps::{Gaps, sheets_constant};
use super::level::Atlas;
use super::surface_foam::Foam;
use super::tiles::{ALL_TILES, TILE, Tiles};
use crate::contract::Config;
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_WRITE, FRAGMENT_READ, INDIRECT,
    VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::Image;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;

/// Number of kinds of tiles: one layer of water or two, without or with foam, first smoothing level only or not.
pub const KINDS: u32 = 8;
/// Byte offset of the dispatches in the arguments: after one draw per kind.
pub const DISPATCHES: u64 = 16 * KINDS as u64;

/// The pass.
pub struct Split {
    split: Pipeline,
    end: Pipeline,
    /// Indices of the tiles, one list for each kind of tile, in this order: one layer of water, two layers, one with
    /// foam, two with foam; then these four kinds with coarser smoothing levels. Each list has room for all tiles of
    /// the first level.
    pub lists: Buffer,
    lengths: Buffer,
    /// Draws, then dispatches, one per kind.
    pub arguments: Buffer,
    /// Capacity of a list in tiles.
    pub most: u32,
}

/// Bytes of all lists.
pub fn list_bytes(config: &Config) -> u64 {
    let first = reduced(config.extent, config.smoothing_level);
    let tiles = u64::from(first.width.div_ceil(TILE)) * u64::from(first.height.div_ceil(TILE));
    4 * u64::from(KINDS) * tiles
}

impl Split {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        type Usage = vk::BufferUsageFlags;
        let make = |name, size, usage| {
            let usage = usage | Usage::STORAGE_BUFFER;
            Buffer::new(gpu, name, size, usage, MemoryLocation::GpuOnly)
        };
        Ok(Self {
            split: Pipeline::compute(
                gpu,
                shader::WATER_SPLIT_COMP,
                &[sheets_constant(config), (9, u32::from(config.surface_foam))],
            )?,
            end: Pipeline::compute(gpu, shader::WATER_SPLIT_END_COMP, &[])?,
            lists: Self::lists(gpu, config)?,
            lengths: make("water/split/lengths", 4 * u64::from(KINDS), Usage::TRANSFER_DST)?,
            arguments: make("water/split/arguments", 2 * DISPATCHES, Usage::INDIRECT_BUFFER)?,
            most: Atlas::of(gpu, config).first,
        })
    }

    fn lists(gpu: &Gpu, config: &Config) -> Result<Buffer, Error> {
        let size = list_bytes(config);
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
        self.most = Atlas::of(gpu, config).first;
        retired.replace(&mut self.lists, lists);
        Ok(())
    }

    pub fn record(
        &self,
        r: &mut Recording<'_>,
        tiles: &Tiles,
        gaps: Option<&Gaps>,
        foam: Option<&Foam>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"split");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let lengths = self.lengths.handle;
        let sampled = |image: &Image| Resource::Sampled(image.view, gpu.samplers.nearest);
        // Fragment shaders read the lists too: `composite` binds them in place of missing boundaries.
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
                (7, r.levels),
                (8, Resource::buffer(&tiles.work)),
                // Missing inputs are not read, so any buffer or image can be bound.
                (11, Resource::buffer(gaps.map_or(&tiles.list, |gaps| &gaps.boundaries))),
                (5, foam.map_or(r.scene_depth, |foam| sampled(foam.depth()))),
                (6, foam.map_or(r.scene_depth, |foam| sampled(foam.thickness()))),
            ],
        )?;
        self.split.push(gpu, cmd, &self.most);
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
                (7, r.levels),
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
