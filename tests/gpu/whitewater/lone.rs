//! Isolated foam of one or a few pixels: its light must be correct and steady, although
//! neighbouring pixels have no samples.

use glam::{DVec2, DVec3};
use whitewater::Settings;
use whitewater::{Irradiance, OcclusionReach, WhitewaterConfig};

use super::{SIZE, Whitewater, channel, doubles, even, seen, whitewater_config};
use crate::reference::whitewater::{self as twin, Layers, Occlusion};
use crate::support::device::Gpu;
use crate::support::rig::{DrawnWhitewater, Rig, Shot};
use crate::support::scenes::{self, Lens};

/// Eye depth of the wall in the middle of the picture.
const WALL: f64 = 6.0;

/// Sixteen isolated particles on a wall, one at each position in a block of 4x4 pixels.
struct Lone {
    cloud: Whitewater,
    /// The pixels that contain the particles' centres.
    pixels: Vec<[usize; 2]>,
    /// The wall's normal in world space.
    normal: DVec3,
}

impl Lone {
    /// Particles with a radius in pixels, on a wall whose depth changes with this slope, at this
    /// offset from pixel centres.
    fn new(settings: Settings, radius: f64, slope: DVec2, offset: DVec2) -> Self {
        let mut cloud = Whitewater::new(Lens::Standard);
        cloud.shot = Shot::new(SIZE, Lens::Standard, 0.2, &scenes::cloud(31, 1, 30.0, 31.0));
        cloud.shot.settings = settings;
        let view = cloud.shot.view(SIZE);
        // Plane with the same n . p as in the middle.
        let wall = |x: usize, y: usize| WALL / (1.0 - slope.dot(view.ray(x, y).truncate()));
        cloud.shot.scene_depth(|x, y| Some(wall(x as usize, y as usize)));
        let pixels: Vec<_> = (0..16).map(|i| [22 + 13 * (i % 4), 11 + 13 * (i / 4)]).collect();
        let mut places: Vec<_> = pixels.iter().map(|[x, y]| [x % 4, y % 4]).collect();
        places.sort_unstable();
        places.dedup();
        assert_eq!(places.len(), 16);
        let mut radii = Vec::new();
        let points: Vec<_> = pixels
            .iter()
            .map(|&[x, y]| {
                let wall = wall(x, y);
                let world = radius * view.c_y() * wall;
                radii.push(world as f32);
                // A sphere drawn smaller than three quarters of a pixel is widened to that. Its
                // front is a twentieth of the radius before the wall.
                let before = (1.0 - offset.length_squared() / radius.max(0.75).powi(2)).sqrt();
                let ray = view.ray_at(DVec2::new(x as f64, y as f64) + 0.5 + offset);
                let depth = wall + (before - 0.05) * world;
                [ray.x * depth, ray.y * depth, depth].map(|v| v as f32)
            })
            .collect();
        cloud.positions = scenes::world(&cloud.shot.camera, &points);
        (cloud.kinds, cloud.ages) = (vec![0; 16], vec![0.0; 16]);
        (cloud.radii, cloud.ids) = (Some(radii), Some(vec![0; 16]));
        let normal = view.view.inverse().transform_vector3(slope.extend(1.0).normalize());
        Self { cloud, pixels, normal }
    }

    fn draw(&self, rig: &mut Rig<'_>) -> DrawnWhitewater {
        self.cloud.draw(rig).whitewater.expect("whitewater particles")
    }

    /// Calls a function for each particle's pixel.
    fn each(&self, mut act: impl FnMut(usize, usize)) {
        self.pixels.iter().for_each(|&[x, y]| act(x, y));
    }
}

fn rig<'a>(gpu: &'a Gpu, irradiance: Irradiance) -> Rig<'a> {
    let whitewater = WhitewaterConfig::new(4096).with(|it| it.irradiance = irradiance);
    Rig::lit(gpu, &whitewater_config(SIZE).with(|it| it.whitewater = Some(whitewater)), 1)
}

/// Radii in pixels, slopes of the wall, and offsets along a diagonal of the pixel. On a sloped wall
/// the offsets are halved so that foam covers only its own pixel: in others it would be many radii
/// before the wall.
fn cases() -> impl Iterator<Item = (f64, DVec2, DVec2)> {
    let slopes = [DVec2::ZERO, DVec2::new(0.8, 0.0), DVec2::new(-0.3, 0.6)];
    let offsets = (0..5).map(|i| 0.23 * DVec2::new(f64::from(i) - 2.0, 2.0 - 0.8 * f64::from(i)));
    let offsets: Vec<_> = offsets.collect();
    [0.02, 0.1, 0.5].into_iter().flat_map(move |radius| {
        let offsets = offsets.clone();
        slopes.into_iter().flat_map(move |slope| {
            let part = if slope == DVec2::ZERO { 1.0 } else { 0.5 };
            offsets.clone().into_iter().map(move |offset| (radius, slope, part * offset))
        })
    })
}

/// Half of each sphere lies behind the wall.
#[test]
fn lone_foam_on_a_wall_is_half_hidden() {
    let gpu = Gpu::shared();
    let mut rig = rig(&gpu, Irradiance::Prefiltered);
    let mut settings = scenes::settings(0.2);
    let look = &mut settings.whitewater;
    // The settings give the occluded fraction unchanged, from any distance; foam itself occludes
    // nothing.
    (
        look.reach,
        [look.shadow_scale, look.shadow_exponent, look.shadow_offset],
        look.half_intensity_thickness,
    ) = (OcclusionReach::Metres(1.0e9), [1.0, 1.0, 0.0], 1.0e6);
    let mut wrong = Vec::new();
    for (radius, slope, offset) in cases() {
        let lone = Lone::new(settings.clone(), radius, slope, offset);
        let foam = lone.draw(&mut rig);
        lone.each(|x, y| {
            assert!(foam.occluders.at(x, y)[0] < 1.0e9, "foam in ({x}, {y})");
            let share = foam.light.at(x, y)[3];
            if (share - 0.5).abs() > 0.05 {
                wrong.push(format!("{radius} {slope} {offset} ({x}, {y}): {share}"));
            }
        });
    }
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

/// With the default look, the occlusion is what a thousand samples find in the picture, in any
/// pixel: on a wall that faces the eye 25/84 (`a_flat_sheet_hides_half`). Foam smaller than a pixel
/// has the normal of that wall.
#[test]
fn lone_foam_is_as_dark_wherever_it_moves() {
    let gpu = Gpu::shared();
    let mut rig = rig(&gpu, Irradiance::Prefiltered);
    let mut settings = scenes::settings(0.2);
    settings.whitewater.half_intensity_thickness = 1.0e6;
    let all = twin::points(1001);
    let (mut wrong, mut widest) = (Vec::new(), 0.0_f64);
    for (radius, slope, offset) in cases() {
        let lone = Lone::new(settings.clone(), radius, slope, offset);
        let foam = lone.draw(&mut rig);
        let of = |i| doubles(&channel(&foam.occluders, i));
        let (front, opacity, fluid, solid) = (seen(&foam), of(1), of(2), of(3));
        let layers = Layers { front: &front, opacity: &opacity, fluid: &fluid, solid: &solid };
        let by = Occlusion { counts: [1000.0; 2], ..lone.cloud.occlusion() };
        let view = lone.cloud.shot.view(SIZE);
        lone.each(|x, y| {
            // Inverts the shadow's formula, which gives the occluded fraction.
            let share = (f64::from(foam.light.at(x, y)[3]) + 0.05).powf(1.0 / 1.5);
            let expected = by.omega(&layers, &view, &all, (x, y)).expect("foam").value;
            if slope == DVec2::ZERO && offset.length() < 0.1 {
                assert!((expected - 25.0 / 84.0).abs() < 0.02, "{radius}: {expected}");
            }
            // On a slope the occlusion is a mean of about thirty sample pairs, each between 0 and
            // 1/2 with a deviation of 0.15: two and a half standard errors.
            let allowed = if slope == DVec2::ZERO { 0.05 } else { 2.5 * 0.15 / 30.0_f64.sqrt() };
            if (share - expected).abs() > allowed {
                wrong.push(format!("{radius} {slope} {offset} ({x}, {y}): {share} of {expected}"));
            }
            // Within a single pixel no slope is visible.
            let [nx, ny, nz, _] = foam.normal.at(x, y).map(f64::from);
            let off = DVec3::new(nx, ny, nz).angle_between(lone.normal);
            widest = widest.max(if slope == DVec2::ZERO { off } else { 0.0 });
        });
    }
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
    assert!(widest < 0.5, "normals {widest} from the wall's");
}

/// In a uniform environment foam gets half of the light, even with few sampled directions and
/// without search spheres.
#[test]
fn lone_foam_gets_half_of_an_even_light() {
    let gpu = Gpu::shared();
    let mut rig = rig(&gpu, Irradiance::Sampled);
    let mut settings = scenes::settings(0.2);
    for passes in [0, 1, 3] {
        settings.whitewater.passes = passes;
        let mut lone = Lone::new(settings.clone(), 0.1, DVec2::ZERO, DVec2::ZERO);
        even(&mut rig, &mut lone.cloud.shot, [1.0; 4]);
        let foam = lone.draw(&mut rig);
        lone.each(|x, y| {
            let light = foam.light.at(x, y)[0];
            // Half precision: the environment, the image and its two blurs.
            assert!((light - 0.5).abs() < 4.0 / 1024.0, "{passes} passes, ({x}, {y}): {light}");
        });
    }
}
