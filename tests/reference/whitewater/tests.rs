//! Compares the definition of whitewater foam with known results.

use super::super::{EMPTY, Image, View};
use super::*;
use crate::reference::tests::view;
use crate::support::scenes::Random;
use glam::{DMat4, DVec2, DVec3};
use std::f64::consts::PI;

const KINDS: [Kind; 3] = [Kind::Foam, Kind::Spray, Kind::Bubble];

fn near(found: f64, expected: f64, by: f64) {
    assert!((found - expected).abs() <= by, "{found}, expected {expected}");
}

fn square(size: usize) -> View {
    view(DVec2::new(1.5, -1.5), DVec2::ZERO, size, size)
}

/// A foam particle with a radius of its own.
fn particle(position: DVec3, radius: f64) -> Particle {
    Particle { position, kind: Kind::Foam, radius: Some(radius), age: 0.0, id: 0 }
}

/// The images of one particle without water and scene.
fn alone(particle: Particle, view: &View) -> Foam {
    let none = Image::new(view.width, view.height, EMPTY);
    foam(&[particle], view, &Settings::new(1.0), &none, &none)
}

fn total(foam: &Foam) -> f64 {
    foam.sums.data.iter().map(|sums| sums[0]).sum()
}

#[test]
fn a_falloff_at_its_ends() {
    for (b, n, m) in [(1.0, 1.5, 1.0), (6.0, 2.0, 4.0), (1.0, 2.0, 0.4)] {
        for (x, f) in [(-1.0, 1.0), (0.0, 1.0), (b, 0.0), (1.001 * b, 0.0)] {
            assert_eq!(falloff(x, b, n, m), f, "{x} {b} {n} {m}");
        }
    }
    near(falloff(3.0, 6.0, 2.0, 4.0), 0.75_f64.powi(4), 1e-15);
    near(falloff(0.25, 1.0, 1.5, 1.0), 0.875, 1e-15);
    // A bubble's sprite is empty in its middle.
    assert_eq!([0.0, 0.5, 1.0].map(|x| Kind::Bubble.shape(x)), [0.0, 0.25, 1.0]);
    assert_eq!([0.0, 1.0].map(|x| Kind::Foam.shape(x)), [1.0, 0.0]);
}

#[test]
fn the_mean_of_a_shape_is_its_integral() {
    let n = 100_000;
    for kind in KINDS {
        let rings = (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n));
        let mean: f64 = rings.map(|x| 2.0 * x * kind.shape(x)).sum::<f64>() / f64::from(n);
        near(kind.mean(), mean, 1e-9);
    }
    near(Kind::Spray.mean(), 1.0 - 2.0 / 3.5, 1e-15);
    near(Kind::Foam.mean(), 1.0 - 2.0 / 4.25, 1e-15);
}

#[test]
fn what_is_drawn_and_how_large() {
    let view = square(33);
    let good = particle(DVec3::new(0.0, 0.0, -4.0), 0.5);
    for bad in [
        Particle { age: 1.0, ..good },
        Particle { age: f64::NAN, ..good },
        Particle { age: f64::NEG_INFINITY, ..good },
        Particle { position: DVec3::new(f64::NAN, 0.0, -4.0), ..good },
        Particle { position: DVec3::new(0.0, 0.0, -0.1), ..good },
        Particle { position: DVec3::new(0.0, 0.0, 4.0), ..good },
    ] {
        assert_eq!(total(&alone(bad, &view)), 0.0, "{bad:?}");
    }
    assert_eq!(total(&alone(Particle { age: -3.0, ..good }, &view)), total(&alone(good, &view)));
    let half = total(&alone(Particle { age: 0.5, ..good }, &view));
    near(half / total(&alone(good, &view)), 0.75_f64.powf(0.4), 1e-12);

    // h gives the radius.
    let size = |particle: Particle| {
        let seen = alone(particle, &view).front.at(16, 16).expect("foam in the middle");
        seen.h * 4.0 / 1.5
    };
    near(size(good), 0.5, 1e-12);
    near(size(Particle { id: 4, ..good }), 0.1, 1e-12);
    near(size(Particle { id: 7, kind: Kind::Bubble, ..good }), 0.5 / 3.0 / 2.0, 1e-12);
    near(size(Particle { radius: None, ..good }), 0.15, 1e-12);
    assert_eq!([0, 1, 2, 3].map(Kind::of), [Kind::Foam, Kind::Spray, Kind::Bubble, Kind::Foam]);
}

/// Sum of the thickness of a sprite with this radius in pixels, relative to its integral: min, max
/// and mean over positions within a pixel.
fn totals(kind: Kind, pixels: f64, focal: DVec2) -> [f64; 3] {
    let view = view(focal, DVec2::ZERO, 32, 32);
    let d = 8.0;
    let r = pixels * d * view.c_x().max(view.c_y());
    let one = particle(DVec3::ZERO, if kind == Kind::Bubble { 2.0 * r } else { r });
    let expected = PI * r * r / (d * d * view.c_x() * view.c_y()) * kind.mean();
    let expected = expected * (1.0_f64 - 0.09).powf(0.4);
    let mut random = Random(7);
    let all: Vec<_> = (0..400)
        .map(|_| {
            let mut pixel = || f64::from(random.between(14.0, 18.0));
            let position = view.ray_at(DVec2::new(pixel(), pixel())) * d;
            total(&alone(Particle { kind, position, age: 0.3, ..one }, &view)) / expected
        })
        .collect();
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    let most = all.iter().copied().fold(0.0, f64::max);
    [least, most, all.iter().sum::<f64>() / all.len() as f64]
}

#[test]
fn a_small_sprite_is_all_there_wherever_it_lies() {
    for focal in [DVec2::new(1.5, -1.5), DVec2::new(1.2, -1.9)] {
        for kind in KINDS {
            for pixels in [0.02, 0.3, 0.75, 0.9, 1.0] {
                let [least, most, _] = totals(kind, pixels, focal);
                assert!(
                    least > 1.0 - 1e-9 && most < 1.0 + 1e-9,
                    "{kind:?} {pixels}: {least} {most}"
                );
            }
        }
    }
}

#[test]
fn a_larger_sprite_is_nearly_all_there() {
    // A bubble's rim is a step, which hits or misses pixel centres.
    for (kind, by) in [(Kind::Foam, 0.05), (Kind::Spray, 0.05), (Kind::Bubble, 0.3)] {
        for pixels in [1.5, 2.0, 3.0, 6.0] {
            let [least, most, mean] = totals(kind, pixels, DVec2::new(1.5, -1.5));
            if pixels == 3.0 {
                assert!(least > 1.0 - by && most < 1.0 + by, "{kind:?}: {least} {most}");
            }
            near(mean, 1.0, 0.02);
        }
    }
}

#[test]
fn a_sphere_is_nearest_in_its_middle() {
    let view = square(33);
    let seen = alone(particle(DVec3::new(0.0, 0.0, -4.0), 0.5), &view).front;
    let middle = seen.at(16, 16).expect("foam in the middle");
    near(middle.depth, 3.5, 1e-12);
    near((middle.normal - DVec3::Z).length(), 0.0, 1e-12);
    near(middle.h, 0.5 * 1.5 / 4.0, 1e-12);
    // The radius is 3.09 pixels; first to the right, then up.
    let part = 2.0 / (0.5 / (4.0 * view.c_x()));
    for (x, y, normal) in [(18, 16, DVec2::X), (16, 14, DVec2::Y)] {
        let there = seen.at(x, y).expect("foam beside the middle");
        let w = (1.0 - part * part).sqrt();
        near((there.normal - (part * normal).extend(w)).length(), 0.0, 1e-12);
        near(there.depth, 4.0 - 0.5 * w, 1e-12);
    }
    assert!(seen.at(20, 16).is_none());

    // In a mirrored picture the normal is the same on the other side, and the view matrix rotates
    // it.
    let turn = DMat4::from_rotation_y(0.5);
    let mirrored = crate::reference::tests::view(DVec2::new(-1.5, 1.5), DVec2::ZERO, 33, 33);
    let mirrored = View { view: turn, ..mirrored };
    let position = turn.inverse().transform_point3(DVec3::new(0.0, 0.0, -4.0));
    let there = alone(particle(position, 0.5), &mirrored).front.at(18, 16).expect("foam");
    let eye = turn.transform_vector3(there.normal);
    near(eye.x, -part, 1e-12);
}

#[test]
fn thickness_goes_where_the_fluid_says() {
    let view = square(33);
    let images = |fluid: f64, scene: f64, attenuation: Attenuation| {
        let image = |depth: f64| Image::new(33, 33, depth);
        let settings = Settings { attenuation, ..Settings::new(2.0) };
        let one = particle(DVec3::new(0.0, 0.0, -4.0), 0.5);
        foam(&[one], &view, &settings, &image(scene), &image(fluid))
    };
    let open = images(EMPTY, EMPTY, Attenuation::Water);
    let middle = open.sums.at(16, 16);
    assert_eq!(middle, [1.0, 0.0, 0.0]);
    // The sphere's front is at 3.5, a quarter of the spacing behind the water's surface.
    let sums = images(3.0, EMPTY, Attenuation::Water).sums.at(16, 16);
    let below = 0.25 * 0.25 * 2.5;
    for (found, expected) in sums.into_iter().zip([1.0 - below, below, below * 0.2]) {
        near(found, expected, 1e-12);
    }
    assert_eq!(images(3.5, EMPTY, Attenuation::Water).sums.at(16, 16), [1.0, 0.0, 0.0]);
    near(images(1.0, EMPTY, Attenuation::Water).sums.at(16, 16)[1], 1.0, 1e-12);
    let source = Attenuation::Falloff { max: 1.0, n: 2.0, m: 4.0 };
    let sums = images(3.0, EMPTY, source).sums.at(16, 16);
    near(sums[0], 0.75_f64.powi(4), 1e-12);
    assert_eq!(sums[1..], [0.0, 0.0]);
    assert_eq!(images(2.4, EMPTY, source).sums.at(16, 16), [0.0; 3]);
    assert_eq!(images(EMPTY, EMPTY, source).sums.data, open.sums.data);

    // A scene hides foam that is not before it.
    let cut = images(EMPTY, 3.6, Attenuation::Water);
    assert!(cut.sums.at(16, 16) == middle && cut.sums.at(19, 16) == [0.0; 3]);
    assert!(cut.front.at(19, 16).is_none() && open.front.at(19, 16).is_some());
    let none = images(EMPTY, 3.5, Attenuation::Water);
    assert!(none.count.data.iter().all(|n| *n == 0));
}

#[test]
fn what_rounding_decides_is_in_the_upper_bounds_alone() {
    let view = square(33);
    let bounds = |d: f64, scene: f64| -> Bounds {
        let (scene, fluid) = (Image::new(33, 33, scene), Image::new(33, 33, EMPTY));
        let one = particle(DVec3::new(0.0, 0.0, -d), 0.125 * d);
        foam_bounds(&[one], &view, &Settings::new(1.0), &scene, &fluid)
    };
    let middle = |bounds: &Bounds| {
        let sums = [&bounds.sums[0].low, &bounds.sums[0].high].map(|sum| sum.at(16, 16));
        let depth = [&bounds.depth.low, &bounds.depth.high].map(|depth| depth.at(16, 16));
        (sums, depth, bounds.candidates.at(16, 16).len())
    };
    // Foam certainly before the scene; at the scene's depth; at the near plane.
    let (sums, depth, candidates) = middle(&bounds(4.0, 3.6));
    near(sums[0], 1.0, 1e-4);
    near(sums[1], 1.0, 1e-4);
    near(depth[0], 3.5, 1e-5);
    near(depth[1], 3.5, 1e-5);
    assert_eq!(candidates, 1);
    for (d, scene) in [(4.0, 3.5), (0.1, EMPTY)] {
        let (sums, depth, candidates) = middle(&bounds(d, scene));
        assert_eq!((sums[0], depth[1], candidates), (0.0, EMPTY, 1));
        near(sums[1], 1.0, 1e-4);
        near(depth[0], 0.875 * d, 1e-5);
    }
    let (sums, _, candidates) = middle(&bounds(4.0, 3.49));
    assert_eq!((sums, candidates), ([0.0; 2], 0));
}

#[test]
fn the_halton_points() {
    for (index, point) in [
        (1, [0.0, -1.0 / 3.0, -0.6]),
        (2, [-0.5, 1.0 / 3.0, -0.2]),
        (5, [0.25, 5.0 / 9.0, -0.92]),
        (6, [-0.25, -5.0 / 9.0, -0.52]),
    ] {
        near((halton(index) - DVec3::from(point)).length(), 0.0, 1e-12);
    }
    let points = points(512);
    assert!(points.len() == 512 && points.iter().all(|s| s.length() < 1.0));
    // Rounding decides for no point whether it is in the sphere.
    let all = (1..2000).map(|i| (halton(i).length() - 1.0).abs());
    assert!(all.fold(1.0, f64::min) > 1e-6);
}

/// Samples of equal weight are distributed as `lambda` says: the means of its powers over the
/// sphere are `B(k + 3, 3) / B(3, 3)`, and those of squares along an axis are a third of the
/// radius'. Each run of ten samples is nearly as good.
#[test]
fn pairs_lie_as_samples_count() {
    let pairs = pairs(160);
    let mean = |of: &dyn Fn(&DVec3) -> f64, all: &[DVec3]| {
        all.iter().map(of).sum::<f64>() / all.len() as f64
    };
    near(mean(&|s| s.length(), &pairs), 0.5, 2e-3);
    near(mean(&|s| s.length_squared(), &pairs), 2.0 / 7.0, 2e-3);
    for axis in 0..3 {
        near(mean(&|s| s[axis] * s[axis], &pairs), 2.0 / 21.0, 4e-3);
    }
    assert!(pairs.iter().all(|s| s.z >= 0.0 && s.length() < 1.0));
    // A sheet with limited reach occludes `(1 - z)^2` of one half.
    let hides = |s: &DVec3| 0.5 * (1.0 - s.z).powi(2);
    near(mean(&hides, &pairs), 25.0 / 84.0, 2e-3);
    for run in pairs.chunks(10) {
        near(mean(&hides, run), 25.0 / 84.0, 0.07);
    }
}

/// Occlusion at the middle of a flat opaque sheet of foam, with this number of samples.
fn sheet(samples: usize, reach: Reach) -> f64 {
    let view = square(65);
    let depth = 5.0;
    // Ten pixels in the first pass.
    let h = 10.0 / (8.0 * 32.5);
    let front = Image::new(65, 65, Some(Seen { depth, h, normal: DVec3::Z }));
    let (opacity, none) = (front.map(|_| 1.0), front.map(|_| EMPTY));
    let layers = Layers { front: &front, opacity: &opacity, fluid: &none, solid: &none };
    let settings =
        Occlusion { passes: 1, counts: [samples as f64; 2], reach, ..Occlusion::default() };
    let omega = settings.omega(&layers, &view, &points(samples + 1), (32, 32)).expect("foam");
    assert!(omega.low <= omega.value && omega.value <= omega.high);
    omega.value
}

/// With a reach of R, a sample at a distance of z R behind the sheet counts `(1 - z)^2`:
///
/// `2 pi int r^2 (1-r)^2 int_0^1 (1 - r mu)^2 dmu dr = 2 pi (B(3,3) - B(4,3) + B(5,3) / 3)`,
///
/// which is `2 pi 5/252`. Divided by `4 pi int r^2 (1-r)^2 dr = 4 pi / 30` it is 25/84.
#[test]
fn a_flat_sheet_hides_half() {
    let far = Reach::Radii(1e9);
    near(sheet(20_000, far), 0.5, 2e-3);
    near(sheet(20_000, Reach::Scene(1e9)), 0.5, 2e-3);
    near(sheet(20_000, Reach::Radii(1.0)), 25.0 / 84.0, 2e-3);
    near(sheet(512, far), 0.5, 0.02);
    // The value of these 16 samples.
    near(sheet(16, far), 0.2933, 1e-4);
    near(Occlusion::default().zeta(0.5), 0.30, 5e-3);
    near(Occlusion::default().zeta(0.1), 0.0, 0.0);
}

/// The normal found for foam that forms a tilted sheet, and the sheet's normal, both in world
/// space. The foam's spheres have another normal.
fn facing(slope: DVec2, opacity: f64, h: f64) -> (DVec3, DVec3) {
    let view = View { view: DMat4::from_rotation_x(0.4), ..square(129) };
    // A plane at depth 5 in the middle of the picture, with constant n . p.
    let depth = |x: usize, y: usize| 5.0 / (1.0 - slope.dot(view.ray(x, y).truncate()));
    let front =
        Image::from_fn(129, 129, |x, y| Some(Seen { depth: depth(x, y), h, normal: DVec3::X }));
    let (opacity, none) = (front.map(|_| opacity), front.map(|_| EMPTY));
    let layers = Layers { front: &front, opacity: &opacity, fluid: &none, solid: &none };
    let settings = Occlusion { counts: [20_000.0; 2], ..Occlusion::default() };
    let omega = settings.omega(&layers, &view, &points(20_001), (64, 64)).expect("foam");
    let (facing, _) = omega.facing(&view, h, (DVec3::X, 0.0));
    let eye = slope.extend(1.0).normalize();
    (facing, view.view.inverse().transform_vector3(eye))
}

#[test]
fn small_foam_faces_where_it_is_open() {
    // Spheres of half a pixel, whose samples reach four to eleven pixels.
    let h = 0.5 / 64.5;
    for slope in [DVec2::ZERO, DVec2::new(0.8, 0.0), DVec2::new(-0.3, 0.6)] {
        let (facing, sheet) = facing(slope, 1.0, h);
        // The mean of the visible samples differs from the mean of all by n/8, and the eye adds
        // 0.02: int r^3 (1-r)^2 dr = 1/60, over 1/30 is 1/2; the mean cosine of a hemisphere is
        // 1/2; and half of the samples are visible.
        let eye = DMat4::from_rotation_x(-0.4).transform_vector3(DVec3::Z);
        let expected = (sheet / 8.0 + 0.02 * eye).normalize();
        let angle = facing.angle_between(expected);
        assert!(angle < 0.02, "{slope}: {facing} of {expected}, {angle} apart");
    }
    // Transparent foam is open on all sides, so it faces the eye.
    let (facing_haze, sheet) = facing(DVec2::new(0.8, 0.0), 0.01, h);
    let eye = DMat4::from_rotation_x(-0.4).transform_vector3(DVec3::Z);
    assert!(facing_haze.angle_between(eye) < 0.2 * sheet.angle_between(eye), "{facing_haze}");
    // Large foam has its sphere's normal.
    let (large, _) = facing(DVec2::new(0.8, 0.0), 1.0, 2.0 / 64.5);
    near((large - DVec3::X).length(), 0.0, 1e-12);
}

#[test]
fn samples_go_by_the_pixels() {
    let settings = Occlusion::default();
    assert_eq!([0.0, 1.0, 1e3].map(|h_px| settings.samples(h_px)), [16, 16, 512]);
    // 4/3 pi 64 / 2 is 134.04.
    assert_eq!(settings.samples(4.0), 134);
    near(settings.search(0.5, 1), 4.0, 1e-15);
    near(settings.search(0.5, 3), 11.0, 1e-15);
    // A half is rounded up.
    assert_eq!(Occlusion { counts: [16.5, 16.5], ..settings }.samples(1.0), 17);
}

#[test]
fn occluders_add_up_to_one_and_count_where_they_are_seen() {
    let view = square(65);
    let settings = Occlusion { reach: Reach::Radii(1e9), ..Occlusion::default() };
    let points = points(513);
    let middle = |fluid: f64, solid: f64, opacity: f64, alone: bool| {
        let seen = Seen { depth: 5.0, h: 0.01, normal: DVec3::Z };
        let mut front = Image::new(65, 65, (!alone).then_some(seen));
        *front.at_mut(32, 32) = Some(seen);
        let [fluid, solid, opacity] = [fluid, solid, opacity].map(|v| Image::new(65, 65, v));
        let layers = Layers { front: &front, opacity: &opacity, fluid: &fluid, solid: &solid };
        let omega = |at| settings.omega(&layers, &view, &points, at);
        assert_eq!(omega((0, 0)).is_none(), alone);
        omega((32, 32)).expect("foam").value
    };
    let whole = middle(EMPTY, EMPTY, 1.0, false);
    near(middle(EMPTY, EMPTY, 0.25, false), 0.25 * whole, 1e-6);
    near(middle(5.0, EMPTY, 0.25, false), 0.75 * whole, 1e-6);
    near(middle(5.0, EMPTY, 0.75, false), whole, 1e-6);
    near(middle(5.0, 5.0, 0.0, false), whole, 1e-6);
    // The water lies before all samples, then behind all of them.
    near(middle(1.0, EMPTY, 0.0, false), 0.5, 1e-6);
    near(middle(9.0, 9.0, 0.0, false), 0.0, 1e-6);
    let one = middle(EMPTY, EMPTY, 1.0, true);
    assert!(one > 0.0 && one < 0.5 * whole, "{one} of {whole}");
}

#[test]
fn what_leaves_the_picture_does_not_count() {
    // The camera is so far away that perspective is weak; the spheres extend beyond the picture by
    // more than half.
    let view = view(DVec2::new(150.0, -150.0), DVec2::ZERO, 65, 65);
    let seen = Seen { depth: 5.0, h: 0.05, normal: DVec3::Z };
    let front = Image::new(65, 65, Some(seen));
    let (opacity, none) = (front.map(|_| 1.0), front.map(|_| EMPTY));
    let layers = Layers { front: &front, opacity: &opacity, fluid: &none, solid: &none };
    let settings =
        Occlusion { reach: Reach::Radii(1e9), counts: [512.0; 2], ..Occlusion::default() };
    let points = points(513);
    for at in [(0, 0), (0, 32), (64, 64)] {
        let omega = settings.omega(&layers, &view, &points, at).expect("foam");
        near(omega.value, 0.5, 0.05);
    }
    // Samples before the near plane do not count either; they would be visible, so the occluded
    // fraction increases.
    let view = square(65);
    let near_by = front.map(|_| Some(Seen { depth: 0.11, h: 0.6, normal: DVec3::Z }));
    let layers = Layers { front: &near_by, opacity: &opacity, fluid: &none, solid: &none };
    let settings = Occlusion { passes: 1, radii: [0.0, 1.0], ..settings };
    let omega = settings.omega(&layers, &view, &points, (32, 32)).expect("foam");
    assert!(omega.value > 0.6 && omega.value < 0.8, "{omega:?}");
}

#[test]
fn even_light_gives_a_half() {
    let view = View { view: DMat4::from_rotation_y(1.1), ..square(33) };
    let normal = DVec3::new(0.3, 0.8, -0.5).normalize();
    for (samples, by) in [(16, 0.15), (512, 0.01), (20_000, 1e-3)] {
        let found = irradiance_of(&points(samples), &view, normal, |_| DVec3::ONE);
        near(found.x, 0.5, by);
    }
    // With light only from above, the mean is that of a squared cosine, 1/3.
    let above = irradiance_of(&points(20_000), &view, normal, |dir| {
        assert!(dir.dot(normal) >= 0.0 && (dir.length() - 1.0).abs() < 1e-9);
        DVec3::new(dir.dot(normal), 0.0, 2.0)
    });
    near(above.x, 1.0 / 3.0, 1e-3);
    near(above.z, 1.0, 2e-3);

    let seen = Seen { depth: 5.0, h: 0.01, normal };
    let mut front = Image::new(33, 33, None);
    *front.at_mut(3, 4) = Some(seen);
    let settings = Occlusion::default();
    let image = irradiance(&front, &view, &settings, |_| DVec3::ONE);
    // 8 h is 1.32 pixels, for which the min number of samples is used.
    let expected = irradiance_of(&points(16), &view, normal, |_| DVec3::ONE);
    assert_eq!((image.at(3, 4), image.at(4, 4)), (Some(expected), None));
}

#[test]
fn a_blur_keeps_what_is_even_and_stops_at_gaps() {
    let view = square(64);
    let settings = Occlusion::default();
    // Kernel radii of 1.5 * 8 h 32: 7.7 pixels, and 77, which is limited to 32.
    for h in [0.02, 0.2] {
        let deep = |x: usize| if x < 32 { 5.0 } else { 9.0 };
        let front = Image::from_fn(64, 64, |x, y| {
            let seen = Seen { depth: deep(x), h, normal: DVec3::Z };
            ((x + y) % 3 > 0).then_some(seen)
        });
        let side = |x: usize| if x < 32 { [0.25, 1.0, 2.0, 3.0] } else { [0.5, 0.0, 8.0, -1.0] };
        let values = Image::from_fn(64, 64, |x, _| side(x));
        let found = blur(&values, &front, &view, &settings);
        for (x, y) in [(0, 0), (30, 2), (31, 31), (32, 32), (63, 61)] {
            for (found, expected) in found.at(x, y).into_iter().zip(side(x)) {
                near(found, expected, 1e-12);
            }
        }
    }
    // A single value in a flat sheet becomes a Gaussian along each axis, cut at the radius.
    let (h, size) = (0.02, 64);
    let front = Image::new(size, size, Some(Seen { depth: 5.0, h, normal: DVec3::Z }));
    let mut values = Image::new(size, size, [0.0; 4]);
    *values.at_mut(32, 32) = [1.0; 4];
    let found = blur(&values, &front, &view, &settings);
    let sigma = 0.75 * 8.0 * h * 32.0;
    let gauss = |i: f64| (-i * i / (2.0 * sigma * sigma)).exp();
    let all: f64 = (-7..=7).map(|i| gauss(f64::from(i))).sum();
    for (dx, dy) in [(0, 0), (3, 0), (0, 5), (7, 7)] {
        let expected = gauss(dx as f64) * gauss(dy as f64) / (all * all);
        near(found.at(32 + dx, 32 - dy)[0], expected, 1e-12);
    }
    assert_eq!(found.at(40, 32), [0.0; 4]);
    near(found.data.iter().map(|v| v[1]).sum(), 1.0, 1e-12);
    // A radius below one pixel changes nothing.
    let narrow = front.map(|seen| seen.map(|seen| Seen { h: 0.002, ..seen }));
    assert_eq!(blur(&values, &narrow, &view, &settings).data, values.data);
}

#[test]
fn intensity_and_picture() {
    assert_eq!(intensity(0.0, 3.0, 1.25), 0.0);
    near(intensity(1.0, 3.0, 1.25), 0.25, 1e-15);
    near(intensity(16.0, 3.0, 1.25), 32.0 / 35.0, 1e-12);
    near(intensity(3.0, 3.0, 1.0), 0.5, 1e-15);

    let dark = DVec3::new(0.0, 0.0, 0.2);
    near((zeta_final(0.5, dark) - DVec3::new(0.5, 0.5, 0.4)).length(), 0.0, 1e-15);
    assert_eq!(zeta_final(0.5, DVec3::splat(-3.0)), DVec3::ONE);
    let (back, light, scale) =
        (DVec3::new(1.0, 0.5, 0.0), DVec3::new(0.25, 1.0, 0.1), DVec3::splat(2.0));
    for composite in [composite_source, composite_hdr] {
        assert_eq!(composite(back, 0.0, 0.3, light, dark, scale), back);
    }
    // Light (0.5, 1, 0.2) or (0.5, 2, 0.2), shadow (0.5, 0.5, 0.4), opacity a half.
    let source = composite_source(back, 0.5, 0.5, light, dark, scale);
    near((source - DVec3::new(0.5, 0.5, 0.0)).length(), 0.0, 1e-12);
    let hdr = composite_hdr(back, 0.5, 0.5, light, dark, scale);
    near((hdr - DVec3::new(0.625, 0.75, 0.06)).length(), 0.0, 1e-12);
}
