//! What both ray-casters share: particles as balls in eye space (pass `prepare`), and cells of tiles of the picture
//! and slabs of depth (passes `tiles`, `count`, `scan`); at the end thickness to intensity (pass `resolve`).
//!
//! The cells of a tile reach from its first slab with particles to the last one or the scene's, so that what is
//! empty before, between the tiles and behind costs nothing.

use bytemuck::{Pod, Zeroable};
use whitewater::Error;
use whitewater::gpu_allocator::MemoryLocation;
use whitewater::headless::Device;

use crate::vulkan::{Buffer, FILL, Frame, Pass, Queue, READ, UPDATE, WRITE};
use crate::{Input, LEAST_REACH, Lens, Settings, bad};

/// SPIR-V of `glsl/NAME.comp`.
macro_rules! shader {
    ($name:literal) => {
        include_bytes!(concat!(env!("OUT_DIR"), "/", $name, ".comp.spv"))
    };
}
pub(crate) use shader;

/// Bytes of a particle's record.
const RECORD: u64 = 32;
/// Numbers of a block of a scan (glsl/include/scan.glsl).
const BLOCK: u64 = 2048;
/// Invocations of a group over particles, tiles or pixels.
const GROUP: u32 = 64;
/// Groups of a dispatch at most.
const MOST_GROUPS: u32 = 65_535;

/// The block `View` of `glsl/include/view.glsl`; its comments say what each member holds.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct View {
    view: [[f32; 4]; 4],
    slope: [f32; 4],
    lens: [f32; 4],
    lattice: [f32; 4],
    intensity: [f32; 4],
    extent: [u32; 4],
    samples: [u32; 4],
}

/// How cells are laid out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// Edge of a tile in pixels.
    pub tile: u32,
    /// Samples of a slab.
    pub samples: u32,
    /// They are marked, not counted.
    pub bricks: bool,
    /// Bytes of an entry, or of a brick.
    pub bytes_each: u64,
}

/// What there is room for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Room {
    cells: u64,
    /// Entries, or bricks.
    pub total: u64,
}

/// Particles that are taken at a time.
pub(crate) struct Chunk<'d> {
    positions: Buffer<'d>,
    kinds: Buffer<'d>,
    ages: Buffer<'d>,
    ids: Buffer<'d>,
    count: u32,
}

impl<'d> Chunk<'d> {
    fn new(device: &'d Device, input: &Input<'_>, first: usize, end: usize) -> Result<Self, Error> {
        let foam = input.foam;
        let with = |name, bytes: &[u8]| Buffer::with(device, name, bytes);
        Ok(Self {
            positions: with("positions", bytemuck::cast_slice(&foam.positions[first..end]))?,
            kinds: with("kinds", bytemuck::cast_slice(&foam.kinds[first..end]))?,
            ages: with("ages", bytemuck::cast_slice(&foam.ages[first..end]))?,
            ids: with("ids", bytemuck::cast_slice(&foam.ids[first..end]))?,
            count: (end - first) as u32,
        })
    }

    /// Groups with an invocation a particle.
    pub fn groups(&self) -> [u32; 2] {
        [self.count.div_ceil(GROUP), 1]
    }
}

/// Sums of all before each (Blelloch 1990).
struct Scan<'d> {
    blocks: Pass<'d>,
    sums: Pass<'d>,
    apply: Pass<'d>,
}

impl<'d> Scan<'d> {
    fn new(device: &'d Device, bricks: bool) -> Result<Self, Error> {
        let constants = [(0, u32::from(bricks))];
        Ok(Self {
            blocks: Pass::new(device, "scan_blocks", shader!("scan_blocks"), 2, &constants)?,
            sums: Pass::new(device, "scan_sums", shader!("scan_sums"), 1, &constants)?,
            apply: Pass::new(device, "scan_apply", shader!("scan_apply"), 2, &constants)?,
        })
    }

    /// Of so many values, which shaders have written; the sum of all stands in the blocks after the last.
    fn record(
        &self,
        frame: &mut Frame<'_>,
        view: &Buffer<'_>,
        blocks: &Buffer<'_>,
        values: &Buffer<'_>,
        count: u64,
    ) -> Result<(), Error> {
        let groups = [count.div_ceil(BLOCK) as u32, 1];
        let push = [count as u32, 0, 0];
        frame.barrier(&[(values, UPDATE, READ), (blocks, UPDATE, WRITE)]);
        frame.dispatch(&self.blocks, view, &[blocks, values], push, groups)?;
        frame.barrier(&[(blocks, WRITE, UPDATE)]);
        frame.dispatch(&self.sums, view, &[blocks], push, [1, 1])?;
        frame.barrier(&[(blocks, UPDATE, READ), (values, READ, UPDATE)]);
        frame.dispatch(&self.apply, view, &[blocks, values], push, groups)
    }
}

/// Passes and buffers of both.
pub(crate) struct Cells<'d> {
    begin: Pass<'d>,
    prepare: Pass<'d>,
    lengths: Pass<'d>,
    tile_scan: Scan<'d>,
    count: Pass<'d>,
    cell_scan: Scan<'d>,
    resolve: Pass<'d>,
    pub queue: Queue<'d>,
    pub size: [u32; 2],
    /// Tiles across and down.
    pub tile_count: [u32; 2],
    pub layout: Layout,
    pub room: Room,
    chunks: Vec<Chunk<'d>>,
    pub view: Buffer<'d>,
    pub scene: Buffer<'d>,
    pub tiles: Buffer<'d>,
    pub starts: Buffer<'d>,
    blocks: Buffer<'d>,
    pub cells: Buffer<'d>,
    pub records: Buffer<'d>,
    pub thickness: Buffer<'d>,
    pub intensity: Buffer<'d>,
}

impl<'d> Cells<'d> {
    pub fn new(
        device: &'d Device,
        input: &Input<'_>,
        settings: &Settings,
        layout: Layout,
    ) -> Result<Self, Error> {
        let lens = Lens::new(input.camera)?;
        let [width, height] = input.size;
        let tile_count = input.size.map(|n| n.div_ceil(layout.tile));
        let view = view_of(&lens, input, settings, layout, tile_count);
        // SAFETY: live handles.
        let limits = unsafe { device.instance.get_physical_device_properties(device.physical) };
        let range = u64::from(limits.limits.max_storage_buffer_range);
        let pixels = u64::from(width) * u64::from(height);
        let tiles = u64::from(tile_count[0]) * u64::from(tile_count[1]);
        if 4 * pixels > range || 16 * tiles > range {
            return Err(bad("Input.size", "too large for the device's storage buffers".into()));
        }
        let on_device = |name, bytes| Buffer::new(device, name, bytes, MemoryLocation::GpuOnly);
        let constants = [(0, u32::from(layout.bricks)), (1, layout.tile)];
        let pass = |name, code, buffers| Pass::new(device, name, code, buffers, &constants);
        let mut cells = Self {
            begin: pass("begin", shader!("begin"), 2)?,
            prepare: pass("prepare", shader!("prepare"), 6)?,
            lengths: pass("lengths", shader!("lengths"), 2)?,
            tile_scan: Scan::new(device, false)?,
            count: pass("count", shader!("count"), 4)?,
            cell_scan: Scan::new(device, layout.bricks)?,
            resolve: pass("resolve", shader!("resolve"), 2)?,
            queue: Queue::new(device)?,
            size: input.size,
            tile_count,
            layout,
            room: Room::default(),
            chunks: Vec::new(),
            view: Buffer::with(device, "view", bytemuck::bytes_of(&view))?,
            scene: Buffer::with(device, "scene", bytemuck::cast_slice(&input.depths()))?,
            tiles: on_device("tiles", 16 * tiles)?,
            starts: on_device("starts", 4 * tiles)?,
            blocks: on_device("blocks", 4 * (tiles.div_ceil(BLOCK) + 1))?,
            cells: on_device("cells", 0)?,
            records: on_device("records", 0)?,
            thickness: on_device("thickness", 4 * pixels)?,
            intensity: on_device("intensity", 4 * pixels)?,
        };
        cells.make_room(device, input, range, settings.chunk)?;
        Ok(cells)
    }

    pub fn chunks(&self) -> &[Chunk<'d>] {
        &self.chunks
    }

    pub fn memory(&self) -> u64 {
        let own = [
            &self.view,
            &self.scene,
            &self.tiles,
            &self.starts,
            &self.blocks,
            &self.cells,
            &self.records,
            &self.thickness,
            &self.intensity,
        ];
        let particles = (self.chunks.iter())
            .flat_map(|chunk| [&chunk.positions, &chunk.kinds, &chunk.ages, &chunk.ids]);
        own.into_iter().chain(particles).map(|buffer| buffer.size).sum()
    }

    /// Specialization constants of passes.
    pub fn constants(&self) -> [(u32, u32); 1] {
        [(1, self.layout.tile)]
    }

    /// Push constants of passes over particles and cells.
    pub fn push(&self, chunk: &Chunk<'_>) -> [u32; 3] {
        [chunk.count, self.room.cells as u32, self.room.total as u32]
    }

    /// Finds chunks whose cells and entries the device has room for.
    fn make_room(
        &mut self,
        device: &'d Device,
        input: &Input<'_>,
        range: u64,
        chunk: Option<u32>,
    ) -> Result<(), Error> {
        let all = input.foam.positions.len();
        let most = (range / RECORD).min(u64::from(GROUP * MOST_GROUPS)) as usize;
        let chunk = chunk.map_or(most, |chunk| most.min(chunk as usize));
        let mut size = all.min(chunk).max(1);
        loop {
            if self.fits(device, input, range, size)? {
                return Ok(());
            }
            if size <= GROUP as usize {
                let why = "too fine: its cells do not fit into the device's storage buffers";
                return Err(bad("Settings.step", why.into()));
            }
            size = size.div_ceil(2);
        }
    }

    fn fits(
        &mut self,
        device: &'d Device,
        input: &Input<'_>,
        range: u64,
        size: usize,
    ) -> Result<bool, Error> {
        let all = input.foam.positions.len();
        let chunk = |first| Chunk::new(device, input, first, all.min(first + size));
        self.chunks = (0..all).step_by(size).map(chunk).collect::<Result<_, _>>()?;
        let location = MemoryLocation::GpuOnly;
        self.records = Buffer::new(device, "records", RECORD * size as u64, location)?;
        self.room = Room::default();
        for i in 0..self.chunks.len() {
            let chunk = &self.chunks[i];
            self.queue.run(|frame| self.record_tiles(frame, chunk))?;
            let cells = self.total(self.tiles.size / 16)?;
            if 4 * cells > range {
                return Ok(false);
            }
            if cells > self.room.cells {
                self.room.cells = cells;
                self.cells = Buffer::new(device, "cells", 4 * cells, location)?;
                let tiles = self.tiles.size / 16;
                let blocks = 4 * (cells.max(tiles).div_ceil(BLOCK) + 1);
                self.blocks = Buffer::new(device, "blocks", blocks, location)?;
            }
            self.queue.run(|frame| self.record_counts(frame, &self.chunks[i]))?;
            let total = self.total(self.room.cells)?;
            if self.layout.bytes_each * total > range {
                return Ok(false);
            }
            self.room.total = self.room.total.max(total);
        }
        Ok(true)
    }

    /// The sum that a scan of so many values left.
    fn total(&self, count: u64) -> Result<u64, Error> {
        Ok(self.queue.read(&self.blocks, count.div_ceil(BLOCK), 1)?[0].into())
    }

    /// Before the first chunk.
    pub fn record_begin(&self, frame: &mut Frame<'_>) -> Result<(), Error> {
        frame.clear(&self.thickness);
        frame.barrier(&[(&self.thickness, FILL, UPDATE)]);
        Ok(())
    }

    /// Passes `prepare` and `tiles`.
    fn record_tiles(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        let tiles = self.tile_count[0] * self.tile_count[1];
        let (view, push) = (&self.view, self.push(chunk));
        let groups = [tiles.div_ceil(GROUP), 1];
        frame.scope("prepare", |frame| {
            frame.barrier(&[(&self.tiles, READ, WRITE), (&self.records, READ, WRITE)]);
            frame.dispatch(&self.begin, view, &[&self.scene, &self.tiles], push, groups)?;
            frame.barrier(&[(&self.tiles, WRITE, UPDATE)]);
            let buffers = [
                &self.records,
                &chunk.positions,
                &chunk.kinds,
                &chunk.ages,
                &chunk.ids,
                &self.tiles,
            ];
            frame.dispatch(&self.prepare, view, &buffers, push, chunk.groups())
        })?;
        frame.scope("tiles", |frame| {
            frame.barrier(&[(&self.tiles, UPDATE, READ), (&self.starts, READ, WRITE)]);
            frame.dispatch(&self.lengths, view, &[&self.tiles, &self.starts], push, groups)?;
            self.tile_scan.record(frame, view, &self.blocks, &self.starts, tiles.into())
        })
    }

    /// Passes `count` and `scan`.
    fn record_counts(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        frame.scope("count", |frame| {
            frame.barrier(&[(&self.cells, UPDATE, FILL)]);
            frame.clear(&self.cells);
            frame.barrier(&[
                (&self.cells, FILL, UPDATE),
                (&self.starts, UPDATE, READ),
                (&self.records, WRITE, READ),
            ]);
            let buffers = [&self.records, &self.tiles, &self.starts, &self.cells];
            frame.dispatch(&self.count, &self.view, &buffers, self.push(chunk), chunk.groups())
        })?;
        frame.scope("scan", |frame| {
            self.cell_scan.record(frame, &self.view, &self.blocks, &self.cells, self.room.cells)
        })
    }

    /// The cells of a chunk.
    pub fn record_cells(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        self.record_tiles(frame, chunk)?;
        self.record_counts(frame, chunk)
    }

    /// After the last chunk.
    pub fn record_end(&self, frame: &mut Frame<'_>) -> Result<(), Error> {
        frame.scope("resolve", |frame| {
            frame.barrier(&[(&self.thickness, UPDATE, READ)]);
            let groups = (self.thickness.size / 4).div_ceil(GROUP.into());
            let buffers = [&self.thickness, &self.intensity];
            frame.dispatch(&self.resolve, &self.view, &buffers, [0; 3], [groups as u32, 1])
        })
    }
}

fn view_of(
    lens: &Lens,
    input: &Input<'_>,
    settings: &Settings,
    layout: Layout,
    tiles: [u32; 2],
) -> View {
    let slope = lens.slope(input.size);
    let pixel = [slope.x.abs(), slope.y.abs()];
    let growth = LEAST_REACH * pixel[0].max(pixel[1]);
    let slab = layout.samples as f32 * settings.step;
    View {
        view: lens.view.to_cols_array_2d(),
        slope: slope.to_array(),
        lens: [pixel[0], pixel[1], lens.near, settings.most()],
        lattice: [input.radius, growth, input.radius / growth, slab],
        intensity: [settings.half, settings.exponent, 0.0, 0.0],
        extent: [input.size[0], input.size[1], tiles[0], tiles[1]],
        samples: [layout.samples, settings.shifted.into(), 0, 0],
    }
}
