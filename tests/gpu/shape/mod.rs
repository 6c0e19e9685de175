//! Compares pass `shape`, which finds an ellipsoid for each particle, and its depth and thickness
//! with CPU twins. Also checks the purpose of ellipsoids: sheets without holes, long streams, a
//! smooth surface, and as much water as with spheres.

use std::f64::consts::PI;

use ash::vk;
use glam::{DMat3, DVec2, DVec3};
use whitewater::water::{Ellipsoids, Kernels, Splat};
use whitewater::{Config, Count, LightVolume};

use crate::hostile::spoil;
use crate::invariants::{packet_bytes, same_drawn, scaled};
use crate::reference::depth::hit;
use crate::reference::shape::{self, Shape, eigen, norm, shapes};
use crate::reference::thickness::{J, kernel};
use crate::reference::{EMPTY, Image, Sphere, View, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, Rig, Shot, config, extent};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::support::tolerance::{Between, Sum, U, eye_space, ray_distance};

mod crowd;

const BOTH: [Splat; 2] = [Splat::Raster, Splat::Compute];

fn ellipsoids(size: vk::Extent2D, splat: Splat) -> Config {
    config(size).with(|it| {
        it.kernels = Kernels::Ellipsoids;
        it.depth_splat = Some(splat);
        it.thickness_splat = Some(splat);
        it.smoothing_level = 0;
        it.thickness_level = 0;
    })
}

/// An ellipsoid in eye space.
#[derive(Clone, Copy)]
struct Body {
    center: DVec3,
    radius: f64,
    /// Matrix from a ball of `radius` to the ellipsoid, and the error of its entries.
    axes: DMat3,
    off: f64,
}

/// Output of pass `shape`, in world space: centre, axes of water and of spray, and the sum of the
/// neighbours' weights.
fn all_left(drawn: &Drawn, shot: &Shot) -> Vec<(DVec3, [DMat3; 2], f64)> {
    let words = drawn.shapes.as_ref().expect("of ellipsoids");
    assert!(words.len() >= 10 * shot.positions.len(), "{} words", words.len());
    let each = words.chunks_exact(10).take(shot.positions.len());
    each.map(|w| {
        let center = DVec3::from([w[0], w[1], w[2]].map(|bits| f64::from(f32::from_bits(bits))));
        let axes = |w: &[u32]| {
            let half =
                |i: usize| f64::from((w[i / 2] >> (16 * (i % 2))) as u16 as i16) * 4.0 / 32767.0;
            let [xx, yy, zz, yz, xz, xy] = std::array::from_fn(half);
            let rows = [DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz)];
            DMat3::from_cols(rows[0], rows[1], rows[2])
        };
        (center, [axes(&w[3..6]), axes(&w[6..9])], f64::from(f32::from_bits(w[9])))
    })
    .collect()
}

/// Centre and axes of water.
fn left(drawn: &Drawn, shot: &Shot) -> Vec<(DVec3, DMat3)> {
    all_left(drawn, shot).into_iter().map(|(center, [water, _], _)| (center, water)).collect()
}

/// The axes of spray, and the sum of the neighbours' weights.
pub fn of_spray(drawn: &Drawn, shot: &Shot) -> Vec<(DMat3, f64)> {
    all_left(drawn, shot).into_iter().map(|(_, [_, spray], crowd)| (spray, crowd)).collect()
}

/// The ellipsoids in eye space, as pass `cull` stores them: rotated, and rounded to 16 bits again.
fn bodies(drawn: &Drawn, shot: &Shot) -> Vec<Body> {
    let view = shot.camera_view();
    let turn = DMat3::from_mat4(view);
    let body = |(center, axes)| Body {
        center: view.transform_point3(center),
        radius: f64::from(shot.settings.water.radius()),
        axes: turn * axes * turn.transpose(),
        // Half a step in each of nine entries, and two products.
        off: 3.0 * 0.5 * 4.0 / 32767.0 + 32.0 * U * norm(&axes),
    };
    left(drawn, shot).into_iter().map(body).collect()
}

fn twin_settings(shot: &Shot) -> shape::Settings {
    let Ellipsoids { reach, ratio, fewest, lone, centred } = shot.settings.water.ellipsoids;
    shape::Settings {
        reach: f64::from(reach * shot.settings.water.spacing),
        ratio: ratio.into(),
        fewest: fewest.into(),
        lone: lone.into(),
        centred: centred.into(),
        strand: shot.settings.spray.strand_ratio.into(),
    }
}

/// The positions in double precision.
fn world(shot: &Shot) -> Vec<DVec3> {
    shot.positions.iter().map(|p| DVec3::from(p.map(f64::from))).collect()
}

/// World positions of a lattice whose distance is the particle spacing. `middle` is its centre as
/// (x, y, depth) of the eye, `turn` its rotation, `steps` the number of points to each side.
pub fn lattice(shot: &Shot, middle: [f32; 3], turn: DMat3, steps: [i32; 3]) -> Vec<[f32; 3]> {
    let spacing = f64::from(shot.settings.water.spacing);
    let at = DVec3::from(scenes::world(&shot.camera, &[middle])[0].map(f64::from));
    let range = |i: usize| -steps[i]..=steps[i];
    let all = range(2).flat_map(|z| range(1).flat_map(move |y| range(0).map(move |x| (x, y, z))));
    let place = |(x, y, z): (i32, i32, i32)| turn * DVec3::new(x.into(), y.into(), z.into());
    all.map(|step| (at + spacing * place(step)).as_vec3().to_array()).collect()
}

/// The eye's axes in world space: a sheet in its x and y faces the eye.
pub fn facing(shot: &Shot) -> DMat3 {
    DMat3::from_mat4(shot.camera_view()).transpose()
}

pub fn askew() -> DMat3 {
    DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.7)
}

/// A cloud, a sheet, a stream and a block.
fn mixed(size: vk::Extent2D, lens: Lens) -> Shot {
    let mut shot = Shot::new(size, lens, 0.1, &scenes::cloud(5, 500, 2.0, 9.0));
    for (middle, steps) in
        [([-1.0, 0.3, 4.0], [6, 6, 0]), ([0.7, 0.5, 3.5], [9, 0, 0]), ([0.4, -0.8, 4.0], [3, 3, 3])]
    {
        shot.positions.extend(lattice(&shot, middle, askew(), steps));
    }
    shot
}

#[test]
fn shapes_are_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(32, 24);
    let mut rig = Rig::new(&gpu, &ellipsoids(size, Splat::Compute));
    let usual = Ellipsoids::default();
    let cases = [
        ("default", usual, 1.0),
        ("wide", Ellipsoids { reach: 3.3, ..usual }, 4.0),
        ("flat", Ellipsoids { ratio: 8.0, ..usual }, 8.0),
        ("round", Ellipsoids { ratio: 1.0, ..usual }, 6.0),
        ("source", Ellipsoids { fewest: 6.0, lone: 0.5, ..usual }, 2.5),
        ("in place", Ellipsoids { centred: 0.0, ..usual }, 6.0),
        ("any", Ellipsoids { fewest: 0.0, centred: 1.0, lone: 0.25, ..usual }, 1.5),
    ];
    for (name, settings, strand) in cases {
        let mut shot = mixed(size, Lens::Standard);
        shot.settings.water.ellipsoids = settings;
        shot.settings.spray.strand_ratio = strand;
        // A lone particle, and two particles so close together that their variance is 0.
        shot.positions.extend(scenes::world(&shot.camera, &[[-9.0, 9.0, 12.0], [9.0, 9.0, 12.0]]));
        let [x, y, z] = shot.positions[shot.positions.len() - 1];
        shot.positions.push([x + 1.0e-5, y, z]);
        let drawn = rig.draw(&shot);
        let positions = world(&shot);
        let (mut worst, mut slack): (f64, Vec<f64>) = (0.0, Vec::new());
        let (mut sprays, mut crowds) = (Vec::new(), Vec::new());
        let expected = shapes(&positions, &twin_settings(&shot));
        for (i, (found, expected)) in all_left(&drawn, &shot).into_iter().zip(expected).enumerate()
        {
            let Shape { center, axes, spray, crowd, off } = expected;
            let [water, of_spray] = found.1;
            let (moved, turned) = ((found.0 - center).length(), norm(&(water - axes)));
            let apart = norm(&(of_spray - spray));
            assert!(apart <= off[2], "{name} {i}: {apart} of {}: {of_spray}, not {spray}", off[2]);
            sprays.push(off[2]);
            crowds.push(off[3]);
            let many = (found.2 - crowd).abs();
            assert!(many <= off[3], "{name} {i}: {many} of {}: {}, not {crowd}", off[3], found.2);
            assert!(
                moved <= off[0],
                "{name} {i}: {moved} of {}: {}, not {center}",
                off[0],
                found.0
            );
            assert!(turned <= off[1], "{name} {i}: {turned} of {}: {}, not {axes}", off[1], water);
            worst = worst.max(turned / off[1]);
            slack.push(off[1]);
        }
        let medians = [slack, sprays, crowds].map(|mut all| {
            all.sort_by(f64::total_cmp);
            all[all.len() / 2]
        });
        let median = medians.into_iter().fold(0.0, f64::max);
        if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
            eprintln!("{name}: worst {worst:.2} of its slack, whose median is {median:.1e}");
        }
        assert!(median < 0.01, "{name}: {median} says nothing");
    }
}

/// Distance at which the ray hits the ellipsoid, with its radius changed by `more`.
fn hit_body(ray: DVec3, body: &Body, inverse: &DMat3, more: f64) -> Option<f64> {
    let radius = (body.radius + more).max(0.0);
    hit(*inverse * ray, &Sphere { center: *inverse * body.center, radius })
}

/// Bounds of the depth. The test intersects the sphere that the ellipsoid's inverse matrix gives:
/// errors of the centre grow by the inverse's norm, and the surface adds the error of the axes.
fn depth_bounds(bodies: &[Body], view: &View) -> Between {
    let near = view.near();
    let mut low = Image::new(view.width, view.height, EMPTY);
    let mut high = low.clone();
    for body in bodies {
        let inverse = body.axes.inverse();
        let (least, most) = (norm(&inverse), norm(&body.axes));
        let d = least * (ray_distance(body.center, view) + body.off * body.radius);
        let slack = d * most + 8.0 * U * (body.center.length() + body.radius);
        let reach = (body.radius + d) * most;
        if -body.center.z + reach < near {
            continue;
        }
        let z = -body.center.z;
        let half = DVec2::splat(reach);
        let (columns, rows) = view.footprint(body.center.truncate(), half, z - reach, z + reach);
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let ray = view.ray(x, y);
            let Some(nearest) = hit_body(ray, body, &inverse, d).map(|t| t - slack) else {
                continue;
            };
            let farthest = hit_body(ray, body, &inverse, -d).map(|t| t + slack);
            let inner =
                (inverse * ray).dot(inverse * body.center) / (inverse * ray).length_squared();
            let latest = farthest.unwrap_or(inner + slack);
            if latest >= near * (1.0 - 8.0 * U) {
                let pixel = low.at_mut(x, y);
                *pixel = pixel.min(nearest.max(near * (1.0 - 8.0 * U)));
            }
            if let Some(farthest) = farthest.filter(|_| nearest >= near * (1.0 + 8.0 * U)) {
                let pixel = high.at_mut(x, y);
                *pixel = pixel.min(farthest);
            }
        }
    }
    Between { low, high }
}

#[test]
fn depth_is_the_nearest_ellipsoid_through_every_lens() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for splat in BOTH {
        let mut rig = Rig::new(&gpu, &ellipsoids(size, splat));
        for lens in LENSES {
            let mut shot = mixed(size, lens);
            shot.positions.extend(scenes::world(&shot.camera, &scenes::cloud(9, 60, 0.0, 0.5)));
            let drawn = rig.draw(&shot);
            let bounds = depth_bounds(&bodies(&drawn, &shot), &shot.view(size));
            compare::between(&format!("shape-depth-{lens:?}-{splat:?}"), &drawn.depth, &bounds);
        }
    }
}

/// Ellipsoids so wide that one covers cells of image `front`. Pass `cull` drops only those that
/// cannot be visible.
#[test]
fn what_is_left_out_does_not_show() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for splat in BOTH {
        let mut rig = Rig::new(&gpu, &ellipsoids(size, splat));
        for (radius, seed) in [(0.5, 3), (0.35, 4)] {
            let shot =
                Shot::new(size, Lens::Standard, radius, &scenes::cloud(seed, 1500, 3.0, 9.0));
            let drawn = rig.draw(&shot);
            assert!(drawn.work.front < drawn.work.visible * 4 / 5, "{:?}", drawn.work);
            let bounds = depth_bounds(&bodies(&drawn, &shot), &shot.view(size));
            compare::between(&format!("shape-front-{radius}-{splat:?}"), &drawn.depth, &bounds);
        }
    }
}

#[test]
fn raster_and_compute_agree() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let shot = mixed(size, Lens::Standard);
    let [raster, compute] = BOTH.map(|splat| Rig::new(&gpu, &ellipsoids(size, splat)).draw(&shot));
    // Both pictures lie within the twin's bounds, cover the same pixels, and are close.
    let bounds = depth_bounds(&bodies(&raster, &shot), &shot.view(size));
    compare::between("shape-agree-raster", &raster.depth, &bounds);
    compare::between("shape-agree-compute", &compute.depth, &bounds);
    let pairs = raster.depth.data.iter().zip(&compute.depth.data);
    let off = |(a, b): (&f32, &f32)| (a - b).abs() / a;
    assert!(pairs.map(off).fold(0.0, f32::max) < 1.0e-3);
}

/// Twin of the thickness sprite: the projection of the ellipsoid along the ray through its centre.
/// rho is the distance of a pixel's line from the centre in the space where the ellipsoid is a
/// ball. The ball's projection along w has area pi det(axes) |axes^-1 w| on a plane with w.z = 1.
///
/// Rounding of a sum in single precision grows with the number of addends; in fixed point each is
/// rounded to `unit`.
fn thickness_bounds(bodies: &[Body], view: &View, volume: f64, unit: f64) -> Between {
    let mut low = Image::new(view.width, view.height, 0.0);
    let mut high = low.clone();
    let mut count = low.clone();
    for body in bodies {
        let depth = -body.center.z;
        let inverse = body.axes.inverse();
        let along = inverse * (body.center / depth);
        let whole = 2.0 * body.radius;
        let area = PI * whole * whole * body.axes.determinant() * along.length();
        let off = norm(&inverse) * body.off;
        let flat = norm(&body.axes).powi(3) / body.axes.determinant();
        let uncertain = norm(&inverse) * ray_distance(body.center, view) / whole + 2.0 * off;
        let reach = whole * norm(&body.axes) * body.center.length() / depth;
        if depth < view.near() * (1.0 + 8.0 * U) + eye_space(body.center, view) {
            continue;
        }
        let half = DVec2::splat(1.1 * reach);
        let (columns, rows) = view.footprint(body.center.truncate(), half, depth, depth);
        for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
            let from = inverse * (view.ray(x, y) * depth - body.center);
            let rho = (from - along * (from.dot(along) / along.length_squared())).length() / whole;
            let at = |rho: f64| kernel((rho * rho).min(1.0)) * volume / (J * area);
            // Kernel and amplitude add 40u, as for spheres; the determinant 8u of its terms.
            let slack = (1.0 + 6.0 * off) * (1.0 + (40.0 + 8.0 * flat) * U);
            let most = at((rho - uncertain).max(0.0)) * slack;
            *low.at_mut(x, y) += at(rho + uncertain) / slack;
            *high.at_mut(x, y) += most;
            *count.at_mut(x, y) += if most > 0.0 { 1.0 } else { 0.0 };
        }
    }
    for ((low, high), n) in low.data.iter_mut().zip(&mut high.data).zip(&count.data) {
        let (sum, rounded) = ((n + 4.0) * U, 0.5 * n * unit);
        *low = (*low - rounded) * (1.0 - sum);
        *high = (*high + rounded) * (1.0 + sum);
    }
    Between { low, high }
}

#[test]
fn thickness_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for splat in BOTH {
        let mut rig = Rig::new(&gpu, &ellipsoids(size, splat));
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            let mut shot = mixed(size, lens);
            // No sprite is narrower than a pixel or so near that it is cut.
            shot.settings.water.ellipsoids.ratio = 3.0;
            let drawn = rig.draw(&shot);
            let volume = f64::from(shot.settings.water.spacing).powi(3);
            let unit = match splat {
                Splat::Compute => shot.splats(&[], 0, Sum::Fixed).unit(),
                _ => 0.0,
            };
            let bounds = thickness_bounds(&bodies(&drawn, &shot), &shot.view(size), volume, unit);
            let name = format!("shape-thickness-{lens:?}-{splat:?}");
            compare::between(&name, &drawn.thickness, &bounds);
            assert!(drawn.thickness.data.iter().any(|t| *t > 0.0), "{name}: there is water");
        }
    }
}

/// A block, a sheet and a stream hold as much water with ellipsoids as with spheres, also at a
/// distance where a sprite is smaller than a pixel. A sum over pixels approximates the integral of
/// sprites of several pixels to a hundredth, and of a few tiny ones to a tenth, because they cover
/// few texel centres.
#[test]
fn there_is_as_much_water_as_with_spheres() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for (splat, level) in BOTH.into_iter().flat_map(|splat| [0, 2].map(|level| (splat, level))) {
        let config = ellipsoids(size, splat).with(|it| it.thickness_level = level);
        let round = config.with(|it| it.kernels = Kernels::Spheres);
        let [mut rig, mut round] = [config, round].map(|config| Rig::new(&gpu, &config));
        for (depth, steps) in [4.0_f32, 60.0]
            .into_iter()
            .flat_map(|d| [[4, 4, 4], [9, 9, 0], [9, 0, 0]].map(|s| (d, s)))
        {
            let mut shot = Shot::new(size, Lens::Standard, 0.06, &[]);
            shot.positions = lattice(&shot, [0.0, 0.0, depth], askew(), steps);
            let [found, expected] = [&mut rig, &mut round].map(|rig| -> f64 {
                rig.draw(&shot).thickness.data.into_iter().map(f64::from).sum()
            });
            let off = found / expected - 1.0;
            let most = if depth < 5.0 { 0.02 } else { 0.1 };
            assert!(off.abs() < most, "{splat:?} {level} {depth} {steps:?}: {off}");
        }
    }
}

/// A sheet of one layer that faces the eye. The variance across it is 0, so its ellipsoids are 1 :
/// 1 : 1/4, and with r = 0.656 spacings the half-axes are 1.041 and 0.260 spacings. The surface
/// lies 0.260 before the sheet at particles, and 0.191 at the lattice's farthest points, 0.707
/// away. So depths differ by at most 0.07 spacings, where spheres leave holes.
#[test]
fn a_sheet_has_no_holes_and_is_flat() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    for splat in BOTH {
        let mut shot = Shot::new(size, Lens::Standard, 0.2, &[]);
        shot.settings.water.ellipsoids.ratio = 4.0;
        let (spacing, far) = (shot.settings.water.spacing, 4.0);
        shot.positions = lattice(&shot, [0.0, 0.0, far], facing(&shot), [18, 14, 0]);
        let drawn = Rig::new(&gpu, &ellipsoids(size, splat)).draw(&shot);
        let round = ellipsoids(size, splat).with(|it| it.kernels = Kernels::Spheres);
        let spheres = Rig::new(&gpu, &round).draw(&shot);
        // Here all neighbours of all neighbours exist.
        let inside = |x: usize, y: usize| {
            let at = shot.view(size).ray(x, y).truncate() * f64::from(far / spacing);
            at.x.abs() < 11.0 && at.y.abs() < 7.0
        };
        let pixels = (0..64).flat_map(|y| (0..96).map(move |x| (x, y)));
        let (mut least, mut most, mut holes, mut count) = (f32::MAX, f32::MIN, 0, 0);
        for (x, y) in pixels.filter(|(x, y)| inside(*x, *y)) {
            let above = (far - drawn.depth.at(x, y)) / spacing;
            (least, most) = (least.min(above), most.max(above));
            holes += usize::from(!is_surface(spheres.depth.at(x, y).into()));
            count += 1;
        }
        assert!(count > 2000, "{count}");
        // Perspective shifts the particles by up to a third of their height above the sheet.
        assert!(least > 0.18 && most < 0.27, "{splat:?}: {least} to {most}");
        assert!(holes > 5, "{holes}");
    }
}

/// A stream has long ellipsoids, nearly 1 : 1/4 : 1/4.
#[test]
fn a_stream_is_long() {
    let gpu = Gpu::shared();
    let size = extent(96, 64);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    let ellipsoids_of = &mut shot.settings.water.ellipsoids;
    (ellipsoids_of.ratio, ellipsoids_of.fewest) = (4.0, 3.0);
    let turn = facing(&shot);
    shot.positions = lattice(&shot, [0.0, 0.0, 4.0], turn, [8, 0, 0]);
    let drawn = Rig::new(&gpu, &ellipsoids(size, Splat::Compute)).draw(&shot);
    let direction = turn * DVec3::X;
    for (i, (_, axes)) in left(&drawn, &shot).into_iter().enumerate().skip(2).take(13) {
        let along = (axes * direction).dot(direction);
        let (values, _) = eigen(axes);
        let thin = values.min_element();
        // The neighbours' weights sum to 2.85, which is 0.9 of the way from 1.5 to 3; smoothstep
        // gives an exponent of 0.972.
        assert!((along / thin - 4.0_f64.powf(0.972)).abs() < 0.02, "{i}: {along} {thin}");
        assert!((along * thin * thin - 1.0).abs() < 0.01, "{i}");
    }
}

/// Inside a block, neighbours are equally distributed, so ellipsoids are spheres. Checked for the
/// 27 inner particles.
#[test]
fn inside_the_water_it_is_round() {
    let gpu = Gpu::shared();
    let size = extent(32, 24);
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    shot.positions = lattice(&shot, [0.0, 0.0, 4.0], askew(), [4, 4, 4]);
    let drawn = Rig::new(&gpu, &ellipsoids(size, Splat::Compute)).draw(&shot);
    let inner = |i: &usize| [i % 9, i / 9 % 9, i / 81].iter().all(|k| (3..6).contains(k));
    let all = left(&drawn, &shot);
    let mut count = 0;
    for (i, (_, axes)) in all.into_iter().enumerate().filter(|(i, _)| inner(i)) {
        assert!(norm(&(axes - DMat3::IDENTITY)) < 0.01, "{i}: {axes}");
        count += 1;
    }
    assert_eq!(count, 27);
}

/// Centring reduces the distances of particles from their sheet by more than half. The middles of a
/// block's sides move by less than a fifth of a spacing; moving fully to their neighbours' mean
/// would be 0.7 spacings.
#[test]
fn centring_smooths_a_sheet_and_keeps_a_block() {
    let gpu = Gpu::shared();
    let size = extent(32, 24);
    let mut rig = Rig::new(&gpu, &ellipsoids(size, Splat::Compute));
    let mut shot = Shot::new(size, Lens::Standard, 0.1, &[]);
    let (turn, spacing) = (facing(&shot), f64::from(shot.settings.water.spacing));
    let (across, mut random) = ((turn * DVec3::Z).as_vec3(), Random(4));
    let flat = lattice(&shot, [0.0, 0.0, 4.0], turn, [12, 12, 0]);
    let moved = |p: &[f32; 3]| {
        (glam::Vec3::from(*p) + across * random.between(-0.25, 0.25) * spacing as f32).to_array()
    };
    shot.positions = flat.iter().map(moved).collect();
    let inner = |i: &usize| (5..20).contains(&(i % 25)) && (5..20).contains(&(i / 25));
    let off = |points: &[DVec3]| -> f64 {
        let each = points.iter().zip(&flat).enumerate().filter(|(i, _)| inner(i));
        let normal = turn * DVec3::Z;
        each.map(|(_, (p, f))| (*p - DVec3::from(f.map(f64::from))).dot(normal).powi(2)).sum()
    };
    let before: Vec<_> = shot.positions.iter().map(|p| DVec3::from(p.map(f64::from))).collect();
    let after: Vec<_> = left(&rig.draw(&shot), &shot).into_iter().map(|(p, _)| p).collect();
    let less = (off(&after) / off(&before)).sqrt();
    assert!(less < 0.5, "{less}");

    shot.positions = lattice(&shot, [0.0, 0.0, 4.0], turn, [6, 6, 6]);
    let after = left(&rig.draw(&shot), &shot);
    // The middles of four sides of the block.
    for i in [6 * 13 + 6, 12 * 169 + 6 * 13 + 6, 6 * 169 + 6, 6 * 169 + 12 * 13 + 6] {
        let there = DVec3::from(shot.positions[i].map(f64::from));
        let gone = (after[i].0 - there).length() / spacing;
        assert!(gone < 0.2, "{i}: {gone}");
    }
}

#[test]
fn the_order_of_the_particles_is_no_matter() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let mut rig = Rig::new(&gpu, &ellipsoids(size, Splat::Compute));
    let shot = mixed(size, Lens::Standard);
    let order = Random(3).order(shot.positions.len());
    let positions = order.iter().map(|i| shot.positions[*i]).collect();
    let first = rig.draw(&shot);
    let second = rig.draw(&Shot { positions, ..shot });
    same_drawn("shape-order", &second, &first);
}

#[test]
fn the_unit_of_length_does_not_show() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let mut rig = Rig::new(&gpu, &ellipsoids(size, Splat::Compute));
    let shot = mixed(size, Lens::Infinite);
    // Scaling by a power of two changes no rounding.
    let larger = scaled(&shot, 16.0);
    let [first, second] = [&shot, &larger].map(|shot| rig.draw(shot));
    let axes = |drawn: &Drawn, shot: &Shot| -> Vec<DMat3> {
        left(drawn, shot).into_iter().map(|(_, axes)| axes).collect()
    };
    assert_eq!(axes(&first, &shot), axes(&second, &larger));
    for (a, b) in first.depth.data.iter().zip(&second.depth.data) {
        assert!(*a >= 1.0e9 && *b >= 1.0e9 || a * 16.0 == *b, "{a} {b}");
    }
}

/// A count on the GPU, packets and chunks do not change the picture.
#[test]
fn counts_packets_and_chunks_do_not_show() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let config = ellipsoids(size, Splat::Compute);
    let mut rig = Rig::new(&gpu, &config);
    let shot = mixed(size, Lens::Standard);
    let expected = rig.draw(&shot);
    let cloud = rig.particles(&shot);
    let plain = cloud.particles();
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let n = cloud.count;
    // The second count is larger than the stream, which limits it.
    for count in [n, n + 1000] {
        let counted = rig.stub.data(&count.to_le_bytes(), usage);
        let count = Count::Gpu { buffer: counted.buffer, offset: 0 };
        let drawn = rig.draw_particles(&shot, &plain.with(|it| it.count = count));
        same_drawn("shape-count", &drawn, &expected);
    }
    let ranges = [(0, n / 2), (n / 2, n - n / 2)];
    let packets = rig.stub.data(&packet_bytes(&shot, &ranges), usage);
    let packets = whitewater::Packets { buffer: packets.buffer, offset: 0, count: 2 };
    let drawn = rig.draw_particles(&shot, &plain.with(|it| it.packets = Some(packets)));
    same_drawn("shape-packets", &drawn, &expected);
    // With this stride the device binds few particles at a time.
    let max_stride = 1 << 19;
    let mut rig = Rig::new(&gpu, &config.with(|it| it.max_stride = max_stride));
    let drawn = rig.draw(&shot);
    same_drawn("shape-chunks", &drawn, &expected);
}

/// A frame with two sheets, spray and light maps ends and has finite results, whatever the bits of
/// the positions.
#[test]
fn hostile_positions_end() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    for splat in BOTH {
        let config = ellipsoids(size, splat).with(|it| {
            it.sheets = 2;
            it.light_map_size = Some(64);
            it.spray = true;
        });
        let mut rig = Rig::new(&gpu, &config);
        let mut shot = mixed(size, Lens::Standard);
        let center = scenes::world(&shot.camera, &[[0.0, 0.0, 5.0]])[0];
        shot.light_volume = Some(LightVolume { center, radius: 6.0 });
        let on_one_spot = vec![shot.positions[3]; 1500];
        let in_a_line = (0..700).map(|i| [i as f32 * 1.0e-20, 2.0, 0.0]).collect();
        let far = shot.positions.iter().map(|p| p.map(|x| x * 1.0e17)).collect();
        let mut words: Vec<u32> = bytemuck::cast_slice(&shot.positions).to_vec();
        spoil(&mut words, 3, &mut Random(8));
        let spoiled = bytemuck::cast_slice(&words).to_vec();
        for (name, positions) in
            [("one spot", on_one_spot), ("line", in_a_line), ("far", far), ("spoiled", spoiled)]
        {
            let drawn = rig.draw(&Shot { positions, ..shot.clone() });
            let finite = drawn.output.data.iter().flatten().all(|c| c.is_finite());
            assert!(finite && drawn.thickness.data.iter().all(|t| t.is_finite()), "{name}");
        }
    }
}

/// Particles with invalid positions are dropped and counted, and do not change the others.
#[test]
fn strays_do_no_harm() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let mut rig = Rig::new(&gpu, &ellipsoids(size, Splat::Compute));
    let shot = mixed(size, Lens::Standard);
    let expected = rig.draw(&shot);
    let mut more = shot.clone();
    more.positions.extend([[f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0], [1.0e19, 0.0, 0.0]]);
    let drawn = rig.draw(&more);
    assert_eq!(drawn.work.dropped, 3);
    assert_eq!(drawn.depth.data, expected.depth.data);
    assert_eq!(drawn.thickness.data, expected.thickness.data);
}

/// Each setting changes the picture.
#[test]
fn every_setting_shows() {
    let gpu = Gpu::shared();
    let size = extent(64, 48);
    let mut rig = Rig::new(&gpu, &ellipsoids(size, Splat::Compute));
    let shot = mixed(size, Lens::Standard);
    let before = rig.draw(&shot).depth.data;
    type Change = (&'static str, fn(&mut Ellipsoids));
    let changes: [Change; 5] = [
        ("reach", |e| e.reach = 2.0),
        ("ratio", |e| e.ratio = 3.0),
        ("fewest", |e| e.fewest = 6.0),
        ("lone", |e| e.lone = 0.5),
        ("centred", |e| e.centred = 0.5),
    ];
    for (name, change) in changes {
        let mut other = shot.clone();
        change(&mut other.settings.water.ellipsoids);
        assert!(rig.draw(&other).depth.data != before, "{name} does nothing");
    }
    // With spheres, settings of ellipsoids change nothing.
    let mut rig =
        Rig::new(&gpu, &ellipsoids(size, Splat::Compute).with(|it| it.kernels = Kernels::Spheres));
    let before = rig.draw(&shot).depth.data;
    let mut other = shot.clone();
    other.settings.water.ellipsoids.ratio = 3.0;
    assert_eq!(rig.draw(&other).depth.data, before);
    assert!(before != Rig::new(&gpu, &ellipsoids(size, Splat::Compute)).draw(&shot).depth.data);
}

/// The pass reports its GPU time.
#[test]
fn its_time_is_told() {
    let gpu = Gpu::shared();
    let size = extent(32, 24);
    let mut rig = Rig::new(&gpu, &ellipsoids(size, Splat::Compute));
    let shot = mixed(size, Lens::Standard);
    rig.draw(&shot);
    rig.draw(&shot);
    let names: Vec<_> =
        rig.renderer().timings(whitewater::Slot(0)).iter().map(|t| t.name).collect();
    assert!(names.contains(&"shape"), "{names:?}");
}
