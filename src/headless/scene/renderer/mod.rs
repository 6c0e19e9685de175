//! Pass `scene`: opaque meshes, ground and sky under a sun with a shadow map.
//!
//! Colour is drawn with four samples a pixel, where that is asked for and the device has them, and
//! resolved; depth, which the water is tested against, is drawn apart with one sample at each
//! pixel's centre. The shadow
//! map is drawn once, in `record_setup`: nothing in the scene moves.
//! Reads: vertices, shadow map, environment. Writes: scene colour and depth, all of both.

use std::collections::BTreeMap;
use std::sync::Arc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Quat, Vec2, Vec3};
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use super::bake::{self, Batch, Vertex};
use super::{Material, Mesh, Pattern, Scene, SunLight, Texture};
use crate::contract::{Camera, Slot};
use crate::error::{Error, VkContext};
use crate::frame::Lens;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COLOR_ATTACHMENT, COMPUTE_WRITE, COPY_WRITE, FRAGMENT_SAMPLED, NOTHING,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource, bind_set};
use crate::gpu::graveyard::Destroy;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::{Pipeline, no_blend};
use crate::gpu::shader::{self, Shader};

/// Edge of the shadow map in texels.
const SHADOW_SIZE: u32 = 2048;
/// Samples of a pixel's colour, where the device has them.
const SAMPLES: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_4;
/// Radiance of the sun's disc over its irradiance: one over its solid angle, less where a half
/// float would overflow.
const DISC: f32 = 1.0 / 6.8e-5;
const DISC_MOST: f32 = 3.0e4;

/// Depth attachment, tested and written.
const DEPTH_ATTACHMENT: Access = Access::new(
    vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::EARLY_FRAGMENT_TESTS.as_raw()
            | vk::PipelineStageFlags2::LATE_FRAGMENT_TESTS.as_raw(),
    ),
    vk::AccessFlags2::from_raw(
        vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
            | vk::AccessFlags2::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
    ),
    DEPTH_LAYOUT,
);
const DEPTH_LAYOUT: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
/// Fragment shader: storage buffer, read.
const FRAGMENT_READ: Access = Access::new(
    vk::PipelineStageFlags2::FRAGMENT_SHADER,
    vk::AccessFlags2::SHADER_STORAGE_READ,
    vk::ImageLayout::GENERAL,
);
/// Vertices and indices.
const VERTEX_INPUT: Access = Access::new(
    vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::VERTEX_ATTRIBUTE_INPUT.as_raw()
            | vk::PipelineStageFlags2::INDEX_INPUT.as_raw(),
    ),
    vk::AccessFlags2::from_raw(
        vk::AccessFlags2::VERTEX_ATTRIBUTE_READ.as_raw() | vk::AccessFlags2::INDEX_READ.as_raw(),
    ),
    vk::ImageLayout::GENERAL,
);

/// The block `Scene` of `glsl/headless/scene.glsl`; its comments say what each member holds.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Uniforms {
    clip: [[f32; 4]; 4],
    shadow: [[f32; 4]; 4],
    eye: [f32; 4],
    ray_x: [f32; 4],
    ray_y: [f32; 4],
    ray_z: [f32; 4],
    sun_direction: [f32; 4],
    sun_color: [f32; 4],
    shadow_texel: [f32; 4],
    ground: [f32; 4],
}

shader::assert_layout!(
    shader::HEADLESS_SCENE_FRAG,
    "Scene",
    Uniforms {
        clip,
        shadow,
        eye,
        ray_x,
        ray_y,
        ray_z,
        sun_direction,
        sun_color,
        shadow_texel,
        ground
    }
);

/// Push constants of `scene.frag`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Push {
    turn: [f32; 4],
    origin: [f32; 4],
    color: [f32; 4],
    pattern: [f32; 4],
}

shader::assert_layout!(shader::HEADLESS_SCENE_FRAG, "Push", Push { turn, origin, color, pattern });

/// What one record needs.
#[derive(Clone, Copy)]
pub struct SceneFrame<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// The slot's descriptor sets: room for [`SceneRenderer::sets`].
    pub descriptors: &'a Descriptors,
    /// The view.
    pub camera: &'a Camera,
    /// Colour target in COLOR_ATTACHMENT_OPTIMAL, before and after.
    pub color: &'a Image,
    /// Depth target in DEPTH_STENCIL_ATTACHMENT_OPTIMAL, before and after.
    pub depth: &'a Image,
    /// Cube of the environment with its mips, in SHADER_READ_ONLY_OPTIMAL; its last barrier makes
    /// it visible to compute and fragment shaders.
    pub environment: vk::ImageView,
    /// Linear in the texels and between the mips.
    pub sampler: vk::Sampler,
}

/// The pass.
pub struct SceneRenderer {
    shadow_pass: vk::RenderPass,
    depth_pass: vk::RenderPass,
    color_pass: vk::RenderPass,
    shadow: Pipeline,
    depth: Pipeline,
    /// Depth before colour, in the multisampled pass.
    depths: Option<Pipeline>,
    meshes: BTreeMap<Kind, Pipeline>,
    sky: Pipeline,
    irradiance: Pipeline,
    shadow_framebuffer: vk::Framebuffer,
    shadow_map: Image,
    shadow_sampler: vk::Sampler,
    texture_sampler: vk::Sampler,
    coefficients: Buffer,
    vertices: Buffer,
    indices: Buffer,
    /// Indices of what casts a shadow: all but the ground, which comes last.
    casters: u32,
    index_count: u32,
    textures: Vec<Image>,
    draws: Vec<Draw>,
    staging: Vec<Upload>,
    uniforms: Vec<Buffer>,
    framebuffers: Vec<[vk::Framebuffer; 2]>,
    samples: vk::SampleCountFlags,
    multisampled: Option<Multisampled>,
    sun: SunLight,
    sun_view: SunView,
    ground: Option<f32>,
    fade: [f32; 4],
}

/// What the shader is specialised for: a software device takes both sides of every branch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Kind {
    pattern: u32,
    ground: u32,
    textured: u32,
}

struct Draw {
    kind: Kind,
    texture: usize,
    first: u32,
    count: u32,
    push: Push,
}

/// A copy that `record_setup` makes.
enum Upload {
    Buffer { from: Buffer, to: vk::Buffer, bytes: u64 },
    Texture { from: Buffer, to: usize, sizes: Vec<(vk::Extent2D, u64)> },
}

/// The sun's orthographic view of everything that casts a shadow.
#[derive(Clone, Copy)]
struct SunView {
    clip: Mat4,
    /// World size of a texel.
    texel: f32,
}

impl SceneRenderer {
    /// Bakes the scene's light, makes pipelines, images and buffers. The depth convention is not
    /// fixed here: each record takes it from its camera. `antialias` smooths the edges; it costs
    /// little on a GPU, and on a software device several times the pass.
    ///
    /// # Errors
    /// A sun without direction; no memory; what Vulkan reports.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        color_format: vk::Format,
        depth_format: vk::Format,
        antialias: bool,
    ) -> Result<Self, Error> {
        let direction = Vec3::from(scene.sun.direction);
        let Some(direction) = direction.try_normalize() else {
            return Err(Error::bad("Scene.sun.direction", "not finite, or of no length"));
        };
        if !scene.sun.color.iter().all(|c| c.is_finite() && *c >= 0.0) {
            return Err(Error::bad("Scene.sun.color", "expected finite values of at least 0"));
        }
        let counts =
            gpu.limits.framebuffer_color_sample_counts & gpu.limits.framebuffer_depth_sample_counts;
        let many = antialias && counts.contains(SAMPLES);
        let samples = if many { SAMPLES } else { vk::SampleCountFlags::TYPE_1 };
        let shadow_pass = depth_only_pass(gpu, "scene/shadow", vk::Format::D32_SFLOAT)?;
        let depth_pass = depth_only_pass(gpu, "scene/depth", depth_format)?;
        let color_pass = color_pass(gpu, color_format, depth_format, samples)?;
        let one = vk::SampleCountFlags::TYPE_1;
        let depth_only = |pass, samples, bias| {
            let vertex = shader::HEADLESS_DEPTH_VERT;
            let (input, kind) = (Input::Positions, Kind::default());
            let has_color = pass == color_pass;
            let fragment = None;
            graphics(gpu, &Desc { vertex, fragment, pass, samples, input, bias, kind, has_color })
        };
        let shadow = depth_only(shadow_pass, one, true)?;
        let depth = depth_only(depth_pass, one, false)?;
        let depths =
            if samples == one { None } else { Some(depth_only(color_pass, samples, false)?) };
        let colored = |vertex, fragment, input, kind| {
            let (fragment, pass, bias) = (Some(fragment), color_pass, false);
            let has_color = true;
            graphics(gpu, &Desc { vertex, fragment, pass, samples, input, bias, kind, has_color })
        };
        let sky = colored(
            shader::HEADLESS_SKY_VERT,
            shader::HEADLESS_SKY_FRAG,
            Input::None,
            Kind::default(),
        )?;
        let irradiance = Pipeline::compute(gpu, shader::HEADLESS_IRRADIANCE_COMP, &[])?;

        let shadow_map = Image::new(
            gpu,
            &ImageDesc::new(
                "scene/shadow",
                vk::Extent2D { width: SHADOW_SIZE, height: SHADOW_SIZE },
                vk::Format::D32_SFLOAT,
                vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
            ),
        )?;
        let shadow_framebuffer =
            framebuffer(gpu, "scene/shadow", shadow_pass, &[shadow_map.view], shadow_map.extent)?;
        let (shadow_sampler, texture_sampler) = samplers(gpu)?;

        let baked = bake::bake(scene);
        let casters: u32 = baked.batches.iter().filter(|b| b.mesh.is_some()).map(|b| b.count).sum();
        let sun_view = SunView::new(scene, direction);
        let mut staging = Vec::new();
        let mut device = |name, bytes: &[u8], usage| -> Result<Buffer, Error> {
            let usage = usage | vk::BufferUsageFlags::TRANSFER_DST;
            let to = Buffer::new(gpu, name, bytes.len() as u64, usage, MemoryLocation::GpuOnly)?;
            if !bytes.is_empty() {
                let from = staged(gpu, bytes)?;
                staging.push(Upload::Buffer { from, to: to.handle, bytes: bytes.len() as u64 });
            }
            Ok(to)
        };
        let vertices = device(
            "scene/vertices",
            bytemuck::cast_slice(&baked.vertices),
            vk::BufferUsageFlags::VERTEX_BUFFER,
        )?;
        let indices = device(
            "scene/indices",
            bytemuck::cast_slice(&baked.indices),
            vk::BufferUsageFlags::INDEX_BUFFER,
        )?;
        let coefficients = Buffer::new(
            gpu,
            "scene/irradiance",
            9 * 16,
            vk::BufferUsageFlags::STORAGE_BUFFER,
            MemoryLocation::GpuOnly,
        )?;
        let mut textures = vec![];
        let white = Arc::new(Texture { width: 1, height: 1, data: vec![[255; 4]] });
        let mut known: BTreeMap<*const Texture, usize> = BTreeMap::new();
        let mut texture = |texture: &Arc<Texture>| -> Result<usize, Error> {
            if let Some(&index) = known.get(&Arc::as_ptr(texture)) {
                return Ok(index);
            }
            let index = textures.len();
            let (image, upload) = texture_image(gpu, texture, index)?;
            textures.push(image);
            staging.push(upload);
            known.insert(Arc::as_ptr(texture), index);
            Ok(index)
        };
        texture(&white)?;
        let mut draws: Vec<Draw> = Vec::new();
        let mut meshes = BTreeMap::new();
        for batch in &baked.batches {
            let material = match (batch.mesh, &scene.ground) {
                (Some(index), _) => &scene.meshes[index].material,
                (None, Some(ground)) => &ground.material,
                (None, None) => continue,
            };
            let texture = material.texture.as_ref().map_or(Ok(0), &mut texture)?;
            let mesh = batch.mesh.map(|index| &scene.meshes[index]);
            let draw = Draw::new(batch, texture, mesh, material);
            if let std::collections::btree_map::Entry::Vacant(entry) = meshes.entry(draw.kind) {
                entry.insert(colored(
                    shader::HEADLESS_SCENE_VERT,
                    shader::HEADLESS_SCENE_FRAG,
                    Input::All,
                    draw.kind,
                )?);
            }
            draws.push(draw);
        }
        // By pipeline; within one as the scene has them.
        draws.sort_by_key(|draw| draw.kind);
        let uniforms = (0..gpu.slots)
            .map(|_| {
                Buffer::new(
                    gpu,
                    "scene/uniforms",
                    size_of::<Uniforms>() as u64,
                    vk::BufferUsageFlags::UNIFORM_BUFFER,
                    MemoryLocation::CpuToGpu,
                )
            })
            .collect::<Result<_, _>>()?;
        let (low, high) = scene.bounds();
        let (centre, size) = (0.5 * (low + high), (high - low).length());
        let [begin, end] = bake::GROUND_FADE;
        Ok(Self {
            shadow_pass,
            depth_pass,
            color_pass,
            shadow,
            depth,
            depths,
            meshes,
            sky,
            irradiance,
            shadow_framebuffer,
            shadow_map,
            shadow_sampler,
            texture_sampler,
            coefficients,
            vertices,
            indices,
            casters,
            index_count: baked.indices.len() as u32,
            textures,
            draws,
            staging,
            uniforms,
            framebuffers: vec![[vk::Framebuffer::null(); 2]; gpu.slots as usize],
            samples,
            multisampled: None,
            sun: SunLight { direction: direction.to_array(), ..scene.sun },
            sun_view,
            ground: scene.ground.as_ref().map(|g| g.y),
            fade: [centre.x, centre.z, begin * size, end * size],
        })
    }

    /// How many descriptor sets a record takes.
    pub fn sets(&self) -> u32 {
        // Irradiance, sky, and one for each pipeline with each texture it draws with.
        let draws = self.draws.iter().map(|draw| (draw.kind, draw.texture));
        2 + draws.collect::<std::collections::BTreeSet<_>>().len() as u32
    }

    /// Records the uploads and the shadow map; submitted once, before any record.
    pub fn record_setup(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        gpu.begin_label(cmd, c"scene/setup");
        for upload in &self.staging {
            match upload {
                Upload::Buffer { from, to, bytes } => {
                    let region = [vk::BufferCopy::default().size(*bytes)];
                    // SAFETY: cmd is recording; both buffers have room for the region.
                    unsafe { gpu.device.cmd_copy_buffer(cmd, from.handle, *to, &region) };
                }
                Upload::Texture { from, to, sizes } => {
                    record_texture(gpu, cmd, from, &self.textures[*to], sizes);
                }
            }
        }
        gpu.barriers(
            cmd,
            &[access::image(&self.shadow_map, NOTHING, DEPTH_ATTACHMENT)],
            &[
                access::buffer(self.vertices.handle, COPY_WRITE, VERTEX_INPUT),
                access::buffer(self.indices.handle, COPY_WRITE, VERTEX_INPUT),
            ],
        );
        let area = self.shadow_map.extent.into();
        begin_pass(gpu, cmd, self.shadow_pass, self.shadow_framebuffer, area, 1.0);
        self.draw_depth(gpu, cmd, &self.shadow, self.sun_view.clip, 1.0, self.casters);
        // SAFETY: the pass was begun above.
        unsafe { gpu.device.cmd_end_render_pass(cmd) };
        gpu.barriers(
            cmd,
            &[access::image(&self.shadow_map, DEPTH_ATTACHMENT, FRAGMENT_SAMPLED)],
            &[],
        );
        gpu.end_label(cmd);
    }

    /// Frees what only `record_setup` needed. The GPU must be done with it.
    pub fn finish_setup(&mut self, gpu: &Gpu) {
        for upload in self.staging.drain(..) {
            match upload {
                Upload::Buffer { from, .. } | Upload::Texture { from, .. } => from.destroy(gpu),
            }
        }
    }

    /// Draws the scene: clears colour and depth and fills both.
    ///
    /// # Errors
    /// A camera that cannot be drawn, no memory, what Vulkan reports.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        frame: &SceneFrame<'_>,
    ) -> Result<(), Error> {
        let lens = Lens::new(frame.camera)?;
        let slot = frame.slot.0 as usize;
        if slot >= self.uniforms.len() {
            return Err(Error::bad(
                "SceneFrame.slot",
                format!("expected less than {}, found {slot}", self.uniforms.len()),
            ));
        }
        let extent = frame.color.extent;
        if extent != frame.depth.extent {
            return Err(Error::bad("SceneFrame.depth", "not of the colour image's size"));
        }
        gpu.begin_label(cmd, c"scene");
        // Depth of nothing: the end of the range that is farther away.
        let reversed = lens.linear.0 / (1.0 + lens.linear.1) < 1.001 * lens.near
            && lens.linear.0 / (1.0 + lens.linear.1) > 0.0;
        let far = if reversed { 0.0 } else { 1.0 };
        let uniforms = self.uniforms(&lens, frame.camera, far);
        let bytes = bytemuck::bytes_of(&uniforms);
        self.uniforms[slot].mapped_mut()[..bytes.len()].copy_from_slice(bytes);

        self.record_irradiance(gpu, cmd, frame)?;
        let targets = self.targets(gpu, frame, slot)?;
        let area = extent.into();
        begin_pass(gpu, cmd, self.depth_pass, targets[0], area, far);
        let clip = frame.camera.projection * frame.camera.view;
        self.draw_depth(gpu, cmd, &self.depth, clip, far, self.index_count);
        // SAFETY: the pass was begun above.
        unsafe { gpu.device.cmd_end_render_pass(cmd) };

        if let Some(images) = &self.multisampled {
            // Cleared each time; the frame before may still be at it.
            gpu.barriers(
                cmd,
                &[
                    access::raw_image(
                        images.color.handle,
                        vk::ImageAspectFlags::COLOR,
                        COLOR_ATTACHMENT.discarded(),
                        COLOR_ATTACHMENT,
                    ),
                    access::raw_image(
                        images.depth.handle,
                        vk::ImageAspectFlags::DEPTH,
                        DEPTH_ATTACHMENT.discarded(),
                        DEPTH_ATTACHMENT,
                    ),
                ],
                &[],
            );
        } else {
            // The colour pass tests against the depth of the pass before.
            let depth = access::image(frame.depth, DEPTH_ATTACHMENT, DEPTH_ATTACHMENT);
            gpu.barriers(cmd, &[depth], &[]);
        }
        begin_pass(gpu, cmd, self.color_pass, targets[1], area, far);
        if let Some(depths) = &self.depths {
            // The shading is dear: only what is seen is shaded.
            self.draw_depth(gpu, cmd, depths, clip, far, self.index_count);
        }
        let drawn = self.draw_color(gpu, cmd, frame, slot, far);
        // SAFETY: the pass was begun above.
        unsafe { gpu.device.cmd_end_render_pass(cmd) };
        gpu.end_label(cmd);
        drawn
    }

    fn uniforms(&self, lens: &Lens, camera: &Camera, far: f32) -> Uniforms {
        let world = lens.view.inverse();
        let turn = |v: Vec3| world.transform_vector3(v).extend(0.0).to_array();
        let p = lens.p;
        // World to uv: clip space of the sun is -1 to 1 with the same y down.
        let to_uv = Mat4::from_translation(Vec3::new(0.5, 0.5, 0.0))
            * Mat4::from_scale(Vec3::new(0.5, 0.5, 1.0));
        let sun = Vec3::from(self.sun.color);
        let disc = DISC.min(DISC_MOST / sun.max_element().max(1e-6));
        let texel = 1.0 / SHADOW_SIZE as f32;
        let shows = if self.ground.is_some() { 1.0 } else { 0.0 };
        Uniforms {
            clip: (camera.projection * camera.view).to_cols_array_2d(),
            shadow: (to_uv * self.sun_view.clip).to_cols_array_2d(),
            eye: world.transform_point3(Vec3::ZERO).extend(far).to_array(),
            ray_x: turn(Vec3::X / p.x),
            ray_y: turn(Vec3::Y / p.y),
            ray_z: turn(Vec3::new(p.z / p.x, p.w / p.y, -1.0)),
            sun_direction: Vec3::from(self.sun.direction).extend(shows).to_array(),
            sun_color: sun.extend(disc).to_array(),
            // No ground: nothing stands near it.
            shadow_texel: [texel, texel, self.sun_view.texel, self.ground.unwrap_or(-1e9)],
            ground: self.fade,
        }
    }

    fn record_irradiance(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        frame: &SceneFrame<'_>,
    ) -> Result<(), Error> {
        let buffer = self.coefficients.handle;
        gpu.barriers(cmd, &[], &[access::buffer(buffer, FRAGMENT_READ, COMPUTE_WRITE)]);
        let resources = self.resources(frame, 0);
        frame.descriptors.bind(gpu, cmd, &self.irradiance, &resources)?;
        // SAFETY: outside a render pass; pipeline and set are bound.
        unsafe { gpu.device.cmd_dispatch(cmd, 1, 1, 1) };
        gpu.barriers(cmd, &[], &[access::buffer(buffer, COMPUTE_WRITE, FRAGMENT_READ)]);
        Ok(())
    }

    fn resources(&self, frame: &SceneFrame<'_>, texture: usize) -> [(u32, Resource); 5] {
        [
            (0, Resource::buffer(&self.uniforms[frame.slot.0 as usize])),
            (1, Resource::Sampled(self.shadow_map.view, self.shadow_sampler)),
            (2, Resource::Sampled(frame.environment, frame.sampler)),
            (3, Resource::buffer(&self.coefficients)),
            (4, Resource::Sampled(self.textures[texture].view, self.texture_sampler)),
        ]
    }

    fn draw_depth(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        pipeline: &Pipeline,
        clip: Mat4,
        far: f32,
        count: u32,
    ) {
        if count == 0 {
            return;
        }
        pipeline.bind(gpu, cmd);
        self.bind_vertices(gpu, cmd, far);
        pipeline.push(gpu, cmd, &clip.to_cols_array());
        // SAFETY: inside a render pass; the indices are within the vertices.
        unsafe { gpu.device.cmd_draw_indexed(cmd, count, 1, 0, 0, 0) };
    }

    fn draw_color(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        frame: &SceneFrame<'_>,
        slot: usize,
        far: f32,
    ) -> Result<(), Error> {
        debug_assert_eq!(slot, frame.slot.0 as usize);
        self.bind_vertices(gpu, cmd, far);
        let mut sets: BTreeMap<(Kind, usize), vk::DescriptorSet> = BTreeMap::new();
        for draw in &self.draws {
            let Some(pipeline) = self.meshes.get(&draw.kind) else { continue };
            let set = match sets.get(&(draw.kind, draw.texture)) {
                Some(&set) => set,
                None => {
                    let resources = self.resources(frame, draw.texture);
                    let set = frame.descriptors.set(gpu, pipeline, &resources)?;
                    sets.insert((draw.kind, draw.texture), set);
                    set
                }
            };
            pipeline.bind(gpu, cmd);
            bind_set(gpu, cmd, pipeline, set);
            pipeline.push(gpu, cmd, &draw.push);
            // SAFETY: inside a render pass; the indices are within the vertices.
            unsafe { gpu.device.cmd_draw_indexed(cmd, draw.count, 1, draw.first, 0, 0) };
        }
        frame.descriptors.bind(gpu, cmd, &self.sky, &self.resources(frame, 0))?;
        self.set_compare(gpu, cmd, far);
        // SAFETY: inside a render pass; the sky has no vertex input.
        unsafe { gpu.device.cmd_draw(cmd, 3, 1, 0, 0) };
        Ok(())
    }

    fn bind_vertices(&self, gpu: &Gpu, cmd: vk::CommandBuffer, far: f32) {
        self.set_compare(gpu, cmd, far);
        // SAFETY: cmd is recording; the buffers live as long as self.
        unsafe {
            gpu.device.cmd_bind_vertex_buffers(cmd, 0, &[self.vertices.handle], &[0]);
            gpu.device.cmd_bind_index_buffer(cmd, self.indices.handle, 0, vk::IndexType::UINT32);
        }
    }

    fn set_compare(&self, gpu: &Gpu, cmd: vk::CommandBuffer, far: f32) {
        let nearer =
            if far == 0.0 { vk::CompareOp::GREATER_OR_EQUAL } else { vk::CompareOp::LESS_OR_EQUAL };
        // SAFETY: cmd is recording; dynamic in every pipeline here.
        unsafe { gpu.device.cmd_set_depth_compare_op(cmd, nearer) };
    }

    /// The slot's framebuffers, made anew: the views may have changed, and the slot is back.
    fn targets(
        &mut self,
        gpu: &Gpu,
        frame: &SceneFrame<'_>,
        slot: usize,
    ) -> Result<[vk::Framebuffer; 2], Error> {
        let extent = frame.color.extent;
        for old in &mut self.framebuffers[slot] {
            // SAFETY: the slot's earlier work is complete; null is allowed.
            unsafe { gpu.device.destroy_framebuffer(std::mem::take(old), None) };
        }
        if self.samples != vk::SampleCountFlags::TYPE_1
            && self.multisampled.as_ref().is_none_or(|images| images.extent != extent)
        {
            let new = Multisampled::new(
                gpu,
                extent,
                [frame.color.format, frame.depth.format],
                self.samples,
            )?;
            if let Some(old) = self.multisampled.replace(new) {
                // Another slot may still draw into it. A change of size is rare: wait.
                // SAFETY: live device.
                unsafe { gpu.device.device_wait_idle() }.context(|| "vkDeviceWaitIdle".into())?;
                old.destroy(gpu);
            }
        }
        let depth = framebuffer(gpu, "scene/depth", self.depth_pass, &[frame.depth.view], extent)?;
        self.framebuffers[slot][0] = depth;
        let views = match &self.multisampled {
            Some(images) => vec![images.color.view, images.depth.view, frame.color.view],
            None => vec![frame.color.view, frame.depth.view],
        };
        let color = framebuffer(gpu, "scene/color", self.color_pass, &views, extent)?;
        self.framebuffers[slot][1] = color;
        Ok(self.framebuffers[slot])
    }

    /// Frees everything. The GPU must be done with it.
    pub fn destroy(mut self, gpu: &Gpu) {
        self.finish_setup(gpu);
        // SAFETY: the caller guarantees that the GPU is done; null is allowed.
        unsafe {
            for framebuffer in self.framebuffers.iter().flatten() {
                gpu.device.destroy_framebuffer(*framebuffer, None);
            }
            gpu.device.destroy_framebuffer(self.shadow_framebuffer, None);
            for pass in [self.shadow_pass, self.depth_pass, self.color_pass] {
                gpu.device.destroy_render_pass(pass, None);
            }
            gpu.device.destroy_sampler(self.shadow_sampler, None);
            gpu.device.destroy_sampler(self.texture_sampler, None);
        }
        if let Some(images) = self.multisampled {
            images.destroy(gpu);
        }
        // Images, buffers and pipelines.
        drop((self.shadow_map, self.textures, self.uniforms, self.coefficients));
        drop((self.vertices, self.indices, self.shadow, self.depth, self.depths));
        drop((self.meshes, self.sky, self.irradiance));
        gpu.bury();
    }
}

impl Draw {
    fn new(batch: &Batch, texture: usize, mesh: Option<&Mesh>, material: &Material) -> Self {
        let (mut turn, mut origin) = (Quat::IDENTITY, Vec3::ZERO);
        if let Some(mesh) = mesh {
            let (_, rotation, translation) = mesh.transform.to_scale_rotation_translation();
            // A mesh that is not turned takes the world's frame: tiles go on round corners.
            if rotation.is_finite() && !rotation.is_near_identity() {
                (turn, origin) = (rotation.normalize(), translation);
            }
        }
        // The numbers of `scene.frag`.
        let (pattern, size, band) = match material.pattern {
            Pattern::Plain => (0, 1.0, None),
            Pattern::Tiles { size, band } => (1, size, band),
            Pattern::Planks { width } => (2, width, None),
            Pattern::Concrete => (3, 1.0, None),
            Pattern::Stone { course } => (4, course, None),
            Pattern::Sand => (5, 1.0, None),
            Pattern::Paving { size } => (6, size, None),
        };
        let [r, g, b] = material.base_color;
        Self {
            kind: Kind {
                pattern,
                ground: mesh.is_none().into(),
                textured: material.texture.is_some().into(),
            },
            texture,
            first: batch.first,
            count: batch.count,
            push: Push {
                turn: turn.to_array(),
                origin: origin.extend(0.0).to_array(),
                color: [r, g, b, material.roughness.clamp(0.05, 1.0)],
                pattern: [size.max(1e-4), band.unwrap_or(-1e6), 0.0, 0.0],
            },
        }
    }
}

impl SunView {
    fn new(scene: &Scene, direction: Vec3) -> Self {
        let up = if direction.y.abs() > 0.99 { Vec3::X } else { Vec3::Y };
        let view = Mat4::look_to_rh(Vec3::ZERO, -direction, up);
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for mesh in &scene.meshes {
            for &position in &mesh.positions {
                let at = mesh.transform.transform_point3(position.into());
                let at = view.transform_point3(at);
                if at.is_finite() {
                    low = low.min(at);
                    high = high.max(at);
                }
            }
        }
        if !low.is_finite() || !high.is_finite() {
            (low, high) = (Vec3::splat(-1.0), Vec3::ONE);
        }
        // Square texels, and room for the filter at the border, which is lit.
        let size = (high - low).truncate().max_element().max(1e-4);
        let half = Vec2::splat(0.5 * size * (1.0 + 16.0 / SHADOW_SIZE as f32));
        let centre = (0.5 * (low + high)).truncate();
        let margin = 0.01 * (high - low).length().max(1e-4);
        let clip = Mat4::orthographic_rh(
            centre.x - half.x,
            centre.x + half.x,
            centre.y - half.y,
            centre.y + half.y,
            -high.z - margin,
            -low.z + margin,
        ) * view;
        Self { clip, texel: 2.0 * half.x / SHADOW_SIZE as f32 }
    }
}

fn staged(gpu: &Gpu, bytes: &[u8]) -> Result<Buffer, Error> {
    let usage = vk::BufferUsageFlags::TRANSFER_SRC;
    let size = bytes.len() as u64;
    let mut buffer = Buffer::new(gpu, "scene/staging", size, usage, MemoryLocation::CpuToGpu)?;
    buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
    Ok(buffer)
}

/// The image of a texture, and the upload of its mips: boxes of texels, averaged in linear light.
fn texture_image(gpu: &Gpu, texture: &Texture, index: usize) -> Result<(Image, Upload), Error> {
    let (width, height) = (texture.width.max(1), texture.height.max(1));
    let most = gpu.limits.max_image_dimension2_d;
    if width > most || height > most || texture.data.len() != width as usize * height as usize {
        return Err(Error::bad(
            "Material.texture",
            format!("{width}x{height} with {} texels", texture.data.len()),
        ));
    }
    let to_linear = |v: u8| (f32::from(v) / 255.0).powf(2.2);
    let to_byte = |v: f32| (v.powf(1.0 / 2.2) * 255.0 + 0.5) as u8;
    let mut bytes: Vec<u8> = bytemuck::cast_slice(&texture.data).to_vec();
    let mut sizes = vec![(vk::Extent2D { width, height }, 0)];
    let mut level: Vec<Vec3> = texture
        .data
        .iter()
        .map(|c| Vec3::new(to_linear(c[0]), to_linear(c[1]), to_linear(c[2])))
        .collect();
    let (mut w, mut h) = (width as usize, height as usize);
    while w > 1 || h > 1 {
        let (nw, nh) = ((w / 2).max(1), (h / 2).max(1));
        let at = |x: usize, y: usize| level[y.min(h - 1) * w + x.min(w - 1)];
        let mut next = Vec::with_capacity(nw * nh);
        for y in 0..nh {
            for x in 0..nw {
                let sum = at(2 * x, 2 * y)
                    + at(2 * x + 1, 2 * y)
                    + at(2 * x, 2 * y + 1)
                    + at(2 * x + 1, 2 * y + 1);
                next.push(sum * 0.25);
            }
        }
        sizes.push((vk::Extent2D { width: nw as u32, height: nh as u32 }, bytes.len() as u64));
        bytes.extend(next.iter().flat_map(|c| [to_byte(c.x), to_byte(c.y), to_byte(c.z), 255]));
        (level, w, h) = (next, nw, nh);
    }
    let image = Image::new(
        gpu,
        &ImageDesc {
            mips: sizes.len() as u32,
            ..ImageDesc::new(
                "scene/texture",
                vk::Extent2D { width, height },
                vk::Format::R8G8B8A8_SRGB,
                vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            )
        },
    )?;
    Ok((image, Upload::Texture { from: staged(gpu, &bytes)?, to: index, sizes }))
}

fn record_texture(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    from: &Buffer,
    to: &Image,
    sizes: &[(vk::Extent2D, u64)],
) {
    gpu.barriers(cmd, &[access::image(to, NOTHING, COPY_WRITE)], &[]);
    let regions: Vec<_> = sizes
        .iter()
        .enumerate()
        .map(|(mip, &(extent, offset))| {
            vk::BufferImageCopy::default()
                .buffer_offset(offset)
                .image_subresource(vk::ImageSubresourceLayers {
                    aspect_mask: vk::ImageAspectFlags::COLOR,
                    mip_level: mip as u32,
                    base_array_layer: 0,
                    layer_count: 1,
                })
                .image_extent(extent.into())
        })
        .collect();
    // SAFETY: the image is in TRANSFER_DST_OPTIMAL; the buffer holds all mips.
    unsafe {
        gpu.device.cmd_copy_buffer_to_image(
            cmd,
            from.handle,
            to.handle,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
            &regions,
        );
    }
    gpu.barriers(cmd, &[access::image(to, COPY_WRITE, FRAGMENT_SAMPLED)], &[]);
}

fn samplers(gpu: &Gpu) -> Result<(vk::Sampler, vk::Sampler), Error> {
    let border = vk::SamplerAddressMode::CLAMP_TO_BORDER;
    let shadow = vk::SamplerCreateInfo::default()
        .mag_filter(vk::Filter::LINEAR)
        .min_filter(vk::Filter::LINEAR)
        .address_mode_u(border)
        .address_mode_v(border)
        .address_mode_w(border)
        .border_color(vk::BorderColor::FLOAT_OPAQUE_WHITE)
        .compare_enable(true)
        .compare_op(vk::CompareOp::LESS_OR_EQUAL);
    let texture = vk::SamplerCreateInfo::default()
        .mag_filter(vk::Filter::LINEAR)
        .min_filter(vk::Filter::LINEAR)
        .mipmap_mode(vk::SamplerMipmapMode::LINEAR)
        .max_lod(vk::LOD_CLAMP_NONE);
    let make = |info: &vk::SamplerCreateInfo<'_>, name: &str| -> Result<vk::Sampler, Error> {
        // SAFETY: valid create info.
        let sampler = unsafe { gpu.device.create_sampler(info, None) }
            .context(|| format!("vkCreateSampler {name}"))?;
        gpu.name(sampler, name);
        Ok(sampler)
    };
    Ok((make(&shadow, "scene/shadow")?, make(&texture, "scene/texture")?))
}

/// An attachment that is in one layout before, in and after its pass.
fn attachment(
    format: vk::Format,
    samples: vk::SampleCountFlags,
    load: vk::AttachmentLoadOp,
    store: vk::AttachmentStoreOp,
    layout: vk::ImageLayout,
) -> vk::AttachmentDescription {
    vk::AttachmentDescription::default()
        .format(format)
        .samples(samples)
        .load_op(load)
        .store_op(store)
        .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
        .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
        .initial_layout(layout)
        .final_layout(layout)
}

fn depth_only_pass(gpu: &Gpu, name: &str, format: vk::Format) -> Result<vk::RenderPass, Error> {
    let attachments = [attachment(
        format,
        vk::SampleCountFlags::TYPE_1,
        vk::AttachmentLoadOp::CLEAR,
        vk::AttachmentStoreOp::STORE,
        DEPTH_LAYOUT,
    )];
    let reference = vk::AttachmentReference { attachment: 0, layout: DEPTH_LAYOUT };
    let subpasses = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .depth_stencil_attachment(&reference)];
    create_pass(gpu, name, &attachments, &subpasses)
}

/// Multisampled: colour and depth that end with the pass, and the target it resolves to.
/// Single-sampled: the target, and its depth from the pass before.
fn color_pass(
    gpu: &Gpu,
    color_format: vk::Format,
    depth_format: vk::Format,
    samples: vk::SampleCountFlags,
) -> Result<vk::RenderPass, Error> {
    use vk::{AttachmentLoadOp as Load, AttachmentStoreOp as Store};
    let color_layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
    let one = vk::SampleCountFlags::TYPE_1;
    let many = samples != one;
    let store = if many { Store::DONT_CARE } else { Store::STORE };
    let load_depth = if many { Load::CLEAR } else { Load::LOAD };
    let mut attachments = vec![
        attachment(color_format, samples, Load::CLEAR, store, color_layout),
        attachment(depth_format, samples, load_depth, store, DEPTH_LAYOUT),
    ];
    if many {
        attachments.push(attachment(
            color_format,
            one,
            Load::DONT_CARE,
            Store::STORE,
            color_layout,
        ));
    }
    let color = [vk::AttachmentReference { attachment: 0, layout: color_layout }];
    let depth = vk::AttachmentReference { attachment: 1, layout: DEPTH_LAYOUT };
    let resolve = [vk::AttachmentReference { attachment: 2, layout: color_layout }];
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&color)
        .depth_stencil_attachment(&depth);
    if many {
        subpass = subpass.resolve_attachments(&resolve);
    }
    create_pass(gpu, "scene/color", &attachments, &[subpass])
}

fn create_pass(
    gpu: &Gpu,
    name: &str,
    attachments: &[vk::AttachmentDescription],
    subpasses: &[vk::SubpassDescription<'_>],
) -> Result<vk::RenderPass, Error> {
    let info = vk::RenderPassCreateInfo::default().attachments(attachments).subpasses(subpasses);
    // SAFETY: valid create info.
    let pass = unsafe { gpu.device.create_render_pass(&info, None) }
        .context(|| format!("vkCreateRenderPass {name}"))?;
    gpu.name(pass, name);
    Ok(pass)
}

fn framebuffer(
    gpu: &Gpu,
    name: &str,
    pass: vk::RenderPass,
    views: &[vk::ImageView],
    extent: vk::Extent2D,
) -> Result<vk::Framebuffer, Error> {
    let info = vk::FramebufferCreateInfo::default()
        .render_pass(pass)
        .attachments(views)
        .width(extent.width)
        .height(extent.height)
        .layers(1);
    // SAFETY: pass and views fit each other.
    let framebuffer = unsafe { gpu.device.create_framebuffer(&info, None) }
        .context(|| format!("vkCreateFramebuffer {name}"))?;
    gpu.name(framebuffer, name);
    Ok(framebuffer)
}

fn begin_pass(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    area: vk::Rect2D,
    depth: f32,
) {
    let depth = vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 } };
    // The depth-only passes take the first value, the colour pass the second: the sky covers
    // whatever its colour is cleared to.
    let clears = [depth, depth];
    let info = vk::RenderPassBeginInfo::default()
        .render_pass(pass)
        .framebuffer(framebuffer)
        .render_area(area)
        .clear_values(&clears);
    let viewport = vk::Viewport {
        x: 0.0,
        y: 0.0,
        width: area.extent.width as f32,
        height: area.extent.height as f32,
        min_depth: 0.0,
        max_depth: 1.0,
    };
    // SAFETY: cmd is recording outside a render pass; the objects are alive.
    unsafe {
        gpu.device.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
        gpu.device.cmd_set_viewport(cmd, 0, &[viewport]);
        gpu.device.cmd_set_scissor(cmd, 0, &[area]);
    }
}

#[derive(Clone, Copy)]
enum Input {
    None,
    Positions,
    All,
}

struct Desc {
    vertex: Shader,
    fragment: Option<Shader>,
    pass: vk::RenderPass,
    samples: vk::SampleCountFlags,
    input: Input,
    bias: bool,
    kind: Kind,
    has_color: bool,
}

/// A pipeline with a depth test whose direction is dynamic.
fn graphics(gpu: &Gpu, desc: &Desc) -> Result<Pipeline, Error> {
    let mut stages = vec![(desc.vertex, vk::ShaderStageFlags::VERTEX)];
    stages.extend(desc.fragment.map(|shader| (shader, vk::ShaderStageFlags::FRAGMENT)));
    let bindings = [vk::VertexInputBindingDescription {
        binding: 0,
        stride: size_of::<Vertex>() as u32,
        input_rate: vk::VertexInputRate::VERTEX,
    }];
    let attribute = |location, format, offset: usize| vk::VertexInputAttributeDescription {
        location,
        binding: 0,
        format,
        offset: offset as u32,
    };
    let three = vk::Format::R32G32B32_SFLOAT;
    let attributes = [
        attribute(0, three, std::mem::offset_of!(Vertex, position)),
        attribute(1, three, std::mem::offset_of!(Vertex, normal)),
        attribute(2, vk::Format::R32G32_SFLOAT, std::mem::offset_of!(Vertex, uv)),
        attribute(3, vk::Format::R32G32B32A32_SFLOAT, std::mem::offset_of!(Vertex, light)),
        // With `bulge` behind it.
        attribute(4, vk::Format::R32G32B32A32_SFLOAT, std::mem::offset_of!(Vertex, around)),
    ];
    let mut vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
    match desc.input {
        Input::None => {}
        Input::Positions => {
            vertex_input = vertex_input
                .vertex_binding_descriptions(&bindings)
                .vertex_attribute_descriptions(&attributes[..1]);
        }
        Input::All => {
            vertex_input = vertex_input
                .vertex_binding_descriptions(&bindings)
                .vertex_attribute_descriptions(&attributes);
        }
    }
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
        .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport =
        vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    // Both sides are drawn, in the shadow map too: winding is not trusted.
    let raster = vk::PipelineRasterizationStateCreateInfo::default()
        .cull_mode(vk::CullModeFlags::NONE)
        .depth_bias_enable(desc.bias)
        .depth_bias_slope_factor(1.5)
        .line_width(1.0);
    let multisample =
        vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(desc.samples);
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(true)
        .depth_compare_op(vk::CompareOp::LESS_OR_EQUAL);
    // Without a fragment shader nothing may be written; passes without colour ignore this.
    let mut write = no_blend();
    if desc.fragment.is_none() {
        write = write.color_write_mask(vk::ColorComponentFlags::empty());
    }
    let attachments = [write];
    let color = vk::PipelineColorBlendStateCreateInfo::default();
    let color = if desc.has_color { color.attachments(&attachments) } else { color };
    let dynamic_states =
        [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR, vk::DynamicState::DEPTH_COMPARE_OP];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);
    let info = vk::GraphicsPipelineCreateInfo::default()
        .vertex_input_state(&vertex_input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&color)
        .dynamic_state(&dynamic)
        .render_pass(desc.pass);
    let constants = [(0, desc.kind.pattern), (1, desc.kind.ground), (2, desc.kind.textured)];
    Pipeline::from_state(gpu, &stages, &constants, info)
}

/// Multisampled colour and depth, of the targets' size.
struct Multisampled {
    color: RawImage,
    depth: RawImage,
    extent: vk::Extent2D,
}

struct RawImage {
    handle: vk::Image,
    view: vk::ImageView,
    allocation: Allocation,
}

impl Multisampled {
    fn new(
        gpu: &Gpu,
        extent: vk::Extent2D,
        formats: [vk::Format; 2],
        samples: vk::SampleCountFlags,
    ) -> Result<Self, Error> {
        use vk::ImageUsageFlags as Usage;
        let (color, depth) = (Usage::COLOR_ATTACHMENT, Usage::DEPTH_STENCIL_ATTACHMENT);
        Ok(Self {
            color: RawImage::new(gpu, "scene/samples", extent, formats[0], color, samples)?,
            depth: RawImage::new(gpu, "scene/depths", extent, formats[1], depth, samples)?,
            extent,
        })
    }

    fn destroy(self, gpu: &Gpu) {
        self.color.destroy(gpu);
        self.depth.destroy(gpu);
    }
}

impl RawImage {
    fn new(
        gpu: &Gpu,
        name: &str,
        extent: vk::Extent2D,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
        samples: vk::SampleCountFlags,
    ) -> Result<Self, Error> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(extent.into())
            .mip_levels(1)
            .array_layers(1)
            .samples(samples)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage);
        // SAFETY: valid create info; the sample count was asked for.
        let handle = unsafe { gpu.device.create_image(&info, None) }
            .context(|| format!("vkCreateImage {name}"))?;
        // SAFETY: handle was just made.
        let requirements = unsafe { gpu.device.get_image_memory_requirements(handle) };
        let allocation = gpu.lock_allocator().allocate(&AllocationCreateDesc {
            name,
            requirements,
            location: MemoryLocation::GpuOnly,
            linear: false,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        });
        let allocation = match allocation {
            Ok(allocation) => allocation,
            Err(source) => {
                // SAFETY: nothing uses the image yet.
                unsafe { gpu.device.destroy_image(handle, None) };
                return Err(Error::Allocation { name: name.into(), source });
            }
        };
        let mut image = Self { handle, view: vk::ImageView::null(), allocation };
        // SAFETY: the allocation meets the image's requirements and is bound once.
        let bound = unsafe {
            gpu.device.bind_image_memory(
                handle,
                image.allocation.memory(),
                image.allocation.offset(),
            )
        };
        let view = bound
            .context(|| format!("vkBindImageMemory {name}"))
            .and_then(|()| gpu.view(handle, format, 1, 0, 1, name));
        match view {
            Ok(view) => {
                image.view = view;
                gpu.name(handle, name);
                Ok(image)
            }
            Err(error) => {
                image.destroy(gpu);
                Err(error)
            }
        }
    }

    fn destroy(self, gpu: &Gpu) {
        // SAFETY: the caller guarantees that the GPU is done; null is allowed.
        unsafe {
            gpu.device.destroy_image_view(self.view, None);
            gpu.device.destroy_image(self.handle, None);
        }
        // The only failure is a broken allocator; the memory then stays with it.
        let _ = gpu.lock_allocator().free(self.allocation);
    }
}
