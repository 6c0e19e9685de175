//! Pass `shore-tiles`: lists the screen tiles that may contain foam on the host's surface. The sources have no such
//! list. It saves time because most of a picture has no foam, and this test is much cheaper than shading.
//!
//! Reads: scene depth, depth of the host's water surface, map of shore distances; for pass `contact` also the
//! particles' water depth. Writes: lists of tiles, and the indirect arguments of dispatches over them.

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::Given;
use crate::contract::Config;
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    Access, COMPUTE_READ, COMPUTE_READ_WRITE, COPY_WRITE, INDIRECT, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::Recording;

/// Number of halvings from pixels to tiles: tiles are 8×8 (glsl/include/shore_lists.glsl).
const LEVEL: u32 = 3;
/// Maximum number of tiles per run (glsl/include/shore_runs.glsl).
const LONGEST: u32 = 16;
/// Number of lists of screen tiles. Three are of tiles that on the host's water surface may contain only shoreline
/// foam, only contact foam, or both kinds. The fourth is of runs: neighbouring tiles of a row that have foam. The
/// fifth is of tiles that may contain contact foam on the particles' water.
const LISTS: u32 = 5;
/// Arguments of an empty draw and of five empty dispatches, with their tile counts (glsl/include/shore_lists.glsl).
const NO_TILES: [[u32; 4]; 6] =
    [[4, 0, 0, 0], [0, 0, 1, 0], [0, 0, 1, 0], [0, 0, 1, 0], [0, 0, 1, 0], [0, 0, 1, 0]];
/// Byte offset of the dispatch over the fourth list.
pub const COAT_DISPATCH: u64 = 64;
/// Byte offset of the dispatch over the fifth list.
pub const CONTACT_DISPATCH: u64 = 80;
/// Access of `shoreline` to the lists.
const SHADED: Access = COMPUTE_READ.and(INDIRECT);
/// Access of `composite` to the runs and their draw.
const READ: Access = COMPUTE_READ.and(VERTEX_READ).and(INDIRECT);

/// Size-dependent buffers.
struct Lists {
    /// Capacity of a list in tiles.
    most: u32,
    list: Buffer,
    /// One mark per tile: whether it has foam.
    marks: Buffer,
}

/// Number of tiles of an extent, along x and y.
pub fn extent_in_tiles(extent: vk::Extent2D) -> vk::Extent2D {
    reduced(extent, LEVEL)
}

/// Bytes of the lists of an extent.
pub fn list_bytes(extent: vk::Extent2D) -> u64 {
    let vk::Extent2D { width, height } = extent_in_tiles(extent);
    4 * u64::from(LISTS) * u64::from(width) * u64::from(height)
}

impl Lists {
    fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let vk::Extent2D { width: x, height: y } = extent_in_tiles(config.extent);
        let words = |name, each: u32| {
            // Tests copy from these buffers.
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER
                | vk::BufferUsageFlags::TRANSFER_DST
                | vk::BufferUsageFlags::TRANSFER_SRC;
            let bytes = 4 * u64::from(each) * u64::from(x) * u64::from(y);
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        Ok(Self { most: x * y, marks: words("shore/marks", 1)?, list: words("shore/list", LISTS)? })
    }
}

/// The pass.
pub struct Tiles {
    /// Pipelines for most frames, and for the general case (glsl/include/shore.glsl).
    pipelines: [Pipeline; 2],
    /// These two pipelines for the particles' water.
    on_particles: [Pipeline; 2],
    runs: Pipeline,
    /// Arguments of the draw of the tiles' quads and of the dispatches.
    arguments: Buffer,
    lists: Lists,
}

impl Tiles {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::TRANSFER_DST;
        let name = "shore/arguments";
        let ways = |shader| -> Result<_, Error> {
            let way = |general| Pipeline::compute(gpu, shader, &[(3, general)]);
            Ok([way(0)?, way(1)?])
        };
        Ok(Self {
            pipelines: ways(shader::SHORE_TILES_COMP)?,
            on_particles: ways(shader::SHORE_CONTACT_TILES_COMP)?,
            runs: Pipeline::compute(gpu, shader::SHORE_RUNS_COMP, &[])?,
            arguments: Buffer::new(gpu, name, 96, usage, MemoryLocation::GpuOnly)?,
            lists: Lists::new(gpu, config)?,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let new = Lists::new(gpu, config)?;
        self.lists.most = new.most;
        retired.replace(&mut self.lists.marks, new.marks);
        retired.replace(&mut self.lists.list, new.list);
        Ok(())
    }

    /// The lists, the arguments, and the marks.
    pub fn buffers(&self) -> [&Buffer; 3] {
        [&self.lists.list, &self.arguments, &self.lists.marks]
    }

    /// Number of tiles per row of a frame, and capacity of a list.
    pub fn places(&self, extent: vk::Extent2D) -> [u32; 2] {
        [extent_in_tiles(extent).width, self.lists.most]
    }

    /// `general` selects the general pipeline.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        (given, general): (&Given<'_>, bool),
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let [list, arguments, marks] = self.buffers();
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(marks.handle, COMPUTE_READ, COPY_WRITE),
                buffer(arguments.handle, READ, COPY_WRITE),
                buffer(list.handle, READ, COMPUTE_READ_WRITE),
            ],
        );
        // SAFETY: outside a render pass; the frame before has read both (barrier).
        unsafe {
            gpu.device.cmd_fill_buffer(cmd, marks.handle, 0, vk::WHOLE_SIZE, 0);
            let none = bytemuck::bytes_of(&NO_TILES);
            gpu.device.cmd_update_buffer(cmd, arguments.handle, 0, none);
        }
        let filled = [
            buffer(marks.handle, COPY_WRITE, COMPUTE_READ_WRITE),
            buffer(arguments.handle, COPY_WRITE, COMPUTE_READ_WRITE),
        ];
        gpu.barriers(cmd, &[], &filled);
        if given.shore.is_some_and(|shore| shore.surface.is_some()) {
            let pipeline = &self.pipelines[usize::from(general)];
            let resources = [
                (0, r.uniforms),
                (1, r.shore),
                (2, r.scene_depth),
                // Missing inputs are bound but not read.
                (3, given.surface.unwrap_or(r.scene_depth)),
                (6, given.map(gpu).unwrap_or(r.scene_depth)),
                (9, Resource::buffer(list)),
                (10, Resource::buffer(arguments)),
            ];
            r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
            pipeline.push(gpu, cmd, &self.places(r.extent));
            r.dispatch_over(extent_in_tiles(r.extent), pipeline.local_size);
        }
        let made = [
            buffer(list.handle, COMPUTE_READ_WRITE, SHADED),
            buffer(arguments.handle, COMPUTE_READ_WRITE, SHADED),
        ];
        gpu.barriers(cmd, &[], &made);
        Ok(())
    }

    /// Lists the tiles that may contain contact foam on the particles' water, from that water's `depth`. The list and
    /// the arguments of its dispatch are readable afterwards.
    pub fn record_on_particles(
        &self,
        r: &mut Recording<'_>,
        depth: Resource,
        general: bool,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let [list, arguments, _] = self.buffers();
        let own = |from, to| [list, arguments].map(|own| buffer(own.handle, from, to));
        gpu.barriers(cmd, &[], &own(READ, COMPUTE_READ_WRITE));
        let pipeline = &self.on_particles[usize::from(general)];
        let resources = [
            (0, r.uniforms),
            (1, r.shore),
            (2, r.scene_depth),
            (3, depth),
            (9, Resource::buffer(list)),
            (10, Resource::buffer(arguments)),
        ];
        r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
        pipeline.push(gpu, cmd, &self.places(r.extent));
        r.dispatch_over(extent_in_tiles(r.extent), pipeline.local_size);
        gpu.barriers(cmd, &[], &own(COMPUTE_READ_WRITE, READ));
        Ok(())
    }

    /// Merges the tiles that `shoreline` has marked as having foam into runs of up to 16 neighbours, for `composite`.
    pub fn record_runs(&self, r: &Recording<'_>) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let [list, arguments, marks] = self.buffers();
        let own = |from, to| [list, arguments].map(|own| buffer(own.handle, from, to));
        let marked = buffer(marks.handle, COMPUTE_READ_WRITE, COMPUTE_READ);
        gpu.barriers(cmd, &[], &[&own(SHADED, COMPUTE_READ_WRITE)[..], &[marked]].concat());
        let resources = [
            (9, Resource::buffer(list)),
            (10, Resource::buffer(arguments)),
            (11, Resource::buffer(marks)),
        ];
        r.descriptors.bind(gpu, cmd, &self.runs, &resources)?;
        self.runs.push(gpu, cmd, &self.places(r.extent));
        let vk::Extent2D { width, height } = extent_in_tiles(r.extent);
        let rows = vk::Extent2D { width: width.div_ceil(LONGEST), height };
        r.dispatch_over(rows, self.runs.local_size);
        gpu.barriers(cmd, &[], &own(COMPUTE_READ_WRITE, READ));
        Ok(())
    }

    /// Bytes of buffers.
    pub fn memory(&self) -> u64 {
        self.lists.marks.size + self.lists.list.size + self.arguments.size
    }
}
