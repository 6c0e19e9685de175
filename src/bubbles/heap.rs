//! Pass `heap`: blobs that move (Huszár, Szécsi, Sec. 6), on the GPU, where the source has the CPU.
//!
//! A blob is a ball: neighbours pull each other when near and push when nearer, all fall, roll and rub on what is solid.
//! A step is cut into several, in each of which a hashed grid finds the neighbours. Those of a bucket stand in the order
//! of their ids, so that the same blobs move the same in every run, whatever their order.
//! Reads: the host's streams and solids. Writes: balls, turns, velocities.

use std::sync::Arc;

use ash::vk;
use bytemuck::{NoUninit, Pod, Zeroable};
use glam::Vec3;
use gpu_allocator::MemoryLocation;

use super::lists::buffers_of;
use crate::check;
use crate::contract::{Blobs, Count, Host, Slot, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    CLEAR, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::scan::{self, Scan};
use crate::gpu::shader;
use crate::gpu::timing::{Timer, Timing};
use crate::water::Window;
use crate::water::settings::range;

/// Most parts of a step.
pub const MOST_SUBSTEPS: u32 = 64;

/// How blobs move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeapSettings {
    /// m/s², default (0, −9.81, 0).
    pub gravity: [f32; 3],
    /// What the air takes of their speed, 1/s, [0, 100], default 0.8.
    pub drag: f32,
    /// How far apart neighbours rest, in sums of their radii, (0, 1), default 0.75: they lie in each other.
    pub rest: f32,
    /// How near they pull each other, in sums of their radii, above `rest` to 1.2, default 0.95.
    pub reach: f32,
    /// How much they push, m/s² a metre, (0, 100 000], default 4000.
    pub stiffness: f32,
    /// How much they pull at most, m/s², [0, 1000], default 12.
    pub cohesion: f32,
    /// What two that touch take of each other's speed, along and across, 1/s, [0, 100], default 12 and 6.
    pub damping: [f32; 2],
    /// Distance at which solids begin, in radii, (0, 1], default 0.85: foam clings to what it lies on.
    pub contact: f32,
    /// How much solids push, m/s² a metre, (0, 100 000], default 20 000.
    pub solidity: f32,
    /// What solids take of the speed along their normal, 1/s, [0, 200], default 60.
    pub solid_damping: f32,
    /// Coefficient of friction on solids, [0, 10], default 0.35.
    pub friction: f32,
    /// Level of water that they float on, metres; default: none.
    pub water: Option<f32>,
    /// Density of the foam over the water's, [0.01, 10], default 0.2.
    pub density: f32,
    /// Parts of a step, 1 to 64, default 4: forces are stable to parts of 1/200 s.
    pub substeps: u32,
}

impl Default for HeapSettings {
    fn default() -> Self {
        Self {
            gravity: [0.0, -9.81, 0.0],
            drag: 0.8,
            rest: 0.75,
            reach: 0.95,
            stiffness: 4000.0,
            cohesion: 12.0,
            damping: [12.0, 6.0],
            contact: 0.85,
            solidity: 20_000.0,
            solid_damping: 60.0,
            friction: 0.35,
            water: None,
            density: 0.2,
            substeps: 4,
        }
    }
}

impl HeapSettings {
    fn check(&self) -> Result<(), Error> {
        for part in self.gravity {
            range("HeapSettings.gravity", part, -1.0e4, 1.0e4)?;
        }
        range("HeapSettings.drag", self.drag, 0.0, 100.0)?;
        range("HeapSettings.rest", self.rest, 1.0e-3, 1.0)?;
        range("HeapSettings.reach", self.reach, self.rest + 1.0e-3, 1.2)?;
        range("HeapSettings.stiffness", self.stiffness, 1.0e-3, 1.0e5)?;
        range("HeapSettings.cohesion", self.cohesion, 0.0, 1000.0)?;
        range("HeapSettings.damping", self.damping[0], 0.0, 100.0)?;
        range("HeapSettings.damping", self.damping[1], 0.0, 100.0)?;
        range("HeapSettings.contact", self.contact, 1.0e-3, 1.0)?;
        range("HeapSettings.solidity", self.solidity, 1.0e-3, 1.0e5)?;
        range("HeapSettings.solid_damping", self.solid_damping, 0.0, 200.0)?;
        range("HeapSettings.friction", self.friction, 0.0, 10.0)?;
        range("HeapSettings.water", self.water.unwrap_or(0.0), -1.0e9, 1.0e9)?;
        range("HeapSettings.density", self.density, 0.01, 10.0)?;
        if !(1..=MOST_SUBSTEPS).contains(&self.substeps) {
            let why = format!("expected 1 to {MOST_SUBSTEPS}, found {}", self.substeps);
            return Err(Error::bad("HeapSettings.substeps", why));
        }
        Ok(())
    }
}

/// What blobs run against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Solid {
    /// All that lies behind a plane: `normal · x < distance`.
    Plane {
        /// Unit length.
        normal: [f32; 3],
        /// Of the plane from 0, along the normal.
        distance: f32,
    },
    /// A box.
    Box {
        /// Its middle.
        center: [f32; 3],
        /// Half its edges.
        half: [f32; 3],
        /// How it is turned: a unit quaternion, the real part last.
        turn: [f32; 4],
    },
}

/// The same for the shader (glsl/include/solid.glsl).
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct GpuSolid {
    place: [f32; 4],
    size: [f32; 4],
    turn: [f32; 4],
}

impl Solid {
    fn check(&self) -> Result<(), Error> {
        let whole = |all: &[f32]| all.iter().all(|v| v.is_finite());
        let unit = |all: &[f32]| (all.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1.0e-3;
        let good = match self {
            Self::Plane { normal, distance } => unit(normal) && distance.is_finite(),
            Self::Box { center, half, turn } => {
                whole(center) && whole(half) && half.iter().all(|v| *v >= 0.0) && unit(turn)
            }
        };
        if good {
            return Ok(());
        }
        let why = format!("{self:?}: finite, with a unit normal or turn expected");
        Err(Error::bad("HeapStep.solids", why))
    }

    fn on_gpu(self) -> GpuSolid {
        match self {
            Self::Plane { normal: [x, y, z], distance } => GpuSolid {
                place: [x, y, z, 0.0],
                size: [0.0, 0.0, 0.0, distance],
                turn: [0.0, 0.0, 0.0, 1.0],
            },
            Self::Box { center: [x, y, z], half: [a, b, c], turn } => {
                GpuSolid { place: [x, y, z, 1.0], size: [a, b, c, 0.0], turn }
            }
        }
    }
}

/// Distances from a solid of any shape, negative inside, at the points of a grid; between them they are even. Beyond the
/// grid there is nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceField {
    /// Points each way, 2 to 1024; x runs fastest.
    pub points: [u32; 3],
    /// The first point.
    pub corner: [f32; 3],
    /// From one to the next.
    pub edge: f32,
    /// As many as there are points.
    pub distances: Vec<f32>,
}

impl DistanceField {
    fn check(&self) -> Result<(), Error> {
        let bad = |why: String| Err(Error::bad("HeapConfig.field", why));
        if !self.points.iter().all(|n| (2..=1024).contains(n)) {
            return bad(format!("{:?} points: 2 to 1024 each way expected", self.points));
        }
        let count = self.points.iter().map(|n| *n as usize).product::<usize>();
        if self.distances.len() != count {
            return bad(format!("{} distances of {count} points", self.distances.len()));
        }
        let whole = self.corner.iter().chain(&self.distances).all(|v| v.is_finite());
        if !whole || !self.edge.is_finite() || self.edge <= 0.0 {
            return bad("not finite, or an edge that is not above 0".into());
        }
        Ok(())
    }
}

/// What fixes the memory of a [`Heap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeapConfig {
    /// Most blobs, 1 to 2^20.
    pub max_blobs: u32,
    /// Most solids of a step, default 64.
    pub max_solids: u32,
}

impl HeapConfig {
    /// The defaults for so many blobs.
    pub fn new(max_blobs: u32) -> Self {
        Self { max_blobs, max_solids: 64 }
    }
}

/// One step of a heap.
#[derive(Clone, Copy, Debug)]
pub struct HeapStep<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// Seconds, [0, 1].
    pub dt: f32,
    /// Uniform settings.
    pub settings: &'a HeapSettings,
    /// What is solid, as it is at the step's end.
    pub solids: &'a [Solid],
}

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    gravity: [f32; 4],
    pair: [f32; 4],
    damping: [f32; 4],
    solid: [f32; 4],
    water: [f32; 4],
    field: [f32; 4],
    field_size: [u32; 4],
    blobs: u32,
    buckets: u32,
}
shader::assert_layout!(
    shader::BUBBLES_HEAP_MOVE_COMP,
    "Push",
    Push { gravity, pair, damping, solid, water, field, field_size, blobs, buckets }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct SetPush {
    ball_word: u32,
    ball_stride: u32,
    turn_word: u32,
    turn_stride: u32,
    id_word: u32,
    id_stride: u32,
    drift_word: u32,
    drift_stride: u32,
    blobs: u32,
}
shader::assert_layout!(
    shader::BUBBLES_HEAP_SET_COMP,
    "Push",
    SetPush {
        ball_word,
        ball_stride,
        turn_word,
        turn_stride,
        id_word,
        id_stride,
        drift_word,
        drift_stride,
        blobs
    }
);

struct Pipelines {
    set: Pipeline,
    /// Numbers, which.
    place: [Pipeline; 2],
    order: Pipeline,
    run: Pipeline,
}

struct Buffers {
    balls: Buffer,
    turns: Buffer,
    ids: Buffer,
    drifts: Buffer,
    spins: Buffer,
    buckets: Buffer,
    order: Buffer,
    heaped: Buffer,
    counts: Buffer,
    field: Buffer,
}

struct HeapSlot {
    descriptors: Descriptors,
    timer: Timer,
    solids: Buffer,
}

/// Blobs of bubble foam that move. Views share them.
pub struct Heap {
    gpu: Arc<Gpu>,
    config: HeapConfig,
    pipelines: Pipelines,
    buffers: Buffers,
    scan: Scan,
    slots: Vec<HeapSlot>,
    /// Buckets of the grid.
    buckets: u32,
    /// Points of the field of distances each way, its corner and edge.
    field: ([u32; 3], [f32; 4]),
    count: u32,
    /// The largest radius, by which cells are.
    largest: f32,
}

impl Heap {
    /// Makes pipelines and memory, 150 bytes a blob. `field`: what is solid besides the steps' own.
    ///
    /// # Errors
    /// Bad configuration, no memory, and what Vulkan reports.
    ///
    /// # Safety
    /// As [`Renderer::new`](crate::Renderer::new).
    pub unsafe fn new(
        host: &Host<'_>,
        config: &HeapConfig,
        field: Option<&DistanceField>,
    ) -> Result<Self, Error> {
        if config.max_blobs == 0 || config.max_blobs > 1 << 20 {
            let why = format!("expected 1 to {}, found {}", 1 << 20, config.max_blobs);
            return Err(Error::bad("HeapConfig.max_blobs", why));
        }
        if config.max_solids > 65_536 {
            let why = format!("expected 0 to 65536, found {}", config.max_solids);
            return Err(Error::bad("HeapConfig.max_solids", why));
        }
        field.map_or(Ok(()), DistanceField::check)?;
        let gpu = Gpu::new(host)?;
        match Self::made(&gpu, config, field) {
            Ok(heap) => Ok(heap),
            Err(error) => {
                // Nothing was submitted with what was made before the failure.
                gpu.destroy();
                Err(error)
            }
        }
    }

    fn made(
        gpu: &Arc<Gpu>,
        config: &HeapConfig,
        field: Option<&DistanceField>,
    ) -> Result<Self, Error> {
        let most = u64::from(config.max_blobs);
        let buckets = config.max_blobs.next_power_of_two();
        let sized = |name, bytes: u64| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER
                | vk::BufferUsageFlags::TRANSFER_SRC
                | vk::BufferUsageFlags::TRANSFER_DST;
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        let mapped = |name, bytes: u64| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            Buffer::new(gpu, name, bytes.max(16), usage, MemoryLocation::CpuToGpu)
        };
        let distances = field.map_or(&[][..], |field| &field.distances);
        let bytes: &[u8] = bytemuck::cast_slice(distances);
        let mut own_field = mapped("heap/field", bytes.len() as u64)?;
        own_field.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
        let place = |go| Pipeline::compute(gpu, shader::BUBBLES_HEAP_PLACE_COMP, &[(0, go)]);
        let sets = 1 + MOST_SUBSTEPS * (4 + scan::SETS);
        let slot = |_| {
            let size = size_of::<GpuSolid>() as u64 * u64::from(config.max_solids);
            Ok(HeapSlot {
                descriptors: Descriptors::new(gpu, sets)?,
                timer: Timer::new(gpu)?,
                solids: mapped("heap/solids", size)?,
            })
        };
        Ok(Self {
            gpu: gpu.clone(),
            config: *config,
            pipelines: Pipelines {
                set: Pipeline::compute(gpu, shader::BUBBLES_HEAP_SET_COMP, &[])?,
                place: [place(0)?, place(1)?],
                order: Pipeline::compute(gpu, shader::BUBBLES_HEAP_ORDER_COMP, &[])?,
                run: Pipeline::compute(gpu, shader::BUBBLES_HEAP_MOVE_COMP, &[])?,
            },
            buffers: Buffers {
                balls: sized("heap/balls", 16 * most)?,
                turns: sized("heap/turns", 16 * most)?,
                ids: sized("heap/ids", 4 * most)?,
                drifts: sized("heap/drifts", 16 * most)?,
                spins: sized("heap/spins", 16 * most)?,
                buckets: sized("heap/buckets", 4 * u64::from(buckets))?,
                order: sized("heap/order", 4 * most)?,
                heaped: sized("heap/heaped", 48 * most)?,
                counts: sized("heap/counts", 16)?,
                field: own_field,
            },
            scan: Scan::new(gpu, "heap/scan", buckets)?,
            slots: (0..gpu.slots).map(slot).collect::<Result<_, Error>>()?,
            buckets,
            field: field.map_or(([0; 3], [0.0; 4]), |field| {
                let [x, y, z] = field.corner;
                (field.points, [x, y, z, field.edge])
            }),
            count: 0,
            largest: 1.0,
        })
    }

    /// Records that these are the blobs: as the host has them, at rest or with velocities (3×f32, m/s). `largest`: the
    /// largest of their radii, by which neighbours are looked for.
    ///
    /// # Errors
    /// [`Error::BadInput`] with the field, before the first command.
    ///
    /// # Safety
    /// As [`record_step`](Self::record_step).
    pub unsafe fn record_set(
        &mut self,
        cmd: vk::CommandBuffer,
        slot: Slot,
        blobs: &Blobs,
        velocities: Option<&Stream>,
        largest: f32,
    ) -> Result<(), Error> {
        check::step(["slot", "dt"], slot, self.slots.len(), 0.0)?;
        let fields = ["Blobs.count", "Blobs.count.offset"];
        let most = ("HeapConfig.max_blobs", self.config.max_blobs);
        let count = check::count(fields, blobs.count, most, &self.gpu.limits)?;
        if matches!(blobs.count, Count::Gpu { .. }) {
            return Err(Error::bad("Blobs.count", "of a buffer: known to the host expected"));
        }
        let most = ("what the device binds of all blobs", self.stride());
        blobs.balls.check("Blobs.balls", 16, count, most)?;
        blobs.turns.map_or(Ok(()), |turns| turns.check("Blobs.turns", 16, count, most))?;
        blobs.ids.map_or(Ok(()), |ids| ids.check("Blobs.ids", 4, count, most))?;
        velocities.map_or(Ok(()), |v| v.check("velocities", 12, count, most))?;
        if !(largest.is_finite() && largest > 0.0) {
            return Err(Error::bad(
                "largest",
                format!("a radius above 0 expected, found {largest}"),
            ));
        }
        self.count = count;
        self.largest = largest;
        if count == 0 {
            return Ok(());
        }
        let gpu = &*self.gpu;
        let own = &mut self.slots[slot.0 as usize];
        own.descriptors.reset(gpu)?;
        let balls = Window::new(gpu, &blobs.balls, 0)
            .ok_or_else(|| Error::bad("Blobs.balls", "ends before the first"))?;
        let other = |stream: Option<&Stream>| {
            stream
                .and_then(|stream| Window::new(gpu, stream, 0))
                .unwrap_or(Window { stride: 0, ..balls })
        };
        let (turns, ids) = (other(blobs.turns.as_ref()), other(blobs.ids.as_ref()));
        let drifts = other(velocities);
        let b = &self.buffers;
        let written = [&b.balls, &b.turns, &b.ids, &b.drifts, &b.spins];
        let mut hosts = buffers_of(blobs);
        hosts.extend(velocities.map(|v| v.buffer).filter(|v| !hosts.contains(v)));
        let before = written.map(|b| buffer(b.handle, AFTER, COMPUTE_WRITE)).into_iter();
        let taken = hosts.iter().map(|handle| buffer(*handle, blobs.before, COMPUTE_READ));
        gpu.barriers(cmd, &[], &before.chain(taken).collect::<Vec<_>>());
        let resources = [
            (0, Resource::buffer(&b.balls)),
            (1, Resource::buffer(&b.turns)),
            (2, Resource::buffer(&b.ids)),
            (3, Resource::buffer(&b.drifts)),
            (4, Resource::buffer(&b.spins)),
            (5, balls.resource),
            (6, turns.resource),
            (7, ids.resource),
            (8, drifts.resource),
        ];
        own.descriptors.bind(gpu, cmd, &self.pipelines.set, &resources)?;
        let push = SetPush {
            ball_word: balls.word,
            ball_stride: balls.stride,
            turn_word: turns.word,
            turn_stride: turns.stride,
            id_word: ids.word,
            id_stride: ids.stride,
            drift_word: drifts.word,
            drift_stride: drifts.stride,
            blobs: count,
        };
        self.pipelines.set.push(gpu, cmd, &push);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, count.div_ceil(64), 1, 1) };
        let after = written.map(|b| buffer(b.handle, COMPUTE_WRITE, AFTER)).into_iter();
        let back = hosts.iter().map(|handle| buffer(*handle, COMPUTE_READ, blobs.after));
        gpu.barriers(cmd, &[], &after.chain(back).collect::<Vec<_>>());
        Ok(())
    }

    /// Records a step. Never submits, waits or allocates device memory.
    ///
    /// # Errors
    /// [`Error::BadInput`] with the field, before the first command; after any other error discard the command buffer.
    ///
    /// # Safety
    /// As [`Renderer::record`](crate::Renderer::record); steps are submitted in the order they were recorded, before
    /// the frames that show them.
    pub unsafe fn record_step(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &HeapStep<'_>,
    ) -> Result<(), Error> {
        self.check(step)?;
        let push = self.push(step);
        let (gpu, b) = (&*self.gpu, &self.buffers);
        let slot = &mut self.slots[step.slot.0 as usize];
        slot.descriptors.reset(gpu)?;
        gpu.begin_label(cmd, c"whitewater/heap");
        slot.timer.reset(gpu, cmd);
        let scope = slot.timer.begin(gpu, cmd, c"heap");
        let solids: Vec<GpuSolid> = step.solids.iter().map(|solid| solid.on_gpu()).collect();
        let bytes: &[u8] = bytemuck::cast_slice(&solids);
        slot.solids.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
        let resources = [
            (0, Resource::buffer(&b.balls)),
            (1, Resource::buffer(&b.turns)),
            (2, Resource::buffer(&b.ids)),
            (3, Resource::buffer(&b.drifts)),
            (4, Resource::buffer(&b.spins)),
            (5, Resource::buffer(&b.buckets)),
            (6, Resource::buffer(&b.order)),
            (7, Resource::buffer(&b.heaped)),
            (8, Resource::buffer(&slot.solids)),
            (9, Resource::buffer(&b.field)),
        ];
        let descriptors = &slot.descriptors;
        let both = COMPUTE_READ_WRITE;
        let dispatch = |pipeline: &Pipeline, invocations: u32| -> Result<(), Error> {
            descriptors.bind(gpu, cmd, pipeline, &resources)?;
            pipeline.push(gpu, cmd, &push);
            // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
            unsafe { gpu.device.cmd_dispatch(cmd, invocations.div_ceil(64), 1, 1) };
            Ok(())
        };
        let parts = if self.count == 0 { 0 } else { step.settings.substeps };
        let moved = [&b.balls, &b.turns, &b.drifts, &b.spins];
        let all = [&b.buckets, &b.order, &b.heaped];
        let wait = |which: &[&Buffer]| {
            let barriers: Vec<_> = which.iter().map(|b| buffer(b.handle, both, both)).collect();
            gpu.barriers(cmd, &[], &barriers);
        };
        let first: Vec<_> = moved.iter().map(|b| buffer(b.handle, AFTER, both)).collect();
        gpu.barriers(cmd, &[], &first);
        for _ in 0..parts {
            gpu.barriers(cmd, &[], &[buffer(b.buckets.handle, both, CLEAR)]);
            // SAFETY: cmd is recording outside a render pass; the part before is done (barrier).
            unsafe { gpu.device.cmd_fill_buffer(cmd, b.buckets.handle, 0, vk::WHOLE_SIZE, 0) };
            gpu.barriers(cmd, &[], &[buffer(b.buckets.handle, CLEAR, both)]);
            wait(&[&b.order]);
            dispatch(&self.pipelines.place[0], self.count)?;
            let on = (gpu, cmd, descriptors);
            self.scan.record(on, &b.counts, (&b.buckets, self.buckets), None, 0)?;
            wait(&all);
            dispatch(&self.pipelines.place[1], self.count)?;
            wait(&all);
            dispatch(&self.pipelines.order, self.buckets)?;
            wait(&all);
            wait(&moved);
            dispatch(&self.pipelines.run, self.count)?;
            wait(&moved);
        }
        let last: Vec<_> = moved.iter().map(|b| buffer(b.handle, both, AFTER)).collect();
        gpu.barriers(cmd, &[], &last);
        slot.timer.end(gpu, cmd, scope);
        gpu.end_label(cmd);
        Ok(())
    }

    fn push(&self, step: &HeapStep<'_>) -> Push {
        let s = step.settings;
        let [x, y, z] = s.gravity;
        let (points, field) = self.field;
        // As wide as the farthest neighbours are from each other.
        let cell = 2.0 * self.largest * s.reach;
        Push {
            gravity: [x, y, z, s.drag],
            pair: [s.rest, s.reach, s.stiffness, s.cohesion],
            damping: [s.damping[0], s.damping[1], s.solid_damping, s.friction],
            solid: [s.contact, s.solidity, cell, step.dt / s.substeps as f32],
            water: [s.water.unwrap_or(-1.0e30), s.density, 0.0, 0.0],
            field,
            field_size: [points[0], points[1], points[2], step.solids.len() as u32],
            blobs: self.count,
            buckets: self.buckets,
        }
    }

    /// The blobs after the last step, for [`Frame::bubbles`](crate::Frame::bubbles) of renderers on the same queue. Their
    /// buffers are transfer sources too.
    pub fn blobs(&self) -> Blobs {
        let b = &self.buffers;
        let stream = |own: &Buffer, stride: u32| {
            let size = u64::from(stride) * u64::from(self.config.max_blobs);
            Stream { buffer: own.handle, size, offset: 0, stride }
        };
        Blobs {
            balls: stream(&b.balls, 16),
            turns: Some(stream(&b.turns, 16)),
            ids: Some(stream(&b.ids, 4)),
            count: Count::Cpu(self.count),
            before: COMPUTE_READ,
            after: COMPUTE_READ,
        }
    }

    /// Their velocities (3×f32, m/s), in the same order.
    pub fn velocities(&self) -> Stream {
        let size = 16 * u64::from(self.config.max_blobs);
        Stream { buffer: self.buffers.drifts.handle, size, offset: 0, stride: 16 }
    }

    /// Their angular velocities (3×f32, 1/s), in the same order.
    pub fn spins(&self) -> Stream {
        Stream { buffer: self.buffers.spins.handle, ..self.velocities() }
    }

    /// Times of the slot's last finished step, as [`Renderer::timings`](crate::Renderer::timings).
    pub fn timings(&mut self, slot: Slot) -> &[Timing] {
        match self.slots.get_mut(slot.0 as usize) {
            Some(own) => own.timer.timings(&self.gpu),
            None => &[],
        }
    }

    /// Bytes of device memory in use.
    pub fn memory(&self) -> u64 {
        let b = &self.buffers;
        let own = [&b.balls, &b.turns, &b.ids, &b.drifts, &b.spins, &b.buckets, &b.order];
        let own = own.into_iter().chain([&b.heaped, &b.counts, &b.field]);
        own.map(|b| b.size).sum::<u64>()
            + self.scan.memory()
            + self.slots.iter().map(|slot| slot.solids.size).sum::<u64>()
    }

    /// Frees everything. A plain drop leaks it, safely.
    ///
    /// # Safety
    /// The GPU is done with all recorded work, or it will never be submitted.
    pub unsafe fn destroy(self) {
        let gpu = self.gpu.clone();
        drop(self);
        gpu.destroy();
    }

    /// Longest stride of a stream of all blobs.
    fn stride(&self) -> u32 {
        (self.gpu.limits.max_storage_buffer_range / self.config.max_blobs) & !3
    }

    /// Everything that can be wrong with a step.
    fn check(&self, step: &HeapStep<'_>) -> Result<(), Error> {
        check::step(["HeapStep.slot", "HeapStep.dt"], step.slot, self.slots.len(), step.dt)?;
        range("HeapStep.dt", step.dt, 0.0, 1.0)?;
        step.settings.check()?;
        if step.solids.len() > self.config.max_solids as usize {
            let most = self.config.max_solids;
            let why = format!("{} are more than HeapConfig.max_solids, {most}", step.solids.len());
            return Err(Error::bad("HeapStep.solids", why));
        }
        step.solids.iter().try_for_each(Solid::check)
    }
}

/// How blobs are used between steps.
const AFTER: crate::contract::Access = COMPUTE_READ.and(COPY_READ);

impl DistanceField {
    /// Of a mesh (three corners a triangle), on a grid of points `edge` apart that goes `margin` beyond it. The inside is
    /// where the mesh winds round a point (Jacobson, Kavan, Sorkine-Hornung, Robust Inside-Outside Segmentation using
    /// Generalized Winding Numbers, 2013): it may have holes and cross itself. By all triangles for each point, once.
    ///
    /// # Errors
    /// No triangles, corners that are not finite, more than 1024 points in a row.
    pub fn of_mesh(triangles: &[[[f32; 3]; 3]], edge: f32, margin: f32) -> Result<Self, Error> {
        let bad = |why: &str| Err(Error::bad("DistanceField", why));
        let corners = || triangles.iter().flatten().map(|c| Vec3::from(*c));
        if triangles.is_empty() || !corners().all(|c| c.is_finite()) {
            return bad("triangles with finite corners expected");
        }
        if !(edge.is_finite() && edge > 0.0 && margin.is_finite() && margin >= 0.0) {
            return bad("an edge above 0 and a margin expected");
        }
        let low = corners().reduce(Vec3::min).unwrap_or_default() - margin;
        let high = corners().reduce(Vec3::max).unwrap_or_default() + margin;
        let span = ((high - low) / edge).ceil();
        if span.max_element() > 1023.0 {
            return bad("more than 1024 points in a row: a longer edge expected");
        }
        let points = span.to_array().map(|n| n as u32 + 2);
        let mut distances = Vec::with_capacity(points.iter().map(|n| *n as usize).product());
        for z in 0..points[2] {
            for y in 0..points[1] {
                for x in 0..points[0] {
                    let at = low + edge * Vec3::new(x as f32, y as f32, z as f32);
                    let (mut nearest, mut winds) = (f32::INFINITY, 0.0);
                    for triangle in triangles {
                        let [a, b, c] = triangle.map(Vec3::from);
                        nearest = nearest.min(to_triangle(at, [a, b, c]));
                        winds += solid_angle([a - at, b - at, c - at]);
                    }
                    let inside = winds.abs() > 2.0 * std::f32::consts::PI;
                    distances.push(if inside { -nearest } else { nearest });
                }
            }
        }
        Ok(Self { points, corner: low.to_array(), edge, distances })
    }
}

/// Distance of a point from a triangle (Ericson, Real-Time Collision Detection, 2004, Sec. 5.1.5).
fn to_triangle(p: Vec3, [a, b, c]: [Vec3; 3]) -> f32 {
    let along = |from: Vec3, to: Vec3| {
        let way = to - from;
        let t = ((p - from).dot(way) / way.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        p.distance(from + t * way)
    };
    let normal = (b - a).cross(c - a);
    let over = |from: Vec3, to: Vec3| (to - from).cross(p - from).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && over(a, b) && over(b, c) && over(c, a) {
        return (p - a).dot(normal.normalize()).abs();
    }
    along(a, b).min(along(b, c)).min(along(c, a))
}

/// Of a triangle seen from 0 (Van Oosterom, Strackee 1983).
fn solid_angle([a, b, c]: [Vec3; 3]) -> f32 {
    let (x, y, z) = (a.length(), b.length(), c.length());
    let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * a.dot(b.cross(c)).atan2(below)
}
