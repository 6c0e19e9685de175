//! Pass `smooth`: adaptive curvature flow (thesis Sec. 3.1 and 4.7; van der Laan et al. 2009).
//!
//! Each iteration reads one of two images and writes the other. Each pixel's number of iterations and their step size
//! (the plan) are known in advance. Three forms do the same arithmetic and give the same surface, in image `a`: one
//! dispatch per iteration over the tiles that still have active pixels; several iterations per dispatch in shared
//! memory; or the thesis' raster passes, ended by an occlusion query (in `smooth_query`). The GPU makes the decisions
//! that the thesis makes on the CPU.

use ash::vk;
use bytemuck::{Pod, Zeroable};

use super::Recording;
use super::level::Atlas;
use super::reduce::rule_constant;
use super::smooth_query::Query;
use super::tiles::Tiles;
use crate::contract::Config;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_READ, COMPUTE_WRITE, COPY_READ, FRAGMENT_SAMPLED,
};
use crate::gpu::descriptors::{Resource, bind_set};
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::settings::{Rule, Smoothing};

/// Last uses of both smoothing images in a frame, for which the next frame waits: by `composite`, by the smoothing
/// itself, or a copy of the layer by the host.
pub const BEFORE: Access =
    FRAGMENT_SAMPLED.and(COPY_READ).and(COMPUTE_READ).and(COMPUTE_WRITE).and(COLOR_ATTACHMENT);

/// Iterations of one dispatch of the fused form.
const FUSED_STEPS: u32 = 8;

/// State of an image that compute shaders sample in the GENERAL layout.
const COMPUTE_SAMPLED_GENERAL: Access = Access::new(
    vk::PipelineStageFlags2::COMPUTE_SHADER,
    vk::AccessFlags2::SHADER_SAMPLED_READ,
    vk::ImageLayout::GENERAL,
);

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct TilesPush {
    iteration: u32,
    columns: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct FusedPush {
    iteration: u32,
    columns: u32,
    arguments_index: u32,
}

/// Plan and tiles of the smoothing.
pub struct Work<'a> {
    /// Iteration count and step of each pixel.
    pub plan: &'a Image,
    pub tiles: &'a Tiles,
}

enum Form {
    Tiles(Pipeline),
    Fused(Pipeline),
    Query(Box<Query>),
}

/// The pass.
pub struct Smooth {
    form: Form,
    iterations: u32,
    /// The reduced depth before the pass, the smoothed surface after it.
    pub a: Image,
    /// The second image of the ping-pong.
    pub b: Image,
}

impl Smooth {
    pub fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        let (a, b) = Self::images(gpu, config)?;
        let rule = (1, rule_constant(config.rule));
        let iterations = match config.rule {
            Rule::Fixed(count) => count.min(config.max_iterations),
            _ => config.max_iterations,
        };
        let form = match config.smoothing.unwrap_or_else(|| default_form(gpu)) {
            Smoothing::Tiles => {
                // With few threads, long columns are faster.
                let rows = if gpu.is_cpu() { 16 } else { 2 };
                let constants = [rule, (2, 16 / rows), (3, rows)];
                Form::Tiles(Pipeline::compute(gpu, shader::WATER_SMOOTH_COMP, &constants)?)
            }
            Smoothing::Fused => {
                Form::Fused(Pipeline::compute(gpu, shader::WATER_SMOOTH_FUSED_COMP, &[rule])?)
            }
            Smoothing::Query(gate) => {
                Form::Query(Box::new(Query::new(gpu, gate, config.rule, iterations, &a, &b)?))
            }
        };
        Ok(Self { form, iterations, a, b })
    }

    fn images(gpu: &Gpu, config: &Config) -> Result<(Image, Image), Error> {
        let make = |name| {
            Image::new(
                gpu,
                &ImageDesc::new(
                    name,
                    Atlas::of(gpu, config).extent,
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
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let (a, b) = Self::images(gpu, config)?;
        if let Form::Query(query) = &mut self.form {
            query.resize(gpu, &a, &b, retired)?;
        }
        retired.replace(&mut self.a, a);
        retired.replace(&mut self.b, b);
        Ok(())
    }

    /// Records the smoothing. Images `a` and `b` must be in the state in which `reduce` leaves them (layout GENERAL).
    /// After the pass, `a` is in the state `FRAGMENT_SAMPLED` (layout SHADER_READ_ONLY_OPTIMAL).
    pub fn record(&self, r: &mut Recording<'_>, work: &Work<'_>) -> Result<(), Error> {
        let scope = r.begin(c"smooth");
        match &self.form {
            Form::Tiles(pipeline) => self.record_tiles(r, pipeline, work)?,
            Form::Fused(pipeline) => self.record_fused(r, pipeline, work)?,
            Form::Query(query) => query.record(r, [&self.a, &self.b], work)?,
        }
        r.end(scope);
        Ok(())
    }

    /// One dispatch per iteration over the tiles that still have active pixels. A tile runs one iteration more than
    /// it needs: this one copies its pixels, so that its result is in both images, and neighbouring tiles can read
    /// either image in later iterations.
    fn record_tiles(
        &self,
        r: &mut Recording<'_>,
        pipeline: &Pipeline,
        work: &Work<'_>,
    ) -> Result<(), Error> {
        // One dispatch more than the max number of iterations, for the copies. The number is even, so that the result
        // ends in image `a`.
        let dispatches = (self.iterations + 1).next_multiple_of(2).min(256);
        self.record_dispatches(r, pipeline, work, dispatches, |r, index| {
            let push = TilesPush { iteration: index + 1, columns: work.tiles.atlas.columns };
            pipeline.push(r.gpu, r.cmd, &push);
            index + 1
        })
    }

    /// Several iterations per dispatch, and one more dispatch, which copies.
    fn record_fused(
        &self,
        r: &mut Recording<'_>,
        pipeline: &Pipeline,
        work: &Work<'_>,
    ) -> Result<(), Error> {
        let dispatches = self.iterations.div_ceil(FUSED_STEPS) + 1;
        self.record_dispatches(r, pipeline, work, dispatches, |r, index| {
            let iteration = FUSED_STEPS * index + 1;
            // Arguments [i] hold the tiles with at least i - 1 iterations.
            let arguments_index =
                if index == 0 { 1 } else { (iteration + 1 - FUSED_STEPS).min(257) };
            let push = FusedPush { iteration, columns: work.tiles.atlas.columns, arguments_index };
            pipeline.push(r.gpu, r.cmd, &push);
            arguments_index
        })
    }

    /// Records a number of dispatches, each of which reads one smoothing image and writes the other, in turns. `push`
    /// sets the push constants of a dispatch and returns the index of its indirect arguments.
    fn record_dispatches(
        &self,
        r: &mut Recording<'_>,
        pipeline: &Pipeline,
        work: &Work<'_>,
        dispatches: u32,
        push: impl Fn(&Recording<'_>, u32) -> u32,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let set = |from: &Image, to: &Image| {
            let nearest = gpu.samplers.nearest;
            r.descriptors.set(
                gpu,
                pipeline,
                &[
                    (0, r.uniforms),
                    (1, Resource::SampledIn(from.view, nearest, vk::ImageLayout::GENERAL)),
                    (2, Resource::storage(to)),
                    (3, Resource::Sampled(work.plan.view, nearest)),
                    (4, Resource::buffer(&work.tiles.list)),
                    (5, Resource::buffer(&work.tiles.arguments)),
                    (7, r.levels),
                ],
            )
        };
        let sets = [set(&self.a, &self.b)?, set(&self.b, &self.a)?];
        gpu.barriers(
            cmd,
            &[
                access::image(&self.a, COMPUTE_WRITE, COMPUTE_SAMPLED_GENERAL),
                access::image(&self.b, COMPUTE_WRITE, COMPUTE_WRITE),
            ],
            &[],
        );
        pipeline.bind(gpu, cmd);
        let images = [&self.a, &self.b];
        for index in 0..dispatches {
            let from = (index % 2) as usize;
            bind_set(gpu, cmd, pipeline, sets[from]);
            let arguments = push(r, index);
            // SAFETY: outside a render pass; the arguments are visible since `tiles`.
            unsafe {
                gpu.device.cmd_dispatch_indirect(
                    cmd,
                    work.tiles.arguments.handle,
                    16 * u64::from(arguments),
                );
            }
            // The image that was written is read next, and the other way round.
            gpu.barriers(
                cmd,
                &[
                    access::image(images[1 - from], COMPUTE_WRITE, COMPUTE_SAMPLED_GENERAL),
                    access::image(images[from], COMPUTE_SAMPLED_GENERAL, COMPUTE_WRITE),
                ],
                &[],
            );
        }
        // The last access depends on the parity of the number of dispatches.
        let last = COMPUTE_SAMPLED_GENERAL.and(COMPUTE_WRITE);
        gpu.barriers(cmd, &[access::image(&self.a, last, FRAGMENT_SAMPLED)], &[]);
        Ok(())
    }

    /// The samples counted by the queries, if the form has them.
    pub fn query_results(&self) -> Option<(vk::Buffer, u32)> {
        match &self.form {
            Form::Query(query) => Some((query.results.handle, query.blocks)),
            _ => None,
        }
    }

    pub fn memory(&self) -> u64 {
        match &self.form {
            Form::Query(query) => query.results.size + query.predicates.size,
            _ => 0,
        }
    }
}

/// The default form: on CPUs `Tiles`, by far the fastest on lavapipe; otherwise `Fused`, which takes half the time of
/// `Tiles` on an H200 (docs/performance.md).
fn default_form(gpu: &Gpu) -> Smoothing {
    if gpu.is_cpu() { Smoothing::Tiles } else { Smoothing::Fused }
}
