//! Pass `near`: whitewater foam cross-fades from sprites to blobs of soap bubbles near the camera. Akinci et al.
//! 2013 show no foam so near.
//!
//! A histogram of the distances of foam particles from the camera gives the distance up to which the buffer of blobs
//! has room for all of them. Each foam particle nearer than that becomes a blob. Its place in the buffer is
//! arbitrary, which is not visible.
//! Reads: the host's whitewater particles. Writes: distances of the cross-fade; spheres, orientations, ids and count
//! of the blobs.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::settings::BubbleConfig;
use crate::contract::{Blobs, Count, Stream, WhitewaterParticles};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    Access, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_WRITE, INDIRECT, VERTEX_READ,
    buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::Recording;
use crate::whitewater::WhitewaterConfig;
use crate::whitewater::streams::{Chunks, Places, buffers_of};

/// Bins of the distance histogram (glsl/include/crossfade_rings.glsl).
const RINGS: u64 = 1024;
/// Bytes of the cross-fade distances.
const OVER: u64 = 16;

/// Access to these distances by the sprite passes.
const OVER_READ: Access = COMPUTE_READ.and(VERTEX_READ);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    places: Places,
    room: u32,
}
const _: () =
    assert!(std::mem::offset_of!(Push, room) == shader::BUBBLES_NEAR_COMP.offset("Push", "room"));

/// The pass.
pub struct Near {
    begin: Pipeline,
    /// Pipelines `[dispatch][shape]`. Dispatch: 0 histogram, 1 entries. Shape of the particles: 0 default, 1 other.
    goes: [[Pipeline; 2]; 2],
    range: Pipeline,
    chunks: Chunks,
    arguments: Buffer,
    numbers: Buffer,
    over: Buffer,
    count: Buffer,
    balls: Buffer,
    turns: Buffer,
    ids: Buffer,
    room: u32,
}

impl Near {
    pub fn new(
        gpu: &Gpu,
        whitewater: &WhitewaterConfig,
        bubbles: &BubbleConfig,
    ) -> Result<Self, Error> {
        let chunks = Chunks::new(&gpu.limits, whitewater);
        let own = |name, bytes, usage| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER | usage;
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        let most = u64::from(bubbles.max_blobs);
        let (cleared, plain) = (vk::BufferUsageFlags::TRANSFER_DST, vk::BufferUsageFlags::empty());
        let indirect = vk::BufferUsageFlags::INDIRECT_BUFFER;
        let go = |which| -> Result<_, Error> {
            let make = |shaped| {
                Pipeline::compute(gpu, shader::BUBBLES_NEAR_COMP, &[(0, which), (3, shaped)])
            };
            Ok([make(0)?, make(1)?])
        };
        Ok(Self {
            begin: Pipeline::compute(gpu, shader::LIGHT_WHITEWATER_BEGIN_COMP, &[])?,
            goes: [go(0)?, go(1)?],
            range: Pipeline::compute(gpu, shader::BUBBLES_NEAR_RANGE_COMP, &[])?,
            chunks,
            arguments: own("bubbles/near/arguments", chunks.arguments(), indirect)?,
            numbers: own("bubbles/near/numbers", 4 * RINGS, cleared)?,
            over: own("bubbles/near/over", OVER, plain)?,
            count: own("bubbles/near/count", 4, cleared)?,
            balls: own("bubbles/near/balls", 16 * most, plain)?,
            turns: own("bubbles/near/turns", 16 * most, plain)?,
            ids: own("bubbles/near/ids", 4 * most, plain)?,
            room: bubbles.max_blobs,
        })
    }

    /// The distances of the cross-fade.
    pub fn over(&self) -> Resource {
        Resource::buffer(&self.over)
    }

    /// The blobs of the frame.
    pub fn blobs(&self) -> Blobs {
        let stream = |own: &Buffer, stride| Stream {
            buffer: own.handle,
            size: u64::from(stride) * u64::from(self.room),
            offset: 0,
            stride,
        };
        Blobs {
            spheres: stream(&self.balls, 16),
            rotations: Some(stream(&self.turns, 16)),
            ids: Some(stream(&self.ids, 4)),
            count: Count::Gpu { buffer: self.count.handle, offset: 0 },
            before: COMPUTE_READ,
            after: COMPUTE_READ,
        }
    }

    /// Records pass `near`. It runs before any other pass acquires the buffers of the whitewater particles, and
    /// leaves them in the compute-read state.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: Option<&WhitewaterParticles>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"near");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let made = [&self.balls, &self.turns, &self.ids].map(|own| own.handle);
        let used = INDIRECT.and(COMPUTE_READ);
        let mut before = vec![
            buffer(self.numbers.handle, COMPUTE_READ, COPY_WRITE),
            buffer(self.count.handle, COMPUTE_READ, COPY_WRITE),
            buffer(self.arguments.handle, used, COMPUTE_WRITE),
        ];
        before.extend(made.map(|own| buffer(own, COMPUTE_READ, COMPUTE_WRITE)));
        if let Some(particles) = particles {
            let taken = buffers_of(particles).into_iter();
            before.extend(taken.map(|host| buffer(host, particles.before, COMPUTE_READ)));
        }
        gpu.barriers(cmd, &[], &before);
        for own in [&self.numbers, &self.count] {
            // SAFETY: outside a render pass; the previous frame has finished with it (barrier).
            unsafe { gpu.device.cmd_fill_buffer(cmd, own.handle, 0, vk::WHOLE_SIZE, 0) };
        }
        let (counting, host_count) =
            self.chunks.counting(particles, self.goes[0][0].local_size[0], self.over());
        let own = [(1, host_count), (2, Resource::buffer(&self.arguments))];
        r.descriptors.bind(gpu, cmd, &self.begin, &own)?;
        self.begin.push(gpu, cmd, &counting);
        let groups = self.chunks.count.div_ceil(self.begin.local_size[0]);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, groups, 1, 1) };
        let both = COMPUTE_READ_WRITE;
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.numbers.handle, COPY_WRITE, both),
                buffer(self.count.handle, COPY_WRITE, both),
                buffer(self.arguments.handle, COMPUTE_WRITE, used),
            ],
        );
        self.record_go(r, 0, particles)?;
        // The first dispatch also binds everything that the second writes and reads; `over` was last read by the
        // sprites of the previous frame.
        let mut between = made.map(|own| buffer(own, COMPUTE_WRITE, COMPUTE_WRITE)).to_vec();
        between.push(buffer(self.over.handle, OVER_READ, COMPUTE_WRITE));
        between.push(buffer(self.numbers.handle, both, COMPUTE_READ));
        gpu.barriers(cmd, &[], &between);
        let own = [(0, r.uniforms), (6, Resource::buffer(&self.numbers)), (11, self.over())];
        r.descriptors.bind(gpu, cmd, &self.range, &own)?;
        self.range.push(gpu, cmd, &self.room);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, 1, 1, 1) };
        gpu.barriers(cmd, &[], &[buffer(self.over.handle, COMPUTE_WRITE, OVER_READ)]);
        self.record_go(r, 1, particles)?;
        let mut after = made.map(|own| buffer(own, COMPUTE_WRITE, COMPUTE_READ)).to_vec();
        after.push(buffer(self.count.handle, both, COMPUTE_READ));
        gpu.barriers(cmd, &[], &after);
        r.end(scope);
        Ok(())
    }

    fn record_go(
        &self,
        r: &Recording<'_>,
        go: usize,
        particles: Option<&WhitewaterParticles>,
    ) -> Result<(), Error> {
        let Some(particles) = particles else { return Ok(()) };
        let arguments = self.arguments.handle;
        let own = [
            (6, Resource::buffer(&self.numbers)),
            (7, Resource::buffer(&self.arguments)),
            (8, Resource::buffer(&self.balls)),
            (9, Resource::buffer(&self.turns)),
            (10, Resource::buffer(&self.ids)),
            (12, Resource::buffer(&self.count)),
        ];
        let push = |places| Push { places, room: self.room };
        let pipeline = &self.goes[go][usize::from(r.shaped)];
        self.chunks.each(r, pipeline, &own, particles, push, |chunk| {
            // SAFETY: outside a render pass, pipeline and set are bound; the arguments are visible.
            unsafe { r.gpu.device.cmd_dispatch_indirect(r.cmd, arguments, 16 * chunk) };
        })
    }

    /// Bytes of buffers.
    pub fn memory(&self) -> u64 {
        let own = [&self.arguments, &self.numbers, &self.over, &self.count];
        let made = [&self.balls, &self.turns, &self.ids];
        own.iter().chain(&made).map(|own| own.size).sum()
    }
}

/// Number of descriptor sets per frame.
pub fn sets(limits: &vk::PhysicalDeviceLimits, whitewater: &WhitewaterConfig) -> u32 {
    2 + 2 * Chunks::new(limits, whitewater).count
}
