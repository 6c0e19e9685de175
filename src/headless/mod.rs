//! Everything that a host engine would provide to the library: a Vulkan device, a scene, submission and read-back.
//! This module serves the tool, tests and examples; an engine that embeds the library does not compile it.
//!
//! [`Headless`] draws one frame at a time. After [`Headless::new`], these methods set the inputs of a frame:
//! [`Headless::particles`] and [`Headless::motion`] the fluid, [`Headless::whitewater`] or, in parts,
//! [`Headless::whitewater_parts`] the whitewater, [`Headless::sky`] or [`Headless::equirectangular`] the environment,
//! and [`Headless::scene`] the background. [`Headless::render`] then draws the frame, and the picture and its layers
//! can be read back. A call that records commands also submits them and waits for them.

mod device;
mod draw;
mod environment;
mod generate;
mod heap;
mod inputs;
mod levels;
mod readback;
pub mod scene;
mod shore;
mod stage;
mod submit;
mod transfer;

use std::ops::Range;
use std::sync::Arc;

use ash::vk;

pub use device::{Device, DeviceOptions};
pub use draw::Background;
pub use generate::Generated;
use generate::Generating;
pub use inputs::{Bubble, Whitewater, WhitewaterParts};
use inputs::{Foamed, Foaming, WhitewaterBuffers};
pub use readback::Picture;
pub use shore::ShoreMesh;
use shore::Shores;
use stage::Stage;
use submit::{Commands, begin, submit};

use crate::bubbles::BlobSimulation;
use crate::composite::way;
use crate::context::Context;
use crate::contract::{Access, Config, Layer, LightVolume, Previous, Slot};
use crate::diagnostics::{ParticleCounts, SmoothingLevels};
use crate::environment::{Environment, Sky};
use crate::error::{Error, VkContext};
use crate::gpu::Gpu;
use crate::gpu::access;
use crate::gpu::buffer::Buffer;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::timing::Timing;
use crate::renderer::Renderer;
use crate::water::Pane;
use crate::water::settings::Shading;

/// Output format: linear, scene-referred.
pub const COLOR_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
/// Depth format of the scene.
pub const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// The scene's colour image between its own passes.
const COLOR_REST: Access = access::COLOR_ATTACHMENT;
/// The scene's depth image between its own passes.
const DEPTH_REST: Access = access::DEPTH_ATTACHMENT;

/// Particle statistics of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Particles in the view.
    pub visible: u32,
    /// Those of the particles in the view that may be visible.
    pub front: u32,
    /// Particles dropped for NaN, infinite or huge positions.
    pub dropped: u32,
    /// Particles classified as spray.
    pub spray: u32,
}

/// Simulations that are stepped once before the frames that show the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stepped {
    /// Surface foam ([`Headless::step`]).
    Foam,
    /// Whitewater emission ([`Headless::generate`]).
    Generate,
    /// Blob dynamics ([`Headless::heap_step`]).
    BlobSimulation,
    /// The map of distances to the shore ([`Headless::shore_map_step`]).
    ShoreMap,
}

/// A renderer together with everything that a host engine would provide. It draws one frame at a time.
pub struct Headless {
    gpu: Arc<Gpu>,
    renderer: Renderer,
    color: Image,
    depth: Image,
    commands: Commands,
    /// Command buffers for the parts of a frame between which the CPU reads data back.
    parts: Vec<vk::CommandBuffer>,
    positions: Option<Buffer>,
    densities: Option<Buffer>,
    velocities: Option<Buffer>,
    ids: Option<Buffer>,
    whitewater: Option<WhitewaterBuffers>,
    bubbles: Option<Foamed>,
    heap: Option<BlobSimulation>,
    shores: Shores,
    generating: Option<Generating>,
    foam: Option<Foaming>,
    region: Option<LightVolume>,
    /// Panes of glass of the scene.
    panes: Vec<Pane>,
    previous: Option<Previous>,
    count: u32,
    /// Index range of the drawn particles; `None` draws all.
    shown: Option<Range<u32>>,
    /// Whether whitewater is drawn.
    whitewater_shown: bool,
    layers: Vec<Layer>,
    counts: Option<ParticleCounts>,
    levels: Option<SmoothingLevels>,
    active_samples: Option<(vk::Buffer, u32)>,
    bubble_words: Option<(vk::Buffer, u32)>,
    scene: Option<Stage>,
    /// The environment without the sun, which lights the scene; set if the host gives such a picture beside one that
    /// contains the sun.
    without_sun: Option<Environment>,
    context: Context,
    device: Device,
}

impl Headless {
    /// Creates the renderer, and sets the built-in sky as environment. Three values of `config` are replaced: the
    /// output format by [`COLOR_FORMAT`], `in_place` and `keep_layers` by true.
    ///
    /// # Errors
    /// Those of [`Context::new`] and [`Renderer::new`].
    pub fn new(device: Device, config: &Config) -> Result<Self, Error> {
        let config =
            Config { output_format: COLOR_FORMAT, in_place: true, keep_layers: true, ..*config };
        // SAFETY: the device is ours, and dropped after its context and all that is made from it.
        let context = unsafe { Context::new(&device.host(1)) }?;
        let gpu = Gpu::new(&context);
        // The renderer checks the extent.
        let made = Renderer::new(&context, &config).and_then(|renderer| {
            match Self::own(&gpu, &device, &config) {
                Ok(own) => Ok((own, renderer)),
                Err(error) => {
                    // SAFETY: nothing was submitted.
                    unsafe { renderer.destroy() };
                    Err(error)
                }
            }
        });
        let ((commands, color, depth), renderer) = match made {
            Ok(made) => made,
            Err(error) => {
                // Nothing was submitted with the objects created before the failure.
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
            whitewater: None,
            bubbles: None,
            heap: None,
            shores: Shores::default(),
            generating: None,
            foam: None,
            region: None,
            panes: Vec::new(),
            previous: None,
            count: 0,
            shown: None,
            whitewater_shown: true,
            layers: Vec::new(),
            counts: None,
            levels: None,
            active_samples: None,
            bubble_words: None,
            scene: None,
            without_sun: None,
            context,
            device,
        };
        if let Err(error) = headless.first_contents() {
            drop(headless.finish());
            return Err(error);
        }
        Ok(headless)
    }

    /// Initializes the images and sets the built-in sky as environment.
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

    /// Creates the objects besides the renderer.
    fn own(gpu: &Gpu, device: &Device, config: &Config) -> Result<(Commands, Image, Image), Error> {
        let extent = config.extent;
        let usage = vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        let mut color = usage | vk::ImageUsageFlags::COLOR_ATTACHMENT;
        // Storage usage only if needed, because some devices do not compress storage images.
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

    /// Fills a command buffer, submits it and waits. `record` returns the command buffer in which its recording
    /// ended.
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

    /// Like [`run_parts`](Self::run_parts), for a recording that stays in one command buffer.
    fn run(
        &mut self,
        record: impl FnOnce(&mut Self, vk::CommandBuffer) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.run_parts(|this, cmd| record(this, cmd).map(|()| cmd))
    }

    /// GPU times of the last step of a kind of simulation, pass by pass; empty before the first step.
    pub fn step_timings(&mut self, which: Stepped) -> Vec<Timing> {
        let slot = Slot(0);
        let times = match which {
            Stepped::Foam => self.foam.as_mut().map(|own| own.state.timings(slot)),
            Stepped::Generate => self.generating.as_mut().map(|own| own.generator.timings(slot)),
            Stepped::BlobSimulation => self.heap.as_mut().map(|own| own.timings(slot)),
            Stepped::ShoreMap => self.shores.map_timings(slot),
        };
        times.unwrap_or_default().to_vec()
    }

    /// Times of the last frame, pass by pass, without its [steps](Self::step_timings).
    pub fn timings(&mut self) -> Vec<Timing> {
        self.renderer.timings(Slot(0)).to_vec()
    }

    /// Frees everything and returns the device.
    ///
    /// # Errors
    /// Device loss.
    pub fn finish(mut self) -> Result<Device, Error> {
        let idle = self.device.wait_idle();
        self.drop_shores();
        let Self { gpu, renderer, device, foam, generating, heap, .. } = self;
        if let Some(heap) = heap {
            // SAFETY: the device is idle, or lost.
            unsafe { heap.destroy() };
        }
        if let Some(generating) = generating {
            // SAFETY: the device is idle, or lost.
            unsafe { generating.generator.destroy() };
        }
        if let Some(foam) = foam {
            // SAFETY: the device is idle, or lost.
            unsafe { foam.state.destroy() };
        }
        // Freed with the shared objects.
        drop((self.commands, self.color, self.depth, self.scene));
        drop((self.positions, self.densities, self.velocities, self.ids, self.whitewater));
        drop((self.bubbles, self.shores, self.without_sun));
        // SAFETY: the device is idle, or lost.
        unsafe { renderer.destroy() };
        gpu.destroy();
        idle.map(|()| device)
    }
}
