//! The thickness of each sheet against the twin, and boundaries where there is only one sheet.

use whitewater::water::Splat;

use crate::harness::fails;
use crate::reduce::wide;
use crate::reference::sheets;
use crate::reference::{EMPTY, Image, Sphere, View, is_surface};
use crate::support::compare;
use crate::support::device::Gpu;
use crate::support::rig::{Rig, Sheets, Shot, extent};
use crate::support::scenes::{LENSES, Lens};
use crate::support::tolerance::{self, Between, Sum, U};

use super::{of, shot, spacing, splatted, two, visible};

/// Whether a sphere certainly belongs to the back sheet, and whether it possibly does. The depth
/// has a rounding error; the boundary is exact, because it was read back.
pub fn is_behind(sphere: &Sphere, boundary: f64, view: &View) -> (bool, bool) {
    let (z, e) = (-sphere.center.z, tolerance::eye_space(sphere.center, view));
    (z - e >= boundary, z + e >= boundary)
}

/// Min and max share of a splat in the front sheet, in the back sheet and in the window. Each share
/// is monotonic in the depth, which is rounded, as is its difference from the boundary. The cubic
/// adds 5u, its argument is a quotient of 5u that counts one and a half times, and the difference
/// from 1 adds 1u.
fn share_bounds(sphere: &Sphere, boundary: f64, spacing: f64, view: &View) -> [(f64, f64); 3] {
    let z = -sphere.center.z;
    let e = tolerance::eye_space(sphere.center, view) + 4.0 * U * (z + boundary + spacing);
    let front = |z: f64| sheets::shares(z, boundary, spacing).0;
    let window = |away: f64| sheets::shares(boundary + away.max(0.0), boundary, spacing).1;
    let away = (z - boundary).abs();
    // A share that is clamped to 0 or 1 has no error.
    let open = |(low, high): (f64, f64)| match (low, high) {
        (_, 0.0) => (0.0, 0.0),
        (1.0, _) => (1.0, 1.0),
        _ => ((low - 14.0 * U).max(0.0), (high + 14.0 * U).min(1.0)),
    };
    let (least, most) = (front(z + e), front(z - e));
    [(least, most), (1.0 - most, 1.0 - least), (window(away + e), window(away - e))].map(open)
}

/// Bounds of the thickness of the front sheet, of the back sheet and of the window, for the
/// boundaries that were read back. In texels without a boundary they are 0.
fn thickness_bounds(shot: &Shot, boundaries: &Image<f32>, level: u32, sum: Sum) -> [Between; 3] {
    let (spheres, view, boundaries) = (visible(shot), shot.view(shot.size), wide(boundaries));
    [0, 1, 2].map(|i| {
        let rest = i == 1 && sum == Sum::Fixed;
        let splats = shot.splats(&spheres, level, if rest { Sum::FixedRest } else { sum });
        tolerance::thickness_where(&splats, |x, y, sphere| match boundaries.at(x, y) {
            boundary if is_surface(boundary) => {
                share_bounds(sphere, boundary, spacing(shot), &view)[i]
            }
            _ => (0.0, 0.0),
        })
    })
}

/// Asserts that the thickness of all water and of each sheet is the twin's, for the boundaries that
/// were read back. Returns the number of texels with water of both sheets.
pub fn check_thickness(
    name: &str,
    all: &Image<f32>,
    found: &Sheets,
    shot: &Shot,
    level: u32,
    sum: Sum,
) -> usize {
    let spheres = visible(shot);
    let bounds = tolerance::thickness(&shot.splats(&spheres, level, sum));
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
            // With one sheet the sums are equal. A blended sum is rounded as often as there are
            // splats.
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
            let config = two(size).with(|it| {
                it.thickness_splat = thickness_splat;
                it.thickness_level = thickness_level;
            });
            let mut rig = Rig::new(&gpu, &config);
            let lenses = if level == 1 { &LENSES[..] } else { &[Lens::Reversed, Lens::OffAxis] };
            for lens in lenses {
                let mut shot = shot(size, *lens);
                let name = format!("sheets-thickness-{splat:?}-{level}-{lens:?}");
                let drawn = rig.draw(&shot);
                let both = check_thickness(&name, &drawn.thickness, of(&drawn), &shot, level, sum);
                // At least a tenth of the picture.
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

/// Asserts that pruning removes only boundaries of texels whose water is all of one sheet, and
/// changes no other boundary. Returns the indices of texels with a boundary that certainly have one
/// sheet, and of those that certainly have two.
fn check_pruned(
    name: &str,
    pruned: &Image<f32>,
    found: &Image<f32>,
    shot: &Shot,
    level: u32,
    sum: Sum,
) -> [Vec<usize>; 2] {
    let [front, back, _] = thickness_bounds(shot, found, level, sum);
    // What is no water: a fixed-point sum of zero, a blended one below half a fixed-point step.
    let (spheres, least) = (visible(shot), f64::MIN_POSITIVE);
    let least =
        if sum == Sum::Float { 0.5 * shot.splats(&spheres, level, sum).unit() } else { least };
    let (mut one, mut two) = (Vec::new(), Vec::new());
    for (i, (pruned, found)) in pruned.data.iter().zip(&found.data).enumerate() {
        let at = (i % front.low.width, i / front.low.width);
        if f64::from(*found) == EMPTY || f64::from(*pruned) != EMPTY {
            assert_eq!(pruned.to_bits(), found.to_bits(), "{name} at {at:?}: another boundary");
        }
        if f64::from(*found) == EMPTY {
            continue;
        }
        // Fixed-point addends may all round to zero. The limit of blended sums is a quotient and a
        // product of uniforms in single precision: 2u.
        let none = front.low.data[i].min(back.low.data[i]) < least * (1.0 + 2.0 * U);
        let some = front.high.data[i].min(back.high.data[i]) >= least * (1.0 - 2.0 * U);
        match f64::from(*pruned) == EMPTY {
            true => assert!(none, "{name} at {at:?}: two sheets made one"),
            false => assert!(some, "{name} at {at:?}: one sheet parted"),
        }
        if !some {
            one.push(i);
        }
        if !none {
            two.push(i);
        }
    }
    [one, two]
}

#[test]
fn where_nothing_is_to_be_told_apart_there_is_one_sheet() {
    let gpu = Gpu::shared();
    let size = extent(160, 110);
    for (splat, sum) in [(Splat::Raster, Sum::Float), (Splat::Compute, Sum::Fixed)] {
        let (mut gone, mut kept) = (0, 0);
        for level in 0..4 {
            let mut rig = Rig::new(&gpu, &splatted(size, splat, level));
            for lens in [Lens::Standard, Lens::OffAxis, Lens::LeftHanded] {
                let shot = shot(size, lens);
                let drawn = rig.draw(&shot);
                let Sheets { boundaries: pruned, found, .. } = of(&drawn);
                let name = format!("pruned-{splat:?}-{level}-{lens:?}");
                let check =
                    |pruned: &Image<f32>| check_pruned(&name, pruned, found, &shot, level, sum);
                let [one, two] = check(pruned);
                // A boundary where there is one sheet, and none where there are two.
                let kept_one = one.first().map(|at| (*at, found.data[*at]));
                let lost_two = two.first().map(|at| (*at, EMPTY as f32));
                for (at, to) in kept_one.into_iter().chain(lost_two) {
                    let mut planted = pruned.clone();
                    planted.data[at] = to;
                    let seen = fails(|| {
                        check(&planted);
                    });
                    assert!(seen, "{name}: {to} in texel {at}");
                }
                gone += one.len();
                kept += two.len();
            }
        }
        assert!(gone > 100 && kept > 100, "{splat:?}: {gone} texels of one sheet, {kept} of two");
    }
}

/// Water that the scene hides at a texel's centre may be visible beside it. Its boundary stays;
/// otherwise pixels along the outline of the scene would show one sheet, in squares of a texel.
#[test]
fn boundaries_stay_where_the_scene_hides_them() {
    let gpu = Gpu::shared();
    let size = extent(160, 110);
    let cases = [Splat::Raster, Splat::Compute].map(|splat| [(splat, 0), (splat, 1), (splat, 2)]);
    for (splat, level) in cases.into_iter().flatten() {
        let mut shot = shot(size, Lens::Standard);
        // A wall before all water, with a slanted upper edge.
        let wall = |x: u32, y: u32| 3 * y > 100 + x;
        shot.scene_depth(|x, y| wall(x, y).then_some(1.0));
        let drawn = Rig::new(&gpu, &splatted(size, splat, level)).draw(&shot);
        let Sheets { boundaries: kept, found, .. } = of(&drawn);
        let (mut hidden, edge) = (0, 1_u32 << level);
        for (i, (found, kept)) in found.data.iter().zip(&kept.data).enumerate() {
            let middle = |i: usize, most: u32| (i as u32 * edge + edge / 2).min(most - 1);
            let width = size.width.div_ceil(edge) as usize;
            let (x, y) = (i % width, i / width);
            if !wall(middle(x, size.width), middle(y, size.height)) {
                continue;
            }
            let name = format!("{splat:?}, level {level}");
            assert_eq!(found.to_bits(), kept.to_bits(), "{name}, texel ({x}, {y})");
            hidden += usize::from(is_surface(f64::from(*found)));
        }
        assert!(hidden > 50 >> level, "{splat:?}, level {level}: {hidden} hidden texels");
    }
}
