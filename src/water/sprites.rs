//! Code shared by the passes that read the host's particles again after `cull`. It binds the attribute streams of the
//! particles chunk by chunk (a chunk is as many particles as fit in one storage-buffer binding). For `surface_foam`,
//! `spray` and `noise` it also builds the list of sprites that a draw or a dispatch then processes.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::Recording;
use super::cull::{self, LIST_USE, SphereList, Window};
use crate::contract::{Config, Particles, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{Access, COMPUTE_READ_WRITE, COMPUTE_WRITE, buffer};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader::Shader;

/// Maximum number of workgroups per chunk; if there are more particles an invocation processes several. This many
/// groups of 64 invocations fill the largest device. More would be wasted if there are few particles, whose number
/// the CPU may not know.
const MOST_GROUPS: u32 = 4096;

/// A dispatch over the particles, with one invocation each.
pub struct Over<'a, const N: usize> {
    pub particles: &'a Particles,
    /// Attribute streams besides the positions. An absent stream is bound with a stride of 0.
    pub streams: [&'a Option<Stream>; N],
    /// Binding of the positions; the streams follow.
    pub binding: u32,
}

impl<const N: usize> Over<'_, N> {
    /// The first binding after the streams.
    fn next_binding(&self) -> u32 {
        self.binding + 1 + N as u32
    }

    /// Records the dispatch of a pass over the particles of one chunk of `list`. `own` are the resources of the pass
    /// besides uniforms, positions and streams. `push` returns the push constants, given the index of the chunk's
    /// first particle, the positions and the streams.
    pub fn record<P: NoUninit>(
        &self,
        r: &Recording<'_>,
        pipeline: &Pipeline,
        (list, index): (&SphereList, u32),
        own: &[(u32, Resource)],
        push: impl FnOnce(u32, Window, [Window; N]) -> P,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let first = index * list.chunk_size;
        let bound = Window::all(gpu, &self.particles.positions, self.streams, first);
        // If a stream ends before this chunk, the chunk is empty: the number of particles was limited to what
        // all streams hold.
        let Some((positions, streams)) = bound else { return Ok(()) };
        let mut resources = vec![(0, r.uniforms), (self.binding, positions.resource)];
        resources.extend((self.binding + 1..).zip(streams.map(|stream| stream.resource)));
        resources.extend_from_slice(own);
        r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
        pipeline.push(gpu, cmd, &push(first, positions, streams));
        let groups = list.chunk_size.div_ceil(pipeline.local_size[0]).min(MOST_GROUPS);
        // SAFETY: outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, groups, 1, 1) };
        Ok(())
    }
}

/// Sprites of one kind: listed by a dispatch, then drawn with one instance each, or processed by one invocation
/// each.
pub struct Sprites {
    list: Pipeline,
    buffer: Buffer,
    /// Bytes of a sprite.
    size: u64,
    /// State of the sprites while they are read.
    read: Access,
}

impl Sprites {
    /// Creates a buffer for sprites and the pipeline that fills it, from `shader` specialized by `constants`. The
    /// shader's bindings are, in this order, the frame's uniforms, positions, streams, `Counts`, sprites, packet
    /// members, and those of the pass. `read` is how the sprites are read afterwards: by a draw's vertex shader, or
    /// by compute.
    pub fn new(
        gpu: &Gpu,
        config: &Config,
        name: &str,
        size: u64,
        (shader, constants): (Shader, &[(u32, u32)]),
        read: Access,
    ) -> Result<Self, Error> {
        let (chunk, chunks) = cull::chunks(&gpu.limits, config);
        let bytes = size * u64::from(chunk) * u64::from(chunks);
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        Ok(Self {
            list: Pipeline::compute(gpu, shader, constants)?,
            buffer: Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)?,
            size,
            read,
        })
    }

    /// Records the dispatches, one per chunk, that list the sprites. `list` is the list of pass `cull`, whose counts
    /// are read; it must be in the state [`LIST_USE`], and is in the same state afterwards. `own` and `push` have the
    /// meaning that they have in [`Over::record`].
    pub fn record<P: NoUninit, const N: usize>(
        &self,
        r: &Recording<'_>,
        list: &SphereList,
        over: &Over<'_, N>,
        own: &[(u32, Resource)],
        push: impl Fn(u32, Window, [Window; N]) -> P,
    ) -> Result<(), Error> {
        let (counts, sprites) = (list.counts.handle, self.buffer.handle);
        let before = [
            buffer(counts, LIST_USE, COMPUTE_READ_WRITE),
            buffer(sprites, self.read, COMPUTE_WRITE),
        ];
        r.gpu.barriers(r.cmd, &[], &before);
        let binding = over.next_binding();
        for index in 0..list.chunks {
            let (chunk, sprites) = (list.chunk(index), self.chunk(list, index));
            let mut resources =
                vec![(binding, chunk.counts), (binding + 1, sprites), (binding + 2, chunk.members)];
            resources.extend_from_slice(own);
            over.record(r, &self.list, (list, index), &resources, &push)?;
        }
        let after = [
            buffer(counts, COMPUTE_READ_WRITE, LIST_USE),
            buffer(sprites, COMPUTE_WRITE, self.read),
        ];
        r.gpu.barriers(r.cmd, &[], &after);
        Ok(())
    }

    /// Draws the sprites, which are binding 1, inside a render pass. `arguments` is the byte offset of the draw's
    /// indirect arguments in `Counts`.
    pub fn draw(
        &self,
        r: &Recording<'_>,
        list: &SphereList,
        pipeline: &Pipeline,
        arguments: u64,
        more: &[(u32, Resource)],
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        for index in 0..list.chunks {
            let mut resources = vec![(0, r.uniforms), (1, self.chunk(list, index))];
            resources.extend_from_slice(more);
            r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
            let draw = list.chunk(index).arguments + arguments;
            // SAFETY: inside a render pass; the arguments are visible (barrier of the list).
            unsafe { gpu.device.cmd_draw_indirect(cmd, list.counts.handle, draw, 1, 16) };
        }
        Ok(())
    }

    /// Processes the listed sprites by one indirect dispatch per chunk, outside a render pass; `Counts` are binding
    /// 4. There are exactly as many workgroups as the sprites need, because a CPU distributes groups to its threads
    /// in advance: with many empty groups at the end, one thread would get all the work.
    pub fn splat(
        &self,
        r: &Recording<'_>,
        list: &SphereList,
        pipeline: &Pipeline,
        arguments: u64,
        more: &[(u32, Resource)],
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        for index in 0..list.chunks {
            let counts = list.chunk(index).counts;
            let mut resources = vec![(0, r.uniforms), (1, self.chunk(list, index)), (4, counts)];
            resources.extend_from_slice(more);
            r.descriptors.bind(gpu, cmd, pipeline, &resources)?;
            let groups = list.chunk(index).arguments + arguments;
            // SAFETY: outside a render pass; the arguments are visible (barrier of the list).
            unsafe { gpu.device.cmd_dispatch_indirect(cmd, list.counts.handle, groups) };
        }
        Ok(())
    }

    /// A chunk's part of the sprites.
    fn chunk(&self, list: &SphereList, index: u32) -> Resource {
        let bytes = self.size * u64::from(list.chunk_size);
        Resource::Buffer(self.buffer.handle, bytes * u64::from(index), bytes)
    }

    /// Bytes of device memory.
    pub fn memory(&self) -> u64 {
        self.buffer.size
    }
}
