//! The stand-in scene's sea: visible but absent from the depth, with the light of closed forms, and
//! moved by time alone.

use std::f32::consts::PI;

use ash::vk;
use glam::Mat4;
use whitewater::headless::scene::{Liquid, Material, Mesh, Scene, Sea, SunLight};
use whitewater::headless::{Background, Headless};
use whitewater::{Camera, Error, Settings};

use crate::support::device::Gpu;
use crate::support::rig::{config, extent, finish, headless};
use crate::support::scenes::{Lens, projection};

const SIZE: vk::Extent2D = vk::Extent2D { width: 32, height: 24 };

/// Colour and depth of a picture.
type Shot = (Vec<[f32; 4]>, Vec<f32>);

fn camera(eye: [f32; 3], target: [f32; 3], up: [f32; 3], lens: Lens) -> Camera {
    Camera::of(Mat4::look_at_rh(eye.into(), target.into(), up.into()), projection(lens, SIZE))
}

/// A camera 10 m above the origin that looks straight down.
fn from_above() -> Camera {
    camera([0.0, 10.0, 0.0], [0.0; 3], [0.0, 0.0, -1.0], Lens::ReversedInfinite)
}

/// A camera that looks at the horizon.
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

/// A floor two metres under the water level, with a box that rises above the level.
fn stage(sea: Option<Sea>) -> Scene {
    let floor = Mesh::plane([0.0, -2.0, 0.0], [30.0, 30.0], Material::named("island").unwrap());
    let stone = Material::named("rock").unwrap();
    let stone = Mesh::cuboid([0.5, -0.5, 0.0], [1.0, 2.0, 1.0], [0.0, 0.0, 0.0, 1.0], stone);
    Scene { meshes: vec![floor, stone], sea, ..Scene::default() }
}

fn lava() -> Sea {
    Sea { liquid: Liquid::LAVA, length: 1.5, ..Sea::default() }
}

/// Radiance from all directions.
const AROUND: f32 = 0.5;

fn under_a_grey_sky(headless: &mut Headless) {
    let grey = [AROUND, AROUND, AROUND, 1.0];
    headless.equirectangular(extent(8, 4), &[grey; 32], 1.0, 0.0).expect("environment");
}

/// Reflectance from air to water, for an angle of incidence with this cosine.
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

/// Straight down through a flat sea, over a floor or deep water: transmission by Beer, reflection
/// by Fresnel, floor by Lambert.
#[test]
fn water_absorbs_and_scatters_as_a_closed_form_says() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let (albedo, sun, height) = (0.5, [2.0, 1.6, 1.0], 0.8_f32);
    let sea = Sea { waves: 0.0, ..Sea::default() };
    let matt = Material { base_color: [albedo; 3], roughness: 1.0, ..Material::default() };
    let floor = |x: f32, y: f32| Mesh::plane([x, y, 0.0], [40.0, 40.0], matt.clone());
    // The last floor lies far aside, where the camera does not see it.
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
        // Path length of sunlight in water per metre of depth.
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

/// Variance of the slopes of 28 waves, whose steepness falls by 0.93 from each to the next shorter
/// one; still shorter waves add a fifth.
fn variance_of_slopes(sea: &Sea) -> f64 {
    let steepest = f64::from(PI * sea.waves / sea.length);
    let each = (0..28).map(|i| 0.5 * (steepest * 0.93_f64.powi(i)).powi(2));
    1.2 * each.sum::<f64>()
}

/// Height of the mean reflected direction and mean reflectance of a rough sea, seen at an elevation
/// with this sine. `variance` is that of the slopes along one direction. Facets are weighted by the
/// area that the eye sees.
fn mirrored_by(sine: f64, variance: f64) -> (f64, f64) {
    let (deviation, tangent) = (variance.sqrt(), sine / (1.0 - sine * sine).sqrt());
    let (mut sum, mut all) = (0.0, 0.0);
    for i in -4000..=4000 {
        let slope = 5.0 * deviation * f64::from(i) / 4000.0;
        let seen = (tangent + slope).max(0.0) * (-0.5 * (slope / deviation).powi(2)).exp();
        sum += slope * seen;
        all += seen;
    }
    // The mean normal is tilted towards the eye; the ray is mirrored at it.
    let tilt = (sum / all).atan();
    let up = (2.0 * tilt + sine.asin()).sin();
    let grazing = (1.0 - sine).powf(5.0 * (-2.69 * deviation).exp());
    let mirrored = 0.02037 + (1.0 - 0.02037) * grazing / (1.0 + 22.7 * deviation.powf(1.5));
    (up, mirrored)
}

/// A black sea, too far away for single waves, mirrors a sky that is brighter higher up, by the
/// facets that are visible. Haze hides it by Beer's law, and at the horizon it has the colour of
/// the sky.
#[test]
fn a_rough_sea_mirrors_the_sky_and_melts_into_it() {
    // With texels of a third of a degree, which do not blur the horizon.
    let fine = config(SIZE).with(|it| it.environment_size = 256);
    let mut headless = Headless::new(Gpu::own().take_device(), &fine).expect("headless");
    // Radiance 0.2 + 0.6 y, and 0.2 below the horizon.
    let (width, height) = (256, 128);
    let sky: Vec<[f32; 4]> = (0..width * height)
        .map(|i| {
            let up = (PI * ((i / width) as f32 + 0.5) / height as f32).cos();
            let c = 0.2 + 0.6 * up.max(0.0);
            [c, c, c, 1.0]
        })
        .collect();
    headless.equirectangular(extent(width, height), &sky, 1.0, 0.0).expect("environment");
    // A mesh far aside makes the scene so large that the default haze is negligible.
    let aside = Mesh::plane([4.0e6, -1.0, 0.0], [1.0e6, 1.0e6], Material::default());
    // The longest waves are so short that a pixel contains many, and gusts average out.
    let sea = Sea {
        absorption: [1.0e3; 3],
        scattering: [0.0; 3],
        waves: 0.001,
        length: 0.05,
        ..Sea::default()
    };
    let variance = 0.5 * variance_of_slopes(&sea);
    assert!((0.008..0.02).contains(&variance), "as of a breeze: {variance}");
    let clear = Scene {
        meshes: vec![aside],
        sun: SunLight { direction: [0.0, 1.0, 0.0], color: [0.0; 3] },
        sea: Some(sea),
        ..Scene::default()
    };
    let eye = 40.0_f32;
    let level = camera([0.0, eye, 0.0], [0.0, eye, -1.0], [0.0, 1.0, 0.0], Lens::ReversedInfinite);
    let (far, _) = shot(&mut headless, &clear, &level, false);
    let length = 900.0;
    let hazy = Scene { haze: Some(length), ..clear };
    let (hazed, _) = shot(&mut headless, &hazy, &level, false);
    // With dense haze only the colour of the air is seen.
    let (air, _) = shot(&mut headless, &Scene { haze: Some(0.1), ..hazy }, &level, false);
    let to_world = (level.projection_matrix() * level.view_matrix()).inverse();
    for y in SIZE.height / 2..SIZE.height {
        let x = SIZE.width / 2;
        let ndc = |at: u32, size: u32| 2.0 * (at as f32 + 0.5) / size as f32 - 1.0;
        let near =
            to_world.project_point3(glam::vec3(ndc(x, SIZE.width), ndc(y, SIZE.height), 0.5));
        let ray = (near - glam::Vec3::Y * eye).normalize();
        let (up, mirrored) = mirrored_by(f64::from(-ray.y), variance);
        let expected = mirrored * (0.2 + 0.6 * up);
        let i = (y * SIZE.width + x) as usize;
        let found = f64::from(far[i][1]);
        // The sky has texels of 1.4 degrees, and the environment has mip levels; Page's fit of the normal
        // distribution errs by 2e-4.
        assert!((found / expected - 1.0).abs() < 0.03, "row {y}: {found}, not {expected}");
        // The fraction left through the haze, for each channel.
        let away = eye / -ray.y * (1.0 - ray.y * ray.y).sqrt();
        for (c, rate) in [0.80, 1.0, 1.39].into_iter().enumerate() {
            let kept = (-rate * away / length).exp();
            let expected = air[i][c] + kept * (far[i][c] - air[i][c]);
            // Three values below 1 in half precision.
            let (hazed, most) = (hazed[i][c], 3.0 * 2.0_f32.powi(-12));
            assert!((hazed - expected).abs() < most, "row {y}: {hazed}, not {expected}");
        }
    }
    // At the horizon the air has the colour of the sky there, at a sine of 0.02. The sky in the next
    // row, half a pixel above the horizon, is nearly the same.
    let i = (SIZE.height / 2 * SIZE.width + SIZE.width / 2) as usize;
    let half_pixel = (PI / 6.0).tan() / SIZE.height as f32;
    for (found, up) in [(air[i][1], 0.02), (air[i - SIZE.width as usize][1], half_pixel)] {
        let expected = 0.2 + 0.6 * up;
        // The sky's texels of 1.4 degrees, a sine of 0.025, are interpolated over its kink at 0.
        assert!((found - expected).abs() < 0.6 * 0.025 / 4.0, "{found} {expected}");
    }
    finish(headless);
}

/// Pixels that do not look through the sea's surface are as without a sea: a wall above the sea
/// that fills the picture, and an eye under water.
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
            // Two pipelines may round differently; the glow of lava is far below the wall.
            for (dry, wet) in dry.iter().flatten().zip(wet.iter().flatten()) {
                assert!((dry - wet).abs() <= 1.0e-3 * dry.max(0.1), "{dry} {wet}");
            }
        }
    }
    finish(headless);
}

/// Without other light, lava and what it lights are as bright as its radiance in each channel. Red
/// glows in more places than green, and green in more than blue.
#[test]
fn lava_glows_by_its_radiance() {
    let mut headless = headless(SIZE);
    headless.equirectangular(extent(8, 4), &[[0.0, 0.0, 0.0, 1.0]; 32], 1.0, 0.0).expect("a map");
    let mut glow = |radiance: [f32; 3]| {
        let liquid = Liquid::Lava { radiance, speed: 0.1 };
        let sun = SunLight { direction: [0.0, 1.0, 0.0], color: [0.0; 3] };
        let scene = Scene { sun, ..stage(Some(Sea { liquid, ..lava() })) };
        shot(&mut headless, &scene, &level(), false).0
    };
    let [red, other, white] = [[4.0, 0.0, 0.0], [0.0, 1.0, 4.0], [4.0, 4.0, 4.0]].map(&mut glow);
    let mut brighter = [0; 2];
    for ((red, other), white) in red.iter().zip(&other).zip(&white) {
        assert_eq!([red[1], red[2], other[0]], [0.0; 3]);
        // A quarter scales exactly, but for numbers below the least normal one of half precision.
        let sums = [red[0], 4.0 * other[1], other[2]];
        let near = sums.iter().zip(white).all(|(sum, white)| (sum - white).abs() < 4.0e-7);
        assert!(near, "{red:?}, {other:?}, {white:?}");
        brighter[0] += usize::from(white[0] > white[1] + 0.01);
        brighter[1] += usize::from(white[1] > white[2] + 0.01);
        assert!(white[0] >= white[1] && white[1] >= white[2], "{white:?}");
    }
    println!("{brighter:?}");
    assert!(brighter.iter().all(|n| *n > 60), "{brighter:?}");
    finish(headless);
}

/// Lava flows where the sea says, with its speed: from a camera that moves alike it looks the same.
#[test]
fn lava_flows_with_its_speed() {
    let mut headless = headless(SIZE);
    let liquid = Liquid::Lava { radiance: [4.0; 3], speed: 0.5 };
    let sea = Sea { liquid, towards: [-1.2, 1.6], ..lava() };
    let aside = Mesh::plane([900.0, -1.0, 0.0], [1.0, 1.0], Material::default());
    let mut at = |time: f64, eye: [f32; 2]| {
        let sea = Some(sea.clone());
        let scene = Scene { time, sea, meshes: vec![aside.clone()], ..Scene::default() };
        let [x, z] = eye;
        let above = camera([x, 10.0, z], [x, 0.0, z], [0.0, 0.0, -1.0], Lens::ReversedInfinite);
        shot(&mut headless, &scene, &above, false).0
    };
    let first = at(0.0, [0.0, 0.0]);
    // In two seconds it goes one metre.
    let [along, still] = [[-0.6, 0.8], [0.0, 0.0]].map(|eye| at(2.0, eye));
    let (moved, off) = (apart(&first, &still), apart(&first, &along));
    println!("{moved} from the same place, {off} from one that moves alike");
    assert!(moved > 0.1 && off < 0.01 * moved, "{moved}, {off}");
    finish(headless);
}

/// Mean difference of two pictures in red.
fn apart(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs()).sum::<f32>() / a.len() as f32
}

/// Lava with a period looks the same a period later, and not in between. It moves on without a jump
/// where one period ends and the next begins.
#[test]
fn lava_repeats_after_its_period() {
    let mut headless = headless(SIZE);
    let sea = Sea { period: Some(4.0), ..lava() };
    let mut at = |time: f64| {
        shot(&mut headless, &Scene { time, ..stage(Some(sea.clone())) }, &from_above(), false).0
    };
    let [first, between, later] = [1.0, 3.0, 5.0].map(&mut at);
    assert_eq!(first, later, "a period later");
    let [ends, begins] = [4.0 - 1.0e-3, 4.0 + 1.0e-3].map(&mut at);
    let (moved, jump) = (apart(&first, &between), apart(&ends, &begins));
    println!("{moved} in half a period, {jump} at its end");
    // The end takes a thousandth of that time.
    assert!(moved > 0.01 && jump < 0.01 * moved, "{moved}, {jump}");
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
