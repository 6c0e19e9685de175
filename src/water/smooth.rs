//! Pass `smooth`: adaptive curvature flow (thesis Sec. 3.1 and 4.7; van der Laan et al. 2009).
//!
//! Two images change places with each iteration. All forms do the same arithmetic on the same plan
//! and give the same surface, in image `a`.

use ash::vk;
use bytemuck::{Pod, Zeroable};

use super::Recording;
use super::reduce::{Reduce, rule_constant};
use super::tiles::Tiles;
use crate::contract::Config;
use crate::error::Error;
use crate::frame::reduced;
use crate::gpu::Gpu;
use crate::gpu::access::{self, Access, COMPUTE_READ, COMPUTE_WRITE, COPY_READ, FRAGMENT_SAMPLED};
use crate::gpu::descriptors::{Resource, bind_set};
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::Retired;
use crate::gpu::shader;
use crate::water::settings::{Rule, Smoothing};

/// Last uses of both images in a frame: `composite`, the host's copy, the forms themselves.
pub const BEFORE: Access = FRAGMENT_SAMPLED.and(COPY_READ).and(COMPUTE_READ).and(COMPUTE_WRITE);

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    iteration: u32,
    columns: u32,
}

/// The pass.
pub struct Smooth {
    tiles: Pipeline,
    iterations: u32,
    /// Holds the reduced depth before, the smoothed surface after.
    pub a: Image,
    /// The other one.
    pub b: Image,
}

impl Smooth {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let form = config.smoothing.unwrap_or(Smoothing::Tiles);
        if form != Smoothing::Tiles {
            return Err(Error::bad("Config.smoothing", format!("{form:?} is not built yet")));
        }
        let (a, b) = Self::images(gpu, config)?;
        Ok(Self {
            tiles: {
                // Few threads do better with long columns.
                let rows = if gpu.is_cpu() { 16 } else { 1 };
                let rule = rule_constant(config.rule);
                let constants = [(1, rule), (2, 16 / rows), (3, rows)];
                Pipeline::compute(gpu, shader::WATER_SMOOTH_COMP, &constants)?
            },
            iterations: match config.rule {
                Rule::Fixed(count) => count.min(config.max_iterations),
                _ => config.max_iterations,
            },
            a,
            b,
        })
    }

    fn images(gpu: &Gpu, config: &Config) -> Result<(Image, Image), Error> {
        let make = |name| {
            Image::new(
                gpu,
                &ImageDesc::new(
                    name,
                    reduced(config.extent, config.smoothing_level),
                    vk::Format::R32_SFLOAT,
                    vk::ImageUsageFlags::STORAGE
                        | vk::ImageUsageFlags::SAMPLED
                        | vk::ImageUsageFlags::COLOR_ATTACHMENT
                        | vk::ImageUsageFlags::TRANSFER_SRC,
                ),
            )
        };
        Ok((make("water/smooth/a")?, make("water/smooth/b")?))
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retire: &mut dyn FnMut(Retired),
    ) -> Result<(), Error> {
        let (a, b) = Self::images(gpu, config)?;
        retire(Retired::Image(std::mem::replace(&mut self.a, a)));
        retire(Retired::Image(std::mem::replace(&mut self.b, b)));
        Ok(())
    }

    /// Both images come as `reduce` left them, in GENERAL; `a` leaves sampled by fragments.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        reduce: &Reduce,
        tiles: &Tiles,
    ) -> Result<(), Error> {
        let scope = r.begin(c"smooth");
        self.record_tiles(r, reduce, tiles)?;
        r.end(scope);
        Ok(())
    }

    /// A dispatch an iteration over the tiles with work left. A tile runs one iteration more than
    /// it needs, in which its pixels are copied: its result is then in both images, whatever their
    /// roles in its neighbours' later iterations.
    fn record_tiles(
        &self,
        r: &mut Recording<'_>,
        reduce: &Reduce,
        tiles: &Tiles,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let sampled = |image: &Image| {
            Resource::SampledIn(image.view, gpu.samplers.nearest, vk::ImageLayout::GENERAL)
        };
        let set = |from: &Image, to: &Image| {
            r.descriptors.set(
                gpu,
                &self.tiles,
                &[
                    (0, r.uniforms),
                    (1, sampled(from)),
                    (2, Resource::storage(to)),
                    (3, Resource::Sampled(reduce.plan.view, gpu.samplers.nearest)),
                    (4, Resource::buffer(&tiles.list)),
                    (5, Resource::buffer(&tiles.arguments)),
                ],
            )
        };
        let sets = [set(&self.a, &self.b)?, set(&self.b, &self.a)?];
        let sampled_read = Access::new(
            vk::PipelineStageFlags2::COMPUTE_SHADER,
            vk::AccessFlags2::SHADER_SAMPLED_READ,
            vk::ImageLayout::GENERAL,
        );
        gpu.barriers(
            cmd,
            &[
                access::image(&self.a, COMPUTE_WRITE, sampled_read),
                access::image(&self.b, COMPUTE_WRITE, COMPUTE_WRITE),
            ],
            &[],
        );
        self.tiles.bind(gpu, cmd);
        let images = [&self.a, &self.b];
        // One more than the most, for the copies; made even, so that the roles end as they began.
        let dispatches = (self.iterations + 1).next_multiple_of(2).min(256);
        for iteration in 1..=dispatches {
            let odd = (iteration % 2) as usize;
            bind_set(gpu, cmd, &self.tiles, sets[1 - odd]);
            self.tiles.push(gpu, cmd, &Push { iteration, columns: tiles.columns });
            // SAFETY: outside a render pass; the arguments are visible since `tiles`.
            unsafe {
                gpu.device.cmd_dispatch_indirect(
                    cmd,
                    tiles.arguments.handle,
                    16 * u64::from(iteration),
                );
            }
            // What was written is read next, what was read is written next.
            gpu.barriers(
                cmd,
                &[
                    access::image(images[odd], COMPUTE_WRITE, sampled_read),
                    access::image(images[1 - odd], sampled_read, COMPUTE_WRITE),
                ],
                &[],
            );
        }
        gpu.barriers(
            cmd,
            &[access::image(&self.a, sampled_read.and(COMPUTE_WRITE), FRAGMENT_SAMPLED)],
            &[],
        );
        Ok(())
    }

    pub fn destroy(self, gpu: &Gpu) {
        self.tiles.destroy(gpu);
        self.a.destroy(gpu);
        self.b.destroy(gpu);
    }
}
