//! Binds the host's streams of whitewater particles (buffers with one attribute of each particle) for all passes over
//! the particles. Streams are bound in chunks as large as the device can bind. The number of particles comes from the
//! host or from a buffer on the GPU.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use crate::contract::{Count, Packets, Stream, WhitewaterParticles};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{COMPUTE_READ, COMPUTE_READ_WRITE, COPY_WRITE, INDIRECT, buffer};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader::{self, Shader};
use crate::water::{Recording, Window, capacity, each_once};
use crate::whitewater::settings::WhitewaterConfig;

/// Maximum number of groups per dispatch.
const MOST_GROUPS: u32 = 65_535;

/// Offsets and strides of a chunk's streams, in words of 32 bits; an absent stream has a stride of 0
/// (glsl/include/whitewater_streams.glsl).
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
pub struct Places {
    position_word: u32,
    position_stride: u32,
    kind_word: u32,
    kind_stride: u32,
    radius_word: u32,
    radius_stride: u32,
    age_word: u32,
    age_stride: u32,
    id_word: u32,
    id_stride: u32,
    chunk_first: u32,
    chunk: u32,
}
shader::assert_layout!(
    [
        shader::WHITEWATER_SPLAT_COMP,
        shader::WHITEWATER_SPLAT64_COMP,
        shader::WHITEWATER_SPLAT_VERT,
        shader::LIGHT_WHITEWATER_COMP,
        shader::BUBBLES_NEAR_COMP,
    ],
    "Push",
    Places {
        position_word,
        position_stride,
        kind_word,
        kind_stride,
        radius_word,
        radius_stride,
        age_word,
        age_stride,
        id_word,
        id_stride,
        chunk_first,
        chunk,
    }
);

/// Number of particles in each chunk (glsl/include/whitewater_chunks.glsl).
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
pub struct Counting {
    count: u32,
    from_gpu: u32,
    chunks: u32,
    chunk_size: u32,
    group_size: u32,
}
shader::assert_layout!(
    shader::LIGHT_WHITEWATER_BEGIN_COMP,
    "Push",
    Counting { count, from_gpu, chunks, chunk_size, group_size }
);

/// The division of the maximum number of particles into chunks.
#[derive(Clone, Copy)]
pub struct Chunks {
    /// Number of chunks.
    pub count: u32,
    size: u32,
    max_particles: u32,
}

impl Chunks {
    pub fn new(limits: &vk::PhysicalDeviceLimits, config: &WhitewaterConfig) -> Self {
        let max_particles = config.max_particles;
        let range = limits.max_storage_buffer_range.saturating_sub(256);
        let size = (range / config.max_stride).min(64 * MOST_GROUPS).min(max_particles).max(1);
        Self { count: max_particles.div_ceil(size), size, max_particles }
    }

    /// Bytes of the indirect arguments, 16 per chunk.
    pub fn arguments(&self) -> vk::DeviceSize {
        16 * u64::from(self.count)
    }

    /// Returns the push constants from which a shader computes the number of particles in each chunk, and the buffer
    /// from which it reads the total number if that is only known on the GPU. If the host gives the number, the
    /// shader reads no buffer, and `unread`, any buffer that can be bound in its place, is returned. `group_size` is
    /// the number of particles per workgroup, 0 if quads are drawn instead of dispatched.
    pub fn counting(
        &self,
        particles: Option<&WhitewaterParticles>,
        group_size: u32,
        unread: Resource,
    ) -> (Counting, Resource) {
        let most =
            particles.map_or(0, |p| streams(p).map(capacity).fold(self.max_particles, u32::min));
        let (count, from_gpu, buffer) = match particles.map(|p| p.count) {
            Some(Count::Gpu { buffer, offset }) => (most, 1, Resource::Buffer(buffer, offset, 4)),
            Some(Count::Cpu(count)) => (count.min(most), 0, unread),
            None => (0, 0, unread),
        };
        let (chunks, chunk_size) = (self.count, self.size);
        (Counting { count, from_gpu, chunks, chunk_size, group_size }, buffer)
    }

    /// For each chunk of particles, binds the chunk's streams and the caller's resources `own`, pushes the constants
    /// that `push` makes of the streams' offsets and strides, and calls `act` with the chunk's index.
    pub fn each<P: NoUninit>(
        &self,
        r: &Recording<'_>,
        pipeline: &Pipeline,
        own: &[(u32, Resource)],
        particles: &WhitewaterParticles,
        push: impl Fn(Places) -> P,
        act: impl Fn(u64),
    ) -> Result<(), Error> {
        let others = [&particles.kinds, &particles.radii, &particles.ages, &particles.ids];
        for chunk in 0..self.count {
            let first = chunk * self.size;
            let bound = Window::all(r.gpu, &particles.positions, others, first);
            // If a stream ends before the chunk, the chunk has no particles: the count was clamped to the shortest
            // stream.
            let Some((positions, [kinds, radii, ages, ids])) = bound else { break };
            let streams = [
                (0, r.uniforms),
                (1, positions.resource),
                (2, kinds.resource),
                (3, radii.resource),
                (4, ages.resource),
                (5, ids.resource),
                // Not read without a cross-fade.
                (11, r.crossfade.unwrap_or(positions.resource)),
            ];
            r.descriptors.bind(r.gpu, r.cmd, pipeline, &[&streams[..], own].concat())?;
            let places = Places {
                position_word: positions.word,
                position_stride: positions.stride,
                kind_word: kinds.word,
                kind_stride: kinds.stride,
                radius_word: radii.word,
                radius_stride: radii.stride,
                age_word: ages.word,
                age_stride: ages.stride,
                id_word: ids.word,
                id_stride: ids.stride,
                chunk_first: first,
                chunk,
            };
            pipeline.push(r.gpu, r.cmd, &push(places));
            act(u64::from(chunk));
        }
        Ok(())
    }
}

/// Capacity of a chunk's list of large particles (glsl/include/whitewater_cover.glsl). A large particle that does not
/// fit is processed by a single invocation, like a small one.
const ROOM: u64 = 16_384;
/// Bytes of a chunk's list of large particles: dispatch arguments and the number of these particles in 4 words, then
/// their indices.
const LIST: u64 = 4 * (4 + ROOM);

/// A shader over the pixels of each particle (glsl/include/whitewater_cover.glsl), in two dispatches per chunk. The
/// first has one invocation per particle or, if the host hands in `Packets` of particles, one workgroup per packet;
/// it lists particles with more than 256 pixels. The second has one workgroup for each particle in this list.
pub struct Covering {
    /// Pipelines of the shader: first those for default particle shapes, then those for other shapes or the paper's
    /// falloff behind the water's surface.
    ways: [Ways; 2],
    list: Buffer,
}

/// Pipelines of a shader.
struct Ways {
    each: Pipeline,
    packets: Option<Pipeline>,
    large: Pipeline,
}

impl Covering {
    /// `name` is the debug name of the buffer with the lists of large particles. `constants` are further
    /// specialization constants of the shader, with ids other than 1 to 3.
    pub fn new(
        gpu: &Gpu,
        name: &str,
        shader: Shader,
        constants: &[(u32, u32)],
        config: &WhitewaterConfig,
    ) -> Result<Self, Error> {
        let make = |packets, large, shaped| {
            let own = [(1, u32::from(packets)), (2, u32::from(large)), (3, shaped)];
            Pipeline::compute(gpu, shader, &[constants, &own].concat())
        };
        let ways = |shaped| -> Result<Ways, Error> {
            Ok(Ways {
                each: make(false, false, shaped)?,
                packets: config.packets.then(|| make(true, false, shaped)).transpose()?,
                large: make(false, true, shaped)?,
            })
        };
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::INDIRECT_BUFFER
            | vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = LIST * u64::from(Chunks::new(&gpu.limits, config).count);
        Ok(Self {
            ways: [ways(0)?, ways(1)?],
            list: Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)?,
        })
    }

    /// Group size.
    pub fn group_size(&self) -> u32 {
        self.ways[0].each.local_size[0]
    }

    /// Bytes of its list.
    pub fn memory(&self) -> u64 {
        self.list.size
    }

    /// Records the shader's dispatches over all chunks of particles. The buffer `arguments` holds their indirect
    /// arguments; a barrier has already made it visible. Atomics accumulate the results in any order, so chunks need
    /// no barriers between them.
    pub fn record<P: NoUninit>(
        &self,
        r: &Recording<'_>,
        chunks: &Chunks,
        own: &[(u32, Resource)],
        particles: &WhitewaterParticles,
        arguments: vk::Buffer,
        push: impl Fn(Places) -> P,
    ) -> Result<(), Error> {
        if particles.packets.is_some_and(|packets| packets.count == 0) {
            return Ok(());
        }
        let (gpu, device, list) = (r.gpu, &r.gpu.device, self.list.handle);
        let used = INDIRECT.and(COMPUTE_READ);
        gpu.barriers(r.cmd, &[], &[buffer(list, used, COPY_WRITE)]);
        for chunk in 0..chunks.count {
            let empty = bytemuck::bytes_of(&[0_u32, 1, 1, 0]);
            // SAFETY: outside a render pass; the previous reader has finished (barrier).
            unsafe { device.cmd_update_buffer(r.cmd, list, LIST * u64::from(chunk), empty) };
        }
        gpu.barriers(r.cmd, &[], &[buffer(list, COPY_WRITE, COMPUTE_READ_WRITE)]);

        let bound = |packets| [own, &[(9, packets), (10, Resource::buffer(&self.list))]].concat();
        // Bound but not read.
        let unread = Resource::Buffer(arguments, 0, 16);
        // The check of the frame has ensured that packets come only with a configuration for packets.
        let ways = &self.ways[usize::from(r.shaped)];
        match (particles.packets, &ways.packets) {
            (Some(Packets { buffer, offset, count }), Some(pipeline)) => {
                let packets = Resource::Buffer(buffer, offset, 32 * u64::from(count));
                chunks.each(r, pipeline, &bound(packets), particles, &push, |_| {
                    // SAFETY: outside a render pass, pipeline and set are bound.
                    unsafe { device.cmd_dispatch(r.cmd, count, 1, 1) };
                })?;
            }
            _ => chunks.each(r, &ways.each, &bound(unread), particles, &push, |chunk| {
                // SAFETY: outside a render pass, pipeline and set are bound; the arguments are visible.
                unsafe { device.cmd_dispatch_indirect(r.cmd, arguments, 16 * chunk) };
            })?,
        }
        gpu.barriers(r.cmd, &[], &[buffer(list, COMPUTE_READ_WRITE, used)]);
        chunks.each(r, &ways.large, &bound(unread), particles, &push, |chunk| {
            // SAFETY: outside a render pass, pipeline and set are bound; the list is visible.
            unsafe { device.cmd_dispatch_indirect(r.cmd, list, LIST * chunk) };
        })
    }
}

/// The present streams, with the size of a value in bytes.
fn streams(particles: &WhitewaterParticles) -> impl Iterator<Item = (&Stream, u64)> {
    let all = [
        (Some(&particles.positions), 12),
        (particles.kinds.as_ref(), 4),
        (particles.radii.as_ref(), 4),
        (particles.ages.as_ref(), 4),
        (particles.ids.as_ref(), 4),
    ];
    all.into_iter().filter_map(|(stream, bytes)| Some((stream?, bytes)))
}

/// The host's buffers, each once: interleaved streams share one.
pub fn buffers_of(particles: &WhitewaterParticles) -> Vec<vk::Buffer> {
    each_once(streams(particles), particles.count, particles.packets.map(|p| p.buffer))
}
