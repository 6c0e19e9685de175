//! Parts that all ray-casters share: particles as balls in eye space (pass `prepare`), and at the end the conversion of
//! thickness to intensity (pass `resolve`).

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

/// Bytes per particle record.
const RECORD: u64 = 32;
/// Invocations per group, in passes over particles, tiles or pixels.
pub(crate) const GROUP: u32 = 64;
/// Most groups of a dispatch along one axis.
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

/// Particles that are processed together.
pub(crate) struct Chunk<'d> {
    positions: Buffer<'d>,
    kinds: Buffer<'d>,
    ages: Buffer<'d>,
    ids: Buffer<'d>,
    pub count: u32,
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

    /// Group counts for one invocation per particle.
    pub fn groups(&self) -> [u32; 2] {
        [self.count.div_ceil(GROUP), 1]
    }
}

/// Passes and buffers that all ray-casters share.
pub(crate) struct Balls<'d> {
    begin: Pass<'d>,
    prepare: Pass<'d>,
    resolve: Pass<'d>,
    pub queue: Queue<'d>,
    pub size: [u32; 2],
    /// Edge of a tile in pixels.
    pub tile: u32,
    /// Number of tiles across and down.
    pub tile_count: [u32; 2],
    /// Radius of the least drawn ball, divided by its depth.
    pub least_reach: f32,
    /// Larger absolute slope of the picture's left and right edges.
    pub widest_slope: f32,
    /// Most bytes of a storage buffer.
    pub range: u64,
    pub chunks: Vec<Chunk<'d>>,
    pub view: Buffer<'d>,
    pub scene: Buffer<'d>,
    pub tiles: Buffer<'d>,
    pub records: Buffer<'d>,
    pub thickness: Buffer<'d>,
    pub intensity: Buffer<'d>,
}

impl<'d> Balls<'d> {
    /// Makes the passes for tiles of `tile` pixels and slabs of `samples` samples. [`Self::take`] uploads particles
    /// later.
    pub fn new(
        device: &'d Device,
        input: &Input<'_>,
        settings: &Settings,
        tile: u32,
        samples: u32,
    ) -> Result<Self, Error> {
        let lens = Lens::new(input.camera)?;
        let [width, height] = input.size;
        let tile_count = input.size.map(|n| n.div_ceil(tile));
        let view = view_of(&lens, input, settings, samples, tile_count);
        let left = view.slope[2];
        // SAFETY: live handles.
        let limits = unsafe { device.instance.get_physical_device_properties(device.physical) };
        let range = u64::from(limits.limits.max_storage_buffer_range);
        let pixels = u64::from(width) * u64::from(height);
        let tiles = u64::from(tile_count[0]) * u64::from(tile_count[1]);
        if 4 * pixels > range || 16 * tiles > range {
            return Err(bad("Input.size", "too large for the device's storage buffers".into()));
        }
        let on_device = |name, bytes| Buffer::new(device, name, bytes, MemoryLocation::GpuOnly);
        let pass = |name, code, buffers| Pass::new(device, name, code, buffers, &[(1, tile)]);
        Ok(Self {
            begin: pass("begin", shader!("begin"), 2)?,
            prepare: pass("prepare", shader!("prepare"), 6)?,
            resolve: pass("resolve", shader!("resolve"), 2)?,
            queue: Queue::new(device)?,
            size: input.size,
            tile,
            tile_count,
            least_reach: view.lattice[1],
            widest_slope: left.abs().max((left + width as f32 * view.slope[0]).abs()),
            range,
            chunks: Vec::new(),
            view: Buffer::with(device, "view", bytemuck::bytes_of(&view))?,
            scene: Buffer::with(device, "scene", bytemuck::cast_slice(&input.depths()))?,
            tiles: on_device("tiles", 16 * tiles)?,
            records: on_device("records", 0)?,
            thickness: on_device("thickness", 4 * pixels)?,
            intensity: on_device("intensity", 4 * pixels)?,
        })
    }

    /// Most particles that can be processed together, out of `all`.
    pub fn most(&self, all: usize, settings: &Settings) -> usize {
        let most = (self.range / RECORD).min(u64::from(GROUP * MOST_GROUPS)) as usize;
        let chunk = settings.chunk.map_or(most, |chunk| most.min(chunk as usize));
        all.min(chunk).max(1)
    }

    /// Uploads all particles, in chunks of `size`.
    pub fn take(
        &mut self,
        device: &'d Device,
        input: &Input<'_>,
        size: usize,
    ) -> Result<(), Error> {
        let all = input.foam.positions.len();
        let chunk = |first| Chunk::new(device, input, first, all.min(first + size));
        self.chunks = (0..all).step_by(size).map(chunk).collect::<Result<_, _>>()?;
        let bytes = RECORD * size as u64;
        self.records = Buffer::new(device, "records", bytes, MemoryLocation::GpuOnly)?;
        Ok(())
    }

    pub fn memory(&self) -> u64 {
        let own =
            [&self.view, &self.scene, &self.tiles, &self.records, &self.thickness, &self.intensity];
        let particles = (self.chunks.iter())
            .flat_map(|chunk| [&chunk.positions, &chunk.kinds, &chunk.ages, &chunk.ids]);
        own.into_iter().chain(particles).map(|buffer| buffer.size).sum()
    }

    /// Specialization constants that all passes have.
    pub fn constants(&self) -> [(u32, u32); 1] {
        [(1, self.tile)]
    }

    /// Records the work before the first chunk.
    pub fn record_begin(&self, frame: &mut Frame<'_>) {
        frame.clear(&self.thickness);
        frame.barrier(&[(&self.thickness, FILL, UPDATE)]);
    }

    /// Records pass `prepare`. The caller adds the barrier after it.
    pub fn record_prepare(&self, frame: &mut Frame<'_>, chunk: &Chunk<'_>) -> Result<(), Error> {
        let (view, push) = (&self.view, [chunk.count, 0, 0]);
        let tiles = self.tile_count[0] * self.tile_count[1];
        frame.scope("prepare", |frame| {
            frame.barrier(&[(&self.tiles, UPDATE, WRITE), (&self.records, READ, WRITE)]);
            let (buffers, groups) = ([&self.scene, &self.tiles], [tiles.div_ceil(GROUP), 1]);
            frame.dispatch(&self.begin, view, &buffers, push, groups)?;
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
        })
    }

    /// Records the work after the last chunk.
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
    samples: u32,
    tiles: [u32; 2],
) -> View {
    let slope = lens.slope(input.size);
    let pixel = [slope.x.abs(), slope.y.abs()];
    let growth = LEAST_REACH * pixel[0].max(pixel[1]);
    let slab = samples as f32 * settings.step;
    View {
        view: lens.view.to_cols_array_2d(),
        slope: slope.to_array(),
        lens: [pixel[0], pixel[1], lens.near, settings.most()],
        lattice: [input.radius, growth, input.radius / growth, slab],
        intensity: [settings.half, settings.exponent, 0.0, 0.0],
        extent: [input.size[0], input.size[1], tiles[0], tiles[1]],
        samples: [samples, settings.shifted.into(), 0, 0],
    }
}
