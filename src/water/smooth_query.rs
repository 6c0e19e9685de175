//! Pass `smooth`, form Query: the thesis' raster passes, which end when an occlusion query every fifth iteration
//! finds no active pixel (Sec. 4.7, Listing A.11). Here the GPU alone decides that.
//!
//! A block is five iterations and a copy back, so that the result is always in the same image. In the fifth iteration
//! a separate draw without colour writes counts the pixels that are still active. One shader invocation converts the
//! count to the predicate of the next block: 1 if the block runs, 0 if it is skipped. By which Vulkan mechanism the
//! predicate skips the block is selected by the gate ([`Gate`]). A skipped block costs only its empty render passes.
//! Reads: smoothing images, plan, tile list. Writes: smoothing images, query results, predicates.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::{Pod, Zeroable};

use super::Recording;
use super::reduce::rule_constant;
use super::smooth::Work;
use super::tiles::Tiles;
use crate::error::{Error, VkContext};
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COLOR_ATTACHMENT, COMPUTE_READ, COMPUTE_WRITE, COPY_READ, COPY_WRITE,
    FRAGMENT_SAMPLED, INDIRECT, PREDICATE, VERTEX_READ, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Resource, bind_set};
use crate::gpu::graveyard::{Grave, Owned};
use crate::gpu::image::Image;
use crate::gpu::pipeline::{Graphics, Pipeline, no_blend};
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::settings::{Gate, Rule};

/// Iterations per block: the thesis' query interval.
pub const BLOCK: u32 = 5;
/// Distance between two predicates in bytes: large enough to bind each of them, or to use it as a draw count, on its
/// own.
const PREDICATE_STRIDE: u64 = 256;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    iteration: u32,
    columns: u32,
    block: u32,
}

/// State of this form.
pub struct Query {
    gate: Gate,
    pass: vk::RenderPass,
    /// Framebuffers of images `a` and `b`.
    framebuffers: [Owned<vk::Framebuffer>; 2],
    iterate: Pipeline,
    count: Pipeline,
    copy: Pipeline,
    write_gate: Pipeline,
    pool: Owned<vk::QueryPool>,
    /// Number of pixels that are active in the last of the five iterations of each block; 0 for blocks that were
    /// skipped.
    pub results: Buffer,
    /// One word per block, [`PREDICATE_STRIDE`] apart.
    pub predicates: Buffer,
    /// Number of recorded blocks.
    pub blocks: u32,
}

impl Query {
    pub fn new(
        gpu: &Gpu,
        gate: Gate,
        rule: Rule,
        iterations: u32,
        a: &Image,
        b: &Image,
    ) -> Result<Self, Error> {
        let missing = |what: &str| {
            Err(Error::Missing {
                what: what.into(),
                why: format!("{gate:?} needs it enabled; choose another gate"),
            })
        };
        match gate {
            Gate::DrawCount if !gpu.enabled.draw_indirect_count => {
                return missing("drawIndirectCount");
            }
            Gate::Predicate if gpu.conditional.is_none() => {
                return missing("VK_EXT_conditional_rendering");
            }
            _ => {}
        }
        let pass = gpu.color_pass("water/smooth", &[a.format], vk::AttachmentLoadOp::LOAD)?;
        let make = |task, blend| {
            let cull = u32::from(gate == Gate::VertexCull);
            Pipeline::graphics(
                gpu,
                &Graphics {
                    vertex: shader::WATER_SMOOTH_VERT,
                    fragment: shader::WATER_SMOOTH_FRAG,
                    topology: vk::PrimitiveTopology::TRIANGLE_STRIP,
                    pass,
                    blend: &[blend],
                    constants: &[(0, cull), (1, rule_constant(rule)), (2, task)],
                },
            )
        };
        let unwritten = no_blend().color_write_mask(vk::ColorComponentFlags::empty());
        let blocks = iterations.div_ceil(BLOCK).max(1);
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::OCCLUSION)
            .query_count(blocks);
        // SAFETY: valid create info.
        let pool = unsafe { gpu.device.create_query_pool(&info, None) }
            .context(|| "vkCreateQueryPool water/smooth".into())?;
        gpu.name(pool, "water/smooth/active");
        let pool = gpu.own(pool, Grave::QueryPool);
        let (iterate, count, copy) =
            (make(0, no_blend())?, make(1, unwritten)?, make(2, no_blend())?);
        Ok(Self {
            gate,
            framebuffers: Self::framebuffers(gpu, pass, a, b)?,
            iterate,
            count,
            copy,
            pass,
            write_gate: Pipeline::compute(gpu, shader::WATER_SMOOTH_GATE_COMP, &[])?,
            pool,
            results: Buffer::new(
                gpu,
                "water/smooth/results",
                4 * u64::from(blocks),
                vk::BufferUsageFlags::STORAGE_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_DST
                    | vk::BufferUsageFlags::TRANSFER_SRC,
                MemoryLocation::GpuOnly,
            )?,
            predicates: Buffer::new(
                gpu,
                "water/smooth/predicates",
                PREDICATE_STRIDE * u64::from(blocks + 1),
                vk::BufferUsageFlags::STORAGE_BUFFER
                    | vk::BufferUsageFlags::TRANSFER_DST
                    | vk::BufferUsageFlags::INDIRECT_BUFFER
                    | if gpu.conditional.is_some() {
                        vk::BufferUsageFlags::CONDITIONAL_RENDERING_EXT
                    } else {
                        vk::BufferUsageFlags::empty()
                    },
                MemoryLocation::GpuOnly,
            )?,
            blocks,
        })
    }

    fn framebuffers(
        gpu: &Gpu,
        pass: vk::RenderPass,
        a: &Image,
        b: &Image,
    ) -> Result<[Owned<vk::Framebuffer>; 2], Error> {
        Ok([
            gpu.framebuffer("water/smooth/a", pass, a.view, a.extent)?,
            gpu.framebuffer("water/smooth/b", pass, b.view, b.extent)?,
        ])
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        a: &Image,
        b: &Image,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        let new = Self::framebuffers(gpu, self.pass, a, b)?;
        for old in std::mem::replace(&mut self.framebuffers, new) {
            retired.retire(old);
        }
        Ok(())
    }

    /// Access to the predicates.
    fn gate_use(&self) -> Access {
        match self.gate {
            Gate::DrawCount => INDIRECT,
            Gate::Predicate => PREDICATE,
            Gate::VertexCull => VERTEX_READ,
        }
    }

    /// Records all blocks of the smoothing. Before, both smoothing images (`images`) are in the layout GENERAL;
    /// after, fragment shaders can sample both.
    pub fn record(
        &self,
        r: &mut Recording<'_>,
        images: [&Image; 2],
        work: &Work<'_>,
    ) -> Result<(), Error> {
        let Work { plan, tiles } = work;
        let (gpu, cmd) = (r.gpu, r.cmd);
        let by_host = r.read_back.is_some();
        // All three pipelines have the same bindings and push constants. Only with the gate VertexCull a shader reads
        // the predicates; with the others the tile list stands in, because their barriers make the predicates visible
        // to no shader.
        let shader_predicates = match self.gate {
            Gate::VertexCull => Resource::buffer(&self.predicates),
            Gate::DrawCount | Gate::Predicate => Resource::buffer(&tiles.list),
        };
        let set = |pipeline: &Pipeline, from: &Image| {
            let nearest = gpu.samplers.nearest;
            r.descriptors.set(
                gpu,
                pipeline,
                &[
                    (0, r.uniforms),
                    (1, Resource::Sampled(from.view, nearest)),
                    (2, Resource::Sampled(plan.view, nearest)),
                    (3, Resource::buffer(&tiles.list)),
                    (4, shader_predicates),
                    (7, r.levels),
                ],
            )
        };
        let iterate = [set(&self.iterate, images[0])?, set(&self.iterate, images[1])?];
        let count = set(&self.count, images[0])?;
        let copy = set(&self.copy, images[1])?;
        let gate = r.descriptors.set(
            gpu,
            &self.write_gate,
            &[(1, Resource::buffer(&self.results)), (2, Resource::buffer(&self.predicates))],
        )?;

        // The first block always runs.
        gpu.barriers(
            cmd,
            &[
                access::image(images[0], COMPUTE_WRITE, FRAGMENT_SAMPLED),
                access::image(images[1], COMPUTE_WRITE, FRAGMENT_SAMPLED),
            ],
            &[
                buffer(self.predicates.handle, self.gate_use(), CLEAR),
                buffer(self.results.handle, COMPUTE_READ.and(COPY_READ), COPY_WRITE),
            ],
        );
        // SAFETY: outside a render pass; the previous frame has finished with both (barriers above).
        unsafe {
            // Word 0: the first predicate. Words 4 to 7: the arguments of an empty draw.
            let first: [u32; 8] = [1, 0, 0, 0, 0, 0, 0, 0];
            let bytes = bytemuck::bytes_of(&first);
            gpu.device.cmd_update_buffer(cmd, self.predicates.handle, 0, bytes);
            gpu.device.cmd_reset_query_pool(cmd, self.pool.handle, 0, self.blocks);
        }
        gpu.barriers(cmd, &[], &[buffer(self.predicates.handle, CLEAR, self.gate_use())]);

        // If the host reads the queries and ends the recording itself, no gate is needed: every block uses the first
        // predicate, which is always 1.
        let gate_of = |block| if by_host { 0 } else { block };
        for block in 0..self.blocks {
            for k in 0..BLOCK {
                let (from, to) = ((k % 2) as usize, (1 - k % 2) as usize);
                let push = Push {
                    iteration: BLOCK * block + k + 1,
                    columns: tiles.atlas.columns,
                    block: gate_of(block),
                };
                self.begin(r, images[to], to);
                self.draw(r, &self.iterate, iterate[from], &push, tiles);
                if k == BLOCK - 1 {
                    self.draw_counted(r, count, block, &push, tiles);
                }
                self.end(r, images[to]);
            }
            let push = Push { iteration: 0, columns: tiles.atlas.columns, block: gate_of(block) };
            self.begin(r, images[0], 0);
            self.draw(r, &self.copy, copy, &push, tiles);
            self.end(r, images[0]);
            if block + 1 == self.blocks {
                break;
            }
            let Some(read_back) = &mut r.read_back else {
                self.record_gate(r, gate, block);
                continue;
            };
            // A debug label may not span two command buffers: lavapipe crashes then.
            gpu.end_label(r.cmd);
            gpu.end_label(r.cmd);
            let (next, any) = read_back(r.cmd, self.pool.handle, block)?;
            r.cmd = next;
            gpu.begin_label(r.cmd, c"whitewater");
            gpu.begin_label(r.cmd, c"smooth");
            if !any {
                break;
            }
        }
        if self.gate == Gate::DrawCount && gpu.is_cpu() {
            self.forget_draw_count(r, images[0]);
        }
        Ok(())
    }

    /// Works around a bug of lavapipe (Mesa's CPU driver) up to 22.3, which applies the count of the last
    /// `drawIndirectCount` to every later indirect draw of the command buffer. So this records an empty draw with a
    /// count of 1. Later indirect draws of one command are then right; only those of several commands stay wrong,
    /// which the library does not record but a host may.
    fn forget_draw_count(&self, r: &Recording<'_>, image: &Image) {
        self.begin(r, image, 0);
        // SAFETY: inside a render pass; the copy's pipeline, set and constants are still bound;
        // the words were written above and made visible.
        unsafe {
            let words = self.predicates.handle;
            r.gpu.device.cmd_draw_indirect_count(r.cmd, words, 16, words, 0, 1, 16);
        }
        self.end(r, image);
    }

    /// Begins a render pass on an image that was sampled before.
    fn begin(&self, r: &Recording<'_>, image: &Image, index: usize) {
        let barrier = access::image(image, FRAGMENT_SAMPLED, COLOR_ATTACHMENT);
        r.gpu.barriers(r.cmd, &[barrier], &[]);
        let area = image.extent.into();
        r.gpu.begin_pass(r.cmd, self.pass, self.framebuffers[index].handle, area, [0.0; 4]);
    }

    /// Ends the render pass; the image is sampled next.
    fn end(&self, r: &Recording<'_>, image: &Image) {
        r.gpu.end_pass(r.cmd);
        let barrier = access::image(image, COLOR_ATTACHMENT, FRAGMENT_SAMPLED);
        r.gpu.barriers(r.cmd, &[barrier], &[]);
    }

    /// A gated draw of all tiles.
    fn draw(
        &self,
        r: &Recording<'_>,
        pipeline: &Pipeline,
        set: vk::DescriptorSet,
        push: &Push,
        tiles: &Tiles,
    ) {
        let (gpu, cmd) = (r.gpu, r.cmd);
        pipeline.bind(gpu, cmd);
        bind_set(gpu, cmd, pipeline, set);
        pipeline.push(gpu, cmd, push);
        let arguments = tiles.arguments.handle;
        let predicate = PREDICATE_STRIDE * u64::from(push.block);
        // SAFETY: inside a render pass; arguments and predicates are visible (barriers).
        unsafe {
            match (self.gate, &gpu.conditional) {
                (Gate::DrawCount, _) => gpu.device.cmd_draw_indirect_count(
                    cmd,
                    arguments,
                    0,
                    self.predicates.handle,
                    predicate,
                    1,
                    16,
                ),
                (Gate::Predicate, Some(conditional)) => {
                    let info = vk::ConditionalRenderingBeginInfoEXT::default()
                        .buffer(self.predicates.handle)
                        .offset(predicate);
                    // Only the draw is inside: a clear or a copy would not be predicated.
                    (conditional.fp().cmd_begin_conditional_rendering_ext)(cmd, &info);
                    gpu.device.cmd_draw_indirect(cmd, arguments, 0, 1, 16);
                    (conditional.fp().cmd_end_conditional_rendering_ext)(cmd);
                }
                _ => gpu.device.cmd_draw_indirect(cmd, arguments, 0, 1, 16),
            }
        }
    }

    /// The counted draw: pixels still active in this iteration.
    fn draw_counted(
        &self,
        r: &Recording<'_>,
        set: vk::DescriptorSet,
        query: u32,
        push: &Push,
        tiles: &Tiles,
    ) {
        let flags = if r.gpu.enabled.precise_occlusion_queries {
            vk::QueryControlFlags::PRECISE
        } else {
            vk::QueryControlFlags::empty()
        };
        // SAFETY: inside a render pass; the query was reset at the start, no other is active.
        unsafe { r.gpu.device.cmd_begin_query(r.cmd, self.pool.handle, query, flags) };
        self.draw(r, &self.count, set, push, tiles);
        // SAFETY: begun above.
        unsafe { r.gpu.device.cmd_end_query(r.cmd, self.pool.handle, query) };
    }

    /// Converts the block's count to the next block's predicate.
    fn record_gate(&self, r: &Recording<'_>, set: vk::DescriptorSet, block: u32) {
        let (gpu, cmd) = (r.gpu, r.cmd);
        // SAFETY: outside a render pass; WAIT makes the GPU wait for the query, not the host.
        unsafe {
            gpu.device.cmd_copy_query_pool_results(
                cmd,
                self.pool.handle,
                block,
                1,
                self.results.handle,
                4 * u64::from(block),
                4,
                vk::QueryResultFlags::WAIT,
            );
        }
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.results.handle, COPY_WRITE, COMPUTE_READ),
                buffer(self.predicates.handle, self.gate_use(), COMPUTE_WRITE),
            ],
        );
        self.write_gate.bind(gpu, cmd);
        bind_set(gpu, cmd, &self.write_gate, set);
        self.write_gate.push(gpu, cmd, &block);
        // SAFETY: outside a render pass.
        unsafe { gpu.device.cmd_dispatch(cmd, 1, 1, 1) };
        gpu.barriers(
            cmd,
            &[],
            &[
                buffer(self.results.handle, COMPUTE_READ, COPY_WRITE),
                buffer(self.predicates.handle, COMPUTE_WRITE, self.gate_use()),
            ],
        );
    }
}
