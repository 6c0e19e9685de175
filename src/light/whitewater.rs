//! Pass `whitewater_light`: a map of whitewater as seen from the sun (future work of Akinci et al. 2013, Sec. 4).
//!
//! In pass `whitewater_light`, one invocation per particle reads the host's streams directly, independent of the
//! camera. Sums use fixed-point steps, so the order of the particles does not matter. Each texel has three sums: the
//! thickness t (as for the camera), t·d and t·d², with d the particle's position along the light. They give the
//! amount of whitewater, and mean and standard deviation of its position. From these follows how much whitewater lies
//! between the sun and a point, and so how much sunlight reaches the point (glsl/include/sunlight.glsl).
//! Reads: the host's streams, front. Writes: whitewater, RGBA16F: thickness, mean distance along the light, and its
//! standard deviation, in units of the power of two at or below a texel's edge (`whitewater_unit`, sunlight.glsl).

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::map_desc;
use super::maps::{AFTER, Maps};
use crate::contract::WhitewaterParticles;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_WRITE, COPY_READ, COPY_WRITE, INDIRECT, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::Image;
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;
use crate::water::Recording;
use crate::whitewater::settings::WhitewaterConfig;
use crate::whitewater::streams::{Chunks, Covering, Places, buffers_of};

/// Bytes of a texel's words (glsl/include/light_whitewater.glsl).
const WORDS: u64 = 16;

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    places: Places,
    first: i32,
    last: i32,
}
shader::assert_layout!(shader::LIGHT_WHITEWATER_COMP, "Push", Push { first, last });

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct ResolvePush {
    first: i32,
    last: i32,
    bound: i32,
}
shader::assert_layout!(
    shader::LIGHT_WHITEWATER_RESOLVE_COMP,
    "Push",
    ResolvePush { first, last, bound }
);

/// The pass.
pub struct Whitewater {
    begin: Pipeline,
    splat: Covering,
    resolve: Pipeline,
    arguments: Buffer,
    words: Buffer,
    /// The result.
    pub image: Image,
    chunks: Chunks,
    /// Rows whose words fit in one binding.
    rows: u32,
}

impl Whitewater {
    pub fn new(gpu: &Gpu, whitewater: &WhitewaterConfig, edge: u32) -> Result<Self, Error> {
        let chunks = Chunks::new(&gpu.limits, whitewater);
        let made = |name, bytes, usage| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER | usage;
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        let (arguments, fill) =
            (vk::BufferUsageFlags::INDIRECT_BUFFER, vk::BufferUsageFlags::TRANSFER_DST);
        let words = WORDS * u64::from(edge) * u64::from(edge);
        // It is cleared in frames without particles.
        let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = map_desc("light/whitewater", edge, vk::Format::R16G16B16A16_SFLOAT, usage);
        Ok(Self {
            begin: Pipeline::compute(gpu, shader::LIGHT_WHITEWATER_BEGIN_COMP, &[])?,
            splat: Covering::new(
                gpu,
                "light/whitewater/large",
                shader::LIGHT_WHITEWATER_COMP,
                &[],
                whitewater,
            )?,
            resolve: Pipeline::compute(gpu, shader::LIGHT_WHITEWATER_RESOLVE_COMP, &[])?,
            arguments: made("light/whitewater/arguments", chunks.arguments(), arguments)?,
            words: made("light/whitewater/words", words, fill)?,
            image: Image::new(gpu, &desc)?,
            chunks,
            rows: rows(&gpu.limits, edge),
        })
    }

    /// Runs after `light`, whose front it reads. Acquires the particles' buffers.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: Option<&WhitewaterParticles>,
        maps: &Maps,
    ) -> Result<(), Error> {
        let scope = r.begin(c"whitewater_light");
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

    /// Accumulates the particles in the words.
    fn record_splat(
        &self,
        r: &Recording<'_>,
        particles: &WhitewaterParticles,
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

    /// Accumulates the contributions to a range of rows.
    fn record_rows(
        &self,
        r: &Recording<'_>,
        particles: &WhitewaterParticles,
        maps: &Maps,
        rows: [u32; 2],
    ) -> Result<(), Error> {
        let words = self.words_of(rows);
        let [first_row, last_row] = rows.map(u32::cast_signed);
        let front = Resource::Sampled(maps.front.image().view, r.gpu.samplers.nearest);
        let own = [(6, words), (7, Resource::buffer(&self.arguments)), (8, front)];
        let push = |places| Push { places, first: first_row, last: last_row };
        self.splat.record(r, &self.chunks, &own, particles, self.arguments.handle, push)
    }

    fn record_resolve(&self, r: &Recording<'_>) -> Result<(), Error> {
        let (gpu, cmd, edge) = (r.gpu, r.cmd, self.image.extent.height);
        // One row on either side is read as well.
        let own = if self.rows < edge { self.rows - 2 } else { edge };
        for first in (0..edge).step_by(own as usize) {
            if first > 0 {
                // The rows are separate, but a validation layer that tracks whole images requires the barrier.
                let barrier = access::image(&self.image, COMPUTE_WRITE, COMPUTE_WRITE);
                gpu.barriers(cmd, &[barrier], &[]);
            }
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

    /// Returns the part of the buffer `words` from the first to the last row of the map. A row takes a multiple of
    /// 256 bytes, because the side length is a multiple of 16, so every device can bind at the start of any row.
    fn words_of(&self, [first, last]: [u32; 2]) -> Resource {
        let row = WORDS * u64::from(self.image.extent.width);
        let (first, count) = (u64::from(first), u64::from(last - first + 1));
        Resource::Buffer(self.words.handle, row * first, row * count)
    }

    fn record_begin(
        &self,
        r: &Recording<'_>,
        particles: &WhitewaterParticles,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        // No larger than every device can bind.
        let unread = Resource::buffer(&self.arguments);
        let group_size = self.splat.group_size();
        let (counting, count) = self.chunks.counting(Some(particles), group_size, unread);
        let resources = [(1, count), (2, Resource::buffer(&self.arguments))];
        r.descriptors.bind(gpu, cmd, &self.begin, &resources)?;
        self.begin.push(gpu, cmd, &counting);
        let groups = self.chunks.count.div_ceil(self.begin.local_size[0]);
        // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, groups, 1, 1) };
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        let buffers = self.words.size + self.arguments.size + self.splat.memory();
        (self.image.size, buffers)
    }
}

/// Number of rows of the map whose words fit in one binding, at least three.
fn rows(limits: &vk::PhysicalDeviceLimits, edge: u32) -> u32 {
    let row = WORDS * u64::from(edge);
    let fit = u64::from(limits.max_storage_buffer_range) / row;
    (fit as u32).clamp(3, edge)
}

/// Number of descriptor sets per frame.
pub fn sets(limits: &vk::PhysicalDeviceLimits, whitewater: &WhitewaterConfig, edge: u32) -> u32 {
    let rows = rows(limits, edge);
    let own = if rows < edge { rows - 2 } else { edge };
    1 + 2 * edge.div_ceil(rows) * Chunks::new(limits, whitewater).count + edge.div_ceil(own)
}
