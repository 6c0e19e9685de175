//! Pass `front`: selects the spheres that can be visible, for the passes `depth` and `gaps`.
//!
//! Not in the thesis, which draws every particle: for each cell of 4×4 pixels, pass `front` finds the nearest depth
//! behind which nothing is visible, because a single sphere in front of it covers the whole cell. Then it removes
//! every sphere that lies behind this depth in all cells that the sphere touches. Large spheres are few, and are kept
//! without this test. The result is exact: the depth image is the same to the bit as without this pass. In a splashing
//! pool that is nine particles deep, six of ten spheres are removed; in deeper water the depth pass costs only as much
//! as the spheres at the surface.
//! Reads: the list of `cull`. Writes: cells, the front list.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::{Pod, Zeroable};

use super::cull::{Cull, LIST_USE, SMALL_GROUPS, SphereList};
use super::{Recording, shape};
use crate::contract::Config;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{CLEAR, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, buffer};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;

/// Side length of a cell in pixels.
const CELL: u32 = 4;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    capacity: u32,
    columns: i32,
    rows: i32,
}

/// Bytes of the cells for an extent.
pub fn cell_bytes(extent: vk::Extent2D) -> u64 {
    4 * u64::from(extent.width.div_ceil(CELL)) * u64::from(extent.height.div_ceil(CELL))
}

/// The pass.
pub struct Front {
    cover: Pipeline,
    keep: Pipeline,
    cells: Buffer,
    columns: u32,
    rows: u32,
    /// The spheres that can be visible.
    pub list: SphereList,
}

impl Front {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let (columns, rows, cells) = Self::cells(gpu, config)?;
        Ok(Self {
            cover: Pipeline::compute(
                gpu,
                shader::WATER_FRONT_COVER_COMP,
                &[shape::constant(config)],
            )?,
            keep: Pipeline::compute(gpu, shader::WATER_FRONT_COMP, &[shape::constant(config)])?,
            cells,
            columns,
            rows,
            list: SphereList::new(gpu, config, "water/front")?,
        })
    }

    fn cells(gpu: &Gpu, config: &Config) -> Result<(u32, u32, Buffer), Error> {
        let (columns, rows) =
            (config.extent.width.div_ceil(CELL), config.extent.height.div_ceil(CELL));
        let buffer = Buffer::new(
            gpu,
            "water/front/cells",
            cell_bytes(config.extent),
            vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST,
            MemoryLocation::GpuOnly,
        )?;
        Ok((columns, rows, buffer))
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let (columns, rows, cells) = Self::cells(gpu, config)?;
        retired.replace(&mut self.cells, cells);
        (self.columns, self.rows) = (columns, rows);
        Ok(())
    }

    pub fn record(&self, r: &mut Recording<'_>, cull: &Cull) -> Result<(), Error> {
        let scope = r.begin(c"front");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (counts, spheres) = (self.list.counts.handle, self.list.spheres.handle);
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.cells.handle, COMPUTE_READ, CLEAR),
                buffer(counts, LIST_USE, COMPUTE_WRITE),
                buffer(spheres, LIST_USE, COMPUTE_WRITE),
            ],
        );
        let empty = crate::frame::EMPTY.to_bits();
        // SAFETY: outside a render pass; the frame before has read the cells (barrier above).
        unsafe { gpu.device.cmd_fill_buffer(cmd, self.cells.handle, 0, vk::WHOLE_SIZE, empty) };
        cull.begin_list(r, &self.list)?;
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.cells.handle, CLEAR, COMPUTE_READ_WRITE),
                buffer(counts, COMPUTE_WRITE, COMPUTE_READ_WRITE),
            ],
        );
        self.dispatch(r, cull, &self.cover)?;
        gpu.barriers(cmd, &[], &[buffer(self.cells.handle, COMPUTE_READ_WRITE, COMPUTE_READ)]);
        self.dispatch(r, cull, &self.keep)?;
        gpu.barriers(cmd, &[], &[buffer(counts, COMPUTE_READ_WRITE, COMPUTE_READ_WRITE)]);
        cull.end_list(r, &self.list)?;
        gpu.barriers(
            cmd,
            &[],
            &[buffer(counts, COMPUTE_WRITE, LIST_USE), buffer(spheres, COMPUTE_WRITE, LIST_USE)],
        );
        r.end(scope);
        Ok(())
    }

    /// Dispatches one invocation per small sphere of every chunk.
    fn dispatch(&self, r: &Recording<'_>, cull: &Cull, pipeline: &Pipeline) -> Result<(), Error> {
        for (all, front) in cull.list.chunks().zip(self.list.chunks()) {
            r.descriptors.bind(
                r.gpu,
                r.cmd,
                pipeline,
                &[
                    (0, r.uniforms),
                    (1, all.counts),
                    (2, all.spheres),
                    (3, Resource::buffer(&self.cells)),
                    (4, front.counts),
                    (5, front.spheres),
                ],
            )?;
            let push = Push {
                capacity: all.capacity,
                columns: self.columns as i32,
                rows: self.rows as i32,
            };
            pipeline.push(r.gpu, r.cmd, &push);
            // SAFETY: outside a render pass; the arguments are visible since `cull`.
            unsafe {
                r.gpu.device.cmd_dispatch_indirect(
                    r.cmd,
                    cull.list.counts.handle,
                    all.arguments + SMALL_GROUPS,
                );
            }
        }
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        self.cells.size + self.list.memory()
    }
}
