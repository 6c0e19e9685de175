//! Pass `diffuse`: the foam of diffuse particles as the sun sees it (future work of Akinci et al. 2013, Sec. 4).
//!
//! An invocation a particle, straight from the host's streams, wherever the eye looks: sums of whole steps, which no
//! order of the particles changes. Of each texel three are kept, of a thickness as the eye's and of that times its
//! place along the light, once and squared: how much there is, where its middle is and how far it spreads. What of
//! it lies before a point, and so what of the sun comes there, is told by those (glsl/include/sunlight.glsl).
//! Reads: the host's streams, front. Writes: diffuse, RGBA16F, thickness; metres along the light to its middle, and
//! of its spread.

use ash::vk;
use bytemuck::NoUninit;
use gpu_allocator::MemoryLocation;

use super::map_desc;
use super::maps::{AFTER, Maps};
use crate::contract::{Count, DiffuseParticles, Stream};
use crate::error::Error;
use crate::foam::settings::DiffuseConfig;
use crate::foam::splat::{buffers_of, chunks};
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, COPY_WRITE, INDIRECT, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::Image;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::{Recording, Window, capacity};

/// Bytes of a texel's words (glsl/include/light_diffuse.glsl).
const WORDS: u64 = 16;

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct BeginPush {
    count: u32,
    from_gpu: u32,
    chunks: u32,
    chunk_size: u32,
    group_size: u32,
}
shader::assert_layout!(
    shader::LIGHT_DIFFUSE_BEGIN_COMP,
    "Push",
    BeginPush { count, from_gpu, chunks, chunk_size, group_size }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
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
    first: i32,
    last: i32,
}
shader::assert_layout!(
    shader::LIGHT_DIFFUSE_COMP,
    "Push",
    Push {
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
        first,
        last,
    }
);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct ResolvePush {
    first: i32,
    last: i32,
    bound: i32,
}
shader::assert_layout!(
    shader::LIGHT_DIFFUSE_RESOLVE_COMP,
    "Push",
    ResolvePush { first, last, bound }
);

/// The pass.
pub struct Diffuse {
    begin: Pipeline,
    splat: Pipeline,
    resolve: Pipeline,
    arguments: Buffer,
    words: Buffer,
    /// The result.
    pub image: Image,
    chunk_size: u32,
    chunks: u32,
    max_particles: u32,
    /// Rows whose words can be bound at once.
    rows: u32,
}

impl Diffuse {
    pub fn new(gpu: &Gpu, diffuse: &DiffuseConfig, edge: u32) -> Result<Self, Error> {
        let (chunk_size, chunks) = chunks(&gpu.limits, diffuse);
        let made = |name, bytes, usage| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER | usage;
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        let (arguments, fill) =
            (vk::BufferUsageFlags::INDIRECT_BUFFER, vk::BufferUsageFlags::TRANSFER_DST);
        let words = WORDS * u64::from(edge) * u64::from(edge);
        // Cleared where a frame has no particles.
        let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = map_desc("light/diffuse", edge, vk::Format::R16G16B16A16_SFLOAT, usage);
        Ok(Self {
            begin: Pipeline::compute(gpu, shader::LIGHT_DIFFUSE_BEGIN_COMP, &[])?,
            splat: Pipeline::compute(gpu, shader::LIGHT_DIFFUSE_COMP, &[])?,
            resolve: Pipeline::compute(gpu, shader::LIGHT_DIFFUSE_RESOLVE_COMP, &[])?,
            arguments: made("light/diffuse/arguments", 16 * u64::from(chunks), arguments)?,
            words: made("light/diffuse/words", words, fill)?,
            image: Image::new(gpu, &desc)?,
            chunk_size,
            chunks,
            max_particles: diffuse.max_particles,
            rows: rows(&gpu.limits, edge),
        })
    }

    /// After `light`, whose front it takes. The particles' buffers are taken over here.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: Option<&DiffuseParticles>,
        maps: &Maps,
    ) -> Result<(), Error> {
        let scope = r.begin(c"diffuse");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let before = AFTER.and(COPY_READ).discarded();
        if let Some(particles) = particles {
            self.record_splat(r, particles, maps)?;
            let words = buffer(self.words.handle, COMPUTE_READ_WRITE, COMPUTE_READ);
            let images = [access::image(&self.image, before, COMPUTE_WRITE)];
            gpu.barriers(cmd, &images, &[words]);
            self.record_resolve(r)?;
            gpu.barriers(cmd, &[access::image(&self.image, COMPUTE_WRITE, AFTER)], &[]);
        } else {
            gpu.barriers(cmd, &[access::image(&self.image, before, COPY_WRITE)], &[]);
            gpu.clear_color(cmd, &self.image, [0.0; 4]);
            gpu.barriers(cmd, &[access::image(&self.image, COPY_WRITE, AFTER)], &[]);
        }
        r.end(scope);
        Ok(())
    }

    /// The words are those of the particles afterwards.
    fn record_splat(
        &self,
        r: &Recording<'_>,
        particles: &DiffuseParticles,
        maps: &Maps,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (words, arguments) = (self.words.handle, self.arguments.handle);
        let used = INDIRECT.and(COMPUTE_READ);
        let host = buffers_of(particles).into_iter();
        let mut taken: Vec<_> =
            host.map(|handle| buffer(handle, particles.before, COMPUTE_READ)).collect();
        taken.push(buffer(arguments, used, COMPUTE_WRITE));
        gpu.barriers(cmd, &[], &taken);
        self.record_begin(r, particles)?;
        gpu.barriers(cmd, &[], &[buffer(words, COMPUTE_READ, COPY_WRITE)]);
        // SAFETY: outside a render pass; the frame before has read it (barrier).
        unsafe { gpu.device.cmd_fill_buffer(cmd, words, 0, vk::WHOLE_SIZE, 0) };
        let filled =
            [buffer(words, COPY_WRITE, COMPUTE_READ_WRITE), buffer(arguments, COMPUTE_WRITE, used)];
        gpu.barriers(cmd, &[], &filled);

        let edge = self.image.extent.height;
        for first in (0..edge).step_by(self.rows as usize) {
            self.record_rows(r, particles, maps, [first, (first + self.rows).min(edge) - 1])?;
        }
        Ok(())
    }

    /// Adds up what comes to some rows, the first and the last.
    fn record_rows(
        &self,
        r: &Recording<'_>,
        particles: &DiffuseParticles,
        maps: &Maps,
        rows: [u32; 2],
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let words = self.words_of(rows);
        let [first_row, last_row] = rows.map(u32::cast_signed);
        let front = Resource::Sampled(maps.front.image().view, gpu.samplers.nearest);
        let others = [&particles.kinds, &particles.radii, &particles.ages, &particles.ids];
        // Atomics alone, in any order: no barrier between chunks.
        for chunk in 0..self.chunks {
            let first = chunk * self.chunk_size;
            let bound = Window::all(gpu, &particles.positions, others, first);
            // A stream that ends before the chunk has no particles in it: the count was clamped.
            let Some((positions, [kinds, radii, ages, ids])) = bound else { break };
            let resources = [
                (0, r.uniforms),
                (1, positions.resource),
                (2, kinds.resource),
                (3, radii.resource),
                (4, ages.resource),
                (5, ids.resource),
                (6, words),
                (7, Resource::buffer(&self.arguments)),
                (8, front),
            ];
            r.descriptors.bind(gpu, cmd, &self.splat, &resources)?;
            let push = Push {
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
                first: first_row,
                last: last_row,
            };
            self.splat.push(gpu, cmd, &push);
            let groups = 16 * u64::from(chunk);
            // SAFETY: outside a render pass; the arguments are visible since `begin`.
            unsafe { gpu.device.cmd_dispatch_indirect(cmd, self.arguments.handle, groups) };
        }
        Ok(())
    }

    fn record_resolve(&self, r: &Recording<'_>) -> Result<(), Error> {
        let (gpu, cmd, edge) = (r.gpu, r.cmd, self.image.extent.height);
        // A row to either side is read.
        let own = if self.rows < edge { self.rows - 2 } else { edge };
        for first in (0..edge).step_by(own as usize) {
            let last = (first + own).min(edge) - 1;
            let bound = first.saturating_sub(1);
            let resources = [
                (0, r.uniforms),
                (1, self.words_of([bound, (last + 1).min(edge - 1)])),
                (2, Resource::storage(&self.image)),
            ];
            r.descriptors.bind(gpu, cmd, &self.resolve, &resources)?;
            let [first, last, bound] = [first, last, bound].map(u32::cast_signed);
            self.resolve.push(gpu, cmd, &ResolvePush { first, last, bound });
            let extent = vk::Extent2D { height: own, ..self.image.extent };
            r.dispatch_over(extent, self.resolve.local_size);
        }
        Ok(())
    }

    /// The words of rows, the first and the last. Edges are multiples of 16: every device can bind them.
    fn words_of(&self, [first, last]: [u32; 2]) -> Resource {
        let row = WORDS * u64::from(self.image.extent.width);
        let (first, count) = (u64::from(first), u64::from(last - first + 1));
        Resource::Buffer(self.words.handle, row * first, row * count)
    }

    fn record_begin(&self, r: &Recording<'_>, particles: &DiffuseParticles) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let most = streams(particles).map(capacity).fold(self.max_particles, u32::min);
        let (count, from_gpu, host_count) = match particles.count {
            Count::Gpu { buffer, offset } => (most, true, Resource::Buffer(buffer, offset, 4)),
            // Any buffer will do: it is not read.
            Count::Cpu(count) => (count.min(most), false, Resource::buffer(&self.words)),
        };
        let resources = [(1, host_count), (2, Resource::buffer(&self.arguments))];
        r.descriptors.bind(gpu, cmd, &self.begin, &resources)?;
        let push = BeginPush {
            count,
            from_gpu: u32::from(from_gpu),
            chunks: self.chunks,
            chunk_size: self.chunk_size,
            group_size: self.splat.local_size[0],
        };
        self.begin.push(gpu, cmd, &push);
        let groups = self.chunks.div_ceil(self.begin.local_size[0]);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, groups, 1, 1) };
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        (self.image.size, self.words.size + self.arguments.size)
    }
}

/// Rows of a map of so many texels a side whose words a device can bind at once, at least three.
fn rows(limits: &vk::PhysicalDeviceLimits, edge: u32) -> u32 {
    let row = WORDS * u64::from(edge);
    let fit = u64::from(limits.max_storage_buffer_range) / row;
    (fit as u32).clamp(3, edge)
}

/// Descriptor sets that a frame takes.
pub fn sets(limits: &vk::PhysicalDeviceLimits, diffuse: &DiffuseConfig, edge: u32) -> u32 {
    let rows = rows(limits, edge);
    let own = if rows < edge { rows - 2 } else { edge };
    1 + edge.div_ceil(rows) * chunks(limits, diffuse).1 + edge.div_ceil(own)
}

/// The streams that there are, with the bytes of a value.
fn streams(particles: &DiffuseParticles) -> impl Iterator<Item = (&Stream, u64)> {
    let all = [
        (Some(&particles.positions), 12),
        (particles.kinds.as_ref(), 4),
        (particles.radii.as_ref(), 4),
        (particles.ages.as_ref(), 4),
        (particles.ids.as_ref(), 4),
    ];
    all.into_iter().filter_map(|(stream, bytes)| Some((stream?, bytes)))
}
