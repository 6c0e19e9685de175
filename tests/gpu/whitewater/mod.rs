//! Compares the foam of whitewater particles (passes `splat`, `radiance` and `blur`) with the CPU
//! twin, and checks the picture that contains this foam.

mod blur;
mod fluid;
mod heaped;
mod lone;
pub mod packets;
mod ranges;
mod sun;
pub mod ways;

use ash::vk;
use glam::{DVec3, Mat4, Vec3, vec3};
use whitewater::headless;
use whitewater::water::{Shading, Shadows};
use whitewater::{Config, Count, LightVolume, Renderer, Settings, WhitewaterParticles};
use whitewater::{
    Irradiance, Occlusion as Occluding, OcclusionReach, ShadowMixing, Submerged, WhitewaterConfig,
    WhitewaterSettings, WhitewaterSplat,
};

use crate::light::even as mask;
use crate::reference::whitewater::{self as twin, Layers, Occlusion, Particle, Seen, foam_bounds};
use crate::reference::{EMPTY, Image};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{
    Drawn, DrawnWhitewater, Rig, Shot, attenuation, config, extent, stream, twins,
};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::support::tolerance::Between;

const SIZE: vk::Extent2D = vk::Extent2D { width: 93, height: 61 };
/// Relative error of a rounding to half precision. Vulkan permits rounding to nearest and towards
/// zero.
const HALF: f64 = 1.0 / 1024.0;
/// Error of a stored normal. It is divided by the sum of its components' absolute values, and two
/// combinations of x and y are stored in a byte each. Half a step of both bytes, 0.5/127, moves (x,
/// y) and z by at most 0.5/127 each. Normalizing divides by a length of at least 1/sqrt 3. The
/// image has half precision.
const TURNED: f64 = SQRT_3 * std::f64::consts::SQRT_2 * 0.5 / 127.0 + 2.0 * HALF;
const SQRT_3: f64 = 1.732_050_807_568_877_2;

fn whitewater_config(size: vk::Extent2D) -> Config {
    let whitewater = WhitewaterConfig::new(4096).with(|it| it.occlusion = Occluding::Reference);
    config(size).with(|it| it.whitewater = Some(whitewater))
}

/// `whitewater_config` with this way to splat the particles.
fn by(way: WhitewaterSplat, size: vk::Extent2D) -> Config {
    let config = whitewater_config(size);
    let whitewater = config.whitewater.map(|whitewater| whitewater.with(|it| it.splat = Some(way)));
    config.with(|it| it.whitewater = whitewater)
}

/// The ways to splat that the device supports.
fn ways(gpu: &Gpu) -> Vec<WhitewaterSplat> {
    let mut ways = vec![WhitewaterSplat::Compute, WhitewaterSplat::Raster];
    if gpu.enabled.buffer_int64_atomics {
        ways.push(WhitewaterSplat::Compute64);
    } else {
        crate::support::skipped::skipped(
            "no 64-bit atomics here: WhitewaterSplat::Compute64 is not drawn",
        );
    }
    ways
}

/// A shot with whitewater particles.
#[derive(Clone)]
struct Whitewater {
    shot: Shot,
    positions: Vec<[f32; 3]>,
    kinds: Vec<u32>,
    radii: Option<Vec<f32>>,
    ages: Vec<f32>,
    ids: Option<Vec<u32>>,
    /// The host's fluid that covers foam, if there is one.
    fluid: Option<Shot>,
}

impl Whitewater {
    /// Particles of all kinds and ages, with radii from a fiftieth of a pixel, before and behind
    /// some water and a scene whose right half is nearer.
    fn new(lens: Lens) -> Self {
        let mut shot = Shot::new(SIZE, lens, 0.2, &scenes::cloud(31, 40, 3.0, 9.0));
        shot.scene_depth(|x, _| Some(if x < SIZE.width / 2 { 8.5 } else { 6.0 }));
        shot.settings.whitewater.radius = 0.3;
        let points = scenes::cloud(7, 400, 2.0, 9.0);
        let mut random = Random(3);
        let positions = scenes::world(&shot.camera, &points);
        let count = positions.len();
        let radius = |i: usize, random: &mut Random| match i % 3 {
            0 => random.between(0.001, 0.05),
            _ => random.between(0.05, 0.6),
        };
        Self {
            shot,
            positions,
            kinds: (0..count).map(|i| i as u32 % 4).collect(),
            radii: Some((0..count).map(|i| radius(i, &mut random)).collect()),
            ages: (0..count).map(|_| random.between(-0.1, 1.1)).collect(),
            ids: Some((0..count).map(|_| random.bits() as u32).collect()),
            fluid: None,
        }
    }

    fn input(&self) -> headless::Whitewater<'_> {
        headless::Whitewater {
            positions: &self.positions,
            kinds: Some(&self.kinds),
            radii: self.radii.as_deref(),
            ages: Some(&self.ages),
            ids: self.ids.as_deref(),
        }
    }

    fn draw(&self, rig: &mut Rig<'_>) -> Drawn {
        let (water, cloud) = (rig.particles(&self.shot), rig.whitewater(&self.input()));
        let fluid = self.fluid.as_ref().map(|shot| (rig.scene(shot).1, shot));
        let particles = cloud.particles().with(|it| {
            it.fluid_depth = fluid.as_ref().map(|(texture, shot)| {
                texture.host_image().with(|it| it.rect = shot.with_margin(shot.depth_extent).1)
            })
        });
        rig.draw_whitewater(&self.shot, &water.particles(), Some(particles))
    }

    fn particles(&self) -> Vec<Particle> {
        twins(&self.input())
    }

    fn twin_settings(&self) -> twin::Settings {
        let Settings { whitewater: look, water, .. } = &self.shot.settings;
        twin::Settings {
            radius: f64::from(look.radius),
            spacing: f64::from(water.spacing),
            attenuation: attenuation(look.submerged),
            look: twin::Look {
                shapes: [look.foam_shape, look.spray_shape, look.bubble_shape]
                    .map(|shape| shape.map(f64::from)),
                life: look.life.map(f64::from),
                sizes: look.sizes,
                bubble: look.bubble_size.into(),
            },
        }
    }

    fn occlusion(&self) -> Occlusion {
        let look = &self.shot.settings.whitewater;
        Occlusion {
            passes: look.passes,
            radii: [look.search_radius, look.search_radius_step].map(f64::from),
            density: look.sample_density.into(),
            counts: [look.min_samples, look.max_samples].map(f64::from),
            reach: match look.reach {
                OcclusionReach::Radii(radii) => twin::Reach::Radii(radii.into()),
                OcclusionReach::Metres(metres) => twin::Reach::Scene(metres.into()),
            },
            opacities: [look.fluid_opacity, look.scene_opacity].map(f64::from),
            shadow: [look.shadow_scale, look.shadow_exponent, look.shadow_offset].map(f64::from),
            least_blur: 0.0,
            blur: look.blur.into(),
        }
    }
}

/// One channel of an image.
fn channel(image: &Image<[f32; 4]>, i: usize) -> Image<f32> {
    image.map(|texel| texel[i])
}

fn doubles(image: &Image<f32>) -> Image<f64> {
    image.map(|v| f64::from(*v))
}

/// The frontmost foam of each pixel, as the images store it.
fn seen(drawn: &DrawnWhitewater) -> Image<Option<Seen>> {
    let (depth, with) = (&drawn.occluders, &drawn.normal);
    Image::from_fn(depth.width, depth.height, |x, y| {
        let ([depth, ..], [nx, ny, nz, h]) = (depth.at(x, y), with.at(x, y));
        let normal = DVec3::new(nx.into(), ny.into(), nz.into());
        (f64::from(depth) < EMPTY).then_some(Seen { depth: depth.into(), h: h.into(), normal })
    })
}

#[test]
fn foam_is_the_twins() {
    let gpu = Gpu::shared();
    for way in ways(&gpu) {
        foam_is_the_twins_by(&mut Rig::lit(&gpu, &by(way, SIZE), 1));
    }
}

fn foam_is_the_twins_by(rig: &mut Rig<'_>) {
    let spacing = 0.2 / 0.656;
    for (lens, falloff) in LENSES.iter().flat_map(|lens| [(*lens, false), (*lens, true)]) {
        let mut cloud = Whitewater::new(lens);
        if falloff {
            let most = 6.0 * spacing;
            cloud.shot.settings.whitewater.submerged =
                Submerged::Falloff { depth: most, n: 2.0, m: 4.0 };
            cloud.radii = None;
            cloud.ids = None;
        }
        foam_is_the_twins_of(rig, &cloud, &format!("{lens:?}"), 300);
    }
}

/// Compares foam whose shapes, lives and sizes differ from the source's, with and without the
/// source's falloff under water.
#[test]
fn foam_of_any_shape_is_the_twins() {
    let gpu = Gpu::shared();
    for way in ways(&gpu) {
        let mut rig = Rig::lit(&gpu, &by(way, SIZE), 1);
        for submerged in [Submerged::Water, Submerged::Falloff { depth: 1.5, n: 2.0, m: 4.0 }] {
            let mut cloud = Whitewater::new(Lens::Standard);
            let look = &mut cloud.shot.settings.whitewater;
            look.submerged = submerged;
            (look.foam_shape, look.spray_shape) = ([4.0, 1.0], [2.0, 0.5]);
            (look.bubble_shape, look.life) = ([6.0, 3.0], [1.0, 2.0]);
            (look.sizes, look.bubble_size) = (3, 1.0);
            foam_is_the_twins_of(&mut rig, &cloud, &format!("{submerged:?}"), 200);
        }
    }
}

/// The setting `scale` multiplies the foam's radiance, also beyond the brightness that an albedo of
/// 1 gives.
#[test]
fn foam_shines_as_bright_as_it_is_asked_to() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    let mut cloud = Whitewater::new(Lens::Standard);
    cloud.shot.positions.clear();
    // The foam is opaque and the scene black, so the picture is the foam's radiance alone.
    (cloud.shot.settings.whitewater.half_intensity_thickness, cloud.shot.color) =
        (1.0e-6, vec![[0.0; 4]; (SIZE.width * SIZE.height) as usize]);
    let mut draw = |scale: f32| {
        cloud.shot.settings.whitewater.scale = scale;
        channel(&cloud.draw(&mut rig).output, 0)
    };
    let (one, three) = (draw(1.0), draw(3.0));
    let bright = one.data.iter().filter(|v| **v > 0.05).count();
    assert!(bright > 500, "{bright} pixels of foam");
    // The twin of a scaled picture is a single product.
    compare::close("whitewater-scale", &three, &one.map(|v| 3.0 * f64::from(*v)), 0, |_, _, v| {
        1.0e-5 * v + 1.0e-6
    });
}

/// Pixels are far from square, so a footprint widened to one pixel is much longer along the other
/// axis.
#[test]
fn pixels_may_be_far_from_square() {
    let gpu = Gpu::shared();
    for way in ways(&gpu) {
        let mut rig = Rig::lit(&gpu, &by(way, SIZE), 1);
        for stretch in [vec3(0.15, 1.0, 1.0), vec3(1.0, 0.15, 1.0)] {
            let mut cloud = Whitewater::new(Lens::Standard);
            // So large that normals show in flat pixels, too.
            cloud.radii.iter_mut().flatten().for_each(|radius| *radius *= 4.0);
            let camera = &mut cloud.shot.camera;
            camera.projection =
                (Mat4::from_scale(stretch) * camera.projection_matrix()).to_cols_array_2d();
            foam_is_the_twins_of(&mut rig, &cloud, &format!("{stretch}"), 50);
        }
    }
}

fn foam_is_the_twins_of(rig: &mut Rig<'_>, cloud: &Whitewater, name: &str, least_told: u32) {
    let drawn = cloud.draw(rig);
    let foam = drawn.whitewater.expect("whitewater particles");
    let fluid = &drawn.depth;
    let view = cloud.shot.view(SIZE);
    let scene = cloud.shot.scene_at(SIZE, 0);
    let bounds =
        foam_bounds(&cloud.particles(), &view, &cloud.twin_settings(), &scene, &doubles(fluid));
    compare::between("whitewater-depth", &channel(&foam.occluders, 0), &bounds.depth);
    for (i, sum) in bounds.sums.iter().enumerate() {
        compare::between(&format!("whitewater-sum-{i}"), &channel(&foam.thickness, i), sum);
    }
    let seen = seen(&foam);
    let mut told = 0_u32;
    for y in 0..seen.height {
        for x in 0..seen.width {
            let Some(Seen { depth, h, normal }) = seen.at(x, y) else { continue };
            let candidates = bounds.candidates.at(x, y);
            // The normals of foam less than two pixels high depend on their surroundings; another
            // test checks them.
            let shaped = 0.5 * h * view.extent().y >= 2.0;
            let fits = candidates.iter().any(|one| {
                (one.depth.v - depth).abs() <= one.depth.e
                    && (one.h.v - h).abs() <= one.h.e + HALF * one.h.v
                    && (!shaped || (one.normal.v - normal).length() <= one.normal.e + TURNED)
            });
            assert!(fits, "{name} ({x}, {y}): {depth} {h} {normal} of {candidates:?}");
            told += u32::from(shaped && candidates.len() == 1);
        }
    }
    assert!(told >= least_told, "{name}: {told} pixels can tell");
}

#[test]
fn intensity_is_the_formula() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    let mut cloud = Whitewater::new(Lens::Standard);
    cloud.shot.settings.whitewater.half_intensity_thickness = 0.7;
    cloud.shot.settings.whitewater.exponent = 1.6;
    let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
    let expected = Image::from_fn(foam.thickness.width, foam.thickness.height, |x, y| {
        let [above, below, ..] = foam.thickness.at(x, y);
        twin::intensity(f64::from(above) + f64::from(below), f64::from(0.7_f32), f64::from(1.6_f32))
    });
    // pow is exp2 of a product with log2: 3 ulp, and 2^-21 absolute for numbers up to 4; the other
    // operations add 4 ulp.
    compare::close(
        "whitewater-intensity",
        &channel(&foam.occluders, 1),
        &expected,
        0,
        |_, _, v| 4e-6 * v,
    );
}

#[test]
fn shadow_is_the_twins() {
    let gpu = Gpu::shared();
    for (lens, reach, occlusion) in [
        (Lens::Standard, OcclusionReach::Radii(1.0), Occluding::Reference),
        (Lens::ReversedInfinite, OcclusionReach::Radii(3.0), Occluding::Reference),
        (Lens::OffAxis, OcclusionReach::Metres(5.0), Occluding::Reference),
        (Lens::Standard, OcclusionReach::Radii(2.0), Occluding::Fast),
        (Lens::OffAxis, OcclusionReach::Metres(5.0), Occluding::Fast),
    ] {
        let whitewater = WhitewaterConfig::new(4096).with(|it| it.occlusion = occlusion);
        let mut rig =
            Rig::lit(&gpu, &whitewater_config(SIZE).with(|it| it.whitewater = Some(whitewater)), 1);
        let mut cloud = Whitewater::new(lens);
        let look = &mut cloud.shot.settings.whitewater;
        look.reach = reach;
        [look.min_samples, look.max_samples] = [8, 96];
        [look.shadow_scale, look.shadow_exponent, look.shadow_offset] = [2.0, 0.8, -0.02];
        let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
        // Each pixel of a 2x2 block takes a part of the samples, so the fast way needs a blur over
        // the block.
        let least_blur = if occlusion == Occluding::Fast { 4.0 } else { 0.0 };
        let (front, by) = (seen(&foam), Occlusion { least_blur, ..cloud.occlusion() });
        let view = cloud.shot.view(SIZE);
        let of = |i| doubles(&channel(&foam.occluders, i));
        let (opacity, fluid, solid) = (of(1), of(2), of(3));
        let layers = Layers { front: &front, opacity: &opacity, fluid: &fluid, solid: &solid };
        let omega = match occlusion {
            Occluding::Reference => twin::occlusion(&layers, &view, &by),
            Occluding::Fast => twin::shared_occlusion(&layers, &view, &by, 96),
        };
        let shadowed = omega.data.iter().flatten().filter(|o| by.zeta(o.low) > 0.05).count();
        assert!(shadowed > 200, "{lens:?}: {shadowed} pixels in shadow");
        // The blur is a mean with positive weights, so blurring the lower ends gives a lower end.
        // The images round three times to half precision.
        let blurred = |end: fn(&twin::Omega) -> f64| {
            let zeta = omega.map(|o| [o.map_or(0.0, |o| by.zeta(end(&o))), 0.0, 0.0, 0.0]);
            twin::blur(&zeta, &front, &view, &by).map(|v| v[0])
        };
        facings_are_the_twins(&cloud, &foam, &front, &omega);
        let pow = 4.0e-6;
        let bounds = Between {
            low: blurred(|o| o.low).map(|v| v * (1.0 - 3.0 * HALF) - pow),
            high: blurred(|o| o.high).map(|v| v * (1.0 + 3.0 * HALF) + pow),
        };
        compare::between("whitewater-shadow", &channel(&foam.light, 3), &bounds);
    }
}

/// Checks normals of foam of all sizes: large foam has its sphere's normal, small foam faces the
/// open space around it.
fn facings_are_the_twins(
    cloud: &Whitewater,
    foam: &DrawnWhitewater,
    front: &Image<Option<Seen>>,
    omega: &Image<Option<twin::Omega>>,
) {
    let view = cloud.shot.view(SIZE);
    let scene = cloud.shot.scene_at(SIZE, 0);
    let fluid = doubles(&channel(&foam.occluders, 2));
    let bounds = foam_bounds(&cloud.particles(), &view, &cloud.twin_settings(), &scene, &fluid);
    // Number of normals checked by their source: open space alone, a mixture, the sphere alone.
    let mut told = [0; 3];
    for (x, y) in (0..front.height).flat_map(|y| (0..front.width).map(move |x| (x, y))) {
        let (Some(seen), Some(omega)) = (front.at(x, y), omega.at(x, y)) else { continue };
        let [one] = &bounds.candidates.at(x, y)[..] else { continue };
        let kept = (one.normal.v, one.normal.e + TURNED);
        let (facing, e) = omega.facing(&view, seen.h, kept);
        // The images have half precision.
        let off = (seen.normal - facing).length();
        assert!(
            off <= e + 2.0 * HALF,
            "({x}, {y}): {} is {off} from {facing}, of {e}",
            seen.normal
        );
        let pixels = 0.5 * seen.h * view.extent().y;
        if e < 0.2 {
            told[usize::from(pixels > 1.0) + usize::from(pixels >= 2.0)] += 1;
        }
    }
    assert!(told.iter().all(|count| *count > 100), "{told:?} can tell");
}

/// Foam of a given size in pixels lies on an endless wall, which hides half of each sphere. So the
/// fast shadow is 0.5 at all distances, although the number of samples changes with the foam's
/// size.
#[test]
fn fast_shadow_does_not_change_with_the_distance() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(
        &gpu,
        &whitewater_config(SIZE).with(|it| it.whitewater = Some(WhitewaterConfig::new(8000))),
        1,
    );
    // Larger foam has occlusion spheres that leave the picture.
    for pixels in [0.02_f32, 0.1, 0.5, 1.5] {
        let mut cloud = Whitewater::new(Lens::Standard);
        cloud.shot = Shot::new(SIZE, Lens::Standard, 0.2, &scenes::cloud(31, 1, 30.0, 31.0));
        let depth = 6.0_f32;
        cloud.shot.scene_depth(|_, _| Some(depth.into()));
        let view = cloud.shot.view(SIZE);
        let radius = pixels * depth / (0.5 * SIZE.height as f32) / view.focal().y.abs() as f32;
        let look = &mut cloud.shot.settings.whitewater;
        look.reach = OcclusionReach::Metres(1.0e9);
        // Scale and exponent 1 and offset 0 give the occluded fraction unchanged.
        [look.shadow_scale, look.shadow_exponent, look.shadow_offset] = [1.0, 1.0, 0.0];
        // Foam this transparent does not occlude other foam.
        look.half_intensity_thickness = 1.0e6;
        // One particle in the middle of each pixel, with its front at the wall.
        let (depth, scale) = (depth + 0.95 * radius, cloud.shot.camera.projection_matrix());
        let middle = |i: u32, n: u32, scale: f32| ((2 * i + 1) as f32 / n as f32 - 1.0) / scale;
        let points: Vec<_> = (0..SIZE.width * SIZE.height)
            .map(|i| (i % SIZE.width, i / SIZE.width))
            .map(|(x, y)| {
                let x = middle(x, SIZE.width, scale.x_axis.x);
                [x * depth, middle(y, SIZE.height, scale.y_axis.y) * depth, depth]
            })
            .collect();
        let count = points.len();
        cloud.positions = scenes::world(&cloud.shot.camera, &points);
        cloud.kinds = vec![0; count];
        cloud.radii = Some(vec![radius; count]);
        cloud.ages = vec![0.0; count];
        cloud.ids = Some(vec![5; count]);
        let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
        let middle: Vec<f32> = (0..SIZE.width * SIZE.height)
            .map(|i| ((i % SIZE.width) as usize, (i / SIZE.width) as usize))
            .filter(|(x, y)| (30..62).contains(x) && (18..42).contains(y))
            .filter(|(x, y)| foam.occluders.at(*x, *y)[0] < 1.0e9)
            .map(|(x, y)| foam.light.at(x, y)[3])
            .collect();
        let mean = middle.iter().sum::<f32>() / middle.len() as f32;
        assert!(middle.len() > 50, "{pixels}: {}", middle.len());
        assert!((mean - 0.5).abs() < 0.02, "{pixels}: {mean}");
    }
}

/// Pass `radiance` works on tiles of 8x8 pixels. A tile whose only foam is one pixel gets light,
/// wherever in the tile that pixel is. Pixels without foam have no light, also none from the frame
/// before.
#[test]
fn the_foam_of_a_single_pixel_has_light() {
    let gpu = Gpu::shared();
    let whitewater = WhitewaterConfig::new(4096);
    let mut rig =
        Rig::lit(&gpu, &whitewater_config(SIZE).with(|it| it.whitewater = Some(whitewater)), 1);
    let mut cloud = Whitewater::new(Lens::Standard);
    even(&mut rig, &mut cloud.shot, [1.0; 4]);
    cloud.shot.positions.clear();
    cloud.shot.scene_depth(|_, _| None);
    let view = cloud.shot.view(SIZE);
    let (width, height) = (SIZE.width as usize, SIZE.height as usize);
    for frame in 0..8 {
        // Each frame has one pixel with foam in each tile, and another pixel in the next frame.
        let of_tile = |i: usize| {
            let (across, own) = (width.div_ceil(8), (8 * frame + 9 * i) % 64);
            [8 * (i % across) + own % 8, 8 * (i / across) + own / 8]
        };
        let tiles = width.div_ceil(8) * height.div_ceil(8);
        let pixels: Vec<_> =
            (0..tiles).map(of_tile).filter(|[x, y]| *x < width && *y < height).collect();
        let points: Vec<_> = pixels
            .iter()
            .map(|[x, y]| {
                let ray = view.ray(*x, *y);
                [ray.x, ray.y, 1.0].map(|v| 5.0 * v as f32)
            })
            .collect();
        let count = points.len();
        cloud.positions = scenes::world(&cloud.shot.camera, &points);
        (cloud.kinds, cloud.ages) = (vec![0; count], vec![0.0; count]);
        (cloud.radii, cloud.ids) = (Some(vec![1.0e-4; count]), Some(vec![0; count]));
        let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
        for y in 0..height {
            for x in 0..width {
                let foams = pixels.contains(&[x, y]);
                assert_eq!(foam.occluders.at(x, y)[0] < 1.0e9, foams, "{frame}: ({x}, {y})");
                assert_eq!(foam.light.at(x, y)[0] > 0.0, foams, "{frame}: light at ({x}, {y})");
            }
        }
    }
}

/// Gives the frame an environment of one colour and no direct sun.
fn even(rig: &mut Rig<'_>, shot: &mut Shot, color: [f32; 4]) {
    rig.environment(extent(16, 8), &[color; 128]);
    shot.settings.light.shade = shot.settings.light.irradiance;
}

#[test]
fn light_of_an_even_environment_is_half_of_it() {
    let gpu = Gpu::shared();
    for irradiance in [Irradiance::Prefiltered, Irradiance::Sampled] {
        let occlusion = Occluding::Reference;
        let whitewater = WhitewaterConfig::new(4096).with(|it| {
            it.irradiance = irradiance;
            it.occlusion = occlusion;
        });
        let mut rig =
            Rig::lit(&gpu, &whitewater_config(SIZE).with(|it| it.whitewater = Some(whitewater)), 1);
        let mut cloud = Whitewater::new(Lens::Standard);
        even(&mut rig, &mut cloud.shot, [1.0, 2.0, 0.25, 1.0]);
        let foam = cloud.draw(&mut rig).whitewater.expect("whitewater particles");
        let front = seen(&foam);
        // Sampled points are not equally many on all sides, so the twin computes their mean cosine.
        let expected = match irradiance {
            Irradiance::Prefiltered => front.map(|seen| seen.map(|_| DVec3::splat(0.5))),
            Irradiance::Sampled => {
                let view = cloud.shot.view(SIZE);
                twin::irradiance(&front, &view, &cloud.occlusion(), |_| DVec3::ONE)
            }
        };
        let both = expected.map(|light| light.map_or([0.0; 4], |l| [0.0, l.x, l.y, l.z]));
        let expected = twin::blur(&both, &front, &cloud.shot.view(SIZE), &cloud.occlusion());
        for (i, part) in [1.0, 2.0, 0.25].into_iter().enumerate() {
            let expected = expected.map(|light| light[1 + i] * part);
            // Seven values in half precision: the environment, its sum, three images and a unit
            // normal; then few operations.
            let tolerance = |_: usize, _: usize, v: f64| 8.0 * HALF * v;
            compare::close("whitewater-light", &channel(&foam.light, i), &expected, 0, tolerance);
        }
    }
}

#[test]
fn both_ways_to_gather_light_agree() {
    let gpu = Gpu::shared();
    let draw = |irradiance| {
        let occlusion = Occluding::Reference;
        let whitewater = WhitewaterConfig::new(4096).with(|it| {
            it.irradiance = irradiance;
            it.occlusion = occlusion;
        });
        let mut rig =
            Rig::lit(&gpu, &whitewater_config(SIZE).with(|it| it.whitewater = Some(whitewater)), 1);
        let mut cloud = Whitewater::new(Lens::Standard);
        // The environment is bright above and dark below.
        let texels: Vec<_> =
            (0..128).map(|i| [1.5 - (i / 16) as f32 / 7.0, 0.5, 0.5, 1.0]).collect();
        rig.environment(extent(16, 8), &texels);
        cloud.shot.settings.light.shade = cloud.shot.settings.light.irradiance;
        [cloud.shot.settings.whitewater.min_samples, cloud.shot.settings.whitewater.max_samples] =
            [512, 512];
        channel(&cloud.draw(&mut rig).whitewater.expect("whitewater particles").light, 0)
    };
    let (once, sampled) = (draw(Irradiance::Prefiltered), draw(Irradiance::Sampled));
    let (low, high) = once
        .data
        .iter()
        .filter(|v| **v > 0.0)
        .fold((9.0_f32, 0.0_f32), |(a, b), v| (a.min(*v), b.max(*v)));
    assert!(high > 1.3 * low, "the side that is turned up is lighter: {low} to {high}");
    // With 512 sampled points, their mean cosine differs by a fiftieth between directions.
    compare::close("whitewater-gathered", &sampled, &doubles(&once), 0, |_, _, v| 0.03 * v);
}

#[test]
fn foam_lies_over_the_scene() {
    let gpu = Gpu::shared();
    for (shading, mixing) in
        [(Shading::Raster, ShadowMixing::Scaled), (Shading::Compute, ShadowMixing::Source)]
    {
        let config = whitewater_config(SIZE).with(|it| it.composite = Some(shading));
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut cloud = Whitewater::new(Lens::Standard);
        cloud.shot.positions.clear();
        let look = &mut cloud.shot.settings.whitewater;
        (look.mixing, look.albedo, look.shadow_color) = (mixing, [0.9, 0.7, 0.5], [0.1, 0.0, 0.3]);
        let (albedo, shadow) = (Vec3::from(look.albedo), Vec3::from(look.shadow_color));
        let drawn = cloud.draw(&mut rig);
        let foam = drawn.whitewater.as_ref().expect("whitewater particles");
        let over = match mixing {
            ShadowMixing::Scaled => twin::composite_hdr,
            ShadowMixing::Source => twin::composite_source,
        };
        let expected = |x: usize, y: usize| {
            let [r, g, b, zeta] = foam.light.at(x, y).map(f64::from);
            let rho = f64::from(foam.thickness.at(x, y)[0]);
            let [br, bg, bb, _] = cloud.shot.color[y * foam.light.width + x].map(f64::from);
            let (background, light) = (DVec3::new(br, bg, bb), DVec3::new(r, g, b));
            let iota = twin::intensity(rho, 3.0, 1.25);
            let scale = 2.0 * albedo.as_dvec3();
            over(background, iota, zeta, light, shadow.as_dvec3(), scale).to_array()
        };
        for i in 0..3 {
            let expected =
                Image::from_fn(foam.light.width, foam.light.height, |x, y| expected(x, y)[i]);
            let name = format!("whitewater-over-{i}");
            // The tolerance of `intensity_is_the_formula`, for the difference from the background,
            // which is blended in.
            compare::close(&name, &channel(&drawn.output, i), &expected, 0, |_, _, v| {
                1e-5 * (1.0 + v)
            });
        }
        let touched =
            (drawn.output.data.iter().zip(&cloud.shot.color)).filter(|(a, b)| a != b).count();
        assert!(touched > 500, "{touched} pixels with foam");
    }
}

#[test]
fn bubbles_lie_under_the_water() {
    let gpu = Gpu::shared();
    let config = whitewater_config(SIZE).with(|it| it.max_particles = 20_000);
    let mut rig = Rig::lit(&gpu, &config, 1);
    let draw = |rig: &mut Rig<'_>, depth: Option<f32>| {
        // A wall of water from 4 to 7 m, and foam before, in or behind it.
        let block = scenes::block(3, 0.2, [40, 28, 15], [-4.0, -2.8, 4.0]);
        let mut shot = Shot::new(SIZE, Lens::Standard, 0.656 * 0.2, &block);
        even(rig, &mut shot, [1.0, 1.0, 1.0, 1.0]);
        let points: Vec<_> = depth.map_or(Vec::new(), |d| {
            (0..40).map(|i| [(i % 8) as f32 * 0.12 - 0.4, (i / 8) as f32 * 0.12 - 0.3, d]).collect()
        });
        let count = points.len();
        Whitewater {
            positions: scenes::world(&shot.camera, &points),
            shot,
            kinds: vec![0; count],
            radii: Some(vec![0.2; count]),
            ages: vec![0.0; count],
            ids: Some(vec![0; count]),
            fluid: None,
        }
        .draw(rig)
    };
    let middle = |drawn: &Drawn| Vec3::from_slice(&drawn.output.at(46, 30)[..3]);
    let without = middle(&draw(&mut rig, None));
    let [before, near, deep, behind] =
        [3.0, 4.6, 6.0, 8.0].map(|depth| draw(&mut rig, Some(depth)));
    let sums = |drawn: &Drawn| {
        drawn.whitewater.as_ref().expect("whitewater particles").thickness.at(46, 30)
    };
    assert!(sums(&before)[0] > 1.0 && sums(&before)[1] == 0.0, "{:?}", sums(&before));
    assert!(sums(&near)[0] == 0.0 && sums(&near)[1] > 1.0, "{:?}", sums(&near));
    assert!(sums(&behind)[0] == 0.0 && sums(&behind)[1] > 1.0, "{:?}", sums(&behind));
    // A metre of water takes a tenth or more of the light.
    let change = [before, near, deep, behind].map(|drawn| (middle(&drawn) - without).length());
    assert!(change.windows(2).all(|two| two[0] > 1.1 * two[1]), "{change:?}");
    assert!(change[3] > 0.01, "{change:?}");
}

#[test]
fn order_is_no_matter() {
    let gpu = Gpu::shared();
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    let cloud = Whitewater::new(Lens::Reversed);
    let mut turned = cloud.clone();
    let order = Random(9).order(cloud.positions.len());
    let moved = |all: &[u32]| -> Vec<u32> { order.iter().map(|i| all[*i]).collect() };
    turned.positions = order.iter().map(|i| cloud.positions[*i]).collect();
    turned.kinds = moved(&cloud.kinds);
    turned.ids = cloud.ids.as_deref().map(moved);
    turned.ages = order.iter().map(|i| cloud.ages[*i]).collect();
    turned.radii = cloud.radii.as_ref().map(|all| order.iter().map(|i| all[*i]).collect());
    let [a, b] = [cloud.draw(&mut rig), turned.draw(&mut rig)];
    compare::same_color("whitewater-order", &a.output, &b.output);
    let [a, b] = [a, b].map(|drawn| drawn.whitewater.expect("whitewater particles"));
    compare::same_color("whitewater-order-thickness", &a.thickness, &b.thickness);
    compare::same_color("whitewater-order-normal", &a.normal, &b.normal);
}

#[test]
fn without_particles_nothing_changes() {
    let gpu = Gpu::shared();
    let cloud = Whitewater::new(Lens::Standard);
    let plain = Rig::lit(&gpu, &config(SIZE), 1).draw(&cloud.shot).output;
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    let none = rig.draw(&cloud.shot).output;
    // This configuration runs another shader, whose compiler may round differently.
    let doubles = plain.map(|c| c.map(f64::from));
    compare::close_color("whitewater-none", &none, &doubles, |_, _| [1e-6; 4]);
    let nothing = |positions, ages| Whitewater { positions, ages, ..cloud.clone() };
    let far = |p: [f32; 3]| vec![p; cloud.positions.len()];
    let new = vec![0.0; cloud.positions.len()];
    for (name, cloud) in [
        ("nan", nothing(far([f32::NAN, 0.0, -4.0]), new.clone())),
        ("infinite", nothing(far([0.0, f32::INFINITY, -4.0]), new.clone())),
        ("huge", nothing(far([0.0, 0.0, 1.0e30]), new)),
        ("gone", nothing(cloud.positions.clone(), vec![1.0; cloud.positions.len()])),
        ("aged by NaN", nothing(cloud.positions.clone(), vec![f32::NAN; cloud.positions.len()])),
    ] {
        compare::same_color(&format!("whitewater-{name}"), &cloud.draw(&mut rig).output, &none);
    }
}

#[test]
fn mistakes_are_named() {
    let gpu = Gpu::shared();
    let cloud = Whitewater::new(Lens::Standard);
    let mut rig = Rig::lit(&gpu, &whitewater_config(SIZE), 1);
    type Mistake = fn(&mut WhitewaterSettings);
    let cases: [(&str, Mistake); 15] = [
        ("Settings.whitewater.bubble_shape", |look| look.bubble_shape[1] = 0.0),
        ("Settings.whitewater.life", |look| look.life = [f32::NAN, 0.4]),
        ("Settings.whitewater.sizes", |look| look.sizes = 0),
        ("Settings.whitewater.bubble_size", |look| look.bubble_size = 1.5),
        ("Settings.whitewater.scale", |look| look.scale = -1.0),
        ("Settings.whitewater.radius", |look| look.radius = f32::NAN),
        ("Settings.whitewater.submerged.depth", |look| {
            look.submerged = Submerged::Falloff { depth: 0.0, n: 2.0, m: 4.0 };
        }),
        ("Settings.whitewater.half_intensity_thickness", |look| {
            look.half_intensity_thickness = 0.0
        }),
        ("Settings.whitewater.exponent", |look| look.exponent = -1.0),
        ("Settings.whitewater.passes", |look| look.passes = 9),
        ("Settings.whitewater.max_samples", |look| {
            [look.min_samples, look.max_samples] = [16, 513]
        }),
        ("Settings.whitewater.max_samples", |look| [look.min_samples, look.max_samples] = [32, 16]),
        ("Settings.whitewater.reach", |look| look.reach = OcclusionReach::Metres(0.0)),
        ("Settings.whitewater.scene_opacity", |look| look.scene_opacity = 1.5),
        ("Settings.whitewater.albedo", |look| look.albedo[2] = 1.01),
    ];
    for (field, mistake) in cases {
        let mut shot = cloud.shot.clone();
        mistake(&mut shot.settings.whitewater);
        let error = rig.refused(&shot, None);
        assert!(error.contains(field), "{field}: {error}");
    }
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let data = rig.stub.data(&[0; 1024], usage);
    let good = WhitewaterParticles::new(stream(&data, 0, 12), Count::Cpu(80));
    let short = Some(stream(&data, 1000, 4));
    for (field, particles) in [
        ("Frame.whitewater.positions", good.with(|it| it.count = Count::Cpu(86))),
        ("Frame.whitewater.count", good.with(|it| it.count = Count::Cpu(4097))),
        ("Frame.whitewater.kinds", good.with(|it| it.kinds = short)),
        ("Frame.whitewater.radii", good.with(|it| it.radii = short)),
        ("Frame.whitewater.ages", good.with(|it| it.ages = short)),
        ("Frame.whitewater.ids", good.with(|it| it.ids = Some(stream(&data, 2, 4)))),
    ] {
        let error = rig.refused(&cloud.shot, Some(particles));
        assert!(error.contains(field), "{field}: {error}");
    }
    let (_, depth) = rig.scene(&cloud.shot);
    let lost = depth.host_image().with(|it| it.before = whitewater::access::NOTHING);
    let lost = good.with(|it| it.fluid_depth = Some(lost));
    let error = rig.refused(&cloud.shot, Some(lost));
    assert!(error.contains("Frame.whitewater.fluid_depth"), "{error}");
    let error = Rig::new(&gpu, &config(SIZE)).refused(&cloud.shot, Some(good));
    assert!(error.contains("Frame.whitewater"), "{error}");
    for (field, whitewater) in [
        ("Config.whitewater.max_particles", WhitewaterConfig::new(0)),
        ("Config.whitewater.max_stride", WhitewaterConfig::new(1).with(|it| it.max_stride = 8)),
    ] {
        let config = config(SIZE).with(|it| it.whitewater = Some(whitewater));
        let error = Renderer::new(&gpu.context(1), &config).err().expect("refused");
        assert!(error.to_string().contains(field), "{field}: {error}");
    }
}

#[test]
fn the_sun_shines_as_far_as_it_comes() {
    let gpu = Gpu::shared();
    let config = whitewater_config(SIZE).with(|it| it.shadow = Some(Shadows::Mask));
    let mut rig = Rig::lit(&gpu, &config, 1);
    let mut cloud = Whitewater::new(Lens::Reversed);
    let mut draw = |part: f32| {
        let (_image, shadow) = mask(&rig, part);
        cloud.shot.shadow = Some(shadow);
        channel(&cloud.draw(&mut rig).whitewater.expect("whitewater particles").light, 0)
    };
    let [none, half, all] = [0.0, 0.5, 1.0].map(&mut draw);
    let mean = Image::from_fn(all.width, all.height, |x, y| {
        0.5 * (f64::from(none.at(x, y)) + f64::from(all.at(x, y)))
    });
    compare::close("whitewater-mask", &half, &mean, 0, |_, _, v| 4.0 * HALF * v);
    let lit = all.data.iter().zip(&none.data).filter(|(all, none)| **all > 1.2 * **none).count();
    assert!(lit > 500, "{lit} pixels are lighter in the sun");
}

#[test]
fn water_takes_the_sun_from_foam() {
    let gpu = Gpu::shared();
    let of = |cast: Option<u32>| {
        let mut rig =
            Rig::lit(&gpu, &whitewater_config(SIZE).with(|it| it.light_map_size = cast), 1);
        // A slab of water lies between the sun and the foam; the eye sees both.
        let mut shot = Shot::new(SIZE, Lens::Standard, 0.0656, &[]);
        shot.settings.light.direction = [0.0, 1.0, 0.0];
        let region =
            LightVolume { center: scenes::world(&shot.camera, &[[0.0, 0.5, 4.0]])[0], radius: 2.5 };
        shot.light_volume = cast.map(|_| region);
        let slab = scenes::block(3, 0.1, [20, 4, 20], [-1.0, 1.0, 3.0]);
        shot.positions = scenes::world(&shot.camera, &slab);
        let point = |i: u32| [(i % 10) as f32 * 0.1 - 0.5, (i / 10) as f32 * 0.05, 4.0];
        let points: Vec<_> = (0..60).map(point).collect();
        let cloud = Whitewater {
            positions: scenes::world(&shot.camera, &points),
            shot,
            kinds: vec![0; 60],
            radii: Some(vec![0.15; 60]),
            ages: vec![0.0; 60],
            ids: Some(vec![0; 60]),
            fluid: None,
        };
        channel(&cloud.draw(&mut rig).whitewater.expect("whitewater particles").light, 0).at(46, 28)
    };
    let (open, under) = (of(None), of(Some(64)));
    assert!(open > 0.1 && under < 0.9 * open, "{under} under water, {open} without");
}
