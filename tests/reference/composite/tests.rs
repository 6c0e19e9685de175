//! Compares the composite's twin with closed forms.

use super::super::EMPTY;
use super::super::surface::Case;
use super::super::tests::{Depth, projection, view};
use super::*;
use glam::DMat4;

pub const PLAIN: Settings = Settings {
    radius: 0.5,
    falloff: 5.3,
    refraction: 0.25,
    medium: Medium::Physical {
        absorption: [0.5, 0.2, 0.0],
        scattering: [0.1, 0.0, 0.0],
        ambient: [2.0, 2.0, 2.0],
    },
    fresnel: Fresnel::Schlick { f0: 0.0 },
    specular: [0.0; 3],
    shininess: 80.0,
    sun_direction: DVec3::Z,
    sun_color: [1.0; 3],
    bed: None,
    mirror_steps: 0,
    exit: None,
};

/// A surface with this position and normal, this thickness of water, and the distance `room` to
/// the scene.
pub fn facing(position: DVec3, normal: DVec3, thickness: f64, room: f64) -> Surface {
    let parts = super::super::surface::Parts {
        case: super::super::surface::Case::Whole,
        smooth: [DVec2::ZERO; 2],
        sphere: [DVec2::ZERO; 2],
        full: thickness,
        drop: 0.0,
        borrowed: false,
        found: 1.0,
        mixed: 0.0,
        margin: f64::INFINITY,
    };
    let ripple = super::super::noise::Ripple::default();
    Surface {
        position,
        normal,
        thickness,
        room,
        slope: DVec2::ZERO,
        lens: thickness,
        ripple,
        parts,
    }
}

/// The images of one water surface before a scene at depth 50.
struct Scene {
    depth: Image<f64>,
    smoothed: Image<f64>,
    thickness: Image<f64>,
    color: Image<[f64; 4]>,
    scene: Image<f64>,
}

impl Scene {
    fn new(view: &View, level: u32, thickness: f64, z: impl Fn(DVec3) -> f64 + Sync) -> Self {
        let (w, h, reduced) = (view.width, view.height, view.reduced(level));
        let image = |view: &View| Image::from_fn(view.width, view.height, |x, y| z(view.ray(x, y)));
        Self {
            depth: image(view),
            smoothed: image(&reduced),
            thickness: Image::new(w, h, thickness),
            color: Image::from_fn(w, h, |x, y| [x as f64, y as f64, 1.0, 0.5]),
            scene: Image::new(w, h, 50.0),
        }
    }

    fn inputs(&self, level: u32) -> Inputs<'_> {
        Inputs {
            depth: &self.depth,
            smoothed: &self.smoothed,
            level,
            thickness: &self.thickness,
            thickness_level: 0,
            scene_color: &self.color,
            scene_depth: &self.scene,
            noise: None,
        }
    }
}

const BLACK: fn(DVec3) -> DVec3 = |_| DVec3::ZERO;

#[test]
fn the_normal_of_a_plane_is_its_own_at_every_level() {
    for focal in [DVec2::new(1.2, -1.5), DVec2::new(-1.2, 1.5)] {
        let view = view(focal, DVec2::new(0.2, -0.1), 163, 121);
        let n = DVec3::new(0.3, 0.5, 0.8).normalize();
        for level in 0..3 {
            let scene = Scene::new(&view, level, 1.0, |ray| -n.z * 20.0 / ray.dot(n));
            for (x, y) in [(81, 60), (30, 20), (140, 100)] {
                let found =
                    Surfaces::new(&scene.inputs(level), &PLAIN, &view).at(x, y).expect("water");
                assert!((found.normal - n).length() < 2e-3, "{found:?}");
                assert!((found.position - view.ray(x, y) * scene.depth.at(x, y)).length() < 5e-2);
            }
        }
    }
}

#[test]
fn borders_are_one_sided_and_islets_face_the_eye() {
    let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 64, 64);
    let n = DVec3::new(0.3, 0.0, 1.0).normalize();
    let mut scene = Scene::new(&view, 1, 1.0, |ray| -n.z * 20.0 / ray.dot(n));
    for (x, y) in (0..32).flat_map(|y| (16..32).map(move |x| (x, y))) {
        *scene.smoothed.at_mut(x, y) = if x < 20 { 40.0 } else { EMPTY };
    }
    let at = |x| Surfaces::new(&scene.inputs(1), &PLAIN, &view).at(x, 30).expect("water");
    assert!((at(31).normal - n).length() < 0.02, "{:?}", at(31));
    // Water without a smoothed surface near it.
    let islet = at(50);
    assert_eq!(-islet.position.z, scene.depth.at(50, 30));
    assert!((islet.normal - DVec3::Z).length() < 1e-12);
}

#[test]
fn light_is_absorbed_along_the_ray() {
    let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 33, 33);
    let scene = Scene::new(&view, 0, 2.0, |_| 10.0);
    let picture = shade(&scene.inputs(0), &PLAIN, BLACK, &view);
    for (x, y) in [(16, 16), (32, 0)] {
        let path = 2.0 * view.ray(x, y).length();
        let fresnel = 1.0 - (1.0 - 1.0 / view.ray(x, y).length()).powi(5);
        let t = (-0.6 * path).exp();
        let expected =
            [x as f64 * t + 2.0 * (0.1 / 0.6) * (1.0 - t), y as f64 * (-0.2 * path).exp(), 1.0];
        for (found, expected) in picture.at(x, y).iter().zip(expected) {
            assert!((found - expected * fresnel).abs() < 1e-9);
        }
        assert_eq!(picture.at(x, y)[3], 1.0);
    }
    let source = Medium::Source { base: [0.3, 0.5, 0.9], k: [0.4, 0.3, 0.2, 0.1] };
    let picture = shade(&scene.inputs(0), &Settings { medium: source, ..PLAIN }, BLACK, &view);
    let a = (-0.2_f64).exp();
    let expected = 0.5 * (-0.6_f64).exp() * (1.0 - a) + 16.0 * a;
    assert!((picture.at(16, 16)[1] - expected).abs() < 1e-9);
}

#[test]
fn pixels_without_water_are_the_scene() {
    let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 9, 9);
    let mut scene = Scene::new(&view, 1, 2.0, |_| 10.0);
    scene.depth = Image::new(9, 9, EMPTY);
    assert_eq!(shade(&scene.inputs(1), &PLAIN, BLACK, &view), scene.color);
}

#[test]
fn the_background_is_displaced_in_pixels_but_not_onto_what_is_in_front() {
    let clear = Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3], ambient: [0.0; 3] };
    let settings = Settings { medium: clear, ..PLAIN };
    let view = view(DVec2::new(2.0, -2.0), DVec2::ZERO, 65, 65);
    let n = DVec3::new(0.2, 0.1, 1.0).normalize();
    let mut scene = Scene::new(&view, 0, 3.0, |ray| -n.z * 10.0 / ray.dot(n));
    let fresnel = |c: f64| 1.0 - (1.0 - c).powi(5);
    let found = shade(&scene.inputs(0), &settings, BLACK, &view).at(32, 32);
    // To the left, and downwards in the image: -beta T n / (C z).
    let shift = 3.0 * 0.25 / (10.0 * 2.0 / (65.0 * 2.0));
    let by = DVec2::new(-n.x, n.y) * shift;
    // The offset is limited smoothly to four pixels of 65, here to 0.97 of its length.
    let expected = 32.0 + by / (1.0 + by.length_squared() * (16.0_f64 / 65.0).powi(2)).sqrt();
    for axis in [0, 1] {
        assert!((found[axis] / fresnel(n.z) - expected[axis]).abs() < 0.02, "{found:?}");
    }
    *scene.scene.at_mut(31, 33) = 5.0;
    let found = shade(&scene.inputs(0), &settings, BLACK, &view).at(32, 32);
    assert!((found[0] / fresnel(n.z) - 32.0).abs() < 1e-3, "{found:?}");
}

/// Two planes that face the eye at depths 10 and 20, with thicknesses x and y, and with water of
/// thickness `window` between them.
fn two(
    view: &View,
    [x, y, window]: [f64; 3],
    settings: &Settings,
    boundary: f64,
    back: impl Fn(usize, usize) -> f64 + Sync,
) -> Image<[f64; 4]> {
    let front = Scene::new(view, 0, x + y, |_| 10.0);
    let reduced = view.reduced(1);
    let behind = Behind {
        boundaries: &Image::new(view.width, view.height, boundary),
        thickness: &Image::new(view.width, view.height, [x, y, window]),
        smoothed: &Image::from_fn(reduced.width, reduced.height, back),
        level: 1,
    };
    let env = |_| DVec3::new(0.5, 2.0, 1.0);
    shade_sheets(&front.inputs(0), &behind, settings, env, view)
}

#[test]
fn the_front_sheet_lies_over_the_back_one() {
    let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 33, 33);
    let mirror = Fresnel::Source { bias: 0.25, scale: 0.0, power: 1.0 };
    let mut settings = Settings { fresnel: mirror, ..PLAIN };
    let source = Medium::Source { base: [0.3, 0.5, 0.9], k: [0.4, 0.3, 0.2, 0.1] };
    for (medium, sheet) in [
        (PLAIN.medium, [(0.6, 2.0 * 0.1 / 0.6), (0.2, 0.0), (0.0, 0.0)].map(Some)),
        (source, [None; 3]),
    ] {
        settings.medium = medium;
        let spacing = settings.radius / 0.656;
        // Between the sheets there is only air, or as much water as air. The back sheet is
        // everywhere, in half of the columns, or nowhere.
        let cases = [(0.0, 1.0), (0.35, 0.5)]
            .map(|(window, air)| [0.0, 0.5, 1.0].map(|e| (window, air, e)));
        for (window, air, empty) in cases.into_iter().flatten() {
            let back = |i: usize, _| if i as f64 >= 17.0 * (1.0 - empty) { EMPTY } else { 20.0 };
            let found = two(&view, [1.0, 3.0, window * spacing], &settings, 15.0, back);
            for (x, y) in [(16, 16), (30, 4)] {
                let slant = view.ray(x, y).length();
                let over = |behind: DVec3, path: f64, part: f64| {
                    let of = |c: usize| match sheet[c] {
                        Some((k, glow)) => {
                            let t = (-k * path * slant).exp();
                            behind[c] * t + glow * (1.0 - t)
                        }
                        None => {
                            let a = (-0.1 * path * slant).exp();
                            let k = [0.4, 0.3, 0.2][c];
                            [0.3, 0.5, 0.9][c] * (-k * path * slant).exp() * (1.0 - a)
                                + behind[c] * a
                        }
                    };
                    // The reflectance is a quarter.
                    let mirrored = 0.25 * part;
                    DVec3::new(of(0), of(1), of(2)) * (1.0 - mirrored)
                        + DVec3::new(0.5, 2.0, 1.0) * mirrored
                };
                let scene = DVec3::new(x as f64, y as f64, 1.0);
                // Pixel 16 lies at 8.25 texels, a quarter of texel 7 and three quarters of texel 8.
                // Texels from 9 on are empty, and 8 is at the rim.
                let covered = match (empty == 0.0, empty == 1.0, x) {
                    (true, _, _) => 1.0,
                    (_, true, _) => 0.0,
                    (_, _, 16) => 0.25,
                    _ => 0.0,
                };
                let expected =
                    over(over(scene, air * 3.0, covered * air), 1.0 + (1.0 - air) * 3.0, 1.0);
                let found = DVec3::from_slice(&found.at(x, y)[..3]);
                assert!((found - expected).length() < 1e-9, "{found}, not {expected}");
                assert!((over(over(scene, 1.0, 1.0), 3.0, 1.0) - expected).length() > 1e-3);
            }
        }
    }
    // A single sheet with all water: without a boundary, or without air.
    let spacing = settings.radius / 0.656;
    let env = |_| DVec3::new(0.5, 2.0, 1.0);
    let front = Scene::new(&view, 0, 4.0, |_| 10.0);
    let one = shade(&front.inputs(0), &settings, env, &view);
    assert_eq!(two(&view, [1.0, 3.0, 0.0], &settings, EMPTY, |_, _| 20.0), one);
    assert_eq!(two(&view, [1.0, 3.0, 0.6 * spacing], &settings, 15.0, |_, _| 20.0), one);
    // The visible sheet is the back one, with its own thickness and nothing before it.
    let back = two(&view, [1.0, 3.0, 0.0], &settings, 8.0, |_, _| 20.0);
    let front = Scene::new(&view, 0, 3.0, |_| 10.0);
    assert_eq!(back, shade(&front.inputs(0), &settings, env, &view));
}

#[test]
fn the_scene_hides_the_back_sheet() {
    let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 32, 32);
    let mut front = Scene::new(&view, 1, 4.0, |_| 10.0);
    let boundaries = Image::new(32, 32, 15.0);
    let thickness = Image::new(32, 32, [1.0, 3.0, 0.0]);
    // Pixel 16 lies at 4.125 texels: three eighths of texel 3, which is at the rim, and five
    // eighths of texel 4.
    let smoothed = Image::from_fn(8, 8, |i, _| if i < 3 { EMPTY } else { 20.0 });
    let behind =
        Behind { boundaries: &boundaries, thickness: &thickness, smoothed: &smoothed, level: 2 };
    let back = |front: &Scene, x| {
        let two = Two::new(&front.inputs(1), &behind, &PLAIN, &view);
        two.at(x, 16).expect("water").back.expect("a back sheet")
    };
    let found = back(&front, 16);
    assert_eq!((found.covered, found.apart), (0.625, 1.0));
    assert_eq!(found.surface.thickness, 3.0);
    assert_eq!(back(&front, 22).covered, 1.0);
    assert_eq!(back(&front, 2).covered, 0.0);
    *front.scene.at_mut(16, 16) = 20.0;
    assert_eq!(back(&front, 16).covered, 0.0);
    assert_eq!(back(&front, 22).covered, 1.0);
}

#[test]
fn what_the_front_image_covers_is_of_the_back_one() {
    let view = view(DVec2::new(1.0, -1.0), DVec2::ZERO, 64, 64);
    let n = DVec3::new(0.3, 0.1, 1.0).normalize();
    let plane = |ray: DVec3| -n.z * 20.0 / ray.dot(n);
    let mut front = Scene::new(&view, 1, 4.0, plane);
    // In the first 17 columns of the smoothed image lies something nearer, which reaches a pixel
    // beyond its visible outline.
    for (x, y) in (0..32).flat_map(|y| (0..17).map(move |x| (x, y))) {
        *front.smoothed.at_mut(x, y) = 5.0;
    }
    let reduced = view.reduced(2);
    let smoothed = Image::from_fn(reduced.width, reduced.height, |x, y| plane(reduced.ray(x, y)));
    let at = |smoothed: &Image<f64>, x: usize| {
        let boundaries = Image::new(64, 64, EMPTY);
        let thickness = Image::new(64, 64, [4.0, 0.0, 4e6]);
        let behind = Behind { boundaries: &boundaries, thickness: &thickness, smoothed, level: 2 };
        Two::new(&front.inputs(1), &behind, &PLAIN, &view).at(x, 30).expect("water").front
    };
    // Pixel 33 is three quarters covered, and a quarter is a texel at the rim, which does not
    // count.
    let found = at(&smoothed, 33);
    assert_eq!(found.parts.mixed, 1.0);
    assert!((found.normal - n).length() < 0.02, "{found:?}");
    assert!((-found.position.z - plane(view.ray(33, 30))).abs() < 0.05, "{found:?}");
    // All texels around pixel 36, at 18.25 texels, belong to its surface.
    assert_eq!(at(&smoothed, 36).parts.mixed, 0.0);
    // The back image has no surface there, then one in half of its columns.
    let empty = Image::new(16, 16, EMPTY);
    assert_eq!(at(&empty, 33).parts.mixed, 0.0);
    let half = Image::from_fn(16, 16, |x, y| if x < 8 { smoothed.at(x, y) } else { EMPTY });
    let found = at(&half, 33).parts.mixed;
    assert_eq!(found, 0.0, "texels on a rim are not found");
}

#[test]
fn the_offsets_of_both_sheets_add_up() {
    let settings = Settings {
        medium: Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3], ambient: [0.0; 3] },
        fresnel: Fresnel::Source { bias: 0.0, scale: 0.0, power: 1.0 },
        ..PLAIN
    };
    let view = view(DVec2::new(2.0, -2.0), DVec2::ZERO, 65, 65);
    let normals = [(0.2, 0.1), (-0.05, 0.3)].map(|(x, y)| DVec3::new(x, y, 1.0).normalize());
    let plane = |n: DVec3, z: f64| move |ray: DVec3| -n.z * z / ray.dot(n);
    let front = Scene::new(&view, 0, 10.0, plane(normals[0], 10.0));
    let at = plane(normals[1], 20.0);
    let reduced = view.reduced(1);
    let back = Image::from_fn(reduced.width, reduced.height, |x, y| at(reduced.ray(x, y)));
    let behind = Behind {
        boundaries: &Image::new(65, 65, 15.0),
        thickness: &Image::new(65, 65, [2.0, 8.0, 0.0]),
        smoothed: &back,
        level: 1,
    };
    let found = shade_sheets(&front.inputs(0), &behind, &settings, BLACK, &view).at(32, 32);
    // Pixels per length at depth 1.
    let scale = 65.0;
    let by = |n: DVec3, t: f64, z: f64| DVec2::new(-n.x, n.y) * t * 0.25 * scale / z;
    let both = by(normals[0], 2.0, 10.0) + by(normals[1], 8.0, 20.0);
    let share = both.length() * 16.0 / 65.0;
    let expected = 32.0 + both / share.hypot(1.0);
    let found = DVec2::new(found[0], found[1]);
    assert!((found - expected).length() < 0.02, "{found}, not {expected}");
    assert!((expected - 32.0 - by(normals[0], 2.0, 10.0)).length() > 1.0, "one of them only");
}

/// A level pool before an upright wall: in the water, each point of the wall appears as far below
/// the water's edge as it stands above it, in any unit of length.
#[test]
fn a_wall_is_mirrored_where_it_stands() {
    let (far, above) = (6.0, 2.0);
    for unit in [1.0, 1e-3, 100.0] {
        let pitch = DMat4::from_rotation_x(20.0_f64.to_radians());
        let p = projection(DVec2::new(1.2, -1.2), DVec2::ZERO, Depth::Standard);
        let view = View::new(pitch, p, 160, 120).expect("a valid view");
        let world = view.view.inverse();
        // The eye is at the origin, the wall at z = -far, the water and the pool's bed below.
        let ray = |x: usize, y: usize| world.transform_vector3(view.ray(x, y));
        let level = |ray: DVec3, y: f64| if ray.y < 0.0 { y / ray.y } else { EMPTY };
        let wall = |ray: DVec3| if ray.z < 0.0 { -far / ray.z } else { EMPTY };
        let of = |of: &(dyn Fn(DVec3) -> f64 + Sync)| {
            Image::from_fn(view.width, view.height, |x, y| unit * of(ray(x, y)))
        };
        let water = |ray: DVec3| {
            let z = level(ray, -above);
            if z < wall(ray) { z } else { EMPTY }
        };
        let mut scene = Scene::new(&view, 0, unit, |_| 1.0);
        (scene.depth, scene.smoothed) = (of(&water), of(&water));
        scene.scene = of(&|ray| wall(ray).min(level(ray, -above - 1.0)));
        let heights = of(&|ray| wall(ray).min(level(ray, -above - 1.0)) * ray.y);
        scene.color = Image::from_fn(view.width, view.height, |x, y| {
            [heights.at(x, y) / unit, 0.0, 0.0, 1.0]
        });
        let settings = Settings { mirror_steps: 10, radius: 0.5 * unit, ..PLAIN };
        let surfaces = Surfaces::new(&scene.inputs(0), &settings, &view);
        let mut found = 0;
        for (x, y) in (20..140).flat_map(|x| (0..120).map(move |y| (x, y))) {
            let (ray, near) = (ray(x, y), water(ray(x, y)));
            if near >= EMPTY {
                continue;
            }
            let Some(surface) = surfaces.at(x, y) else { continue };
            // The reflected ray rises as steeply as the eye's ray falls.
            let point = ray * near;
            let height = -above - ray.y * (far + point.z) / -ray.z;
            let seen = met(&scene.inputs(0), &settings, &surface, &view);
            let at =
                on_wall(&view, DVec3::new(point.x - ray.x / ray.z * (far + point.z), height, -far));
            let extent = view.extent();
            if at.cmplt(DVec2::splat(8.0)).any()
                || at.cmpgt(extent - 8.0).any()
                || surface.parts.case != Case::Whole
            {
                continue;
            }
            assert_eq!(seen.share, 1.0, "({x}, {y}) meets nothing: {at} {seen:?}");
            // Accurate to two pixels, because the water's slope comes from texels and depth has
            // steps between texels.
            assert!(seen.at.distance(at) < 2.0, "({x}, {y}): {}, not {at}", seen.at);
            found += 1;
        }
        assert!(found > 1000, "{found} pixels");
    }
}

/// A level pool over a sloping floor: the refracted ray meets the floor between the centres of the scene's texels.
#[test]
fn a_floor_under_water_is_met_between_texels() {
    let (above, deep, index) = (1.5, 1.0, 1.33);
    let pitch = DMat4::from_rotation_x(35.0_f64.to_radians());
    let p = projection(DVec2::new(1.2, -1.2), DVec2::ZERO, Depth::Standard);
    let view = View::new(pitch, p, 160, 120).expect("a valid view");
    let world = view.view.inverse();
    let up = view.view.transform_vector3(DVec3::Y);
    // The floor rises to the right and away from the eye. Distances along a ray of unit depth.
    let floor = (DVec3::new(-0.1, 1.0, 0.1), -above - deep);
    let to_floor = |from: DVec3, along: DVec3| (floor.1 - floor.0.dot(from)) / floor.0.dot(along);
    let ray = |x: usize, y: usize| world.transform_vector3(view.ray(x, y));
    let of = |of: &(dyn Fn(DVec3) -> f64 + Sync)| {
        Image::from_fn(view.width, view.height, |x, y| of(ray(x, y)))
    };
    let mut scene = Scene::new(&view, 0, 1.0, |_| 1.0);
    (scene.depth, scene.smoothed) = (of(&|ray| -above / ray.y), of(&|ray| -above / ray.y));
    scene.scene = of(&|ray| to_floor(DVec3::ZERO, ray));
    let mut most = 0.0_f64;
    for (x, y) in (30..130).flat_map(|x| (50..90).map(move |y| (x, y))) {
        let ray = ray(x, y);
        let surface = facing(view.ray(x, y) * (-above / ray.y), up, 1.0, 1.0);
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let by = (index, 1.0, &Off::default());
        let (off, touches) = bed_offset(&scene.inputs(0), &surface, &view, pixel, by);
        assert_eq!(touches, 1.0, "({x}, {y})");
        // By Snell's law the part along the surface shrinks by the index.
        let (from, unit) = (ray * (-above / ray.y), ray.normalize());
        let level = unit.with_y(0.0) / index;
        let along = level.with_y(-(1.0 - level.length_squared()).sqrt());
        let meets = on_wall(&view, from + along * to_floor(from, along));
        most = most.max((pixel + off).distance(meets));
    }
    assert!(most < 1e-6, "{most} pixels");
}

/// Pixel position of a point in world space.
fn on_wall(view: &View, place: DVec3) -> DVec2 {
    let eye = view.view.transform_point3(place);
    (eye.truncate() / -eye.z - view.ray_at(DVec2::ZERO).truncate()) / view.slope_step()
}

#[test]
fn the_reflection_is_looked_up_in_the_world() {
    // A level pool seen from above at 30 degrees; the result is the mirrored ray.
    let eye = DVec3::new(0.0, 5.0, 0.0);
    let forward = DVec3::new(0.0, -0.5, -(0.75_f64.sqrt()));
    let pitch = DMat4::from_rotation_x(30.0_f64.to_radians());
    let world_to_eye = pitch * DMat4::from_translation(-eye);
    assert!((world_to_eye.transform_vector3(forward) + DVec3::Z).length() < 1e-12);
    let p = projection(DVec2::new(1.2, -1.2), DVec2::ZERO, Depth::Standard);
    let view = View::new(world_to_eye, p, 65, 65).expect("a valid view");
    let up = world_to_eye.transform_vector3(DVec3::Y);
    let scene = Scene::new(&view, 0, 5.0, |ray| -5.0 / ray.dot(up));
    let mirror =
        Settings { fresnel: Fresnel::Source { bias: 2.0, scale: 0.0, power: 1.0 }, ..PLAIN };
    let picture = shade(&scene.inputs(0), &mirror, |direction| direction, &view);
    let found = DVec3::from_slice(&picture.at(32, 32)[..3]);
    assert!((found - DVec3::new(0.0, 0.5, forward.z)).length() < 2e-3, "{found}");

    // With the sun in the reflected direction there is the whole highlight; thin water has none.
    let sun = world_to_eye.transform_vector3(found.normalize());
    let lit = Settings { specular: [0.5; 3], sun_direction: sun, ..mirror };
    let glint = shade(&scene.inputs(0), &lit, |direction| direction, &view).at(32, 32);
    assert!((glint[0] - picture.at(32, 32)[0] - 0.5).abs() < 1e-3, "{glint:?}");
    let dry = Scene::new(&view, 0, 0.0, |ray| -5.0 / ray.dot(up));
    let found = shade(&dry.inputs(0), &lit, |direction| direction, &view).at(32, 32);
    assert!((found[0] - 32.0).abs() < 1e-9, "{found:?}");
}
