//! The kernel ray-caster (Ihmsen et al. 2012): passes `prepare`, `tiles`, `count`, `scan` of [`Cells`], then `fill`
//! and `march`.

use whitewater::Error;
use whitewater::gpu_allocator::MemoryLocation;
use whitewater::headless::Device;

use crate::balls::{Balls, Chunk, shader};
use crate::cells::{Cells, Layout};
use crate::vulkan::{Buffer, Frame, Pass, READ, UPDATE, WRITE};
use crate::{Input, Settings};

/// Least thickness of a cell in radii. In thinner cells a particle lies in more of them. Thicker ones cost no time,
/// because only samples inside a particle are evaluated, but they make steps grow less evenly: the step is constant
/// within a slab.
const SLAB: f32 = 32.0;
/// Edge of a tile in pixels.
const TILE: u32 = 4;

/// Samples per slab, for the step of the settings.
pub(crate) fn samples(settings: &Settings) -> u32 {
    (SLAB / settings.step).ceil().max(1.0) as u32
}

/// Layout of the kernel ray-caster's cells.
fn layout(settings: &Settings) -> Layout {
    let samples = samples(settings);
    Layout { tile: settings.tile.unwrap_or(TILE), samples, bricks: false, bytes_each: 4 }
}

/// Passes and buffers of the kernel ray-caster.
pub(crate) struct Kernel<'d> {
    pub cells: Cells<'d>,
    fill: Pass<'d>,
    march: Pass<'d>,
    entries: Buffer<'d>,
}

impl<'d> Kernel<'d> {
    pub fn new(device: &'d Device, input: &Input<'_>, settings: &Settings) -> Result<Self, Error> {
        let cells = Cells::new(device, input, settings, layout(settings))?;
        let constants = cells.balls.constants();
        let bytes = 4 * cells.room.total;
        Ok(Self {
            cells,
            fill: Pass::new(device, "fill", shader!("fill"), 5, &constants)?,
            march: Pass::new(device, "march", shader!("march_kernel"), 7, &constants)?,
            entries: Buffer::new(device, "entries", bytes, MemoryLocation::GpuOnly)?,
        })
    }

    pub fn memory(&self) -> u64 {
        self.cells.memory() + self.entries.size
    }

    pub fn record(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        let (cells, Balls { view, records, tiles, .. }) = (&self.cells, &self.cells.balls);
        let push = cells.push(chunk);
        cells.record(frame, chunk)?;
        frame.scope("fill", |frame| {
            frame.barrier(&[(&cells.cells, UPDATE, UPDATE), (&self.entries, READ, WRITE)]);
            let buffers = [records, tiles, &cells.starts, &cells.cells, &self.entries];
            frame.dispatch(&self.fill, view, &buffers, push, chunk.groups())
        })?;
        frame.scope("march", |frame| {
            let thickness = &cells.balls.thickness;
            frame.barrier(&[
                (&cells.cells, UPDATE, READ),
                (&self.entries, WRITE, READ),
                (thickness, UPDATE, UPDATE),
            ]);
            let buffers = [
                records,
                tiles,
                &cells.starts,
                &cells.cells,
                &self.entries,
                &cells.balls.scene,
                thickness,
            ];
            frame.dispatch(&self.march, view, &buffers, push, cells.balls.tile_count)
        })
    }
}
