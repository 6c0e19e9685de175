//! Passes `radiance` and `blur`: ambient occlusion and light of whitewater (Akinci et al. 2013, Sec. 2.4 and
//! 2.5; passes 6 and 7).
//!
//! In the reference mode the samples are the paper's: points of a Halton sequence in spheres of growing radius, the
//! same for every pixel. In the fast mode each pixel evaluates a sixteenth of the points, and the blur recombines the
//! results. A pixel of isolated foam then has only its own samples, so these come in opposite pairs: of each pair, a
//! plane through the sphere's centre hides exactly one. The density of these points follows the paper's weights, so
//! that each counts equally. Particles smaller than a pixel take the mean direction of unoccluded samples as their
//! normal, which is not in the paper.
//! Reads: the images of `splat`, smoothed surface, scene depth, points, irradiance, environment, sunlight. Writes:
//! foam normal, foam radiance.

use std::f64::consts::TAU;

use crate::gpu::memory::MemoryLocation;
use ash::vk;

use super::settings::{Irradiance, Occlusion, WhitewaterConfig};
use super::splat::{AFTER, Sprites};
use super::tiles::Tiles;
use crate::contract::Config;
use crate::environment::Environment;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{
    self, Access, CLEAR, COMPUTE_READ_WRITE, COMPUTE_SAMPLED, COMPUTE_WRITE, COPY_READ,
    FRAGMENT_SAMPLED,
};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Resource;
use crate::gpu::image::{Image, ImageDesc};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::retire::RetireList;
use crate::gpu::shader;
use crate::water::Recording;

/// Maximum number of samples per sphere.
const MOST_SAMPLES: usize = 512;

/// Radical inverse of `index` in a base (van der Corput).
fn radical_inverse(mut index: u32, base: u32) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0 / f64::from(base));
    while index > 0 {
        value += f64::from(index % base) * digit;
        index /= base;
        digit /= f64::from(base);
    }
    value
}

/// The first points s of the Halton sequence (bases 2, 3, 5, indices from 1, scaled to [−1, 1]³) that lie inside the
/// unit sphere, each with its weight `λ = (1 − |s|)²`.
fn points() -> Vec<[f32; 4]> {
    let point = |index| [2, 3, 5].map(|base| 2.0 * radical_inverse(index, base) - 1.0);
    let inside = (1..).map(point).filter_map(|[x, y, z]| {
        let length = (x * x + y * y + z * z).sqrt();
        (length < 1.0).then(|| [x, y, z, (1.0 - length).powi(2)].map(|v| v as f32))
    });
    inside.take(MOST_SAMPLES).collect()
}

/// Number of pairs of opposite points in the fast mode. Each pixel of a 4×4 block uses a sixteenth of them
/// (glsl/whitewater/radiance.comp).
const PAIRS: u32 = 160;

/// One point s of each pair ±s in the unit sphere, with weight 1, because the density of the points follows
/// `λ = (1 − |s|)²`. They are a low-discrepancy sequence, so that any run of successive points fills the sphere: the
/// coordinates of point i are the fractions of i times three powers of the inverse root of x⁴ = x + 1 (Roberts, The
/// unreasonable effectiveness of quasirandom sequences, 2018).
fn pairs() -> Vec<[f32; 4]> {
    const ROOT: f64 = 1.220_744_084_605_759_6;
    let pair = |index: u32| {
        let part = |power: i32| (f64::from(index) * ROOT.powi(-power)).fract();
        let (radius, height) = (radius_within(part(2)), part(3));
        let (sin, cos) = (TAU * part(1)).sin_cos();
        let across = (1.0 - height * height).sqrt();
        [across * cos, across * sin, height].map(|v| (radius * v) as f32)
    };
    (1..=PAIRS).map(pair).map(|[x, y, z]| [x, y, z, 1.0]).collect()
}

/// Radius r of the ball that contains a given share of the unit ball, both weighted by λ: solves
/// `10 r³ − 15 r⁴ + 6 r⁵ = share`.
fn radius_within(share: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let r: f64 = 0.5 * (low + high);
        let less = r.powi(3) * (10.0 - 15.0 * r + 6.0 * r * r) < share;
        (low, high) = if less { (r, high) } else { (low, r) };
    }
    high
}

/// The images of the depth of the water's surface, unsmoothed and smoothed, in the state in which the fragment
/// shaders of `composite` sample them.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    pub depth: &'a Image,
    pub smoothed: &'a Image,
}

/// The passes.
pub struct Radiance {
    surface: Pipeline,
    tiles: Tiles,
    gather: Pipeline,
    blur: Pipeline,
    points: Buffer,
    /// Light and shadow, and the half-blurred intermediate.
    images: [Image; 2],
}

impl Radiance {
    pub fn new(gpu: &Gpu, config: &Config, whitewater: &WhitewaterConfig) -> Result<Self, Error> {
        let sampled = u32::from(whitewater.irradiance == Irradiance::Sampled);
        let fast = u32::from(whitewater.occlusion == Occlusion::Fast);
        let own = [(0, sampled), (1, fast)];
        let constants = [&own[..], &crate::light::constants(config)].concat();
        let points = if whitewater.occlusion == Occlusion::Fast { pairs() } else { points() };
        let bytes: &[u8] = bytemuck::cast_slice(&points);
        let mut buffer = Buffer::new(
            gpu,
            "whitewater/radiance/points",
            bytes.len() as u64,
            vk::BufferUsageFlags::STORAGE_BUFFER,
            MemoryLocation::CpuToGpu,
        )?;
        buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
        Ok(Self {
            surface: Pipeline::compute(gpu, shader::WHITEWATER_SURFACE_COMP, &[])?,
            tiles: Tiles::new(gpu, config)?,
            gather: Pipeline::compute(gpu, shader::WHITEWATER_RADIANCE_COMP, &constants)?,
            blur: Pipeline::compute(gpu, shader::WHITEWATER_BLUR_COMP, &[(1, fast)])?,
            points: buffer,
            images: Self::images(gpu, config)?,
        })
    }

    fn images(gpu: &Gpu, config: &Config) -> Result<[Image; 2], Error> {
        let image = |name| {
            let usage = vk::ImageUsageFlags::STORAGE
                | vk::ImageUsageFlags::SAMPLED
                | vk::ImageUsageFlags::TRANSFER_SRC
                | vk::ImageUsageFlags::TRANSFER_DST;
            let format = vk::Format::R16G16B16A16_SFLOAT;
            Image::new(gpu, &ImageDesc::new(name, config.extent, format, usage))
        };
        Ok([image("whitewater/radiance")?, image("whitewater/blur")?])
    }

    pub fn resize(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        retired: &mut RetireList,
    ) -> Result<(), Error> {
        for (old, new) in self.images.iter_mut().zip(Self::images(gpu, config)?) {
            retired.replace(old, new);
        }
        self.tiles.resize(gpu, config, retired)
    }

    /// Light and shadow, blurred.
    pub fn image(&self) -> &Image {
        &self.images[0]
    }

    pub fn record(
        &self,
        r: &mut Recording<'_>,
        sprites: &Sprites,
        environment: &Environment,
        water: Option<Surface<'_>>,
    ) -> Result<(), Error> {
        let (gpu, cmd) = (r.gpu, r.cmd);
        let [image, half] = &self.images;
        let sampled = |image: &Image| Resource::Sampled(image.view, gpu.samplers.nearest);
        let linear = |image: &Image| Resource::Sampled(image.view, gpu.samplers.linear);
        let occluders = sampled(sprites.occluders());
        let scope = r.begin(c"radiance");
        let both = COMPUTE_READ_WRITE;
        let before = AFTER.and(COPY_READ).discarded();
        let taken =
            [access::image(sprites.normal(), AFTER, both), access::image(image, before, CLEAR)];
        gpu.barriers(cmd, &taken, &[]);
        // Without foam the result is 0.
        gpu.clear_color(cmd, image, [0.0; 4]);
        gpu.barriers(cmd, &[access::image(image, CLEAR, COMPUTE_WRITE)], &[]);
        if let Some(water) = water {
            self.record_surface(r, sprites, water)?;
        }
        self.tiles.record(r, sprites.occluders())?;
        let [shadow, thickness, basis, span, cast, soap] = r.sunlight.resources();
        let resources = [
            (0, r.uniforms),
            (1, occluders),
            (2, Resource::storage(sprites.normal())),
            (3, Resource::buffer(&self.points)),
            (4, linear(&environment.irradiance)),
            (5, linear(environment.gathered())),
            (6, Resource::storage(image)),
            (9, self.tiles.resource()),
            shadow,
            thickness,
            basis,
            span,
            cast,
            soap,
        ];
        r.descriptors.bind(gpu, cmd, &self.gather, &resources)?;
        self.tiles.dispatch(r);
        gpu.barriers(cmd, &[access::image(sprites.normal(), both, AFTER)], &[]);
        r.end(scope);

        let scope = r.begin(c"blur");
        // Tiles without foam are not written and, in the half-blurred image, not read.
        let ways = [
            (image, (half, COMPUTE_SAMPLED.discarded()), [1, 0]),
            (half, (image, COMPUTE_SAMPLED), [0, 1]),
        ];
        for (from, (to, before), step) in ways {
            let images = [
                access::image(from, COMPUTE_WRITE, COMPUTE_SAMPLED),
                access::image(to, before, COMPUTE_WRITE),
            ];
            gpu.barriers(cmd, &images, &[]);
            let resources = [
                (0, r.uniforms),
                (1, occluders),
                (2, sampled(sprites.normal())),
                (3, sampled(from)),
                (4, Resource::storage(to)),
                (9, self.tiles.resource()),
            ];
            r.descriptors.bind(gpu, cmd, &self.blur, &resources)?;
            self.blur.push::<[i32; 2]>(gpu, cmd, &step);
            self.tiles.dispatch(r);
        }
        gpu.barriers(cmd, &[access::image(image, COMPUTE_WRITE, AFTER)], &[]);
        r.end(scope);
        Ok(())
    }

    /// Adds the water's smoothed surface to the occluders.
    fn record_surface(
        &self,
        r: &Recording<'_>,
        sprites: &Sprites,
        water: Surface<'_>,
    ) -> Result<(), Error> {
        let (gpu, cmd, both) = (r.gpu, r.cmd, COMPUTE_READ_WRITE);
        let hand = |from, to, [before, after]: [Access; 2]| {
            let [depth, smoothed] =
                [water.depth, water.smoothed].map(|own| access::image(own, from, to));
            [depth, smoothed, access::image(sprites.occluders(), before, after)]
        };
        gpu.barriers(cmd, &hand(FRAGMENT_SAMPLED, COMPUTE_SAMPLED, [AFTER, both]), &[]);
        let sampled = |image: &Image| Resource::Sampled(image.view, gpu.samplers.nearest);
        let resources = [
            (0, r.uniforms),
            (1, Resource::storage(sprites.occluders())),
            (2, sampled(water.depth)),
            (5, sampled(water.smoothed)),
            (7, r.levels),
        ];
        r.descriptors.bind(gpu, cmd, &self.surface, &resources)?;
        r.dispatch_over(r.extent, self.surface.local_size);
        gpu.barriers(cmd, &hand(COMPUTE_SAMPLED, FRAGMENT_SAMPLED, [both, AFTER]), &[]);
        Ok(())
    }

    /// Bytes of images and buffers.
    pub fn memory(&self) -> (u64, u64) {
        let buffers = self.points.size + self.tiles.memory();
        (self.images.iter().map(|image| image.size).sum(), buffers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_fill_the_sphere() {
        let points = points();
        assert_eq!(points.len(), MOST_SAMPLES);
        assert_eq!(
            [2, 3, 5].map(|base| radical_inverse(5, base)),
            [0.625, 0.7777777777777777, 0.04]
        );
        let mean: f32 =
            points.iter().map(|[x, y, z, _]| x * x + y * y + z * z).sum::<f32>() / 512.0;
        assert!(
            (mean - 0.6).abs() < 0.01,
            "mean square of the radius {mean}, of a full sphere 3/5"
        );
        let weight: f32 = points.iter().map(|p| p[3]).sum::<f32>() / 512.0;
        assert!((weight - 0.1).abs() < 0.005, "mean weight {weight}, of a full sphere 1/10");
    }

    /// In the unit sphere weighted by `λ`, the mean of the squared radius is `B(5,3)/B(3,3) = 2/7`, and that of the
    /// squared height is a third of it, 2/21. All pairs together have nearly these means. The means of a sixteenth,
    /// 10 pairs, deviate from them no more than those of 10 random points would. One random point has a variance of
    /// `5/42 − (2/7)²` in the squared radius (`B(7,3)/B(3,3) = 5/42`) and of `5/42 / 5 − (2/21)²` in the squared
    /// height; the mean of 10 has a tenth of that as its expected squared deviation. Averaged over 16 sets, the
    /// squared deviation is 1 ± 0.35 times the expected one (χ²), and more than 2.1 times as large once in two
    /// hundred.
    #[test]
    fn pairs_fill_the_weighed_sphere() {
        let pairs = pairs();
        let means = |pairs: &[[f32; 4]]| {
            let mean =
                |of: fn(&[f32; 4]) -> f32| pairs.iter().map(of).sum::<f32>() / pairs.len() as f32;
            [mean(|[x, y, z, _]| x * x + y * y + z * z), mean(|[_, _, z, _]| z * z)]
        };
        let off = |[a, b]: [f32; 2]| [a - 2.0 / 7.0, b - 2.0 / 21.0];
        assert!(off(means(&pairs)).iter().all(|off| off.abs() < 0.003), "{:?}", means(&pairs));
        let runs: Vec<_> = pairs.chunks(10).map(|run| off(means(run))).collect();
        assert_eq!(runs.len(), 16);
        let variance: [f32; 2] =
            [5.0 / 42.0 - (2.0_f32 / 7.0).powi(2), 1.0 / 42.0 - (2.0_f32 / 21.0).powi(2)];
        for i in 0..2 {
            let found = runs.iter().map(|off| off[i] * off[i]).sum::<f32>() / 16.0;
            assert!(found < 2.1 * variance[i] / 10.0, "{found} of {}", variance[i] / 10.0);
        }
    }
}
