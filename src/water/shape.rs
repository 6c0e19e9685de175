//! Pass `shape`: replaces each particle's sphere by an ellipsoid (Yu and Turk, Reconstructing surfaces of
//! particle-based fluids using anisotropic kernels, ACM Transactions on Graphics 2013, Sec. 4): flat in thin sheets
//! of water, elongated in streams, round inside, so that thin water is one body instead of a heap of balls.
//!
//! Not in the thesis. Neighbours are found with a hashed grid, rebuilt each frame. The weighted covariance of the
//! neighbours within reach is diagonalised by a fixed number of Jacobi rotations. An ellipsoid has its sphere's
//! volume, so thickness stays in scene units; the paper scales by a kernel constant. A sphere changes gradually to an
//! ellipsoid as the sum of its neighbours' weights grows; in the paper the sphere is kept up to a number of neighbours
//! and then replaced. A further part moves each ellipsoid towards the weighted centre of its neighbours.
//!
//! Pass `shape` runs once per frame before `cull`, which reads its result instead of the host's positions. The result
//! does not depend on the view. In an optional last part, particles with few neighbours lose their surface foam and
//! get a density so low that they are spray.
//! Reads: positions, surface foam, densities. Writes: the grid, shaped, foam, densities.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::cull::{STREAM_USE, Window, buffers_of, most};
use super::settings::{Ellipsoids, Kernels};
use super::{Recording, chunks};
use crate::contract::{Config, Count, Particles, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    Access, CLEAR, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::scan::{self, Scan};
use crate::gpu::shader;

/// Maximum number of groups per dispatch; their invocations loop over the remaining particles.
const MOST_GROUPS: u32 = 4096;
/// Bytes of a particle with its shapes (glsl/include/shaped.glsl).
pub const SHAPED: u32 = 40;
/// Byte offset of the spray's shape in such a particle.
const SPRAY_SHAPE: u64 = 24;
/// Bytes of a particle's surface foam: amount and age.
const FOAM: u32 = 8;
/// State of the result until the next frame.
const AFTER: Access = COMPUTE_READ.and(COPY_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct ChunkPush {
    position_word: u32,
    position_stride: u32,
    chunk_first: u32,
    chunk: u32,
    count: u32,
    from_gpu: u32,
    buckets: u32,
    cells: f32,
}
shader::assert_layout!(
    shader::WATER_SHAPE_COUNT_COMP,
    "Push",
    ChunkPush {
        position_word,
        position_stride,
        chunk_first,
        chunk,
        count,
        from_gpu,
        buckets,
        cells,
    }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    cells: f32,
    buckets: u32,
    ratio: f32,
    fewest: f32,
    lone: f32,
    strand: f32,
}
shader::assert_layout!(
    shader::WATER_SHAPE_COMP,
    "Push",
    Push { cells, buckets, ratio, fewest, lone, strand }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct CentrePush {
    cells: f32,
    buckets: u32,
    centred: f32,
}
shader::assert_layout!(
    shader::WATER_SHAPE_CENTRE_COMP,
    "Push",
    CentrePush { cells, buckets, centred }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct CrowdPush {
    amount_word: u32,
    amount_stride: u32,
    density_word: u32,
    density_stride: u32,
    chunk_first: u32,
    chunk: u32,
    count: u32,
    from_gpu: u32,
    foam_few: f32,
    foam_many: f32,
    spray_few: f32,
    spray_many: f32,
    alone: f32,
}
shader::assert_layout!(
    shader::WATER_SHAPE_CROWD_COMP,
    "Push",
    CrowdPush {
        amount_word,
        amount_stride,
        density_word,
        density_stride,
        chunk_first,
        chunk,
        count,
        from_gpu,
        foam_few,
        foam_many,
        spray_few,
        spray_many,
        alone,
    }
);

/// What the pass needs of a frame's settings.
pub struct ShapeSettings<'a> {
    pub ellipsoids: &'a Ellipsoids,
    /// [`SpraySettings::strand_ratio`](super::SpraySettings::strand_ratio).
    pub strand: f32,
    pub crowd: Crowd,
    pub spacing: f32,
}

/// How particles with few neighbours lose their surface foam and become spray.
#[derive(Clone, Copy)]
pub struct Crowd {
    /// [`SurfaceFoamSettings::few_neighbours`](super::SurfaceFoamSettings::few_neighbours).
    pub foam: [f32; 2],
    /// [`SpraySettings::few_neighbours`](super::SpraySettings::few_neighbours).
    pub spray: [f32; 2],
    /// Density to which that of a particle without neighbours is limited.
    pub alone: f32,
}

/// Specialization constant that selects whether a shader reads lists of spheres (0) or of ellipsoids (1); see
/// glsl/include/ellipsoid.glsl.
pub fn constant(config: &Config) -> (u32, u32) {
    (15, u32::from(is_on(config)))
}

/// Whether particles are ellipsoids.
pub fn is_on(config: &Config) -> bool {
    config.kernels == Kernels::Ellipsoids
}

/// Bytes of the largest buffer that is bound as a whole: particles with their shapes, or ends of the grid
/// buckets.
pub fn bytes_bound(config: &Config) -> u64 {
    let particles = u64::from(config.max_particles);
    if is_on(config) {
        (u64::from(SHAPED) * particles).max(4 * u64::from(buckets(config)))
    } else {
        0
    }
}

/// Number of descriptor sets of the pass: two, plus those of the prefix sum, plus two per chunk (three with foam or
/// spray).
pub fn sets(config: &Config, chunks: u32) -> u32 {
    let each = 2 + u32::from(config.surface_foam || config.spray);
    if is_on(config) { 2 + scan::SETS + each * chunks } else { 0 }
}

/// Number of buckets: a power of two that fits in every device's binding.
fn buckets(config: &Config) -> u32 {
    config.max_particles.clamp(1, 1 << 25).next_power_of_two()
}

/// The pass.
pub struct Shape {
    count: Pipeline,
    fill: Pipeline,
    shape: Pipeline,
    centre: Pipeline,
    scan: Scan,
    /// For each bucket first the number of its particles, later the bucket's begin, finally its end.
    buckets: Buffer,
    /// Particles sorted by bucket, and their number.
    places: Buffer,
    counts: Buffer,
    /// Vector from each particle to the weighted mean of itself and its neighbours, and how far the particle is an
    /// ellipsoid; particles are in the order of the buffer `places`.
    shifts: Buffer,
    /// Position and shape of each particle, in the host's order.
    pub shaped: Buffer,
    crowd: Pipeline,
    /// Outputs of the optional last part. `foam`: the surface foam after particles with few neighbours have lost
    /// theirs, if the renderer draws foam. `densities`: the densities after those of such particles are lowered, if
    /// it draws spray.
    foam: Option<Buffer>,
    densities: Option<Buffer>,
    many: u32,
    chunk_size: u32,
    max_particles: u32,
}

impl Shape {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        type Usage = vk::BufferUsageFlags;
        let make = |name, each: u64, count: u32, usage| {
            let usage = Usage::STORAGE_BUFFER | usage;
            Buffer::new(gpu, name, each * u64::from(count), usage, MemoryLocation::GpuOnly)
        };
        let (many, particles) = (buckets(config), config.max_particles);
        let foam = || make("water/shape/foam", u64::from(FOAM), particles, Usage::empty());
        let densities = || make("water/shape/densities", 4, particles, Usage::empty());
        Ok(Self {
            count: Pipeline::compute(gpu, shader::WATER_SHAPE_COUNT_COMP, &[])?,
            fill: Pipeline::compute(gpu, shader::WATER_SHAPE_FILL_COMP, &[])?,
            shape: Pipeline::compute(gpu, shader::WATER_SHAPE_COMP, &[])?,
            centre: Pipeline::compute(gpu, shader::WATER_SHAPE_CENTRE_COMP, &[])?,
            scan: Scan::new(gpu, "water/shape/scan", many)?,
            buckets: make("water/shape/buckets", 4, many, Usage::TRANSFER_DST)?,
            places: make("water/shape/places", 16, particles, Usage::empty())?,
            shifts: make("water/shape/shifts", 16, particles, Usage::empty())?,
            counts: make("water/shape/counts", 4, 1, Usage::empty())?,
            shaped: make("water/shape/shaped", u64::from(SHAPED), particles, Usage::TRANSFER_SRC)?,
            crowd: Pipeline::compute(gpu, shader::WATER_SHAPE_CROWD_COMP, &[])?,
            foam: config.surface_foam.then(foam).transpose()?,
            densities: config.spray.then(densities).transpose()?,
            many,
            chunk_size: chunks(&gpu.limits, config).0,
            max_particles: config.max_particles,
        })
    }

    /// Records the pass, and returns the particles for the passes after it. In place of the host's positions they
    /// have `shaped`, which holds positions and shapes. If the settings change the surface foam or the densities of
    /// particles with few neighbours, such a stream is replaced by a changed copy, too. The other streams are the
    /// host's; no buffer of the host is written. Afterwards compute shaders can read all returned streams, vertex
    /// shaders all but `shaped`.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        look: &ShapeSettings<'_>,
    ) -> Result<Particles, Error> {
        let scope = r.begin(c"shape");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let both = COMPUTE_READ_WRITE;
        let (buckets, places) = (&self.buckets, &self.places);
        let host = buffers_of(particles).into_iter();
        let mut before: Vec<_> =
            host.map(|handle| buffer(handle, particles.before, STREAM_USE)).collect();
        before.extend([
            buffer(buckets.handle, COMPUTE_READ, CLEAR),
            buffer(places.handle, COMPUTE_READ, COMPUTE_WRITE),
            buffer(self.counts.handle, both, both),
            buffer(self.shifts.handle, COMPUTE_READ, COMPUTE_WRITE),
            buffer(self.shaped.handle, AFTER, COMPUTE_WRITE),
        ]);
        let crowd_buffers = self.foam.iter().chain(&self.densities);
        before.extend(crowd_buffers.map(|own| buffer(own.handle, STREAM_USE, COMPUTE_WRITE)));
        gpu.barriers(cmd, &[], &before);
        // SAFETY: cmd is recording outside a render pass; the frame before has read the buffer (barrier above).
        unsafe { gpu.device.cmd_fill_buffer(cmd, buckets.handle, 0, vk::WHOLE_SIZE, 0) };
        gpu.barriers(cmd, &[], &[buffer(buckets.handle, CLEAR, both)]);

        let ShapeSettings { ellipsoids: settings, strand, crowd, spacing } = *look;
        let most = most(particles, self.max_particles);
        let cells = 1.0 / (settings.reach * spacing);
        self.record_chunks(r, &self.count, particles, &self.shaped, (most, cells))?;
        let wait = |own: &Buffer, from, to| gpu.barriers(cmd, &[], &[buffer(own.handle, from, to)]);
        wait(buckets, both, both);
        let values = (buckets, self.many);
        self.scan.record((gpu, cmd, r.descriptors), &self.counts, values, None, 0)?;
        wait(buckets, both, both);
        self.record_chunks(r, &self.fill, particles, places, (most, cells))?;
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(buckets.handle, both, COMPUTE_READ),
                buffer(places.handle, COMPUTE_WRITE, COMPUTE_READ),
                buffer(self.counts.handle, both, COMPUTE_READ),
                // `count` has written the particles without a cell.
                buffer(self.shaped.handle, COMPUTE_WRITE, COMPUTE_WRITE),
            ],
        );
        let bound = [
            (1, Resource::buffer(buckets)),
            (2, Resource::buffer(places)),
            (3, Resource::buffer(&self.counts)),
            (4, Resource::buffer(&self.shaped)),
            (5, Resource::buffer(&self.shifts)),
        ];
        r.descriptors.bind(gpu, cmd, &self.shape, &bound)?;
        let Ellipsoids { reach: _, ratio, fewest, lone, centred } = *settings;
        self.shape.push(gpu, cmd, &Push { cells, buckets: self.many, ratio, fewest, lone, strand });
        self.dispatch(r, &self.shape, most);
        if centred > 0.0 {
            gpu.barriers(
                cmd,
                &[],
                &[
                    buffer(self.shifts.handle, COMPUTE_WRITE, COMPUTE_READ),
                    buffer(self.shaped.handle, COMPUTE_WRITE, COMPUTE_WRITE),
                ],
            );
            r.descriptors.bind(gpu, cmd, &self.centre, &bound)?;
            self.centre.push(gpu, cmd, &CentrePush { cells, buckets: self.many, centred });
            self.dispatch(r, &self.centre, most);
        }
        gpu.barriers(cmd, &[], &[buffer(self.shaped.handle, COMPUTE_WRITE, AFTER)]);
        let found = self.record_crowd(r, particles, most, crowd)?;
        r.end(scope);
        let size = u64::from(SHAPED) * u64::from(most);
        let positions = Stream { buffer: self.shaped.handle, size, offset: 0, stride: SHAPED };
        Ok(Particles { positions, before: COMPUTE_READ, ..found })
    }

    /// Records the optional last part. Returns the particles with surface foam and densities changed where a particle
    /// has few neighbours. A stream for which the settings do not ask for that stays the host's.
    fn record_crowd(
        &self,
        r: &Recording<'_>,
        particles: &Particles,
        most: u32,
        crowd: Crowd,
    ) -> Result<Particles, Error> {
        let amounts = particles.surface_foam.as_ref().filter(|_| crowd.foam[1] > 0.0);
        let densities = particles.densities.as_ref().filter(|_| crowd.spray[1] > 0.0);
        let foam = self.foam.as_ref().zip(amounts);
        let torn = self.densities.as_ref().zip(densities);
        let written: Vec<&Buffer> = foam.iter().chain(&torn).map(|(own, _)| *own).collect();
        let Some(any) = written.first() else { return Ok(*particles) };
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (count, from_gpu, host_count) = self.count_of(particles, most);
        let streams = [&foam.map(|(_, stream)| *stream), &torn.map(|(_, stream)| *stream)];
        let mut first = 0;
        while first < count {
            // An absent stream is bound as the positions, and not read.
            let Some((_, [amounts, densities])) =
                Window::all(gpu, &particles.positions, streams, first)
            else {
                break;
            };
            let chunk = self.chunk_size.min(count - first);
            let bound = [
                (1, host_count),
                (2, amounts.resource),
                (3, densities.resource),
                (4, Resource::buffer(&self.shaped)),
                (5, Resource::buffer(foam.map_or(any, |(own, _)| own))),
                (6, Resource::buffer(torn.map_or(any, |(own, _)| own))),
            ];
            r.descriptors.bind(gpu, cmd, &self.crowd, &bound)?;
            let push = CrowdPush {
                amount_word: amounts.word,
                amount_stride: amounts.stride,
                density_word: densities.word,
                density_stride: densities.stride,
                chunk_first: first,
                chunk,
                count,
                from_gpu,
                foam_few: crowd.foam[0],
                foam_many: crowd.foam[1],
                spray_few: crowd.spray[0],
                spray_many: crowd.spray[1],
                alone: crowd.alone,
            };
            self.crowd.push(gpu, cmd, &push);
            self.dispatch(r, &self.crowd, chunk);
            first += chunk;
        }
        let read: Vec<_> =
            written.iter().map(|own| buffer(own.handle, COMPUTE_WRITE, STREAM_USE)).collect();
        gpu.barriers(cmd, &[], &read);
        let stream = |own: &Buffer, stride: u32| {
            let size = u64::from(stride) * u64::from(most);
            Stream { buffer: own.handle, size, offset: 0, stride }
        };
        let surface_foam = foam.map(|(own, _)| stream(own, FOAM)).or(particles.surface_foam);
        let densities = torn.map(|(own, _)| stream(own, 4)).or(particles.densities);
        Ok(Particles { surface_foam, densities, ..*particles })
    }

    /// Values for the shaders: the number of particles, or its maximum if only the GPU knows the number; 1 if only
    /// the GPU knows it, otherwise 0; the buffer with the number on the GPU, otherwise any buffer, which is not read.
    fn count_of(&self, particles: &Particles, most: u32) -> (u32, u32, Resource) {
        match particles.count {
            Count::Cpu(count) => (count.min(most), 0, Resource::buffer(&self.counts)),
            Count::Gpu { buffer, offset } => (most, 1, Resource::Buffer(buffer, offset, 4)),
        }
    }

    /// Stream of the spray's shapes in `shaped`, the particles that [`record`](Self::record) returned.
    pub fn of_spray(shaped: &Particles) -> Stream {
        Stream { offset: shaped.positions.offset + SPRAY_SHAPE, ..shaped.positions }
    }

    /// Dispatches over the host's positions.
    fn record_chunks(
        &self,
        r: &Recording<'_>,
        pipeline: &Pipeline,
        particles: &Particles,
        written: &Buffer,
        (most, cells): (u32, f32),
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (count, from_gpu, host_count) = self.count_of(particles, most);
        let mut first = 0;
        while first < count {
            let Some(positions) = Window::new(gpu, &particles.positions, first) else { break };
            let chunk = self.chunk_size.min(count - first);
            r.descriptors.bind(
                gpu,
                cmd,
                pipeline,
                &[
                    (1, host_count),
                    (2, positions.resource),
                    (3, Resource::buffer(&self.buckets)),
                    (4, Resource::buffer(written)),
                ],
            )?;
            pipeline.push(
                gpu,
                cmd,
                &ChunkPush {
                    position_word: positions.word,
                    position_stride: positions.stride,
                    chunk_first: first,
                    chunk,
                    count,
                    from_gpu,
                    buckets: self.many,
                    cells,
                },
            );
            self.dispatch(r, pipeline, chunk);
            first += chunk;
        }
        Ok(())
    }

    fn dispatch(&self, r: &Recording<'_>, pipeline: &Pipeline, invocations: u32) {
        let groups = invocations.div_ceil(pipeline.local_size[0]).clamp(1, MOST_GROUPS);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { r.gpu.device.cmd_dispatch(r.cmd, groups, 1, 1) };
    }

    pub fn memory(&self) -> u64 {
        let own = [&self.buckets, &self.places, &self.counts, &self.shifts, &self.shaped];
        let crowd = self.foam.iter().chain(&self.densities);
        own.into_iter().chain(crowd).map(|buffer| buffer.size).sum::<u64>() + self.scan.memory()
    }
}
