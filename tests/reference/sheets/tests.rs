//! The twin of the sheets against closed forms.

use super::super::tests::view;
use super::super::thickness::{self, Amplitude};
use super::super::{EMPTY, Image, Sphere, View, depth, is_surface};
use super::boundaries::*;
use super::judged::*;
use super::*;
use glam::{DVec2, DVec3};

const SPACING: f64 = 0.5;
const RADIUS: f64 = 0.656 * SPACING;

fn at(x: f64, y: f64, z: f64) -> Sphere {
    Sphere { center: DVec3::new(x, y, -z), radius: RADIUS }
}

/// Spheres behind each other in the middle of a pixel of the view of one cell.
fn row(depths: &[f64]) -> Vec<Sphere> {
    let ray = wide(8, 8).ray(4, 4);
    depths.iter().map(|z| at(ray.x * z, ray.y * z, *z)).collect()
}

/// A lattice of particles that faces the eye and covers the view at its depth.
fn plane(z: f64) -> Vec<Sphere> {
    let n = (2.0 * z / SPACING) as i32;
    let along = |i: i32| f64::from(i) * SPACING;
    (-n..=n).flat_map(|y| (-n..=n).map(move |x| at(along(x), along(y), z))).collect()
}

/// A view 45 degrees to either side.
fn wide(width: usize, height: usize) -> View {
    view(DVec2::new(1.0, -1.0), DVec2::ZERO, width, height)
}

/// More than single precision rounds.
fn rounded(sphere: &Sphere) -> Slack {
    Slack { depth: 1e-5 * sphere.center.z.abs(), pixels: 1.0 / 32.0 }
}

/// The boundary of a view of one cell.
fn one(spheres: &[Sphere]) -> f64 {
    let found = boundaries(spheres, &wide(8, 8), SPACING);
    assert_eq!((found.width, found.height), (1, 1));
    found.data[0]
}

#[test]
fn a_drop_before_a_plane_is_a_sheet_of_its_own() {
    let view = wide(64, 64);
    // Pixels are 0.266 wide at the drop: it spans 2.5 of them, in the middle of cell (5, 2).
    let drop = at(44.0 * 8.5 / 32.0 - 8.5, 8.5 - 20.0 * 8.5 / 32.0, 8.5);
    let mut spheres = plane(10.0);
    spheres.push(drop);
    let found = boundaries(&spheres, &view, SPACING);
    for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
        // The drop marks slices 0 and 1, the plane 4 (from (1.5 - 0.375) / 0.25 on) to 7.
        let expected = if (x, y) == (5, 2) { 8.5 + 3.0 * 0.25 } else { EMPTY };
        assert_eq!(found.at(x, y), expected, "({x}, {y})");
    }
    // Nearer to the plane the air between is less than a slice.
    assert_eq!(one(&row(&[8.0, 10.0])), 9.0);
    assert_eq!(one(&row(&[8.75, 10.0])), 9.375);
    assert_eq!(one(&row(&[9.0, 10.0])), EMPTY);
}

#[test]
fn contiguous_water_is_one_sheet_and_no_water_none() {
    let mut block = Vec::new();
    for layer in 0..8 {
        block.extend(plane(6.0 + f64::from(layer) * SPACING));
    }
    let view = wide(50, 33);
    let found = boundaries(&block, &view, SPACING);
    assert_eq!((found.width, found.height), (7, 5));
    assert!(found.data.iter().all(|b| *b == EMPTY));
    assert!(boundaries(&[], &view, SPACING).data.iter().all(|b| *b == EMPTY));
    assert_eq!(one(&row(&[6.0])), EMPTY);
}

#[test]
fn the_last_air_before_a_body_decides() {
    // Slices 0 and 1, 6 to 9, 14 to 19: the last are a body.
    assert_eq!(one(&row(&[9.5, 5.0, 9.0, 7.0])), 5.0 + 12.0 * 0.25);
    // 14 to 18 are none: the first air.
    assert_eq!(one(&row(&[5.0, 7.0, 9.0, 9.25])), 5.0 + 4.0 * 0.25);
    // All to the last slice are, and the last body decides.
    assert_eq!(one(&row(&[5.0, 7.0, 40.0])), 5.0 + 20.5 * 0.25);
    assert_eq!(one(&row(&[5.0, 7.0, 7.5, 40.0])), 5.0 + 21.5 * 0.25);
    // A drop behind a body is of its sheet.
    assert_eq!(one(&row(&[5.0, 7.0, 7.5, 10.0])), 5.0 + 4.0 * 0.25);
    // What is before the air need be none.
    assert_eq!(one(&row(&[5.0, 5.5, 6.0, 8.0, 8.5])), 5.0 + 0.5 * (6.0 + 10.0) * 0.25);
}

#[test]
fn boundaries_are_spread_to_the_cells_round() {
    let mut cells = Image::new(5, 4, EMPTY);
    *cells.at_mut(0, 0) = 4.0;
    *cells.at_mut(2, 1) = 8.0;
    let found = spread(&cells);
    // By 1 over the square of the distance: half on the diagonal.
    let (both, far) = ((4.0 + 0.5 * 8.0) / 1.5, (0.5 * 4.0 + 8.0) / 1.5);
    let expected = [
        [4.0, both, 8.0, 8.0, EMPTY],
        [4.0, far, 8.0, 8.0, EMPTY],
        [EMPTY, 8.0, 8.0, 8.0, EMPTY],
        [EMPTY; 5],
    ];
    for (y, x) in (0..4).flat_map(|y| (0..5).map(move |x| (y, x))) {
        assert!((found.at(x, y) - expected[y][x]).abs() < 1e-12, "({x}, {y})");
    }
}

#[test]
fn texels_are_between_the_cells_that_have_one() {
    let view = wide(40, 8);
    let mut cells = Image::new(5, 1, EMPTY);
    *cells.at_mut(0, 0) = 4.0;
    *cells.at_mut(1, 0) = 6.0;
    *cells.at_mut(2, 0) = 8.0;
    // The middle of texel p lies at p / 2 - 1 / 4 from that of the first cell; the fourth cell
    // has its boundary of the third.
    let found = of_texels(&cells, &view, 2);
    assert_eq!((found.width, found.height), (10, 2));
    let expected = [4.0, 4.5, 5.5, 6.5, 7.5, 8.0, 8.0, 8.0, 8.0, EMPTY];
    for (x, expected) in expected.into_iter().enumerate() {
        assert_eq!([found.at(x, 0), found.at(x, 1)], [expected; 2], "{x}");
    }
    // Each texel of level 3 is a cell.
    let found = of_texels(&cells, &view, 3);
    assert_eq!(found.data, [4.0, 6.0, 8.0, 8.0, EMPTY]);
    assert_eq!(of_texels(&cells, &view, 0).at(8, 5), 4.0 * 0.4375 + 6.0 * 0.5625);
}

#[test]
fn the_last_slice_holds_all_that_is_farther() {
    assert_eq!(one(&row(&[5.0, 40.0])), 9.125);
    assert_eq!(one(&row(&[5.0, 1e12])), 9.125);
    let until = |z: f64| -> Vec<f64> {
        (0..).map(|i| 5.0 + 0.25 * f64::from(i)).take_while(|d| *d <= z).collect()
    };
    // The layer at 12 marks to slice 29 (7.375 / 0.25), that at 12.25 to 30, at 12.5 to 31.
    for (last, far, expected) in [
        (12.0, Some(40.0), 5.0 + 30.5 * 0.25),
        (12.0, None, EMPTY),
        (12.25, Some(40.0), EMPTY),
        (12.25, None, EMPTY),
        (12.5, Some(40.0), EMPTY),
    ] {
        let mut depths = until(last);
        depths.extend(far);
        assert_eq!(one(&row(&depths)), expected, "{last} {far:?}");
    }
}

#[test]
fn a_sphere_at_the_eye_takes_no_part() {
    for (radii, expected) in [(1.005, EMPTY), (0.5, EMPTY), (-3.0, EMPTY), (1.02, 1.02)] {
        let z = radii * RADIUS;
        let expected = if expected == EMPTY { EMPTY } else { z + 16.5 * 0.25 };
        assert_eq!(one(&row(&[z, 10.0])), expected, "{radii} radii");
    }
}

/// All pixels that see the sphere are in its span, whose sides are those of the silhouette.
#[test]
fn a_span_bounds_the_projection() {
    for (focal, shift) in [
        (DVec2::new(0.9, -1.2), DVec2::new(0.2, -0.1)),
        (DVec2::new(-0.7, 0.8), DVec2::new(-0.4, 0.3)),
    ] {
        let view = view(focal, shift, 400, 300);
        for (x, y, z) in [(0.0, 0.0, 1.5), (0.9, -0.4, 2.0), (-0.3, 0.6, 1.1)] {
            let sphere = at(x, y, z);
            let (columns, rows) = span(&sphere, &view, GROWN).expect("bounds");
            let depth = depth::splat(&[sphere], &view);
            let seen: Vec<_> = (0..300)
                .flat_map(|y| (0..400).map(move |x| (x, y)))
                .filter(|(x, y)| is_surface(depth.at(*x, *y)))
                .collect();
            let ends = |pick: fn(&(usize, usize)) -> usize| {
                let all = || seen.iter().map(pick);
                all().min().unwrap_or(0)..all().max().unwrap_or(0) + 1
            };
            for (found, silhouette) in [(columns, ends(|p| p.0)), (rows, ends(|p| p.1))] {
                // Where the silhouette turns it may pass between the pixels' centres.
                assert!(found.start <= silhouette.start && found.end >= silhouette.end);
                assert!(found.start + 1 >= silhouette.start && found.end <= silhouette.end + 1);
            }
        }
    }
    // By the closed form: 0.5 of 0.4 / sqrt(0.9999 - 0.16) of it either side of the middle.
    let view = wide(100, 100);
    let sphere = Sphere { center: DVec3::new(0.0, 0.0, -1.0), radius: 0.4 };
    let half = 50.0 * 0.4 / (1.0_f64 - 0.16).sqrt();
    let (first, last) = ((49.5 - half).ceil() as usize, (49.5 + half).floor() as usize);
    assert_eq!(span(&sphere, &view, 0.0), Some((first..last + 1, first..last + 1)));
    // Between the centres of pixels there are none, grown there are.
    let tiny = Sphere { center: DVec3::new(0.0, 0.0, -1.0), radius: 1e-4 };
    assert!(span(&tiny, &view, GROWN).is_some_and(|(columns, _)| columns.is_empty()));
    assert_eq!(span(&tiny, &view, 0.5), Some((49..51, 49..51)));
}

#[test]
fn a_cell_is_certain_unless_rounding_decides() {
    let view = wide(8, 8);
    let judge = |depths: &[f64]| judged(&row(depths), &view, SPACING, rounded).data[0];
    let apart = judge(&[8.5, 10.0]);
    assert!(apart.certain && apart.boundary == 9.25, "{apart:?}");
    assert!(apart.low < 9.25 && apart.high > 9.25 && apart.high - apart.low < 2e-4);
    let none = |known: Known| known.certain && known.maybe_none && !known.maybe_one;
    assert!(none(judge(&[8.5])) && none(judge(&[8.5, 9.5])));
    // The second marks from slice 3 on, or from 2 on: a gap or none.
    let edge = 8.5 + 3.0 * 0.25 + 0.375;
    let either = judge(&[8.5, edge]);
    assert!(!either.certain && either.maybe_none && either.maybe_one, "{either:?}");
    assert!(judge(&[8.5, edge + 1e-3]).certain);
    // The same of slices 4 and 3, or of where the first sheet ends: a gap that is wider or not.
    for depths in [&[8.5, edge + 0.25][..], &[8.5, 8.875, 12.0]] {
        let either = judge(depths);
        assert!(!either.certain && !either.maybe_none, "{either:?}");
        assert!((either.high - either.low - 0.125).abs() < 1e-3, "{either:?}");
    }
    // What is not known of a cell is not known of the texels round it.
    let view = wide(16, 8);
    let mut cells = Image::new(2, 1, judge(&[8.5, 10.0]));
    *cells.at_mut(1, 0) = either;
    let texels = judged_texels(&cells, &view, 3);
    assert!(texels.at(0, 0).certain && !texels.at(1, 0).certain);
    // It may have the boundary of the first, or its own; never none.
    let Known { low, high, maybe_none, .. } = texels.at(1, 0);
    assert!(!maybe_none && low <= either.low && high >= either.high && high > 9.2499);
    assert!(!judged_texels(&cells, &view, 2).at(1, 0).certain);
    let view = wide(8, 8);
    // A sphere that may touch the cell or not.
    let beside = |by: f64| {
        // Its left tangent passes the middle of the last pixel at so many pixels.
        let angle = ((3.5 + by) / 4.0).atan() + (RADIUS / 10.0).asin();
        let (x, z) = (10.0 * angle.sin(), 10.0 * angle.cos());
        let spheres = [row(&[6.0])[0], at(x, view.ray(4, 4).y * z, z)];
        judged(&spheres, &view, SPACING, rounded).data[0]
    };
    let (outside, edge, inside) = (beside(0.1), beside(GROWN), beside(-0.1));
    assert!(none(outside) && outside.boundary == EMPTY, "{outside:?}");
    assert!(inside.certain && (inside.boundary - 6.75).abs() < 1e-12, "{inside:?}");
    assert!(!edge.certain, "{edge:?}");
}

#[test]
fn each_sheet_has_its_own_thickness() {
    let view = wide(32, 16);
    // Before, at and behind the boundary, of which the share goes over in half a spacing to
    // either side, the window's in half of one to one.
    let depths = [5.0, 6.875, 7.0, 7.375, 9.0];
    let spheres = depths.map(|z| at(0.5, -0.5, z));
    let (fronts, windows) = ([1.0, 0.84375, 0.5, 0.0, 0.0], [0.0, 1.0, 1.0, 0.5, 0.0]);
    let volume = Amplitude::Volume { particle_volume: 0.1 };
    for level in 0..4 {
        let reduced = view.reduced(level);
        let of = |x: usize, y: usize| if (x + y).is_multiple_of(3) { 7.0 } else { EMPTY };
        let mut boundaries = Image::from_fn(reduced.width, reduced.height, of);
        let mut found = thickness(&spheres, &view, level, &boundaries, SPACING, volume);
        let splats = spheres.map(|s| thickness::splat(&[s], &reduced, None, volume));
        let mut expected = found.clone();
        for (j, i) in (0..found.height).flat_map(|j| (0..found.width).map(move |i| (j, i))) {
            let sum = |shares: [f64; 5]| -> f64 {
                splats.iter().zip(shares).map(|(splat, share)| splat.at(i, j) * share).sum()
            };
            let all = sum([1.0; 5]);
            let texel = match is_surface(boundaries.at(i, j)) {
                true => [sum(fronts), all - sum(fronts), sum(windows)],
                false => [all, 0.0, 1e6 * all],
            };
            for (found, expected) in found.at(i, j).iter().zip(texel) {
                assert!((found - expected).abs() <= 1e-9 * expected.abs(), "({i}, {j})");
            }
            // Nothing to tell apart.
            *expected.at_mut(i, j) = match texel[0] == 0.0 || texel[1] == 0.0 {
                true => [all, 0.0, 1e6 * all],
                false => found.at(i, j),
            };
        }
        assert!(found.data.iter().any(|[x, y, _]| *x > 0.0 && *y > 0.0));
        prune(&mut boundaries, &mut found);
        assert_eq!(found, expected);
        let split = |[x, y, _]: &[f64; 3]| *x > 0.0 && *y > 0.0;
        let same = boundaries.data.iter().zip(&found.data);
        assert!(same.into_iter().all(|(b, texel)| is_surface(*b) == split(texel)));
    }
}

#[test]
fn the_back_sheet_is_seen_where_there_are_two() {
    // Odd: the last texel goes by the last pixel.
    let view = wide(37, 21);
    let (front, back) = (plane(3.0), plane(9.0));
    let all: Vec<_> = front.iter().chain(&back).copied().collect();
    let mut cells = Image::new(5, 3, EMPTY);
    *cells.at_mut(2, 1) = 6.0;
    *cells.at_mut(4, 2) = 6.0;
    let marked = Image::from_fn(37, 21, |x, y| (100 * y + x) as f64);
    let of = |texels| Boundaries { texels, level: 3 };
    for level in 1..5 {
        let found = back_depth(&all, &view, level, &of(&cells), &marked);
        let hits = depth::splat(&back, &view.reduced(level));
        for (y, x) in (0..found.height).flat_map(|y| (0..found.width).map(move |x| (y, x))) {
            let middle = |i: usize, last: usize| ((2 * i + 1) << (level - 1)).min(last);
            let (px, py) = (middle(x, 36), middle(y, 20));
            let two = (16..24).contains(&px) && (8..16).contains(&py) || px > 31 && py > 15;
            let expected = if two { hits.at(x, y) } else { marked.at(px, py) };
            assert_eq!(found.at(x, y), expected, "({x}, {y}) of {level}");
        }
        assert!(hits.data.iter().any(|z| is_surface(*z)));
    }
    // Of the spheres of the back alone, and none is left without.
    let found = back_depth(&front, &view, 1, &of(&cells), &marked);
    assert_eq!(found.at(9, 5), EMPTY);
}

#[test]
fn tiles_near_a_gap_are_made() {
    // Level 1: 100 x 60 texels, 7 x 4 tiles.
    let view = wide(200, 120);
    let mut cells = Image::new(25, 15, EMPTY);
    // Pixels 96 to 103, texels 48 to 51: tile 3, next to tile 2.
    *cells.at_mut(12, 0) = 6.0;
    let found = made(&Boundaries { texels: &cells, level: 3 }, &view, 1);
    let depth = Image::new(200, 120, 9.0);
    let filled = back_depth(&[], &view, 1, &Boundaries { texels: &cells, level: 3 }, &depth);
    for (y, x) in (0..60).flat_map(|y| (0..100).map(move |x| (y, x))) {
        let near = (2..=4).contains(&(x / 16)) && y / 16 <= 1;
        assert_eq!(found.at(x, y), near, "({x}, {y})");
        let split = (48..52).contains(&x) && y < 4;
        assert_eq!(filled.at(x, y), if near && !split { 9.0 } else { EMPTY }, "({x}, {y})");
    }
    // The middle of a cell is asked for alone.
    let mut pixels = Image::new(200, 120, EMPTY);
    let any = |pixels: &Image<f64>| {
        made(&Boundaries { texels: pixels, level: 0 }, &view, 1).data.contains(&true)
    };
    *pixels.at_mut(99, 4) = 6.0;
    assert!(!any(&pixels));
    *pixels.at_mut(100, 4) = 6.0;
    assert!(any(&pixels));
}
