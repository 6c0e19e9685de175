//! The stand-in scene's backdrop is drawn, lit and hazed, and does not enlarge the bounds that
//! shadows, ground and bake use.

use ash::vk;
use glam::{Mat4, Vec3};
use whitewater::headless::scene::{Ground, Material, Mesh, Motion, Pattern, Scene, SunLight};
use whitewater::headless::{Background, Headless};
use whitewater::{Camera, Error, Settings};

use crate::support::rig::{extent, finish, headless};
use crate::support::scenes::{Lens, projection};

const SIZE: vk::Extent2D = vk::Extent2D { width: 48, height: 32 };

/// Colour and depth of a picture.
type Shot = (Vec<[f32; 4]>, Vec<f32>);

fn camera(eye: Vec3, target: Vec3) -> Camera {
    Camera::of(Mat4::look_at_rh(eye, target, Vec3::Y), projection(Lens::ReversedInfinite, SIZE))
}

fn shot(headless: &mut Headless, scene: &Scene, camera: &Camera) -> Shot {
    headless.scene(scene, false).expect("scene");
    headless.particles(&[], None).expect("no particles");
    headless.render(camera, &Settings::default(), &Background::Scene).expect("a frame");
    let color = headless.color().expect("read back").data;
    (color, headless.scene_depth().expect("read back").data)
}

fn matt() -> Material {
    Material { base_color: [0.5; 3], roughness: 1.0, ..Material::default() }
}

/// Radiance from all directions.
const AROUND: f32 = 0.5;

fn under_a_grey_sky(headless: &mut Headless) {
    let grey = [AROUND, AROUND, AROUND, 1.0];
    headless.equirectangular(extent(8, 4), &[grey; 32], 1.0, 0.0).expect("environment");
}

/// A box on the ground, with a wall far behind it.
fn stage(backdrop: bool) -> Scene {
    let turn = [0.0, 0.0, 0.0, 1.0];
    let stone = Mesh::cuboid([0.0, 0.5, 0.0], [0.5; 3], turn, matt());
    let wall = Mesh::cuboid([0.0, 2.0, -12.0], [30.0, 2.0, 0.5], turn, matt());
    Scene {
        meshes: vec![stone],
        ground: Some(Ground { y: 0.0, material: matt(), reach: None }),
        sun: SunLight { direction: [0.3, 0.8, 0.5], color: [2.0, 1.8, 1.5] },
        backdrop: if backdrop { vec![wall] } else { Vec::new() },
        ..Scene::default()
    }
}

/// Pixels that the backdrop does not cover are the same to the bit.
#[test]
fn a_backdrop_is_seen_and_changes_nothing_else() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let camera = camera(Vec3::new(0.0, 1.5, 5.0), Vec3::new(0.0, 0.8, 0.0));
    let (alone, depths) = shot(&mut headless, &stage(false), &camera);
    let (with, nearer) = shot(&mut headless, &stage(true), &camera);
    assert_eq!(stage(false).bounds(), stage(true).bounds());
    let mut covered = 0;
    for ((a, b), (far, near)) in alone.iter().zip(&with).zip(depths.iter().zip(&nearer)) {
        // Depth is reversed: nearer means larger.
        assert!(near >= far);
        if near == far {
            assert_eq!(a, b);
        } else {
            covered += 1;
        }
    }
    let all = alone.len();
    assert!((all / 12..all / 2).contains(&covered), "{covered} of {all}");
    finish(headless);
}

/// Beer's law: over one length of haze, 1/e of the contrast with the horizon is left.
#[test]
fn haze_takes_the_contrast_of_the_backdrop() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let eye = Vec3::new(0.0, 2.0, 5.0);
    let camera = camera(eye, Vec3::new(0.0, 2.0, 0.0));
    let (clear, _) = shot(&mut headless, &stage(true), &camera);
    let length = 9.0;
    let (hazy, _) = shot(&mut headless, &Scene { haze: Some(length), ..stage(true) }, &camera);
    let middle = (SIZE.height / 2 * SIZE.width + SIZE.width / 2) as usize;
    // Distance from the eye to the wall's face; the pixel's centre is half a pixel off the axis.
    let kept = (-(16.5_f32) / length).exp();
    for c in 0..3 {
        let (clear, hazy) = (clear[middle][c] - AROUND, hazy[middle][c] - AROUND);
        assert!(clear.abs() > 0.05, "no contrast to lose: {clear}");
        // Values of about 1 in half precision.
        assert!((hazy - kept * clear).abs() < 2.0_f32.powi(-10), "{hazy}, not {kept} of {clear}");
    }
    // Haze does not cover the meshes.
    let clip =
        camera.projection_matrix() * camera.view_matrix() * Vec3::new(0.1, 0.6, 0.5).extend(1.0);
    let [x, y] = [(clip.x, SIZE.width), (clip.y, SIZE.height)]
        .map(|(at, size)| ((0.5 * at / clip.w + 0.5) * size as f32) as usize);
    let stone = y * SIZE.width as usize + x;
    assert_eq!(clear[stone], hazy[stone]);
    for haze in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let scene = Scene { haze: Some(haze), ..stage(true) };
        assert!(matches!(headless.scene(&scene, false), Err(Error::BadInput { .. })), "{haze}");
    }
    finish(headless);
}

/// Thin clouds brighten the sky at the horizon more than higher up, and brighten the ground. Values
/// outside 0 to 1 are errors.
#[test]
fn clouds_brighten_the_sky_and_the_ground() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let camera = camera(Vec3::new(0.0, 1.5, 5.0), Vec3::new(0.0, 2.5, 0.0));
    // The band of clouds is brighter than the sky only with a strong sun.
    let sun = SunLight { color: [8.0; 3], ..stage(true).sun };
    let (_, depths) = shot(&mut headless, &stage(true), &camera);
    let mut of = |clouds: f32| {
        let scene = Scene { clouds, sun, ..stage(true) };
        shot(&mut headless, &scene, &camera).0
    };
    let [clear, some, all] = [of(0.0), of(0.5), of(1.0)];
    let row = |picture: &[[f32; 4]], y: u32| -> f32 {
        let pixels = (0..SIZE.width).map(|x| (y * SIZE.width + x) as usize);
        pixels.filter(|i| depths[*i] == 0.0).map(|i| picture[i][1]).sum()
    };
    let skies: Vec<u32> = (0..SIZE.height).filter(|y| row(&clear, *y) > 0.0).collect();
    let [top, low] = [skies[0], skies[skies.len() - 1]];
    let [none, half, full] = [&clear, &some, &all].map(|picture| row(picture, low));
    assert!(none < half && half < full, "{none} {half} {full}");
    let gain = |y: u32| row(&all, y) / row(&clear, y);
    assert!(gain(low) > gain(top), "{} {}", gain(low), gain(top));
    let ground = (SIZE.height * SIZE.width - 1) as usize;
    assert!(all[ground][1] > clear[ground][1]);
    for clouds in [-0.1, 1.1, f32::NAN] {
        let scene = Scene { clouds, ..stage(true) };
        assert!(matches!(headless.scene(&scene, false), Err(Error::BadInput { .. })), "{clouds}");
    }
    finish(headless);
}

/// Fraction of a disc on one side of a line at a distance of `x` radii from its centre.
fn beyond(x: f32) -> f32 {
    let x = x.clamp(-1.0, 1.0);
    0.5 + (x * (1.0 - x * x).sqrt() + x.asin()) / std::f32::consts::PI
}

/// Behind thin clouds, half of the sunlight comes from a glow around the sun, so the shadow's
/// penumbra widens with the distance from the occluder.
#[test]
fn shadows_soften_with_the_distance_behind_clouds() {
    let mut headless = headless(SIZE);
    // A black sky leaves only sunlight and the light that clouds scatter, which a plate over the
    // floor partly hides.
    headless.equirectangular(extent(8, 4), &[[0.0, 0.0, 0.0, 1.0]; 32], 1.0, 0.0).expect("dark");
    let sun = SunLight { direction: [0.0, 1.0, 0.0], color: [3.0; 3] };
    let sheet = |at: [f32; 3], half: [f32; 2]| Mesh::plane(at, half, matt());
    let mut profile = |clouds: f32, high: f32, offset: f32| {
        let meshes = vec![
            sheet([0.0; 3], [3.0, 3.0]),
            // The plate's edge lies along z at x = 0.
            sheet([-1.5, high, 0.0], [1.5, 3.0]),
        ];
        let scene = Scene { meshes, sun, clouds, ..Scene::default() };
        let from = |x: f32| camera(Vec3::new(x + 0.5, 0.3, 0.0), Vec3::new(x, 0.0, 0.0));
        // The pixel's centre is half a pixel off the axis; this finds its point on the floor.
        let at = |middle: u32, size: u32| 2.0 * (middle as f32 + 0.5) / size as f32 - 1.0;
        let [x, y] = [SIZE.width, SIZE.height].map(|size| at(size / 2, size));
        let world = (from(0.0).projection_matrix() * from(0.0).view_matrix()).inverse();
        let [near, far] = [0.9, 0.1].map(|depth| world.project_point3(Vec3::new(x, y, depth)));
        let hit = near + (far - near) * (near.y / (near.y - far.y));
        let (picture, _) = shot(&mut headless, &scene, &from(offset - hit.x));
        picture[(SIZE.height / 2 * SIZE.width + SIZE.width / 2) as usize][0]
    };
    for high in [0.4_f32, 0.7] {
        let radius = 0.0436 * high;
        // With the sun's disc alone the penumbra is as narrow as the map's filter, whose texels are
        // 3 mm.
        let [dark, lit] = [-0.6, 0.6].map(|x| profile(0.0, high, x * radius));
        assert!(dark < 0.01 * lit, "{dark} {lit}");
        let [dark, lit] = [-1.3, 1.3].map(|x| profile(1.0, high, x * radius));
        for x in [-0.6_f32, 0.6] {
            let found = (profile(1.0, high, x * radius) - dark) / (lit - dark);
            let core = if x > 0.0 { 0.5 } else { 0.0 };
            let expected = core + 0.5 * beyond(x);
            // Half of the light has sixteen samples. The map filters over one texel, and a radius
            // is five texels.
            let most = 0.5 / 16.0 + 0.5 * 0.5 / 5.0 * 2.0 / std::f32::consts::PI;
            assert!((found - expected).abs() < most, "{high} {x}: {found} {expected}");
        }
    }
    finish(headless);
}

/// Paving around splashing water is damp in patches, no darker than stone under a film of water,
/// and dry farther away.
#[test]
fn splashed_paving_is_damp_near_by_and_dry_beyond() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let paving = Material { pattern: Pattern::Paving { size: 0.4 }, ..matt() };
    let mut seen = |splashed: Option<[[f32; 2]; 2]>, x: f32| {
        let mesh = Mesh::plane([0.0; 3], [9.0, 9.0], paving.clone());
        let scene = Scene { meshes: vec![mesh], splashed, ..Scene::default() };
        let down = camera(Vec3::new(x, 1.5, 0.01), Vec3::new(x, 0.0, 0.0));
        shot(&mut headless, &scene, &down).0
    };
    let basin = Some([[-1.0, -1.0], [1.0, 1.0]]);
    let mean = |picture: &[[f32; 4]]| picture.iter().map(|c| c[1]).sum::<f32>();
    let (dry, damp) = (seen(None, 1.4), seen(basin, 1.4));
    let share = mean(&damp) / mean(&dry);
    // With a film of water, an albedo of 0.5 becomes 0.49 / (1 - 0.235) of itself; lower albedos
    // become less.
    assert!((0.5..0.97).contains(&share), "{share}");
    assert!(dry.iter().zip(&damp).any(|(a, b)| a == b), "not everywhere");
    // More than three metres away, plus half of the picture.
    assert_eq!(seen(None, 6.0), seen(basin, 6.0));
    let scene = Scene { splashed: Some([[0.0, f32::NAN], [1.0, 1.0]]), ..Scene::default() };
    let error = headless.scene(&scene, false).expect_err("no place");
    assert!(matches!(error, Error::BadInput { field: "Scene.splashed", .. }), "{error}");
    finish(headless);
}

/// A roof of the backdrop shades the backdrop and nothing else.
#[test]
fn a_backdrop_shades_itself_alone() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let down = camera(Vec3::new(0.0, 3.0, 0.01), Vec3::ZERO);
    let sheet = |y: f32, half: f32| Mesh::plane([0.0, y, 0.0], [half, half], matt());
    let sun = SunLight { direction: [0.0, 1.0, 0.0], color: [3.0; 3] };
    let roof = sheet(5.0, 40.0);
    let middle = (SIZE.height / 2 * SIZE.width + SIZE.width / 2) as usize;
    let mut light = |meshes: &[Mesh], backdrop: &[Mesh]| {
        let (meshes, backdrop) = (meshes.to_vec(), backdrop.to_vec());
        let scene = Scene { meshes, backdrop, sun, ..Scene::default() };
        shot(&mut headless, &scene, &down).0[middle][0]
    };
    // A pole extends the scene's bounds so that the shadow map reaches the roof.
    let pole = Mesh::cuboid([3.5, 3.0, 3.5], [0.1, 3.0, 0.1], [0.0, 0.0, 0.0, 1.0], matt());
    let floor = [sheet(0.0, 4.0), pole];
    let lit = light(&floor, &[]);
    let below = light(&floor, std::slice::from_ref(&roof));
    // A backdrop hides the sky below the horizon only, which a level sheet does not see.
    assert!((below - lit).abs() < 0.02 * lit, "a mesh: {below}, {lit}");
    let lit = light(&[], &[sheet(0.0, 4.0)]);
    let below = light(&[], &[sheet(0.0, 4.0), roof]);
    // Lambert's law without sun and sky: what is left is light that the roof reflects.
    let sun = 0.5 * 3.0 / std::f32::consts::PI;
    assert!(lit > sun && below < 0.4 * lit, "a backdrop: {below}, {lit}");
    finish(headless);
}

/// Procedural patterns scale with `Scene::metre`: a scene four times as large, with its metre,
/// looks the same.
#[test]
fn surfaces_go_by_the_metre() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let scene = |size: f32, metre: Option<f32>, pattern: Pattern| {
        let material = Material { pattern, ..matt() };
        // Tilted, because an island's ground depends on its height.
        let turn = glam::Quat::from_rotation_x(0.2).to_array();
        let half = [3.0, 0.1, 3.0].map(|half| half * size);
        let mesh = Mesh::cuboid([0.0; 3], half, turn, material);
        Scene { meshes: vec![mesh], metre, ..Scene::default() }
    };
    let eye = Vec3::new(0.3, 2.0, 1.5);
    let patterns = |size: f32| {
        [
            Pattern::Concrete,
            Pattern::Lawn { stripe: 0.5 * size },
            Pattern::Ripples { length: 0.2 * size },
            Pattern::Foliage,
            Pattern::Island { beach: 0.2 * size },
        ]
    };
    for (small, large) in patterns(1.0).into_iter().zip(patterns(4.0)) {
        let mut draw = |size: f32, metre, pattern| {
            let camera = camera(size * eye, Vec3::ZERO);
            shot(&mut headless, &scene(size, metre, pattern), &camera).0
        };
        let expected = draw(1.0, None, small);
        let (same, other) = (draw(4.0, Some(4.0), large), draw(4.0, None, large));
        let apart = |a: &[[f32; 4]], b: &[[f32; 4]]| {
            let differences = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs());
            differences.sum::<f32>() / a.len() as f32
        };
        // Four is a power of two, so everything except the sky's constants scales exactly.
        let [same, other] = [same, other].map(|shot| apart(&shot, &expected));
        assert!(same < 1.0e-3 && other > 5.0e-3, "{small:?}: {same}, {other}");
    }
    for metre in [0.0, f32::NAN] {
        let bad = headless.scene(&scene(1.0, Some(metre), Pattern::Plain), false);
        assert!(matches!(bad, Err(Error::BadInput { .. })), "{metre}");
    }
    finish(headless);
}

/// The pattern of a mesh that moves moves with it: seen from a camera that moves alike, it looks the
/// same. That of a mesh built at the other place does not.
#[test]
fn patterns_move_with_their_mesh() {
    let mut headless = headless(SIZE);
    under_a_grey_sky(&mut headless);
    let boards = Material { pattern: Pattern::Planks { width: 0.2 }, ..matt() };
    let door = |at: Vec3, pose: Mat4| {
        let at = (Vec3::new(0.5, 0.0, 0.0) + at).to_array();
        let mesh = Mesh::cuboid(at, [1.0, 1.0, 0.1], [0.0, 0.0, 0.0, 1.0], boards.clone());
        let motion = Motion { meshes: vec![0], first_frame: 0, poses: vec![pose] };
        Scene { meshes: vec![mesh], motions: vec![motion], ..Scene::default() }
    };
    let eye = Vec3::new(0.4, 0.3, 4.0);
    let mut seen = |built: Vec3, pose: Mat4| {
        let camera = Mat4::from_translation(built) * pose;
        let [eye, target, up] =
            [eye, Vec3::ZERO, eye + Vec3::Y].map(|p| camera.transform_point3(p));
        let view = Mat4::look_at_rh(eye, target, up - eye);
        let camera = Camera::of(view, projection(Lens::ReversedInfinite, SIZE));
        shot(&mut headless, &door(built, pose), &camera).0
    };
    let by = Vec3::new(0.33, 0.0, 0.07);
    let expected = seen(Vec3::ZERO, Mat4::IDENTITY);
    let shifted = seen(Vec3::ZERO, Mat4::from_translation(by));
    let turned = seen(Vec3::ZERO, Mat4::from_rotation_z(0.4));
    let built = seen(by, Mat4::IDENTITY);
    let apart = |a: &[[f32; 4]]| {
        let differences = a.iter().zip(&expected).map(|(a, b)| (a[0] - b[0]).abs());
        differences.fold(0.0, f32::max)
    };
    let most = [apart(&shifted), apart(&turned)];
    // The slope of the boards' edges is rounded.
    assert!(most.iter().all(|most| *most < 0.02), "{most:?}");
    let other = apart(&built);
    assert!(other > 0.1, "{other}: a pattern fixed to the world would not show");
    finish(headless);
}
