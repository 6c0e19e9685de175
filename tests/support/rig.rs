//! A renderer in a host: the host stub with the images and buffers of a frame, and what comes back.

use ash::vk;
use whitewater::water::{Shading, Splat};
use whitewater::{
    Access, Camera, Config, Count, EnvironmentSource, Equirectangular, Error, Frame, HostImage,
    Layer, Particles, Previous, Recorded, Renderer, Settings, Slot, SmoothingLevel,
    SmoothingLevels, Stream, Sun,
};

use super::device::Gpu;
use super::host::{self, COLOR, DEPTH, Data, HOST_WRITE, Stub, Texture};
use super::scenes;
use crate::reference::{Image, View, foam};

/// Format of the outputs: its rounding is that of the shaders.
pub const OUTPUT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// A size.
pub fn extent(width: u32, height: u32) -> vk::Extent2D {
    vk::Extent2D { width, height }
}

/// A configuration for tests: small environment, layers kept, sums whose order is no matter, and all
/// water in one sheet, as most twins have it.
pub fn config(size: vk::Extent2D) -> Config {
    Config {
        environment_size: 16,
        keep_layers: true,
        depth_splat: Some(Splat::Compute),
        thickness_splat: Some(Splat::Compute),
        sheets: 1,
        ..Config::new(size, OUTPUT, 4096)
    }
}

/// Colour beside a view.
pub const AROUND: [f32; 4] = [50.0, 0.0, 25.0, 0.5];

/// What a frame shows.
#[derive(Clone)]
pub struct Shot {
    /// Of the view.
    pub size: vk::Extent2D,
    /// Columns before and behind the view, rows above and below it, in all images of the host's.
    pub margin: [u32; 4],
    pub camera: Camera,
    /// Where the sun does not come.
    pub sun: Sun,
    /// The frame before.
    pub previous: Option<Previous>,
    pub settings: Settings,
    pub positions: Vec<[f32; 3]>,
    pub densities: Option<Vec<f32>>,
    /// The scene's colour, of the output's size.
    pub color: Vec<[f32; 4]>,
    /// The scene's device depth and its size.
    pub depth: Vec<f32>,
    pub depth_extent: vk::Extent2D,
    pub depth_format: vk::Format,
}

impl Shot {
    /// Particles (eye space x, y, depth) of a radius before a far, coloured scene.
    pub fn new(size: vk::Extent2D, lens: scenes::Lens, radius: f32, points: &[[f32; 3]]) -> Self {
        let camera = scenes::camera(lens, size);
        let mut shot = Self {
            size,
            margin: [0; 4],
            positions: scenes::world(&camera, points),
            camera,
            sun: Sun::default(),
            previous: None,
            settings: scenes::settings(radius),
            densities: None,
            color: Vec::new(),
            depth: Vec::new(),
            depth_extent: size,
            depth_format: vk::Format::D32_SFLOAT,
        };
        shot.color = gradient(size);
        shot.scene_depth(|_, _| None);
        shot
    }

    /// The farthest apart that two depths of one surface are, as the renderer rounds it.
    pub fn falloff(&self) -> f32 {
        self.settings.water.depth_falloff * self.settings.water.radius()
    }

    /// A frame of it over its own scene, with slot 0.
    pub fn frame(&self, output: HostImage, depth: HostImage, particles: Particles) -> Frame<'_> {
        Frame {
            slot: Slot(0),
            output,
            scene_color: output,
            scene_depth: depth,
            particles,
            camera: self.camera,
            sun: self.sun,
            previous: self.previous,
            settings: &self.settings,
        }
    }

    /// Size of an image round a view of a size, and where the view lies in it.
    pub fn with_margin(&self, view: vk::Extent2D) -> (vk::Extent2D, vk::Rect2D) {
        let [left, right, above, below] = self.margin;
        let whole = extent(left + view.width + right, above + view.height + below);
        let offset = vk::Offset2D { x: left as i32, y: above as i32 };
        (whole, vk::Rect2D { offset, extent: view })
    }

    /// The texels of such an image.
    fn pad<T: Copy>(&self, view: vk::Extent2D, texels: &[T], around: T) -> Vec<T> {
        let (whole, rect) = self.with_margin(view);
        let mut padded = vec![around; (whole.width * whole.height) as usize];
        for (y, row) in texels.chunks_exact(view.width as usize).enumerate() {
            let at = (y + rect.offset.y as usize) * whole.width as usize + rect.offset.x as usize;
            padded[at..at + row.len()].copy_from_slice(row);
        }
        padded
    }

    /// The twins' camera.
    pub fn view(&self, size: vk::Extent2D) -> View {
        scenes::twin(&self.camera, size)
    }

    /// World to the twins' eye space.
    pub fn camera_view(&self) -> glam::DMat4 {
        self.view(self.depth_extent).view
    }

    /// Fills the scene's depth: eye depth of each of its texels; none: nothing there.
    pub fn scene_depth(&mut self, eye: impl Fn(u32, u32) -> Option<f64>) {
        let view = self.view(self.depth_extent);
        let far = view.far().map_or_else(
            || view.device_depth(f64::INFINITY),
            |_| {
                let farther = view.eye_depth(1.0) > view.eye_depth(0.0);
                f64::from(farther)
            },
        );
        let size = self.depth_extent;
        self.depth = (0..size.height)
            .flat_map(|y| (0..size.width).map(move |x| (x, y)))
            .map(|(x, y)| {
                let device = eye(x, y).map_or(far, |d| view.device_depth(d));
                device.clamp(0.0, 1.0) as f32
            })
            .collect();
    }

    /// The eye depth of the scene as the depth image has it, for the twins; one value a texel.
    pub fn scene_eye(&self) -> Image<f64> {
        let view = self.view(self.depth_extent);
        let eye = |z: &f32| {
            let d = view.eye_depth(f64::from(*z));
            if d > 0.0 { d } else { f64::INFINITY }
        };
        Image {
            width: self.depth_extent.width as usize,
            height: self.depth_extent.height as usize,
            data: self.depth.iter().map(eye).collect(),
        }
    }
}

impl Shot {
    /// The scene's eye depth at the pixels of the output halved `level` times: the nearest texel.
    pub fn scene_at(&self, size: vk::Extent2D, level: u32) -> Image<f64> {
        let eye = self.scene_eye();
        let block = 1_usize << level;
        let (width, height) = (size.width as usize, size.height as usize);
        let texel = |i: usize, full: usize, texels: usize| {
            let at = (i as f64 + 0.5) * block as f64 * texels as f64 / full as f64;
            (at.floor() as usize).min(texels - 1)
        };
        Image::from_fn(width.div_ceil(block), height.div_ceil(block), |x, y| {
            eye.at(texel(x, width, eye.width), texel(y, height, eye.height))
        })
    }
}

/// A scene's colour that differs from pixel to pixel, smoothly.
pub fn gradient(size: vk::Extent2D) -> Vec<[f32; 4]> {
    (0..size.height)
        .flat_map(|y| (0..size.width).map(move |x| (x as f32, y as f32)))
        .map(|(x, y)| [0.125 + x / 256.0, 0.25 + y / 256.0, 0.5 + (x - y) / 512.0, 0.75])
        .collect()
}

/// What a frame gave.
#[derive(Clone)]
pub struct Drawn {
    pub output: Image<[f32; 4]>,
    /// The output's image with what lies beside the view.
    pub whole: Image<[f32; 4]>,
    pub depth: Image<f32>,
    /// Of the finest level in use.
    pub surface: Image<f32>,
    pub plan: Image<u32>,
    /// Of the coarser level, while it fades in.
    pub coarser: Option<(Image<f32>, Image<u32>)>,
    pub levels: SmoothingLevels,
    /// Of all water.
    pub thickness: Image<f32>,
    /// With two sheets.
    pub sheets: Option<Sheets>,
    /// With foam.
    pub foam: Option<Foaming>,
    /// Optical depth, with spray.
    pub spray: Option<Image<f32>>,
    /// What of it the sun lights.
    pub lit_spray: Option<Image<f32>>,
    /// With motion vectors.
    pub motion: Option<Image<[f32; 2]>>,
    /// Height of the surface noise, where it is drawn.
    pub noise: Option<Image<f32>>,
    /// The light's maps: metres along the light to the first fluid; metres of water and foam, and both
    /// times where they lie; light over what comes without water.
    pub light_front: Option<Image<f32>>,
    /// As above.
    pub light_thickness: Option<Image<[f32; 4]>>,
    /// As above.
    pub caustics: Option<Image<f32>>,
    /// The host's shadow map as a Fourier basis, all pages.
    pub shadow_basis: Option<Image<[f32; 4]>>,
    pub work: Work,
}

/// What a frame worked on.
#[derive(Clone, Debug, Default)]
pub struct Work {
    /// Particles on the screen, and those of them that can show.
    pub visible: u32,
    pub front: u32,
    /// Particles dropped for their positions, and set aside as spray.
    pub dropped: u32,
    pub set_aside: u32,
    /// Tiles with water; then those that iteration 1, 2, … runs over.
    pub tiles: Vec<u32>,
}

/// What a frame with foam gave besides.
#[derive(Clone)]
pub struct Foaming {
    pub depth: Image<f32>,
    /// Of all foam, and of what lies right behind the frontmost.
    pub thickness: Image<[f32; 2]>,
    /// Of the water before the frontmost.
    pub before: Image<f32>,
    /// Times that all are halved.
    pub level: u32,
}

impl Foaming {
    /// What each pixel shows of it: depth, and both thicknesses.
    pub fn seen(&self, shot: &Shot) -> Image<(f64, [f64; 2])> {
        let (scene, layers) = (shot.scene_at(shot.size, 0), (&self.depth, &self.thickness));
        let spacing = f64::from(shot.settings.water.spacing);
        Image::from_fn(scene.width, scene.height, |x, y| {
            foam::seen(layers, (x, y), self.level, scene.at(x, y), spacing)
        })
    }
}

/// What a frame with two sheets gave besides.
#[derive(Clone)]
pub struct Sheets {
    /// Depth between them, for each texel of the thickness.
    pub boundaries: Image<f32>,
    /// Thickness of the front one, of the back one and of the window between them.
    pub thickness: Image<[f32; 3]>,
    /// Surface and plan of the back one.
    pub surface: Image<f32>,
    pub plan: Image<u32>,
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
        // SAFETY: the device outlives the rig.
        let mut renderer = unsafe { Renderer::new(&gpu.host(slots), config) }?;
        // SAFETY: submitted before any record.
        stub.run(|cmd| unsafe { renderer.record_setup(cmd) });
        Ok(Self { gpu, stub, config: *config, renderer: Some(renderer) })
    }

    pub fn renderer(&mut self) -> &mut Renderer {
        self.renderer.as_mut().expect("only drop takes it")
    }

    /// Records the set-up again: after a reconfigure that made the environment anew.
    pub fn set_up(&mut self) {
        let renderer = self.renderer.as_mut().expect("only drop takes it");
        // SAFETY: submitted before any record.
        self.stub.run(|cmd| unsafe { renderer.record_setup(cmd) });
    }

    /// Leaves the renderer to a plain drop: it leaks.
    pub fn leak(mut self) {
        drop(self.renderer.take());
    }

    pub fn resize(&mut self, size: vk::Extent2D) {
        self.renderer().resize(size).expect("resize");
        self.config.extent = size;
    }

    /// An environment of an equirectangular image.
    pub fn environment(&mut self, size: vk::Extent2D, texels: &[[f32; 4]]) {
        self.turned_environment(size, texels, 1.0, 0.0);
    }

    /// The same, brighter and turned.
    pub fn turned_environment(
        &mut self,
        size: vk::Extent2D,
        texels: &[[f32; 4]],
        scale: f32,
        turn: f32,
    ) {
        let after = Access::new(
            vk::PipelineStageFlags2::COMPUTE_SHADER,
            vk::AccessFlags2::SHADER_SAMPLED_READ,
            vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        );
        let image = self.stub.uploaded(
            OUTPUT,
            size,
            vk::ImageUsageFlags::SAMPLED,
            bytemuck::cast_slice(texels),
            after,
        );
        let source = Equirectangular { image: image.host_image(), scale, turn };
        self.any_environment(&EnvironmentSource::Equirectangular(source));
    }

    /// A renderer in an environment from 0 to 1. (Where it was only cleared, SwiftShader prepares it
    /// for draws alone: compute reads garbage at the seams of the cube.)
    pub fn lit(gpu: &'g Gpu, config: &Config, slots: u32) -> Self {
        let mut rig = Self::with_slots(gpu, config, slots);
        rig.light();
        rig
    }

    /// That environment.
    pub fn light(&mut self) {
        let part = |i: u32, n: u32| (i * 37 % n) as f32 / (n - 1) as f32;
        let texels: Vec<_> =
            (0..128).map(|i| [part(i, 7), part(i, 11), part(i, 13), 1.0]).collect();
        self.environment(extent(16, 8), &texels);
    }

    /// An environment of any kind, whose images live to the end of this.
    pub fn any_environment(&mut self, source: &EnvironmentSource) {
        let renderer = self.renderer.as_mut().expect("only drop takes it");
        // SAFETY: cmd is recording; the slot's work is done.
        let result =
            self.stub.run(|cmd| unsafe { renderer.record_environment(cmd, Slot(0), source) });
        result.expect("record_environment");
        renderer.collect(Slot(0));
    }

    /// Usage of outputs: as between the host's own passes, and what the composite's way needs.
    fn output_usage(&self) -> vk::ImageUsageFlags {
        let host = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED;
        match self.config.composite {
            Some(Shading::Compute) => host | vk::ImageUsageFlags::STORAGE,
            _ => host,
        }
    }

    /// The images of a frame as its host has them: colour and depth of the scene, filled.
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
            // Nearer than all water.
            &depth_bytes(shot.depth_format, &shot.pad(shot.depth_extent, &shot.depth, 0.5)),
            DEPTH,
        );
        (color, depth)
    }

    /// Buffers of packed particles.
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

    /// Draws a shot with other particles than its own.
    pub fn draw_particles(&mut self, shot: &Shot, particles: &Particles) -> Drawn {
        let (color, depth) = self.scene(shot);
        let apart = (!self.config.in_place).then(|| {
            let format = self.config.output_format;
            let bytes = color_bytes(format, &shot.pad(shot.size, &shot.color, AROUND));
            let extent = shot.with_margin(shot.size).0;
            self.stub.uploaded(format, extent, self.output_usage(), &bytes, COLOR)
        });
        let placed = |texture: &Texture, size| HostImage {
            rect: shot.with_margin(size).1,
            ..texture.host_image()
        };
        let output = placed(apart.as_ref().unwrap_or(&color), shot.size);
        let frame = Frame {
            scene_color: placed(&color, shot.size),
            ..shot.frame(output, placed(&depth, shot.depth_extent), *particles)
        };
        let cmd = self.stub.begin(0);
        let renderer = self.renderer.as_mut().expect("only drop takes it");
        // SAFETY: cmd is recording; the slot was waited for; the handles live to the end of this.
        let recorded = unsafe { renderer.record(cmd, &frame) };
        self.stub.end(0);
        self.stub.wait(0);
        let recorded = recorded.unwrap_or_else(|error| panic!("{error}"));
        let drawn = self.read(&output, &recorded);
        self.renderer().collect(Slot(0));
        drawn
    }

    /// Reads the output and the kept layers.
    pub fn read(&self, output: &HostImage, recorded: &Recorded) -> Drawn {
        let bytes = self.stub.download(
            output.image,
            output.format,
            output.aspect,
            output.extent.into(),
            output.after,
        );
        let levels = self.levels(recorded);
        let whole = picture(output.format, output.extent, &bytes);
        let empty = || Image::new(0, 0, 0.0);
        let mut drawn = Drawn {
            output: crop(&whole, output.rect),
            whole,
            depth: empty(),
            surface: empty(),
            plan: Image::new(0, 0, 0),
            coarser: None,
            levels,
            thickness: empty(),
            sheets: None,
            foam: None,
            spray: None,
            lit_spray: None,
            motion: None,
            noise: None,
            light_front: None,
            light_thickness: None,
            caustics: None,
            shadow_basis: None,
            work: Work::default(),
        };
        if let Some(counts) = &recorded.counts {
            let size = 256 * u64::from(counts.chunks);
            let back = self.stub.sized(size, vk::BufferUsageFlags::TRANSFER_DST);
            self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, counts.all, &back));
            for chunk in back.bytes().chunks_exact(256) {
                let words: Vec<u32> = words(chunk).collect();
                drawn.work.visible += words[0] + words[5];
                drawn.work.dropped += words[18];
                drawn.work.set_aside += words[19];
            }
            self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, counts.front, &back));
            for chunk in back.bytes().chunks_exact(256) {
                let words: Vec<u32> = words(chunk).collect();
                drawn.work.front += words[0] + words[5];
            }
        }
        if let Some(tiles) = recorded.tiles {
            let back = self.stub.sized(16 * 259, vk::BufferUsageFlags::TRANSFER_DST);
            self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, tiles, &back));
            let words: Vec<u32> = words(back.bytes()).collect();
            drawn.work.tiles = words.chunks_exact(4).skip(1).take(257).map(|w| w[3]).collect();
            drawn.work.tiles.insert(0, words[1]);
        }
        let [a, b, back] = &levels.level;
        let fading = a.texel[3] > 0.0 && b.texel[3] > 0.0;
        let coarser = if a.texel[2] > b.texel[2] { a } else { b };
        let mut second = (empty(), Image::new(0, 0, 0));
        let mut sheets = recorded.sheets.map(|buffer| Sheets {
            boundaries: self.boundaries(buffer, output.rect.extent),
            thickness: Image::new(0, 0, [0.0; 3]),
            surface: empty(),
            plan: Image::new(0, 0, 0),
        });
        let mut foam = Foaming {
            depth: empty(),
            thickness: Image::new(0, 0, [0.0; 2]),
            before: empty(),
            level: self.config.thickness_level,
        };
        let mut foams = false;
        for layer in &recorded.layers {
            let whole = layer.extent.into();
            match layer.name {
                "water.depth" => drawn.depth = self.floats(layer, whole),
                "water.thickness" if layer.format == vk::Format::R32G32_SFLOAT => {
                    let both = self.pairs(layer, whole);
                    drawn.thickness = both.map(|t| t[0]);
                    foam.before = both.map(|t| t[1]);
                }
                "water.thickness" => drawn.thickness = self.floats(layer, whole),
                "foam.depth" => (foam.depth, foams) = (self.floats(layer, whole), true),
                "spray" => {
                    let both = self.halves(layer, whole);
                    drawn.spray = Some(both.map(|s| s[0]));
                    drawn.lit_spray = Some(both.map(|s| s[1]));
                }
                "motion" => drawn.motion = Some(self.pairs(layer, whole)),
                "noise" => drawn.noise = Some(self.floats(layer, whole)),
                "light.front" => drawn.light_front = Some(self.floats(layer, whole)),
                "light.thickness" => {
                    let bytes = self.bytes(layer, whole);
                    drawn.light_thickness = Some(picture(layer.format, layer.extent, &bytes));
                }
                "light.shadow" => {
                    let bytes = self.bytes(layer, whole);
                    drawn.shadow_basis = Some(picture(layer.format, layer.extent, &bytes));
                }
                "light.caustics" => drawn.caustics = Some(self.floats(layer, whole)),
                "foam.thickness" => foam.thickness = self.pairs(layer, whole),
                "water.thickness.sheets" => {
                    let sheets = sheets.as_mut().expect("boundaries of two sheets");
                    sheets.thickness = self.sheets(layer, whole);
                }
                "water.surface" => {
                    drawn.surface = self.floats(layer, area(levels.finer()));
                    if let Some(sheets) = &mut sheets {
                        sheets.surface = self.floats(layer, area(back));
                    }
                    if fading {
                        second.0 = self.floats(layer, area(coarser));
                    }
                }
                "water.iterations" => {
                    assert_eq!(layer.format, vk::Format::R32_UINT);
                    drawn.plan = self.texels(layer, area(levels.finer()));
                    if let Some(sheets) = &mut sheets {
                        sheets.plan = self.texels(layer, area(back));
                    }
                    if fading {
                        second.1 = self.texels(layer, area(coarser));
                    }
                }
                other => panic!("an unknown layer {other}"),
            }
        }
        drawn.coarser = fading.then_some(second);
        drawn.sheets = sheets;
        drawn.foam = foams.then_some(foam);
        drawn
    }

    /// At which resolutions the frame was smoothed.
    fn levels(&self, recorded: &Recorded) -> SmoothingLevels {
        let size = size_of::<SmoothingLevels>();
        let back = self.stub.sized(size as u64, vk::BufferUsageFlags::TRANSFER_DST);
        // Of no frame: none in use.
        let Some(levels) = recorded.levels else { return bytemuck::Zeroable::zeroed() };
        self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, levels, &back));
        bytemuck::pod_read_unaligned(&back.bytes()[..size])
    }

    /// The boundary of each texel of a frame's thickness.
    fn boundaries(&self, buffer: vk::Buffer, frame: vk::Extent2D) -> Image<f32> {
        let texels = |pixels: u32| pixels.div_ceil(1 << self.config.thickness_level) as usize;
        let (width, height) = (texels(frame.width), texels(frame.height));
        let size = 4 * (width * height) as u64;
        let back = self.stub.sized(size, vk::BufferUsageFlags::TRANSFER_DST);
        self.stub.run(|cmd| self.stub.record_buffer_copy(cmd, buffer, &back));
        Image { width, height, data: words(back.bytes()).map(f32::from_bits).collect() }
    }

    fn bytes(&self, layer: &Layer, area: vk::Rect2D) -> Vec<u8> {
        let color = vk::ImageAspectFlags::COLOR;
        self.stub.download(layer.image, layer.format, color, area, layer.access)
    }

    fn texels(&self, layer: &Layer, area: vk::Rect2D) -> Image<u32> {
        let (width, height) = (area.extent.width as usize, area.extent.height as usize);
        Image { width, height, data: words(&self.bytes(layer, area)).collect() }
    }

    /// Front, back and window.
    fn sheets(&self, layer: &Layer, area: vk::Rect2D) -> Image<[f32; 3]> {
        assert_eq!(layer.format, vk::Format::R32G32B32A32_SFLOAT);
        picture(layer.format, area.extent, &self.bytes(layer, area))
            .map(|[x, y, z, _]| [*x, *y, *z])
    }

    fn pairs(&self, layer: &Layer, area: vk::Rect2D) -> Image<[f32; 2]> {
        assert_eq!(layer.format, vk::Format::R32G32_SFLOAT);
        let bytes = self.bytes(layer, area);
        let pairs = bytes.chunks_exact(8).map(bytemuck::pod_read_unaligned).collect();
        let (width, height) = (area.extent.width as usize, area.extent.height as usize);
        Image { width, height, data: pairs }
    }

    fn halves(&self, layer: &Layer, area: vk::Rect2D) -> Image<[f32; 2]> {
        assert_eq!(layer.format, vk::Format::R16G16_SFLOAT);
        let bytes = self.bytes(layer, area);
        let half = |low, high| half::f16::from_le_bytes([low, high]).to_f32();
        let both = |b: &[u8]| [half(b[0], b[1]), half(b[2], b[3])];
        let (width, height) = (area.extent.width as usize, area.extent.height as usize);
        Image { width, height, data: bytes.chunks_exact(4).map(both).collect() }
    }

    fn floats(&self, layer: &Layer, area: vk::Rect2D) -> Image<f32> {
        self.texels(layer, area).map(|bits| f32::from_bits(*bits))
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

/// Packed particles of the host's.
pub struct Cloud {
    pub positions: Data,
    pub densities: Option<Data>,
    pub count: u32,
}

impl Cloud {
    pub fn particles(&self) -> Particles {
        Particles {
            densities: self.densities.as_ref().map(|d| stream(d, 0, 4)),
            before: HOST_WRITE,
            after: HOST_WRITE,
            ..Particles::new(stream(&self.positions, 0, 12), Count::Cpu(self.count))
        }
    }
}

/// A stream over a buffer.
pub fn stream(data: &Data, offset: u64, stride: u32) -> Stream {
    Stream { buffer: data.buffer, size: data.size, offset, stride }
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u32> + '_ {
    bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned)
}

fn color_bytes(format: vk::Format, color: &[[f32; 4]]) -> Vec<u8> {
    match host::texel_size(format) {
        16 => bytemuck::cast_slice(color).to_vec(),
        8 => {
            let half = |c: &[f32; 4]| c.map(|v| half::f16::from_f32(v).to_bits());
            color.iter().flat_map(half).flat_map(u16::to_le_bytes).collect()
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

fn picture(format: vk::Format, extent: vk::Extent2D, bytes: &[u8]) -> Image<[f32; 4]> {
    let data: Vec<[f32; 4]> = match host::texel_size(format) {
        16 => bytes.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect(),
        4 => {
            assert_eq!(format, vk::Format::R8G8B8A8_SNORM);
            let part = |v: u8| (f32::from(v.cast_signed()) / 127.0).max(-1.0);
            bytes.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]].map(part)).collect()
        }
        _ => bytes
            .chunks_exact(8)
            .map(|c| {
                let half: [u16; 4] = bytemuck::pod_read_unaligned(c);
                half.map(|v| half::f16::from_bits(v).to_f32())
            })
            .collect(),
    };
    Image { width: extent.width as usize, height: extent.height as usize, data }
}

fn crop(whole: &Image<[f32; 4]>, part: vk::Rect2D) -> Image<[f32; 4]> {
    let (width, height) = (part.extent.width as usize, part.extent.height as usize);
    let (x, y) = (part.offset.x as usize, part.offset.y as usize);
    let rows = whole.data.chunks_exact(whole.width).skip(y).take(height);
    Image { width, height, data: rows.flat_map(|row| row[x..x + width].to_vec()).collect() }
}

/// Where a level lies.
fn area(level: &SmoothingLevel) -> vk::Rect2D {
    let [x, y, width, height] = level.rect;
    let extent = vk::Extent2D { width: width as u32, height: height as u32 };
    vk::Rect2D { offset: vk::Offset2D { x, y }, extent }
}
