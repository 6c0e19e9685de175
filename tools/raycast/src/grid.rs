//! The ray-caster through a view-aligned density grid (Fraedrich et al. 2010): passes `prepare`, `tiles`, `count`,
//! `scan` of [`Cells`], which here are bricks of voxels, then `clear`, `splat` and `march`.
//!
//! There is one column of voxels per pixel, and one voxel per sample of its ray. The paper's grid is dense; here only
//! bricks with particles exist.

use whitewater::Error;
use whitewater::gpu_allocator::MemoryLocation;
use whitewater::headless::Device;

use crate::balls::{Balls, Chunk, shader};
use crate::cells::{Cells, Layout};
use crate::vulkan::{Buffer, FILL, Frame, Pass, READ, UPDATE};
use crate::{Input, Settings};

/// Samples of a brick along a ray. Fewer mean more bricks, more mean more empty voxels.
const SAMPLES: u32 = 8;
/// Edge of a tile in pixels.
const TILE: u32 = 4;

/// Layout of the grid's cells.
fn layout(settings: &Settings) -> Layout {
    let tile = settings.tile.unwrap_or(TILE);
    let voxels = u64::from(SAMPLES * tile * tile);
    Layout { tile, samples: SAMPLES, bricks: true, bytes_each: 4 * voxels }
}

/// Passes and buffers of the grid ray-caster.
pub(crate) struct Grid<'d> {
    pub cells: Cells<'d>,
    splat: Pass<'d>,
    march: Pass<'d>,
    voxels: Buffer<'d>,
}

impl<'d> Grid<'d> {
    pub fn new(device: &'d Device, input: &Input<'_>, settings: &Settings) -> Result<Self, Error> {
        let cells = Cells::new(device, input, settings, layout(settings))?;
        let constants = cells.balls.constants();
        let bytes = cells.layout.bytes_each * cells.room.total;
        Ok(Self {
            cells,
            splat: Pass::new(device, "splat", shader!("splat"), 5, &constants)?,
            march: Pass::new(device, "march", shader!("march_grid"), 7, &constants)?,
            voxels: Buffer::new(device, "voxels", bytes, MemoryLocation::GpuOnly)?,
        })
    }

    pub fn memory(&self) -> u64 {
        self.cells.memory() + self.voxels.size
    }

    pub fn record(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        let (cells, Balls { view, records, tiles, .. }) = (&self.cells, &self.cells.balls);
        let push = cells.push(chunk);
        cells.record(frame, chunk)?;
        frame.scope("clear", |frame| {
            frame.barrier(&[(&self.voxels, READ, FILL)]);
            frame.clear(&self.voxels);
            Ok(())
        })?;
        frame.scope("splat", |frame| {
            frame.barrier(&[(&self.voxels, FILL, UPDATE), (&cells.cells, UPDATE, READ)]);
            let buffers = [records, tiles, &cells.starts, &cells.cells, &self.voxels];
            frame.dispatch(&self.splat, view, &buffers, push, chunk.groups())
        })?;
        frame.scope("march", |frame| {
            let thickness = &cells.balls.thickness;
            frame.barrier(&[(&self.voxels, UPDATE, READ), (thickness, UPDATE, UPDATE)]);
            let buffers = [
                records,
                tiles,
                &cells.starts,
                &cells.cells,
                &self.voxels,
                &cells.balls.scene,
                thickness,
            ];
            frame.dispatch(&self.march, view, &buffers, push, cells.balls.tile_count)
        })
    }
}
