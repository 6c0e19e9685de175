//! Compares shoreline foam, contact foam and the distance map with twins and closed forms.

mod composite;
mod contact;
mod flight;
mod life;
mod map;
mod order;
mod settings;
mod shade;
mod shoreline;
mod slopes;
mod strip;
mod temporal;
mod tiles;
mod unchanged;

use std::sync::OnceLock;

use ash::vk;
use glam::{DMat3, DVec3};
use whitewater::shore::texture;
use whitewater::shore::{
    Area, Edge, Heights, Measure, ShoreConfig, ShoreMap, ShoreMapConfig, ShoreMapStep,
    ShoreSettings,
};
use whitewater::{Access, Config, Error, ShoreDistances, Shoreline, Slot, Surface};

use crate::reference::Image;
use crate::reference::shore as twin;
use crate::reference::shore::foam;
use crate::reference::shore::texture::Texture as Levels;
use crate::reference::shore::{Bounded, Clock, U, Water, exact};
use crate::support::device::{Gpu, filters_in_halves};
use crate::support::host::{HOST_WRITE, Stub, Texture};
use crate::support::rig::{Shot, config, extent};

/// Layout and access of distance and height images between a host's commands.
const SAMPLED: Access = Access::new(
    vk::PipelineStageFlags2::from_raw(
        vk::PipelineStageFlags2::FRAGMENT_SHADER.as_raw()
            | vk::PipelineStageFlags2::COMPUTE_SHADER.as_raw(),
    ),
    vk::AccessFlags2::SHADER_SAMPLED_READ,
    vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
);

/// Size of the foam texture in these tests, and the seed of texture and noise.
const WEB: u32 = 128;
const SEED: u32 = 3;

fn shore_config(edge: Edge) -> ShoreConfig {
    ShoreConfig::default().with(|it| {
        it.edge = edge;
        it.texture_size = WEB;
        it.seed = SEED;
    })
}

fn with_shore(size: vk::Extent2D, edge: Edge) -> Config {
    config(size).with(|it| it.shore = Some(shore_config(edge)))
}

/// A distance map, and the host that records its steps.
struct Mapped<'g> {
    gpu: &'g Gpu,
    stub: Stub,
    map: Option<ShoreMap>,
    size: u32,
}

impl<'g> Mapped<'g> {
    fn new(gpu: &'g Gpu, size: u32) -> Self {
        Self::with_slots(gpu, size, 1)
    }

    fn with_slots(gpu: &'g Gpu, size: u32, slots: u32) -> Self {
        let config = ShoreMapConfig::default().with(|it| {
            it.size = size;
            it.max_meshes = 4;
        });
        let map = ShoreMap::new(&gpu.context(slots), &config);
        let map = Some(map.unwrap_or_else(|error| panic!("{error}")));
        Self { gpu, stub: Stub::new(gpu, slots), map, size }
    }

    /// An image of heights.
    fn image(&self, heights: &Image<f32>) -> Texture {
        let size = extent(heights.width as u32, heights.height as u32);
        let usage = vk::ImageUsageFlags::SAMPLED;
        let bytes = bytemuck::cast_slice(&heights.data);
        self.stub.uploaded(vk::Format::R32_SFLOAT, size, usage, bytes, SAMPLED)
    }

    fn try_step(
        &mut self,
        area: &Area,
        heights: Heights<'_>,
        changed: Option<[[f32; 2]; 2]>,
    ) -> Result<(), Error> {
        let (before, after) = (HOST_WRITE, HOST_WRITE);
        let step = ShoreMapStep::new(Slot(0), *area, heights).with(|it| {
            it.changed = changed;
            it.before = before;
            it.after = after;
        });
        let map = self.map.as_mut().expect("only drop takes it");
        // SAFETY: the commands are submitted at once and waited for, and the handles outlive them.
        self.stub.run(|cmd| unsafe { map.record_step(cmd, &step) })
    }

    fn step(&mut self, area: &Area, heights: Heights<'_>, changed: Option<[[f32; 2]; 2]>) {
        self.try_step(area, heights, changed).unwrap_or_else(|error| panic!("{error}"));
    }

    /// A step with the heights of an image.
    fn image_step(&mut self, area: &Area, heights: &Image<f32>, changed: Option<[[f32; 2]; 2]>) {
        let image = self.image(heights);
        self.step(area, Heights::Image(image.host_image()), changed);
    }

    /// The distances in metres.
    fn distances(&self) -> Image<f32> {
        let size = extent(self.size, self.size);
        let image = self.map.as_ref().expect("only drop takes it").distances();
        let color = vk::ImageAspectFlags::COLOR;
        let format = vk::Format::R32_SFLOAT;
        let bytes = self.stub.download(image, format, color, size.into(), SAMPLED);
        let data = bytes.chunks_exact(4).map(bytemuck::pod_read_unaligned).collect();
        Image { width: self.size as usize, height: self.size as usize, data }
    }

    fn shore_distances(&self) -> ShoreDistances {
        self.map.as_ref().and_then(ShoreMap::shore_distances).expect("a step before")
    }
}

impl Drop for Mapped<'_> {
    fn drop(&mut self) {
        if let Some(map) = self.map.take() {
            // SAFETY: the device is idle.
            unsafe {
                let _ = self.gpu.device.device_wait_idle();
                map.destroy();
            }
        }
    }
}

/// The built-in noise and foam texture of the twin.
fn textures() -> &'static [Levels<4>; 2] {
    static TEXTURES: OnceLock<[Levels<4>; 2]> = OnceLock::new();
    TEXTURES.get_or_init(|| {
        let noise = Levels::new(256, &texture::noise(256, SEED));
        let all = [noise, Levels::web(WEB as usize, &texture::web(WEB, SEED))];
        all.map(|texture| texture.filtered_in_halves(filters_in_halves()))
    })
}

/// Two horizontal axes for this up axis, as the crate chooses them: x and z for y.
fn level_axes(up: DVec3) -> [DVec3; 2] {
    let first = if up.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
    let east = (first - up * up.dot(first)).normalize();
    [east, east.cross(up)]
}

/// The uniform data of a level surface, from the matrices that the crate gets, with their errors in
/// single precision. The inverse of a rigid transform consists of sums of products of three numbers
/// over one of them: 32u of the largest.
fn water(shot: &Shot, up: DVec3, level: f64) -> Water {
    let view = shot.view(shot.size);
    let back = view.view.inverse();
    let eye = back.w_axis.truncate();
    let turn = DMat3::from_mat4(back).transpose();
    let moved = view.view.w_axis.truncate().length() + eye.length();
    let row = |axis: DVec3, less: f64| {
        let along = (turn * axis).to_array().map(|v| exact(v).wider(32.0 * U));
        let offset = exact(axis.dot(eye) - less).wider(32.0 * U * (moved + less.abs()));
        [along[0], along[1], along[2], offset]
    };
    let [east, north] = level_axes(up);
    let (step, origin) = (view.slope_step(), view.ray_at(glam::DVec2::ZERO));
    let few = |v: f64| exact(v).wider(4.0 * U * v.abs());
    Water {
        slope: [few(step.x), few(step.y), few(origin.x), few(origin.y)],
        up: row(up, level),
        east: row(east, 0.0),
        north: row(north, 0.0),
    }
}

/// Whether pixels are shaded in pairs, by the simpler pipeline that most frames use.
fn is_shared(shot: &Shot) -> bool {
    let Some(shore) = &shot.shore else { return false };
    let s = &shot.settings.shore.shoreline;
    let noises = [s.frequency_noise, s.speed_noise, s.rise_noise, s.threshold_noise];
    let mut scales: Vec<_> =
        noises.iter().filter(|n| n.amplitude != 0.0).map(|n| n.scale.to_bits()).collect();
    scales.sort_unstable();
    scales.dedup();
    let bends = [s.warp, s.texture_warp].iter().filter(|n| n.amplitude != 0.0).count();
    let layers = s.layers.iter().filter(|layer| layer.weight > 0.0).count();
    !matches!(shore.surface, Some(Surface::Depth(_)))
        && !matches!(shore.shoreline, Some(Shoreline::Screen))
        && shore.mask.is_none()
        && shot.depth_extent == shot.size
        && scales.len() + bends <= 2
        && layers <= 2
}

/// The position at which a pair's shared values are evaluated, and the pixel's offset from there,
/// in pixels.
fn shared_at(is_shared: bool, pixel: [usize; 2]) -> ([f64; 2], [f64; 2]) {
    match is_shared {
        true => (pixel.map(|v| ((v & !1) + 1) as f64), pixel.map(|v| (v & 1) as f64 - 0.5)),
        false => (pixel.map(|v| v as f64 + 0.5), [0.0; 2]),
    }
}

fn clock(look: &ShoreSettings) -> Clock {
    Clock { time: look.time, period: look.period.map(f64::from) }
}

/// The twin of these settings.
fn look_of(look: &ShoreSettings) -> foam::Shoreline {
    let (s, clock) = (&look.shoreline, clock(look));
    let noise = |n: whitewater::shore::Noise| foam::noise(n.amplitude, n.scale);
    let layers = s.layers.iter().filter(|own| own.weight > 0.0);
    foam::Shoreline {
        frequency: f64::from(s.frequency),
        phases: clock.phases(s.speed, s.swing, [s.swing_amplitude, s.swing_period], s.speed_period),
        frequency_noise: noise(s.frequency_noise),
        speed_noise: noise(s.speed_noise),
        wave_rise: [s.wave_slope, s.wave_offset].map(f64::from),
        floor: s.floor.map(f64::from),
        wave_weight: f64::from(s.wave_weight),
        texture_weight: f64::from(s.texture_weight),
        web_rise: [s.texture_slope, s.texture_offset].map(f64::from),
        layers: layers
            .map(|own| foam::layer(clock, own.weight, own.scale, own.angle, own.speed))
            .collect(),
        texture_warp: noise(s.texture_warp),
        web_warp_moved: clock.moved(s.texture_warp.scale, s.texture_warp_velocity),
        threshold: f64::from(s.threshold),
        threshold_noise: noise(s.threshold_noise),
        rise_noise: noise(s.rise_noise),
        warp: noise(s.warp),
        fade: f64::from(s.fade),
    }
}

/// The twin of a measure.
fn measure_of(measure: Measure) -> twin::Measure {
    match measure {
        Measure::Distance => twin::Measure::Distance,
        Measure::View => twin::Measure::View,
        Measure::Vertical => twin::Measure::Vertical,
    }
}

/// Max rounding error of eight bits. Vulkan permits either neighbouring step, Direct3D 0.6 of a
/// step (an H200 errs by up to 0.514).
const STEP: f64 = 0.6 / 255.0;

/// Comparison of eight-bit amounts: number of values compared, number of those between 0 and 1, and
/// their errors.
#[derive(Debug, Default)]
struct Tally {
    compared: u32,
    partial: u32,
    /// Sums over the values between 0 and 1.
    bound: f64,
    error: f64,
    /// Number of values that err by more than the bound and half a step.
    beyond: u32,
    worst: f64,
    first: Option<String>,
}

impl Tally {
    fn add(&mut self, at: (usize, usize), found: u8, expected: Bounded) {
        let found = f64::from(found) / 255.0;
        let off = (found - expected.value).abs();
        self.compared += 1;
        if (0.01..0.99).contains(&expected.value) {
            self.partial += 1;
            self.bound += expected.error;
            self.error += off;
        }
        let part = off / (expected.error + STEP + 4.0 * U);
        self.worst = self.worst.max(part);
        if part > 1.0 {
            self.beyond += 1;
            self.first.get_or_insert_with(|| format!("{at:?}: {found}, expected {expected:?}"));
        }
    }

    /// Checks that no value exceeds its bound, that at least `partial` values lie between 0 and 1,
    /// and that their mean bound is at most `bound`.
    fn check(&self, name: &str, partial: u32, bound: f64) {
        let count = f64::from(self.partial.max(1));
        let (error, own) = (self.error / count, self.bound / count);
        println!(
            "{name}: {} pixels, {} in between: mean error {error:.4}, mean bound {own:.4}, worst {:.2} of bound and step",
            self.compared, self.partial, self.worst
        );
        assert_eq!(self.beyond, 0, "{name}: {:?}", self.first);
        assert!(self.partial >= partial, "{name}: {} pixels in between", self.partial);
        assert!(own <= bound, "{name}: the bound is {own} in the mean");
    }
}
