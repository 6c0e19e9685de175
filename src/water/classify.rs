//! Pass `classify`: decides by Weber number which particles are surface foam, once per simulation step (thesis
//! Sec. 3.2). A particle can be partly water and partly foam, as in Sec. 3.2.1 of the thesis; in its Listing A.14 it
//! is one or the other.
//!
//! The state of each particle (its phase between water and foam, a timer, and its age) is stored by particle id in a
//! hash table. Each step writes a new table from the previous one, so particles may be reordered, appear and vanish,
//! and the result does not depend on their order. A table larger than 128 MiB is split into parts, each its own hash
//! table; each step processes the parts one after the other.
//! Reads: velocities, densities, ids, the old table. Writes: the new table, foam.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::cull::{Window, capacity, each_once};
use crate::contract::{Count, SurfaceFoamStep};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    Access, CLEAR, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, COPY_WRITE,
    VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::gpu::timing::Timer;

/// Bytes of a row of the tables.
pub const ROW: u64 = 20;
/// Maximum number of particles per dispatch: 65 535 groups of 64.
const MOST_CHUNK: u32 = 1 << 21;
/// Maximum bytes of a part of a hash table: every device can bind this much, so a state that was saved on one device
/// fits any other.
const MOST_PART: u64 = 1 << 27;
/// If a hash table has several parts, each has a multiple of this number of rows: 64 rows are 1280 bytes, a multiple
/// of every device's offset alignment.
const PART_UNIT: u64 = 64;
/// If there are several chunks of particles, each holds a multiple of this number: the foam of 32 particles is 256
/// bytes, a multiple of every device's offset alignment.
const CHUNK_UNIT: u32 = 32;
/// Bytes of a particle's foam and age.
const FOAM: u64 = 8;

/// Access by the passes that draw foam, and by copies.
const FOAM_USE: Access = COMPUTE_READ.and(VERTEX_READ).and(COPY_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    velocity_word: u32,
    velocity_stride: u32,
    density_word: u32,
    density_stride: u32,
    id_word: u32,
    id_stride: u32,
    first: u32,
    count: u32,
    from_gpu: u32,
    chunk_end: u32,
    rows: u32,
    part_first: u32,
    part_rows: u32,
    seed: u32,
    scale: f32,
    threshold: f32,
    foam_lifetime: f32,
    dt: f32,
    air_x: f32,
    air_y: f32,
    air_z: f32,
    rest_density: f32,
}
shader::assert_layout!(
    shader::WATER_CLASSIFY_COMP,
    "Push",
    Push {
        velocity_word,
        velocity_stride,
        density_word,
        density_stride,
        id_word,
        id_stride,
        first,
        count,
        from_gpu,
        chunk_end,
        rows,
        part_first,
        part_rows,
        seed,
        scale,
        threshold,
        foam_lifetime,
        dt,
        air_x,
        air_y,
        air_z,
        rest_density,
    }
);

/// Division of the hash tables into parts that can be bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Parts {
    /// Rows per part.
    rows: u32,
    count: u32,
}

impl Parts {
    /// The division for a number of particles and a maximum binding size.
    fn new(max_particles: u32, range: u32) -> Option<Self> {
        // At most two thirds of the rows are used, which keeps the searches in the hash table short.
        let rows = u64::from(max_particles) * 3 / 2 + 1;
        let whole = u64::from(range).min(MOST_PART) / ROW;
        let (rows, count) = if rows <= whole {
            (rows, 1)
        } else {
            // Ids are hashed evenly: with millions of them all parts get the same number, to within a thousandth.
            let fits = (whole - whole % PART_UNIT).max(PART_UNIT);
            let count = rows.div_ceil(fits);
            (rows.div_ceil(count).next_multiple_of(PART_UNIT), count)
        };
        let parts = Self { rows: rows as u32, count: count as u32 };
        u32::try_from(rows * count).is_ok().then_some(parts)
    }

    /// Total number of rows.
    fn all(self) -> u32 {
        self.rows * self.count
    }

    /// A part of a table.
    fn of(self, table: &Buffer, part: u32) -> Resource {
        let bytes = ROW * u64::from(self.rows);
        Resource::Buffer(table.handle, bytes * u64::from(part), bytes)
    }
}

/// The pass.
pub struct Classify {
    pipeline: Pipeline,
    /// Tables of the previous step and of this one, alternating.
    tables: [Buffer; 2],
    parts: Parts,
    /// Foam (0 to 1) and age (seconds) of each particle of the last step, in the order that the particles had in it.
    pub foam: Buffer,
    max_particles: u32,
    chunk: u32,
}

impl Classify {
    pub fn new(gpu: &Gpu, max_particles: u32, max_stride: u32) -> Result<Self, Error> {
        let range = gpu.limits.max_storage_buffer_range;
        let parts = Parts::new(max_particles, range).ok_or_else(|| {
            let why =
                format!("{max_particles} is more than the 2.8 thousand million rows of a table");
            Error::bad("SurfaceFoamStateConfig.max_particles", why)
        })?;
        type Usage = vk::BufferUsageFlags;
        let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let make = |name, size| Buffer::new(gpu, name, size, usage, MemoryLocation::GpuOnly);
        let table = |name| make(name, ROW * u64::from(parts.all()));
        let fits = range.saturating_sub(256) / max_stride.max(FOAM as u32);
        Ok(Self {
            pipeline: Pipeline::compute(gpu, shader::WATER_CLASSIFY_COMP, &[])?,
            tables: [table("water/classify/even")?, table("water/classify/odd")?],
            parts,
            foam: make("water/classify/foam", FOAM * u64::from(max_particles))?,
            max_particles,
            chunk: (fits - fits % CHUNK_UNIT).clamp(CHUNK_UNIT, MOST_CHUNK),
        })
    }

    /// Bytes of a table.
    pub fn size(&self) -> u64 {
        ROW * u64::from(self.parts.all())
    }

    /// Returns the hash table that holds the foam state after an odd number of steps (if `odd` is true) or after an
    /// even number.
    pub fn table(&self, odd: bool) -> &Buffer {
        &self.tables[usize::from(odd)]
    }

    /// Clears `table(odd)`, which holds the state.
    pub fn record_clear(&self, gpu: &Gpu, cmd: vk::CommandBuffer, odd: bool) {
        let table = self.table(odd).handle;
        gpu.barriers(cmd, &[], &[buffer(table, COMPUTE_READ_WRITE.and(COPY_READ), CLEAR)]);
        // SAFETY: cmd is recording outside a render pass; the steps before are done (barrier).
        unsafe { gpu.device.cmd_fill_buffer(cmd, table, 0, vk::WHOLE_SIZE, 0) };
        gpu.barriers(cmd, &[], &[buffer(table, CLEAR, COMPUTE_READ_WRITE)]);
    }

    /// Copies the state to or from a host buffer.
    pub fn record_copy(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        odd: bool,
        (host, offset): (vk::Buffer, u64),
        out: bool,
    ) {
        let table = self.table(odd).handle;
        let size = self.size();
        let [from, to] = if out { [table, host] } else { [host, table] };
        let [from_offset, to_offset] = if out { [0, offset] } else { [offset, 0] };
        let region = vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size };
        let used = if out { COPY_READ } else { COPY_WRITE };
        gpu.barriers(cmd, &[], &[buffer(table, COMPUTE_READ_WRITE.and(CLEAR), used)]);
        // SAFETY: the host says that its buffer has room and is ready.
        unsafe { gpu.device.cmd_copy_buffer(cmd, from, to, &[region]) };
        gpu.barriers(cmd, &[], &[buffer(table, used, COMPUTE_READ_WRITE)]);
    }

    /// Records one step: reads the state from `table(odd)` and writes the new state to the other table. `odd` tells
    /// whether the number of steps before this one is odd.
    pub fn record(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        timer: &mut Timer,
        step: &SurfaceFoamStep<'_>,
        odd: bool,
    ) -> Result<(), Error> {
        let scope = timer.begin(gpu, cmd, c"classify");
        let (old, new) = (self.table(odd), self.table(!odd));
        let streams = [Some(&step.velocities), step.densities.as_ref(), step.ids.as_ref()];
        // Each stream with the size of its values in bytes.
        let streams = || streams.into_iter().zip([12, 4, 4]).filter_map(|(s, n)| Some((s?, n)));
        let host = each_once(streams(), step.count, None);
        let mut buffers: Vec<_> =
            host.iter().map(|handle| buffer(*handle, step.before, COMPUTE_READ)).collect();
        buffers.push(buffer(new.handle, COMPUTE_READ_WRITE.and(COPY_READ), CLEAR));
        buffers.push(buffer(self.foam.handle, FOAM_USE, COMPUTE_WRITE));
        gpu.barriers(cmd, &[], &buffers);
        // SAFETY: cmd is recording outside a render pass; the steps before are done (barrier).
        unsafe { gpu.device.cmd_fill_buffer(cmd, new.handle, 0, vk::WHOLE_SIZE, 0) };
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(new.handle, CLEAR, COMPUTE_READ_WRITE),
                buffer(old.handle, COMPUTE_READ_WRITE, COMPUTE_READ),
            ],
        );

        let most = streams().map(capacity).fold(self.max_particles, u32::min);
        let (count, from_gpu) = match step.count {
            Count::Cpu(count) => (count.min(most), None),
            Count::Gpu { buffer, offset } => (most, Some(Resource::Buffer(buffer, offset, 4))),
        };
        // Without ids there is no look-up, and only the first part is bound.
        let parts = if step.ids.is_some() { self.parts.count } else { 1 };
        let mut written = false;
        for part in 0..parts {
            for first in (0..count).step_by(self.chunk as usize) {
                let bound = Window::all(gpu, &step.velocities, [&step.densities, &step.ids], first);
                // If a stream ends before this chunk, the chunk is empty: the number of particles was limited to what
                // all streams hold.
                let Some((velocities, [densities, ids])) = bound else { break };
                if std::mem::replace(&mut written, true) {
                    // Earlier dispatches wrote rows of other parts, and the foam of other particles, to the same
                    // buffers.
                    let ours = [new.handle, self.foam.handle]
                        .map(|own| buffer(own, COMPUTE_READ_WRITE, COMPUTE_READ_WRITE));
                    gpu.barriers(cmd, &[], &ours);
                }
                let chunk = self.chunk.min(count - first);
                let foam = (FOAM * u64::from(first), FOAM * u64::from(chunk));
                descriptors.bind(
                    gpu,
                    cmd,
                    &self.pipeline,
                    &[
                        (1, velocities.resource),
                        (2, densities.resource),
                        (3, ids.resource),
                        (4, from_gpu.unwrap_or(velocities.resource)),
                        (5, self.parts.of(old, part)),
                        (6, self.parts.of(new, part)),
                        (7, Resource::Buffer(self.foam.handle, foam.0, foam.1)),
                    ],
                )?;
                let [velocity, density, id] = [velocities, densities, ids];
                let push = self.push(step, [velocity, density, id], part);
                self.pipeline.push(
                    gpu,
                    cmd,
                    &Push {
                        first,
                        count,
                        from_gpu: u32::from(from_gpu.is_some()),
                        chunk_end: first + chunk,
                        ..push
                    },
                );
                let groups = chunk.div_ceil(self.pipeline.local_size[0]);
                // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
                unsafe { gpu.device.cmd_dispatch(cmd, groups, 1, 1) };
            }
        }

        let mut after = vec![buffer(self.foam.handle, COMPUTE_WRITE, FOAM_USE)];
        after.extend(host.iter().map(|handle| buffer(*handle, COMPUTE_READ, step.after)));
        gpu.barriers(cmd, &[], &after);
        timer.end(gpu, cmd, scope);
        Ok(())
    }

    /// Push constants of a dispatch, except for its range of particles.
    fn push(
        &self,
        step: &SurfaceFoamStep<'_>,
        [velocity, density, id]: [Window; 3],
        part: u32,
    ) -> Push {
        let settings = step.settings;
        let [air_x, air_y, air_z] = settings.air;
        Push {
            velocity_word: velocity.word,
            velocity_stride: velocity.stride,
            density_word: density.word,
            density_stride: density.stride,
            id_word: id.word,
            id_stride: id.stride,
            first: 0,
            count: 0,
            from_gpu: 0,
            chunk_end: 0,
            rows: self.parts.all(),
            part_first: part * self.parts.rows,
            part_rows: self.parts.rows,
            seed: settings.seed,
            scale: settings.scale,
            threshold: settings.threshold,
            foam_lifetime: settings.foam_lifetime,
            dt: step.dt,
            air_x,
            air_y,
            air_z,
            rest_density: settings.rest_density,
        }
    }

    pub fn memory(&self) -> u64 {
        self.tables.iter().map(|table| table.size).sum::<u64>() + self.foam.size
    }

    /// Number of descriptor sets per step.
    pub fn sets(&self) -> u32 {
        self.max_particles.div_ceil(self.chunk).max(1) * self.parts.count
    }
}
