//! The renderer of one view: owns the techniques and records them in order.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;

use crate::composite::{Composite, Surroundings};
use crate::contract::{
    Config, Count, Frame, Host, HostImage, MemoryUse, Particles, Recorded, Slot, Stream,
};
use crate::environment::{Environment, EnvironmentSource};
use crate::error::Error;
use crate::frame::{FrameUniforms, Lens, check_settings};
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, COMPUTE_READ, COPY_READ, COPY_WRITE, FRAGMENT_SAMPLED, buffer,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource};
use crate::gpu::graveyard::Owned;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::requirements::Offer;
use crate::gpu::retire::RetireList;
use crate::gpu::timing::{Timer, Timing};
use crate::light::{Light, Output, Sunlight};
use crate::water::settings::Shadows;
use crate::water::{Recording, Water};

/// What one frame in flight owns.
struct SlotState {
    descriptors: Descriptors,
    timer: Timer,
    uniforms: Buffer,
    /// The output's framebuffer of the frame recorded last.
    framebuffer: Option<Owned<vk::Framebuffer>>,
    /// The environment was recorded with the slot since it came back: its sets must stay.
    has_environment: bool,
}

/// Draws particle water into a host's frame. One per view; see the crate's documentation for the
/// contract.
pub struct Renderer {
    gpu: Arc<Gpu>,
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    config: Config,
    slots: Vec<SlotState>,
    retired: RetireList,
    /// False while a resize has failed half-way.
    whole: bool,
    water: Water,
    composite: Composite,
    light: Option<Light>,
    environment: Environment,
    /// Copy of the scene's colour, when it is the output itself.
    scene_copy: Option<Image>,
}

impl Renderer {
    /// Makes all pipelines and memory for a configuration.
    ///
    /// # Errors
    /// Bad configuration, missing features, no memory, and what Vulkan reports.
    ///
    /// # Safety
    /// The host's handles are alive, belong together, and outlive the renderer; what
    /// [`Enabled`](crate::Enabled) and [`requirements`](crate::requirements) name is enabled.
    pub unsafe fn new(host: &Host<'_>, config: &Config) -> Result<Self, Error> {
        check_config(config)?;
        Offer::of(host.instance, host.physical_device, config.output_format).check(config)?;
        let gpu = Gpu::new(host)?;
        let made = Parts::new(&gpu, config).and_then(|parts| {
            let slots = (0..gpu.slots).map(|_| SlotState::new(&gpu, config));
            Ok((parts, slots.collect::<Result<Vec<_>, _>>()?))
        });
        let (parts, slots) = match made {
            Ok(made) => made,
            Err(error) => {
                // Nothing was submitted with what was made before the failure.
                gpu.destroy();
                return Err(error);
            }
        };
        Ok(Self {
            instance: host.instance.clone(),
            physical_device: host.physical_device,
            gpu,
            config: *config,
            slots,
            retired: RetireList::default(),
            whole: true,
            water: parts.water,
            composite: parts.composite,
            light: parts.light,
            environment: parts.environment,
            scene_copy: parts.scene_copy,
        })
    }

    /// Records the first contents of what is read before it is written. Once, before the first
    /// `record`; again after `reconfigure`.
    ///
    /// # Safety
    /// `cmd` is recording outside a render pass and is submitted before any `record`.
    pub unsafe fn record_setup(&mut self, cmd: vk::CommandBuffer) {
        self.environment.record_setup(&self.gpu, cmd);
    }

    /// Records the environment that the water reflects, once per environment.
    ///
    /// # Errors
    /// What Vulkan reports; a bad slot.
    ///
    /// # Safety
    /// As [`record`](Self::record), with which it may share a slot and a command buffer if it
    /// comes before it there; at most four before the slot is collected.
    pub unsafe fn record_environment(
        &mut self,
        cmd: vk::CommandBuffer,
        slot: Slot,
        source: &EnvironmentSource,
    ) -> Result<(), Error> {
        let index = self.slot_index(slot)?;
        self.retired.recorded(slot.0);
        self.slots[index].begin_environment(&self.gpu)?;
        self.environment.record(&self.gpu, cmd, &self.slots[index].descriptors, source)
    }

    /// Records one frame: water over the scene, into the output.
    ///
    /// Never submits, waits, creates pipelines or allocates device memory. One acquire and one
    /// release barrier per host image. Every [`Error::BadInput`] is found before the first command.
    ///
    /// # Errors
    /// [`Error::BadInput`] with the field; after any other error discard the command buffer.
    ///
    /// # Safety
    /// `cmd` is a primary command buffer of the host's queue family, recording, outside a render
    /// pass, with no active query or conditional rendering; the frame's handles are alive until
    /// the slot comes back; the slot's earlier work is complete; command buffers are submitted to
    /// one queue in the order they were recorded.
    pub unsafe fn record(
        &mut self,
        cmd: vk::CommandBuffer,
        frame: &Frame<'_>,
    ) -> Result<Recorded, Error> {
        // SAFETY: the caller's promises, passed on.
        unsafe { self.record_frame(cmd, frame, None) }.map(|(recorded, _)| recorded)
    }

    /// [`record`](Self::record), where the smoothing may be ended by the host's look at the
    /// queries; also returns the command buffer that was recorded last.
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
        slot.uniforms.mapped_mut()[..size_of::<FrameUniforms>()]
            .copy_from_slice(bytemuck::bytes_of(&uniforms));

        gpu.begin_label(cmd, c"whitewater");
        slot.timer.reset(gpu, cmd);
        let depth_layout = depth_layout(&frame.scene_depth);
        let uses = Uses {
            in_place,
            depth: depth_use(depth_layout, self.config.spray),
            output: self.composite.output_use(),
            scene: self.composite.scene_use(),
            lit: self.light.is_some(),
        };
        gpu.barriers(cmd, &acquire(frame, &uses), &[]);

        let scene_depth =
            Resource::SampledIn(frame.scene_depth.view, gpu.samplers.nearest, depth_layout);
        let mut r = Recording {
            gpu,
            cmd,
            descriptors: &slot.descriptors,
            timer: &mut slot.timer,
            extent: frame.output.rect.extent,
            uniforms: Resource::Buffer(slot.uniforms.handle, 0, size_of::<FrameUniforms>() as u64),
            scene_depth,
            sunlight: sunlight(frame, self.light.as_ref(), gpu, scene_depth),
            read_back,
        };
        self.water.record(&mut r, &frame.particles, self.light.as_ref())?;
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
        )?;

        let cmd = r.cmd;
        let mut buffers = Vec::with_capacity(7);
        for handle in particle_buffers(&frame.particles) {
            let barrier = buffer(handle, COMPUTE_READ, frame.particles.after);
            if !buffers.iter().any(|b: &vk::BufferMemoryBarrier2<'_>| b.buffer == handle) {
                buffers.push(barrier);
            }
        }
        gpu.barriers(cmd, &release(frame, &uses), &buffers);
        gpu.end_label(cmd);
        let recorded = Recorded {
            layers: if self.config.keep_layers {
                let mut layers = self.water.kept(frame.output.rect.extent, FRAGMENT_SAMPLED);
                layers.extend(self.light.iter().flat_map(Light::layers));
                layers
            } else {
                Vec::new()
            },
            active_samples: self.water.query_results(),
            counts: Some(self.water.counts()),
            levels: Some(self.water.levels()),
            sheets: self.water.boundaries(),
        };
        Ok((recorded, cmd))
    }

    /// Times of the slot's last finished frame, pass by pass; empty before there is one. Never
    /// waits: while the frame is still running these are the times of the one before. Best read
    /// after the slot's fence, before its next record.
    pub fn timings(&mut self, slot: Slot) -> &[Timing] {
        match self.slots.get_mut(slot.0 as usize) {
            Some(state) => state.timer.timings(&self.gpu),
            None => &[],
        }
    }

    /// Says that the slot has come back (its work is complete): frees what `resize` and
    /// `reconfigure` retired and no frame in flight uses any more.
    pub fn collect(&mut self, slot: Slot) {
        if let Some(state) = self.slots.get_mut(slot.0 as usize) {
            state.has_environment = false;
        }
        self.retired.collect(slot.0);
        self.gpu.bury();
    }

    /// Says that the command buffer recorded last with this slot was thrown away.
    pub fn abandon(&mut self, slot: Slot) {
        if let Some(state) = self.slots.get_mut(slot.0 as usize) {
            state.timer.abandon();
        }
        self.collect(slot);
    }

    /// Retired objects that still wait for their slots.
    pub fn retired(&self) -> usize {
        self.retired.len()
    }

    /// Changes the output's size. Legal with frames in flight.
    ///
    /// # Errors
    /// A bad extent changes nothing. After any other error (no memory) `record` refuses frames
    /// until a resize has succeeded.
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
        self.retired.retire(std::mem::replace(&mut self.scene_copy, copy));
        if let Some(light) = &mut self.light {
            light.resize(&self.gpu, config, &mut self.retired)?;
        }
        self.water.resize(&self.gpu, config, &mut self.retired)
    }

    /// Changes the configuration: makes what it needs anew and retires what it replaces. Legal with
    /// frames in flight. Returns true when the environment was made anew too: then
    /// [`record_setup`](Self::record_setup) and
    /// [`record_environment`](Self::record_environment) are due before the next record.
    ///
    /// # Errors
    /// As [`Renderer::new`]; the renderer then keeps its old configuration.
    pub fn reconfigure(&mut self, config: &Config) -> Result<bool, Error> {
        self.check_config(config)?;
        let new = self.make_parts(config);
        self.gpu.bury();
        let (water, composite, light, scene_copy, environment, descriptors) = new?;
        let new_environment = environment.is_some();
        self.config = *config;
        self.whole = true;
        let retired = &mut self.retired;
        retired.retire(std::mem::replace(&mut self.water, water));
        retired.retire(std::mem::replace(&mut self.composite, composite));
        retired.retire(std::mem::replace(&mut self.light, light));
        retired.retire(std::mem::replace(&mut self.scene_copy, scene_copy));
        if let Some(new) = environment {
            retired.retire(std::mem::replace(&mut self.environment, new));
        }
        for (slot, new) in self.slots.iter_mut().zip(descriptors) {
            retired.retire(std::mem::replace(&mut slot.descriptors, new));
        }
        self.gpu.bury();
        Ok(new_environment)
    }

    #[allow(clippy::type_complexity)] // used once, right above
    fn make_parts(
        &self,
        config: &Config,
    ) -> Result<
        (Water, Composite, Option<Light>, Option<Image>, Option<Environment>, Vec<Descriptors>),
        Error,
    > {
        let gpu = &*self.gpu;
        let same_environment = config.environment_size == self.config.environment_size;
        Ok((
            Water::new(gpu, config)?,
            Composite::new(gpu, config)?,
            Parts::light(gpu, config)?,
            Parts::scene_copy(gpu, config)?,
            if same_environment { None } else { Some(Environment::new(gpu, config)?) },
            (0..gpu.slots)
                .map(|_| Descriptors::new(gpu, SlotState::sets(gpu, config)))
                .collect::<Result<_, _>>()?,
        ))
    }

    /// The configuration in force.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Device memory in use.
    pub fn memory(&self) -> MemoryUse {
        let mut memory = self.water.memory();
        if let Some((images, buffers)) = self.light.as_ref().map(Light::memory) {
            memory.images += images;
            memory.buffers += buffers;
        }
        memory.images += self.environment.cube.size;
        memory.images += self.scene_copy.as_ref().map_or(0, |image| image.size);
        memory.buffers += self.slots.iter().map(|slot| slot.uniforms.size).sum::<u64>();
        memory
    }

    /// Frees everything. A plain drop leaks it, safely.
    ///
    /// # Safety
    /// The GPU is done with all recorded work, or it will never be submitted.
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
                format!("{index} of {} frames in flight", self.slots.len()),
            ))
        }
    }

    fn check_config(&self, config: &Config) -> Result<(), Error> {
        check_config(config)?;
        Offer::of(&self.instance, self.physical_device, config.output_format).check(config)
    }

    /// Everything that can be wrong with a frame.
    fn check_frame(&self, frame: &Frame<'_>) -> Result<Lens, Error> {
        if !self.whole {
            return Err(Error::bad("Renderer", "its last resize failed: call resize again first"));
        }
        check_settings(&frame.settings.water, &frame.settings.light)?;
        frame.settings.foam.check()?;
        frame.settings.spray.check()?;
        let (part, most) = (frame.output.rect.extent, self.config.extent);
        if part.width > most.width || part.height > most.height {
            return Err(Error::bad(
                "Frame.output.rect",
                format!(
                    "{}x{}, but the renderer is made for {}x{} at most: call resize first",
                    part.width, part.height, most.width, most.height
                ),
            ));
        }
        if frame.output.format != self.config.output_format {
            return Err(Error::bad(
                "Frame.output.format",
                format!("{:?} is not Config.output_format", frame.output.format),
            ));
        }
        let shadow = frame.sun.shadow.as_ref().map(|s| ("Frame.sun.shadow.image.before", &s.image));
        let images = [
            ("Frame.output.before", &frame.output),
            ("Frame.scene_color.before", &frame.scene_color),
            ("Frame.scene_depth.before", &frame.scene_depth),
        ];
        for (field, image) in images.into_iter().chain(shadow) {
            if image.before.layout == vk::ImageLayout::UNDEFINED {
                return Err(Error::bad(field, "UNDEFINED: its contents would be lost"));
            }
            if matches!(
                image.after.layout,
                vk::ImageLayout::UNDEFINED | vk::ImageLayout::PREINITIALIZED
            ) {
                return Err(Error::bad("HostImage.after", "no image can be left UNDEFINED"));
            }
            let vk::Rect2D { offset, extent } = image.rect;
            let fits = |at: i32, size: u32, whole: u32| {
                at >= 0
                    && size > 0
                    && u64::from(at.unsigned_abs()) + u64::from(size) <= whole.into()
            };
            if !fits(offset.x, extent.width, image.extent.width)
                || !fits(offset.y, extent.height, image.extent.height)
            {
                return Err(Error::bad(
                    "HostImage.rect",
                    format!(
                        "{}x{} at ({}, {}) is no part of an image of {}x{}",
                        extent.width,
                        extent.height,
                        offset.x,
                        offset.y,
                        image.extent.width,
                        image.extent.height
                    ),
                ));
            }
        }
        if frame.in_place() && !self.config.in_place {
            return Err(Error::bad(
                "Frame.scene_color",
                "is the output itself, but Config.in_place is false",
            ));
        }
        check_particles(&frame.particles, &self.config, &self.gpu.limits)?;
        check_sun(frame, &self.config)?;
        Lens::new(&frame.camera)
    }
}

fn check_particles(
    particles: &Particles,
    config: &Config,
    limits: &vk::PhysicalDeviceLimits,
) -> Result<(), Error> {
    let count = match particles.count {
        Count::Cpu(count) if count > config.max_particles => {
            return Err(Error::bad(
                "Frame.particles.count",
                format!("{count} is more than Config.max_particles, {}", config.max_particles),
            ));
        }
        Count::Cpu(count) => count,
        Count::Gpu { .. } => 0,
    };
    let stream = |field, stream: &Stream, bytes: u64| {
        stream.check(field, bytes, count, ("Config.max_stride", config.max_stride))
    };
    stream("Frame.particles.positions", &particles.positions, 12)?;
    if let Some(densities) = &particles.densities {
        stream("Frame.particles.densities", densities, 4)?;
    }
    if let Some(velocities) = &particles.velocities {
        stream("Frame.particles.velocities", velocities, 12)?;
    }
    if let Some(ids) = &particles.ids {
        stream("Frame.particles.ids", ids, 4)?;
    }
    if let Some(foam) = &particles.foam {
        stream("Frame.particles.foam", foam, 8)?;
        if !config.foam {
            let why = "given, but Config.foam is false";
            return Err(Error::bad("Frame.particles.foam", why));
        }
    }
    let aligned = |field, offset: u64| {
        let to = limits.min_storage_buffer_offset_alignment.max(4);
        if offset.is_multiple_of(to) {
            Ok(())
        } else {
            Err(Error::bad(field, format!("{offset} is no multiple of the device's {to}")))
        }
    };
    if let Count::Gpu { offset, .. } = particles.count {
        aligned("Frame.particles.count.offset", offset)?;
    }
    if let Some(packets) = &particles.packets {
        aligned("Frame.particles.packets.offset", packets.offset)?;
        if packets.count > 65_535 {
            return Err(Error::bad(
                "Frame.particles.packets.count",
                format!("{} is more than 65535", packets.count),
            ));
        }
    }
    Ok(())
}

fn check_sun(frame: &Frame<'_>, config: &Config) -> Result<(), Error> {
    let bad = |field, why: &str| Err(Error::bad(field, why));
    match (config.shadow, &frame.sun.shadow) {
        (Some(_), None) => return bad("Frame.sun.shadow", "none, but Config.shadow asks for it"),
        (None, Some(_)) => return bad("Frame.sun.shadow", "given, but Config.shadow is None"),
        (Some(Shadows::Map), Some(shadow)) => {
            let clip = &shadow.view_projection;
            if !clip.is_finite() || clip.determinant().abs() < 1e-30 {
                return bad("Frame.sun.shadow.view_projection", "not finite, or singular");
            }
            if !shadow.bias.is_finite() {
                return bad("Frame.sun.shadow.bias", "not finite");
            }
        }
        _ => {}
    }
    match (config.cast, &frame.sun.region) {
        (Some(_), None) => bad("Frame.sun.region", "none, but Config.cast asks for it"),
        (None, Some(_)) => bad("Frame.sun.region", "given, but Config.cast is None"),
        (Some(_), Some(region)) => {
            let finite = region.center.iter().all(|c| c.is_finite());
            if finite && region.radius.is_finite() && region.radius > 0.0 {
                Ok(())
            } else {
                bad("Frame.sun.region", "a finite centre and a radius over 0 expected")
            }
        }
        (None, None) => Ok(()),
    }
}

fn check_config(config: &Config) -> Result<(), Error> {
    let bad = |field, why: String| Err(Error::bad(field, why));
    if config.extent.width == 0 || config.extent.height == 0 {
        return bad("Config.extent", "zero; a minimised window has nothing to draw".into());
    }
    if config.max_particles == 0 {
        return bad("Config.max_particles", "zero; it sizes the buffers".into());
    }
    if config.max_stride < 4 || !config.max_stride.is_multiple_of(4) {
        return bad("Config.max_stride", format!("{} is no multiple of 4", config.max_stride));
    }
    if config.smoothing_level > 2 {
        return bad("Config.smoothing_level", format!("{} of 0, 1, 2", config.smoothing_level));
    }
    if config.thickness_level > 3 {
        return bad("Config.thickness_level", format!("{} of 0 to 3", config.thickness_level));
    }
    if !(1..=256).contains(&config.max_iterations) {
        return bad("Config.max_iterations", format!("{} of 1 to 256", config.max_iterations));
    }
    if config.coarsening > crate::water::MOST_COARSENING {
        return bad("Config.coarsening", format!("{} of 0 to 3", config.coarsening));
    }
    if !(1..=2).contains(&config.sheets) {
        return bad("Config.sheets", format!("{} of 1, 2", config.sheets));
    }
    if let Some(edge) = config.cast
        && (!edge.is_multiple_of(16) || !(16..=4096).contains(&edge))
    {
        let why = format!("{edge}: a multiple of 16 from 16 to 4096 expected");
        return bad("Config.cast", why);
    }
    let size = config.environment_size;
    if !size.is_power_of_two() || !(16..=2048).contains(&size) {
        return bad(
            "Config.environment_size",
            format!("{size}: a power of two from 16 to 2048 expected"),
        );
    }
    Ok(())
}

/// What depends on the configuration.
struct Parts {
    water: Water,
    composite: Composite,
    light: Option<Light>,
    environment: Environment,
    scene_copy: Option<Image>,
}

impl Parts {
    fn new(gpu: &Gpu, config: &Config) -> Result<Self, Error> {
        Ok(Self {
            water: Water::new(gpu, config)?,
            composite: Composite::new(gpu, config)?,
            light: Self::light(gpu, config)?,
            environment: Environment::new(gpu, config)?,
            scene_copy: Self::scene_copy(gpu, config)?,
        })
    }

    fn light(gpu: &Gpu, config: &Config) -> Result<Option<Light>, Error> {
        config.cast.map(|edge| Light::new(gpu, config, edge)).transpose()
    }

    fn scene_copy(gpu: &Gpu, config: &Config) -> Result<Option<Image>, Error> {
        // A lit one takes its place.
        if !config.in_place || config.cast.is_some() {
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
                size_of::<FrameUniforms>() as u64,
                vk::BufferUsageFlags::UNIFORM_BUFFER,
                MemoryLocation::CpuToGpu,
            )?,
            framebuffer: None,
            has_environment: false,
        })
    }

    /// A few sets a pass, and those of the splats for every chunk of particles.
    fn sets(gpu: &Gpu, config: &Config) -> u32 {
        94 + 24 * crate::water::chunks(&gpu.limits, config).1
    }

    /// The slot's earlier work is complete: its sets and its framebuffer can go.
    fn begin(&mut self, gpu: &Gpu) -> Result<(), Error> {
        self.framebuffer = None;
        // Framebuffers alone: what holds memory is dropped by `collect`, which buries it.
        gpu.bury();
        if std::mem::take(&mut self.has_environment) {
            return Ok(());
        }
        self.descriptors.reset(gpu)
    }

    /// The same for the environment, which may share the slot with the frame after it.
    fn begin_environment(&mut self, gpu: &Gpu) -> Result<(), Error> {
        if std::mem::replace(&mut self.has_environment, true) {
            return Ok(());
        }
        self.descriptors.reset(gpu)
    }
}

fn particle_buffers(particles: &Particles) -> impl Iterator<Item = vk::Buffer> {
    let count = match particles.count {
        Count::Gpu { buffer, .. } => Some(buffer),
        Count::Cpu(_) => None,
    };
    [
        Some(particles.positions.buffer),
        particles.densities.map(|s| s.buffer),
        particles.packets.map(|p| p.buffer),
        particles.velocities.map(|s| s.buffer),
        particles.ids.map(|s| s.buffer),
        particles.foam.map(|s| s.buffer),
        count,
    ]
    .into_iter()
    .flatten()
}

/// Layout in which the scene's depth is sampled.
fn depth_layout(image: &HostImage) -> vk::ImageLayout {
    if image.aspect.contains(vk::ImageAspectFlags::DEPTH) {
        vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL
    } else {
        vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL
    }
}

/// How the scene's depth is used here.
fn depth_use(layout: vk::ImageLayout, spray: bool) -> Access {
    let sampled = access::COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED);
    // Bound to its vertices too, in place of what tells where the sun does not come.
    let sampled = if spray { sampled.and(access::VERTEX_SAMPLED) } else { sampled };
    Access { layout, ..sampled }
}

/// How the host's images are used here.
struct Uses {
    /// The output is the scene's colour too.
    in_place: bool,
    depth: Access,
    /// By `composite`.
    output: Access,
    /// The scene's colour, or its copy, by `composite`.
    scene: Access,
    /// The scene is read by `lit` first.
    lit: bool,
}

impl Uses {
    /// What reads or writes the output first.
    fn output_first(&self) -> Access {
        match (self.in_place, self.lit) {
            (true, true) => Light::SCENE_USE,
            (true, false) => COPY_READ,
            (false, _) => self.output,
        }
    }

    /// What reads the host's own image of the scene.
    fn scene_first(&self) -> Access {
        if self.lit { Light::SCENE_USE } else { self.scene }
    }
}

/// How a shadow map or mask is used here.
fn shadow_use(image: &HostImage) -> Access {
    let sampled = access::COMPUTE_SAMPLED.and(FRAGMENT_SAMPLED).and(access::VERTEX_SAMPLED);
    Access { layout: depth_layout(image), ..sampled }
}

/// What tells where the sun does not come; the scene's depth stands in for what is not read.
fn sunlight(frame: &Frame<'_>, light: Option<&Light>, gpu: &Gpu, depth: Resource) -> Sunlight {
    let shadow = frame.sun.shadow.map_or(depth, |shadow| {
        let layout = depth_layout(&shadow.image);
        Resource::SampledIn(shadow.image.view, gpu.samplers.nearest, layout)
    });
    Sunlight { shadow, thickness: light.map_or(depth, |light| light.thickness(gpu)) }
}

/// The one barrier of each host image on its way in.
fn acquire(frame: &Frame<'_>, uses: &Uses) -> Vec<vk::ImageMemoryBarrier2<'static>> {
    let barrier =
        |image: &HostImage, to| access::raw_image(image.image, image.aspect, image.before, to);
    let mut all =
        vec![barrier(&frame.scene_depth, uses.depth), barrier(&frame.output, uses.output_first())];
    if !uses.in_place {
        all.push(barrier(&frame.scene_color, uses.scene_first()));
    }
    let shadow = frame.sun.shadow.iter().map(|shadow| &shadow.image);
    all.extend(shadow.map(|image| barrier(image, shadow_use(image))));
    all
}

/// The one barrier of each host image on its way out.
fn release(frame: &Frame<'_>, uses: &Uses) -> Vec<vk::ImageMemoryBarrier2<'static>> {
    let barrier =
        |image: &HostImage, from| access::raw_image(image.image, image.aspect, from, image.after);
    let mut all =
        vec![barrier(&frame.scene_depth, uses.depth), barrier(&frame.output, uses.output)];
    if !uses.in_place {
        all.push(barrier(&frame.scene_color, uses.scene_first()));
    }
    let shadow = frame.sun.shadow.iter().map(|shadow| &shadow.image);
    all.extend(shadow.map(|image| barrier(image, shadow_use(image))));
    all
}

/// Pass `scene`: the output's scene to a copy that can be sampled while the output is drawn to.
/// The output comes in TRANSFER_SRC_OPTIMAL and leaves as `composite` wants it.
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
