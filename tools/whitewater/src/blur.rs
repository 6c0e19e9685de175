//! Motion blur and depth of field: the mean of pictures at several moments of the exposure and through several
//! points of the lens (the accumulation buffer, Haeberli and Akeley 1990).

use glam::{Vec2, Vec3};
use whitewater::Camera;
use whitewater::headless::Headless;
use whitewater::io::particles::Particles;
use whitewater::io::picture::{Channel, Layers};

use crate::args::DrawArgs;
use crate::failure::Outcome;

/// Defaults for a photograph: exposure time in seconds (`SHUTTER`), ratio of lens diameter to focus distance
/// (`LENS`), and max lens diameter in metres (`LARGEST`).
const SHUTTER: f32 = 0.005;
const LENS: f32 = 0.0015;
const LARGEST: f32 = 0.015;

/// Settings of the average.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blur {
    /// Number of pictures, at least 2.
    pub samples: u32,
    /// Exposure time in seconds, centred on the frame.
    pub seconds: f32,
    /// Radius of the lens, scene units.
    pub radius: f32,
}

/// One of the pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time offset from the frame in seconds.
    pub time: f32,
    /// Offset from the centre of the lens, to the right and upwards, scene units.
    pub lens: Vec2,
    /// Offset from the centre of the pixel, pixels.
    pub pixel: Vec2,
}

impl Blur {
    /// Chooses the blur of a picture; `None` if nothing is blurred. Missing arguments default to those of a
    /// photograph ([`SHUTTER`], [`LENS`]) if `photograph` is set, otherwise to no blur. `focus` is the focus distance
    /// in scene units.
    pub fn of(args: &DrawArgs, photograph: bool, focus: f32) -> Option<Self> {
        let usual = |value: f32| if photograph { value } else { 0.0 };
        let seconds = args.shutter.unwrap_or(usual(SHUTTER));
        let diameter = args.aperture.unwrap_or(usual((focus * LENS).min(LARGEST)));
        let blurs = args.samples > 1 && (seconds > 0.0 || diameter > 0.0);
        blurs.then_some(Self { samples: args.samples, seconds, radius: 0.5 * diameter })
    }

    /// Low-discrepancy samples of time (radical inverse of 2), lens (Vogel's sunflower) and pixel (Roberts'
    /// sequence), which do not correlate with each other.
    pub fn samples(&self) -> impl Iterator<Item = Sample> {
        let Self { samples, seconds, radius } = *self;
        let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
        (0..samples).map(move |i| {
            let inverse = i.reverse_bits() as f32 / 2.0_f32.powi(32);
            let first = (samples.next_power_of_two() as f32).recip();
            let turn = Vec2::from_angle(golden * i as f32);
            let away = ((i as f32 + 0.5) / samples as f32).sqrt();
            let pixel = (Vec2::splat(0.5) + i as f32 * Vec2::new(0.754_877_7, 0.569_840_3)).fract();
            let time = seconds * (inverse + 0.5 * first - 0.5);
            Sample { time, lens: radius * away * turn, pixel: pixel - 0.5 }
        })
    }

    /// Draws one picture per sample, with the particles moved to the sample's time, and returns the mean of the
    /// pictures. At the end the particles are back in place.
    pub fn draw(
        &self,
        headless: &mut Headless,
        particles: &Particles,
        mut picture: impl FnMut(&mut Headless, Sample) -> Outcome<Layers>,
    ) -> Outcome<Mean> {
        let velocities = particles.velocities.as_ref().filter(|_| self.seconds > 0.0);
        let mut mean = Mean::default();
        for sample in self.samples() {
            if let Some(velocities) = velocities {
                let moved = moved(&particles.positions, velocities, sample.time);
                headless.move_particles(&moved)?;
            }
            mean.add(&picture(headless, sample)?);
        }
        if velocities.is_some() {
            headless.move_particles(&particles.positions)?;
        }
        Ok(mean)
    }
}

/// Returns the camera moved to a point of the lens: its view is shifted, and its projection is sheared so that
/// points at distance `focus` stay where they are in the picture. The shear also moves the whole picture by the
/// sample's offset within the pixel.
pub fn through(
    camera: &Camera,
    Sample { lens, pixel, .. }: Sample,
    focus: f32,
    size: (u32, u32),
) -> Camera {
    let mut camera = *camera;
    let mut view = camera.view_matrix();
    view.w_axis -= lens.extend(0.0).extend(0.0);
    camera.view = view.to_cols_array_2d();
    // 1 or -1: whether depth grows along the view-space z axis.
    let along = camera.projection_matrix().z_axis.w;
    let pixel = 2.0 * pixel / Vec2::new(size.0 as f32, size.1 as f32);
    let scale = Vec2::new(camera.projection_matrix().x_axis.x, camera.projection_matrix().y_axis.y);
    let shear = (scale * lens / focus + pixel) * along;
    let mut projection = camera.projection_matrix();
    projection.z_axis += shear.extend(0.0).extend(0.0);
    camera.projection = projection.to_cols_array_2d();
    camera
}

/// Positions after `seconds`. Particles with a non-finite velocity stay where they are.
pub fn moved(positions: &[[f32; 3]], velocities: &[[f32; 3]], seconds: f32) -> Vec<[f32; 3]> {
    let there = |(p, v): (&[f32; 3], &[f32; 3])| {
        let to = Vec3::from(*p) + seconds * Vec3::from(*v);
        if to.is_finite() { to.to_array() } else { *p }
    };
    positions.iter().zip(velocities).map(there).collect()
}

/// Sums of the channels of pictures of one size.
#[derive(Default)]
pub struct Mean {
    sums: Vec<(String, Vec<f64>)>,
    count: u32,
}

impl Mean {
    fn add(&mut self, layers: &Layers) {
        if self.sums.is_empty() {
            let zero = |c: &Channel| (c.name.clone(), vec![0.0; c.data.len()]);
            self.sums = layers.channels.iter().map(zero).collect();
        }
        for ((_, sums), channel) in self.sums.iter_mut().zip(&layers.channels) {
            for (sum, value) in sums.iter_mut().zip(&channel.data) {
                *sum += f64::from(*value);
            }
        }
        self.count += 1;
    }

    /// Replaces the channels of the same names by their means.
    pub fn put(&self, layers: &mut Layers) {
        for channel in &mut layers.channels {
            if let Some((_, sums)) = self.sums.iter().find(|(name, _)| *name == channel.name) {
                let mean = |sum: &f64| (sum / f64::from(self.count)) as f32;
                channel.data = sums.iter().map(mean).collect();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat4, Vec4};

    #[test]
    fn samples_are_even_in_time_and_over_the_lens() {
        for samples in [2, 5, 16, 64] {
            let blur = Blur { samples, seconds: 0.02, radius: 0.1 };
            let all: Vec<_> = blur.samples().collect();
            assert_eq!(all.len(), samples as usize);
            assert!(all.iter().all(|s| s.time.abs() < 0.01 && s.lens.length() < 0.1), "{all:?}");
            let mean = all.iter().map(|s| s.time).sum::<f32>() / samples as f32;
            // If the number of samples is not a power of two, some values of the radical inverse are missing, so the
            // mean is off.
            let most = if samples.is_power_of_two() { 1.0e-6 } else { 0.003 };
            assert!(mean.abs() < most, "{samples}: {mean}");
            let pixel = all.iter().map(|s| s.pixel).sum::<Vec2>() / samples as f32;
            assert!(all.iter().all(|s| s.pixel.abs().max_element() <= 0.5));
            assert!(pixel.length() < 2.0 / samples as f32, "{samples}: {pixel}");
            // A disc has half its area within 0.71 of its radius.
            let inner = all.iter().filter(|s| s.lens.length() < 0.1 * 0.5_f32.sqrt()).count();
            assert!(inner.abs_diff(samples as usize / 2) <= 1, "{samples}: {inner}");
        }
    }

    #[test]
    fn what_is_in_focus_stays_and_what_is_not_goes_by_its_depth() {
        let right = Mat4::perspective_infinite_reverse_rh(0.7, 1.5, 0.1);
        let left = Mat4::perspective_lh(0.7, 1.5, 0.1, 100.0);
        let lens = Vec2::new(0.04, -0.03);
        for (projection, along) in [(right, -1.0), (left, 1.0)] {
            let view = Mat4::look_at_rh(Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO, Vec3::Y);
            let camera = Camera::of(view, projection);
            let seen = |camera: &Camera, p: Vec4| {
                let clip = camera.projection_matrix() * camera.view_matrix() * p;
                Vec2::new(clip.x, clip.y) / clip.w
            };
            let sample = Sample { time: 0.0, lens, pixel: Vec2::new(0.3, -0.4) };
            let other = through(&camera, sample, 5.0, (300, 200));
            for depth in [2.0_f32, 5.0, 20.0] {
                let point = view.inverse() * Vec4::new(0.3, -0.2, along * depth, 1.0);
                let off = seen(&other, point) - seen(&camera, point);
                // Expected by similar triangles, in units of half the picture's width and height.
                let scale = Vec2::new(projection.x_axis.x, projection.y_axis.y);
                let expected = lens * scale * (1.0 / 5.0 - 1.0 / depth) + Vec2::new(0.002, -0.004);
                assert!((off - expected).length() < 1.0e-6, "{along} {depth}: {off} {expected}");
            }
        }
    }

    #[test]
    fn particles_go_by_their_velocity() {
        let velocities = [[2.0, 0.0, -1.0], [f32::NAN, 0.0, 0.0], [f32::INFINITY, 0.0, 0.0]];
        let found = moved(&[[1.0; 3], [2.0; 3], [3.0; 3]], &velocities, -0.5);
        assert_eq!(found, [[0.0, 1.0, 1.5], [2.0; 3], [3.0; 3]]);
        let layers = |a: f32, r: f32| {
            let mut layers = Layers::new(2, 1);
            layers.push("A", 2, 1, vec![a, 2.0 * a]).unwrap();
            layers.push("R", 2, 1, vec![r; 2]).unwrap();
            layers
        };
        let mut mean = Mean::default();
        mean.add(&layers(1.0, 5.0));
        mean.add(&layers(3.0, 5.0));
        let mut whole = layers(0.0, 0.0);
        whole.push("Z", 2, 1, vec![7.0; 2]).unwrap();
        mean.put(&mut whole);
        let of = |name: &str| whole.channel(name).unwrap().to_vec();
        assert_eq!([of("A"), of("R"), of("Z")], [vec![2.0, 4.0], vec![5.0; 2], vec![7.0; 2]]);
    }
}
