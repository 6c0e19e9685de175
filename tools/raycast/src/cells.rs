//! Cells, each one slab of depth in one tile of the picture (passes `tiles`, `count`, `scan`). The kernel and the grid
//! ray-caster use them to find the particles along a ray.
//!
//! The cells of a tile extend from its first slab with particles to its last one or to the scene, so empty space in
//! front, between tiles and behind costs nothing.

use whitewater::Error;
use whitewater::gpu_allocator::MemoryLocation;
use whitewater::headless::Device;

use crate::balls::{Balls, Chunk, GROUP, shader};
use crate::scan::Scan;
use crate::vulkan::{Buffer, FILL, Frame, Pass, READ, UPDATE, WRITE};
use crate::{Input, Settings, bad};

/// Layout of the cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// Edge of a tile in pixels.
    pub tile: u32,
    /// Samples per slab.
    pub samples: u32,
    /// Occupied cells are numbered as bricks; their particles are not counted.
    pub bricks: bool,
    /// Bytes per entry, or per brick.
    pub bytes_each: u64,
}

/// Capacity of the buffers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Room {
    cells: u64,
    /// Entries, or bricks.
    pub total: u64,
}

/// Passes and buffers that the kernel and the grid ray-caster share.
pub(crate) struct Cells<'d> {
    pub balls: Balls<'d>,
    lengths: Pass<'d>,
    tile_scan: Scan<'d>,
    count: Pass<'d>,
    cell_scan: Scan<'d>,
    pub layout: Layout,
    pub room: Room,
    pub starts: Buffer<'d>,
    blocks: Buffer<'d>,
    pub cells: Buffer<'d>,
}

impl<'d> Cells<'d> {
    pub fn new(
        device: &'d Device,
        input: &Input<'_>,
        settings: &Settings,
        layout: Layout,
    ) -> Result<Self, Error> {
        let balls = Balls::new(device, input, settings, layout.tile, layout.samples)?;
        let tiles = balls.tiles.size / 16;
        let on_device = |name, bytes| Buffer::new(device, name, bytes, MemoryLocation::GpuOnly);
        let constants = [(0, u32::from(layout.bricks)), (1, layout.tile)];
        let pass = |name, code, buffers| Pass::new(device, name, code, buffers, &constants);
        let mut cells = Self {
            balls,
            lengths: pass("lengths", shader!("lengths"), 2)?,
            tile_scan: Scan::new(device, false)?,
            count: pass("count", shader!("count"), 4)?,
            cell_scan: Scan::new(device, layout.bricks)?,
            layout,
            room: Room::default(),
            starts: on_device("starts", 4 * tiles)?,
            blocks: on_device("blocks", Scan::bytes(tiles))?,
            cells: on_device("cells", 0)?,
        };
        cells.make_room(device, input, settings)?;
        Ok(cells)
    }

    pub fn memory(&self) -> u64 {
        let own = [&self.starts, &self.blocks, &self.cells];
        self.balls.memory() + own.into_iter().map(|buffer| buffer.size).sum::<u64>()
    }

    /// Push constants of the passes over particles and cells.
    pub fn push(&self, chunk: &Chunk<'_>) -> [u32; 3] {
        [chunk.count, self.room.cells as u32, self.room.total as u32]
    }

    /// Finds a chunk size whose cells and entries fit on the device.
    fn make_room(
        &mut self,
        device: &'d Device,
        input: &Input<'_>,
        settings: &Settings,
    ) -> Result<(), Error> {
        let mut size = self.balls.most(input.foam.positions.len(), settings);
        loop {
            if self.fits(device, input, size)? {
                return Ok(());
            }
            if size <= GROUP as usize {
                let why = "too fine: its cells do not fit into the device's storage buffers";
                return Err(bad("Settings.step", why.into()));
            }
            size = size.div_ceil(2);
        }
    }

    fn fits(&mut self, device: &'d Device, input: &Input<'_>, size: usize) -> Result<bool, Error> {
        self.balls.take(device, input, size)?;
        let (range, location) = (self.balls.range, MemoryLocation::GpuOnly);
        let tiles = self.balls.tiles.size / 16;
        self.room = Room::default();
        for i in 0..self.balls.chunks.len() {
            let chunk = &self.balls.chunks[i];
            self.balls.queue.run(|frame| self.record_tiles(frame, chunk))?;
            let cells = self.total(tiles)?;
            if 4 * cells > range {
                return Ok(false);
            }
            if cells > self.room.cells {
                self.room.cells = cells;
                self.cells = Buffer::new(device, "cells", 4 * cells, location)?;
                let blocks = Scan::bytes(cells.max(tiles));
                self.blocks = Buffer::new(device, "blocks", blocks, location)?;
            }
            let chunk = &self.balls.chunks[i];
            self.balls.queue.run(|frame| self.record_counts(frame, chunk))?;
            let total = self.total(self.room.cells)?;
            if self.layout.bytes_each * total > range {
                return Ok(false);
            }
            self.room.total = self.room.total.max(total);
        }
        Ok(true)
    }

    /// Total that a prefix sum of `count` values left.
    fn total(&self, count: u64) -> Result<u64, Error> {
        Ok(self.balls.queue.read(&self.blocks, Scan::sum_of(count), 1)?[0].into())
    }

    /// Records passes `prepare` and `tiles`.
    fn record_tiles(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        let Balls { view, tiles, tile_count, .. } = &self.balls;
        let count = tile_count[0] * tile_count[1];
        self.balls.record_prepare(frame, chunk)?;
        frame.scope("tiles", |frame| {
            frame.barrier(&[(tiles, UPDATE, READ), (&self.starts, READ, WRITE)]);
            let groups = [count.div_ceil(GROUP), 1];
            frame.dispatch(&self.lengths, view, &[tiles, &self.starts], [0; 3], groups)?;
            self.tile_scan.record(frame, view, &self.blocks, &self.starts, count.into())
        })
    }

    /// Records passes `count` and `scan`.
    fn record_counts(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        let Balls { view, tiles, records, .. } = &self.balls;
        frame.scope("count", |frame| {
            frame.barrier(&[(&self.cells, UPDATE, FILL)]);
            frame.clear(&self.cells);
            frame.barrier(&[
                (&self.cells, FILL, UPDATE),
                (&self.starts, UPDATE, READ),
                (records, WRITE, READ),
            ]);
            let buffers = [records, tiles, &self.starts, &self.cells];
            frame.dispatch(&self.count, view, &buffers, self.push(chunk), chunk.groups())
        })?;
        frame.scope("scan", |frame| {
            self.cell_scan.record(frame, view, &self.blocks, &self.cells, self.room.cells)
        })
    }

    /// Records the passes that build the cells of a chunk.
    pub fn record(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        self.record_tiles(frame, chunk)?;
        self.record_counts(frame, chunk)
    }
}
