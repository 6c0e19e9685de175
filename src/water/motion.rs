//! Pass `motion`: motion vectors, for motion blur, denoising and temporal anti-aliasing.
//!
//! Pass `motion` is not in the sources (thesis and papers). A motion vector is the position of the visible point in
//! this frame minus its position in the previous frame, in pixels of the frame (row 0 on top). For water and foam it
//! contains the surface's own motion and the camera's. For the scene it contains only the camera's motion, at the
//! scene's depth or, for the background, at infinity (only rotation). A pixel with water has the motion of the front
//! surface, not of what is visible through the water. It has the motion of foam if the foam's opacity is at least a
//! half. Spray has no motion of its own: a pixel with droplets has the motion of the surface behind them.
//!
//! The water surface's own motion is the mean velocity of the particles near it, weighted by the thickness that each
//! adds. A particle counts fully if its depth differs from the surface's by at most one drawn radius, and not at all
//! from three radii. Sums are integers at the resolution of the thickness image, one set for the nearest and one for
//! the farthest surface of each texel's pixels, so that both sides of an outline keep their motion: a pixel uses the
//! set of its own surface.
//!
//! The image of pass `motion` is RG32F: with half floats a vector of a hundred pixels could be wrong by a
//! thirty-second of a pixel, one of a thousand pixels by a quarter of a pixel.
//! Reads: the counts of `cull`, the host's particles, depth, foam depth and thickness, smoothed surface, scene depth.
//! Writes: motion, RG32F, every pixel.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use super::Recording;
use super::cull::SphereList;
use super::sprites::Over;
use crate::contract::{Config, Layer, Particles};
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COMPUTE_READ, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ,
    FRAGMENT_SAMPLED, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;

/// State of the layer for the host.
pub const AFTER: Access = COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED);

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    position_word: u32,
    position_stride: u32,
    velocity_word: u32,
    velocity_stride: u32,
    density_word: u32,
    density_stride: u32,
    foam_word: u32,
    foam_stride: u32,
    level: u32,
    packets: u32,
}
shader::assert_layout!(
    shader::WATER_MOTION_COMP,
    "Push",
    Push {
        position_word,
        position_stride,
        velocity_word,
        velocity_stride,
        density_word,
        density_stride,
        foam_word,
        foam_stride,
        level,
        packets,
    }
);

/// Inputs, which fragment shaders sample before and after the pass.
pub struct Surfaces<'a> {
    pub depth: &'a Image,
    /// Depth and thickness of the foam.
    pub foam: Option<[&'a Image; 2]>,
    pub smoothed: &'a Image,
}

/// The pass.
pub struct Motion {
    front: Pipeline,
    each: Pipeline,
    resolve: Pipeline,
    fronts: Buffer,
    sums: Buffer,
    image: Image,
    level: u32,
}

/// Number of surfaces with sums of their own in a texel: the nearest and the farthest, or one if a texel is a pixel.
fn surfaces(level: u32) -> u32 {
    if level == 0 { 1 } else { 2 }
}

fn texels(config: &Config, level: u32) -> u64 {
    let size = reduced(config.extent, level);
    u64::from(size.width) * u64::from(size.height)
}

/// Bytes of the sums: weight and weighted displacement in two words each.
fn sum_bytes(config: &Config, level: u32) -> u64 {
    32 * u64::from(surfaces(level)) * texels(config, level)
}

/// Number of times that the resolution of the sums is halved: as often as the resolution of the thickness, or more
/// often if the sums would not fit in one binding otherwise.
fn level(gpu: &Gpu, config: &Config) -> u32 {
    let range = u64::from(gpu.limits.max_storage_buffer_range);
    (config.thickness_level..32).find(|level| sum_bytes(config, *level) <= range).unwrap_or(32)
}

impl Motion {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let constants = [(9, u32::from(config.surface_foam))];
        let compute = |shader| Pipeline::compute(gpu, shader, &constants);
        let level = level(gpu, config);
        let (fronts, sums, image) = Self::sized(gpu, config, level)?;
        Ok(Self {
            front: compute(shader::WATER_MOTION_FRONT_COMP)?,
            each: compute(shader::WATER_MOTION_COMP)?,
            resolve: compute(shader::WATER_MOTION_RESOLVE_COMP)?,
            fronts,
            sums,
            image,
            level,
        })
    }

    fn sized(gpu: &Gpu, config: &Config, level: u32) -> Result<(Buffer, Buffer, Image), Error> {
        let make = |name, bytes| {
            let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
            Buffer::new(gpu, name, bytes, usage, MemoryLocation::GpuOnly)
        };
        let usage = vk::ImageUsageFlags::STORAGE
            | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC;
        let format = vk::Format::R32G32_SFLOAT;
        let image = ImageDesc::new("water/motion", config.extent, format, usage);
        Ok((
            make("water/motion/fronts", 8 * texels(config, level))?,
            make("water/motion/sums", sum_bytes(config, level))?,
            Image::new(gpu, &image)?,
        ))
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        self.level = level(gpu, config);
        let (fronts, sums, image) = Self::sized(gpu, config, self.level)?;
        retired.replace(&mut self.fronts, fronts);
        retired.replace(&mut self.sums, sums);
        retired.replace(&mut self.image, image);
        Ok(())
    }

    /// `list` is the one of `cull`, read for its counts.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        particles: &Particles,
        list: &SphereList,
        from: &Surfaces<'_>,
    ) -> Result<(), Error> {
        let scope = r.begin(c"motion");
        let (gpu, cmd) = (r.gpu, r.cmd);
        let (fronts, sums) = (self.fronts.handle, self.sums.handle);
        let images: Vec<_> = [from.depth, from.smoothed]
            .into_iter()
            .chain(from.foam.into_iter().flatten())
            .collect();
        let hand = |from, to| -> Vec<_> {
            images.iter().map(|image| access::image(image, from, to)).collect()
        };
        // Acquires the inputs, and our images from the previous frame.
        let mut first = hand(FRAGMENT_SAMPLED, COMPUTE_SAMPLED);
        first.push(access::image(&self.image, AFTER.and(COPY_READ).discarded(), COMPUTE_WRITE));
        let before = [
            buffer(fronts, COMPUTE_READ, COMPUTE_WRITE),
            buffer(sums, COMPUTE_READ, COMPUTE_WRITE),
        ];
        gpu.barriers(cmd, &first, &before);
        let sampled = |image: &Image| Resource::Sampled(image.view, gpu.samplers.nearest);
        // If there is no foam, the stand-in is not read.
        let [foam, foam_thickness] = from.foam.unwrap_or([from.depth; 2]).map(sampled);
        let ours = [
            (0, r.uniforms),
            (1, Resource::buffer(&self.fronts)),
            (2, Resource::buffer(&self.sums)),
        ];
        let front = [(3, sampled(from.depth)), (4, foam), (6, r.scene_depth), (9, foam_thickness)];
        r.descriptors.bind(gpu, cmd, &self.front, &[&ours[..], &front].concat())?;
        self.front.push(gpu, cmd, &self.level);
        r.dispatch_over(reduced(r.extent, self.level), self.front.local_size);
        // Particles without velocities are at rest: nothing to sum.
        if particles.velocities.is_some() {
            let between = [
                buffer(fronts, COMPUTE_WRITE, COMPUTE_READ),
                buffer(sums, COMPUTE_WRITE, COMPUTE_READ_WRITE),
            ];
            gpu.barriers(cmd, &[], &between);
            let streams = [&particles.velocities, &particles.densities, &particles.surface_foam];
            let over = Over { particles, streams, binding: 4 };
            for index in 0..list.chunks {
                let chunk = list.chunk(index);
                let own = [ours[1], ours[2], (3, chunk.counts), (8, chunk.members)];
                over.record(r, &self.each, (list, index), &own, |_, positions, streams| {
                    let [velocities, densities, foam] = streams;
                    Push {
                        position_word: positions.word,
                        position_stride: positions.stride,
                        velocity_word: velocities.word,
                        velocity_stride: velocities.stride,
                        density_word: densities.word,
                        density_stride: densities.stride,
                        foam_word: foam.word,
                        foam_stride: foam.stride,
                        level: self.level,
                        packets: u32::from(particles.packets.is_some()),
                    }
                })?;
            }
            let after = [buffer(sums, COMPUTE_READ_WRITE, COMPUTE_READ)];
            gpu.barriers(cmd, &[], &after);
        } else {
            let after = [fronts, sums].map(|handle| buffer(handle, COMPUTE_WRITE, COMPUTE_READ));
            gpu.barriers(cmd, &[], &after);
        }
        let resolve = [
            (3, sampled(from.depth)),
            (4, foam),
            (5, sampled(from.smoothed)),
            (6, r.scene_depth),
            (7, r.levels),
            (8, Resource::storage(&self.image)),
            (9, foam_thickness),
        ];
        r.descriptors.bind(gpu, cmd, &self.resolve, &[&ours[..], &resolve].concat())?;
        self.resolve.push(gpu, cmd, &self.level);
        r.dispatch_over(r.extent, self.resolve.local_size);
        let mut last = hand(COMPUTE_SAMPLED, FRAGMENT_SAMPLED);
        last.push(access::image(&self.image, COMPUTE_WRITE, AFTER));
        gpu.barriers(cmd, &last, &[]);
        r.end(scope);
        Ok(())
    }

    /// The motion layer of a frame with this extent.
    pub fn layer(&self, frame: vk::Extent2D) -> Layer {
        Layer {
            name: "motion",
            image: self.image.handle,
            view: self.image.view,
            format: self.image.format,
            extent: frame,
            access: AFTER,
        }
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        (self.image.size, self.fronts.size + self.sums.size)
    }
}
