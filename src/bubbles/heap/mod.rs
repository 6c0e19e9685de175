//! Pass `heap`: blob dynamics on the GPU (Huszár, Szécsi, Sec. 6; the paper uses the CPU).
//!
//! A blob is a ball. It attracts near neighbours and repels nearer ones; it falls, rolls and rubs on solids. A blob
//! that was torn off the others splits in two, repeatedly. A step has several substeps, each of which finds
//! neighbours with a hashed grid. The blobs of a grid bucket are sorted by id, so the same blobs move identically in
//! every run, whatever their order in the host's streams.
//! Reads: the host's streams and solids. Writes: balls, turns, ids, velocities.

mod field;
mod settings;

use std::sync::Arc;

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::lists::{Places, buffers_of, windows};
use crate::check;
use crate::context::Context;
use crate::contract::{Blobs, Count, Slot, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    CLEAR, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource, bind_set};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::scan::{self, Scan};
use crate::gpu::shader;
use crate::gpu::timing::{Timer, Timing};
use crate::water::Window;
use crate::water::settings::range;
pub use field::DistanceField;
use settings::GpuSolid;
pub use settings::{BlobSimulationConfig, BlobSimulationSettings, BlobSimulationStep, Solid};

/// Access to the blobs between steps.
const AFTER: crate::contract::Access = COMPUTE_READ.and(COPY_READ);

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
    cells: f32,
    max_splits: u32,
}
shader::assert_layout!(
    shader::BUBBLES_HEAP_MOVE_COMP,
    "Push",
    Push {
        gravity,
        pair,
        damping,
        solid,
        water,
        field,
        field_size,
        blobs,
        buckets,
        cells,
        max_splits
    }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct SetPush {
    places: Places,
    drift_word: u32,
    drift_stride: u32,
    blobs: u32,
    all: u32,
}
shader::assert_layout!(
    shader::BUBBLES_HEAP_SET_COMP,
    "Push",
    SetPush { drift_word, drift_stride, blobs, all }
);

struct Pipelines {
    set: Pipeline,
    /// Two dispatches: counts, then entries.
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
    growths: Buffer,
    buckets: Buffer,
    order: Buffer,
    heaped: Buffer,
    counts: Buffer,
    field: Buffer,
}

impl Buffers {
    /// Buffers of the blobs' attributes, as every shader binds them.
    fn blobs(&self) -> [(u32, Resource); 6] {
        let own = [&self.balls, &self.turns, &self.ids, &self.drifts, &self.spins];
        std::array::from_fn(|i| match own.get(i) {
            Some(own) => (i as u32, Resource::buffer(own)),
            None => (10, Resource::buffer(&self.growths)),
        })
    }
}

struct HeapSlot {
    /// Descriptors of `record_set` and of a step: one command buffer may have both.
    setting: Descriptors,
    descriptors: Descriptors,
    timer: Timer,
    solids: Buffer,
}

/// A simulation of bubble-foam blobs. Several views can share one simulation.
pub struct BlobSimulation {
    gpu: Arc<Gpu>,
    config: BlobSimulationConfig,
    pipelines: Pipelines,
    buffers: Buffers,
    scan: Scan,
    slots: Vec<HeapSlot>,
    /// Number of grid buckets.
    buckets: u32,
    /// Points of the distance field along each axis, its corner and point distance.
    field: ([u32; 3], [f32; 4]),
    count: u32,
    /// The largest radius, which sizes the grid cells.
    largest: f32,
}

impl BlobSimulation {
    /// Creates pipelines and allocates memory: 140 to 144 bytes per entry, with
    /// 2^[`max_splits`](BlobSimulationConfig::max_splits) entries per blob; 4 bytes per point of the field; and 48
    /// bytes per solid for each frame in flight. `field` holds solids in addition to those that each step gives.
    ///
    /// # Errors
    /// Bad configuration; no memory; Vulkan errors.
    pub fn new(
        context: &Context,
        config: &BlobSimulationConfig,
        field: Option<&DistanceField>,
    ) -> Result<Self, Error> {
        if config.max_blobs == 0 || config.max_blobs > 1 << 20 {
            let why = format!("expected 1 to {}, found {}", 1 << 20, config.max_blobs);
            return Err(Error::bad("BlobSimulationConfig.max_blobs", why));
        }
        if config.max_splits > 6 || config.max_blobs << config.max_splits > 1 << 20 {
            let why = format!(
                "{} of {} blobs: 0 to 6, and not more than {} places expected",
                config.max_splits,
                config.max_blobs,
                1 << 20
            );
            return Err(Error::bad("BlobSimulationConfig.max_splits", why));
        }
        if config.max_solids > 65_536 {
            let why = format!("expected 0 to 65536, found {}", config.max_solids);
            return Err(Error::bad("BlobSimulationConfig.max_solids", why));
        }
        field.map_or(Ok(()), DistanceField::check)?;
        let gpu = Gpu::new(context);
        let made = field
            .map_or(Ok(()), |field| field.check_binding(gpu.limits.max_storage_buffer_range))
            .and_then(|()| Self::made(&gpu, config, field));
        match made {
            Ok(heap) => Ok(heap),
            Err(error) => {
                // Nothing was submitted with the objects created before the failure.
                gpu.destroy();
                Err(error)
            }
        }
    }

    fn made(
        gpu: &Arc<Gpu>,
        config: &BlobSimulationConfig,
        field: Option<&DistanceField>,
    ) -> Result<Self, Error> {
        let places = config.max_blobs << config.max_splits;
        let most = u64::from(places);
        let buckets = places.next_power_of_two();
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
        let slot = |_| {
            let size = size_of::<GpuSolid>() as u64 * u64::from(config.max_solids);
            Ok(HeapSlot {
                // One set of ten bindings: the capacity for one set would be eight, for two it is sixteen.
                setting: Descriptors::new(gpu, 2)?,
                descriptors: Descriptors::new(gpu, 4 + scan::SETS)?,
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
                growths: sized("heap/growths", 16 * most)?,
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

    /// Records the initial blobs: the host's, at rest or with velocities (3×f32, scene units per second). Their number
    /// has to be a [`Count::Cpu`]. `largest` is their largest radius, which sizes the cells of the grid that finds
    /// neighbours. This call uses other resources of the slot than a step, so it may have the slot and the command
    /// buffer of the first step.
    ///
    /// # Errors
    /// [`Error::BadInput`], which names the field, before the first command is recorded.
    ///
    /// # Safety
    /// The conditions of [`record_step`](Self::record_step) hold.
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
        let most = ("BlobSimulationConfig.max_blobs", self.config.max_blobs);
        let count = check::count(fields, blobs.count, most, &self.gpu.limits)?;
        if matches!(blobs.count, Count::Gpu { .. }) {
            return Err(Error::bad(
                "Blobs.count",
                "Count::Gpu, expected Count::Cpu: the CPU sizes the simulation",
            ));
        }
        let most = ("the device's limit for all blobs", self.stride());
        blobs.spheres.check("Blobs.spheres", 16, count, most)?;
        blobs.rotations.map_or(Ok(()), |turns| turns.check("Blobs.rotations", 16, count, most))?;
        blobs.ids.map_or(Ok(()), |ids| ids.check("Blobs.ids", 4, count, most))?;
        velocities.map_or(Ok(()), |v| v.check("velocities", 12, count, most))?;
        if !(largest.is_finite() && largest > 0.0) {
            return Err(Error::bad(
                "largest",
                format!("expected a radius above 0, found {largest}"),
            ));
        }
        self.count = count;
        self.largest = largest;
        if count == 0 {
            return Ok(());
        }
        let gpu = &*self.gpu;
        let own = &mut self.slots[slot.0 as usize];
        own.setting.reset(gpu)?;
        let ended = || Error::bad("Blobs.spheres", "ends before the first");
        let ([balls, turns, ids], places) = windows(gpu, blobs).ok_or_else(ended)?;
        let drifts = velocities.and_then(|stream| Window::new(gpu, stream, 0));
        // Bound but not read.
        let drifts = drifts.unwrap_or(Window { resource: balls, word: 0, stride: 0 });
        let b = &self.buffers;
        let written = [&b.balls, &b.turns, &b.ids, &b.drifts, &b.spins, &b.growths];
        let mut hosts = buffers_of(blobs);
        hosts.extend(velocities.map(|v| v.buffer).filter(|v| !hosts.contains(v)));
        let before = written.map(|b| buffer(b.handle, AFTER, COMPUTE_WRITE)).into_iter();
        let taken = hosts.iter().map(|handle| buffer(*handle, blobs.before, COMPUTE_READ));
        gpu.barriers(cmd, &[], &before.chain(taken).collect::<Vec<_>>());
        let hosts_own = [(5, balls), (6, turns), (7, ids), (8, drifts.resource)];
        let resources = [&b.blobs()[..], &hosts_own].concat();
        own.setting.bind(gpu, cmd, &self.pipelines.set, &resources)?;
        let all = count << self.config.max_splits;
        let [drift_word, drift_stride] = [drifts.word, drifts.stride];
        let push = SetPush { places, drift_word, drift_stride, blobs: count, all };
        self.pipelines.set.push(gpu, cmd, &push);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, all.div_ceil(64), 1, 1) };
        let after = written.map(|b| buffer(b.handle, COMPUTE_WRITE, AFTER)).into_iter();
        let back = hosts.iter().map(|handle| buffer(*handle, COMPUTE_READ, blobs.after));
        gpu.barriers(cmd, &[], &after.chain(back).collect::<Vec<_>>());
        Ok(())
    }

    /// Records a step. It never submits, waits or allocates device memory.
    ///
    /// # Errors
    /// [`Error::BadInput`], which names the field, before the first command is recorded. After any other error,
    /// discard the command buffer.
    ///
    /// # Safety
    /// The conditions of [`Renderer::record`](crate::Renderer::record) hold. Steps are submitted in the order in
    /// which they were recorded, before the frames that show them.
    pub unsafe fn record_step(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &BlobSimulationStep<'_>,
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
        let grid = [
            (5, Resource::buffer(&b.buckets)),
            (6, Resource::buffer(&b.order)),
            (7, Resource::buffer(&b.heaped)),
            (8, Resource::buffer(&slot.solids)),
            (9, Resource::buffer(&b.field)),
        ];
        let resources = [&b.blobs()[..], &grid].concat();
        let p = &self.pipelines;
        let set = |pipeline| slot.descriptors.set(gpu, pipeline, &resources);
        let sets = [set(&p.place[0])?, set(&p.place[1])?, set(&p.order)?, set(&p.run)?];
        let scan = self.scan.sets(gpu, &slot.descriptors, &b.counts, &b.buckets)?;
        let dispatch = |pipeline: &Pipeline, set: usize, invocations: u32| {
            pipeline.bind(gpu, cmd);
            bind_set(gpu, cmd, pipeline, sets[set]);
            pipeline.push(gpu, cmd, &push);
            // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
            unsafe { gpu.device.cmd_dispatch(cmd, invocations.div_ceil(64), 1, 1) };
        };
        let both = COMPUTE_READ_WRITE;
        let moved = [&b.balls, &b.turns, &b.ids, &b.drifts, &b.spins, &b.growths];
        let moved = |from, to| moved.map(|b| buffer(b.handle, from, to));
        let wait = |which: &[&Buffer]| {
            let barriers: Vec<_> = which.iter().map(|b| buffer(b.handle, both, both)).collect();
            gpu.barriers(cmd, &[], &barriers);
        };
        for part in 0..if self.count == 0 { 0 } else { step.settings.substeps } {
            let before = moved(if part == 0 { AFTER } else { both }, both);
            // The first dispatch has the order bound as well.
            let others =
                [buffer(b.buckets.handle, both, CLEAR), buffer(b.order.handle, both, both)];
            gpu.barriers(cmd, &[], &[&before[..], &others].concat());
            // SAFETY: cmd is recording outside a render pass; the previous substep has finished (barrier).
            unsafe { gpu.device.cmd_fill_buffer(cmd, b.buckets.handle, 0, vk::WHOLE_SIZE, 0) };
            gpu.barriers(cmd, &[], &[buffer(b.buckets.handle, CLEAR, both)]);
            dispatch(&p.place[0], 0, push.blobs);
            let values = (&b.buckets, self.buckets);
            self.scan.record_with((gpu, cmd, scan), &b.counts, values, None, 0);
            wait(&[&b.buckets, &b.order]);
            dispatch(&p.place[1], 1, push.blobs);
            wait(&[&b.buckets, &b.order, &b.heaped]);
            dispatch(&p.order, 2, self.buckets);
            wait(&[&b.heaped, &b.balls, &b.ids, &b.drifts, &b.spins]);
            dispatch(&p.run, 3, push.blobs);
        }
        gpu.barriers(cmd, &[], &moved(both, AFTER));
        slot.timer.end(gpu, cmd, scope);
        gpu.end_label(cmd);
        Ok(())
    }

    fn push(&self, step: &BlobSimulationStep<'_>) -> Push {
        let s = step.settings;
        let [x, y, z] = s.gravity;
        let (points, field) = self.field;
        // Cells are as wide as the max distance of neighbours.
        let cells = 1.0 / (2.0 * self.largest * s.reach);
        Push {
            gravity: [x, y, z, s.drag],
            pair: [s.rest, s.reach, s.stiffness, s.cohesion],
            damping: [s.normal_damping, s.tangential_damping, s.solid_damping, s.friction],
            solid: [s.contact, s.solidity, step.dt / s.substeps as f32, s.split_duration],
            water: [s.water.unwrap_or(-1.0e30), s.density, s.split_support, s.split_delay],
            field,
            field_size: [points[0], points[1], points[2], step.solids.len() as u32],
            blobs: self.count(),
            buckets: self.buckets,
            cells,
            max_splits: self.config.max_splits,
        }
    }

    /// The blobs after the last step, for [`Frame::bubbles`](crate::Frame::bubbles) of renderers on the same queue.
    /// Their buffers also have transfer-source usage.
    pub fn blobs(&self) -> Blobs {
        let b = &self.buffers;
        let stream = |own: &Buffer, stride: u32| {
            let size = u64::from(stride) * u64::from(self.places());
            Stream { buffer: own.handle, size, offset: 0, stride }
        };
        Blobs {
            spheres: stream(&b.balls, 16),
            rotations: Some(stream(&b.turns, 16)),
            ids: Some(stream(&b.ids, 4)),
            count: Count::Cpu(self.count()),
            before: COMPUTE_READ,
            after: COMPUTE_READ,
        }
    }

    /// Velocities of these blobs (3×f32, scene units per second), in the same order.
    pub fn velocities(&self) -> Stream {
        let size = 16 * u64::from(self.places());
        Stream { buffer: self.buffers.drifts.handle, size, offset: 0, stride: 16 }
    }

    /// Angular velocities of these blobs (3×f32, 1/s), in the same order.
    pub fn spins(&self) -> Stream {
        Stream { buffer: self.buffers.spins.handle, ..self.velocities() }
    }

    /// Number of entries in the streams of [`blobs`](Self::blobs): 0 before [`record_set`](Self::record_set), then the
    /// number of blobs that it was given, times `2^max_splits` ([`BlobSimulationConfig::max_splits`]). The spheres of
    /// entries that no half of a split blob uses yet are all zeros. `max_blobs` of `Config::bubbles` has to be at
    /// least as large; `max_blobs * 2^max_splits` of [`BlobSimulationConfig`] always is.
    pub fn count(&self) -> u32 {
        self.count << self.config.max_splits
    }

    fn places(&self) -> u32 {
        self.config.max_blobs << self.config.max_splits
    }

    /// Times of the slot's last finished step, in the form of [`Renderer::timings`](crate::Renderer::timings).
    pub fn timings(&mut self, slot: Slot) -> &[Timing] {
        match self.slots.get_mut(slot.0 as usize) {
            Some(own) => own.timer.timings(&self.gpu),
            None => &[],
        }
    }

    /// Bytes of device memory in use.
    pub fn memory(&self) -> u64 {
        let b = &self.buffers;
        let own = [&b.balls, &b.turns, &b.ids, &b.drifts, &b.spins, &b.growths, &b.buckets];
        let own = own.into_iter().chain([&b.order, &b.heaped, &b.counts, &b.field]);
        own.map(|b| b.size).sum::<u64>()
            + self.scan.memory()
            + self.slots.iter().map(|slot| slot.solids.size).sum::<u64>()
    }

    /// Frees everything. A plain drop is safe, but leaks.
    ///
    /// # Safety
    /// All recorded work is complete, or will never be submitted.
    pub unsafe fn destroy(self) {
        let gpu = self.gpu.clone();
        drop(self);
        gpu.destroy();
    }

    /// Maximum stride of a stream, so that all blobs fit in one binding.
    fn stride(&self) -> u32 {
        (self.gpu.limits.max_storage_buffer_range / self.config.max_blobs) & !3
    }

    /// Validates a step.
    fn check(&self, step: &BlobSimulationStep<'_>) -> Result<(), Error> {
        check::step(
            ["BlobSimulationStep.slot", "BlobSimulationStep.dt"],
            step.slot,
            self.slots.len(),
            step.dt,
        )?;
        range("BlobSimulationStep.dt", step.dt, 0.0, 1.0)?;
        step.settings.check()?;
        if step.solids.len() > self.config.max_solids as usize {
            let most = self.config.max_solids;
            let why = format!(
                "{} are more than BlobSimulationConfig.max_solids, {most}",
                step.solids.len()
            );
            return Err(Error::bad("BlobSimulationStep.solids", why));
        }
        step.solids.iter().try_for_each(Solid::check)
    }
}
