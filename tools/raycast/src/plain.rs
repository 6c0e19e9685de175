//! The plain ray-caster (Ihmsen et al. 2012, in its straightforward form): pass `prepare` of [`Balls`], then
//! `count`, `scan` and `sort` of the balls into cells in space, then `march`, which searches the cells around
//! each sample.
//!
//! Cells are hashed, not stored one by one: a grid around a sea has thousands of times as many cells as
//! particles. Memory is therefore proportional to the particles: a record, its sorted copy, its index, two to
//! four buckets.

use whitewater::Error;
use whitewater::gpu_allocator::MemoryLocation;
use whitewater::headless::Device;

use crate::balls::{Balls, Chunk, shader};
use crate::scan::Scan;
use crate::vulkan::{Buffer, FILL, Frame, Pass, READ, UPDATE, WRITE};
use crate::{Input, Settings, bad, kernel};

/// Edge of a cell, in reaches of the largest ball. With 1, a sample searches nine runs of three cells; with 2, four
/// runs of two; with 4, about two runs, each with more balls. The largest was fastest, because most cells are empty and
/// each costs a look-up.
const CELL: f32 = 4.0;
/// Edge of a group in pixels.
const TILE: u32 = 8;
/// Rounds per chunk of particles: those tried first, and the most.
const ROUNDS: [u32; 2] = [16, 256];
/// Most buckets of a row. Cells farther out share the last one.
const MOST_ACROSS: f32 = 65_536.0;

/// Passes and buffers of the plain ray-caster.
pub(crate) struct Plain<'d> {
    pub balls: Balls<'d>,
    count: Pass<'d>,
    scan: Scan<'d>,
    sort: Pass<'d>,
    march: Pass<'d>,
    places: Buffer<'d>,
    cells: Buffer<'d>,
    blocks: Buffer<'d>,
    sorted: Buffer<'d>,
    /// Corners of the bounding box of all balls, and the number of rounds that left unfinished rays.
    bounds: Buffer<'d>,
    /// Next sample of each ray.
    rays: Buffer<'d>,
    /// Rounds of `march` per chunk.
    rounds: u32,
    /// Number of buckets where a row may begin, minus 1.
    mask: u32,
    /// Buckets per row.
    span: u32,
}

impl<'d> Plain<'d> {
    pub fn new(device: &'d Device, input: &Input<'_>, settings: &Settings) -> Result<Self, Error> {
        let tile = settings.tile.unwrap_or(TILE);
        // The samples lie where those of the kernel ray-caster lie.
        let samples = kernel::samples(settings);
        let mut balls = Balls::new(device, input, settings, tile, samples)?;
        let size = balls.most(input.foam.positions.len(), settings);
        balls.take(device, input, size)?;
        let starts = (2 * size as u32).next_power_of_two();
        // At each depth, a cell is at least as wide as the least ball.
        let across = (2.0 * balls.widest_slope / balls.least_reach).ceil();
        let span = across.min(MOST_ACROSS) as u32 + 8;
        let buckets = u64::from(starts) + u64::from(span);
        let constants = [(1, tile), (2, settings.cell.unwrap_or(CELL).to_bits())];
        let pass = |name, code, buffers| Pass::new(device, name, code, buffers, &constants);
        let on_device = |name, bytes| Buffer::new(device, name, bytes, MemoryLocation::GpuOnly);
        let mut plain = Self {
            count: pass("count", shader!("plain_count"), 4)?,
            scan: Scan::new(device, false)?,
            sort: pass("sort", shader!("plain_sort"), 4)?,
            march: pass("march", shader!("march_plain"), 6)?,
            places: on_device("places", 8 * size as u64)?,
            cells: on_device("cells", 4 * buckets)?,
            blocks: on_device("blocks", Scan::bytes(buckets))?,
            sorted: on_device("sorted", balls.records.size)?,
            bounds: on_device("bounds", 28)?,
            rays: on_device("rays", balls.thickness.size)?,
            rounds: 0,
            mask: starts - 1,
            span,
            balls,
        };
        plain.find_rounds()?;
        Ok(plain)
    }

    /// Finds how many rounds the longest ray needs.
    fn find_rounds(&mut self) -> Result<(), Error> {
        let queue = &self.balls.queue;
        for chunk in &self.balls.chunks {
            let [mut tried, most] = ROUNDS;
            loop {
                queue.run(|frame| {
                    self.balls.record_begin(frame);
                    self.record_rounds(frame, chunk, tried)
                })?;
                let left = queue.read(&self.bounds, 6, 1)?[0];
                if left < tried {
                    self.rounds = self.rounds.max(left + 1);
                    break;
                }
                if tried >= most {
                    let why = "too fine: rays take too many rounds";
                    return Err(bad("Settings.step", why.into()));
                }
                tried *= 4;
            }
        }
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        let own = [&self.places, &self.cells, &self.blocks, &self.sorted, &self.bounds, &self.rays];
        self.balls.memory() + own.into_iter().map(|buffer| buffer.size).sum::<u64>()
    }

    pub fn record(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        self.record_rounds(frame, chunk, self.rounds)
    }

    fn record_rounds(
        &self,
        frame: &mut Frame<'_>,
        chunk: &Chunk<'_>,
        rounds: u32,
    ) -> Result<(), Error> {
        let Self { places, cells, sorted, bounds, rays, .. } = self;
        let Balls { view, records, scene, thickness, .. } = &self.balls;
        let push = |count| [count, self.mask, self.span];
        self.balls.record_prepare(frame, chunk)?;
        frame.scope("count", |frame| {
            frame.barrier(&[(cells, READ, FILL), (bounds, UPDATE, FILL)]);
            frame.clear(cells);
            frame.clear(bounds);
            frame.barrier(&[
                (cells, FILL, UPDATE),
                (bounds, FILL, UPDATE),
                (places, READ, WRITE),
                (records, WRITE, READ),
            ]);
            let buffers = [records, places, cells, bounds];
            frame.dispatch(&self.count, view, &buffers, push(chunk.count), chunk.groups())
        })?;
        frame.scope("scan", |frame| {
            self.scan.record(frame, view, &self.blocks, cells, cells.size / 4)
        })?;
        frame.scope("sort", |frame| {
            frame.barrier(&[(cells, UPDATE, UPDATE), (places, WRITE, READ), (sorted, READ, WRITE)]);
            let buffers = [records, places, cells, sorted];
            frame.dispatch(&self.sort, view, &buffers, push(chunk.count), chunk.groups())
        })?;
        frame.scope("march", |frame| {
            frame.barrier(&[(rays, UPDATE, FILL)]);
            frame.clear(rays);
            frame.barrier(&[(cells, UPDATE, READ), (sorted, WRITE, READ), (rays, FILL, UPDATE)]);
            let buffers = [cells, sorted, bounds, scene, thickness, rays];
            for round in 0..rounds {
                let uses = [bounds, rays, thickness].map(|buffer| (buffer, UPDATE, UPDATE));
                frame.barrier(&uses);
                let groups = self.balls.tile_count;
                frame.dispatch(&self.march, view, &buffers, push(round), groups)?;
            }
            Ok(())
        })
    }
}
