//! Passes `gaps` and `back`, the thickness of each sheet, and two sheets in the picture: water
//! behind water. This file has the scenes: drops and a torn sheet before a pool.

mod back;
mod boundaries;
mod picture;
mod thickness;
mod through;
mod unchanged;

use ash::vk;
use whitewater::Config;
use whitewater::water::Splat;

use crate::reference::cull::{CullParams, cull};
use crate::reference::sheets::Rule;
use crate::reference::{Image, Sphere};
use crate::support::rig::{Drawn, Sheets, Shot, config};
use crate::support::scenes::{Lens, Random};
use crate::support::{compare, slow};

const SPACING: f32 = 0.25;

type Points = Vec<[f32; 3]>;

/// Number of cases to test; all of them in the long tests.
fn some(cases: usize) -> usize {
    if slow() { usize::MAX } else { cases }
}

fn jittered(random: &mut Random, at: [f32; 3], part: f32) -> [f32; 3] {
    at.map(|v| v + SPACING * part * random.between(-0.2, 0.2))
}

/// Two layers of water below the eye, (x, y, depth) in eye space: level (0) or wavy (1).
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
    config(size).with(|it| it.sheets = 2)
}

/// A configuration with two sheets whose thickness is splatted at a level.
fn splatted(size: vk::Extent2D, splat: Splat, thickness_level: u32) -> Config {
    two(size).with(|it| {
        it.thickness_splat = Some(splat);
        it.thickness_level = thickness_level;
    })
}

fn of(drawn: &Drawn) -> &Sheets {
    drawn.sheets.as_ref().expect("two sheets")
}

/// Number of texels with two sheets.
fn gaps(drawn: &Drawn) -> usize {
    of(drawn).boundaries.data.iter().filter(|b| **b < 1e9).count()
}

/// The spheres that culling keeps.
fn visible(shot: &Shot) -> Vec<Sphere> {
    let water = &shot.settings.water;
    let params = CullParams::new(f64::from(water.radius()), f64::from(water.rest_density));
    cull(&shot.positions, shot.densities.as_deref(), &params, &shot.view(shot.size)).visible
}

fn spacing(shot: &Shot) -> f64 {
    f64::from(shot.settings.water.spacing)
}

/// Parameters of a shot's boundaries.
fn rule(shot: &Shot) -> Rule {
    Rule { spacing: spacing(shot), falloff: f64::from(shot.falloff()) }
}

/// Asserts that two images are equal in the texels that are `sure`.
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
