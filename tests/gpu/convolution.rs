//! Compares the basis images of pass `convolution` with the CPU twin and the picture with these
//! images, and checks properties that every filtered shadow comparison has.

use std::sync::OnceLock;

use ash::vk;
use glam::{DVec3, Mat4, Vec3};
use whitewater::water::{Convolution, Shading, ShadowFilter, Shadows};
use whitewater::{Config, LightVolume, Shadow};

use crate::light::{SIZE, casting, check_foam, light_views, shadows, wall};
use crate::reference::Image;
use crate::reference::convolution::{Convolved, Filter, Pages};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::host::Texture;
use crate::support::rig::{Drawn, Rig, extent};
use crate::support::scenes::{self, Lens, Random};
use crate::support::slow;
use crate::surface_foam::Foamy;

/// A configuration without a light map.
fn convolving(convolution: Convolution) -> Config {
    let shadow = Some(Shadows::Convolution(convolution));
    casting(16).with(|it| {
        it.light_map_size = None;
        it.shadow = shadow;
        it.thickness_level = 0;
    })
}

fn filter(convolution: Convolution, settings: &ShadowFilter) -> Filter {
    let Convolution { terms, texels, bits } = convolution;
    Filter {
        terms: terms as usize,
        texels: texels as usize,
        bits: bits as usize,
        width: f64::from(settings.width),
        damping: f64::from(settings.damping),
        offset: f64::from(settings.offset),
        scale: f64::from(settings.scale),
    }
}

/// A wall of foam, with the sun behind the eye and to its side. Returns also the light's target and
/// the direction to the sun.
fn lit_wall() -> (Foamy, Vec3, Vec3) {
    let mut case = wall(Lens::Standard);
    let [at, from] = [[0.1, 0.1, 2.0], [0.5, 0.7, 0.5]]
        .map(|p| Vec3::from(scenes::world(&case.shot.camera, &[p])[0]));
    let sun = (from - at).normalize();
    case.shot.settings.light.direction = sun.to_array();
    (case, at, sun)
}

/// A shadow map that is a part of a larger image.
struct Map {
    part: Image<f32>,
    view_projection: Mat4,
    bias: f32,
    reversed: bool,
    _image: Texture,
}

impl Map {
    /// Surrounds `part` by texels of another depth, which must not be used.
    fn new(
        rig: &Rig<'_>,
        case: &mut Foamy,
        part: Image<f32>,
        (view_projection, reversed): (Mat4, bool),
        bias: f32,
    ) -> Self {
        let (w, h) = (part.width, part.height);
        let whole = Image::from_fn(w + 3, h + 5, |x, y| {
            if (1..=w).contains(&x) && (2..h + 2).contains(&y) {
                part.at(x - 1, y - 2)
            } else {
                0.4
            }
        });
        let image = shadows(rig, Shadows::Map, &whole);
        let mut host = image.host_image();
        host.rect.offset = vk::Offset2D { x: 1, y: 2 };
        host.rect.extent = extent(w as u32, h as u32);
        case.shot.shadow =
            Some(Shadow::new(host, view_projection.to_cols_array_2d()).with(|it| it.bias = bias));
        Self { part, view_projection, bias, reversed, _image: image }
    }

    fn twin(&self, case: &Foamy, convolution: Convolution) -> Convolved<'_> {
        Convolved {
            depth: &self.part,
            view_projection: self.view_projection.as_dmat4(),
            bias: f64::from(self.bias),
            sun: Vec3::from(case.shot.settings.light.direction).as_dvec3(),
            reversed: self.reversed,
            filter: filter(convolution, &case.shot.settings.shadow),
            found: OnceLock::new(),
        }
    }
}

fn pages(drawn: &Drawn) -> &Pages {
    drawn.shadow_basis.as_ref().expect("a basis")
}

/// Checks that the basis images with their borders are the twin's. Returns the max error as a
/// fraction of its bound.
fn check_basis(name: &str, twin: &Convolved<'_>, pages: &Pages) -> f64 {
    let (_, [width, height]) = twin.size();
    let mut worst = 0.0_f64;
    for k in 1..=twin.filter.terms {
        let (expected, bound) = (twin.basis(k), twin.basis_error(k));
        let [left, top] = twin.corner((k - 1) / 2);
        for (x, y) in (0..height + 2).flat_map(|y| (0..width + 2).map(move |x| (x, y))) {
            let found = pages.at(left + x - 1, top + y - 1);
            for i in 0..2 {
                let found = f64::from(found[2 * ((k - 1) % 2) + i]);
                let expected = expected.clamped(x as isize - 1, y as isize - 1)[i];
                let error = (found - expected).abs();
                assert!(
                    error <= bound,
                    "{name}: term {k} at ({x}, {y}), {i}: {found}, not {expected} by {bound}"
                );
                worst = worst.max(error / bound);
            }
        }
    }
    worst
}

/// Blocks in shade and in sun, texels at random depths between, and empty ones.
fn blocks(width: usize, height: usize, [before, behind]: [f32; 2], open: f32) -> Image<f32> {
    let mut random = Random(4);
    let (low, high) = (before.min(behind), before.max(behind));
    let mut texels = Image::new(width, height, open);
    for (i, texel) in texels.data.iter_mut().enumerate() {
        *texel = match (i % width / 6 + i / width / 5) % 4 {
            0 => before,
            1 => behind,
            2 => open,
            _ => random.between(low, high),
        };
    }
    texels
}

#[test]
fn the_basis_is_the_twins_and_foam_is_in_its_shade() {
    let gpu = Gpu::shared();
    let bits_between = gpu.limits().sub_texel_precision_bits;
    let ways = [(4, 64, 8), (8, 64, 16), (16, 16, 8), (16, 64, 16)];
    for (i, (terms, texels, bits)) in ways.into_iter().enumerate() {
        let convolution = Convolution { terms, texels, bits };
        let mut rig = Rig::lit(&gpu, &convolving(convolution), 1);
        let (mut case, at, sun) = lit_wall();
        for (j, (name, view_projection, reversed)) in light_views(sun, at).into_iter().enumerate() {
            let depth = |along: f32| view_projection.project_point3(at + along * sun).z;
            let ends = [depth(0.6), depth(-0.6)];
            let open = if reversed { 0.0 } else { 1.0 };
            case.shot.settings.shadow = ShadowFilter::default().with(|it| {
                it.width = [0.0, 3.0, 7.5, 4.0][(i + j) % 4];
                it.damping = [1.0, 0.0, 2.0, 0.5][j];
                it.offset = [1.0, 0.25, 0.0, 0.75][(i + 2 * j) % 4];
                it.scale = [1.0, 1.25, 2.0, 4.0][(i + j) % 4];
            });
            let bias = [0.0, 0.15][j % 2];
            let part = blocks(21, 33 + j, ends, open);
            let map = Map::new(&rig, &mut case, part, (view_projection, reversed), bias);
            let drawn = case.draw(&mut rig);
            let twin = map.twin(&case, convolution);
            let name = format!("convolved-{terms}-{bits}-{name}");
            let worst = check_basis(&name, &twin, pages(&drawn));
            assert!(worst > 0.1, "{name}: idle bounds, {worst}");
            let sun = |p: DVec3, by: f64| [twin.past(pages(&drawn), p, by, bits_between); 3];
            check_foam(&name, &case, &drawn, Some(&sun), |_| 1.0);
        }
    }
}

/// A wall of sprites that do not overlap, so a pixel shows the light at one sprite's centre.
fn scattered() -> (Foamy, Vec3, Vec3) {
    let (mut case, at, sun) = lit_wall();
    let mut random = Random(8);
    let points: Vec<_> = (0..28 * 19)
        .map(|i| [i % 28, i / 28].map(|i| i as f32))
        .map(|[i, j]| [0.16 * i - 2.2, 0.16 * j - 1.5].map(|v| v + random.between(-0.01, 0.01)))
        .map(|[x, y]| [x, y, 2.0])
        .collect();
    case.shot.positions = scenes::world(&case.shot.camera, &points);
    case.shot.settings.water.spacing *= 0.5;
    case.amounts = vec![[1.0, 0.0]; points.len()];
    case.velocities = vec![[0.0; 3]; points.len()];
    (case, at, sun)
}

/// For each visible sprite: its position in the map, its depth along the light, and its fraction of
/// sunlight. Nine frames shift the sprites to other positions.
fn shares(rig: &mut Rig<'_>, case: &mut Foamy, map: &Map) -> Vec<([f64; 2], f64, f64)> {
    let positions = case.shot.positions.clone();
    let mut all = Vec::new();
    for i in 0..9 {
        let by = [i % 3, i / 3].map(|i| 0.053 * i as f32);
        let moved = positions.iter().map(|[x, y, z]| [x + by[0], y + by[1], *z]);
        case.shot.positions = moved.collect();
        let drawn = case.draw(rig);
        all.extend(shares_of(case, map, &drawn));
    }
    case.shot.positions = positions;
    all
}

fn shares_of(case: &Foamy, map: &Map, drawn: &Drawn) -> Vec<([f64; 2], f64, f64)> {
    let foam = drawn.foam.as_ref().expect("foam");
    let convolution = Convolution::default();
    let twin = map.twin(case, convolution);
    let view = case.shot.view(SIZE);
    let white = f64::from(case.shot.settings.surface_foam.front_color[0]);
    let mut shares = Vec::new();
    for position in &case.shot.positions {
        let (p, by) = crate::light::middle(&case.shot, *position);
        let ndc = (view.projection * view.view).project_point3(p);
        let size = [drawn.output.width, drawn.output.height];
        let [x, y] = [0, 1].map(|i| ((0.5 * ndc[i] + 0.5) * size[i] as f64).floor() as isize);
        let Some(color) = drawn.output.checked(x, y) else { continue };
        assert!(foam.thickness.clamped(x, y)[1] > 1e-3, "no foam at ({x}, {y})");
        let Some((uv, z, false)) = twin.seen(p, by) else { continue };
        let size = [map.part.width, map.part.height];
        let place = [0, 1].map(|i| uv[i].v * size[i] as f64);
        // The red channel contains only sunlight.
        shares.push((place, z.v, f64::from(color[0]) / white));
    }
    shares
}

/// A half-plane before the wall, another behind. At the edge a sprite has half of the light; across
/// the filter's box the light grows linearly, from none to all.
#[test]
fn an_edge_is_half_lit_and_the_light_grows_across_it() {
    let gpu = Gpu::shared();
    for (terms, bits, width) in [(16, 8, 9.0_f32), (16, 16, 3.0), (8, 8, 9.0), (4, 16, 5.0)] {
        let convolution = Convolution { terms, texels: 128, bits };
        let mut rig = Rig::lit(&gpu, &convolving(convolution), 1);
        let (mut case, at, sun) = scattered();
        let (_, view_projection, reversed) = light_views(sun, at)[0];
        let depth = |along: f32| view_projection.project_point3(at + along * sun).z;
        for scale in [1.0, 1.25_f32] {
            case.shot.settings.shadow = ShadowFilter::default().with(|it| {
                it.width = width;
                it.scale = scale;
            });
            let edge = 52;
            let part = Image::from_fn(101, 23, |x, _| depth(if x < edge { 2.5 } else { -2.5 }));
            let map = Map::new(&rig, &mut case, part, (view_projection, reversed), 0.0);
            let twin = map.twin(&case, convolution);
            // The cosine series rings beyond its ramp. Each basis term errs by its sine's rounding
            // and by that of the image.
            let ramp = 1.5 * twin.ramp();
            let steps = (0..2000).map(|i| ramp + (1.0 - 2.0 * ramp) * f64::from(i) / 2000.0);
            let whole = 0.5 + 0.5 * f64::from(scale);
            let rings = steps.map(|t| (twin.filter.step(t) - whole).abs()).fold(0.0, f64::max);
            let rounding: f64 = (1..=twin.filter.terms)
                .map(|k| {
                    let own = twin.basis_error(k) + 2.0_f64.powi(-11);
                    f64::from(scale) * 2.0 * 2.0 / std::f64::consts::PI / (2 * k - 1) as f64 * own
                })
                .sum();
            let bits_between = gpu.limits().sub_texel_precision_bits;
            let bound = rings + rounding + 2.0 * 2.0_f64.powi(-(bits_between as i32));
            let mut shares: Vec<_> = shares(&mut rig, &mut case, &map)
                .into_iter()
                .map(|(at, _, s)| (at[0] - 52.0, s))
                .collect();
            shares.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(shares.len() > 800 && bound < 0.2, "{} shares, {bound}", shares.len());
            let mut seen = [0; 3];
            let half = 0.5 * f64::from(width);
            for &(x, s) in &shares {
                // The box has an odd number of texels and is interpolated linearly, so the light is
                // the fraction of the box beyond the edge.
                let past = (x / f64::from(width)).clamp(-0.5, 0.5);
                let lit = 0.5 + f64::from(scale) * past;
                let off = (s - lit.clamp(0.0, 1.0)).abs();
                assert!(
                    off <= bound,
                    "{terms} {bits} {width} {scale}: {s} at {x}, not {lit} by {bound}"
                );
                seen[if x.abs() < half { 1 } else { usize::from(x > 0.0) * 2 }] += 1;
            }
            // The light does not decrease by more than two bounds.
            let mut most = 0.0_f64;
            for &(_, s) in &shares {
                assert!(s >= most - 2.0 * bound, "{s} after {most}");
                most = most.max(s);
            }
            assert!(seen.iter().all(|n| *n > 15), "{seen:?}");
        }
    }
}

/// Without filtering, where all texels around a point agree and none is within the ramp's length of
/// the point, the result is that of a hard comparison.
#[test]
fn away_from_edges_and_contacts_it_is_a_hard_comparison() {
    let gpu = Gpu::shared();
    let convolution = Convolution { terms: 16, texels: 64, bits: 16 };
    let mut rig = Rig::lit(&gpu, &convolving(convolution), 1);
    let (mut case, at, sun) = scattered();
    case.shot.settings.shadow.width = 0.0;
    for (name, view_projection, reversed) in light_views(sun, at) {
        let depth = |along: f32| view_projection.project_point3(at + along * sun).z;
        let open = if reversed { 0.0 } else { 1.0 };
        let part = blocks(29, 31, [depth(1.5), depth(-1.5)], open);
        let map = Map::new(&rig, &mut case, part, (view_projection, reversed), 0.0);
        let mut seen = [0; 2];
        let shares = shares(&mut rig, &mut case, &map);
        let twin = map.twin(&case, convolution);
        for (place, z, s) in shares {
            let base = place.map(|v| (v - 0.5).floor() as isize);
            let about: Vec<_> = (-1..3)
                .flat_map(|j| (-1..3).map(move |i| (i, j)))
                .map(|(i, j)| map.part.clamped(base[0] + i, base[1] + j))
                .map(|texel| twin.behind(texel, z))
                .collect();
            // Twice the ramp, because it begins after the offset.
            let far = 2.1 * twin.ramp();
            let verdict = if about.iter().all(|t| *t > 0.0) {
                1
            } else if about.iter().all(|t| *t < -far) {
                0
            } else {
                continue;
            };
            seen[verdict] += 1;
            assert!((s - verdict as f64).abs() < 0.01, "{name}: {s} at {place:?}, not {verdict}");
        }
        assert!(seen.iter().all(|n| *n > 50), "{name}: {seen:?}");
    }
}

/// A reversed map and maps with other depth ranges give the same shade.
#[test]
fn the_convention_does_not_show() {
    let gpu = Gpu::shared();
    let convolution = Convolution { terms: 16, texels: 64, bits: 16 };
    let mut rig = Rig::lit(&gpu, &convolving(convolution), 1);
    let (mut case, at, sun) = scattered();
    let view = Mat4::look_at_rh(at + 6.0 * sun, at, Vec3::Y);
    let flat = |near, far| Mat4::orthographic_rh(-0.9, 0.9, -0.7, 0.7, near, far) * view;
    let mut draw = |view_projection: Mat4, reversed| {
        let depth = |along: f32| view_projection.project_point3(at + along * sun).z;
        let open = if reversed { 0.0 } else { 1.0 };
        let part = Image::from_fn(40, 30, |x, y| match (x / 6 + y / 5) % 3 {
            0 => open,
            i => depth(0.9 * i as f32 - 1.3 + 0.01 * (x + y) as f32),
        });
        let map = Map::new(&rig, &mut case, part, (view_projection, reversed), 0.0);
        shares(&mut rig, &mut case, &map)
    };
    let expected = draw(flat(1.0, 11.0), false);
    assert!(expected.iter().filter(|s| (0.1..0.9).contains(&s.2)).count() > 50);
    for (view_projection, reversed) in
        [(flat(11.0, 1.0), true), (flat(-9.0, 11.0), false), (flat(2.0, 60.0), false)]
    {
        let found = draw(view_projection, reversed);
        assert_eq!(found.len(), expected.len());
        for (a, b) in found.iter().zip(&expected) {
            // Sixteen terms in half precision.
            assert!((a.2 - b.2).abs() < 0.02, "{} not {} at {:?}", a.2, b.2, a.0);
        }
    }
}

/// The map's size may change from frame to frame, and nothing of earlier maps shows. With an empty
/// map nothing is in shade.
#[test]
fn maps_of_any_size_come_and_go() {
    let gpu = Gpu::shared();
    for (composite, terms) in [(Shading::Raster, 16), (Shading::Compute, 4)] {
        let convolution = Convolution { terms, texels: 32, bits: 8 };
        let mut case = Foamy::new(SIZE, Lens::Standard, 10.0);
        let mut random = Random(12);
        let n = case.shot.positions.len();
        case.shot.densities = Some((0..n).map(|_| random.between(300.0, 1000.0)).collect());
        let at = Vec3::from(scenes::world(&case.shot.camera, &[[0.0, 0.0, 5.0]])[0]);
        case.shot.light_volume = Some(LightVolume { center: at.to_array(), radius: 6.0 });
        let sun = Vec3::from(case.shot.settings.light.direction);
        let view = Mat4::look_at_rh(at + 6.0 * sun, at, Vec3::Y);
        let flat = Mat4::orthographic_rh(-4.0, 4.0, -4.0, 4.0, 1.0, 11.0) * view;
        let config = convolving(convolution).with(|it| {
            it.light_map_size = Some(32);
            it.spray = true;
            it.sheets = 2;
            it.composite = Some(composite);
        });
        let mut rig = Rig::lit(&gpu, &config, 1);
        let mut pictures = Vec::new();
        for (w, h) in [(23, 17), (1, 1), (5, 90), (300, 200), (32, 32), (1, 33), (23, 17)] {
            let part = Image::from_fn(w, h, |x, y| 0.2 + 0.6 * ((x * 7 + y * 3) % 5) as f32 / 4.0);
            let map = Map::new(&rig, &mut case, part, (flat, false), 0.05);
            let drawn = case.draw(&mut rig);
            check_basis(&format!("size-{w}x{h}"), &map.twin(&case, convolution), pages(&drawn));
            // A renderer takes seconds to compile, so the normal test compares with a new one only
            // after a larger and a smaller map.
            if slow() || [(5, 90), (32, 32)].contains(&(w, h)) {
                let mut fresh = Rig::lit(&gpu, &config, 1);
                let _map = Map::new(&fresh, &mut case, map.part, (flat, false), 0.05);
                let expected = case.draw(&mut fresh);
                compare::same_color(&format!("size-{w}x{h}"), &drawn.output, &expected.output);
            }
            pictures.push(drawn.output);
        }
        assert!(pictures[0] == pictures[6] && pictures[0] != pictures[1]);
        // An empty map, in both depth conventions.
        let mut dark = Rig::lit(&gpu, &config.with(|it| it.shadow = None), 1);
        case.shot.shadow = None;
        let expected = case.draw(&mut dark);
        for (reversed, open) in [(false, 1.0), (true, 0.0)] {
            let (near, far) = if reversed { (11.0, 1.0) } else { (1.0, 11.0) };
            let flat = Mat4::orthographic_rh(-4.0, 4.0, -4.0, 4.0, near, far) * view;
            let part = Image::new(20, 20, open);
            let _map = Map::new(&rig, &mut case, part, (flat, reversed), 0.05);
            let drawn = case.draw(&mut rig);
            compare::same_but_rounded("nothing there", &drawn.output, &expected.output);
        }
    }
}
