//! A renderer in a host: the host stub with the images and buffers of a frame.

mod bubbles;
mod cloud;
mod drawn;
mod shot;

use ash::vk;
use whitewater::headless::Headless;
use whitewater::water::{Exit, Kernels, Shading, Splat};
use whitewater::{
    Access, Config, Count, EnvironmentSource, Equirectangular, Error, Particles, Renderer, Slot,
    Stream, WhitewaterParticles,
};

use super::device::Gpu;
use super::host::{self, COLOR, DEPTH, Data, HOST_WRITE, Stub, Texture};
use super::slow;

pub use bubbles::{Foamed, Soaped};
pub use cloud::{WhitewaterCloud, attenuation, twins};
pub use drawn::{Drawn, DrawnWhitewater, Foaming, Sheets};
use shot::AROUND;
pub use shot::{Shot, is_around};

/// Format of the outputs: single precision, so that it adds no rounding to the shaders'.
pub const OUTPUT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// An extent.
pub fn extent(width: u32, height: u32) -> vk::Extent2D {
    vk::Extent2D { width, height }
}

/// A configuration for tests: a small environment, layers that are kept, sums that do not depend on
/// the order of the particles, and all water in one sheet, because most twins have one. Only the
/// long tests smooth on several levels: the pipeline that composites tiles of several levels takes
/// half of the time to create a renderer, and few tests need it.
pub fn config(size: vk::Extent2D) -> Config {
    Config::new(size, OUTPUT, 4096).with(|it| {
        it.environment_size = 16;
        it.keep_layers = true;
        it.depth_splat = Some(Splat::Compute);
        it.thickness_splat = Some(Splat::Compute);
        it.sheets = 1;
        // Most twins know only the part of the scene directly behind a pixel.
        it.mirror_steps = 0;
        it.exit = Exit::Straight;
        it.kernels = Kernels::Spheres;
        it.coarsening = if slow() { Config::new(size, OUTPUT, 1).coarsening } else { 0 };
    })
}

/// The configuration with coarser levels where water is near.
pub fn coarsening(config: Config) -> Config {
    config.with(|it| it.coarsening = Config::new(config.extent, OUTPUT, 1).coarsening)
}

/// The stand-in scene on a device of its own.
pub fn headless(size: vk::Extent2D) -> Headless {
    Headless::new(Gpu::own().take_device(), &config(size)).expect("headless")
}

/// Destroys the scene and asserts that there were no validation messages.
pub fn finish(headless: Headless) {
    let device = headless.finish().expect("finish");
    assert_eq!(device.take_messages(), Vec::<String>::new());
}

/// A renderer and its host.
pub struct Rig<'g> {
    pub gpu: &'g Gpu,
    pub stub: Stub,
    pub config: Config,
    renderer: Option<Renderer>,
}

impl<'g> Rig<'g> {
    pub fn new(gpu: &'g Gpu, config: &Config) -> Self {
        Self::with_slots(gpu, config, 1)
    }

    pub fn with_slots(gpu: &'g Gpu, config: &Config, slots: u32) -> Self {
        Self::try_new(gpu, config, slots).unwrap_or_else(|error| panic!("{error}"))
    }

    pub fn try_new(gpu: &'g Gpu, config: &Config, slots: u32) -> Result<Self, Error> {
        let stub = Stub::new(gpu, slots);
        let mut renderer = Renderer::new(&gpu.context(slots), config)?;
        // SAFETY: the set-up is submitted before any other record.
        stub.run(|cmd| unsafe { renderer.record_setup(cmd) });
        // SAFETY: as above; nothing else was recorded with this slot.
        stub.run(|cmd| unsafe {
            renderer.record_environment(cmd, Slot(0), &EnvironmentSource::Black)
        })?;
        // SAFETY: its work was waited for.
        unsafe { renderer.collect(Slot(0)) };
        Ok(Self { gpu, stub, config: *config, renderer: Some(renderer) })
    }

    pub fn renderer(&mut self) -> &mut Renderer {
        self.renderer.as_mut().expect("only drop takes it")
    }

    /// Reports that the slot's work is done.
    pub fn collect(&mut self, slot: Slot) {
        // SAFETY: tests wait for a slot before they report it.
        unsafe { self.renderer().collect(slot) };
    }

    /// Reports that what was recorded with the slot is never submitted.
    pub fn abandon(&mut self, slot: Slot) {
        // SAFETY: tests never submit abandoned work, and wait for earlier work.
        unsafe { self.renderer().abandon(slot) };
    }

    /// Records the set-up again, after a reconfigure that replaced the environment.
    pub fn set_up(&mut self) {
        let renderer = self.renderer.as_mut().expect("only drop takes it");
        // SAFETY: the set-up is submitted before any other record.
        self.stub.run(|cmd| unsafe { renderer.record_setup(cmd) });
        self.any_environment(&EnvironmentSource::Black);
    }

    /// Drops the renderer plainly, which leaks it.
    pub fn leak(mut self) {
        drop(self.renderer.take());
    }

    pub fn resize(&mut self, size: vk::Extent2D) {
        self.renderer().resize(size).expect("resize");
        self.config.extent = size;
    }

    /// Sets an environment from an equirectangular image.
    pub fn environment(&mut self, size: vk::Extent2D, texels: &[[f32; 4]]) {
        self.turned_environment(size, texels, (1.0, 0.0, [0.0, 1.0, 0.0]));
    }

    /// Sets an environment from an equirectangular image, multiplied by `scale` and rotated by
    /// `turn`.
    pub fn turned_environment(
        &mut self,
        size: vk::Extent2D,
        texels: &[[f32; 4]],
        (scale, turn, up): (f32, f32, [f32; 3]),
    ) {
        let image = self.map(size, texels);
        let (image, without_sun) = (image.host_image(), None);
        let source = Equirectangular::new(image).with(|it| {
            it.without_sun = without_sun;
            it.scale = scale;
            it.turn = turn;
            it.up = up;
        });
        self.any_environment(&EnvironmentSource::Equirectangular(source));
    }

    /// Sets an environment from an image with the sun and an image without it.
    pub fn environment_with_sun(
        &mut self,
        size: vk::Extent2D,
        [texels, without_sun]: [&[[f32; 4]]; 2],
    ) {
        let [image, without_sun] = [texels, without_sun].map(|texels| self.map(size, texels));
        let (image, without_sun) = (image.host_image(), Some(without_sun.host_image()));
        let up = [0.0, 1.0, 0.0];
        let source = Equirectangular::new(image).with(|it| {
            it.without_sun = without_sun;
            it.up = up;
        });
        self.any_environment(&EnvironmentSource::Equirectangular(source));
    }

    /// A picture that only compute shaders sample.
    pub fn map(&self, size: vk::Extent2D, texels: &[[f32; 4]]) -> Texture {
        let after = Access::new(
            vk::PipelineStageFlags2::COMPUTE_SHADER,
            vk::AccessFlags2::SHADER_SAMPLED_READ,
            vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        );
        let usage = vk::ImageUsageFlags::SAMPLED;
        self.stub.uploaded(OUTPUT, size, usage, bytemuck::cast_slice(texels), after)
    }

    /// A renderer with an environment of values from 0 to 1. (SwiftShader prepares an environment
    /// that is only cleared for draws only; compute shaders would read wrong values at the seams of
    /// the cube.)
    pub fn lit(gpu: &'g Gpu, config: &Config, slots: u32) -> Self {
        let mut rig = Self::with_slots(gpu, config, slots);
        rig.light();
        rig
    }

    /// Sets the environment of [`lit`](Self::lit). With bubble foam it is grey in SwiftShader,
    /// which uses the mip level of one lane, even of a finished one, for a whole group of pixels:
    /// the same ray could get two colours in two draws.
    pub fn light(&mut self) {
        let expected = std::env::var("WHITEWATER_EXPECT_ADAPTER").unwrap_or_default();
        let grey = self.config.bubbles.is_some() && expected.contains("SwiftShader");
        let part = |i: u32, n: u32| if grey { 0.5 } else { (i * 37 % n) as f32 / (n - 1) as f32 };
        let texels: Vec<_> =
            (0..128).map(|i| [part(i, 7), part(i, 11), part(i, 13), 1.0]).collect();
        self.environment(extent(16, 8), &texels);
    }

    /// Sets an environment of any kind, whose images must live until this returns.
    pub fn any_environment(&mut self, source: &EnvironmentSource) {
        let renderer = self.renderer.as_mut().expect("only drop takes it");
        // SAFETY: cmd is recording; the slot's work is done.
        let result =
            self.stub.run(|cmd| unsafe { renderer.record_environment(cmd, Slot(0), source) });
        result.expect("record_environment");
        self.collect(Slot(0));
    }

    /// Usage of outputs: for the host's own passes, and for the path of the composite.
    fn output_usage(&self) -> vk::ImageUsageFlags {
        let host = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED;
        match self.config.composite {
            Some(Shading::Compute) => host | vk::ImageUsageFlags::STORAGE,
            _ => host,
        }
    }

    /// Colour and depth images of the scene as the host has them, filled.
    pub fn scene(&self, shot: &Shot) -> (Texture, Texture) {
        let color = self.stub.uploaded(
            self.config.output_format,
            shot.with_margin(shot.size).0,
            self.output_usage(),
            &color_bytes(self.config.output_format, &shot.pad(shot.size, &shot.color, AROUND)),
            COLOR,
        );
        let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | vk::ImageUsageFlags::SAMPLED;
        let depth = self.stub.uploaded(
            shot.depth_format,
            shot.with_margin(shot.depth_extent).0,
            usage,
            // The margin is nearer than all water.
            &depth_bytes(shot.depth_format, &shot.pad(shot.depth_extent, &shot.depth, 0.5)),
            DEPTH,
        );
        (color, depth)
    }

    /// Tightly packed buffers of the shot's particles.
    pub fn particles(&self, shot: &Shot) -> Cloud {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        Cloud {
            positions: self.stub.data(bytemuck::cast_slice(&shot.positions), usage),
            densities: shot
                .densities
                .as_ref()
                .map(|d| self.stub.data(bytemuck::cast_slice(d), usage)),
            count: shot.positions.len() as u32,
        }
    }

    /// Draws a shot and reads everything back.
    pub fn draw(&mut self, shot: &Shot) -> Drawn {
        let cloud = self.particles(shot);
        let particles = cloud.particles();
        self.draw_particles(shot, &particles)
    }

    /// Draws a shot with other particles.
    pub fn draw_particles(&mut self, shot: &Shot, particles: &Particles) -> Drawn {
        self.draw_whitewater(shot, particles, None)
    }

    /// Draws a shot with whitewater particles.
    pub fn draw_whitewater(
        &mut self,
        shot: &Shot,
        particles: &Particles,
        whitewater: Option<WhitewaterParticles>,
    ) -> Drawn {
        self.try_draw(shot, particles, whitewater).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Message of the error for a shot that cannot be drawn.
    pub fn refused(&mut self, shot: &Shot, whitewater: Option<WhitewaterParticles>) -> String {
        let cloud = self.particles(shot);
        let result = self.try_draw(shot, &cloud.particles(), whitewater);
        result.err().expect("an error").to_string()
    }

    fn try_draw(
        &mut self,
        shot: &Shot,
        particles: &Particles,
        whitewater: Option<WhitewaterParticles>,
    ) -> Result<Drawn, Error> {
        let (color, depth) = self.scene(shot);
        let apart = (!self.config.in_place).then(|| {
            let format = self.config.output_format;
            let bytes = color_bytes(format, &shot.pad(shot.size, &shot.color, AROUND));
            let extent = shot.with_margin(shot.size).0;
            self.stub.uploaded(format, extent, self.output_usage(), &bytes, COLOR)
        });
        let placed = |texture: &Texture, size| {
            texture.host_image().with(|it| it.rect = shot.with_margin(size).1)
        };
        let output = placed(apart.as_ref().unwrap_or(&color), shot.size);
        let theirs = self.config.bubbles.filter(|bubbles| !bubbles.crossfade);
        let blobs = theirs.map(|_| self.blobs(shot));
        let frame = shot.frame(output, placed(&depth, shot.depth_extent), *particles).with(|it| {
            it.scene_color = placed(&color, shot.size);
            it.bubbles = blobs.as_ref().map(Foamed::streams);
            it.whitewater = whitewater;
        });
        let cmd = self.stub.begin(0);
        let renderer = self.renderer.as_mut().expect("only drop takes it");
        // SAFETY: cmd is recording; the slot was waited for; the handles live until this returns.
        let recorded = unsafe { renderer.record(cmd, &frame) };
        self.stub.end(0);
        self.stub.wait(0);
        let drawn = recorded.map(|recorded| self.read(&output, &recorded));
        self.collect(Slot(0));
        drawn
    }
}

impl Drop for Rig<'_> {
    fn drop(&mut self) {
        if let Some(renderer) = self.renderer.take() {
            // SAFETY: idle.
            unsafe {
                let _ = self.gpu.device.device_wait_idle();
                renderer.destroy();
            }
        }
    }
}

/// Tightly packed particles of the host.
pub struct Cloud {
    pub positions: Data,
    pub densities: Option<Data>,
    pub count: u32,
}

impl Cloud {
    pub fn particles(&self) -> Particles {
        Particles::new(stream(&self.positions, 0, 12), Count::Cpu(self.count)).with(|it| {
            it.densities = self.densities.as_ref().map(|d| stream(d, 0, 4));
            it.before = HOST_WRITE;
            it.after = HOST_WRITE;
        })
    }
}

/// A stream over a buffer.
pub fn stream(data: &Data, offset: u64, stride: u32) -> Stream {
    Stream { buffer: data.buffer, size: data.size, offset, stride }
}

fn color_bytes(format: vk::Format, color: &[[f32; 4]]) -> Vec<u8> {
    match host::texel_size(format) {
        16 => bytemuck::cast_slice(color).to_vec(),
        8 => {
            let half = |c: &[f32; 4]| c.map(|v| half::f16::from_f32(v).to_bits());
            color.iter().flat_map(half).flat_map(u16::to_le_bytes).collect()
        }
        _ if format == vk::Format::R8G8B8A8_UNORM => {
            let step = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
            color.iter().flat_map(|c| c.map(step)).collect()
        }
        _ => panic!("{format:?} is not made here"),
    }
}

fn depth_bytes(format: vk::Format, depth: &[f32]) -> Vec<u8> {
    match format {
        vk::Format::D16_UNORM => {
            depth.iter().flat_map(|z| ((z * 65535.0).round() as u16).to_le_bytes()).collect()
        }
        vk::Format::D24_UNORM_S8_UINT | vk::Format::X8_D24_UNORM_PACK32 => {
            let bits = |z: &f32| (f64::from(*z) * 16_777_215.0).round() as u32;
            depth.iter().flat_map(|z| bits(z).to_le_bytes()).collect()
        }
        _ => bytemuck::cast_slice(depth).to_vec(),
    }
}
