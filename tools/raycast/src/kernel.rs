//! The kernel ray-caster (Ihmsen et al. 2012): passes `prepare`, `tiles`, `count`, `scan` of [`Cells`], then `fill`
//! and `march`.

use whitewater::Error;
use whitewater::gpu_allocator::MemoryLocation;
use whitewater::headless::Device;

use crate::Settings;
use crate::cells::{Cells, Chunk, Layout, shader};
use crate::vulkan::{Buffer, Frame, Pass, READ, UPDATE, WRITE};

/// Thickness of a cell in radii, at least: with thinner ones a particle lies in more of them; thicker ones cost
/// nothing, as of a particle only the samples that lie in it are taken, but steps grow only from slab to slab.
const SLAB: f32 = 32.0;
/// Edge of a tile in pixels.
const TILE: u32 = 4;

/// Of its cells.
pub(crate) fn layout(settings: &Settings) -> Layout {
    let samples = (SLAB / settings.step).ceil().max(1.0) as u32;
    Layout { tile: settings.tile.unwrap_or(TILE), samples, bricks: false, bytes_each: 4 }
}

/// Its own passes.
pub(crate) struct Kernel<'d> {
    fill: Pass<'d>,
    march: Pass<'d>,
    entries: Buffer<'d>,
}

impl<'d> Kernel<'d> {
    pub fn new(device: &'d Device, cells: &Cells<'d>) -> Result<Self, Error> {
        let constants = cells.constants();
        let bytes = 4 * cells.room.total;
        Ok(Self {
            fill: Pass::new(device, "fill", shader!("fill"), 5, &constants)?,
            march: Pass::new(device, "march", shader!("march_kernel"), 7, &constants)?,
            entries: Buffer::new(device, "entries", bytes, MemoryLocation::GpuOnly)?,
        })
    }

    pub fn memory(&self) -> u64 {
        self.entries.size
    }

    pub fn record(
        &self,
        frame: &mut Frame<'_>,
        cells: &Cells<'_>,
        chunk: &Chunk<'_>,
    ) -> Result<(), Error> {
        let (view, push) = (&cells.view, cells.push(chunk));
        frame.scope("fill", |frame| {
            frame.barrier(&[(&cells.cells, UPDATE, UPDATE), (&self.entries, READ, WRITE)]);
            let buffers =
                [&cells.records, &cells.tiles, &cells.starts, &cells.cells, &self.entries];
            frame.dispatch(&self.fill, view, &buffers, push, chunk.groups())
        })?;
        frame.scope("march", |frame| {
            frame.barrier(&[
                (&cells.cells, UPDATE, READ),
                (&self.entries, WRITE, READ),
                (&cells.thickness, UPDATE, UPDATE),
            ]);
            let buffers = [
                &cells.records,
                &cells.tiles,
                &cells.starts,
                &cells.cells,
                &self.entries,
                &cells.scene,
                &cells.thickness,
            ];
            frame.dispatch(&self.march, view, &buffers, push, cells.tile_count)
        })
    }
}
