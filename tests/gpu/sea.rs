//! The stand-in scene's sea: seen and not there, of light that closed forms tell, moved by time alone.

use std::f32::consts::PI;

use ash::vk;
use glam::Mat4;
use whitewater::headless::scene::{Liquid, Material, Mesh, Scene, Sea, SunLight};
use whitewater::headless::{Background, Headless};
use whitewater::{Camera, Error, Settings};

use crate::support::rig::{extent, finish, headless};
use crate::support::scenes::{Lens, projection};

const SIZE: vk::Extent2D = vk::Extent2D { width: 32, height: 24 };

/// Colour and depth of a picture.
type Shot = (Vec<[f32; 4]>, Vec<f32>);

fn camera(eye: [f32; 3], target: [f32; 3], up: [f32; 3], lens: Lens) -> Camera {
    Camera::of(Mat4::look_at_rh(eye.into(), target.into(), up.into()), projection(lens, SIZE))
}

/// Down on what is below the origin from 10 over it.
fn from_above() -> Camera {
    camera([0.0, 10.0, 0.0], [0.0; 3], [0.0, 0.0, -1.0], Lens::ReversedInfinite)
}

/// A look at the horizon.
fn level() -> Camera {
    camera([0.0, 3.0, 12.0], [0.0, 0.5, 0.0], [0.0, 1.0, 0.0], Lens::ReversedInfinite)
}

fn draw(headless: &mut Headless, camera: &Camera) -> Shot {
    headless.particles(&[], None).expect("no particles");
    headless.render(camera, &Settings::default(), &Background::Scene).expect("a frame");
    let color = headless.color().expect("read back").data;
    (color, headless.scene_depth().expect("read back").data)
}

fn shot(headless: &mut Headless, scene: &Scene, camera: &Camera, antialias: bool) -> Shot {
    headless.scene(scene, antialias).expect("scene");
    draw(headless, camera)
}

/// A floor two metres under the level with a box that stands up through it.
fn stage(sea: Option<Sea>) -> Scene {
    let floor = Mesh::plane([0.0, -2.0, 0.0], [30.0, 30.0], Material::named("island").unwrap());
    let stone = Material::named("rock").unwrap();
    let stone = Mesh::cuboid([0.5, -0.5, 0.0], [1.0, 2.0, 1.0], [0.0, 0.0, 0.0, 1.0], stone);
    Scene { meshes: vec![floor, stone], sea, ..Scene::default() }
}

fn lava() -> Sea {
    Sea { liquid: Liquid::LAVA, length: 1.5, ..Sea::default() }
}

/// The same radiance from everywhere.
const AROUND: f32 = 0.5;

fn under_a_grey_sky(headless: &mut Headless) {
    let grey = [AROUND, AROUND, AROUND, 1.0];
    headless.equirectangular(extent(8, 4), &[grey; 32], 1.0, 0.0).expect("environment");
}

/// Of an angle of incidence with this cosine, from air to water.
fn fresnel(cosine: f32) -> f32 {
    0.02037 + (1.0 - 0.02037) * (1.0 - cosine).powi(5)
}

#[test]
fn a_sea_is_seen_and_not_there() {
    let mut headless = headless(SIZE);
    for camera in [from_above(), level()] {
        for antialias in [false, true] {
            let (dry, depth) = shot(&mut headless, &stage(None), &camera, antialias);
            for sea in [Sea::default(), lava()] {
                let (wet, same) = shot(&mut headless, &stage(Some(sea)), &camera, antialias);
                assert_eq!(depth, same, "depth");
                assert_ne!(dry, wet);
            }
        }
    }
    finish(headless);
}

/// Straight down through a mirror of a sea on a floor, or on none: what Beer, Fresnel and Lambert leave of the light.
#[test]
fn water_absorbs_and_scatters_as_a_closed_form_says() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let (albedo, sun, height) = (0.5, [2.0, 1.6, 1.0], 0.8_f32);
    let sea = Sea { waves: 0.0, ..Sea::default() };
    let matt = Material { base_color: [albedo; 3], roughness: 1.0, ..Material::default() };
    let floor = |x: f32, y: f32| Mesh::plane([x, y, 0.0], [40.0, 40.0], matt.clone());
    // The last one lies aside, where it is not seen.
    let far = (floor(200.0, 0.0), f32::INFINITY);
    for (floor, depth) in
        [(floor(0.0, -0.5), 0.5), (floor(0.0, -2.0), 2.0), (floor(0.0, -9.0), 9.0), far]
    {
        let scene = Scene {
            meshes: vec![floor],
            sun: SunLight { direction: [(1.0 - height * height).sqrt(), height, 0.0], color: sun },
            sea: Some(sea.clone()),
            ..Scene::default()
        };
        let (picture, _) = shot(&mut headless, &scene, &from_above(), false);
        let found = picture[picture.len() / 2 + SIZE.width as usize / 2];
        // Metres that the sun's light goes for one down.
        let slant = 1.0 / (1.0 - (1.0 - height * height) / 1.333_f32.powi(2)).sqrt();
        let sky = PI * AROUND;
        let mirrored = fresnel(1.0);
        for c in 0..3 {
            let (absorbed, scattered) = (sea.absorption[c], sea.scattering[c]);
            let lost = absorbed + scattered;
            let entering = sky + sun[c] * height * (1.0 - fresnel(height));
            let arrives = sun[c] * height * (1.0 - fresnel(height)) * (-lost * depth * slant).exp()
                + sky * (-lost * depth * 1.2).exp();
            let under = albedo / PI * arrives * (-lost * depth).exp();
            let rate = lost * (1.0 + slant);
            let haze =
                scattered * entering * slant / (4.0 * PI) * (1.0 - (-rate * depth).exp()) / rate;
            let expected = (1.0 - mirrored) * (under + haze) + mirrored * AROUND;
            assert!(
                (found[c] / expected - 1.0).abs() < 4.0e-3,
                "{depth} m, channel {c}: {} is not {expected}",
                found[c]
            );
        }
    }
    finish(headless);
}

/// A wall that stands over the sea and fills the picture, and an eye under water: as without a sea.
#[test]
fn what_is_not_seen_through_a_sea_is_as_it_was() {
    let mut headless = headless(SIZE);
    let plain = Material::default();
    let wall =
        Mesh::cuboid([0.0, 30.0, -2.0], [60.0, 29.0, 1.0], [0.0, 0.0, 0.0, 1.0], plain.clone());
    let floor = Mesh::plane([0.0, -8.0, 0.0], [60.0, 60.0], plain);
    let over = camera([0.0, 26.0, 1.0], [0.0, 26.0, 0.0], [0.0, 1.0, 0.0], Lens::Standard);
    let under = camera([0.0, -1.0, 9.0], [0.0, -3.0, 0.0], [0.0, 1.0, 0.0], Lens::Standard);
    for camera in [over, under] {
        for sea in [Sea::default(), lava()] {
            let scene =
                |sea| Scene { meshes: vec![wall.clone(), floor.clone()], sea, ..Scene::default() };
            let (dry, _) = shot(&mut headless, &scene(None), &camera, false);
            let (wet, _) = shot(&mut headless, &scene(Some(sea)), &camera, false);
            // Two pipelines may round otherwise; lava's glow is far below.
            for (dry, wet) in dry.iter().flatten().zip(wet.iter().flatten()) {
                assert!((dry - wet).abs() <= 1.0e-3 * dry.max(0.1), "{dry} {wet}");
            }
        }
    }
    finish(headless);
}

#[test]
fn time_moves_it_and_equal_times_give_equal_pictures() {
    let mut headless = headless(SIZE);
    for sea in [Sea::default(), lava()] {
        let scene = |time| Scene { time, ..stage(Some(sea.clone())) };
        let at = |headless: &mut Headless, time: f64, frame: u64| {
            let scene = Scene { frame, ..scene(time) };
            headless.scene_frame(&scene, false).expect("a frame of it");
            draw(headless, &level())
        };
        let first = shot(&mut headless, &scene(0.0), &level(), false);
        let later = at(&mut headless, 1.7, 51);
        assert_ne!(first.0, later.0, "the camera rests and the sea does not");
        assert_eq!(first.1, later.1, "depth");
        assert_eq!(at(&mut headless, 0.0, 0), first);
        assert_eq!(shot(&mut headless, &scene(1.7), &level(), false), later, "from anew");
        assert!(!scene(0.0).rests_between(0, 1) && scene(0.0).rests_between(3, 3));
    }
    let still = Sea { waves: 0.0, ..Sea::default() };
    assert!(stage(Some(still)).rests_between(0, 9));
    finish(headless);
}

#[test]
fn bad_values_are_named() {
    let mut headless = headless(SIZE);
    let sea = Sea::default;
    let lava = |radiance, speed| Sea { liquid: Liquid::Lava { radiance, speed }, ..sea() };
    for (sea, named) in [
        (Sea { level: f32::NAN, ..sea() }, "Scene.sea.level"),
        (Sea { absorption: [0.1, -0.1, 0.1], ..sea() }, "Scene.sea.absorption"),
        (Sea { scattering: [0.1, 0.1, f32::INFINITY], ..sea() }, "Scene.sea.scattering"),
        (Sea { waves: -1.0, ..sea() }, "Scene.sea.waves"),
        (Sea { length: 0.0, ..sea() }, "Scene.sea.length"),
        (Sea { towards: [0.0; 2], ..sea() }, "Scene.sea.towards"),
        (Sea { period: Some(0.0), ..sea() }, "Scene.sea.period"),
        (lava([f32::NAN; 3], 1.0), "Scene.sea.liquid.radiance"),
        (lava([1.0; 3], f32::NAN), "Scene.sea.liquid.speed"),
    ] {
        let error = headless.scene(&stage(Some(sea)), false).expect_err(named);
        assert!(
            matches!(error, Error::BadInput { field, .. } if field == named),
            "{named}: {error}"
        );
    }
    let never = Scene { time: f64::NAN, ..stage(Some(sea())) };
    let error = headless.scene(&never, false).expect_err("no time");
    assert!(matches!(error, Error::BadInput { field: "Scene.time", .. }), "{error}");
    headless.scene(&stage(Some(sea())), false).expect("a scene after all");
    finish(headless);
}
