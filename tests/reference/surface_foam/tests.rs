//! Compares the foam's twin with closed forms, and its bounds with single precision.

use super::super::tests::view;
use super::super::{EMPTY, Image, View, is_surface};
use super::ellipse::{Ellipse, axes};
use super::noise::{gradient, gradient_number};
use super::single::Use;
use super::*;
use crate::support::scenes::Random;
use glam::{DVec2, Mat4, Vec3};

const SPACING: f64 = 0.5;

fn settings() -> Settings {
    Settings { noise: 0.0, ..Settings::new(SPACING) }
}

/// A sprite at rest that is entirely foam.
fn sprite(center: [f64; 3]) -> Sprite {
    let center = DVec3::from(center);
    Sprite { center, foam: 1.0, velocity: DVec3::ZERO, age: 0.0, id: 7, sun: [1.0; 2] }
}

fn moving(center: [f64; 3], velocity: [f64; 3]) -> Sprite {
    Sprite { velocity: DVec3::from(velocity), ..sprite(center) }
}

fn nothing(view: &View) -> Image<f64> {
    Image::new(view.width, view.height, f64::INFINITY)
}

/// Sums of the first two channels of a thickness image.
fn total(thickness: &Image<[f64; 3]>) -> DVec2 {
    thickness.data.iter().map(|t| DVec2::new(t[0], t[1])).sum()
}

fn random(random: &mut Random, low: f64, high: f64) -> f64 {
    f64::from(random.between(low as f32, high as f32))
}

/// Sprites with coordinates in single precision, in front of and around the eye, at all speeds.
/// Some move straight at the eye or across the view, some exactly at a threshold.
fn cloud(seed: u64, count: usize, far: f64, settings: &Settings) -> Vec<Sprite> {
    let mut r = Random(seed);
    let cloud = (0..count).map(|i| {
        let d = random(&mut r, 0.05, far);
        let center = DVec3::new(random(&mut r, -d, d), random(&mut r, -d, d), -d);
        let any = DVec3::from([0; 3].map(|_| random(&mut r, -1.0, 1.0)));
        let across = any.cross(center).normalize();
        let speed = 20.0 * settings.spacing;
        let velocity = match i % 8 {
            0 => DVec3::ZERO,
            1 => center + random(&mut r, 0.0, 0.5) * any,
            2 => speed * (center.normalize() + PARALLEL * across),
            3 => STILL * settings.spacing * any.normalize(),
            _ => 2.0 * speed * any,
        };
        let held = |v: DVec3| v.as_vec3().as_dvec3();
        let (foam, age) = (random(&mut r, 0.0, 1.1), random(&mut r, 0.0, 60.0).powi(2));
        let id = r.bits() as u32;
        Sprite { center: held(center), foam, velocity: held(velocity), age, id, sun: [1.0; 2] }
    });
    cloud.collect()
}

#[test]
fn a_sprite_holds_its_particles_volume() {
    let settings = settings();
    let across = [40.0 * SPACING, 5.0 * SPACING, 0.0];
    let tilted = [20.0 * SPACING, 0.0, 18.0 * SPACING];
    for (at, velocity, foam) in [
        ([0.0, 0.0, -20.0], [0.0; 3], 1.0),
        ([0.0, 0.0, -20.0], across, 0.3),
        ([0.0, 0.0, -20.0], tilted, 1.0),
        ([3.0, -2.0, -20.0], tilted, 0.6),
    ] {
        let view = view(DVec2::new(3.0, -4.0), DVec2::new(0.1, -0.1), 401, 301);
        let sprite = Sprite { foam, ..moving(at, velocity) };
        let empty = Image::new(401, 301, EMPTY);
        let drawn = thickness(&[sprite], &view, 0, &settings, &nothing(&view), &empty);
        let ellipse = Ellipse::new(&sprite, &settings, 1e3);
        let n = ellipse.axes.normal();
        let mut sum = 0.0;
        for (x, y) in (0..301).flat_map(|y| (0..401).map(move |x| (x, y))) {
            // The thickness is in world units along z, over a pixel's area at the depth k of the
            // ellipse's plane.
            let k = n.dot(sprite.center) / n.dot(view.ray(x, y));
            sum += drawn.at(x, y)[0] * k * k * view.c_x() * view.c_y();
        }
        // k and n . ray vary over the sprite by the ratio of half-axis to distance; the linear part
        // cancels.
        let expected = foam * SPACING.powi(3);
        assert!((sum / expected - 1.0).abs() < 3e-3, "{at:?}, {velocity:?}: {sum}");
        assert_eq!(total(&drawn).y, 0.0, "no depth of foam");
    }
}

#[test]
fn the_axes_follow_the_motion() {
    let settings = settings();
    let mut r = Random(3);
    let mut kinds = [0; 3];
    for sprite in cloud(9, 4000, 20.0, &settings) {
        let found = axes(&sprite, &settings);
        let (v, n) = (sprite.center.normalize(), found.normal());
        assert!((found.e1.length() - 1.0).abs() < 1e-12 && (n.length() - 1.0).abs() < 1e-9);
        assert!(found.e2.dot(v).abs() < 1e-9, "the short one lies across the view");
        assert!(n.dot(v).abs() > 0.43, "never edge-on");
        let speed = sprite.velocity.length() / SPACING;
        let dir = sprite.velocity.normalize_or_zero();
        if found.stretch == 0.0 {
            assert!(n.dot(v).abs() > 1.0 - 1e-12, "across the view");
        }
        if speed > settings.motion_threshold && dir.dot(v).abs() < HEAD_ON.0 {
            assert!(found.stretch == 1.0 && (found.e1 - dir).length() < 1e-12);
            kinds[0] += 1;
        } else if speed > 1e-3 && dir.cross(v).length() > 2e-3 {
            assert!(found.e1.dot(dir) > 0.0);
            kinds[1] += 1;
        } else if speed < 0.9e-6 {
            let turned = Sprite { velocity: sprite.velocity * 0.1, ..sprite };
            assert_eq!(found, axes(&turned, &settings));
            kinds[2] += 1;
        }
    }
    assert!(kinds.into_iter().all(|n| n > 400), "{kinds:?}");
    // Half of the threshold speed gives half of the stretch.
    let half = moving([0.0, 0.0, -9.0], [0.5 * 21.0 * SPACING, 0.0, 0.0]);
    assert!((axes(&half, &settings).stretch - 0.5).abs() < 1e-12);
    // At rest the ellipse is level, unless the view is nearly vertical.
    let level = axes(&sprite([0.3, 2.0, -5.0]), &settings);
    assert!(level.e2.y.abs() < 1e-12 && level.e1.y.abs() > 0.9);
    let steep = axes(&sprite([1e-5, random(&mut r, 4.0, 5.0), -1e-5]), &settings);
    assert!(steep.e2.is_finite() && steep.e2.x.abs() < 1e-3 && steep.e2.z.abs() > 0.99);
}

/// Number of pixels with a surface in a depth image, and number of columns and rows that contain
/// some.
fn extents(drawn: &Image<f64>) -> (usize, usize, usize) {
    let seen = |x: usize, y: usize| is_surface(drawn.at(x, y));
    let column = |x: &usize| (0..drawn.height).any(|y| seen(*x, y));
    let row = |y: &usize| (0..drawn.width).any(|x| seen(x, *y));
    let (columns, rows) = ((0..drawn.width).filter(column), (0..drawn.height).filter(row));
    let count = drawn.data.iter().filter(|d| is_surface(**d)).count();
    (count, columns.count(), rows.count())
}

#[test]
fn motion_across_doubles_and_towards_the_eye_does_not() {
    let settings = settings();
    let view = view(DVec2::splat(2.0), DVec2::ZERO, 240, 240);
    let (at, fast) = ([0.0, 0.0, -6.0], 30.0 * SPACING);
    let of = |s: Sprite| extents(&depth(&[s], &view, 0, &settings, &nothing(&view)));
    let rest = of(sprite(at));
    // A diameter of 2 r at a depth of 6, in pixels of 1/120 per unit of depth.
    let expected = 2.0 * 2.0 * 0.656 * SPACING / 6.0 * 240.0;
    assert!((rest.1 as f64 - expected).abs() < 2.0 && rest.1 == rest.2, "{rest:?}");
    for (velocity, by) in [
        ([fast, 0.0, 0.0], (2.0, 1.0)),
        ([0.0, -fast, 0.0], (1.0, 2.0)),
        ([0.0, 0.0, fast], (1.0, 1.0)),
        ([0.0, 0.0, -fast], (1.0, 1.0)),
        ([0.05 * fast, 0.0, fast], (1.0, 1.0)),
    ] {
        let found = of(moving(at, velocity));
        let near = |a: usize, b: f64| (a as f64 - b).abs() <= 2.0;
        let (width, height) = (rest.1 as f64 * by.0, rest.2 as f64 * by.1);
        assert!(near(found.1, width) && near(found.2, height), "{velocity:?}: {found:?}");
        let grown = found.0 as f64 / rest.0 as f64 / (by.0 * by.1);
        assert!((grown - 1.0).abs() < 0.02, "{velocity:?}: {grown}");
    }
    let quarter = of(Sprite { foam: 0.0625, ..sprite(at) });
    assert!((quarter.0 as f64 / rest.0 as f64 - 0.25).abs() < 0.01);
    assert_eq!(of(Sprite { foam: 0.125, ..sprite(at) }), rest);
    assert_eq!(of(Sprite { foam: 3.0, ..sprite(at) }), rest, "no more than whole");
}

#[test]
fn depth_is_that_of_the_nearest_plane() {
    let settings = settings();
    let view = view(DVec2::new(1.5, -2.0), DVec2::new(0.1, 0.2), 64, 48).reduced(0);
    let sprites = cloud(4, 200, 9.0, &settings);
    let all = depth(&sprites, &view, 0, &settings, &nothing(&view));
    let single: Vec<_> =
        sprites.iter().map(|s| depth(&[*s], &view, 0, &settings, &nothing(&view))).collect();
    for i in 0..all.data.len() {
        let least = single.iter().map(|one| one.data[i]).fold(EMPTY, f64::min);
        assert_eq!(all.data[i], least);
    }
    assert!(extents(&all).0 > 500);
    // Every hit lies in the plane and in the ellipse, and no pixel was skipped.
    for (sprite, drawn) in sprites.iter().zip(&single).take(60) {
        let foam = sprite.foam.min(1.0);
        let ellipse = Ellipse::deep(sprite, foam, &view, &settings);
        for (x, y) in (0..48).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let hit = ellipse.meet(view.ray(x, y), view.near());
            let hit = hit.filter(|_| foam > 0.0 && -sprite.center.z > view.near());
            assert_eq!(drawn.at(x, y), hit.map_or(EMPTY, |hit| hit.k));
            if let Some(hit) = hit {
                let p = view.ray(x, y) * hit.k - sprite.center;
                assert!(p.dot(ellipse.axes.normal()).abs() < 1e-9);
                assert!(p.length() <= ellipse.half.x * (1.0 + 1e-9));
            }
        }
    }
}

#[test]
fn what_takes_no_part() {
    let settings = settings();
    let view = view(DVec2::ONE, DVec2::ZERO, 16, 16);
    let good = sprite([0.0, 0.0, -3.0]);
    let with = |change: fn(&mut Sprite)| {
        let mut sprite = good;
        change(&mut sprite);
        sprite
    };
    let none = [
        with(|s| s.foam = 0.0),
        with(|s| s.foam = -1.0),
        with(|s| s.foam = f64::NAN),
        with(|s| s.center.x = f64::NAN),
        with(|s| s.velocity.y = f64::INFINITY),
        with(|s| s.center.z = -0.09),
        with(|s| s.center.z = 3.0),
    ];
    let scene = nothing(&view);
    let empty = Image::new(16, 16, EMPTY);
    let count = |sprites: &[Sprite]| {
        let sum = total(&thickness(sprites, &view, 0, &settings, &scene, &empty)).x;
        (extents(&depth(sprites, &view, 0, &settings, &scene)).0, sum)
    };
    assert_eq!(count(&none), (0, 0.0));
    let (pixels, sum) = count(&[good]);
    assert!(pixels > 10 && sum > 0.0);
}

#[test]
fn the_scene_hides_by_the_planes_depth() {
    let settings = settings();
    let view = view(DVec2::splat(2.0), DVec2::ZERO, 120, 120);
    // The sprite is nearer on its right side, and half of it is before the scene.
    let tilted = [moving([0.0, 0.0, -6.0], [20.0 * SPACING, 0.0, 18.0 * SPACING])];
    let wall = Image::new(120, 120, 6.0);
    let open = depth(&tilted, &view, 0, &settings, &nothing(&view));
    let cut = depth(&tilted, &view, 0, &settings, &wall);
    for (open, cut) in open.data.iter().zip(&cut.data) {
        assert_eq!(*cut, if *open < 6.0 { *open } else { EMPTY });
    }
    let ratio = extents(&cut).0 as f64 / extents(&open).0 as f64;
    assert!((0.4..0.7).contains(&ratio), "{ratio}");
    // Invalid depths of the scene hide nothing.
    for none in [0.0, -4.0, f64::NAN, EMPTY] {
        assert_eq!(depth(&tilted, &view, 0, &settings, &Image::new(120, 120, none)), open);
    }
    let sum = |scene: &Image<f64>, level: u32| {
        let foam = depth(&tilted, &view, level, &settings, scene);
        total(&thickness(&tilted, &view, level, &settings, scene, &foam))
            * f64::from(1 << (2 * level))
    };
    let (all, half) = (sum(&nothing(&view), 0).x, sum(&wall, 0).x);
    assert!((0.4..0.7).contains(&(half / all)));
    assert!((sum(&wall, 2).x / half - 1.0).abs() < 0.05);
    // A texel uses the scene's depth at the pixel after its centre.
    let stripes = Image::from_fn(120, 120, |x, _| if x % 4 == 2 { 99.0 } else { 1.0 });
    assert!((sum(&stripes, 2).x / all - 1.0).abs() < 0.05);
    assert!(sum(&stripes, 0).x < 0.3 * all);
    let stripes = Image::from_fn(120, 120, |x, _| if x % 4 == 2 { 1.0 } else { 99.0 });
    assert_eq!(sum(&stripes, 2).x, 0.0);
}

#[test]
fn the_window_behind_the_nearest_foam() {
    let settings = settings();
    let view = view(DVec2::splat(2.0), DVec2::ZERO, 61, 61);
    let [at_4, at_7, at_8] = [4.0, 7.4, 8.1].map(|d| sprite([0.0, 0.0, -d]));
    let none = nothing(&view);
    let of = |sprites: &[Sprite], foam: &Image<f64>| {
        thickness(sprites, &view, 0, &settings, &none, foam)
    };
    let foam = depth(&[at_4, at_7, at_8], &view, 0, &settings, &none);
    assert!((foam.at(30, 30) - 4.0).abs() < 1e-9);
    let (all, near) = (of(&[at_4, at_7, at_8], &foam), of(&[at_4, at_7], &foam));
    for (x, y) in (0..61).flat_map(|y| (0..61).map(move |x| (x, y))) {
        // 7 spacings are 3.5, then the window of one spacing. There is no front layer where the
        // depth image is empty, although there is foam.
        let expected = if is_surface(foam.at(x, y)) { near.at(x, y)[0] } else { 0.0 };
        assert!((all.at(x, y)[1] - expected).abs() < 1e-12);
        assert!(all.at(x, y)[1] <= all.at(x, y)[0]);
    }
    // The weighted distance behind the frontmost foam: 3.4 and 4.1, minus a spacing of 0.5.
    let alone = |s: &Sprite| of(&[*s], &foam).at(30, 30)[0];
    let expected = alone(&at_7) * 2.9 / 3.4 + alone(&at_8) * 3.6 / 4.1;
    assert!((all.at(30, 30)[2] - expected).abs() < 1e-12 && expected > 0.0);
    // For little foam the depth sprite is smaller than the thickness sprite.
    let little = [Sprite { foam: 0.0625, ..at_4 }];
    let rim = of(&little, &depth(&little, &view, 0, &settings, &none));
    assert!(rim.data.iter().any(|t| t[0] > 0.0 && t[1] == 0.0 && t[2] == 0.0));
    assert!(total(&all).y > 0.5 * total(&all).x);
    let all_in = Settings { front_depth: 4.2, ..settings };
    let all_in = thickness(&[at_4, at_7, at_8], &view, 0, &all_in, &none, &foam);
    assert_eq!(all_in.at(30, 30)[0], all_in.at(30, 30)[1]);
}

#[test]
fn the_noise_is_even_continuous_and_does_not_repeat() {
    let mut r = Random(11);
    let mut place = |size: f64| DVec3::from([0; 3].map(|_| random(&mut r, -size, size)));
    let n = 400_000;
    let (mut sum, mut squares, mut most, mut steepest) = (0.0, 0.0, 0.0_f64, 0.0_f64);
    for i in 0..n {
        let at = place(1000.0);
        let value = noise(at);
        sum += value;
        squares += value * value;
        most = most.max(value.abs());
        // Every second sample lies across a border between cells.
        let at = if i % 2 == 0 { at } else { DVec3::new(at.x.round() - 5e-7, at.y, at.z) };
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][i / 2 % 3];
        let step = if i % 2 == 0 { 1e-6 * axis } else { 1e-6 * DVec3::X };
        steepest = steepest.max((noise(at + step) - noise(at)).abs() / 1e-6);
    }
    let (mean, deviation) = (sum / n as f64, (squares / n as f64).sqrt());
    // The samples are independent, because they are far apart.
    assert!(mean.abs() < 4.0 * deviation / (n as f64).sqrt(), "{mean}");
    assert!(deviation > 0.2 && most > 0.8 && most <= noise_reach(), "{deviation}, {most}");
    assert!(steepest > 1.5 && steepest <= noise_slope(), "{steepest}");
    for corner in [DVec3::ZERO, DVec3::new(-3.0, 5.0, 64.0), DVec3::splat(-1.0)] {
        assert_eq!(noise(corner), 0.0);
    }
    // The noise does not repeat with any of these shifts along an axis.
    let sample: Vec<DVec3> = (0..3000).map(|_| place(100.0)).collect();
    let values: Vec<f64> = sample.iter().map(|at| noise(*at)).collect();
    let norm: f64 = values.iter().map(|v| v * v).sum();
    for shift in (1..=128).chain([192, 256, 512, 1024, 4096, 65536]) {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let moved = |at: &DVec3| noise(*at + f64::from(shift) * axis);
            let product: f64 = sample.iter().zip(&values).map(|(at, v)| moved(at) * v).sum();
            assert!((product / norm).abs() < 0.15, "{shift} along {axis}: {}", product / norm);
        }
    }
}

#[test]
fn the_gradients_are_the_twelve_edges() {
    let mut found = std::collections::HashMap::new();
    for i in 0..4096_u32 {
        let at = [i & 15, (i >> 4 & 15).wrapping_sub(8), i >> 8];
        let g = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| gradient(at, axis) as i32);
        assert_eq!(g.iter().filter(|part| **part == 0).count(), 1);
        assert_eq!(g.iter().map(|part| part.abs()).sum::<i32>(), 2);
        *found.entry(g).or_insert(0) += 1;
    }
    assert_eq!(found.len(), 12);
    // Four of the gradients belong to two hash values.
    for (g, count) in found {
        let twice = [[1, 1, 0], [-1, 1, 0], [0, -1, 1], [0, -1, -1]].contains(&g);
        let expected = if twice { 512.0 } else { 256.0 };
        assert!((f64::from(count) - expected).abs() < 5.0 * expected.sqrt(), "{g:?}: {count}");
    }
}

/// All pairs of gradients at neighbouring lattice points are equally frequent: chi squared with 255
/// degrees of freedom is at most six standard deviations above its mean.
#[test]
fn neighbours_gradients_do_not_know_of_each_other() {
    const EDGE: u32 = 32;
    for step in [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [0, 1, 1], [1, 0, 1], [1, 1, 1]] {
        let mut pairs = [0_u32; 256];
        for n in 0..EDGE.pow(3) {
            let at = [n % EDGE, n / EDGE % EDGE, n / EDGE / EDGE];
            let next = [0, 1, 2].map(|axis| at[axis] + step[axis]);
            pairs[(16 * gradient_number(at) + gradient_number(next)) as usize] += 1;
        }
        let mean = f64::from(EDGE.pow(3)) / 256.0;
        let chi: f64 = pairs.iter().map(|&n| (f64::from(n) - mean).powi(2) / mean).sum();
        assert!(chi < 255.0 + 6.0 * 510.0_f64.sqrt(), "{chi} {step:?}");
    }
}

#[test]
fn the_noise_is_each_particles_own_and_keeps_the_volume() {
    let view = view(DVec2::splat(2.0), DVec2::ZERO, 61, 61);
    let settings = Settings::new(SPACING);
    let (none, empty) = (nothing(&view), Image::new(61, 61, EMPTY));
    let whole = sprite([0.0, 0.0, -5.0]);
    let of = |s: Sprite, by: &Settings| thickness(&[s], &view, 0, by, &none, &empty);
    let smooth = of(whole, &Settings { noise: 0.0, ..settings });
    let by_id = |id: u32| of(Sprite { id, ..whole }, &settings);
    assert!(by_id(1) != by_id(2) && by_id(1) == by_id(1));
    let later = of(Sprite { age: 0.1, id: 1, ..whole }, &settings);
    assert_ne!(later, by_id(1));
    let still = Settings { noise_rate: 0.0, ..settings };
    assert_eq!(of(Sprite { age: 0.1, id: 1, ..whole }, &still), by_id(1));
    // 0.9 times the noise is nearly always above -1, so no thickness is clipped and the mean equals
    // that without noise.
    let mean = (0..600).map(|id| total(&by_id(id)).x).sum::<f64>() / 600.0;
    assert!((mean / total(&smooth).x - 1.0).abs() < 0.02, "{mean}");
    let torn = Settings { noise: 4.0, ..settings };
    assert!(
        (0..9).all(|id| { of(Sprite { id, ..whole }, &torn).data.iter().all(|t| t[0] >= 0.0) })
    );
    // An origin lies in its range, and all are distributed uniformly.
    let origins: Vec<DVec3> = (0..4000).map(origin).collect();
    assert!(origins.iter().all(|o| o.min_element() >= 0.0 && o.max_element() < SPREAD));
    let mean = origins.iter().sum::<DVec3>() / 4000.0;
    assert!((mean - SPREAD / 2.0).abs().max_element() < 2.0, "{mean}");
    assert!(origin(u32::MAX).is_finite(), "three times an id wraps");
}

#[test]
fn single_precision_stays_in_the_bounds() {
    let full = view(DVec2::new(0.9, -1.2), DVec2::new(0.2, -0.1), 37, 26);
    let turned = Mat4::from_rotation_y(0.7) * Mat4::from_rotation_x(0.4);
    let scene = Image::from_fn(37, 26, |x, y| if (x / 9 + y / 5) % 2 == 0 { 3.0 } else { 99.0 });
    let (mut usual, mut special, mut many) = (Use::default(), Use::default(), Use::default());
    for (spacing, far, eye) in
        [(0.5, 20.0, 2.0), (0.05, 20.0, 1.0), (0.05, 2.0, 50.0), (2.0, 9.0, 0.0)]
    {
        let settings = Settings::new(f64::from(spacing as f32));
        let eye = Mat4::from_translation(eye * Vec3::new(1.0, -0.7, 0.3));
        let view = View { view: (turned * eye).as_dmat4(), ..full };
        let back = view.view.inverse();
        let mut sprites = cloud(5, 240, far, &settings);
        for sprite in &mut sprites {
            sprite.center = back.transform_point3(sprite.center).as_vec3().as_dvec3();
            sprite.velocity = back.transform_vector3(sprite.velocity).as_vec3().as_dvec3();
        }
        for (i, sprite) in sprites.iter().enumerate() {
            let used = if (1..4).contains(&(i % 8)) { &mut special } else { &mut usual };
            used.check(&[*sprite], &view, i as u32 % 3, &settings, &scene);
        }
        for level in 0..2 {
            many.check(&sprites, &view, level, &settings, &scene);
        }
    }
    for widths in &mut usual.widths {
        widths.sort_by(f64::total_cmp);
    }
    let middle = usual.widths[..3].iter().map(|w| w[w.len() / 2]).collect::<Vec<_>>();
    assert!(middle[0] < 2e-5 && middle[1] < 3e-3 && middle[2] < 3e-3, "{middle:?}");
    assert!(usual.open[0] * 50 < usual.open[1], "{:?}", usual.open);
    // The host rounds each operation to half an ulp, a tenth of what Vulkan permits.
    assert!(usual.worst[..3].iter().all(|worst| *worst > 0.05), "{:?}", usual.worst);
    // A single sprite has no foam behind it.
    let far = (many.widths[3].len(), many.worst[3]);
    assert!(usual.widths[3].is_empty() && far.0 > 100 && far.1 > 0.05, "{far:?}");
    // At a threshold of the axes, both results occur.
    assert!(special.worst[1] > 0.9, "{:?}", special.worst);
}
