//! Pass `cull`: turns the host's particles into the library's list of visible spheres (thesis Sec. 4.3).
//!
//! Drops particles with NaN, infinite or huge positions, leaves out those of low density (they are spray) and those
//! that are all foam, culls the rest against the frustum, and writes the survivors as eye-space spheres of 16 bytes
//! (32 with the shape of an ellipsoid). Spheres whose sprite is small on the screen fill the list from the front,
//! those whose sprite is large from the back, both without gaps. The passes that draw water for the camera read this
//! list, or what pass `front` keeps of it, by indirect draws and dispatches. Unlike in the thesis the test runs on the
//! GPU, and if the host gives no packets (groups of particles with a bounding box) each particle is tested.
//!
//! If the particles exceed the range of one storage-buffer binding they are processed in chunks, each with its own
//! counts and its own part of the list.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::{NoUninit, Pod, Zeroable};

use super::{Recording, shape};
use crate::contract::{Config, Count, Particles, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    Access, CLEAR, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, INDIRECT, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;

/// Bytes of one chunk's `Counts`: a multiple of every device's offset alignment.
const COUNTS_STRIDE: u64 = 256;
/// Byte offsets in `Counts` of the arguments (glsl/include/counts.glsl).
pub const POINTS: u64 = 0;
pub const QUADS: u64 = 16;
pub const SMALL_GROUPS: u64 = 32;
pub const LARGE_GROUPS: u64 = 44;
const CULL_GROUPS: u64 = 56;
const DROPPED: u64 = 72;
pub const FOAM: u64 = 80;
pub const SPRAY: u64 = 96;
pub const CAST: u64 = 112;
pub const NOISE: u64 = 128;
pub const FOAM_GROUPS: u64 = 144;

const _: () = assert!(shader::WATER_CULL_COMP.offset("Counts", "quads_vertices") == QUADS as usize);
const _: () =
    assert!(shader::WATER_CULL_COMP.offset("Counts", "small_groups") == SMALL_GROUPS as usize);
const _: () =
    assert!(shader::WATER_CULL_COMP.offset("Counts", "large_groups") == LARGE_GROUPS as usize);
const _: () =
    assert!(shader::WATER_CULL_COMP.offset("Counts", "cull_groups") == CULL_GROUPS as usize);
const _: () = assert!(shader::WATER_CULL_COMP.offset("Counts", "foam_vertices") == FOAM as usize);
const _: () = assert!(shader::WATER_CULL_COMP.offset("Counts", "spray_vertices") == SPRAY as usize);
const _: () = assert!(shader::WATER_CULL_COMP.offset("Counts", "cast_vertices") == CAST as usize);
const _: () = assert!(shader::WATER_CULL_COMP.offset("Counts", "noise_vertices") == NOISE as usize);
const _: () =
    assert!(shader::WATER_CULL_COMP.offset("Counts", "foam_groups") == FOAM_GROUPS as usize);
const _: () = assert!(shader::WATER_CULL_COMP.offset("Counts", "dropped") == DROPPED as usize);

/// Maximum number of particles per chunk: 65 535 groups of 64.
const MOST_CHUNK: u32 = 1 << 21;
/// Maximum number of workgroups in a dispatch over large sprites, which get a workgroup each; if there are more
/// sprites than that, a workgroup processes several.
const MOST_LARGE_GROUPS: u32 = 4096;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct BeginPush {
    count: u32,
    from_gpu: u32,
    chunks: u32,
    chunk_size: u32,
    packets: u32,
    group_size: u32,
}

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct CullPush {
    position_word: u32,
    position_stride: u32,
    density_word: u32,
    density_stride: u32,
    chunk_first: u32,
    capacity: u32,
    small_limit: f32,
    small_inside: u32,
    foam_word: u32,
    foam_stride: u32,
}
shader::assert_layout!(
    shader::WATER_CULL_COMP,
    "Push",
    CullPush {
        position_word,
        position_stride,
        density_word,
        density_stride,
        chunk_first,
        capacity,
        small_limit,
        small_inside,
        foam_word,
        foam_stride,
    }
);

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct EndPush {
    chunks: u32,
    group_size: u32,
    most_groups: u32,
    capacity: u32,
}
shader::assert_layout!(
    shader::WATER_CULL_END_COMP,
    "Push",
    EndPush { chunks, group_size, most_groups, capacity }
);

/// Returns the number of which each chunk's number of particles is a multiple, so that a chunk's part of each buffer
/// begins at a multiple of 256 bytes: 16 spheres are 256 bytes, and so are 64 water shares (one word per particle),
/// which exist only with foam.
pub fn chunk_unit(config: &Config) -> u32 {
    if config.surface_foam { 64 } else { 16 }
}

/// Number of particles per chunk, and number of chunks. One chunk of each particle attribute fits in a storage-buffer
/// binding, and each chunk's part of the sphere list begins at an offset that every device can bind.
pub fn chunks(limits: &vk::PhysicalDeviceLimits, config: &Config) -> (u32, u32) {
    let range = u64::from(limits.max_storage_buffer_range).saturating_sub(256);
    let own = match (config.surface_foam, config.spray) {
        (true, _) => super::surface_foam::SPRITE as u32,
        (false, true) => super::spray::SPRITE as u32,
        (false, false) => 16,
    };
    let shaped = if super::shape::is_on(config) { super::shape::SHAPED } else { 0 };
    let own = own.max(entry_bytes(config)).max(shaped);
    let fits = (range / u64::from(config.max_stride.max(own))).min(u64::from(MOST_CHUNK)) as u32;
    let unit = chunk_unit(config);
    // The number of particles is limited to what fits before it is rounded up, so the rounding cannot overflow.
    let wanted = config.max_particles.clamp(1, fits.max(1)).next_multiple_of(unit);
    let size = wanted.min(fits - fits % unit).max(unit);
    // Chunks of the same size, so that the last one is no nearly empty one.
    let most = config.max_particles.max(1);
    let even = most.div_ceil(most.div_ceil(size)).next_multiple_of(unit);
    (even, most.div_ceil(even))
}

/// Bytes of a list entry: the sphere, and the shape of an ellipsoid.
fn entry_bytes(config: &Config) -> u32 {
    if shape::is_on(config) { 32 } else { 16 }
}

/// Whether passes after `cull` read the host's particles again.
fn goes_over_particles(config: &Config) -> bool {
    config.surface_foam
        || config.spray
        || config.motion
        || config.noise.is_some()
        || config.light_map_size.is_some()
}

/// Bytes of a chunk's bits for packet membership: a multiple of 256, so that every device can bind each chunk's part.
fn member_bytes(chunk_size: u32) -> u64 {
    u64::from(chunk_size.div_ceil(8)).next_multiple_of(256)
}

/// Access by the passes that draw or dispatch the lists.
pub const LIST_USE: Access = INDIRECT.and(COMPUTE_READ).and(VERTEX_READ);

/// Access to the host's streams; pass `light` reads them in its vertex shader.
pub const STREAM_USE: Access = COMPUTE_READ.and(VERTEX_READ);

/// Spheres in eye space with the counts that draw them, chunk by chunk.
pub struct SphereList {
    /// `Counts` of every chunk.
    pub counts: Buffer,
    /// One entry per sphere: centre and radius, and after them, only if particles are ellipsoids, the ellipsoid's
    /// shape (glsl/include/ellipsoid.glsl). Each chunk of particles has a part of the buffer. Spheres whose sprite is
    /// small on the screen fill it from the front, those whose sprite is large from the back.
    pub spheres: Buffer,
    /// The fraction of each visible particle that is water; the rest is foam. `None` without foam.
    pub shares: Option<Buffer>,
    /// One bit per host particle: whether it belongs to a packet. Used by passes that read the host's particles
    /// again.
    pub members: Option<Buffer>,
    pub chunk_size: u32,
    pub chunks: u32,
    /// Bytes of an entry.
    entry: u32,
}

/// One chunk's part of a list.
#[derive(Clone, Copy)]
pub struct Chunk {
    /// `Counts` as a resource.
    pub counts: Resource,
    /// The chunk's part of the list as a resource.
    pub spheres: Resource,
    /// The chunk's shares, or a stand-in if all are 1.
    pub shares: Resource,
    /// Packet members, or a stand-in without packets.
    pub members: Resource,
    /// Byte offset of `Counts` in its buffer.
    pub arguments: u64,
    /// Capacity of the part in spheres.
    pub capacity: u32,
}

impl SphereList {
    /// A list for the configuration's particles, in chunks that can be bound.
    pub fn new(gpu: &Gpu, config: &Config, name: &str) -> Result<Self, Error> {
        let (chunk_size, chunks) = chunks(&gpu.limits, config);
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        Ok(Self {
            counts: Buffer::new(
                gpu,
                &format!("{name}/counts"),
                COUNTS_STRIDE * u64::from(chunks),
                storage
                    | vk::BufferUsageFlags::INDIRECT_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_SRC,
                MemoryLocation::GpuOnly,
            )?,
            spheres: Buffer::new(
                gpu,
                &format!("{name}/spheres"),
                u64::from(entry_bytes(config)) * u64::from(chunks) * u64::from(chunk_size),
                storage,
                MemoryLocation::GpuOnly,
            )?,
            shares: None,
            members: None,
            chunk_size,
            chunks,
            entry: entry_bytes(config),
        })
    }

    /// A list for the host's particles: as [`new`](Self::new), but with a buffer of water shares if the configuration
    /// has foam, and with one of packet members if later passes read the host's particles again.
    fn of_host(gpu: &Gpu, config: &Config, name: &str) -> Result<Self, Error> {
        let mut list = Self::new(gpu, config, name)?;
        if goes_over_particles(config) {
            list.members = Some(Buffer::new(
                gpu,
                &format!("{name}/members"),
                u64::from(list.chunks) * member_bytes(list.chunk_size),
                vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST,
                MemoryLocation::GpuOnly,
            )?);
        }
        if config.surface_foam {
            list.shares = Some(Buffer::new(
                gpu,
                &format!("{name}/shares"),
                4 * u64::from(list.chunks) * u64::from(list.chunk_size),
                vk::BufferUsageFlags::STORAGE_BUFFER,
                MemoryLocation::GpuOnly,
            )?);
        }
        Ok(list)
    }

    /// The chunks, for the passes that draw or dispatch them.
    pub fn chunks(&self) -> impl Iterator<Item = Chunk> + '_ {
        (0..self.chunks).map(|i| self.chunk(i))
    }

    /// One chunk.
    pub fn chunk(&self, index: u32) -> Chunk {
        let part = |buffer: &Buffer, each: u32| {
            let bytes = u64::from(each) * u64::from(self.chunk_size);
            Resource::Buffer(buffer.handle, bytes * u64::from(index), bytes)
        };
        let spheres = part(&self.spheres, self.entry);
        let shares = self.shares.as_ref().map_or(spheres, |shares| part(shares, 4));
        let members = self.members.as_ref().map_or(spheres, |members| {
            let bytes = member_bytes(self.chunk_size);
            Resource::Buffer(members.handle, bytes * u64::from(index), bytes)
        });
        Chunk {
            members,
            counts: Resource::Buffer(
                self.counts.handle,
                COUNTS_STRIDE * u64::from(index),
                COUNTS_STRIDE,
            ),
            spheres,
            shares,
            arguments: COUNTS_STRIDE * u64::from(index),
            capacity: self.chunk_size,
        }
    }

    /// Bytes of device memory.
    pub fn memory(&self) -> u64 {
        let more = [&self.shares, &self.members].into_iter().flatten().map(|b| b.size);
        self.counts.size + self.spheres.size + more.sum::<u64>()
    }
}

/// The pass.
pub struct Cull {
    begin: Pipeline,
    each: Pipeline,
    packets: Pipeline,
    end: Pipeline,
    /// All spheres on the screen.
    pub list: SphereList,
    max_particles: u32,
}

impl Cull {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let (foam, again) =
            (u32::from(config.surface_foam), u32::from(goes_over_particles(config)));
        let each = |packets| {
            let constants = [(0, packets), (1, foam), (2, again), shape::constant(config)];
            Pipeline::compute(gpu, shader::WATER_CULL_COMP, &constants)
        };
        Ok(Self {
            begin: Pipeline::compute(gpu, shader::WATER_CULL_BEGIN_COMP, &[])?,
            each: each(0)?,
            packets: each(1)?,
            end: Pipeline::compute(gpu, shader::WATER_CULL_END_COMP, &[])?,
            list: SphereList::of_host(gpu, config, "water/cull")?,
            max_particles: config.max_particles,
        })
    }

    /// Records the start of a list: its number of spheres becomes 0, and its number of particles `count` or, with
    /// `from_gpu`, the number in the buffer `host_count`, at most `count`.
    fn record_begin(
        &self,
        r: &Recording<'_>,
        list: &SphereList,
        host_count: Resource,
        count: u32,
        from_gpu: bool,
        packets: u32,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let resources = [(1, host_count), (2, Resource::buffer(&list.counts))];
        r.descriptors.bind(gpu, cmd, &self.begin, &resources)?;
        self.begin.push(
            gpu,
            cmd,
            &BeginPush {
                count,
                from_gpu: u32::from(from_gpu),
                chunks: list.chunks,
                chunk_size: list.chunk_size,
                packets,
                group_size: self.each.local_size[0],
            },
        );
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, list.chunks.div_ceil(32), 1, 1) };
        Ok(())
    }

    /// Records the dispatch of cull_end.comp, which computes from a list's counts of spheres the arguments of the
    /// dispatches over it. Indirect draws use the counts as they are.
    fn record_end(&self, r: &Recording<'_>, list: &SphereList) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        r.descriptors.bind(gpu, cmd, &self.end, &[(1, Resource::buffer(&list.counts))])?;
        let group_size = self.each.local_size[0];
        self.end.push(
            gpu,
            cmd,
            &EndPush {
                chunks: list.chunks,
                group_size,
                most_groups: MOST_LARGE_GROUPS,
                capacity: list.chunk_size,
            },
        );
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, list.chunks.div_ceil(32), 1, 1) };
        Ok(())
    }

    /// Clears another list; [`end_list`](Self::end_list) completes it.
    pub fn begin_list(&self, r: &Recording<'_>, list: &SphereList) -> Result<(), Error> {
        let unread = Resource::buffer(&self.list.counts);
        self.record_begin(r, list, unread, 0, false, 0)
    }

    /// Completes another list.
    pub fn end_list(&self, r: &Recording<'_>, list: &SphereList) -> Result<(), Error> {
        self.record_end(r, list)
    }

    /// Records pass `cull` over all chunks of the host's particles. `small_limit` is the maximum size of small
    /// sprites in pixels. With `inside`, a sprite whose centre is not on the screen counts as large, whatever its
    /// size.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        small_limit: f32,
        inside: bool,
    ) -> Result<(), Error> {
        let scope = r.begin(c"cull");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let list = &self.list;
        // Acquires the host's buffers, and ours from the previous frame.
        let mut host: Vec<_> = buffers_of(particles)
            .into_iter()
            .map(|handle| buffer(handle, particles.before, STREAM_USE))
            .collect();
        host.push(buffer(list.counts.handle, LIST_USE, COMPUTE_WRITE));
        host.push(buffer(list.spheres.handle, LIST_USE, COMPUTE_WRITE));
        if let Some(shares) = &list.shares {
            host.push(buffer(shares.handle, LIST_USE, COMPUTE_WRITE));
        }
        gpu.barriers(cmd, &[], &host);
        let members = list.members.as_ref().filter(|_| particles.packets.is_some());
        if let Some(members) = members {
            gpu.barriers(cmd, &[], &[buffer(members.handle, LIST_USE, CLEAR)]);
            // SAFETY: cmd is recording outside a render pass; the buffer has transfer usage.
            unsafe { gpu.device.cmd_fill_buffer(cmd, members.handle, 0, vk::WHOLE_SIZE, 0) };
            gpu.barriers(cmd, &[], &[buffer(members.handle, CLEAR, COMPUTE_READ_WRITE)]);
        }

        let most = most(particles, self.max_particles);
        let (count, from_gpu, host_count) = match particles.count {
            Count::Cpu(count) => (count.min(most), false, Resource::buffer(&list.counts)),
            Count::Gpu { buffer, offset } => (most, true, Resource::Buffer(buffer, offset, 4)),
        };
        let packets = particles.packets.map_or(0, |p| p.count);
        self.record_begin(r, list, host_count, count, from_gpu, packets)?;
        gpu.barriers(
            cmd,
            &[],
            &[buffer(list.counts.handle, COMPUTE_WRITE, COMPUTE_READ_WRITE.and(INDIRECT))],
        );

        for index in 0..list.chunks {
            self.record_chunk(r, particles, index, small_limit, inside)?;
        }
        gpu.barriers(
            cmd,
            &[],
            &[buffer(list.counts.handle, COMPUTE_READ_WRITE.and(INDIRECT), COMPUTE_READ_WRITE)],
        );

        self.record_end(r, list)?;
        let ours = [Some(&list.counts), Some(&list.spheres), list.shares.as_ref()];
        let ours: Vec<_> = ours.into_iter().flatten().collect();
        let written = ours.iter().map(|b| buffer(b.handle, COMPUTE_WRITE, LIST_USE));
        let entered = members.map(|b| buffer(b.handle, COMPUTE_READ_WRITE, LIST_USE));
        gpu.barriers(cmd, &[], &written.chain(entered).collect::<Vec<_>>());
        r.end(scope);
        Ok(())
    }

    fn record_chunk(
        &self,
        r: &Recording<'_>,
        particles: &Particles,
        index: u32,
        small_limit: f32,
        inside: bool,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let chunk = self.list.chunk(index);
        let first = index * self.list.chunk_size;
        let others = [&particles.densities, &particles.surface_foam];
        // If a stream ends before this chunk, the chunk is empty: the number of particles was limited to what
        // all streams hold.
        let Some((positions, [densities, foam])) =
            Window::all(gpu, &particles.positions, others, first)
        else {
            return Ok(());
        };
        // Without packets there is nothing to bind.
        if particles.packets.is_some_and(|packets| packets.count == 0) {
            return Ok(());
        }
        let packets = particles.packets.map_or(positions.resource, |p| {
            Resource::Buffer(p.buffer, p.offset, 32 * u64::from(p.count))
        });
        let pipeline = if particles.packets.is_some() { &self.packets } else { &self.each };
        r.descriptors.bind(
            gpu,
            cmd,
            pipeline,
            &[
                (0, r.uniforms),
                (1, positions.resource),
                (2, densities.resource),
                (3, packets),
                (4, chunk.counts),
                (5, chunk.spheres),
                (6, foam.resource),
                (7, chunk.shares),
                (8, chunk.members),
            ],
        )?;
        pipeline.push(
            gpu,
            cmd,
            &CullPush {
                position_word: positions.word,
                position_stride: positions.stride,
                density_word: densities.word,
                density_stride: densities.stride,
                chunk_first: first,
                capacity: chunk.capacity,
                small_limit,
                small_inside: u32::from(inside),
                foam_word: foam.word,
                foam_stride: foam.stride,
            },
        );
        // SAFETY: outside a render pass; the arguments were written by `begin` and made visible.
        unsafe {
            gpu.device.cmd_dispatch_indirect(
                cmd,
                self.list.counts.handle,
                chunk.arguments + CULL_GROUPS,
            );
        }
        Ok(())
    }
}

/// Number of particles for which every stream holds a value, limited to `max_particles`.
pub fn most(particles: &Particles, max_particles: u32) -> u32 {
    streams(particles).map(capacity).fold(max_particles, u32::min)
}

/// Number of particles for which a stream holds a whole value of `bytes` bytes. The last value may end the stream:
/// its stride need not be complete.
pub fn capacity((stream, bytes): (&Stream, u64)) -> u32 {
    match stream.size.saturating_sub(stream.offset).checked_sub(bytes) {
        Some(left) => u32::try_from(left / u64::from(stream.stride.max(4)) + 1).unwrap_or(u32::MAX),
        None => 0,
    }
}

/// The host's buffers, each once: interleaved streams share one.
pub fn buffers_of(particles: &Particles) -> Vec<vk::Buffer> {
    each_once(streams(particles), particles.count, particles.packets.map(|p| p.buffer))
}

/// Returns each buffer once that holds a stream (`streams` gives each stream with the size of a value in bytes), the
/// count (if it is on the GPU), or that is `other`.
pub fn each_once<'a>(
    streams: impl Iterator<Item = (&'a Stream, u64)>,
    count: Count,
    other: Option<vk::Buffer>,
) -> Vec<vk::Buffer> {
    let count = match count {
        Count::Gpu { buffer, .. } => Some(buffer),
        Count::Cpu(_) => None,
    };
    let all = streams.map(|(stream, _)| stream.buffer);
    let mut all: Vec<_> = all.chain(other).chain(count).collect();
    all.sort_by_key(|handle| vk::Handle::as_raw(*handle));
    all.dedup();
    all
}

/// The present streams, with the size of a value in bytes.
fn streams(particles: &Particles) -> impl Iterator<Item = (&Stream, u64)> {
    let all = [
        (Some(&particles.positions), 12),
        (particles.densities.as_ref(), 4),
        (particles.velocities.as_ref(), 12),
        (particles.ids.as_ref(), 4),
        (particles.surface_foam.as_ref(), 8),
    ];
    all.into_iter().filter_map(|(stream, bytes)| Some((stream?, bytes)))
}

/// A part of a host's stream (values of one attribute of the particles) to bind as a storage buffer: it begins at a
/// given particle and is as long as the stream and the device's limit for a binding allow.
#[derive(Clone, Copy)]
pub struct Window {
    pub resource: Resource,
    /// Word offset of that particle in the binding.
    pub word: u32,
    /// Stride in words; 0 for an absent stream.
    pub stride: u32,
}

impl Window {
    /// The window of a stream that begins at the particle `first`; `None` if the stream ends before it. The number of
    /// particles was limited to what the streams hold, so a chunk without a window has no particles.
    pub fn new(gpu: &Gpu, stream: &Stream, first: u32) -> Option<Self> {
        let start = stream.offset + u64::from(first) * u64::from(stream.stride);
        let aligned = start - start % gpu.limits.min_storage_buffer_offset_alignment.max(4);
        let left = stream.size.checked_sub(aligned).filter(|left| *left >= 4)?;
        let range = left.min(u64::from(gpu.limits.max_storage_buffer_range));
        // WHOLE_SIZE keeps the range legal for buffers whose size is no multiple of 4.
        let range = if range == left { vk::WHOLE_SIZE } else { range & !3 };
        Some(Self {
            resource: Resource::Buffer(stream.buffer, aligned, range),
            word: ((start - aligned) / 4) as u32,
            stride: stream.stride / 4,
        })
    }

    /// Windows, from the particle `first` on, of `stream` and of the optional streams `others`. The window of an
    /// absent stream is that of `stream` with stride 0, which is bound but not read. `None` if any present stream
    /// ends before that particle.
    pub fn all<const N: usize>(
        gpu: &Gpu,
        stream: &Stream,
        others: [&Option<Stream>; N],
        first: u32,
    ) -> Option<(Self, [Self; N])> {
        let bound = Self::new(gpu, stream, first)?;
        let mut windows = [Self { word: 0, stride: 0, ..bound }; N];
        for (window, other) in windows.iter_mut().zip(others) {
            if let Some(other) = other {
                *window = Self::new(gpu, other, first)?;
            }
        }
        Some((bound, windows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each chunk has room for a multiple of `chunk_unit` particles, and all chunks together for all particles,
    /// with less than such a multiple unused per chunk. No chunk is superfluous.
    #[test]
    fn any_number_of_particles_has_its_chunks() {
        let range = 1 << 27;
        let limits =
            vk::PhysicalDeviceLimits { max_storage_buffer_range: range, ..Default::default() };
        let extent = vk::Extent2D { width: 8, height: 8 };
        for max_particles in [1, 63, 64, 65, 1 << 20, 10_000_000, u32::MAX - 63, u32::MAX] {
            for (foam, spray) in [(false, false), (true, false), (true, true)] {
                let format = vk::Format::R16G16B16A16_SFLOAT;
                let config = Config {
                    surface_foam: foam,
                    spray,
                    ..Config::new(extent, format, max_particles)
                };
                let (size, count) = chunks(&limits, &config);
                let name = format!("{max_particles}: {count} of {size}");
                assert!(size.is_multiple_of(chunk_unit(&config)), "{name}");
                assert!(u64::from(size) * u64::from(count) >= u64::from(max_particles), "{name}");
                assert!(
                    u64::from(size) * (u64::from(count) - 1) < u64::from(max_particles),
                    "{name}"
                );
                let unused = u64::from(size) * u64::from(count) - u64::from(max_particles);
                assert!(unused < u64::from(chunk_unit(&config)) * u64::from(count), "{name}");
                assert!(size <= MOST_CHUNK && size * 16 <= range, "{name}");
            }
        }
    }
}
