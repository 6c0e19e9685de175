//! Passes `gaps` and `back`, thickness by sheets, and two sheets in the picture: water behind water.

use ash::vk;
use glam::{DVec2, DVec3, Mat4, Vec3};
use whitewater::water::{Fresnel, Gate, Medium, Rule, Shading, Smoothing, Splat};
use whitewater::{Camera, Config, SmoothingLevel, SmoothingLevels};

use crate::composite::{FLAT, Sky, noise_look, twin_settings};
use crate::harness::fails;
use crate::invariants::{exact, same_drawn, scaled};
use crate::reduce::{assert_planned, decoded_plan, params, rules, wide};
use crate::reference::composite::{
    self as twin, Behind, Inputs, Two, cut_look_up, hidden, look_up_both, scene_at,
};
use crate::reference::cull::{CullParams, cull};
use crate::reference::noise::{Look, Ripples};
use crate::reference::sheets::{self, Boundaries, CELL, GROWN, Known, Part};
use crate::reference::thickness::Amplitude;
use crate::reference::{EMPTY, Image, Sphere, View, depth, is_surface, smooth};
use crate::shading::close;
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Drawn, OUTPUT, Rig, Sheets, Shot, Work, config, extent};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::support::shaded::{Filter, Shaded, shaded_both};
use crate::support::slow;
use crate::support::tolerance::{self, Between, Sum, U};

const SPACING: f32 = 0.25;

type Points = Vec<[f32; 3]>;

/// So many of a list of cases; all of them where the long tests are asked for.
fn some(cases: usize) -> usize {
    if slow() { usize::MAX } else { cases }
}

fn jittered(random: &mut Random, at: [f32; 3], part: f32) -> [f32; 3] {
    at.map(|v| v + SPACING * part * random.between(-0.2, 0.2))
}

/// Two layers of water below the eye, (x, y, depth) of eye space: still (0) or wavy (1).
fn pool(wavy: f32) -> Points {
    let mut random = Random(12);
    let columns = (0..28).flat_map(|z| (0..36).map(move |x| (x as f32, z as f32)));
    let all = (0..2).flat_map(|layer| columns.clone().map(move |at| (layer as f32, at)));
    all.map(|(layer, (x, z))| {
        let (x, z) = (SPACING * (x - 18.0), 3.6 + SPACING * z);
        let y = -0.83 - SPACING * layer + 0.08 * wavy * (2.0 * x + z).sin();
        jittered(&mut random, [x, y, z], wavy)
    })
    .collect()
}

/// A drop of eight particles.
fn drop_at(random: &mut Random, at: [f32; 3]) -> Points {
    let corner = |i: usize| [i & 1, i >> 1 & 1, i >> 2].map(|b| SPACING * (b as f32 - 0.5));
    let at = |i: usize| [0, 1, 2].map(|axis| at[axis] + corner(i)[axis]);
    (0..8).map(|i| jittered(random, at(i), 1.0)).collect()
}

/// Drops and a torn sheet before the pool.
fn torn() -> Points {
    let (mut points, mut random) = (pool(1.0), Random(21));
    for (x, y) in (0..11).flat_map(|x| (0..9).map(move |y| (x, y))) {
        if (x * 7 + y * 5) % 11 > 7 {
            continue;
        }
        let (x, y) = (SPACING * (x as f32 - 9.0), SPACING * (y as f32 - 5.0));
        for layer in [0.0, SPACING] {
            let z = 2.5 + 0.2 * (3.0 * x).sin() + layer;
            points.push(jittered(&mut random, [x, y, z], 1.0));
        }
    }
    for at in [[1.0, -0.3, 2.2], [0.8, -0.9, 2.6], [1.6, -0.7, 3.0], [0.3, 0.5, 1.5]] {
        points.extend(drop_at(&mut random, at));
    }
    points
}

fn shot_of(size: vk::Extent2D, lens: Lens, points: &[[f32; 3]]) -> Shot {
    Shot::new(size, lens, SPACING * 0.656, points)
}

fn shot(size: vk::Extent2D, lens: Lens) -> Shot {
    shot_of(size, lens, &torn())
}

fn unsmoothed(shot: &Shot) -> Shot {
    let mut shot = shot.clone();
    shot.settings.water.smoothing_width = 0.0;
    shot
}

/// A configuration with two sheets.
fn two(size: vk::Extent2D) -> Config {
    Config { sheets: 2, ..config(size) }
}

/// One that leaves the boundaries as they were found.
fn unpruned(size: vk::Extent2D, thickness_level: u32) -> Config {
    Config { thickness_splat: Some(Splat::Raster), thickness_level, ..two(size) }
}

fn of(drawn: &Drawn) -> &Sheets {
    drawn.sheets.as_ref().expect("two sheets")
}

/// Texels with two sheets.
fn gaps(drawn: &Drawn) -> usize {
    of(drawn).boundaries.data.iter().filter(|b| **b < 1e9).count()
}

/// The spheres that the culling leaves.
fn visible(shot: &Shot) -> Vec<Sphere> {
    let water = &shot.settings.water;
    let params = CullParams::new(f64::from(water.radius()), f64::from(water.rest_density));
    cull(&shot.positions, shot.densities.as_deref(), &params, &shot.view(shot.size)).visible
}

fn spacing(shot: &Shot) -> f64 {
    f64::from(shot.settings.water.spacing)
}

/// Asserts that no texel is another, of those that are `sure`.
fn same_where(name: &str, found: &Image<f32>, expected: &Image<f32>, sure: &Image<bool>) {
    let masked = |image: &Image<f32>| {
        assert_eq!((image.width, image.height), (sure.width, sure.height), "{name}");
        Image::from_fn(image.width, image.height, |x, y| match sure.at(x, y) {
            true => image.at(x, y),
            false => 0.0,
        })
    };
    compare::same(name, &masked(found), &masked(expected));
}

// The boundaries.

/// What the texels of frames were.
#[derive(Clone, Copy, Debug, Default)]
struct Texels {
    touched: usize,
    split: usize,
    unsure: usize,
}

impl std::ops::AddAssign for Texels {
    fn add_assign(&mut self, other: Self) {
        self.touched += other.touched;
        self.split += other.split;
        self.unsure += other.unsure;
    }
}

impl Texels {
    /// Asserts that there were gaps, and that rounding left hardly any texel open.
    fn suffice(&self, name: &str) {
        assert!(self.split * 10 > self.touched, "{name}: hardly a gap in {self:?}");
        assert!(self.unsure * 20 < self.touched, "{name}: too many are open of {self:?}");
    }
}

/// What is known of the boundaries of a shot.
fn judged(shot: &Shot, level: u32) -> Image<Known> {
    let (spheres, view) = (visible(shot), shot.view(shot.size));
    let rounded = |sphere: &Sphere| tolerance::span(sphere, &view);
    let cells = sheets::judged(&spheres, &view, spacing(shot), rounded);
    sheets::judged_texels(&cells, &view, level)
}

/// Asserts that the boundaries are the twin's. The sum that makes a cell's boundary adds 4u of it. Of
/// the mean of eight cells products and sums make 9u, the quotient 5u, of that of four 5u and 5u, and
/// of its weights 5u. Where the answer depends on rounding it must still be one of those that may come
/// out.
fn check_boundaries(name: &str, found: &Image<f32>, shot: &Shot, level: u32) -> Texels {
    let texels = judged(shot, level);
    assert_eq!((found.width, found.height), (texels.width, texels.height), "{name}");
    let (mut count, mut wrong) = (Texels::default(), Vec::new());
    for (i, (found, texel)) in found.data.iter().zip(&texels.data).enumerate() {
        let split = is_surface(texel.boundary);
        count.touched += usize::from(texel.touched);
        count.split += usize::from(texel.certain && split);
        count.unsure += usize::from(!texel.certain);
        let found = f64::from(*found);
        let (low, high) = (texel.low * (1.0 - 33.0 * U), texel.high * (1.0 + 33.0 * U));
        let sound = match is_surface(found) {
            true => texel.maybe_one && found >= low && found <= high,
            // Exactly so: other passes compare with it.
            false => texel.maybe_none && found == EMPTY,
        };
        if !sound {
            wrong.push(format!("({}, {}): {found}, {texel:?}", i % texels.width, i / texels.width));
        }
    }
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("{name}: {count:?}");
    }
    let few = wrong.iter().take(8).cloned().collect::<Vec<_>>().join("\n");
    assert!(wrong.is_empty(), "{name}: {} texels of {count:?}\n{few}", wrong.len());
    count
}

/// The definition of the cells in single precision, as plainly as it can be put.
fn single_precision(shot: &Shot) -> Image<f32> {
    let view = shot.view(shot.size);
    let (width, height) = (view.width as f32, view.height as f32);
    let s = shot.settings.water.spacing;
    let p = shot.camera.projection;
    let (radius, columns) = (shot.settings.water.radius(), view.width.div_ceil(CELL));
    let mut touching = vec![Vec::new(); columns * view.height.div_ceil(CELL)];
    for position in &shot.positions {
        let c = shot.camera.view.transform_point3(Vec3::from(*position));
        let z = -c.z;
        if z <= 1.01 * radius {
            continue;
        }
        let h = z * z - radius * radius;
        // First pixel and last.
        let along = |across: f32, focal: f32, shift: f32, extent: f32| {
            let reach = radius * (across * across + h).sqrt();
            let slopes = [(across * z - reach) / h, (across * z + reach) / h];
            let [a, b] = slopes.map(|slope| (slope * focal - shift + 1.0) * 0.5 * extent);
            let beside = (0.35 * s * 0.5 * extent * focal.abs() / z - 4.0).max(0.0);
            let grown = GROWN as f32 + beside;
            let (low, high) = (a.min(b) - grown, a.max(b) + grown);
            ((low - 0.5).ceil().max(0.0), (high - 0.5).floor().min(extent - 1.0))
        };
        let (left, right) = along(c.x, p.x_axis.x, p.z_axis.x, width);
        let (top, bottom) = along(c.y, p.y_axis.y, p.z_axis.y, height);
        if left > right || top > bottom {
            continue;
        }
        for row in top as usize / CELL..=bottom as usize / CELL {
            for column in left as usize / CELL..=right as usize / CELL {
                touching[row * columns + column].push(z);
            }
        }
    }
    let boundary = |depths: &Vec<f32>| {
        let nearest = depths.iter().copied().fold(f32::INFINITY, f32::min);
        let slice = |z: f32| ((z - nearest) / (0.5 * s)).floor().clamp(0.0, 31.0) as u32;
        let mark = |z: &f32| (slice(z - 0.75 * s)..=slice(z + 0.75 * s)).map(|k| 1_u32 << k);
        let marks = depths.iter().flat_map(mark).fold(0, |all, mark| all | mark);
        let marked = |k: usize| k < 32 && marks >> k & 1 == 1;
        let next = |from: usize, of: bool| (from..32).find(|k| marked(*k) == of).unwrap_or(32);
        let mut air = Vec::new();
        let mut a = next(0, false);
        while next(a, true) < 32 {
            let (w, e) = (next(a, true), next(next(a, true), false));
            air.push(((a + w) as f32 * 0.25 * s, e - w >= 6 || e == 32));
            a = e;
        }
        let chosen = air.iter().find(|(_, body)| *body).or(air.first());
        chosen.map_or(EMPTY as f32, |(behind, _)| nearest + behind)
    };
    Image {
        width: columns,
        height: touching.len() / columns,
        data: touching.iter().map(boundary).collect(),
    }
}

/// The twin's certainty is what it says: neither single precision nor anything in the slack makes
/// another answer of a texel, and an answer that is off is seen.
#[test]
fn certain_texels_stay_in_all_of_the_slack() {
    let mut random = Random(77);
    let mut signed = |most: f64| f64::from(random.between(-1.0, 1.0)) * most;
    let mut count = Texels::default();
    let mut shots = near_shots().to_vec();
    for size in [extent(96, 64), extent(160, 110), extent(33, 17), extent(192, 120)] {
        shots.extend([Lens::Standard, Lens::OffAxis].map(|lens| shot(size, lens)));
    }
    for (i, shot) in shots.into_iter().enumerate() {
        let (spheres, view) = (visible(&shot), shot.view(shot.size));
        let level = i as u32 % 4;
        let texels = |cells: &Image<f64>| sheets::of_texels(cells, &view, level).map(|b| *b as f32);
        let name = format!("slack-{i}");
        let found = texels(&wide(&single_precision(&shot)));
        count += check_boundaries(&name, &found, &shot, level);
        for _ in 0..20 {
            let mut moved = |sphere: &Sphere| -> (f64, Option<Part>) {
                let mut sphere = *sphere;
                let slack = tolerance::span(&sphere, &view);
                sphere.center.z -= signed(slack.depth);
                let grown = GROWN + signed(slack.pixels);
                (-sphere.center.z, sheets::counted(&sphere, &view, spacing(&shot), grown))
            };
            let moved: Vec<_> = spheres.iter().map(&mut moved).collect();
            let other = sheets::boundaries_of(moved.into_iter(), &view, spacing(&shot));
            check_boundaries(&name, &texels(&other), &shot, level);
        }
        let split = found.data.iter().position(|b| *b < 1e9).expect("a gap");
        // A texel of one sheet, if there is any.
        let one = found.data.iter().position(|b| *b >= 1e9).unwrap_or(split);
        for (texel, other) in [
            (split, EMPTY as f32),
            (split, found.data[split] + 0.25 * shot.settings.water.spacing),
            (split, found.data[split] * 1.0001),
            (one, 50.0),
            (one, f32::INFINITY),
            (one, f32::NAN),
        ] {
            let mut planted = found.clone();
            planted.data[texel] = other;
            let seen = fails(|| {
                check_boundaries(&name, &planted, &shot, level);
            });
            // Where rounding decides either answer may pass.
            let certain = judged(&shot, level).data[texel].certain;
            assert!(seen || !certain, "{name}: {other} in texel {texel}");
        }
    }
    count.suffice("slack");
}

#[test]
fn the_boundaries_are_the_twins() {
    let gpu = Gpu::shared();
    let mut count = Texels::default();
    for (width, height) in [(96, 64), (97, 61), (160, 110), (33, 17)] {
        let size = extent(width, height);
        for level in 0..4 {
            let mut rig = Rig::new(&gpu, &unpruned(size, level));
            for lens in LENSES.into_iter().skip(level as usize).step_by(2) {
                let shot = shot(size, lens);
                let name = format!("boundaries-{lens:?}-{width}-{level}");
                count += check_boundaries(&name, &of(&rig.draw(&shot)).boundaries, &shot, level);
            }
        }
    }
    count.suffice("boundaries");
}

/// Smaller spheres of thin water, and those that are set aside as spray.
#[test]
fn the_boundaries_are_of_the_drawn_spheres() {
    let gpu = Gpu::shared();
    let (size, mut count) = (extent(160, 110), Texels::default());
    let mut rig = Rig::new(&gpu, &unpruned(size, 1));
    for (seed, lens) in (4..).zip(LENSES) {
        let (mut shot, mut random) = (shot(size, lens), Random(seed));
        let densities = shot.positions.iter().map(|_| random.between(250.0, 600.0));
        shot.densities = Some(densities.collect());
        let drawn = rig.draw(&shot);
        count += check_boundaries("boundaries-thin", &of(&drawn).boundaries, &shot, 1);
    }
    count.suffice("boundaries-thin");
}

/// Spheres round the eye, whose projections have no bounds or large ones; many layers behind them.
fn near_shots() -> [Shot; 2] {
    [(Lens::Standard, 90.0), (Lens::ReversedInfinite, 400.0)].map(|(lens, far)| {
        let mut near = scenes::cloud(6, 12, 0.4, 2.0);
        near.extend([[0.1, 0.0, 0.3], [0.0, 0.2, -0.2], [0.3, 0.1, 0.05], [0.0, 0.0, 0.495]]);
        near.extend(scenes::block(2, 0.7, [20, 12, 2], [-7.0, -4.0, 12.0]));
        near.extend(scenes::cloud(9, 60, 20.0, far));
        Shot::new(extent(97, 61), lens, 0.5, &near)
    })
}

#[test]
fn spheres_at_the_eye_take_no_part() {
    let gpu = Gpu::shared();
    let mut count = Texels::default();
    for shot in near_shots() {
        let drawn = Rig::new(&gpu, &unpruned(shot.size, 0)).draw(&shot);
        count += check_boundaries("boundaries-near", &of(&drawn).boundaries, &shot, 0);
    }
    count.suffice("boundaries-near");
}

// The thickness.

/// Whether a sphere surely belongs, and whether it may belong, to the back sheet: its depth is
/// rounded, the boundary is as it was read.
fn is_behind(sphere: &Sphere, boundary: f64, view: &View) -> (bool, bool) {
    let (z, e) = (-sphere.center.z, tolerance::eye_space(sphere.center, view));
    (z - e >= boundary, z + e >= boundary)
}

/// Least and greatest shares of a splat: in the front sheet, in the back one and in the window. Each
/// falls or rises with the depth, which is rounded with its differences from the boundary; the cubic
/// makes 5u, of a quotient of 5u that counts one and a half times, the difference from 1 one more.
fn share_bounds(sphere: &Sphere, boundary: f64, spacing: f64, view: &View) -> [(f64, f64); 3] {
    let z = -sphere.center.z;
    let e = tolerance::eye_space(sphere.center, view) + 4.0 * U * (z + boundary + spacing);
    let front = |z: f64| sheets::shares(z, boundary, spacing).0;
    let window = |away: f64| sheets::shares(boundary + away.max(0.0), boundary, spacing).1;
    let away = (z - boundary).abs();
    // What is cut to 0 or 1 rounds nothing.
    let open = |(low, high): (f64, f64)| match (low, high) {
        (_, 0.0) => (0.0, 0.0),
        (1.0, _) => (1.0, 1.0),
        _ => ((low - 14.0 * U).max(0.0), (high + 14.0 * U).min(1.0)),
    };
    let (least, most) = (front(z + e), front(z - e));
    [(least, most), (1.0 - most, 1.0 - least), (window(away + e), window(away - e))].map(open)
}

/// Bounds of the thickness of the front sheet, of the back one and of the window, by the boundaries
/// that were found; of no texel without one.
fn thickness_bounds(shot: &Shot, boundaries: &Image<f32>, level: u32, sum: Sum) -> [Between; 3] {
    let (spheres, view, boundaries) = (visible(shot), shot.view(shot.size), wide(boundaries));
    [0, 1, 2].map(|i| {
        let rest = i == 1 && sum == Sum::Fixed;
        tolerance::thickness_where(
            &spheres,
            &view,
            level,
            &shot.scene_at(shot.size, level),
            spacing(shot).powi(3),
            f64::from(shot.settings.water.radius()),
            if rest { Sum::FixedRest } else { sum },
            |x, y, sphere| match boundaries.at(x, y) {
                boundary if is_surface(boundary) => {
                    share_bounds(sphere, boundary, spacing(shot), &view)[i]
                }
                _ => (0.0, 0.0),
            },
        )
    })
}

/// Asserts that all water is the twin's and each part of it, by the boundaries that were found;
/// returns how many texels hold water of both sheets.
fn check_thickness(
    name: &str,
    all: &Image<f32>,
    found: &Sheets,
    shot: &Shot,
    level: u32,
    sum: Sum,
) -> usize {
    let (spheres, view) = (visible(shot), shot.view(shot.size));
    let bounds = tolerance::thickness(
        &spheres,
        &view,
        level,
        &shot.scene_at(shot.size, level),
        spacing(shot).powi(3),
        f64::from(shot.settings.water.radius()),
        sum,
    );
    compare::between(&format!("{name}-all"), all, &bounds);
    let bounds = thickness_bounds(shot, &found.boundaries, level, sum);
    let parts = ["front", "back", "window"];
    for (i, (part, mut bounds)) in parts.into_iter().zip(bounds).enumerate() {
        for (j, boundary) in found.boundaries.data.iter().enumerate() {
            let all = f64::from(all.data[j]);
            let (low, high) = (&mut bounds.low.data[j], &mut bounds.high.data[j]);
            if is_surface(f64::from(*boundary)) {
                // A difference of two sums, each rounded once.
                let rounding = if i == 1 { 2.0 * U * all } else { 0.0 };
                (*low, *high) = ((*low - rounding).max(0.0), *high + rounding);
                continue;
            }
            // One sheet: the same sums; blended, each of as many roundings as there are splats.
            let whole = [all, 0.0, sheets::ONE_SHEET * all][i];
            let rounding = match (sum, i) {
                (Sum::Float, 2) => 2.0 * spheres.len() as f64 * U * whole,
                (_, 2) => U * whole,
                _ => 0.0,
            };
            (*low, *high) = (whole - rounding, whole + rounding);
        }
        let found = found.thickness.map(|texel| texel[i]);
        compare::between(&format!("{name}-{part}"), &found, &bounds);
    }
    let both = found.thickness.data.iter().filter(|[x, y, _]| *x > 0.0 && *y > 0.0);
    both.count()
}

#[test]
fn each_sheets_thickness_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    for (splat, sum) in [(Splat::Raster, Sum::Float), (Splat::Compute, Sum::Fixed)] {
        for level in 0..4 {
            let (thickness_splat, thickness_level) = (Some(splat), level);
            let config = Config { thickness_splat, thickness_level, ..two(size) };
            let mut rig = Rig::new(&gpu, &config);
            let lenses = if level == 1 { &LENSES[..] } else { &[Lens::Reversed, Lens::OffAxis] };
            for lens in lenses {
                let mut shot = shot(size, *lens);
                let name = format!("sheets-thickness-{splat:?}-{level}-{lens:?}");
                let drawn = rig.draw(&shot);
                let both = check_thickness(&name, &drawn.thickness, of(&drawn), &shot, level, sum);
                // A tenth of the picture.
                assert!(both * 10 > drawn.thickness.data.len(), "{name}: {both} texels of both");
                shot.scene_depth(|x, y| {
                    ((x / 9 + y / 5) % 2 == 0).then_some(2.0 + f64::from(y % 9))
                });
                let drawn = rig.draw(&shot);
                let name = format!("{name}-cut");
                check_thickness(&name, &drawn.thickness, of(&drawn), &shot, level, sum);
            }
        }
    }
}

/// Asserts that the boundaries are those that were found, but where all water is of one sheet;
/// returns of how many texels that was.
fn check_pruned(
    name: &str,
    pruned: &Image<f32>,
    found: &Image<f32>,
    shot: &Shot,
    level: u32,
) -> [usize; 2] {
    let [front, back, _] = thickness_bounds(shot, found, level, Sum::Fixed);
    let (mut gone, mut kept) = (0, 0);
    for (i, (pruned, found)) in pruned.data.iter().zip(&found.data).enumerate() {
        let at = (i % front.low.width, i / front.low.width);
        if f64::from(*found) == EMPTY || f64::from(*pruned) != EMPTY {
            assert_eq!(pruned.to_bits(), found.to_bits(), "{name} at {at:?}: another boundary");
        }
        if f64::from(*found) == EMPTY {
            continue;
        }
        // All of the addends may round to nothing, and what lies between the bounds.
        let none = front.low.data[i] == 0.0 || back.low.data[i] == 0.0;
        let some = front.high.data[i] > 0.0 && back.high.data[i] > 0.0;
        match f64::from(*pruned) == EMPTY {
            true => assert!(none, "{name} at {at:?}: two sheets made one"),
            false => assert!(some, "{name} at {at:?}: one sheet parted"),
        }
        gone += usize::from(!some);
        kept += usize::from(!none);
    }
    [gone, kept]
}

#[test]
fn where_nothing_is_to_be_told_apart_there_is_one_sheet() {
    let gpu = Gpu::shared();
    let size = extent(160, 110);
    let (mut gone, mut kept) = (0, 0);
    for level in 0..4 {
        let config = unpruned(size, level);
        let mut found = Rig::new(&gpu, &config);
        let compute = Config { thickness_splat: Some(Splat::Compute), ..config };
        let mut pruned = Rig::new(&gpu, &compute);
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            let shot = shot(size, lens);
            let [found, pruned] = [&mut found, &mut pruned].map(|rig| rig.draw(&shot));
            let [found, pruned] = [&found, &pruned].map(|drawn| &of(drawn).boundaries);
            let name = format!("pruned-{level}-{lens:?}");
            let [some_gone, some_kept] = check_pruned(&name, pruned, found, &shot, level);
            gone += some_gone;
            kept += some_kept;
            let planted = |from: f32, to: f32| {
                let at = |i: &usize| pruned.data[*i] == from && found.data[*i] != from;
                let Some(i) = (0..found.data.len()).find(at) else { return };
                let mut planted = pruned.clone();
                planted.data[i] = to;
                let seen = fails(|| {
                    check_pruned(&name, &planted, found, &shot, level);
                });
                assert!(seen, "{name}: {to} in texel {i}");
            };
            planted(EMPTY as f32, 5.0);
        }
    }
    assert!(gone > 100 && kept > 100, "{gone} texels were of one sheet, {kept} of two");
}

// The depth of the back sheet.

/// Where the back sheet lies among the levels: what of that is fixed; its level.
fn back_level(name: &str, drawn: &Drawn, shot: &Shot) -> u32 {
    let back: &SmoothingLevel = &drawn.levels.level[2];
    let edge = back.texel[2];
    assert_eq!(edge, 2.0 * drawn.levels.finer().texel[2], "{name}: one level coarser");
    assert_eq!(back.texel[3], 1.0, "{name}: in use");
    let level = (edge as u32).ilog2();
    let view = shot.view(shot.size).reduced(level);
    assert_eq!(back.rect[2..], [view.width as i32, view.height as i32], "{name}: its size");
    // Both from numbers that are rounded a few times, as slopes in `tolerance::ray_distance`.
    let slope = 4.0 * U * 3.0 * (1.0 + tolerance::reach(&view));
    for (x, y) in [(0, 0), (view.width - 1, view.height - 1)] {
        let [sx, sy, ox, oy] = back.slope.map(f64::from);
        let found = DVec2::new((x as f64 + 0.5) * sx + ox, (y as f64 + 0.5) * sy + oy);
        let off = (found - view.ray(x, y).truncate()).abs().max_element();
        assert!(off <= slope, "{name}: the ray of ({x}, {y}) is off by {off}");
    }
    for (found, expected) in [(back.texel[0], view.c_x()), (back.texel[1], view.c_y())] {
        assert!((f64::from(found) - expected).abs() <= 4.0 * U * expected, "{name}: {found}");
    }
    let [a, b, _] = &drawn.levels.level;
    for other in [a, b].into_iter().filter(|level| level.texel[3] > 0.0) {
        let apart = |i: usize| {
            let (first, second) = (other.rect[i], back.rect[i]);
            first + other.rect[i + 2] <= second || second + back.rect[i + 2] <= first
        };
        assert!(apart(0) || apart(1), "{name}: {back:?} lies in {other:?}");
    }
    level
}

/// The texels where there are two sheets.
fn split(boundaries: &Boundaries<'_>, full: &View, level: u32) -> Image<bool> {
    let view = full.reduced(level);
    Image::from_fn(view.width, view.height, |x, y| {
        is_surface(sheets::boundary_at(boundaries, full, level, x, y))
    })
}

/// Asserts that the unsmoothed depth of the back sheet is the twin's, by the boundaries and the depth
/// that were found; returns how many texels of it are water behind water, and how many are not made.
fn check_back(
    name: &str,
    depth: &Image<f32>,
    sheets: &Sheets,
    shot: &Shot,
    thickness_level: u32,
    level: u32,
) -> (usize, usize) {
    let (full, depth) = (shot.view(shot.size), wide(depth));
    let (view, texels) = (full.reduced(level), wide(&sheets.boundaries));
    let boundaries = Boundaries { texels: &texels, level: thickness_level };
    let split = split(&boundaries, &full, level);
    let made = sheets::made(&boundaries, &full, level);
    let mut bounds = tolerance::depth_where(&visible(shot), &view, |x, y, sphere| {
        let boundary = sheets::boundary_at(&boundaries, &full, level, x, y);
        if split.at(x, y) { is_behind(sphere, boundary, &full) } else { (false, false) }
    });
    let mut water = 0;
    for (y, x) in (0..view.height).flat_map(|y| (0..view.width).map(move |x| (y, x))) {
        let exactly = if !made.at(x, y) {
            EMPTY
        } else if split.at(x, y) {
            water += usize::from(is_surface(f64::from(sheets.surface.at(x, y))));
            continue;
        } else {
            // A copy rounds nothing.
            let (px, py) = sheets::pixel_of_texel(&full, level, x, y);
            depth.at(px, py)
        };
        *bounds.low.at_mut(x, y) = exactly;
        *bounds.high.at_mut(x, y) = exactly;
    }
    compare::between(name, &sheets.surface, &bounds);
    (water, made.data.iter().filter(|made| !**made).count())
}

#[test]
fn the_back_sheets_depth_is_the_twins() {
    let gpu = Gpu::shared();
    for (width, height) in [(97, 61), (192, 120)].into_iter().take(some(1)) {
        let size = extent(width, height);
        for (smoothing_level, thickness_level) in [(0, 2), (0, 0), (1, 2), (1, 3), (2, 1)] {
            let config = Config { smoothing_level, thickness_level, coarsening: 0, ..two(size) };
            let mut rig = Rig::new(&gpu, &config);
            let lenses = match (smoothing_level, thickness_level) {
                (0, 2) => &LENSES[..],
                _ => &[Lens::Standard, Lens::OffAxis],
            };
            for lens in lenses {
                let mut shot = unsmoothed(&shot(size, *lens));
                let name = format!("back-{smoothing_level}{thickness_level}-{lens:?}-{width}");
                let drawn = rig.draw(&shot);
                let level = back_level(&name, &drawn, &shot);
                let check = |name: &str, drawn: &Drawn, shot: &Shot| {
                    check_back(name, &drawn.depth, of(drawn), shot, thickness_level, level)
                };
                let (water, _) = check(&name, &drawn, &shot);
                // A twentieth of the picture.
                let texels = of(&drawn).surface.data.len();
                assert!(water * 20 > texels, "{name}: {water} of {texels} texels");
                // What the scene hides of the front sheet is gone, of the back one nothing.
                shot.scene_depth(|x, y| {
                    ((x / 9 + y / 5) % 2 == 0).then_some(2.0 + f64::from(y % 9))
                });
                check(&format!("{name}-cut"), &rig.draw(&shot), &shot);
            }
        }
    }
}

/// Away from all gaps the back sheet is empty, and only there.
#[test]
fn tiles_are_made_near_gaps() {
    let gpu = Gpu::shared();
    let size = extent(320, 192);
    let mut points = drop_at(&mut Random(3), [-0.9, -0.45, 2.6]);
    points.extend(scenes::block(5, SPACING, [40, 24, 2], [-5.0, -3.0, 5.0]));
    for (smoothing_level, thickness_level) in [(0, 0), (0, 2), (1, 3)] {
        let config = Config { smoothing_level, thickness_level, coarsening: 0, ..two(size) };
        let mut rig = Rig::new(&gpu, &config);
        for lens in [Lens::Standard, Lens::OffAxis] {
            let shot = unsmoothed(&shot_of(size, lens, &points));
            let drawn = rig.draw(&shot);
            let name = format!("back-made-{smoothing_level}{thickness_level}-{lens:?}");
            let level = back_level(&name, &drawn, &shot);
            let (water, unmade) =
                check_back(&name, &drawn.depth, of(&drawn), &shot, thickness_level, level);
            let texels = of(&drawn).surface.data.len();
            assert!(water > 20 && unmade * 6 > texels, "{name}: {water}, {unmade} of {texels}");
        }
    }
}

/// A frame as the twins draw it, of single precision.
fn twins_frame(shot: &Shot, smoothing_level: u32, thickness_level: u32) -> Drawn {
    let (spheres, full) = (visible(shot), shot.view(shot.size));
    let narrow = |image: &Image<f64>| image.map(|v| *v as f32);
    let cells = sheets::boundaries(&spheres, &full, spacing(shot));
    let mut texels = wide(&narrow(&sheets::of_texels(&cells, &full, thickness_level)));
    let depth = narrow(&depth::splat(&spheres, &full));
    let volume = Amplitude::Volume { particle_volume: spacing(shot).powi(3) };
    let mut thickness =
        sheets::thickness(&spheres, &full, thickness_level, &texels, spacing(shot), volume);
    sheets::prune(&mut texels, &mut thickness);
    let (rule, params) = (smooth::Rule::ConstantWidth, params(shot, 256));
    let smoothed = |image: &Image<f64>, level: u32| {
        let view = full.reduced(level);
        let plan = smooth::plan(image, &view, rule, &params);
        narrow(&smooth::run(image, &plan, &view, rule, &params))
    };
    let back_level = smoothing_level + 1;
    let boundaries = Boundaries { texels: &texels, level: thickness_level };
    let back = sheets::back_depth(&spheres, &full, back_level, &boundaries, &wide(&depth));
    let mut levels: SmoothingLevels = bytemuck::Zeroable::zeroed();
    for (i, level, y) in [(0, smoothing_level, 0), (2, back_level, 1 << 12)] {
        let view = full.reduced(level);
        let (step, first) = (view.slope_step(), view.ray_at(DVec2::ZERO));
        levels.level[i] = SmoothingLevel {
            rect: [0, y, view.width as i32, view.height as i32],
            slope: [step.x, step.y, first.x, first.y].map(|v| v as f32),
            texel: [view.c_x() as f32, view.c_y() as f32, (1 << level) as f32, 1.0],
        };
    }
    let reduced = crate::reference::reduce::reduce(&wide(&depth), smoothing_level, shot.falloff());
    let sheets = Sheets {
        boundaries: narrow(&texels),
        thickness: thickness.map(|texel| texel.map(|t| t as f32)),
        surface: smoothed(&back, back_level),
        plan: Image::new(0, 0, 0),
    };
    let mut drawn = Drawn {
        output: Image::new(0, 0, [0.0; 4]),
        whole: Image::new(0, 0, [0.0; 4]),
        surface: smoothed(&reduced, smoothing_level),
        depth,
        plan: Image::new(0, 0, 0),
        coarser: None,
        levels,
        thickness: thickness.map(|[front, back, _]| (front + back) as f32),
        sheets: Some(sheets),
        foam: None,
        spray: None,
        lit_spray: None,
        motion: None,
        noise: None,
        light_front: None,
        light_thickness: None,
        shadow_basis: None,
        caustics: None,
        work: Work::default(),
    };
    let layers = Layers::new(&drawn, shot);
    let sky = Sky::Even.radiance(DVec3::Y);
    let (inputs, behind) =
        (layers.inputs(smoothing_level, thickness_level), layers.behind(back_level));
    let picture = twin::shade_sheets(&inputs, &behind, &twin_settings(shot, &full), |_| sky, &full);
    drawn.output = picture.map(|c| c.map(|v| v as f32));
    drawn
}

/// The checkers of thickness and depth pass the twins themselves, and see what is off by little.
#[test]
fn a_planted_fault_is_seen() {
    let (size, level) = (extent(97, 61), 1);
    let shot = unsmoothed(&shot(size, Lens::OffAxis));
    let view = shot.view(size);
    for thickness_level in [0, 2] {
        let Drawn { depth, thickness: all, sheets, .. } = twins_frame(&shot, 0, thickness_level);
        let good = sheets.expect("two sheets");
        let thick = |all: &Image<f32>, sheets: &Sheets| {
            check_thickness("planted-thickness", all, sheets, &shot, thickness_level, Sum::Float)
        };
        let back = |sheets: &Sheets| {
            check_back("planted-back", &depth, sheets, &shot, thickness_level, level).0
        };
        assert!(thick(&all, &good) > 100 && back(&good) > 100);
        let unseen = |of: &dyn Fn(&Sheets) -> usize, other: &Sheets| {
            !fails(|| {
                of(other);
            })
        };
        let thick_of = |sheets: &Sheets| thick(&all, sheets);
        let swapped = good.thickness.map(|[x, y, z]| [*y, *x, *z]);
        assert!(!unseen(&thick_of, &Sheets { thickness: swapped, ..good.clone() }));
        let both = |i: &usize| good.thickness.data[*i].iter().all(|t| *t > 0.01);
        let texel = (0..all.data.len()).find(both).expect("both sheets");
        let mut other = good.clone();
        other.boundaries.data[texel] = EMPTY as f32;
        assert!(!unseen(&thick_of, &other));
        // A boundary elsewhere: other water is behind it.
        let mut other = good.clone();
        other.boundaries.data.iter_mut().filter(|b| **b < 1e9).for_each(|b| *b += 1.0);
        assert!(!unseen(&thick_of, &other) && !unseen(&back, &other));
        let texels = (0..good.surface.data.len()).filter(|i| good.surface.data[*i] < 1e9);
        for i in texels.step_by(97) {
            let mut other = good.clone();
            other.surface.data[i] *= 1.0001;
            assert!(!unseen(&back, &other), "texel {i}");
        }
        let texels = wide(&good.boundaries);
        let boundaries = Boundaries { texels: &texels, level: thickness_level };
        let made = sheets::made(&boundaries, &view, level);
        if let Some(i) = made.data.iter().position(|made| !made) {
            let mut other = good.clone();
            other.surface.data[i] = 3.0;
            assert!(!unseen(&back, &other), "texel {i}");
        }
        for i in (0..all.data.len()).filter(|i| all.data[*i] > 0.0).step_by(397 >> thickness_level)
        {
            let mut other = all.clone();
            other.data[i] *= 1.001;
            assert!(fails(|| {
                thick(&other, &good);
            }));
            for part in (0..3).filter(|part| good.thickness.data[i][*part] > 0.0) {
                let mut other = good.clone();
                other.thickness.data[i][part] *= 1.001;
                assert!(!unseen(&thick_of, &other), "texel {i}, {part}");
            }
        }
    }
}

// Its smoothing.

#[test]
fn the_back_surface_is_the_twins() {
    let gpu = Gpu::shared();
    let size = extent(193, 121);
    for smoothing_level in 0..3 {
        // The same depth unsmoothed: only this rule has a width.
        let config = Config {
            smoothing_level,
            rule: Rule::ConstantWidth,
            coarsening: 0,
            thickness_level: 0,
            ..two(size)
        };
        let mut flat_rig = Rig::new(&gpu, &config);
        for (rule, twin) in rules() {
            let mut rig = Rig::new(&gpu, &Config { rule, ..config });
            let lenses: &[Lens] = match (smoothing_level, rule) {
                (0, Rule::ConstantWidth) => &LENSES,
                _ => &[Lens::OffAxis],
            };
            for lens in lenses {
                let shot = shot(size, *lens);
                let flat = flat_rig.draw(&unsmoothed(&shot));
                let drawn = rig.draw(&shot);
                let name = format!("back-smooth-{rule:?}-{smoothing_level}-{lens:?}");
                let name = name.replace(['(', ')'], "");
                compare::same(&name, &of(&drawn).boundaries, &of(&flat).boundaries);
                let level = back_level(&name, &drawn, &shot);
                let full = shot.view(size);
                let (view, params) = (full.reduced(level), params(&shot, config.max_iterations));
                let reduced = wide(&of(&flat).surface);
                let plan = decoded_plan(&of(&drawn).plan, twin, &params);
                assert_planned(&name, &plan, &reduced, &view, twin, &params);
                let (expected, error) = tolerance::smoothing(&reduced, &plan, &view, twin, &params);
                let surface = &of(&drawn).surface;
                compare::close(&name, surface, &expected, 0, |x, y, _| error.at(x, y));
                // Of the texels that the picture looks at.
                let texels = wide(&of(&drawn).boundaries);
                let boundaries = Boundaries { texels: &texels, level: 0 };
                let split = split(&boundaries, &full, level);
                let shown = || (0..split.data.len()).filter(|i| split.data[*i]);
                let water = || shown().filter(|i| is_surface(reduced.data[*i]));
                let mut errors: Vec<f64> = water().map(|i| error.data[i]).collect();
                errors.sort_by(f64::total_cmp);
                let median = errors[errors.len() / 2];
                let moved = water().map(|i| (expected.data[i] - reduced.data[i]).abs());
                let moved = moved.fold(0.0, f64::max);
                assert!(median < 0.02 * params.radius, "{name}: a bound of {median} shows nothing");
                assert!(moved > 0.05 * params.radius, "{name}: {moved}: nothing was smoothed");
            }
        }
    }
}

/// All do the same arithmetic: bit for bit.
#[test]
fn all_forms_give_the_same_back_surface() {
    let gpu = Gpu::shared();
    let mut forms = vec![Smoothing::Tiles, Smoothing::Fused, Smoothing::Query(Gate::VertexCull)];
    if gpu.enabled.draw_indirect_count {
        forms.push(Smoothing::Query(Gate::DrawCount));
    }
    if gpu.enabled.conditional_rendering {
        forms.push(Smoothing::Query(Gate::Predicate));
    }
    let sizes = [(extent(193, 121), 256), (extent(3, 5), 40), (extent(130, 35), 7)];
    for (size, cap) in sizes.into_iter().take(some(1)) {
        for (rule, _) in rules() {
            let mut first: Option<Drawn> = None;
            for form in &forms {
                let config = Config {
                    smoothing_level: 0,
                    smoothing: Some(*form),
                    max_iterations: cap,
                    coarsening: 0,
                    rule,
                    ..two(size)
                };
                let mut rig = Rig::lit(&gpu, &config, 1);
                let shot = shot(size, Lens::OffAxis);
                // The second frame starts from the state that the first one left.
                rig.draw(&shot);
                let drawn = rig.draw(&shot);
                let name = format!("back-forms-{form:?}-{rule:?}-{}", size.width);
                let name = name.replace(['(', ')'], "");
                let first = first.get_or_insert_with(|| drawn.clone());
                let (found, expected) = (of(&drawn), of(first));
                compare::same(&name, &found.boundaries, &expected.boundaries);
                compare::same(&name, &found.surface, &expected.surface);
                assert!(found.plan == expected.plan, "{name}: the plans differ");
            }
        }
    }
}

/// However the level of the smoothing was come to, the back sheet is that of a renderer that is
/// configured to it; while a coarser one fades in, of the finer.
#[test]
fn the_back_sheet_follows_the_finer_level() {
    let gpu = Gpu::shared();
    let size = extent(193, 121);
    let mut shot = shot(size, Lens::OffAxis);
    shot.settings.water.smoothing_width = 1.0;
    let (mut levels, mut fades) = (Vec::new(), 0);
    for cap in [6, 9, 14, 20, 30, 45, 70, 110, 160] {
        let config = Config { smoothing_level: 0, max_iterations: cap, ..two(size) };
        let mut rig = Rig::new(&gpu, &config);
        // The second frame starts from what the first one left.
        rig.draw(&shot);
        let drawn = rig.draw(&shot);
        let name = format!("back-level-{cap}");
        let finer = back_level(&name, &drawn, &shot) - 1;
        if finer > 2 {
            continue;
        }
        levels.push(finer);
        fades += usize::from(drawn.coarser.is_some());
        let same = Config { smoothing_level: finer, coarsening: 0, ..config };
        let expected = Rig::new(&gpu, &same).draw(&shot);
        let (found, expected) = (of(&drawn), of(&expected));
        compare::same(&name, &found.boundaries, &expected.boundaries);
        compare::same(&name, &found.surface, &expected.surface);
        assert!(found.plan == expected.plan, "{name}: the plans differ");
    }
    levels.dedup();
    assert!(levels.len() >= 2 && fades >= 1, "levels {levels:?}, {fades} fade in");
}

// What must not change the picture.

#[test]
fn one_sheet_is_the_default_where_there_is_no_gap() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    assert_eq!(Config::new(size, vk::Format::R16G16B16A16_SFLOAT, 1).sheets, 2);
    let points = scenes::block(3, 0.25, [14, 8, 4], [-1.8, -1.0, 4.0]);
    let levels = [(1, 2), (0, 0), (2, 1), (1, 1), (0, 3)];
    for (smoothing_level, thickness_level) in levels.into_iter().take(some(2)) {
        for way in [Shading::Raster, Shading::Compute] {
            let base =
                Config { smoothing_level, thickness_level, composite: Some(way), ..config(size) };
            let mut rigs = [1, 2].map(|sheets| Rig::lit(&gpu, &Config { sheets, ..base }, 1));
            for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
                let shot = Shot::new(size, lens, 0.2, &points);
                let [one, two] = rigs.each_mut().map(|rig| {
                    // The second frame starts from what the first one left.
                    rig.draw(&shot);
                    rig.draw(&shot)
                });
                let name = format!("one-sheet-{smoothing_level}{thickness_level}-{way:?}-{lens:?}");
                let none = of(&two).boundaries.data.iter().all(|b| f64::from(*b) == EMPTY);
                assert!(none, "{name}: a gap");
                same_drawn(&name, &two, &one);
                let all = one.thickness.map(|t| [*t, 0.0, 1e6 * t, 1.0]);
                let found = of(&two).thickness.map(|[x, y, z]| [*x, *y, *z, 1.0]);
                compare::same_color(&format!("{name}-parts"), &found, &all);
                assert!(one.sheets.is_none(), "{name}: boundaries of one sheet");
                assert_eq!(one.levels.level[2].texel[3], 0.0, "{name}: a back sheet in use");
            }
        }
    }
}

/// The farthest, in pixels, that what a pixel shows may come from by the smoothing of the front
/// image: a texel an iteration, and those round it that the surface is rebuilt of.
fn smoothing_reach(drawn: &Drawn) -> u32 {
    let most = drawn.plan.data.iter().map(|p| p & 511).max().unwrap_or(0);
    (most + 3) * drawn.levels.finer().texel[2] as u32
}

/// The pixels farther than 64 from all texels with two sheets.
fn far_from_gaps(boundaries: &Image<f32>, level: u32, width: usize, height: usize) -> Image<bool> {
    const FAR: usize = 64;
    let mut far = Image::new(width, height, true);
    for (i, boundary) in boundaries.data.iter().enumerate() {
        if !is_surface(f64::from(*boundary)) {
            continue;
        }
        let (x, y, edge) =
            ((i % boundaries.width) << level, (i / boundaries.width) << level, 1 << level);
        for row in y.saturating_sub(FAR)..(y + edge + FAR).min(height) {
            for column in x.saturating_sub(FAR)..(x + edge + FAR).min(width) {
                *far.at_mut(column, row) = false;
            }
        }
    }
    far
}

/// What is in front of the pool somewhere is no matter elsewhere.
#[test]
fn a_drop_before_a_pool_leaves_the_rest_as_it_is() {
    let gpu = Gpu::shared();
    let size = extent(320, 192);
    let (mut drop, pool) = (drop_at(&mut Random(3), [-0.9, -0.45, 2.6]), pool(0.0));
    drop.extend(&pool);
    for way in [Shading::Raster, Shading::Compute] {
        let config = Config {
            // Sums of integers: blending rounds in the order of the particles.
            thickness_splat: Some(Splat::Compute),
            composite: Some(way),
            coarsening: 0,
            ..two(size)
        };
        let mut rig = Rig::lit(&gpu, &config, 1);
        let [without, with] = [&pool, &drop].map(|points| {
            let mut shot = shot_of(size, Lens::Standard, points);
            shot.settings.water.smoothing_width = 0.5;
            let drawn = rig.draw(&shot);
            let reach = smoothing_reach(&drawn);
            assert!(reach <= 64, "the smoothing reaches {reach} pixels");
            drawn
        });
        let name = format!("drop-{way:?}");
        let far = |drawn: &Drawn| far_from_gaps(&of(drawn).boundaries, 2, 320, 192);
        let (before, after) = (far(&without), far(&with));
        let fewer = before.data.iter().filter(|far| **far).count();
        let more = after.data.iter().filter(|far| **far).count();
        assert!(fewer > more, "{name}: no gap at the drop");
        let both = Image::from_fn(320, 192, |x, y| before.at(x, y) && after.at(x, y));
        let water = (0..both.data.len())
            .filter(|i| both.data[*i] && is_surface(f64::from(with.depth.data[*i])))
            .count();
        assert!(water > 4000, "{name}: {water} pixels of the pool are away from it");
        same_where(&name, &with.depth, &without.depth, &both);
        for channel in 0..4 {
            let of = |drawn: &Drawn| drawn.output.map(|c| c[channel]);
            same_where(&name, &of(&with), &of(&without), &both);
        }
        let near = with.output.data.iter().zip(&without.output.data).filter(|(a, b)| a != b);
        assert!(near.count() > 100, "{name}: the drop is not seen");
    }
}

#[test]
fn the_order_of_the_particles_is_no_matter() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let shot = shot(size, Lens::OffAxis);
    let order = Random(99).order(shot.positions.len());
    let positions = order.iter().map(|i| shot.positions[*i]).collect();
    let mixed = Shot { positions, ..shot.clone() };
    let mut rig = Rig::lit(&gpu, &Config { sheets: 2, ..exact(size) }, 1);
    let (first, second) = (rig.draw(&shot), rig.draw(&mixed));
    same_drawn("sheets-permutation", &second, &first);
}

/// The stride there may be decides how many particles are worked on at a time.
#[test]
fn chunks_do_not_show() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let shot = shot(size, Lens::OffAxis);
    let mut few = shot.clone();
    few.positions.truncate(100);
    for splat in [Splat::Compute, Splat::Raster] {
        let config = Config { depth_splat: Some(splat), sheets: 2, ..exact(size) };
        for max_stride in [1 << 17, 1 << 19] {
            let [whole, chunks] = [config, Config { max_stride, ..config }].map(|config| {
                let mut rig = Rig::lit(&gpu, &config, 1);
                [rig.draw(&shot), rig.draw(&few), rig.draw(&shot)]
            });
            for (i, (found, expected)) in chunks.iter().zip(&whole).enumerate() {
                let name = format!("sheets-chunks-{splat:?}-{max_stride}-{i}");
                same_drawn(&name, found, expected);
            }
        }
    }
}

const TINY: [(u32, u32); 6] = [(96, 64), (1, 1), (1, 7), (3, 5), (17, 33), (8, 8)];

#[test]
fn no_particles_are_no_sheet() {
    let gpu = Gpu::shared();
    for (width, height) in TINY {
        let size = extent(width, height);
        for way in [Shading::Raster, Shading::Compute] {
            let mut rig = Rig::lit(&gpu, &Config { composite: Some(way), ..two(size) }, 1);
            let mut none = shot(size, Lens::Standard);
            none.positions.clear();
            // Another frame's water must not come back.
            rig.draw(&shot(size, Lens::Standard));
            let drawn = rig.draw(&none);
            let (width, height) = (width as usize, height as usize);
            let scene = Image { width, height, data: none.color.clone() };
            compare::same_color(&format!("sheets-zero-{width}-{way:?}"), &drawn.output, &scene);
            assert!(of(&drawn).boundaries.data.iter().all(|b| f64::from(*b) == EMPTY));
            assert!(of(&drawn).thickness.data.iter().all(|t| *t == [0.0; 3]));
            assert!(of(&drawn).surface.data.iter().all(|z| f64::from(*z) == EMPTY));
        }
    }
}

#[test]
fn small_images_have_sheets_too() {
    let gpu = Gpu::shared();
    for (width, height) in TINY {
        let size = extent(width, height);
        let levels = [(1, 2), (0, 0), (2, 3)];
        for (smoothing_level, thickness_level) in levels.into_iter().take(some(1)) {
            let config = Config { smoothing_level, ..unpruned(size, thickness_level) };
            let mut rig = Rig::lit(&gpu, &config, 1);
            // A drop before a wall.
            let mut points = scenes::block(5, SPACING, [24, 16, 2], [-3.0, -2.0, 5.0]);
            points.extend(drop_at(&mut Random(8), [0.05, 0.0, 2.0]));
            let shot = unsmoothed(&shot_of(size, Lens::Reversed, &points));
            let drawn = rig.draw(&shot);
            let name = format!("tiny-{width}x{height}-{smoothing_level}{thickness_level}");
            check_boundaries(&name, &of(&drawn).boundaries, &shot, thickness_level);
            assert!(gaps(&drawn) > 0, "{name}: no gap");
            let (all, level) = (&drawn.thickness, back_level(&name, &drawn, &shot));
            check_thickness(&name, all, of(&drawn), &shot, thickness_level, Sum::Float);
            check_back(&name, &drawn.depth, of(&drawn), &shot, thickness_level, level);
            for (color, depth) in drawn.output.data.iter().zip(&drawn.depth.data) {
                let sound =
                    color.iter().all(|v| v.is_finite()) && (*depth >= 1e9 || color[3] == 1.0);
                assert!(sound, "{name}: {color:?}");
            }
        }
    }
}

/// A frame looks the same whatever was drawn before it.
#[test]
fn what_an_earlier_frame_left_is_not_seen() {
    let gpu = Gpu::shared();
    let size = extent(320, 192);
    let mut points = drop_at(&mut Random(3), [-0.9, -0.45, 2.6]);
    points.extend(pool(0.0));
    // Sheets everywhere, at other depths.
    let mut other = scenes::block(1, 0.4, [16, 10, 1], [-3.0, -2.0, 2.0]);
    other.extend(scenes::block(2, 0.4, [40, 26, 1], [-8.0, -5.0, 7.0]));
    let other = Shot::new(size, Lens::OffAxis, 0.3, &other);
    for (smoothing, smoothing_width) in [
        (Smoothing::Tiles, 0.5),
        (Smoothing::Tiles, 2.0),
        (Smoothing::Fused, 2.0),
        (Smoothing::Query(Gate::VertexCull), 2.0),
    ] {
        let config =
            Config { smoothing: Some(smoothing), smoothing_level: 0, coarsening: 0, ..two(size) };
        let mut shot = shot_of(size, Lens::Standard, &points);
        shot.settings.water.smoothing_width = smoothing_width;
        let fresh = Rig::lit(&gpu, &config, 1).draw(&shot);
        let mut rig = Rig::lit(&gpu, &config, 1);
        rig.draw(&other);
        let drawn = rig.draw(&shot);
        let name = format!("earlier-{smoothing:?}-{smoothing_width}").replace(['(', ')'], "");
        assert!(gaps(&drawn) > 10, "{name}: no gap");
        let undrawn = of(&drawn).surface.data.iter().filter(|z| f64::from(**z) == EMPTY);
        assert!(undrawn.count() > 500, "{name}: sheets everywhere");
        same_drawn(&name, &drawn, &fresh);
    }
}

/// Powers of two scale every number without rounding.
#[test]
fn the_unit_of_length_does_not_show() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let mut rig = Rig::lit(&gpu, &Config { sheets: 2, ..exact(size) }, 1);
    let shot = shot(size, Lens::Standard);
    let expected = rig.draw(&shot);
    assert!(gaps(&expected) > 10);
    for scale in [1024.0, 1.0 / 1024.0] {
        let drawn = rig.draw(&scaled(&shot, scale));
        let same = |a: &f32, b: &f32| *a == *b * scale || (*a >= 1e9 && *b >= 1e9);
        let [found, wanted] = [&drawn, &expected].map(|drawn| &of(drawn).boundaries.data);
        assert!(found.iter().zip(wanted).all(|(a, b)| same(a, b)), "boundaries at {scale}");
        compare::same_color(&format!("sheets-unit-{scale}"), &drawn.output, &expected.output);
    }
}

#[test]
fn both_ways_of_shading_give_the_same_picture() {
    let gpu = Gpu::shared();
    let size = extent(97, 61);
    let levels = [(0, 2), (1, 1), (0, 0), (2, 3)];
    for (smoothing_level, thickness_level) in levels.into_iter().take(some(2)) {
        let mut rigs = [Shading::Raster, Shading::Compute].map(|way| {
            let levels = Config { smoothing_level, thickness_level, ..two(size) };
            Rig::lit(&gpu, &Config { composite: Some(way), ..levels }, 1)
        });
        for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
            let shot = shot(size, lens);
            let [drawn, stored] = rigs.each_mut().map(|rig| rig.draw(&shot));
            let name = format!("sheets-ways-{smoothing_level}{thickness_level}-{lens:?}");
            close(&name, OUTPUT, &stored, &drawn);
            assert!(gaps(&drawn) > 10, "{name}: no gaps");
        }
    }
}

// The picture.

/// A slab before a slanted one, seen from above: what is mirrored is above the horizon.
fn slabs(size: vk::Extent2D) -> Shot {
    let mut points = scenes::block(6, SPACING, [8, 6, 3], [-1.3, -0.7, 3.0]);
    let slanted = scenes::block(7, SPACING, [34, 20, 4], [-4.2, -2.4, 6.0]);
    points.extend(slanted.into_iter().map(|[x, y, z]| [x, y, z + 0.3 * x]));
    let mut shot = shot_of(size, Lens::Standard, &points);
    let view = Mat4::look_to_rh(Vec3::new(1.0, 9.0, 2.0), Vec3::NEG_Y, Vec3::NEG_Z);
    shot.camera = Camera { view, ..shot.camera };
    shot.positions = scenes::world(&shot.camera, &points);
    shot.settings.water.specular = 0.0;
    shot
}

/// What the twins of a picture take.
struct Layers {
    depth: Image<f64>,
    smoothed: Image<f64>,
    all: Image<f64>,
    color: Image<[f64; 4]>,
    scene: Image<f64>,
    boundaries: Image<f64>,
    back_surface: Image<f64>,
    parts: Image<[f64; 3]>,
    noise: Option<(Image<f64>, Look)>,
}

impl Layers {
    fn new(drawn: &Drawn, shot: &Shot) -> Self {
        let (width, height) = (shot.size.width as usize, shot.size.height as usize);
        let color = shot.color.iter().map(|c| c.map(f64::from)).collect();
        Self {
            depth: wide(&drawn.depth),
            smoothed: wide(&drawn.surface),
            all: drawn.thickness.map(|t| f64::from(*t)),
            color: Image::from_vec(width, height, color).expect("the output's size"),
            scene: shot.scene_eye(),
            boundaries: wide(&of(drawn).boundaries),
            back_surface: wide(&of(drawn).surface),
            parts: of(drawn).thickness.map(|t| t.map(f64::from)),
            noise: drawn.noise.as_ref().map(|image| (wide(image), noise_look(shot, image))),
        }
    }

    fn inputs(&self, level: u32, thickness_level: u32) -> Inputs<'_> {
        Inputs {
            depth: &self.depth,
            smoothed: &self.smoothed,
            level,
            thickness: &self.all,
            thickness_level,
            scene_color: &self.color,
            scene_depth: &self.scene,
            noise: self.noise.as_ref().map(|(image, look)| Ripples { image, look: *look }),
        }
    }

    fn behind(&self, level: u32) -> Behind<'_> {
        Behind {
            boundaries: &self.boundaries,
            thickness: &self.parts,
            smoothed: &self.back_surface,
            level,
        }
    }
}

/// How many pixels were of each kind.
#[derive(Clone, Copy, Debug, Default)]
struct Kinds {
    /// No boundary, and the back sheet itself.
    one: usize,
    behind: usize,
    /// The front sheet over the back one: that is there, partly, or not found.
    both: usize,
    partly: usize,
    unfound: usize,
    /// There is not only air between them.
    touching: usize,
    /// The surface is of the back sheet's image, in part.
    mixed: usize,
    unsure: usize,
}

impl std::ops::AddAssign for Kinds {
    fn add_assign(&mut self, other: Self) {
        self.one += other.one;
        self.behind += other.behind;
        self.both += other.both;
        self.partly += other.partly;
        self.unfound += other.unfound;
        self.touching += other.touching;
        self.mixed += other.mixed;
        self.unsure += other.unsure;
    }
}

/// Asserts that a picture under an even sky is the twin's, of the layers that were read back. Bounds
/// and what is undecided are as in tests of `composite`.
fn check_picture(
    name: &str,
    drawn: &Drawn,
    shot: &Shot,
    thickness_level: u32,
    bits: u32,
    fault: fn(&mut Layers),
) -> Kinds {
    let view = shot.view(shot.size);
    let settings = twin_settings(shot, &view);
    let back_level = back_level(name, drawn, shot);
    let mut layers = Layers::new(drawn, shot);
    fault(&mut layers);
    let inputs = layers.inputs(back_level - 1, thickness_level);
    let behind = layers.behind(back_level);
    let (sky, falloff) = (Sky::Even.radiance(DVec3::Y), settings.falloff * settings.radius);
    let mut expected = twin::shade_sheets(&inputs, &behind, &settings, |_| sky, &view);
    let mut bounds = Image::new(view.width, view.height, [0.0; 4]);
    let filter = Filter { bits, sky_slope: 0.0, sky_error: 0.0 };
    let two = Two::new(&inputs, &behind, &settings, &view);
    let (mut kinds, mut decisions) = (Kinds::default(), 0);
    let pixels = (0..view.height).flat_map(|y| (0..view.width).map(move |x| (x, y)));
    for (x, y) in pixels {
        let Some(shown) = two.at(x, y) else { continue };
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let (displaced, z) = look_up_both(&settings, &shown, &view, pixel);
        let (q, asked) = cut_look_up(&inputs, z, pixel, displaced);
        let seen = (scene_at(&inputs, q), [sky; 2]);
        let Shaded { color, moved } =
            shaded_both(&inputs, &behind, &settings, &shown, &view, (x, y), seen, &filter);
        for (i, c) in color.iter().enumerate() {
            let twin = expected.at(x, y)[i];
            let same = (c.v - twin).abs() <= 16.0 * U * (1.0 + twin);
            assert!(same, "{name} at ({x}, {y}): two orders, {} and {twin}, {shown:?}", c.v);
        }
        let moved = moved + 2.0 / f64::from(1 << bits);
        decisions += asked.len();
        let sides = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let either_way = |q: &DVec2| {
            let either = sides.map(|(dx, dy)| hidden(&inputs, z, *q + DVec2::new(dx, dy) * moved));
            either.iter().any(|h| *h != either[0])
        };
        // Depths are means of 13u, mixed once more; the falloff a product.
        let front = -shown.front.position.z;
        let mut unsure = shown.front.parts.margin <= 40.0 * U * (front + falloff);
        if let Some(back) = shown.back.filter(|back| is_surface(back.nearest)) {
            let (z, scene) = (-back.surface.position.z, inputs.scene(x, y));
            let near = 40.0 * U * (back.nearest + falloff);
            unsure |= shown.front.parts.margin <= near || (z - scene).abs() <= 40.0 * U * z;
        }
        unsure |= shown.barely || asked.iter().any(either_way);
        if unsure {
            kinds.unsure += 1;
            *expected.at_mut(x, y) = drawn.output.at(x, y).map(f64::from);
        } else {
            let kind = match &shown.back {
                Some(back) if back.covered == 0.0 => &mut kinds.unfound,
                Some(back) if back.covered < 1.0 => &mut kinds.partly,
                Some(_) => &mut kinds.both,
                None if shown.parted => &mut kinds.behind,
                None => &mut kinds.one,
            };
            *kind += 1;
            let apart = shown.back.map_or(1.0, |back| back.apart);
            kinds.touching += usize::from(apart < 0.999);
            kinds.mixed += usize::from(shown.front.parts.mixed > 0.01);
        }
        *bounds.at_mut(x, y) = [color[0].e, color[1].e, color[2].e, 0.0];
    }
    let census = compare::close_color(name, &drawn.output, &expected, |x, y| bounds.at(x, y));
    if std::env::var_os("WHITEWATER_VERBOSE").is_some() {
        eprintln!("{name}: {kinds:?}, {census}");
    }
    let unsure = kinds.unsure;
    assert!(unsure * 50 <= decisions, "{name}: {unsure} undecided of {decisions} decisions");
    kinds
}

const MEDIA: [(&str, Medium); 3] = [
    ("pool", Medium::POOL),
    ("milk", Medium::MILK),
    ("none", Medium::Physical { absorption: [0.0; 3], scattering: [0.0; 3] }),
];

/// An environment that is the same in all directions.
fn even(gpu: &Gpu, config: Config) -> Rig<'_> {
    let mut rig = Rig::new(gpu, &config);
    let [r, g, b] = Sky::Even.radiance(DVec3::Y).as_vec3().to_array();
    rig.environment(extent(4, 2), &[[r, g, b, 1.0]; 8]);
    rig
}

/// A highlight that is wide, and a scene of one colour or the gradient.
fn look(mut shot: Shot, flat: bool) -> Shot {
    let water = &mut shot.settings.water;
    (water.specular, water.shininess) = (0.3, 20.0);
    // Where there is any: on the front sheet alone.
    shot.settings.noise.foam = 1.0;
    if flat {
        shot.color.fill(FLAT);
    }
    shot
}

/// Two sheets, at all resolutions and by both ways of shading; what is not only air between them, and
/// surfaces that only the back sheet's image has.
#[test]
fn the_picture_of_two_sheets_is_the_twins() {
    let gpu = Gpu::shared();
    let bits = gpu.limits().sub_texel_precision_bits;
    let size = extent(160, 100);
    let mut kinds = Kinds::default();
    let levels = [(0, 0), (1, 2), (2, 3), (1, 1), (0, 1), (2, 1)];
    for (smoothing_level, thickness_level) in levels.into_iter().take(some(3)) {
        for (way, splat) in [(Shading::Raster, Splat::Compute), (Shading::Compute, Splat::Raster)] {
            let config = Config {
                smoothing_level,
                thickness_level,
                coarsening: 0,
                composite: Some(way),
                thickness_splat: Some(splat),
                noise: (way == Shading::Compute).then_some(1),
                ..two(size)
            };
            let mut rig = even(&gpu, config);
            for (scene, lens) in
                [("torn", Lens::Standard), ("torn", Lens::OffAxis), ("slabs", Lens::Standard)]
            {
                for flat in [true, false] {
                    let shot = if scene == "torn" { shot(size, lens) } else { slabs(size) };
                    let shot = look(shot, flat);
                    let name = format!(
                        "picture-{smoothing_level}{thickness_level}-{way:?}-{scene}-{lens:?}-{flat}"
                    );
                    let drawn = rig.draw(&shot);
                    kinds += check_picture(&name, &drawn, &shot, thickness_level, bits, |_| ());
                }
            }
        }
    }
    let Kinds { one, behind, both, partly, unfound, touching, mixed, .. } = kinds;
    let least = [one, behind, both, partly, unfound, touching, mixed];
    assert!(least.iter().all(|pixels| *pixels >= 100), "{kinds:?}");
}

#[test]
fn the_front_sheet_lies_over_the_back_one() {
    let gpu = Gpu::shared();
    let bits = gpu.limits().sub_texel_precision_bits;
    let size = extent(96, 64);
    for way in [Shading::Raster, Shading::Compute].into_iter().take(some(1)) {
        let mut rig = even(&gpu, Config { coarsening: 0, composite: Some(way), ..two(size) });
        for (medium_name, medium) in MEDIA.into_iter().chain([("source", Medium::source(0.3))]) {
            for bias in [0.0, 0.3] {
                for flat in [true, false] {
                    let mut shot = look(slabs(size), flat);
                    shot.settings.water.medium = medium;
                    shot.settings.water.fresnel = Fresnel::Source { bias, scale: 0.2, power: 2.0 };
                    let name = format!("over-{medium_name}-{bias}-{flat}-{way:?}");
                    let kinds = check_picture(&name, &rig.draw(&shot), &shot, 2, bits, |_| ());
                    assert!(kinds.both > 100, "{name}: {kinds:?}");
                }
            }
        }
    }
}

/// What stands between the sheets or behind both hides and is not refracted.
#[test]
fn the_scene_stands_among_the_sheets() {
    let gpu = Gpu::shared();
    let bits = gpu.limits().sub_texel_precision_bits;
    let size = extent(160, 100);
    let mut kinds = Kinds::default();
    for (smoothing_level, thickness_level) in [(0, 0), (1, 2)] {
        let config = Config { smoothing_level, thickness_level, coarsening: 0, ..two(size) };
        let mut rig = even(&gpu, config);
        for lens in [Lens::Standard, Lens::OffAxis] {
            let mut shot = look(shot(size, lens), false);
            shot.settings.water.refraction = 0.6;
            shot.scene_depth(|x, y| ((x / 9 + y / 5) % 2 == 0).then_some(3.2 + f64::from(y % 9)));
            let name = format!("among-{smoothing_level}{thickness_level}-{lens:?}");
            kinds += check_picture(&name, &rig.draw(&shot), &shot, thickness_level, bits, |_| ());
        }
    }
    assert!(kinds.unfound > 100 && kinds.both > 100, "{kinds:?}");
}

type Fault = fn(&mut Layers);

/// Faults of the layers that a picture's check must see.
const FAULTS: [(&str, Fault); 7] = [
    ("order", |layers| layers.parts.data.iter_mut().for_each(|t| t.swap(0, 1))),
    ("front", |layers| layers.parts.data.iter_mut().for_each(|t| t[0] *= 1.001)),
    ("back", |layers| layers.parts.data.iter_mut().for_each(|t| t[1] *= 1.001)),
    ("window", |layers| layers.parts.data.iter_mut().for_each(|t| t[2] *= 1.05)),
    ("all", |layers| layers.all.data.iter_mut().for_each(|t| *t *= 1.001)),
    ("depth", |layers| layers.back_surface.data.iter_mut().for_each(|z| *z *= 1.05)),
    ("boundary", |layers| layers.boundaries.data.iter_mut().for_each(|b| *b -= 1.0)),
];

/// The checker of the picture passes the twins' own, and sees what is off by little.
#[test]
fn a_planted_fault_of_the_picture_is_seen() {
    let size = extent(160, 100);
    for (smoothing_level, thickness_level) in [(0, 0), (1, 2)] {
        for flat in [true, false].into_iter().take(some(1)) {
            let shot = look(shot(size, Lens::Standard), flat);
            let drawn = twins_frame(&shot, smoothing_level, thickness_level);
            let check = |fault| {
                check_picture("planted-picture", &drawn, &shot, thickness_level, 8, fault);
            };
            check(|_| ());
            for (name, fault) in FAULTS {
                let seen = fails(|| check(fault));
                assert!(seen, "{name} passes at {smoothing_level}{thickness_level}, {flat}");
            }
        }
    }
}
