//! The boundaries between two sheets against the twin, which tells where rounding may change them.

use glam::Vec3;
use whitewater::water::Splat;

use crate::harness::fails;
use crate::reduce::wide;
use crate::reference::sheets::{self, CELL, Cell, GROWN, KnownTexel, Part};
use crate::reference::{EMPTY, Image, Sphere, depth, is_surface};
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Shot, extent};
use crate::support::scenes::{self, LENSES, Lens, Random};
use crate::support::tolerance::{self, U};

use super::{of, rule, shot, spacing, splatted, visible};

/// Number of texels that spheres touch, that have a boundary, and that rounding leaves undecided.
#[derive(Clone, Copy, Debug, Default)]
pub struct Texels {
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
    /// Asserts that there were enough gaps, and that rounding left few texels undecided.
    fn suffice(&self, name: &str) {
        assert!(self.split * 10 > self.touched, "{name}: hardly a gap in {self:?}");
        assert!(self.unsure * 20 < self.touched, "{name}: too many are open of {self:?}");
    }
}

/// Relative rounding error of a boundary. An end of an air gap has an error of 4u. Its middle and
/// the mean's products and sums add 9u, the sum of the weights and the quotient 6u, the limits 6u.
const RELATIVE: f64 = 25.0 * U;

/// What is known of a shot's boundaries, given the depth that was read back.
fn judged(shot: &Shot, depth: &Image<f32>, level: u32) -> Image<KnownTexel> {
    let (spheres, view) = (visible(shot), shot.view(shot.size));
    let rounded = |sphere: &Sphere| tolerance::span(sphere, &view);
    let cells = sheets::judged(&spheres, &view, spacing(shot), rounded);
    sheets::judged_texels(&cells, &wide(depth), level, rule(shot), RELATIVE)
}

/// Asserts that the boundaries are the twin's, computed from the depth that was read back. A
/// boundary that depends on rounding must still lie in the depth range of the cells.
pub fn check_boundaries(
    name: &str,
    found: &Image<f32>,
    depth: &Image<f32>,
    shot: &Shot,
    level: u32,
) -> Texels {
    let texels = judged(shot, depth, level);
    assert_eq!((found.width, found.height), (texels.width, texels.height), "{name}");
    let (mut count, mut wrong) = (Texels::default(), Vec::new());
    for (i, (found, texel)) in found.data.iter().zip(&texels.data).enumerate() {
        let split = is_surface(texel.boundary);
        count.touched += usize::from(texel.touched);
        count.split += usize::from(texel.certain && split);
        count.unsure += usize::from(!texel.certain);
        let found = f64::from(*found);
        let (low, high) = (texel.low * (1.0 - RELATIVE), texel.high * (1.0 + RELATIVE));
        let sound = match is_surface(found) {
            true => texel.maybe_one && found >= low && found <= high,
            // Exactly EMPTY, because other passes compare with it.
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

/// A straightforward implementation of the cells in single precision.
fn single_precision(shot: &Shot) -> Image<Cell> {
    let view = shot.view(shot.size);
    let (width, height) = (view.width as f32, view.height as f32);
    let s = shot.settings.water.spacing;
    let p = shot.camera.projection_matrix();
    let (radius, columns) = (shot.settings.water.radius(), view.width.div_ceil(CELL));
    let mut touching = vec![Vec::new(); columns * view.height.div_ceil(CELL)];
    for position in &shot.positions {
        let c = shot.camera.view_matrix().transform_point3(Vec3::from(*position));
        let z = -c.z;
        if z <= 1.01 * radius {
            continue;
        }
        let h = z * z - radius * radius;
        // First and last pixel.
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
    let airs = |depths: &Vec<f32>| {
        let nearest = depths.iter().copied().fold(f32::INFINITY, f32::min);
        let [slice, reach] = [sheets::SLICE, sheets::REACH].map(|part| part as f32 * s);
        let last = sheets::SLICES - 1;
        let slice = |z: f32| ((z - nearest) / slice).floor().clamp(0.0, last as f32) as usize;
        let mut marks = [false; sheets::SLICES];
        for z in depths {
            marks[slice(z - reach)..=slice(z + reach)].fill(true);
        }
        let airs = sheets::airs_of(&marks);
        let spacing = f64::from(s);
        let airs = airs.iter().map(|air| air.behind(f64::from(nearest), spacing)).collect();
        Cell { airs, lent: false }
    };
    Image {
        width: columns,
        height: touching.len() / columns,
        data: touching.iter().map(airs).collect(),
    }
}

/// The twin judges certainty correctly: neither single precision nor any error within the slack
/// changes a certain texel, and wrong boundaries are detected.
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
        let depth = depth::splat(&spheres, &view).map(|z| *z as f32);
        let texels = |cells: &Image<Cell>| {
            sheets::of_texels(cells, &wide(&depth), level, rule(&shot)).map(|b| *b as f32)
        };
        let name = format!("slack-{i}");
        let found = texels(&single_precision(&shot));
        count += check_boundaries(&name, &found, &depth, &shot, level);
        for _ in 0..20 {
            let mut moved = |sphere: &Sphere| -> (f64, Option<Part>) {
                let mut sphere = *sphere;
                let slack = tolerance::span(&sphere, &view);
                sphere.center.z -= signed(slack.depth);
                let grown = GROWN + signed(slack.pixels);
                (-sphere.center.z, sheets::counted(&sphere, &view, spacing(&shot), grown))
            };
            let moved: Vec<_> = spheres.iter().map(&mut moved).collect();
            let other = sheets::cells_from(moved.into_iter(), &view, spacing(&shot));
            check_boundaries(&name, &texels(&other), &depth, &shot, level);
        }
        let split = found.data.iter().position(|b| *b < 1e9).expect("a gap");
        // A texel with one sheet, if there is any.
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
                check_boundaries(&name, &planted, &depth, &shot, level);
            });
            // If rounding decides, either answer may pass.
            let certain = judged(&shot, &depth, level).data[texel].certain;
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
            let mut rig = Rig::new(&gpu, &splatted(size, Splat::Raster, level));
            for lens in LENSES.into_iter().skip(level as usize).step_by(2) {
                let shot = shot(size, lens);
                let name = format!("boundaries-{lens:?}-{width}-{level}");
                let drawn = rig.draw(&shot);
                let found = &of(&drawn).found;
                count += check_boundaries(&name, found, &drawn.depth, &shot, level);
            }
        }
    }
    count.suffice("boundaries");
}

/// Thin water with smaller spheres, and spheres that are classified as spray.
#[test]
fn the_boundaries_are_of_the_drawn_spheres() {
    let gpu = Gpu::shared();
    let (size, mut count) = (extent(160, 110), Texels::default());
    let mut rig = Rig::new(&gpu, &splatted(size, Splat::Compute, 1));
    for (seed, lens) in (4..).zip(LENSES) {
        let (mut shot, mut random) = (shot(size, lens), Random(seed));
        let densities = shot.positions.iter().map(|_| random.between(250.0, 600.0));
        shot.densities = Some(densities.collect());
        let drawn = rig.draw(&shot);
        count += check_boundaries("boundaries-thin", &of(&drawn).found, &drawn.depth, &shot, 1);
    }
    count.suffice("boundaries-thin");
}

/// Spheres around the eye, whose projections are unbounded or large, with many layers behind them.
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
        let drawn = Rig::new(&gpu, &splatted(shot.size, Splat::Raster, 0)).draw(&shot);
        count += check_boundaries("boundaries-near", &of(&drawn).found, &drawn.depth, &shot, 0);
    }
    count.suffice("boundaries-near");
}
