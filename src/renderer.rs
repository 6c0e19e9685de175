//! The renderer of one view: owns the techniques and records them in order.

use std::sync::Arc;

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use crate::bubbles::{self, BubbleUniforms, Bubbles, near_sets};
use crate::check;
use crate::composite::{Composite, Surroundings};
use crate::context::Context;
use crate::contract::{Config, Count, Frame, HostImage, Layer, MemoryUse, Recorded, Slot};
use crate::diagnostics::{Diagnostics, SmoothingLevels};
use crate::environment::{Environment, EnvironmentSource};
use crate::error::Error;
use crate::frame::{FrameUniforms, Lens};
use crate::gpu::Gpu;
use crate::gpu::access::{self, COPY_READ, COPY_WRITE, FRAGMENT_SAMPLED, buffer};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::retire::RetireList;
use crate::gpu::timing::{Timer, Timing};
use crate::host_images::{Uses, acquire, depth_layout, depth_use, release, shadow_map, sunlight};
use crate::light::{Convolving, Light, Output, convolution, whitewater_sets};
use crate::shore::{Given, Shore, ShoreUniforms};
use crate::water::{Beside, Crowd, Recording, STREAM_USE, Water, buffers_of, shape_sets};
use crate::whitewater::Whitewater;
use crate::whitewater::streams::{self, Chunks};

/// Byte offset of the block of smoothing levels in a slot's uniform buffer. It is a multiple of 256, the largest
/// offset alignment that a device may require.
const LEVELS: usize = size_of::<FrameUniforms>().next_multiple_of(256);

/// Offset of the uniforms of bubble foam.
const BUBBLES: usize = (LEVELS + size_of::<SmoothingLevels>()).next_multiple_of(256);

/// Offset of the uniforms of shoreline and contact foam.
const SHORE: usize = (BUBBLES + size_of::<BubbleUniforms>()).next_multiple_of(256);

/// State of one frame in flight.
struct SlotState {
    descriptors: Descriptors,
    timer: Timer,
    uniforms: Buffer,
    /// Framebuffer of the last recorded frame's output.
    framebuffer: Option<Owned<vk::Framebuffer>>,
    /// Whether an environment was recorded with the slot since the slot was collected. The next frame of the slot
    /// must then not free the descriptor sets, which the environment uses.
    has_environment: bool,
    /// Whether the renderer's environment was recorded with the slot, which was not collected since.
    surrounds: bool,
}

/// Draws particle water into a host's frame. Each view has a renderer of its own. The crate documentation states the
/// contract with the host.
pub struct Renderer {
    gpu: Arc<Gpu>,
    config: Config,
    slots: Vec<SlotState>,
    retired: RetireList,
    /// False after a resize failed half-way.
    whole: bool,
    /// Whether the host has called `record_setup`, which fills resources that are read before they are written. Frames
    /// are refused before.
    set_up: bool,
    /// Whether an environment was recorded after it in a slot that has been collected since.
    surrounded: bool,
    water: Water,
    composite: Composite,
    light: Option<Light>,
    convolving: Option<Convolving>,
    foam: Option<Whitewater>,
    bubbles: Option<Bubbles>,
    shore: Option<Shore>,
    environment: Environment,
    /// Copy of the scene's colour, if it is the output itself.
    scene_copy: Option<Image>,
}

impl Renderer {
    /// Creates a renderer: allocates all memory for a configuration, and creates the pipelines that the context does
    /// not have yet.
    ///
    /// # Errors
    /// Bad configuration, missing features, no memory; Vulkan errors.
    pub fn new(context: &Context, config: &Config) -> Result<Self, Error> {
        check::config(config)?;
        context.shared.offer(config.output_format).check(config)?;
        let gpu = Gpu::new(context);
        let made = Parts::new(&gpu, config, (None, None)).and_then(|parts| {
            let environment = Environment::new(&gpu, config)?;
            let slots = (0..gpu.slots).map(|_| SlotState::new(&gpu, config));
            Ok((parts, environment, slots.collect::<Result<Vec<_>, _>>()?))
        });
        let (parts, environment, slots) = match made {
            Ok(made) => made,
            Err(error) => {
                // Nothing was submitted with the objects created before the failure.
                gpu.destroy();
                return Err(error);
            }
        };
        Ok(Self {
            gpu,
            config: *config,
            slots,
            retired: RetireList::default(),
            whole: true,
            set_up: false,
            surrounded: false,
            water: parts.water,
            composite: parts.composite,
            light: parts.light,
            convolving: parts.convolving,
            foam: parts.foam,
            bubbles: parts.bubbles,
            shore: parts.shore,
            environment,
            scene_copy: parts.scene_copy,
        })
    }

    /// Records the initial contents of resources that are read before they are written, and the precomputed data of
    /// bubble foam and shoreline foam. Call it once before the first `record`, and again if `reconfigure` returns
    /// true. It removes the environment, so call [`record_environment`](Self::record_environment) after it. It also
    /// replaces the host's foam texture ([`record_foam_texture`](Self::record_foam_texture)) by the built-in one.
    ///
    /// # Safety
    /// `cmd`, in which the set-up is recorded, is recording outside a render pass, and is submitted before every
    /// frame that is recorded after the set-up. The set-up belongs to no slot: its GPU work has to be complete before
    /// `resize` and `reconfigure`. This is certain once a frame that was recorded after it has finished.
    pub unsafe fn record_setup(&mut self, cmd: vk::CommandBuffer) {
        self.set_up = true;
        self.forget_environments();
        self.environment.record_setup(&self.gpu, cmd);
        if let Some(bubbles) = &self.bubbles {
            bubbles.record_setup(&self.gpu, cmd);
        }
        if let Some(shore) = &self.shore {
            shore.record_setup(&self.gpu, cmd);
        }
    }

    /// Records the conversion of an image of the host to the foam texture of shoreline and contact foam. The result
    /// replaces the built-in texture until the next [`record_setup`](Self::record_setup). The image has one channel,
    /// 1 where foam appears first and 0 where it appears last. It may have any size. Only its part `rect` is used;
    /// this part is repeated, so its opposite edges have to fit together.
    /// [`shore::texture::from_pattern`](crate::shore::texture::from_pattern) makes such an image from a pattern.
    ///
    /// # Errors
    /// [`Error::NotRecorded`] without a recorded set-up; [`Error::BadInput`] without [`Config::shore`] or for a bad image
    /// or slot; Vulkan errors.
    ///
    /// # Safety
    /// The conditions of [`record_environment`](Self::record_environment) hold. A foam texture counts as one of the
    /// four environments that may be recorded before the slot is collected.
    pub unsafe fn record_foam_texture(
        &mut self,
        cmd: vk::CommandBuffer,
        slot: Slot,
        image: &HostImage,
    ) -> Result<(), Error> {
        let index = self.slot_index(slot)?;
        check::image(check::fields!("web"), image)?;
        let Some(shore) = &self.shore else {
            return Err(Error::bad("Config.shore", "None, but a web is given"));
        };
        if !self.set_up {
            return Err(Error::NotRecorded { call: "Renderer::record_setup" });
        }
        self.retired.recorded(slot.0);
        self.slots[index].begin_environment(&self.gpu)?;
        shore.record_foam_texture(&self.gpu, cmd, &self.slots[index].descriptors, image)
    }

    /// Records the environment that the water reflects, once per environment, after
    /// [`record_setup`](Self::record_setup). Without one [`record`](Self::record) refuses frames; use
    /// [`EnvironmentSource::Black`] for no reflection.
    ///
    /// # Errors
    /// [`Error::NotRecorded`] without a recorded set-up; [`Error::BadInput`] for a bad slot or a bad number or
    /// direction in `source`; Vulkan errors.
    ///
    /// # Safety
    /// The conditions of [`record`](Self::record) hold; a frame may follow in the same slot and command buffer. At
    /// most four environments are recorded with a slot before it is collected.
    pub unsafe fn record_environment(
        &mut self,
        cmd: vk::CommandBuffer,
        slot: Slot,
        source: &EnvironmentSource,
    ) -> Result<(), Error> {
        let index = self.slot_index(slot)?;
        source.check()?;
        if !self.set_up {
            return Err(Error::NotRecorded { call: "Renderer::record_setup" });
        }
        self.retired.recorded(slot.0);
        self.slots[index].begin_environment(&self.gpu)?;
        self.environment.record(&self.gpu, cmd, &self.slots[index].descriptors, source)?;
        self.slots[index].surrounds = true;
        Ok(())
    }

    /// Records one frame: water over the scene, into the output.
    ///
    /// `record` never submits, waits, creates pipelines or allocates device memory. It records one acquire and one
    /// release barrier per host image. It finds every [`Error::BadInput`] before it records the first command.
    ///
    /// # Errors
    /// `record` returns [`Error::BadInput`] with the name of a bad field, and [`Error::NotRecorded`] if the set-up or
    /// an environment has not been recorded. It returns these two errors before it records any command. After any other
    /// error, discard the command buffer and call [`abandon`](Self::abandon).
    ///
    /// # Safety
    /// `cmd`, in which the frame is recorded, is a primary command buffer of the host's queue family. It is
    /// recording, outside a render pass, with no active query or conditional rendering. The frame's handles stay
    /// alive until the slot's GPU work is complete; the slot's earlier work is complete already. Command buffers are
    /// submitted to one queue in the order they were recorded.
    pub unsafe fn record(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: &Frame<'_>,
    ) -> Result<Recorded, Error> {
        // SAFETY: guaranteed by the caller.
        unsafe { self.record_frame(cmd, frame, None) }.map(|(recorded, _)| recorded)
    }

    /// Records a frame like [`record`](Self::record). With `read_back` the host reads the smoothing's occlusion
    /// queries back and decides when the smoothing ends, for which the frame is split into several command buffers.
    /// Returns what `record` returns, and the last of these command buffers.
    pub(crate) unsafe fn record_frame<'a>(
        &'a mut self,
        cmd: vk::CommandBuffer,
        frame: &Frame<'_>,
        read_back: Option<crate::water::ReadBack<'a>>,
    ) -> Result<(Recorded, vk::CommandBuffer), Error> {
        let index = self.slot_index(frame.slot)?;
        let lens = self.check_frame(frame)?;
        let gpu = &*self.gpu;
        let in_place = frame.in_place();
        let slot = &mut self.slots[index];
        slot.begin(gpu)?;
        let framebuffer =
            self.composite.framebuffer(gpu, frame.output.view, frame.output.extent)?;
        let target = framebuffer.as_ref().map_or(vk::Framebuffer::null(), |f| f.handle);
        slot.framebuffer = framebuffer;
        self.retired.recorded(frame.slot.0);
        let uniforms = FrameUniforms::new(&lens, frame, &self.config);
        let extent = frame.output.rect.extent;
        let levels =
            self.water.smoothing_levels(&self.config, &lens, extent, &frame.settings.water);
        let mapped = slot.uniforms.mapped_mut();
        mapped[..size_of::<FrameUniforms>()].copy_from_slice(bytemuck::bytes_of(&uniforms));
        mapped[LEVELS..][..size_of::<SmoothingLevels>()]
            .copy_from_slice(bytemuck::bytes_of(&levels));
        if let Some(bubbles) = &self.config.bubbles {
            let numbers = BubbleUniforms::new(frame, &self.config, bubbles);
            mapped[BUBBLES..][..size_of::<BubbleUniforms>()]
                .copy_from_slice(bytemuck::bytes_of(&numbers));
        }

        let mut general = false;
        if let Some(shore) = &self.shore {
            let numbers = ShoreUniforms::new(frame, &lens, shore.edges());
            mapped[SHORE..][..size_of::<ShoreUniforms>()]
                .copy_from_slice(bytemuck::bytes_of(&numbers));
            general = numbers.is_general(frame.scene_depth.rect.extent, extent);
        }

        gpu.begin_label(cmd, c"whitewater");
        slot.timer.reset(gpu, cmd);
        let depth_layout = depth_layout(&frame.scene_depth);
        let uses = Uses {
            in_place,
            depth: depth_use(depth_layout, self.config.spray),
            output: self.composite.output_use(),
            scene: self.composite.scene_use(),
            lit: self.light.is_some(),
            convolved: self.convolving.is_some(),
        };
        gpu.barriers(cmd, &acquire(frame, &uses), &[]);

        let scene_depth =
            Resource::SampledIn(frame.scene_depth.view, gpu.samplers.nearest, depth_layout);
        let uniforms = Resource::Buffer(slot.uniforms.handle, 0, size_of::<FrameUniforms>() as u64);
        let from = (self.light.as_ref(), self.convolving.as_ref());
        let handed_over = self.bubbles.as_ref().and_then(Bubbles::handed_over);
        let mut r = Recording {
            gpu,
            cmd,
            descriptors: &slot.descriptors,
            timer: &mut slot.timer,
            extent,
            uniforms,
            levels: Resource::Buffer(
                slot.uniforms.handle,
                LEVELS as u64,
                size_of::<SmoothingLevels>() as u64,
            ),
            bubbles: Resource::Buffer(
                slot.uniforms.handle,
                BUBBLES as u64,
                size_of::<BubbleUniforms>() as u64,
            ),
            shore: Resource::Buffer(
                slot.uniforms.handle,
                SHORE as u64,
                size_of::<ShoreUniforms>() as u64,
            ),
            shaped: frame.settings.whitewater.shaped(),
            crossfade: handed_over.map(|(_, over)| over),
            scene_depth,
            sunlight: sunlight(
                frame,
                (from.0, from.1, self.bubbles.as_ref()),
                gpu,
                (scene_depth, uniforms),
            ),
            read_back,
        };
        if let (Some(convolving), Some(shadow), Some(convolution)) =
            (&self.convolving, &frame.shadow, convolution(&self.config))
        {
            convolving.record(&mut r, &convolution, shadow, shadow_map(shadow, gpu))?;
        }
        let whitewater = self.foam.as_ref().map(|foam| (foam, frame.whitewater.as_ref()));
        let blobs = frame.bubbles.or(handed_over.map(|(blobs, _)| blobs));
        let bubbles = self.bubbles.as_ref().map(|bubbles| (bubbles, blobs.as_ref()));
        let beside = Beside {
            light: self.light.as_ref(),
            whitewater,
            bubbles,
            strand_ratio: frame.settings.spray.strand_ratio,
            crowd: Crowd {
                foam: frame.settings.surface_foam.few_neighbours,
                spray: frame.settings.spray.few_neighbours,
                // Below the density of pure spray; 0 would mark a particle that was just emitted.
                alone: (0.9
                    * frame.settings.spray.all_spray_density
                    * frame.settings.water.rest_density)
                    .max(f32::MIN_POSITIVE),
            },
        };
        self.water.record(&mut r, &frame.particles, &frame.settings.water, &beside)?;
        let given = Given::new(frame.shore.as_ref(), gpu);
        if let Some(shore) = &self.shore {
            shore.record_shoreline(&mut r, &given, general)?;
            if given.shore.is_some() && frame.settings.shore.contact.particle_opacity > 0.0 {
                shore.record_contact(&mut r, (&given, general), &self.water.layers())?;
            }
        }
        if let Some(foam) = &self.foam {
            let wet = !matches!(frame.particles.count, Count::Cpu(0));
            let layers = self.water.layers();
            foam.record_radiance(&mut r, &self.environment, wet.then_some(&layers))?;
        }
        if let Some(bubbles) = &self.bubbles {
            bubbles.record_soap(&mut r, &self.environment, &self.water.layers())?;
        }
        let scene_color = match (&self.scene_copy, &self.light) {
            (_, Some(light)) => {
                let output = Output {
                    view: frame.output.view,
                    image: frame.output.image,
                    aspect: frame.output.aspect,
                    target,
                    area: frame.output.rect,
                    before: uses.output_first(),
                    after: uses.output,
                };
                let sunlight = r.sunlight;
                light.record_lit(&mut r, &frame.scene_color, &output, &sunlight)?.view
            }
            (Some(copy), None) if in_place => {
                copy_scene(&mut r, &frame.output, copy, &uses);
                copy.view
            }
            _ => frame.scene_color.view,
        };
        self.composite.record(
            &mut r,
            &Surroundings {
                output: frame.output.view,
                target,
                area: frame.output.rect,
                scene_color: Resource::Sampled(scene_color, gpu.samplers.linear),
                environment: Resource::Sampled(self.environment.cube.view, gpu.samplers.linear),
            },
            &self.water.layers(),
            self.foam.as_ref(),
            self.bubbles.as_ref(),
            self.shore.as_ref(),
        )?;

        let cmd = r.cmd;
        let given_back = |handle| buffer(handle, STREAM_USE, frame.particles.after);
        let mut buffers: Vec<_> =
            buffers_of(&frame.particles).into_iter().map(given_back).collect();
        if let (Some(whitewater), Some(foam)) = (&frame.whitewater, &self.foam) {
            let back = |handle| buffer(handle, foam.reading(), whitewater.after);
            buffers.extend(streams::buffers_of(whitewater).into_iter().map(back));
        }
        if let (Some(blobs), Some(_)) = (&frame.bubbles, &self.bubbles) {
            let back = |handle| buffer(handle, bubbles::READING, blobs.after);
            buffers.extend(bubbles::buffers_of(blobs).into_iter().map(back));
        }
        gpu.barriers(cmd, &release(frame, &uses), &buffers);
        gpu.end_label(cmd);
        let recorded = Recorded {
            layers: kept(
                &self.config,
                &self.water,
                (self.foam.as_ref(), self.bubbles.as_ref(), self.shore.as_ref()),
                from,
                frame.output.rect.extent,
            ),
            diagnostics: Diagnostics {
                active_samples: self.water.query_results(),
                counts: Some(self.water.counts()),
                levels: Some(levels),
                tiles: Some(self.water.tiles()),
                sheets: self.water.boundaries(),
                shapes: self.water.shaped(),
                bubbles: self.bubbles.as_ref().map(Bubbles::layers),
                blobs: self.bubbles.as_ref().map(Bubbles::counts),
            },
        };
        Ok((recorded, cmd))
    }

    /// Times of the passes in the slot's last finished frame. The list is empty until the slot's first frame has
    /// finished, and always if the queue family has no timestamps. The call never waits: while a frame of the slot is
    /// still running, it returns the times of the slot's frame before. Call it not before the slot's first frame was
    /// submitted, and best after the wait for the slot's fence and before the next [`record`](Self::record) with the
    /// slot.
    pub fn timings(&mut self, slot: Slot) -> &[Timing] {
        match self.slots.get_mut(slot.0 as usize) {
            Some(state) => state.timer.timings(&self.gpu),
            None => &[],
        }
    }

    /// Tells the renderer that the slot's GPU work has finished. Frees objects that `resize` and `reconfigure`
    /// replaced, if no frame in flight uses them any more. Call it after waiting for the slot at the beginning of a
    /// frame.
    ///
    /// `collect` has no parameter for a fence or a timeline value: the caller promises that the slot's GPU work has
    /// finished. The library sees no submission, so it could not associate a fence or a value with one, and an engine
    /// that counts frames may have neither. A slot that never finishes only costs memory. Work in flight with other
    /// slots is not affected.
    ///
    /// # Safety
    /// All GPU work that was recorded with the slot to be collected is complete, or will never be submitted.
    pub unsafe fn collect(&mut self, slot: Slot) {
        if let Some(state) = self.slots.get_mut(slot.0 as usize) {
            state.has_environment = false;
            self.surrounded |= std::mem::take(&mut state.surrounds);
        }
        self.retired.collect(slot.0);
        self.gpu.bury();
    }

    /// Tells the renderer that the command buffer recorded last with this slot was discarded instead of submitted.
    /// Then does what [`collect`](Self::collect) does.
    ///
    /// # Safety
    /// The conditions of [`collect`](Self::collect) hold: the command buffer that was recorded last with the slot
    /// will never be submitted, and earlier work of the slot is complete.
    pub unsafe fn abandon(&mut self, slot: Slot) {
        if let Some(state) = self.slots.get_mut(slot.0 as usize) {
            state.timer.abandon();
            state.surrounds = false;
        }
        // SAFETY: guaranteed by the caller.
        unsafe { self.collect(slot) };
    }

    /// Number of retired objects that still wait for their slots.
    pub fn retired(&self) -> usize {
        self.retired.len()
    }

    /// Changes [`Config::extent`], the maximum size of a frame. Legal with frames in flight.
    ///
    /// # Errors
    /// A bad extent changes nothing. After any other error (no memory) `record` refuses frames until a `resize` or
    /// [`reconfigure`](Self::reconfigure) has succeeded.
    pub fn resize(&mut self, extent: vk::Extent2D) -> Result<(), Error> {
        let config = Config { extent, ..self.config };
        self.check_config(&config)?;
        // Frames are refused until all parts have the new size.
        self.whole = false;
        let result = self.resize_parts(&config);
        self.gpu.bury();
        result?;
        self.config = config;
        self.whole = true;
        Ok(())
    }

    fn resize_parts(&mut self, config: &Config) -> Result<(), Error> {
        let copy = Parts::scene_copy(&self.gpu, config)?;
        self.retired.replace(&mut self.scene_copy, copy);
        if let Some(light) = &mut self.light {
            light.resize(&self.gpu, config, &mut self.retired)?;
        }
        if let Some(foam) = &mut self.foam {
            foam.resize(&self.gpu, config, &mut self.retired)?;
        }
        if let Some(bubbles) = &mut self.bubbles {
            bubbles.resize(&self.gpu, config, &mut self.retired)?;
        }
        if let Some(shore) = &mut self.shore {
            shore.resize(&self.gpu, config, &mut self.retired)?;
        }
        self.water.resize(&self.gpu, config, &mut self.retired)
    }

    /// Changes the configuration: creates the new objects and retires the old ones. Legal with frames in flight.
    /// Returns true if the environment or the precomputed data of bubble foam or shoreline foam was recreated. Then
    /// [`record_setup`](Self::record_setup) and, because the environment is empty,
    /// [`record_environment`](Self::record_environment) are due before the next record.
    ///
    /// # Errors
    /// Those of [`Renderer::new`]; the renderer then keeps its old configuration.
    pub fn reconfigure(&mut self, config: &Config) -> Result<bool, Error> {
        self.check_config(config)?;
        let new = self.make_parts(config);
        self.gpu.bury();
        let (parts, environment, descriptors) = new?;
        let bubbles = parts.bubbles.as_ref();
        let same_bubbles = bubbles.is_none_or(|own| own.is_set_up_as(self.bubbles.as_ref()));
        let shore = parts.shore.as_ref();
        let same_shore = shore.is_none_or(|own| own.is_set_up_as(self.shore.as_ref()));
        let due = environment.is_some() || !same_bubbles || !same_shore;
        if due {
            self.set_up = false;
            self.forget_environments();
        }
        self.config = *config;
        self.whole = true;
        let retired = &mut self.retired;
        retired.replace(&mut self.water, parts.water);
        retired.replace(&mut self.composite, parts.composite);
        retired.replace(&mut self.light, parts.light);
        retired.replace(&mut self.convolving, parts.convolving);
        retired.replace(&mut self.foam, parts.foam);
        retired.replace(&mut self.bubbles, parts.bubbles);
        retired.replace(&mut self.shore, parts.shore);
        retired.replace(&mut self.scene_copy, parts.scene_copy);
        if let Some(new) = environment {
            retired.replace(&mut self.environment, new);
        }
        for (slot, new) in self.slots.iter_mut().zip(descriptors) {
            retired.replace(&mut slot.descriptors, new);
        }
        self.gpu.bury();
        Ok(due)
    }

    /// Creates the parts that a configuration needs. The environment is recreated only if its size or its use
    /// by foam changes.
    fn make_parts(
        &self,
        config: &Config,
    ) -> Result<(Parts, Option<Environment>, Vec<Descriptors>), Error> {
        let gpu = &*self.gpu;
        let parts = Parts::new(gpu, config, (self.bubbles.as_ref(), self.shore.as_ref()))?;
        let of = |config: &Config| (config.environment_size, Environment::is_sampled(config));
        let same_environment = of(config) == of(&self.config);
        let environment = (!same_environment).then(|| Environment::new(gpu, config)).transpose()?;
        let descriptors =
            (0..gpu.slots).map(|_| Descriptors::new(gpu, SlotState::sets(gpu, config)));
        Ok((parts, environment, descriptors.collect::<Result<_, _>>()?))
    }

    /// The current configuration.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Device memory in use.
    pub fn memory(&self) -> MemoryUse {
        let mut memory = self.water.memory();
        let light = self.light.as_ref().map(Light::memory);
        let convolving = self.convolving.as_ref().map(Convolving::memory);
        let foam = self.foam.as_ref().map(Whitewater::memory);
        let bubbles = self.bubbles.as_ref().map(Bubbles::memory);
        let shore = self.shore.as_ref().map(Shore::memory);
        let all = light.into_iter().chain(convolving).chain(foam).chain(bubbles).chain(shore);
        for (images, buffers) in all {
            memory.images += images;
            memory.buffers += buffers;
        }
        memory.images += self.environment.memory();
        memory.images += self.scene_copy.as_ref().map_or(0, |image| image.size);
        memory.buffers += self.slots.iter().map(|slot| slot.uniforms.size).sum::<u64>();
        memory
    }

    /// Frees everything. A plain drop is safe, but leaks.
    ///
    /// # Safety
    /// All recorded work is complete, or will never be submitted.
    pub unsafe fn destroy(self) {
        let gpu = self.gpu.clone();
        drop(self);
        gpu.destroy();
    }

    /// The environment's cube, for the stand-in scene.
    #[cfg(feature = "headless")]
    pub(crate) fn environment_view(&self) -> vk::ImageView {
        self.environment.cube.view
    }

    fn slot_index(&self, slot: Slot) -> Result<usize, Error> {
        let index = slot.0 as usize;
        if index < self.slots.len() {
            Ok(index)
        } else {
            Err(Error::bad(
                "Frame.slot",
                format!(
                    "expected less than {} (the frames in flight), found {index}",
                    self.slots.len()
                ),
            ))
        }
    }

    fn check_config(&self, config: &Config) -> Result<(), Error> {
        check::config(config)?;
        self.gpu.offer(config.output_format).check(config)
    }

    /// Makes an environment due.
    fn forget_environments(&mut self) {
        self.surrounded = false;
        self.slots.iter_mut().for_each(|slot| slot.surrounds = false);
    }

    /// Validates a frame.
    fn check_frame(&self, frame: &Frame<'_>) -> Result<Lens, Error> {
        if !self.whole {
            return Err(Error::bad("Renderer", "its last resize failed: call resize again first"));
        }
        let lens = check::frame(frame, &self.config, &self.gpu.limits)?;
        let surrounded = self.surrounded || self.slots.iter().any(|slot| slot.surrounds);
        for (recorded, call) in
            [(self.set_up, "Renderer::record_setup"), (surrounded, "Renderer::record_environment")]
        {
            if !recorded {
                return Err(Error::NotRecorded { call });
            }
        }
        Ok(lens)
    }
}

/// Parts that every change of the configuration recreates.
struct Parts {
    water: Water,
    composite: Composite,
    light: Option<Light>,
    convolving: Option<Convolving>,
    foam: Option<Whitewater>,
    bubbles: Option<Bubbles>,
    shore: Option<Shore>,
    scene_copy: Option<Image>,
}

impl Parts {
    /// `before` are the previous parts; those that still fit are kept.
    fn new(
        gpu: &Gpu,
        config: &Config,
        before: (Option<&Bubbles>, Option<&Shore>),
    ) -> Result<Self, Error> {
        let bubbles = config.bubbles.map(|own| Bubbles::new(gpu, config, &own, before.0));
        let shore = config.shore.map(|own| Shore::new(gpu, config, &own, before.1));
        Ok(Self {
            water: Water::new(gpu, config)?,
            composite: Composite::new(gpu, config)?,
            light: Self::light(gpu, config)?,
            convolving: Self::convolving(gpu, config)?,
            foam: config
                .whitewater
                .map(|whitewater| Whitewater::new(gpu, config, &whitewater))
                .transpose()?,
            bubbles: bubbles.transpose()?,
            shore: shore.transpose()?,
            scene_copy: Self::scene_copy(gpu, config)?,
        })
    }

    fn light(gpu: &Gpu, config: &Config) -> Result<Option<Light>, Error> {
        config.light_map_size.map(|edge| Light::new(gpu, config, edge)).transpose()
    }

    fn convolving(gpu: &Gpu, config: &Config) -> Result<Option<Convolving>, Error> {
        convolution(config).map(|convolution| Convolving::new(gpu, &convolution)).transpose()
    }

    fn scene_copy(gpu: &Gpu, config: &Config) -> Result<Option<Image>, Error> {
        // The lit scene replaces the copy.
        if !config.in_place || config.light_map_size.is_some() {
            return Ok(None);
        }
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc::new("scene copy", config.extent, config.output_format, usage);
        Image::new(gpu, &desc).map(Some)
    }
}

impl SlotState {
    fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        Ok(Self {
            descriptors: Descriptors::new(gpu, Self::sets(gpu, config))?,
            timer: Timer::new(gpu)?,
            uniforms: Buffer::new(
                gpu,
                "slot/uniforms",
                (SHORE + size_of::<ShoreUniforms>()) as u64,
                vk::BufferUsageFlags::UNIFORM_BUFFER,
                MemoryLocation::CpuToGpu,
            )?,
            framebuffer: None,
            has_environment: false,
            surrounds: false,
        })
    }

    /// Number of descriptor sets of a slot: a few for each pass, and for passes over particles some for each chunk of
    /// particles.
    fn sets(gpu: &Gpu, config: &Config) -> u32 {
        let whitewater =
            config.whitewater.map_or(0, |whitewater| Chunks::new(&gpu.limits, &whitewater).count);
        let water = crate::water::chunks(&gpu.limits, config).1;
        let near = config.whitewater.filter(|_| config.bubbles.is_some_and(|own| own.crossfade));
        let near = near.map_or(0, |whitewater| near_sets(&gpu.limits, &whitewater));
        149 + shape_sets(config, water)
            + 27 * water
            + 4 * whitewater
            + near
            + whitewater_sets(&gpu.limits, config)
    }

    /// Begins a frame. The slot's earlier work is complete, so its framebuffer is freed, and so are its descriptor
    /// sets, unless an environment was just recorded with them.
    fn begin(&mut self, gpu: &Gpu) -> Result<(), Error> {
        self.framebuffer = None;
        // This list only holds framebuffers: objects with memory are dropped by `collect`, which empties the deletion
        // queue.
        gpu.bury();
        if std::mem::take(&mut self.has_environment) {
            return Ok(());
        }
        self.descriptors.reset(gpu)
    }

    /// Begins an environment, which may share the slot with the following frame.
    fn begin_environment(&mut self, gpu: &Gpu) -> Result<(), Error> {
        if std::mem::replace(&mut self.has_environment, true) {
            return Ok(());
        }
        self.descriptors.reset(gpu)
    }
}

/// The layers of a frame of this size, for the host.
fn kept(
    config: &Config,
    water: &Water,
    (foam, bubbles, shore): (Option<&Whitewater>, Option<&Bubbles>, Option<&Shore>),
    (light, convolving): (Option<&Light>, Option<&Convolving>),
    size: vk::Extent2D,
) -> Vec<Layer> {
    let mut layers = Vec::new();
    if config.keep_layers {
        layers = water.kept(size, FRAGMENT_SAMPLED);
        layers.extend(light.into_iter().flat_map(Light::layers));
        layers.extend(convolving.map(Convolving::layer));
        layers.extend(foam.into_iter().flat_map(|foam| foam.kept(size)));
        layers.extend(bubbles.into_iter().flat_map(|bubbles| bubbles.kept(size)));
        layers.extend(shore.map(|shore| shore.kept(size)));
    }
    layers.extend(water.motion(size));
    layers
}

/// Pass `scene`: copies the scene from the output, so that it can be sampled while the output is written. The
/// output is in TRANSFER_SRC_OPTIMAL before, and in the state that `composite` expects after.
fn copy_scene(r: &mut Recording<'_>, output: &HostImage, copy: &Image, uses: &Uses) {
    let scope = r.begin(c"scene");
    let (gpu, cmd) = (r.gpu, r.cmd);
    gpu.barriers(cmd, &[access::image(copy, uses.scene.discarded(), COPY_WRITE)], &[]);
    let layers = vk::ImageSubresourceLayers {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        mip_level: 0,
        base_array_layer: 0,
        layer_count: 1,
    };
    let from = output.rect.offset;
    let region = vk::ImageCopy::default()
        .src_subresource(layers)
        .src_offset(vk::Offset3D { x: from.x, y: from.y, z: 0 })
        .dst_subresource(layers)
        .extent(output.rect.extent.into());
    // SAFETY: both images are in their transfer layouts and of one format and size.
    unsafe {
        gpu.device.cmd_copy_image(
            cmd,
            output.image,
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            copy.handle,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
            &[region],
        );
    }
    gpu.barriers(
        cmd,
        &[
            access::image(copy, COPY_WRITE, uses.scene),
            access::raw_image(output.image, output.aspect, COPY_READ, uses.output),
        ],
        &[],
    );
    r.end(scope);
}
