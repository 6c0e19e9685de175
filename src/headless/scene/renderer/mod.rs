//! Pass `scene`: opaque meshes, ground and sky under a sun with a shadow map.
//!
//! In the set-up, [`geometry`] and [`textures`] are uploaded, and [`shadow`] draws the shadow map. In each frame,
//! [`irradiance`] projects the environment's light, [`depth`] draws the depth that the water is tested against, with
//! one sample per pixel, and [`color`] draws [`meshes`] and [`sky`], with four samples if requested and supported.
//! [`targets`] holds the images and framebuffers that these passes draw to, [`uniforms`] and [`sea`] the shaders'
//! data on the view and the sea, and [`opaque`] the pipeline state that the passes share.
//! Reads: vertices, shadow map, environment. Writes: the whole scene colour and depth.

mod color;
mod depth;
mod geometry;
mod irradiance;
mod meshes;
mod opaque;
mod sea;
mod shadow;
mod sky;
mod targets;
mod textures;
mod uniforms;

use std::sync::Arc;

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::Scene;
use super::bake::{self, Baked};
use crate::contract::{Camera, Slot};
use crate::error::Error;
use crate::frame::Lens;
use crate::gpu::Gpu;
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::image::Image;
use color::Color;
use depth::Depth;
use geometry::Geometry;
use irradiance::Irradiance;
use opaque::View;
use shadow::Shadow;
use targets::Targets;
use textures::Textures;
use uniforms::{Surroundings, Uniforms};

/// Inputs of one record.
#[derive(Clone, Copy)]
pub struct SceneFrame<'a> {
    /// The slot; its earlier work is complete.
    pub slot: Slot,
    /// The slot's descriptor sets, with room for [`SceneRenderer::sets`].
    pub descriptors: &'a Descriptors,
    /// The camera.
    pub camera: &'a Camera,
    /// Colour target in COLOR_ATTACHMENT_OPTIMAL, before and after.
    pub color: &'a Image,
    /// Depth target in DEPTH_STENCIL_ATTACHMENT_OPTIMAL, before and after.
    pub depth: &'a Image,
    /// Cube map of the environment that is seen as sky and in reflections, with mips, in SHADER_READ_ONLY_OPTIMAL.
    /// The caller has made its last write visible to compute and fragment shaders by a barrier.
    pub environment: vk::ImageView,
    /// Cube map like `environment`, but without the sun, for lighting the scene; `None` if `environment` contains no
    /// sun.
    pub without_sun: Option<vk::ImageView>,
    /// A sampler that is linear between texels and between mips.
    pub sampler: vk::Sampler,
}

/// Draws the scene.
pub struct SceneRenderer {
    surroundings: Surroundings,
    /// The baked light, shared by renderers of the same scene in other frames.
    pub(in crate::headless) baked: Arc<Baked>,
    geometry: Geometry,
    textures: Textures,
    shadow: Shadow,
    irradiance: Irradiance,
    depth: Depth,
    color: Color,
    slots: Vec<SlotState>,
}

/// State that frames in flight do not share.
struct SlotState {
    uniforms: Buffer,
    /// Targets of the last record.
    targets: Option<Targets>,
}

/// Formats of the frame's images.
#[derive(Clone, Copy)]
struct Formats {
    color: vk::Format,
    depth: vk::Format,
}

/// Arguments that the passes of one record share.
struct Recording<'a> {
    gpu: &'a Gpu,
    cmd: vk::CommandBuffer,
    descriptors: &'a Descriptors,
    geometry: &'a Geometry,
    textures: &'a Textures,
    view: View,
    /// The whole frame.
    area: vk::Rect2D,
    /// What shaders of the scene read, except the texture.
    resources: [(u32, Resource); 6],
}

impl Recording<'_> {
    /// Everything that shaders of the scene read, with this texture.
    fn resources(&self, texture: usize) -> [(u32, Resource); 7] {
        let [a, b, c, d, e, f] = self.resources;
        [a, b, c, d, (4, self.textures.resource(texture)), e, f]
    }
}

impl SceneRenderer {
    /// Bakes the scene's light and creates pipelines, images and buffers. Each record takes the depth convention from
    /// its camera. `antialias` smooths edges; it costs little on a GPU, but makes the pass several times slower on a
    /// Vulkan device that runs on the CPU. After an error the next `Gpu::bury` frees the objects.
    ///
    /// # Errors
    /// A device that has neither Vulkan 1.3 nor VK_EXT_extended_dynamic_state enabled; a sun without direction or with
    /// a negative colour; an invalid sea, haze, metre, cloud strength or splashed
    /// rectangle; a texture that the device cannot hold; no memory; Vulkan errors.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        color_format: vk::Format,
        depth_format: vk::Format,
        antialias: bool,
    ) -> Result<Self, Error> {
        let baked = Arc::new(bake::bake(scene));
        Self::with_light(gpu, scene, &baked, color_format, depth_format, antialias)
    }

    /// Like [`SceneRenderer::new`], but with light that is already baked: that of a renderer of the same scene,
    /// whichever frame of the animation it draws.
    ///
    /// # Errors
    /// Those of [`SceneRenderer::new`].
    pub(in crate::headless) fn with_light(
        gpu: &Gpu,
        scene: &Scene,
        baked: &Arc<Baked>,
        color_format: vk::Format,
        depth_format: vk::Format,
        antialias: bool,
    ) -> Result<Self, Error> {
        if gpu.depth_compare.is_none() {
            return Err(Error::Missing {
                what: "vkCmdSetDepthCompareOp".into(),
                why: "the scene needs Vulkan 1.3 or VK_EXT_extended_dynamic_state".into(),
            });
        }
        let formats = Formats { color: color_format, depth: depth_format };
        let surroundings = Surroundings::new(scene)?;
        let mut textures = Textures::new(gpu)?;
        let color = Color::new(gpu, scene, &baked.batches, &mut textures, formats, antialias)?;
        let slot = |_| {
            let (name, size) = ("scene/uniforms", size_of::<Uniforms>() as u64);
            let usage = vk::BufferUsageFlags::UNIFORM_BUFFER;
            let uniforms = Buffer::new(gpu, name, size, usage, MemoryLocation::CpuToGpu)?;
            Ok(SlotState { uniforms, targets: None })
        };
        Ok(Self {
            geometry: Geometry::new(gpu, scene, baked)?,
            baked: Arc::clone(baked),
            textures,
            shadow: Shadow::new(gpu, scene, surroundings.to_sun)?,
            irradiance: Irradiance::new(gpu)?,
            depth: Depth::new(gpu, formats.depth)?,
            color,
            slots: (0..gpu.slots).map(slot).collect::<Result<_, Error>>()?,
            surroundings,
        })
    }

    /// Sets the time of the scene, if only the sea has moved.
    ///
    /// # Errors
    /// An invalid time.
    pub(in crate::headless) fn sea_at(&mut self, scene: &Scene) -> Result<(), Error> {
        self.surroundings.move_sea(scene)
    }

    /// The sun's shadow map in the form in which a host engine passes its own. `bias` is the depth bias in
    /// world units, to which the width of a texel is added.
    pub fn shadow(&self, bias: f32) -> crate::contract::Shadow {
        self.shadow.handed_over(bias)
    }

    /// Number of descriptor sets for a record.
    pub fn sets(&self) -> u32 {
        // Irradiance, sky, meshes.
        2 + self.color.meshes.sets()
    }

    /// Records the uploads and the shadow map; submitted once, before any record.
    pub fn record_setup(&self, gpu: &Gpu, cmd: vk::CommandBuffer) {
        gpu.begin_label(cmd, c"scene/setup");
        self.geometry.record_upload(gpu, cmd);
        self.textures.record_upload(gpu, cmd);
        self.shadow.record(gpu, cmd, &self.geometry);
        gpu.end_label(cmd);
    }

    /// Frees the objects that only `record_setup` needed. The GPU must have finished with them.
    pub fn finish_setup(&mut self, gpu: &Gpu) {
        self.geometry.uploaded();
        self.textures.uploaded();
        gpu.bury();
    }

    /// Clears the frame's colour and depth images and draws the scene to them. It creates framebuffers for that. Those
    /// of the slot's previous record go to the deletion queue, which the next `Gpu::bury` empties. So do the slot's
    /// multisampled images, but only if the size of the frame has changed; otherwise they are used again.
    ///
    /// # Errors
    /// A camera that cannot be drawn, a slot that does not exist, colour and depth images of different sizes, no
    /// memory; Vulkan errors.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        frame: &SceneFrame<'_>,
    ) -> Result<(), Error> {
        let lens = Lens::new(frame.camera)?;
        let (index, slots) = (frame.slot.0 as usize, self.slots.len());
        let Some(slot) = self.slots.get_mut(index) else {
            let why = format!("expected less than {slots}, found {index}");
            return Err(Error::bad("SceneFrame.slot", why));
        };
        if frame.color.extent != frame.depth.extent {
            return Err(Error::bad("SceneFrame.depth", "not of the colour image's size"));
        }
        let (far, extent) = (lens.nothing(), frame.color.extent);
        let mut uniforms =
            Uniforms::new(&self.surroundings, &self.shadow.sun, frame.camera, &lens, far, extent);
        if frame.without_sun.is_some() {
            uniforms.hide_sun();
        }
        let bytes = bytemuck::bytes_of(&uniforms);
        slot.uniforms.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
        let earlier = slot.targets.take().and_then(|targets| targets.samples);
        let targets = Targets::new(gpu, frame, &self.depth, &self.color, earlier)?;
        let targets = slot.targets.insert(targets);

        let r = Recording {
            gpu,
            cmd,
            descriptors: frame.descriptors,
            geometry: &self.geometry,
            textures: &self.textures,
            view: View { clip: frame.camera.projection() * frame.camera.view(), far },
            area: frame.color.extent.into(),
            resources: [
                (0, Resource::buffer(&slot.uniforms)),
                (1, self.shadow.resource()),
                (
                    2,
                    Resource::Sampled(
                        frame.without_sun.unwrap_or(frame.environment),
                        frame.sampler,
                    ),
                ),
                (3, self.irradiance.resource()),
                (5, Resource::Sampled(frame.environment, frame.sampler)),
                (6, self.shadow.depths()),
            ],
        };
        gpu.begin_label(cmd, c"scene");
        let drawn = self.irradiance.record(&r).and_then(|()| {
            self.depth.record(&r, targets.depth.handle);
            self.color.record(&r, targets, frame.depth)
        });
        gpu.end_label(cmd);
        drawn
    }

    /// Frees everything. The GPU must have finished with it.
    pub fn destroy(self, gpu: &Gpu) {
        drop(self);
        gpu.bury();
    }
}
