//! Far particles keep their light: the sum over a picture, times a pixel's area, is the same at
//! every distance, down to ten spacings per pixel. Fragments add whole fixed-point steps, so sums
//! do not depend on the order; contributions smaller than a step must not be lost by that.

use glam::{DMat3, DVec3, Mat4, Vec3, vec3};
use whitewater::LightVolume;
use whitewater::WhitewaterConfig;
use whitewater::headless::Whitewater;
use whitewater::water::{Kernels, Splat, SpraySettings};

use crate::reference::smoothstep;
use crate::reference::spray::SIZES;
use crate::shape::of_spray;
use crate::support::device::Gpu;
use crate::support::limits::{Claims, claim};
use crate::support::rig::{Drawn, Rig, Shot, config};
use crate::support::scenes::{self, Lens, Random};
use crate::surface_foam::Foamy;

const SIZE: ash::vk::Extent2D = ash::vk::Extent2D { width: 96, height: 64 };
const SPACING: f32 = 0.04;
/// Spacings per pixel.
const DISTANCES: [f32; 7] = [0.16, 0.32, 0.65, 1.3, 2.6, 5.2, 10.4];
/// Max relative error of a sum.
const LOSS: f64 = 0.05;

/// Height of the view in degrees, so small that perspective does not matter.
const HIGH: f32 = 6.0;

/// Width of a pixel at depth 1, for a view of this height in degrees.
fn slope(high: f32) -> f32 {
    2.0 * (0.5 * high).to_radians().tan() / SIZE.height as f32
}

/// `count` particles at rest at random places in a plane across the view, at the depth where a
/// pixel is `spacings` spacings wide, at least `left` pixels away from the picture's edges.
fn plane(count: usize, spacings: f32, left: f32) -> Foamy {
    plane_in(HIGH, count, spacings, left)
}

/// Particles as in [`plane`], for a view of this height in degrees.
fn plane_in(high: f32, count: usize, spacings: f32, left: f32) -> Foamy {
    let mut random = Random(11);
    let depth = spacings * SPACING / slope(high);
    let half = |pixels: u32| (0.5 * pixels as f32 - left) * slope(high) * depth;
    let (x, y) = (half(SIZE.width), half(SIZE.height));
    let mut shot = Shot::new(SIZE, Lens::Infinite, 0.656 * SPACING, &[]);
    let square = SIZE.width as f32 / SIZE.height as f32;
    let projection = Mat4::perspective_infinite_rh(high.to_radians(), square, 0.1);
    shot.camera.projection =
        (Mat4::from_scale(vec3(1.0, -1.0, 1.0)) * projection).to_cols_array_2d();
    let points: Vec<_> =
        (0..count).map(|_| [random.between(-x, x), random.between(-y, y), depth]).collect();
    shot.positions = scenes::world(&shot.camera, &points);
    shot.scene_depth(|_, _| None);
    // Without noise and pattern, which vary the thickness.
    (shot.settings.surface_foam.noise, shot.settings.surface_foam.pattern) = (0.0, 0.0);
    let ids = (0..count).map(|_| random.bits() as u32).collect();
    let (amounts, velocities) = (vec![[0.0; 2]; count], vec![[0.0; 3]; count]);
    Foamy { shot, amounts, velocities, ids: Some(ids) }
}

/// Draws the shot with the streams that the renderer is configured for.
fn draw(case: &Foamy, rig: &mut Rig<'_>) -> Drawn {
    let streams = case.streams(rig);
    let all = streams.particles();
    let foam = all.surface_foam.filter(|_| rig.config.surface_foam);
    rig.draw_particles(&case.shot, &all.with(|it| it.surface_foam = foam))
}

/// Sum of all texels of `level` per particle, in square spacings times the texel's unit.
fn total(texels: impl Iterator<Item = f32>, case: &Foamy, spacings: f32, level: u32) -> f64 {
    let texel = f64::from(spacings) * f64::from(1 << level);
    texels.map(f64::from).sum::<f64>() * texel * texel / case.amounts.len() as f64
}

/// Checks the sum at all distances against the expected one.
fn kept(name: &str, wanted: f64, sum: impl FnMut(f32) -> f64) {
    let parts: Vec<f64> = DISTANCES.into_iter().map(sum).map(|sum| sum / wanted).collect();
    eprintln!("{name}: {parts:.3?} of it at {DISTANCES:?} spacings a pixel");
    assert!(parts.iter().all(|part| (part - 1.0).abs() < LOSS), "{name}: {parts:.3?}");
}

/// Mean square of the droplets' sizes a + b u⁶ with u uniform.
const SQUARES: f64 =
    SIZES[0] * SIZES[0] + 2.0 * SIZES[0] * SIZES[1] / 7.0 + SIZES[1] * SIZES[1] / 13.0;
/// Integral of a sprite's kernel over the unit disc, divided by pi.
const KERNEL: f64 = 0.340_003;

/// Expected optical depth of a particle's spray times its area, in square spacings.
fn spray_of(case: &Foamy) -> f64 {
    let look = &case.shot.settings.spray;
    let many = f64::from(look.droplets);
    // Fraction of droplets of a particle that is only spray. Fewer droplets are larger.
    let torn = 0.3_f64;
    // Half-axis of one droplet. A particle draws a random fraction of these droplets, uniform
    // between 0.2 and 1, 0.6 in the mean. Droplet 0 is the mist; droplet k is drawn if their number
    // plus a half is more than k.
    let whole = f64::from(look.size) * 0.656;
    let part = |k: u32| ((f64::from(k) - 0.5) / (torn * many) - 0.2) / 0.8;
    let drawn: f64 = (1..look.droplets).map(|k| 1.0 - part(k).clamp(0.0, 1.0)).sum();
    let droplets = drawn / (torn * 0.6 * many) * whole * whole * SQUARES / 0.513;
    let depth = |taken: f32| -(1.0 - f64::from(taken)).ln();
    let mist = torn.powi(3) * depth(look.mist) * f64::from(look.mist_size).powi(2);
    std::f64::consts::PI * KERNEL * (depth(look.opacity) * droplets + mist)
}

fn spray(drawn: &Drawn) -> impl Iterator<Item = f32> {
    drawn.spray.as_ref().expect("spray").data.iter().copied()
}

fn spray_keeps_its_light(gpu: &Gpu, opacities: &[f32]) {
    let mut rig = Rig::new(gpu, &config(SIZE).with(|it| it.spray = true));
    for &opacity in opacities {
        let case = |spacings| {
            let mut case = plane(4000, spacings, 12.0);
            case.shot.settings.spray = SpraySettings::default().with(|it| it.opacity = opacity);
            case.shot.densities = Some(vec![1.0; 4000]);
            case
        };
        kept(&format!("spray of opacity {opacity}"), spray_of(&case(1.0)), |spacings| {
            let case = case(spacings);
            total(spray(&draw(&case, &mut rig)), &case, spacings, 0)
        });
    }
}

#[test]
fn far_spray_keeps_its_light() {
    spray_keeps_its_light(&Gpu::shared(), &[0.5, 0.05]);
}

/// The path for devices that cannot blend 32-bit floats. Its steps are larger, and fainter spray
/// would have so few that the sum's random error shows.
#[test]
fn far_spray_of_half_floats_keeps_its_light() {
    let mut gpu = Gpu::own();
    let unblended = Some(ash::vk::Format::R32G32_SFLOAT);
    claim(&mut gpu, Claims { unblended, ..Claims::default() });
    spray_keeps_its_light(&gpu, &[0.5]);
}

/// Mist of sheets and strands in all orientations: each has another ellipse, and the same light.
/// The ellipses are wider than a pixel, and the groups are so far apart that each has its own
/// shape.
#[test]
fn far_mist_keeps_its_light_in_every_shape() {
    let gpu = Gpu::shared();
    let shaped = config(SIZE).with(|it| {
        it.spray = true;
        it.kernels = Kernels::Ellipsoids;
    });
    let mut rig = Rig::new(&gpu, &shaped);
    for steps in [[1, 1, 0], [2, 0, 0]] {
        let case = |spacings: f32| {
            let mut case = plane(40, spacings, 26.0);
            let mut random = Random(7);
            let mut positions = Vec::new();
            for middle in &case.shot.positions {
                let mut axis = || f64::from(random.between(-1.0, 1.0));
                let axis = DVec3::new(axis(), axis(), axis()).normalize();
                let turn = DMat3::from_axis_angle(axis, f64::from(random.between(0.0, 3.0)));
                let range = |i: usize| -steps[i]..=steps[i];
                for (i, j) in range(0).flat_map(|i| range(1).map(move |j| (i, j))) {
                    let off = turn * DVec3::new(f64::from(i), f64::from(j), 0.0);
                    positions.push((Vec3::from(*middle) + SPACING * off.as_vec3()).to_array());
                }
            }
            let count = positions.len();
            case.shot.positions = positions;
            case.amounts = vec![[0.0; 2]; count];
            case.velocities = vec![[0.0; 3]; count];
            case.ids = None;
            case.shot.densities = Some(vec![1.0; count]);
            case.shot.settings.spray = SpraySettings::default().with(|it| {
                (it.droplets, it.opacity, it.strand_ratio) = (2, 0.0, 6.0);
                (it.mist, it.mist_size, it.scatter_radius) = (0.9, 6.0, 0.0);
            });
            case
        };
        for spacings in [1.3, 1.9] {
            let case = case(spacings);
            let drawn = draw(&case, &mut rig);
            // Particles at the ends of a group have fewer neighbours and less mist.
            let crowds = of_spray(&drawn, &case.shot).into_iter().map(|(_, crowd)| crowd);
            let mist: f64 = crowds.map(|crowd| smoothstep(1.0, 6.0, crowd)).sum();
            let expected = spray_of(&case) * mist / case.shot.positions.len() as f64;
            let part = total(spray(&drawn), &case, spacings, 0) / expected;
            eprintln!("mist of {steps:?}: {part:.3} of it at {spacings} spacings a pixel");
            assert!((part - 1.0).abs() < LOSS, "mist of {steps:?} at {spacings}: {part}");
        }
    }
}

/// Both kinds of splat, at two levels of the thickness, of which 2 is the default.
#[test]
fn far_foam_keeps_its_light() {
    let gpu = Gpu::shared();
    for (splat, level) in
        [Splat::Compute, Splat::Raster].into_iter().flat_map(|splat| [(splat, 2), (splat, 1)])
    {
        let ways = config(SIZE).with(|it| {
            it.thickness_splat = Some(splat);
            it.thickness_level = level;
        });
        let mut rig = Rig::new(&gpu, &ways.with(|it| it.surface_foam = true));
        for amount in [1.0, 0.1] {
            // The plane is one layer, so all foam is also the foam right behind the frontmost.
            for (i, layer) in ["all", "front"].into_iter().enumerate() {
                let volume = f64::from(amount) * f64::from(SPACING);
                kept(
                    &format!("{layer} foam of {amount}, {splat:?}, {level}"),
                    volume,
                    |spacings| {
                        let mut case = plane(2000, spacings, 18.0);
                        case.amounts.fill([amount, 0.0]);
                        let drawn = draw(&case, &mut rig);
                        let foam = &drawn.foam.as_ref().expect("foam").thickness;
                        total(foam.data.iter().map(|t| t[i]), &case, spacings, level)
                    },
                );
            }
        }
    }
}

/// Off the axis of a wide lens, a sprite that faces the eye is tilted against the image plane by up
/// to 61 degrees.
#[test]
fn foam_off_the_axis_keeps_its_volume() {
    let gpu = Gpu::shared();
    for splat in [Splat::Compute, Splat::Raster] {
        let ways = config(SIZE).with(|it| {
            it.thickness_splat = Some(splat);
            it.thickness_level = 1;
        });
        let mut rig = Rig::new(&gpu, &ways.with(|it| it.surface_foam = true));
        let mut case = plane_in(90.0, 2000, 4.0, 4.0);
        case.amounts.fill([1.0, 0.0]);
        let drawn = draw(&case, &mut rig);
        let foam = &drawn.foam.as_ref().expect("foam").thickness;
        let part = total(foam.data.iter().map(|t| t[0]), &case, 4.0, 1) / f64::from(SPACING);
        eprintln!("{splat:?}: {part:.4} of it");
        assert!((part - 1.0).abs() < LOSS, "{splat:?}: {part}");
    }
}

/// Water's thickness is blended without steps, or added in steps too fine to matter.
#[test]
fn far_water_keeps_its_volume() {
    let gpu = Gpu::shared();
    for splat in [Splat::Compute, Splat::Raster] {
        let config = config(SIZE).with(|it| {
            it.thickness_splat = Some(splat);
            it.thickness_level = 2;
        });
        let mut rig = Rig::new(&gpu, &config);
        kept(&format!("water, {splat:?}"), f64::from(SPACING), |spacings| {
            let case = plane(2000, spacings, 18.0);
            total(draw(&case, &mut rig).thickness.data.iter().copied(), &case, spacings, 2)
        });
    }
}

/// The light map's texels have the same widths as the pixels in the tests above.
#[test]
fn far_maps_of_the_sun_keep_what_casts() {
    let gpu = Gpu::shared();
    let config = config(SIZE).with(|it| {
        it.light_map_size = Some(64);
        it.surface_foam = true;
        it.spray = true;
    });
    let mut rig = Rig::new(&gpu, &config);
    // The map's channels for particles of this foam amount: metres of water, and metres of foam.
    for (amount, channel, share) in [(0.0, 0, 1.0), (1.0, 1, 1.0), (0.1, 1, 0.1)] {
        let wanted = share * f64::from(SPACING);
        kept(&format!("channel {channel} of the sun's map, foam {amount}"), wanted, |spacings| {
            let mut random = Random(5);
            let mut case = plane(2000, 1.0, 12.0);
            case.amounts.fill([amount, 0.0]);
            let radius = 0.5 * 64.0 * spacings * SPACING;
            let mut place = || random.between(-0.7, 0.7) * radius;
            case.shot.positions = (0..2000).map(|_| [place(), 0.0, place()]).collect();
            case.shot.settings.light.direction = [0.0, 1.0, 0.0];
            case.shot.light_volume = Some(LightVolume { center: [0.0; 3], radius });
            let drawn = draw(&case, &mut rig);
            let map = drawn.light_thickness.as_ref().expect("a map");
            total(map.data.iter().map(|t| t[channel]), &case, spacings, 0)
        });
    }
}

/// Particles that are only spray block sunlight in proportion to their droplets: a single droplet
/// in full, several with 0.3 squared.
#[test]
fn far_maps_of_the_sun_keep_what_spray_casts() {
    let gpu = Gpu::shared();
    let config = config(SIZE).with(|it| {
        it.light_map_size = Some(64);
        it.spray = true;
    });
    let mut rig = Rig::new(&gpu, &config);
    for (droplets, part) in [(1, 1.0), (16, 0.09)] {
        let shade = 2.5;
        let wanted = f64::from(shade) * part * f64::from(SPACING);
        kept(&format!("the sun's map of {droplets} droplets"), wanted, |spacings| {
            let mut random = Random(5);
            let mut case = plane(2000, 1.0, 12.0);
            let radius = 0.5 * 64.0 * spacings * SPACING;
            let mut place = || random.between(-0.7, 0.7) * radius;
            case.shot.positions = (0..2000).map(|_| [place(), 0.0, place()]).collect();
            case.shot.densities = Some(vec![1.0; 2000]);
            (case.shot.settings.spray.droplets, case.shot.settings.spray.shade) = (droplets, shade);
            case.shot.settings.light.direction = [0.0, 1.0, 0.0];
            case.shot.light_volume = Some(LightVolume { center: [0.0; 3], radius });
            let drawn = draw(&case, &mut rig);
            let map = drawn.light_thickness.as_ref().expect("a map");
            total(map.data.iter().map(|t| t[1]), &case, spacings, 0)
        });
    }
}

/// Whitewater particles seen by the eye and by the sun, with five radii from 0.656 spacings down to
/// a fifth.
#[test]
fn far_whitewater_particles_keep_their_light() {
    let gpu = Gpu::shared();
    let whitewater = Some(WhitewaterConfig::new(4096));
    let mut rig = Rig::new(
        &gpu,
        &config(SIZE).with(|it| {
            it.whitewater = whitewater;
            it.light_map_size = Some(64);
        }),
    );
    const COUNT: usize = 2000;
    // `life` is the fraction left at this age.
    for (age, life) in [(0.0, 1.0), (0.998, (1.0_f32 - 0.998 * 0.998).powf(0.4))] {
        let radius = 0.656_f32;
        // A fifth of the particles has each of the five sizes. The sprite's thickness is 1 -
        // x^2.25.
        let squares: f64 = (1..=5).map(|i| 1.0 / f64::from(i * i)).sum::<f64>() / 5.0;
        let wanted = std::f64::consts::PI * f64::from(radius * radius) * squares;
        let wanted = wanted * (1.0 - 2.0 / 4.25) * f64::from(life);
        let mut drawn = |spacings: f32, sun: bool| {
            let mut case = plane(COUNT, spacings, 18.0);
            if sun {
                let mut random = Random(5);
                let radius = 0.5 * 64.0 * spacings * SPACING;
                let mut place = || random.between(-0.7, 0.7) * radius;
                case.shot.positions = (0..COUNT).map(|_| [place(), 0.0, place()]).collect();
                case.shot.light_volume = Some(LightVolume { center: [0.0; 3], radius });
            } else {
                case.shot.light_volume = Some(LightVolume { center: [0.0; 3], radius: 1.0 });
            }
            case.shot.settings.light.direction = [0.0, 1.0, 0.0];
            case.shot.settings.whitewater.radius = radius * SPACING;
            let positions = std::mem::take(&mut case.shot.positions);
            let ids: Vec<u32> = (0..COUNT as u32).collect();
            let ages = vec![age; COUNT];
            let input = Whitewater {
                positions: &positions,
                kinds: None,
                radii: None,
                ages: Some(&ages),
                ids: Some(&ids),
            };
            let (water, cloud) = (rig.particles(&case.shot), rig.whitewater(&input));
            let drawn =
                rig.draw_whitewater(&case.shot, &water.particles(), Some(cloud.particles()));
            let map = match sun {
                true => drawn.light_whitewater.expect("a map"),
                false => drawn.whitewater.expect("foam").thickness,
            };
            total(map.data.iter().map(|t| t[0]), &case, spacings, 0)
        };
        kept(&format!("foam of age {age}"), wanted, |spacings| drawn(spacings, false));
        kept(&format!("foam of age {age} to the sun"), wanted, |spacings| drawn(spacings, true));
    }
}
