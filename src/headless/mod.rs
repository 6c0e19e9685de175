//! The library without a host: an own device, a scene to stand in, submits and read-back. For the
//! tool and for tests; an engine that embeds the library does not compile it.

mod device;
mod readback;
pub mod scene;
mod submit;
mod transfer;

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;

pub use device::{Device, DeviceOptions};
pub use readback::Picture;
use scene::bake::Baked;
use scene::{Scene, SceneFrame, SceneRenderer};
use submit::{Commands, Parts, begin, submit};
use transfer::staging;

use crate::composite::way;
use crate::contract::{
    Access, Camera, Config, Count, Frame, HostImage, Layer, ParticleCounts, Particles, Previous,
    Region, Settings, Slot, Step, Stream, Sun,
};
use crate::environment::{EnvironmentSource, Equirectangular, Sky};
use crate::error::{Error, VkContext};
use crate::frame::Lens;
use crate::gpu::Gpu;
use crate::gpu::access::{self, COPY_WRITE};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Descriptors;
use crate::gpu::graveyard::Destroy;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::timing::Timing;
use crate::renderer::Renderer;
use crate::state::{State, StateConfig};
use crate::water::settings::{FoamSettings, Shading, Shadows};

/// Output format: linear, scene-referred.
pub const COLOR_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
/// Depth of the stand-in scene.
pub const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// The scene's colour image between its own passes.
const COLOR_REST: Access = access::COLOR_ATTACHMENT;
/// The scene's depth image between its own passes.
const DEPTH_REST: Access = access::DEPTH_ATTACHMENT;

/// What became of the particles of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// On the screen.
    pub visible: u32,
    /// Of those, the ones that can show.
    pub front: u32,
    /// Dropped for NaN, infinite or huge positions.
    pub dropped: u32,
    /// Set aside as spray.
    pub spray: u32,
}

/// What stands behind the water.
pub enum Background<'a> {
    /// One colour, nothing in front of the far plane.
    Color([f32; 3]),
    /// The scene handed to [`Headless::scene`].
    Scene,
    /// Pictures from the CPU, row by row: linear RGBA and device depth.
    Images {
        /// width × height linear RGBA.
        color: &'a [[f32; 4]],
        /// width × height device depth.
        depth: &'a [f32],
    },
}

/// A renderer with everything a host would have, one frame at a time.
pub struct Headless {
    gpu: Arc<Gpu>,
    renderer: Renderer,
    color: Image,
    depth: Image,
    commands: Commands,
    /// Command buffers for the parts of a frame that the host reads back in between.
    parts: Vec<vk::CommandBuffer>,
    positions: Option<Buffer>,
    densities: Option<Buffer>,
    velocities: Option<Buffer>,
    ids: Option<Buffer>,
    foam: Option<Foaming>,
    region: Option<Region>,
    previous: Option<Previous>,
    count: u32,
    layers: Vec<Layer>,
    counts: Option<ParticleCounts>,
    levels: Option<vk::Buffer>,
    active_samples: Option<(vk::Buffer, u32)>,
    scene: Option<Stage>,
    device: Device,
}

impl Headless {
    /// Makes the renderer. The output format and `in_place` of the configuration are replaced.
    ///
    /// # Errors
    /// As [`Renderer::new`].
    pub fn new(device: Device, config: &Config) -> Result<Self, Error> {
        let config =
            Config { output_format: COLOR_FORMAT, in_place: true, keep_layers: true, ..*config };
        let host = device.host(1);
        let gpu = Gpu::new(&host)?;
        let made = Self::own(&gpu, &device, &config).and_then(|own| {
            // SAFETY: the device is ours and outlives the renderer (field order, `finish`).
            Ok((own, unsafe { Renderer::new(&host, &config) }?))
        });
        let ((commands, color, depth), renderer) = match made {
            Ok(made) => made,
            Err(error) => {
                // Nothing was submitted with what was made before the failure.
                gpu.destroy();
                return Err(error);
            }
        };
        let mut headless = Self {
            gpu,
            renderer,
            color,
            depth,
            commands,
            parts: Vec::new(),
            positions: None,
            densities: None,
            velocities: None,
            ids: None,
            foam: None,
            region: None,
            previous: None,
            count: 0,
            layers: Vec::new(),
            counts: None,
            levels: None,
            active_samples: None,
            scene: None,
            device,
        };
        if let Err(error) = headless.first_contents() {
            drop(headless.finish());
            return Err(error);
        }
        Ok(headless)
    }

    /// Brings the images to where frames find them, under the built-in sky.
    fn first_contents(&mut self) -> Result<(), Error> {
        self.run(|this, cmd| {
            // SAFETY: cmd is recording and submitted before any record.
            unsafe { this.renderer.record_setup(cmd) };
            this.gpu.barriers(
                cmd,
                &[
                    access::image(&this.color, access::NOTHING, COLOR_REST),
                    access::image(&this.depth, access::NOTHING, DEPTH_REST),
                ],
                &[],
            );
            Ok(())
        })?;
        self.sky(&Sky::default())
    }

    /// What is ours beside the renderer.
    fn own(gpu: &Gpu, device: &Device, config: &Config) -> Result<(Commands, Image, Image), Error> {
        let extent = config.extent;
        let usage = vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        let mut color = usage | vk::ImageUsageFlags::COLOR_ATTACHMENT;
        // Only where it is needed: some devices do not compress what can be stored to.
        if way(config) == Shading::Compute {
            color |= vk::ImageUsageFlags::STORAGE;
        }
        let depth = usage | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
        Ok((
            Commands::new(gpu, device.queue_family)?,
            Image::new(gpu, &ImageDesc::new("headless/color", extent, COLOR_FORMAT, color))?,
            Image::new(gpu, &ImageDesc::new("headless/depth", extent, DEPTH_FORMAT, depth))?,
        ))
    }

    /// The device.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The renderer.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Fills a fresh command buffer, submits it and waits. `record` says which command buffer it
    /// ended with.
    fn run_parts(
        &mut self,
        record: impl FnOnce(&mut Self, vk::CommandBuffer) -> Result<vk::CommandBuffer, Error>,
    ) -> Result<(), Error> {
        // SAFETY: no command buffer of the pool is in use: every run waits for its end.
        unsafe {
            self.gpu
                .device
                .reset_command_pool(self.commands.pool.handle, vk::CommandPoolResetFlags::empty())
                .context(|| "vkResetCommandPool".into())?;
        }
        let cmd = self.commands.buffer;
        begin(&self.gpu, cmd)?;
        let last = record(self, cmd)?;
        submit(&self.gpu, self.device.queue, last, self.commands.fence.handle)
    }

    /// The same for one command buffer.
    fn run(
        &mut self,
        record: impl FnOnce(&mut Self, vk::CommandBuffer) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.run_parts(|this, cmd| record(this, cmd).map(|()| cmd))
    }

    /// The built-in sky as environment.
    ///
    /// # Errors
    /// What Vulkan reports.
    pub fn sky(&mut self, sky: &Sky) -> Result<(), Error> {
        let source = EnvironmentSource::Sky(*sky);
        self.run(|this, cmd| {
            // SAFETY: cmd is recording; the slot's earlier work is done (every run waits).
            unsafe { this.renderer.record_environment(cmd, Slot(0), &source) }
        })
    }

    /// An equirectangular picture as environment: linear RGBA, row 0 up.
    ///
    /// # Errors
    /// A picture larger than the device's images may be, no memory, and what Vulkan reports.
    pub fn equirectangular(
        &mut self,
        extent: vk::Extent2D,
        pixels: &[[f32; 4]],
        scale: f32,
        turn: f32,
    ) -> Result<(), Error> {
        let most = self.gpu.limits.max_image_dimension2_d;
        if extent.width > most || extent.height > most {
            let found = format!("{}x{}", extent.width, extent.height);
            let why =
                format!("expected at most {most}x{most} texels on this device, found {found}");
            return Err(Error::bad("Equirectangular.image.extent", why));
        }
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let image =
            Image::new(&self.gpu, &ImageDesc::new("headless/equirect", extent, format, usage))?;
        let staging = staging(&self.gpu, bytemuck::cast_slice(pixels))?;
        let result = self.run(|this, cmd| {
            this.upload(cmd, &staging, &image, access::NOTHING, COPY_WRITE);
            let host = HostImage {
                image: image.handle,
                view: image.view,
                format,
                aspect: vk::ImageAspectFlags::COLOR,
                extent,
                rect: extent.into(),
                before: COPY_WRITE,
                after: access::COMPUTE_SAMPLED,
            };
            let source =
                EnvironmentSource::Equirectangular(Equirectangular { image: host, scale, turn });
            // SAFETY: as in `sky`.
            unsafe { this.renderer.record_environment(cmd, Slot(0), &source) }
        });
        staging.destroy(&self.gpu);
        image.destroy(&self.gpu);
        result
    }

    /// The scene to stand behind the water, drawn by [`Background::Scene`]; `antialias`: four
    /// samples a pixel in its colour. Its light is baked: a new sun needs a new scene.
    ///
    /// # Errors
    /// No memory, and what Vulkan reports.
    pub fn scene(&mut self, scene: &Scene, antialias: bool) -> Result<(), Error> {
        self.set_up_scene(scene, antialias, None)
    }

    /// The scene that was handed in last, in another [`frame`](Scene::frame): its parts have moved,
    /// and nothing else has changed. What moves takes the baked light along; the sun's shadow is
    /// drawn anew.
    ///
    /// # Errors
    /// As [`scene`](Self::scene).
    pub fn scene_frame(&mut self, scene: &Scene, antialias: bool) -> Result<(), Error> {
        let light = self.scene.as_ref().map(|stage| Arc::clone(&stage.renderer.baked));
        self.set_up_scene(scene, antialias, light)
    }

    fn set_up_scene(
        &mut self,
        scene: &Scene,
        antialias: bool,
        light: Option<Arc<Baked>>,
    ) -> Result<(), Error> {
        if let Some(old) = self.scene.take() {
            old.renderer.destroy(&self.gpu);
        }
        let gpu = &self.gpu;
        let (color, depth) = (COLOR_FORMAT, DEPTH_FORMAT);
        let made = match light {
            Some(light) => SceneRenderer::with_light(gpu, scene, &light, color, depth, antialias),
            None => SceneRenderer::new(gpu, scene, color, depth, antialias),
        };
        let made = made.and_then(|renderer| {
            Ok(Stage { descriptors: Descriptors::new(gpu, renderer.sets())?, renderer })
        });
        if made.is_err() {
            // Nothing was submitted with what was made before the failure.
            gpu.bury();
        }
        let mut stage = made?;
        self.run(|this, cmd| {
            stage.renderer.record_setup(&this.gpu, cmd);
            Ok(())
        })?;
        stage.renderer.finish_setup(&self.gpu);
        self.scene = Some(stage);
        Ok(())
    }

    fn draw_scene(&mut self, cmd: vk::CommandBuffer, camera: &Camera) -> Result<(), Error> {
        let Some(stage) = &mut self.scene else {
            return Err(Error::bad("Background::Scene", "no scene was handed in"));
        };
        stage.descriptors.reset(&self.gpu)?;
        let frame = SceneFrame {
            slot: Slot(0),
            descriptors: &stage.descriptors,
            camera,
            color: &self.color,
            depth: &self.depth,
            environment: self.renderer.environment_view(),
            sampler: self.gpu.samplers.linear,
        };
        stage.renderer.record(&self.gpu, cmd, &frame)
    }

    /// Uploads the particles of a frame.
    ///
    /// # Errors
    /// More than [`Config::max_particles`], densities of another length, no memory.
    pub fn particles(
        &mut self,
        positions: &[[f32; 3]],
        densities: Option<&[f32]>,
    ) -> Result<(), Error> {
        if densities.is_some_and(|d| d.len() != positions.len()) {
            return Err(Error::bad("densities", "not as many as positions"));
        }
        if let Some(foam) = &mut self.foam {
            foam.stepped = false;
        }
        self.count = u32::try_from(positions.len())
            .map_err(|_| Error::bad("positions", "more than 2^32"))?;
        let old = [&mut self.positions, &mut self.densities, &mut self.velocities, &mut self.ids];
        for old in old.into_iter().filter_map(Option::take) {
            old.destroy(&self.gpu);
        }
        let make = |name, bytes: &[u8]| input(&self.gpu, name, bytes);
        self.positions = Some(make("headless/positions", bytemuck::cast_slice(positions))?);
        if let Some(densities) = densities {
            self.densities = Some(make("headless/densities", bytemuck::cast_slice(densities))?);
        }
        Ok(())
    }

    /// Uploads how the particles uploaded last move: their velocities, for foam, spray and
    /// motion vectors, and `ids` that follow them from frame to frame, so that the noise in their foam and their droplets do.
    ///
    /// # Errors
    /// Not as many as positions, no memory.
    pub fn motion(&mut self, velocities: &[[f32; 3]], ids: Option<&[u32]>) -> Result<(), Error> {
        let all = |length: usize| length == self.count as usize;
        if !all(velocities.len()) || ids.is_some_and(|ids| !all(ids.len())) {
            return Err(Error::bad("velocities", "not as many as positions, or as ids"));
        }
        for old in [self.velocities.take(), self.ids.take()].into_iter().flatten() {
            old.destroy(&self.gpu);
        }
        let make = |name, bytes: &[u8]| input(&self.gpu, name, bytes);
        self.velocities = Some(make("headless/velocities", bytemuck::cast_slice(velocities))?);
        if let Some(ids) = ids {
            self.ids = Some(make("headless/ids", bytemuck::cast_slice(ids))?);
        }
        Ok(())
    }

    /// What of the particles is foam, with [`Config::foam`]: a step of a [`State`] by their
    /// [`motion`](Self::motion). `dt`: seconds since the step before; without, or without ids, a
    /// frame stands for itself.
    ///
    /// # Errors
    /// No motion, no memory, and as [`State::record_step`].
    pub fn step(&mut self, dt: Option<f32>, settings: &FoamSettings) -> Result<(), Error> {
        let Some(velocities) = &self.velocities else {
            return Err(Error::bad("velocities", "none uploaded"));
        };
        let velocities = stream(velocities, 12);
        // The last that can fail before the state is put back: dropped, it would leak.
        let mut state = match self.foam.take() {
            Some(old) => old.state,
            None => {
                let config = StateConfig::new(self.renderer.config().max_particles);
                // SAFETY: the device is ours and outlives the state (field order, `finish`).
                unsafe { State::new(&self.device.host(1), &config) }?
            }
        };
        let step = Step {
            slot: Slot(0),
            velocities,
            densities: self.densities.as_ref().map(|buffer| stream(buffer, 4)),
            ids: self.ids.as_ref().filter(|_| dt.is_some()).map(|ids| stream(ids, 4)),
            count: Count::Cpu(self.count),
            dt: dt.unwrap_or(0.0),
            settings,
            before: HOST_WRITE,
            after: HOST_WRITE,
        };
        // SAFETY: cmd is recording outside a render pass; every run waits for its end.
        let result = self.run(|_, cmd| unsafe { state.record_step(cmd, &step) });
        if result.is_err() {
            state.abandon(Slot(0));
        }
        self.foam = Some(Foaming { state, stepped: result.is_ok() });
        result
    }

    /// Where water and foam cast shadows and caustics, with [`Config::cast`]. Shadows of the scene on
    /// them, with [`Shadows::Map`] or [`Shadows::Convolution`], come from the scene's own map.
    pub fn region(&mut self, region: Region) {
        self.region = Some(region);
    }

    /// The frame before those that are drawn next, with [`Config::motion`].
    pub fn previous(&mut self, previous: Option<Previous>) {
        self.previous = previous;
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// As [`Renderer::record`].
    pub fn render(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
    ) -> Result<(), Error> {
        self.render_frame(camera, settings, background, false)
    }

    /// The same, with the smoothing ended by the host: it submits block by block and reads each
    /// query back, as the source does. For comparison only; needs
    /// [`Smoothing::Query`](crate::water::Smoothing::Query).
    ///
    /// # Errors
    /// As [`Renderer::record`].
    pub fn render_with_read_back(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
    ) -> Result<(), Error> {
        self.render_frame(camera, settings, background, true)
    }

    fn render_frame(
        &mut self,
        camera: &Camera,
        settings: &Settings,
        background: &Background<'_>,
        read_back: bool,
    ) -> Result<(), Error> {
        let Some(positions) = &self.positions else {
            return Err(Error::bad("particles", "none uploaded"));
        };
        let foam = self.foam.as_ref().filter(|foam| foam.stepped).map(|foam| Stream {
            buffer: foam.state.foam(),
            size: 8 * u64::from(self.renderer.config().max_particles),
            offset: 0,
            stride: 8,
        });
        let particles = Particles {
            densities: self.densities.as_ref().map(|buffer| stream(buffer, 4)),
            velocities: self.velocities.as_ref().map(|buffer| stream(buffer, 12)),
            ids: self.ids.as_ref().map(|buffer| stream(buffer, 4)),
            foam,
            before: HOST_WRITE,
            after: HOST_WRITE,
            ..Particles::new(stream(positions, 12), Count::Cpu(self.count))
        };
        let image = |image: &Image, rest| HostImage {
            image: image.handle,
            view: image.view,
            format: image.format,
            aspect: crate::gpu::image::aspect_of(image.format),
            extent: image.extent,
            rect: image.extent.into(),
            before: rest,
            after: rest,
        };
        let output = image(&self.color, COLOR_REST);
        let depth = image(&self.depth, DEPTH_REST);
        let staging = match background {
            Background::Images { color, depth } => {
                let half: Vec<[u16; 4]> =
                    color.iter().map(|c| c.map(|v| half::f16::from_f32(v).to_bits())).collect();
                Some((
                    staging(&self.gpu, bytemuck::cast_slice(&half))?,
                    staging(&self.gpu, bytemuck::cast_slice(depth))?,
                ))
            }
            Background::Color(_) | Background::Scene => None,
        };
        let result = self.run_parts(|this, cmd| {
            match (background, &staging) {
                (_, Some((color, depth))) => {
                    this.upload(cmd, color, &this.color, COLOR_REST, COLOR_REST);
                    this.upload(cmd, depth, &this.depth, DEPTH_REST, DEPTH_REST);
                }
                (Background::Color(color), None) => this.clear(cmd, *color, camera),
                (Background::Scene, None) => this.draw_scene(cmd, camera)?,
                _ => {}
            }
            let maps = |kind| matches!(kind, Shadows::Map | Shadows::Convolution(_));
            let shadowed = this.renderer.config().shadow.is_some_and(maps);
            let stage = this.scene.as_ref().filter(|_| shadowed);
            let sun = Sun {
                shadow: stage.map(|stage| stage.renderer.shadow(settings.water.spacing)),
                region: this.region,
            };
            let frame = Frame {
                slot: Slot(0),
                output,
                scene_color: output,
                scene_depth: depth,
                particles,
                camera: *camera,
                sun,
                previous: this.previous,
                settings,
            };
            let mut parts = Parts {
                gpu: this.gpu.clone(),
                queue: this.device.queue,
                fence: this.commands.fence.handle,
                pool: this.commands.pool.handle,
                spare: std::mem::take(&mut this.parts),
                used: 0,
            };
            let mut stop = |cmd, pool, query| parts.read_back(cmd, pool, query);
            let stop: Option<crate::water::ReadBack<'_>> =
                if read_back { Some(&mut stop) } else { None };
            // SAFETY: cmd is recording outside a render pass; the slot's work is done.
            let result = unsafe { this.renderer.record_frame(cmd, &frame, stop) };
            this.parts = parts.spare;
            let (recorded, last) = result?;
            this.layers = recorded.layers;
            this.counts = recorded.counts;
            this.levels = recorded.levels;
            this.active_samples = recorded.active_samples;
            Ok(last)
        });
        if let Some((color, depth)) = staging {
            color.destroy(&self.gpu);
            depth.destroy(&self.gpu);
        }
        self.renderer.collect(Slot(0));
        self.gpu.bury();
        result
    }

    fn clear(&self, cmd: vk::CommandBuffer, color: [f32; 3], camera: &Camera) {
        let far = Lens::new(camera).map_or(1.0, |lens| lens.nothing());
        let range = |image: &Image| vk::ImageSubresourceRange {
            aspect_mask: crate::gpu::image::aspect_of(image.format),
            level_count: 1,
            layer_count: 1,
            ..Default::default()
        };
        let [r, g, b] = color;
        self.gpu.barriers(
            cmd,
            &[
                access::image(&self.color, COLOR_REST.discarded(), access::CLEAR),
                access::image(&self.depth, DEPTH_REST.discarded(), access::CLEAR),
            ],
            &[],
        );
        // SAFETY: both images are in TRANSFER_DST_OPTIMAL.
        unsafe {
            self.gpu.device.cmd_clear_color_image(
                cmd,
                self.color.handle,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &vk::ClearColorValue { float32: [r, g, b, 1.0] },
                &[range(&self.color)],
            );
            self.gpu.device.cmd_clear_depth_stencil_image(
                cmd,
                self.depth.handle,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &vk::ClearDepthStencilValue { depth: far, stencil: 0 },
                &[range(&self.depth)],
            );
        }
        self.gpu.barriers(
            cmd,
            &[
                access::image(&self.color, access::CLEAR, COLOR_REST),
                access::image(&self.depth, access::CLEAR, DEPTH_REST),
            ],
            &[],
        );
    }

    /// Times of the last frame, pass by pass.
    pub fn timings(&mut self) -> Vec<Timing> {
        self.renderer.timings(Slot(0)).to_vec()
    }

    /// Frees everything and gives the device back.
    ///
    /// # Errors
    /// Device loss.
    pub fn finish(self) -> Result<Device, Error> {
        let idle = self.device.wait_idle();
        let Self { gpu, renderer, device, foam, .. } = self;
        if let Some(foam) = foam {
            // SAFETY: the device is idle, or lost.
            unsafe { foam.state.destroy() };
        }
        // Freed with the shared objects.
        drop((self.commands, self.color, self.depth, self.scene));
        drop((self.positions, self.densities, self.velocities, self.ids));
        // SAFETY: the device is idle, or lost.
        unsafe { renderer.destroy() };
        gpu.destroy();
        idle.map(|()| device)
    }
}

/// What the foam of the particles goes by.
struct Foaming {
    state: State,
    /// By the particles that are here now.
    stepped: bool,
}

/// Written by the CPU before the submit.
const HOST_WRITE: Access = Access::new(
    vk::PipelineStageFlags2::HOST,
    vk::AccessFlags2::HOST_WRITE,
    vk::ImageLayout::GENERAL,
);

/// A buffer for shaders to read, with its contents.
fn input(gpu: &Arc<Gpu>, name: &str, bytes: &[u8]) -> Result<Buffer, Error> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let size = bytes.len().max(16) as u64;
    let mut buffer = Buffer::new(gpu, name, size, usage, MemoryLocation::CpuToGpu)?;
    buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
    Ok(buffer)
}

fn stream(buffer: &Buffer, stride: u32) -> Stream {
    Stream { buffer: buffer.handle, size: buffer.size, offset: 0, stride }
}

/// The stand-in scene with the sets of its frame.
struct Stage {
    renderer: SceneRenderer,
    descriptors: Descriptors,
}
