//! Passes of a step: `grid`, `potentials`, `crest`, `advance`, `emit`. A snapshot has `trace` in place of `advance`.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::settings::{GeneratorConfig, PotentialRange};
use crate::contract::{Access, Count, GeneratorStep};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    CLEAR, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, COPY_WRITE, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::scan::{self, Scan};
use crate::gpu::shader;
use crate::gpu::timing::Timer;
use crate::water::{Window, capacity, each_once};

/// Maximum number of groups per dispatch; their invocations loop over the remaining items.
pub const MOST_GROUPS: u32 = 4096;
/// Max number of fluid particles per chunk (the particles of one dispatch). The device's max size of a binding limits
/// it further, depending on the stride of the host's streams.
const MOST_CHUNK: u32 = 1 << 24;

/// Words of the counts (glsl/include/generate_types.glsl).
#[derive(Clone, Copy)]
pub enum Counts {
    High,
    Fluid,
    Sorted,
    Free,
    Made,
}

/// Bytes of the counts.
const COUNTS: u64 = 24;
/// Bytes of a whitewater particle: position and age, velocity and id, kind.
pub const PARTICLE: u64 = 16;
pub const DRIFT: u64 = 16;
pub const KIND: u64 = 4;

/// Access to whitewater particles and potentials after a step.
pub const AFTER: Access = COMPUTE_READ.and(COPY_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct FluidPush {
    position_word: u32,
    position_stride: u32,
    velocity_word: u32,
    velocity_stride: u32,
    id_word: u32,
    id_stride: u32,
    chunk_first: u32,
    chunk: u32,
    spacing: f32,
    cells: f32,
    buckets: u32,
}
shader::assert_layout!(
    shader::GENERATE_COUNT_COMP,
    "Push",
    FluidPush {
        position_word,
        position_stride,
        velocity_word,
        velocity_stride,
        id_word,
        id_stride,
        chunk_first,
        chunk,
        spacing,
        cells,
        buckets,
    }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    spacing: f32,
    dt: f32,
    seed: u32,
    number: u32,
    gravity_x: f32,
    gravity_y: f32,
    gravity_z: f32,
    buoyancy: f32,
    drag: f32,
    trapped_least: f32,
    trapped_scale: f32,
    crest_least: f32,
    crest_scale: f32,
    energy_least: f32,
    energy_scale: f32,
    trapped_rate: f32,
    crest_rate: f32,
    life_least: f32,
    life_most: f32,
    low_x: f32,
    low_y: f32,
    low_z: f32,
    high_x: f32,
    high_y: f32,
    high_z: f32,
    buckets: u32,
    most: u32,
    capacity: u32,
    cells: f32,
    gravity: f32,
}
shader::assert_layout!(
    shader::GENERATE_CREST_COMP,
    "Push",
    Push {
        spacing,
        dt,
        seed,
        number,
        gravity_x,
        gravity_y,
        gravity_z,
        buoyancy,
        drag,
        trapped_least,
        trapped_scale,
        crest_least,
        crest_scale,
        energy_least,
        energy_scale,
        trapped_rate,
        crest_rate,
        life_least,
        life_most,
        low_x,
        low_y,
        low_z,
        high_x,
        high_y,
        high_z,
        buckets,
        most,
        capacity,
        cells,
        gravity,
    }
);

/// The acceleration that sets the shaders' step of speeds: the length of gravity, or, without gravity, 9.81 scene units
/// per second squared. Its product with the spacing stays in a range in which the fixed-point sums are finite.
fn step_gravity(gravity: [f32; 3], spacing: f32) -> f32 {
    // Squares are exact in double precision, so gravity along an axis keeps its bits.
    let [x, y, z] = gravity.map(f64::from);
    let length = (x * x + y * y + z * z).sqrt();
    let length = if length > 0.0 { length } else { f64::from(9.81_f32) };
    let spacing = f64::from(spacing);
    length.clamp(1.0e-24 / spacing, 1.0e30 / spacing).min(f64::from(f32::MAX)) as f32
}

impl Push {
    fn new(step: &GeneratorStep<'_>, fluid: u32, buckets: u32, most: u32) -> Self {
        let GeneratorStep { dt, number, settings: s, .. } = *step;
        let scale = |limits: PotentialRange| 1.0 / (limits.max - limits.min);
        let [gravity_x, gravity_y, gravity_z] = s.gravity;
        let [low, high] = s.bounds.unwrap_or([[-f32::MAX; 3], [f32::MAX; 3]]);
        Self {
            spacing: s.spacing,
            dt,
            seed: s.seed,
            number,
            gravity_x,
            gravity_y,
            gravity_z,
            buoyancy: s.buoyancy,
            drag: s.drag,
            trapped_least: s.trapped_air.min,
            trapped_scale: scale(s.trapped_air),
            crest_least: s.wave_crest.min,
            crest_scale: scale(s.wave_crest),
            energy_least: s.energy.min,
            energy_scale: scale(s.energy),
            trapped_rate: s.trapped_air_rate,
            crest_rate: s.wave_crest_rate,
            life_least: s.min_lifetime,
            life_most: s.max_lifetime,
            low_x: low[0],
            low_y: low[1],
            low_z: low[2],
            high_x: high[0],
            high_y: high[1],
            high_z: high[2],
            buckets,
            most,
            capacity: fluid,
            cells: 0.5 / s.spacing,
            gravity: step_gravity(s.gravity, s.spacing),
        }
    }
}

struct Pipelines {
    /// Pipelines for a CPU count and for one in a buffer.
    begin: [Pipeline; 2],
    count: Pipeline,
    fill: Pipeline,
    potentials: Pipeline,
    crest: Pipeline,
    advance: Pipeline,
    free: Pipeline,
    trace: Pipeline,
    /// Pipelines of a step and of a snapshot.
    emit: [Pipeline; 2],
    end: Pipeline,
}

/// Buffers of the passes.
pub struct Buffers {
    pub counts: Buffer,
    /// End of each bucket in the particle list.
    buckets: Buffer,
    places: Buffer,
    motions: Buffer,
    /// Surface normals. In a snapshot, they are later replaced by the numbers of whitewater particles that each fluid
    /// particle emits at the moments to which it is traced back.
    normals: Buffer,
    /// Emission rate of each particle, relative to the maximum.
    rates: Buffer,
    /// For each fluid particle, in the order of the host's streams (not in the grid's order), four `f32`: potentials
    /// of trapped air, wave crest and energy, and number of neighbours.
    pub potentials: Buffer,
    /// Number of whitewater particles that each fluid particle emits, later replaced by its exclusive prefix sum.
    wanted: Buffer,
    pub particles: Buffer,
    pub drifts: Buffer,
    pub kinds: Buffer,
    /// Flags of free slots, then their exclusive prefix sum.
    gone: Buffer,
    free: Buffer,
}

impl Buffers {
    fn new(gpu: &Gpu, config: &GeneratorConfig, buckets: u32) -> Result<Self, Error> {
        type Usage = vk::BufferUsageFlags;
        let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_SRC | Usage::TRANSFER_DST;
        let make = |name, each: u64, count: u32| {
            Buffer::new(gpu, name, each * u64::from(count), usage, MemoryLocation::GpuOnly)
        };
        let (fluid, whitewater) = (config.max_fluid, config.max_particles);
        Ok(Self {
            counts: make("generate/counts", COUNTS, 1)?,
            buckets: make("generate/buckets", 4, buckets)?,
            places: make("generate/places", 16, fluid)?,
            motions: make("generate/motions", 16, fluid)?,
            normals: make("generate/normals", 16, fluid)?,
            rates: make("generate/rates", 4, fluid)?,
            potentials: make("generate/potentials", 16, fluid)?,
            wanted: make("generate/wanted", 4, fluid)?,
            particles: make("generate/particles", PARTICLE, whitewater)?,
            drifts: make("generate/drifts", DRIFT, whitewater)?,
            kinds: make("generate/kinds", KIND, whitewater)?,
            gone: make("generate/gone", 4, whitewater)?,
            free: make("generate/free", 4, whitewater)?,
        })
    }

    fn all(&self) -> [&Buffer; 13] {
        [
            &self.counts,
            &self.buckets,
            &self.places,
            &self.motions,
            &self.normals,
            &self.rates,
            &self.potentials,
            &self.wanted,
            &self.particles,
            &self.drifts,
            &self.kinds,
            &self.gone,
            &self.free,
        ]
    }

    /// Persistent buffers, with their used bytes for `most` particles.
    fn state(&self, most: u32) -> [(&Buffer, u64); 4] {
        let most = u64::from(most);
        [
            (&self.counts, COUNTS),
            (&self.particles, PARTICLE * most),
            (&self.drifts, DRIFT * most),
            (&self.kinds, KIND * most),
        ]
    }
}

/// All passes of the generator.
pub struct Passes {
    pipelines: Pipelines,
    pub buffers: Buffers,
    scan: Scan,
    config: GeneratorConfig,
    buckets: u32,
    chunk: u32,
}

/// Recording state of a step.
struct Recorder<'a> {
    gpu: &'a Gpu,
    cmd: vk::CommandBuffer,
    descriptors: &'a Descriptors,
}

impl Recorder<'_> {
    /// Barrier: makes compute writes visible to the commands that follow.
    fn wait(&self) {
        let both = COMPUTE_READ_WRITE;
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(both.stage)
            .src_access_mask(COMPUTE_WRITE.access)
            .dst_stage_mask(both.stage)
            .dst_access_mask(both.access)];
        let info = vk::DependencyInfo::default().memory_barriers(&barrier);
        self.gpu.dependency(self.cmd, &info);
    }

    fn dispatch<T: NoUninit>(
        &self,
        pipeline: &Pipeline,
        resources: &[(u32, Resource)],
        push: &T,
        invocations: u32,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (self.gpu, self.cmd);
        self.descriptors.bind(gpu, cmd, pipeline, resources)?;
        pipeline.push(gpu, cmd, push);
        let groups = invocations.div_ceil(pipeline.local_size[0]).clamp(1, MOST_GROUPS);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, groups, 1, 1) };
        Ok(())
    }
}

impl Passes {
    pub fn new(gpu: &Gpu, config: &GeneratorConfig) -> Result<Self, Error> {
        let range = u64::from(gpu.limits.max_storage_buffer_range);
        for (field, value) in [
            ("GeneratorConfig.max_fluid", config.max_fluid),
            ("GeneratorConfig.max_particles", config.max_particles),
        ] {
            if 16 * u64::from(value) > range {
                let why = format!("{value} is more than the device's limit of {}", range / 16);
                return Err(Error::bad(field, why));
            }
        }
        let buckets = config.max_fluid.next_power_of_two();
        let fits = (range.saturating_sub(256) / u64::from(config.max_stride)) as u32;
        let compute = |shader| Pipeline::compute(gpu, shader, &[]);
        let begin =
            |from_gpu| Pipeline::compute(gpu, shader::GENERATE_BEGIN_COMP, &[(0, from_gpu)]);
        let emit = |snapshot| Pipeline::compute(gpu, shader::GENERATE_EMIT_COMP, &[(0, snapshot)]);
        Ok(Self {
            pipelines: Pipelines {
                begin: [begin(0)?, begin(1)?],
                count: compute(shader::GENERATE_COUNT_COMP)?,
                fill: compute(shader::GENERATE_FILL_COMP)?,
                potentials: compute(shader::GENERATE_POTENTIALS_COMP)?,
                crest: compute(shader::GENERATE_CREST_COMP)?,
                advance: compute(shader::GENERATE_ADVANCE_COMP)?,
                free: compute(shader::GENERATE_FREE_COMP)?,
                trace: compute(shader::GENERATE_TRACE_COMP)?,
                emit: [emit(0)?, emit(1)?],
                end: compute(shader::GENERATE_END_COMP)?,
            },
            buffers: Buffers::new(gpu, config, buckets)?,
            scan: Scan::new(gpu, "generate/scan", buckets.max(config.max_particles))?,
            config: *config,
            buckets,
            chunk: fits.clamp(1, MOST_CHUNK),
        })
    }

    /// Descriptor sets per step: one per pass, three scans, two per chunk.
    pub fn sets(&self) -> u32 {
        7 + 3 * scan::SETS + 2 * self.config.max_fluid.div_ceil(self.chunk)
    }

    /// Records that there are no whitewater particles.
    pub fn record_clear(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        let counts = self.buffers.counts.handle;
        gpu.barriers(cmd, &[], &[buffer(counts, AFTER, CLEAR)]);
        // SAFETY: cmd is recording outside a render pass; the steps before are done (barrier).
        unsafe { gpu.device.cmd_fill_buffer(cmd, counts, 0, vk::WHOLE_SIZE, 0) };
        gpu.barriers(cmd, &[], &[buffer(counts, CLEAR, AFTER)]);
    }

    /// Bytes of a saved state.
    pub fn size(&self) -> u64 {
        self.buffers.state(self.config.max_particles).iter().map(|(_, size)| size).sum()
    }

    /// Copies the state to or from a host buffer.
    pub fn record_copy(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        (host, mut offset): (vk::Buffer, u64),
        out: bool,
    ) {
        let state = self.buffers.state(self.config.max_particles);
        let used = if out { COPY_READ } else { COPY_WRITE };
        gpu.barriers(cmd, &[], &state.map(|(part, _)| buffer(part.handle, AFTER, used)));
        for (part, size) in state {
            let [from, to] = if out { [part.handle, host] } else { [host, part.handle] };
            let [src_offset, dst_offset] = if out { [0, offset] } else { [offset, 0] };
            let region = vk::BufferCopy { src_offset, dst_offset, size };
            // SAFETY: the host says that its buffer has room and is ready.
            unsafe { gpu.device.cmd_copy_buffer(cmd, from, to, &[region]) };
            offset += size;
        }
        gpu.barriers(cmd, &[], &state.map(|(part, _)| buffer(part.handle, used, AFTER)));
    }

    pub fn record(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        descriptors: &Descriptors,
        timer: &mut Timer,
        step: &GeneratorStep<'_>,
        snapshot: bool,
    ) -> Result<(), Error> {
        if snapshot {
            self.record_clear(gpu, cmd);
        }
        let r = Recorder { gpu, cmd, descriptors };
        let streams = [Some(&step.positions), Some(&step.velocities), step.ids.as_ref()];
        let streams = || streams.into_iter().flatten().zip([12, 12, 4]);
        let most = streams().map(capacity).fold(self.config.max_fluid, u32::min);
        let fluid = match step.count {
            Count::Cpu(count) => count.min(most),
            Count::Gpu { .. } => most,
        };
        let push = Push::new(step, fluid, self.buckets, self.config.max_particles);
        let host = each_once(streams(), step.count, None);
        let b = &self.buffers;
        let before: Vec<_> = b
            .all()
            .iter()
            .map(|own| match own.handle == b.buckets.handle {
                true => buffer(own.handle, COMPUTE_READ_WRITE, CLEAR),
                false => buffer(own.handle, AFTER.and(COMPUTE_READ_WRITE), COMPUTE_READ_WRITE),
            })
            .chain(host.iter().map(|handle| buffer(*handle, step.before, COMPUTE_READ)))
            .collect();
        gpu.barriers(cmd, &[], &before);

        let scope = timer.begin(gpu, cmd, c"grid");
        self.record_grid(&r, step, fluid, &push)?;
        timer.end(gpu, cmd, scope);

        let grid = [
            (1, Resource::buffer(&b.buckets)),
            (2, Resource::buffer(&b.places)),
            (3, Resource::buffer(&b.motions)),
            (4, Resource::buffer(&b.counts)),
        ];
        let with = |more: &[(u32, &Buffer)]| -> Vec<_> {
            let more = more.iter().map(|(binding, own)| (*binding, Resource::buffer(own)));
            grid.into_iter().chain(more).collect()
        };
        let scope = timer.begin(gpu, cmd, c"potentials");
        let written = with(&[(5, &b.normals), (6, &b.potentials)]);
        r.dispatch(&self.pipelines.potentials, &written, &push, fluid)?;
        r.wait();
        timer.end(gpu, cmd, scope);

        let scope = timer.begin(gpu, cmd, c"crest");
        let written = with(&[(5, &b.normals), (6, &b.potentials), (7, &b.wanted), (8, &b.rates)]);
        r.dispatch(&self.pipelines.crest, &written, &push, fluid)?;
        timer.end(gpu, cmd, scope);

        if snapshot {
            r.wait();
            let scope = timer.begin(gpu, cmd, c"trace");
            let written = with(&[(5, &b.normals), (6, &b.rates), (7, &b.wanted)]);
            r.dispatch(&self.pipelines.trace, &written, &push, fluid)?;
            timer.end(gpu, cmd, scope);
        } else {
            let scope = timer.begin(gpu, cmd, c"advance");
            self.record_advance(&r, &with(&[]), &push)?;
            timer.end(gpu, cmd, scope);
        }

        let scope = timer.begin(gpu, cmd, c"emit");
        self.record_emit(&r, fluid, &push, snapshot)?;
        timer.end(gpu, cmd, scope);

        let mut after: Vec<_> = [&b.counts, &b.potentials, &b.particles, &b.drifts, &b.kinds]
            .map(|own| buffer(own.handle, COMPUTE_READ_WRITE, AFTER))
            .into();
        after.extend(host.iter().map(|handle| buffer(*handle, COMPUTE_READ, step.after)));
        gpu.barriers(cmd, &[], &after);
        Ok(())
    }

    /// Records pass `grid`.
    fn record_grid(
        &self,
        r: &Recorder<'_>,
        step: &GeneratorStep<'_>,
        fluid: u32,
        push: &Push,
    ) -> Result<(), Error> {
        let (gpu, cmd, b) = (r.gpu, r.cmd, &self.buffers);
        // SAFETY: cmd is recording outside a render pass; the buffer is ready (barrier).
        unsafe { gpu.device.cmd_fill_buffer(cmd, b.buckets.handle, 0, vk::WHOLE_SIZE, 0) };
        gpu.barriers(cmd, &[], &[buffer(b.buckets.handle, CLEAR, COMPUTE_READ_WRITE)]);
        let counts = Resource::buffer(&b.counts);
        // If the host knows the count, any buffer can be bound.
        let (begin, count) = match step.count {
            Count::Cpu(_) => (0, counts),
            Count::Gpu { buffer, offset } => (1, Resource::Buffer(buffer, offset, 4)),
        };
        r.dispatch(&self.pipelines.begin[begin], &[(1, count), (2, counts)], push, 1)?;
        r.wait();
        let chunked = |pipeline: &Pipeline, more: &[(u32, Resource)]| {
            let mut first = 0;
            while first < fluid {
                let others = [&Some(step.velocities), &step.ids];
                let bound = Window::all(gpu, &step.positions, others, first);
                // If a stream ends before the chunk, the chunk has no particles: the count was clamped.
                let Some((positions, [velocities, ids])) = bound else { break };
                let chunk = self.chunk.min(fluid - first);
                let own = [
                    (1, positions.resource),
                    (2, velocities.resource),
                    (3, ids.resource),
                    (4, counts),
                    (5, Resource::buffer(&b.buckets)),
                ];
                let resources = [&own[..], more].concat();
                let push = FluidPush {
                    position_word: positions.word,
                    position_stride: positions.stride,
                    velocity_word: velocities.word,
                    velocity_stride: velocities.stride,
                    id_word: ids.word,
                    id_stride: ids.stride,
                    chunk_first: first,
                    chunk,
                    spacing: step.settings.spacing,
                    cells: 0.5 / step.settings.spacing,
                    buckets: self.buckets,
                };
                r.dispatch(pipeline, &resources, &push, chunk)?;
                first += chunk;
            }
            Ok::<_, Error>(())
        };
        let none = [(6, Resource::buffer(&b.wanted)), (7, Resource::buffer(&b.potentials))];
        chunked(&self.pipelines.count, &none)?;
        let values = (&b.buckets, self.buckets);
        self.scan.record(
            (gpu, cmd, r.descriptors),
            &b.counts,
            values,
            None,
            Counts::Sorted as u32,
        )?;
        r.wait();
        let sorted = [(6, Resource::buffer(&b.places)), (7, Resource::buffer(&b.motions))];
        chunked(&self.pipelines.fill, &sorted)?;
        r.wait();
        Ok(())
    }

    /// Records pass `advance`: existing particles, then the free slots.
    fn record_advance(
        &self,
        r: &Recorder<'_>,
        grid: &[(u32, Resource)],
        push: &Push,
    ) -> Result<(), Error> {
        let b = &self.buffers;
        let own = [(5, &b.particles), (6, &b.drifts), (7, &b.kinds), (8, &b.gone)];
        let own = own.map(|(binding, own)| (binding, Resource::buffer(own)));
        let most = self.config.max_particles;
        r.dispatch(&self.pipelines.advance, &[grid, &own].concat(), push, most)?;
        let (values, high) = ((&b.gone, most), Some(Counts::High as u32));
        let to = (r.gpu, r.cmd, r.descriptors);
        self.scan.record(to, &b.counts, values, high, Counts::Free as u32)?;
        r.wait();
        let resources = [
            (1, Resource::buffer(&b.counts)),
            (2, Resource::buffer(&b.particles)),
            (3, Resource::buffer(&b.gone)),
            (4, Resource::buffer(&b.free)),
        ];
        r.dispatch(&self.pipelines.free, &resources, push, most)
    }

    /// Records pass `emit`, and the final counts.
    fn record_emit(
        &self,
        r: &Recorder<'_>,
        fluid: u32,
        push: &Push,
        snapshot: bool,
    ) -> Result<(), Error> {
        let b = &self.buffers;
        let (values, count) = ((&b.wanted, self.config.max_fluid), Some(Counts::Fluid as u32));
        let to = (r.gpu, r.cmd, r.descriptors);
        self.scan.record(to, &b.counts, values, count, Counts::Made as u32)?;
        r.wait();
        let resources = [
            (1, &b.counts),
            (2, &b.places),
            (3, &b.motions),
            (4, &b.normals),
            (5, &b.wanted),
            (6, &b.free),
            (7, &b.particles),
            (8, &b.drifts),
            (9, &b.kinds),
        ];
        let resources = resources.map(|(binding, own)| (binding, Resource::buffer(own)));
        r.dispatch(&self.pipelines.emit[usize::from(snapshot)], &resources, push, fluid)?;
        r.wait();
        r.dispatch(&self.pipelines.end, &[(1, Resource::buffer(&b.counts))], push, 1)
    }

    /// Bytes of buffers.
    pub fn memory(&self) -> u64 {
        self.buffers.all().iter().map(|own| own.size).sum::<u64>() + self.scan.memory()
    }
}

#[cfg(test)]
mod tests {
    use super::step_gravity;

    #[test]
    fn the_step_of_speeds_goes_by_gravity() {
        assert_eq!(step_gravity([0.0, -9.81, 0.0], 0.05), 9.81);
        assert_eq!(step_gravity([-0.0, -0.0, 9810.0], 50.0), 9810.0);
        assert_eq!(step_gravity([0.0, -3.0, 4.0], 0.05), 5.0);
        assert_eq!(step_gravity([0.0; 3], 0.05), 9.81);
        for (gravity, spacing) in
            [(f32::MAX, 1.0e12_f32), (f32::MAX, 1.0e-18), (1.0e-40, 1.0e-18), (1.0e-40, 1.0e12)]
        {
            let product = step_gravity([gravity; 3], spacing) * spacing;
            assert!((0.9e-24..1.1e30).contains(&product), "{gravity}, {spacing}: {product}");
        }
    }
}
