//! Compares pass `thickness`, metres of water along the view's z axis, with its CPU twin.

use whitewater::water::{Amplitude, Splat};

use std::f64::consts::PI;

use crate::depth::spheres;
use crate::reference::thickness::{J, kernel};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::support::slow;
use crate::support::tolerance::{self, Sum, U, UNITS};

const PATHS: [(Splat, Sum); 2] = [(Splat::Raster, Sum::Float), (Splat::Compute, Sum::Fixed)];

fn check(name: &str, rig: &mut Rig<'_>, shot: &Shot, sum: Sum) {
    let drawn = rig.draw(shot);
    let spheres = spheres(shot);
    let bounds = tolerance::thickness(&shot.splats(&spheres, rig.config.thickness_level, sum));
    compare::between(name, &drawn.thickness, &bounds);
    assert!(drawn.thickness.data.iter().any(|t| *t > 0.0), "{name}: there is water");
}

#[test]
fn it_is_the_twins_through_every_lens() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let points = scenes::cloud(17, 500, 0.4, 15.0);
    for (splat, sum) in PATHS {
        for level in [0, 1] {
            let config = config(size).with(|it| {
                it.thickness_splat = Some(splat);
                it.thickness_level = level;
            });
            let mut rig = Rig::new(&gpu, &config);
            for lens in LENSES {
                let mut shot = Shot::new(size, lens, 0.15, &points);
                check(&format!("thickness-{splat:?}-{level}-{lens:?}"), &mut rig, &shot, sum);
                shot.scene_depth(|x, y| ((x / 9 + y / 5) % 2 == 0).then_some(3.0 + f64::from(y)));
                check(&format!("thickness-{splat:?}-{level}-{lens:?}-cut"), &mut rig, &shot, sum);
            }
        }
    }
}

/// Many layers, large sprites, sprites before the near plane, odd sizes and a quarter of the
/// resolution.
#[test]
fn sums_of_many_and_of_large_sprites() {
    let gpu = Gpu::shared();
    for (splat, sum) in PATHS {
        for (width, height, level) in [(33, 17, 1), (97, 61, 2), (5, 3, 1), (1, 7, 0)] {
            let size = extent(width, height);
            let config = config(size).with(|it| {
                it.thickness_splat = Some(splat);
                it.smoothing_level = level;
                it.thickness_level = level;
            });
            let mut rig = Rig::new(&gpu, &config);
            let cases: [(&str, f32, Vec<[f32; 3]>); 3] = [
                ("many", 0.3, scenes::cloud(1, 2000, 2.0, 6.0)),
                ("large", 2.0, scenes::cloud(2, 30, 0.5, 6.0)),
                ("near", 0.2, scenes::cloud(3, 60, 0.0, 0.4)),
            ];
            for (name, radius, points) in cases {
                let shot = Shot::new(size, Lens::Infinite, radius, &points);
                check(&format!("thickness-{name}-{splat:?}-{width}"), &mut rig, &shot, sum);
            }
        }
    }
}

/// Mean and standard deviation of the sum over pixels of a sprite with this half-axis in pixels,
/// over all positions within a pixel, as a fraction of its integral.
fn sampled(half: f64) -> (f64, f64) {
    let reach = half.ceil() as i32 + 1;
    let pixels = || (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y)));
    let sums: Vec<f64> = (0..64 * 64)
        .map(|i| (f64::from(i % 64) / 64.0, f64::from(i / 64) / 64.0))
        .map(|(dx, dy)| {
            let square =
                |(x, y): (i32, i32)| (f64::from(x) - dx).powi(2) + (f64::from(y) - dy).powi(2);
            let values = pixels().map(square).filter(|s| *s < half * half);
            values.map(|s| kernel(s / (half * half))).sum::<f64>() / (PI * J * half * half)
        })
        .collect();
    let n = sums.len() as f64;
    let mean = sums.iter().sum::<f64>() / n;
    let square = sums.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / n;
    (mean, square.sqrt())
}

/// The integral of the thickness over the plane of the particles is their volume, however small
/// sprites are compared with a pixel: none falls between pixels, and widened sprites do not add
/// volume.
#[test]
fn the_volume_is_kept_at_every_distance() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let count = 4000;
    for (splat, sum) in PATHS {
        for level in [0, 2] {
            let config = config(size).with(|it| {
                it.thickness_splat = Some(splat);
                it.thickness_level = level;
            });
            let mut rig = Rig::new(&gpu, &config);
            for axis in [0.001, 0.01, 0.03, 0.1, 0.4, 0.9, 1.0, 1.1, 1.7] {
                let depth = 8.0_f32;
                let view = Shot::new(size, Lens::Standard, 1.0, &[]).view(size).reduced(level);
                let pixel = view.c_x() * f64::from(depth);
                let radius = (axis * pixel / 2.0) as f32;
                // All sprites lie entirely in the image.
                let (x, y) = (view.width as f32 / 2.0 - 3.0, view.height as f32 / 2.0 - 3.0);
                let mut random = Random(31);
                let mut within = |n: f32| random.between(-n, n) * pixel as f32;
                let points: Vec<[f32; 3]> =
                    (0..count).map(|_| [within(x), within(y), depth]).collect();
                let shot = Shot::new(size, Lens::Standard, radius, &points);
                let drawn = rig.draw(&shot);
                let area = pixel * view.c_y() * f64::from(depth);
                let found: f64 =
                    drawn.thickness.data.iter().map(|t| f64::from(*t) * area).sum::<f64>();
                let volume = f64::from(shot.settings.water.spacing).powi(3) * f64::from(count);
                let drawn_axis = axis.max(1.0);
                let (mean, deviation) = sampled(drawn_axis);
                assert!((mean - 1.0).abs() < 1e-3, "{mean}");
                // In fixed point each of about pi h^2 terms errs by up to half a unit, with a
                // variance of 1/12 units, of a sum of pi J h^2. The unit refers to the sprite
                // before it is widened.
                let unit =
                    if sum == Sum::Fixed { (drawn_axis / axis).powi(2) / UNITS } else { 0.0 };
                let fixed = unit / (12.0 * PI).sqrt() / J / drawn_axis;
                // Five standard deviations of the mean, and 1/1000 for the error of `sampled` and
                // for rounding.
                let most = 5.0 * deviation.hypot(fixed) / f64::from(count).sqrt() + 1e-3;
                let off = found / volume - 1.0;
                if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
                    eprintln!("{splat:?}, level {level}, {axis} pixels: {off:.2e} of {most:.2e}");
                }
                assert!(off.abs() <= most, "{splat:?}, level {level}, {axis} pixels: {off}");
            }
        }
    }
}

/// The source's amplitude gives the same sums, scaled by the ratio of the amplitudes.
#[test]
fn the_sources_amplitude() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (splat, _) in PATHS {
        let mut rig = Rig::new(&gpu, &config(size).with(|it| it.thickness_splat = Some(splat)));
        let mut shot = Shot::new(size, Lens::Standard, 0.2, &scenes::cloud(3, 300, 1.0, 9.0));
        let volume = rig.draw(&shot).thickness;
        shot.settings.water.amplitude = Amplitude::Source;
        let source = rig.draw(&shot).thickness;
        let water = &shot.settings.water;
        let axis = 2.0 * f64::from(water.radius());
        let ours = f64::from(water.spacing).powi(3) / (PI * J * axis * axis);
        let ratio = 0.8 * 2.0 * axis / ours;
        for (a, b) in volume.data.iter().zip(&source.data) {
            // Amplitudes are rounded a few times, float sums once per term.
            let (expected, found) = (f64::from(*a) * ratio, f64::from(*b));
            assert!((found - expected).abs() <= 600.0 * U * expected, "{found}, not {expected}");
        }
        assert!(volume.data.iter().any(|t| *t > 0.0));
    }
}

/// However many particles lie on one spot, no sum overflows: it is that many times the thickness of
/// one particle, to float rounding. The slow test has ten million, in chunks.
#[test]
fn any_number_of_particles_on_one_spot() {
    let gpu = Gpu::shared();
    let size = extent(17, 11);
    let mut counts = vec![255_u32, 4000, 300_000];
    if slow() {
        counts.push(10_000_000);
    }
    for count in counts {
        let mut rig = Rig::new(&gpu, &config(size).with(|it| it.max_particles = count));
        // A particle just dense enough not to be spray has half the radius and four times the
        // amplitude.
        for (name, density) in [("whole", 1000.0), ("half", 350.1)] {
            let draw = |rig: &mut Rig<'_>, count: u32| {
                let points = vec![[0.1, -0.2, 4.0]; count as usize];
                let mut shot = Shot::new(size, Lens::Standard, 0.3, &points);
                shot.densities = Some(vec![density; points.len()]);
                rig.draw(&shot).thickness
            };
            let (one, many) = (draw(&mut rig, 1), draw(&mut rig, count));
            assert!(one.data.iter().any(|t| *t > 0.0), "{name}: there is water");
            for (one, many) in one.data.iter().zip(&many.data) {
                let expected = f64::from(*one) * f64::from(count);
                // Two conversions, a sum and a product for each.
                let off = (f64::from(*many) - expected).abs();
                assert!(off <= 8.0 * U * expected, "{count} {name}: {many}, not {expected}");
            }
        }
    }
}

/// Sums of more than one word of different sprites give the same bits in any order.
#[test]
fn carries_come_in_any_order() {
    let gpu = Gpu::shared();
    let size = extent(17, 11);
    let points = scenes::cloud(5, 20_000, 3.0, 4.0);
    let order = Random(7).order(points.len());
    let mixed: Vec<_> = order.iter().map(|i| points[*i]).collect();
    let max_particles = points.len() as u32;
    let mut rig = Rig::new(&gpu, &config(size).with(|it| it.max_particles = max_particles));
    let [first, second] = [points, mixed].map(|points| {
        let shot = Shot::new(size, Lens::Standard, 1.0, &points);
        let spacing = f64::from(shot.settings.water.spacing);
        // A word holds 256 whole amplitudes; an amplitude is the volume over the sprite's integral.
        let word = 256.0 * spacing.powi(3) / (PI * J * 4.0);
        let thickness = rig.draw(&shot).thickness.data;
        assert!(thickness.iter().any(|t| f64::from(*t) > 2.0 * word), "{thickness:?} {word}");
        thickness
    });
    assert_eq!(first, second);
}
