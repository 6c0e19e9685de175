//! Pass `blobs`: lists the blobs on the screen, and for each screen tile its blobs from front to back.
//!
//! The paper draws a billboard per blob, and all billboards once per layer. Here each pixel iterates over the list of
//! its tile. The lists of all tiles share one buffer, which holds the nearest depth slice of all tiles first. A
//! prefix sum gives each slice of each tile its place. If the buffer is full, the farthest blobs are dropped.
//! Reads: the host's streams. Writes: blobs, range, cells, spans, list.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::settings::{BubbleConfig, BubbleSort};
use crate::contract::{Blobs, Config, Count, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    Access, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, FRAGMENT_READ, VERTEX_READ,
    buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::scan::Scan;
use crate::gpu::shader;
use crate::water::{Recording, Window, capacity, each_once};

/// Side length of a tile in pixels (glsl/include/bubbles.glsl).
pub const TILE: u32 = 16;
/// Slices of depth.
pub const SLICES: u32 = 32;
/// Room for list entries per tile, on average over all tiles; usually fewer blobs lie behind each other.
const PLACES: u32 = 128;
/// Bytes of a blob, and of the statistics of all blobs.
const BLOB: u64 = 48;
const RANGE: u64 = 20;
/// Word of the range with the number of used entries.
const TAKEN: u32 = 4;

/// Offsets and strides of the host's streams, in words of 32 bits; an absent stream has a stride of 0.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
pub struct Places {
    ball_word: u32,
    ball_stride: u32,
    turn_word: u32,
    turn_stride: u32,
    id_word: u32,
    id_stride: u32,
}
shader::assert_layout!(
    [shader::BUBBLES_BLOBS_COMP, shader::BUBBLES_HEAP_SET_COMP],
    "Push",
    Places { ball_word, ball_stride, turn_word, turn_stride, id_word, id_stride }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    places: Places,
    most: u32,
    from_gpu: u32,
}
shader::assert_layout!(shader::BUBBLES_BLOBS_COMP, "Push", Push { most, from_gpu });

/// Number of tiles of an extent, along x and y.
pub fn tiles(extent: vk::Extent2D) -> [u32; 2] {
    [extent.width.div_ceil(TILE), extent.height.div_ceil(TILE)]
}

/// List entries for an extent, 4 bytes each.
pub fn room(extent: vk::Extent2D, config: &BubbleConfig) -> u32 {
    let [x, y] = tiles(extent);
    PLACES * x * y + 4 * config.max_blobs
}

/// The present streams, with the size of a value in bytes.
fn streams(blobs: &Blobs) -> impl Iterator<Item = (&Stream, u64)> {
    let all = [(Some(&blobs.spheres), 16), (blobs.rotations.as_ref(), 16), (blobs.ids.as_ref(), 4)];
    all.into_iter().filter_map(|(stream, bytes)| Some((stream?, bytes)))
}

/// The host's buffers, each once.
pub fn buffers_of(blobs: &Blobs) -> Vec<vk::Buffer> {
    each_once(streams(blobs), blobs.count, None)
}

/// Buffer bindings, offsets and strides of the host's streams of spheres (balls), rotations (turns) and ids; `None`
/// if a stream is too short for one blob.
pub fn windows(gpu: &Gpu, blobs: &Blobs) -> Option<([Resource; 3], Places)> {
    let balls = Window::new(gpu, &blobs.spheres, 0)?;
    let other = |stream: &Option<Stream>| match stream {
        Some(stream) => Window::new(gpu, stream, 0),
        None => Some(Window { stride: 0, ..balls }),
    };
    let (turns, ids) = (other(&blobs.rotations)?, other(&blobs.ids)?);
    let places = Places {
        ball_word: balls.word,
        ball_stride: balls.stride,
        turn_word: turns.word,
        turn_stride: turns.stride,
        id_word: ids.word,
        id_stride: ids.stride,
    };
    Some(([balls, turns, ids].map(|own| own.resource), places))
}

/// Size-dependent state.
struct Cells {
    cells: Buffer,
    spans: Buffer,
    list: Buffer,
    scan: Scan,
}

impl Cells {
    fn new(gpu: &Gpu, config: &Config, bubbles: &BubbleConfig) -> Result<Self, Error> {
        let cells = cells_of(config.extent);
        let [x, y] = tiles(config.extent);
        let own = |name, words: u32| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            Buffer::new(gpu, name, 4 * u64::from(words), usage, MemoryLocation::GpuOnly)
        };
        Ok(Self {
            cells: own("bubbles/cells", cells)?,
            spans: own("bubbles/spans", 2 * x * y)?,
            list: own("bubbles/list", room(config.extent, bubbles))?,
            scan: Scan::new(gpu, "bubbles/scan", cells)?,
        })
    }
}

/// The pass.
pub struct Lists {
    begin: Pipeline,
    /// Pipelines of three dispatches: transform to eye space, counts, entries.
    goes: [Pipeline; 3],
    config: BubbleConfig,
    blobs: Buffer,
    range: Buffer,
    cells: Cells,
}

impl Lists {
    pub fn new(gpu: &Gpu, config: &Config, bubbles: &BubbleConfig) -> Result<Self, Error> {
        let own = |name, bytes| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        let go = |which| Pipeline::compute(gpu, shader::BUBBLES_BLOBS_COMP, &[(0, which)]);
        Ok(Self {
            begin: Pipeline::compute(gpu, shader::BUBBLES_BEGIN_COMP, &[])?,
            goes: [go(0)?, go(1)?, go(2)?],
            config: *bubbles,
            blobs: own("bubbles/blobs", BLOB * u64::from(bubbles.max_blobs))?,
            range: own("bubbles/range", RANGE)?,
            cells: Cells::new(gpu, config, bubbles)?,
        })
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let new = Cells::new(gpu, config, &self.config)?;
        retired.replace(&mut self.cells.cells, new.cells);
        retired.replace(&mut self.cells.spans, new.spans);
        retired.replace(&mut self.cells.list, new.list);
        retired.replace(&mut self.cells.scan, new.scan);
        Ok(())
    }

    /// Blobs, their statistics, ends of the cells, list, depth slices of each tile.
    pub fn buffers(&self) -> [&Buffer; 5] {
        let Cells { cells, spans, list, .. } = &self.cells;
        [&self.blobs, &self.range, cells, list, spans]
    }

    /// How the blobs' buffer is read after the pass: by compute shaders, and with [`BubbleSort::Peel`] also by vertex
    /// and fragment shaders. The pass's other buffers are read by compute shaders; the host may copy the statistics.
    fn read(&self) -> Access {
        match self.config.sort {
            BubbleSort::Tiles => COMPUTE_READ,
            BubbleSort::Peel => COMPUTE_READ.and(VERTEX_READ).and(FRAGMENT_READ),
        }
    }

    /// The pipelines of the dispatches that are needed: all three to sort by tile lists, only the first for depth
    /// peeling.
    fn goes(&self) -> &[Pipeline] {
        match self.config.sort {
            BubbleSort::Tiles => &self.goes,
            BubbleSort::Peel => &self.goes[..1],
        }
    }

    /// Number of blobs, or their maximum number if only the GPU knows it.
    pub fn count(&self, gpu: &Gpu, blobs: Option<&Blobs>) -> u32 {
        blobs.and_then(|blobs| self.bound(gpu, blobs)).map_or(0, |(_, push)| push.most)
    }

    pub fn record(&self, r: &Recording<'_>, blobs: Option<&Blobs>) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let [own, range, cells, list, spans] = self.buffers();
        let whole = [own, range, cells, list, spans];
        let [_, rest @ ..] = whole;
        let all = rest.map(|b| buffer(b.handle, COMPUTE_READ.and(COPY_READ), COMPUTE_WRITE));
        let all = all.into_iter().chain([buffer(own.handle, self.read(), COMPUTE_WRITE)]);
        let host = blobs.into_iter().flat_map(|blobs| {
            let to = |handle| buffer(handle, blobs.before, COMPUTE_READ);
            buffers_of(blobs).into_iter().map(to)
        });
        gpu.barriers(cmd, &[], &all.chain(host).collect::<Vec<_>>());
        let resources = [
            (0, r.uniforms),
            (1, r.bubbles),
            (6, Resource::buffer(own)),
            (7, Resource::buffer(range)),
            (8, Resource::buffer(cells)),
            (9, Resource::buffer(list)),
            (10, Resource::buffer(spans)),
        ];
        r.descriptors.bind(gpu, cmd, &self.begin, &resources)?;
        let count = cells_of(r.extent);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, count.div_ceil(256), 1, 1) };
        let both = COMPUTE_READ_WRITE;
        let hand = |from, to| whole.map(|b| buffer(b.handle, from, to));
        gpu.barriers(cmd, &[], &hand(COMPUTE_WRITE, both));
        let bound = blobs.and_then(|blobs| Some((blobs, self.bound(gpu, blobs)?)));
        if let Some((blobs, (streams, push))) = bound {
            let count = match blobs.count {
                Count::Gpu { buffer, offset } => Resource::Buffer(buffer, offset, 4),
                Count::Cpu(_) => Resource::buffer(range),
            };
            let resources = [&resources[..], &streams, &[(5, count)]].concat();
            for (i, go) in self.goes().iter().enumerate() {
                match i {
                    0 => {}
                    2 => {
                        let on = (gpu, cmd, r.descriptors);
                        let values = (cells, cells_of(r.extent));
                        self.cells.scan.record(on, range, values, None, TAKEN)?;
                        gpu.barriers(cmd, &[], &hand(both, both));
                    }
                    _ => gpu.barriers(cmd, &[], &hand(both, both)),
                }
                r.descriptors.bind(gpu, cmd, go, &resources)?;
                go.push(gpu, cmd, &push);
                // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
                unsafe { gpu.device.cmd_dispatch(cmd, push.most.div_ceil(64).max(1), 1, 1) };
            }
        }
        let back = rest.map(|b| buffer(b.handle, both, COMPUTE_READ)).into_iter();
        let back = back.chain([buffer(own.handle, both, self.read())]);
        gpu.barriers(cmd, &[], &back.collect::<Vec<_>>());
        Ok(())
    }

    /// Bindings of the host's streams, with their numbers, and the push constants; `None` if a stream is too short
    /// for one blob.
    fn bound(&self, gpu: &Gpu, blobs: &Blobs) -> Option<([(u32, Resource); 3], Push)> {
        let (bound, places) = windows(gpu, blobs)?;
        let room = streams(blobs).map(capacity).fold(self.config.max_blobs, u32::min);
        let (most, from_gpu) = match blobs.count {
            Count::Cpu(count) => (count.min(room), 0),
            Count::Gpu { .. } => (room, 1),
        };
        let [balls, turns, ids] = bound;
        Some(([(2, balls), (3, turns), (4, ids)], Push { places, most, from_gpu }))
    }

    pub fn memory(&self) -> u64 {
        let own = self.buffers().map(|buffer| buffer.size).iter().sum::<u64>();
        own + self.cells.scan.memory()
    }
}

/// Number of tiles of all depth slices.
fn cells_of(extent: vk::Extent2D) -> u32 {
    let [x, y] = tiles(extent);
    SLICES * x * y
}
