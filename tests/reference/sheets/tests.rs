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

/// Spheres one behind the other, at the centre of a pixel of a view with a single cell.
fn row(depths: &[f64]) -> Vec<Sphere> {
    let ray = wide(8, 8).ray(4, 4);
    depths.iter().map(|z| at(ray.x * z, ray.y * z, *z)).collect()
}

/// A lattice of particles parallel to the image that covers the view at its depth.
fn plane(z: f64) -> Vec<Sphere> {
    let n = (2.0 * z / SPACING) as i32;
    let along = |i: i32| f64::from(i) * SPACING;
    (-n..=n).flat_map(|y| (-n..=n).map(move |x| at(along(x), along(y), z))).collect()
}

/// A view with an angle of 45 degrees to either side.
fn wide(width: usize, height: usize) -> View {
    view(DVec2::new(1.0, -1.0), DVec2::ZERO, width, height)
}

/// A larger error than single precision has.
fn rounded(sphere: &Sphere) -> Slack {
    Slack { depth: 1e-5 * sphere.center.z.abs(), pixels: 1.0 / 32.0 }
}

const RULE: Rule = Rule { spacing: SPACING, falloff: 3.5 * SPACING };

/// The air gaps of a view with a single cell.
fn airs(spheres: &[Sphere]) -> Cell {
    let found = cells(spheres, &wide(8, 8), SPACING);
    assert_eq!((found.width, found.height), (1, 1));
    found.at(0, 0)
}

fn air(from: f64, to: f64, body: f64) -> Air<f64> {
    Air { from, to, body }
}

fn cell_of(airs: &[Air<f64>]) -> Cell {
    Cell { airs: airs.to_vec(), lent: false }
}

/// The boundary of a texel at depth z in a view with a single cell.
fn one(depths: &[f64], z: f64) -> f64 {
    between(&[(airs(&row(depths)), 1.0)], z, RULE).0
}

#[test]
fn a_drop_before_a_plane_is_a_sheet_of_its_own() {
    let view = wide(64, 64);
    // At the drop's depth a pixel is 0.266 wide. The drop spans 2.5 pixels in the middle of cell
    // (5, 2).
    let drop = at(44.0 * 8.5 / 32.0 - 8.5, 8.5 - 20.0 * 8.5 / 32.0, 8.5);
    let mut spheres = plane(10.0);
    spheres.push(drop);
    let found = cells(&spheres, &view, SPACING);
    for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
        // The drop marks slices 0 to 6, the plane slices 17, which is (1.5 - 0.4) / 0.0625, to 30.
        // 14 slices are a drop.
        let expected = if (x, y) == (5, 2) { vec![air(8.9375, 9.5625, 0.0)] } else { Vec::new() };
        assert_eq!(found.at(x, y).airs, expected, "({x}, {y})");
    }
    // The nearer the drop is to the plane, the narrower is the gap: 18, 4 and 3 slices. Less than
    // half a spacing, which is 4 slices, is no gap.
    assert_eq!(one(&[8.0, 10.0], 7.7), 9.0);
    assert_eq!(one(&[8.875, 10.0], 8.55), 9.4375);
    assert_eq!(one(&[8.9375, 10.0], 8.6), EMPTY);
    // A narrow gap joins the water on its two sides: only the gap behind it counts.
    assert_eq!(airs(&row(&[8.0, 9.0, 12.0])).airs, [air(9.4375, 11.5625, 0.0)]);
    assert_eq!(airs(&row(&[8.0, 10.0, 11.0])).airs, [air(8.4375, 9.5625, 1.0)]);
}

#[test]
fn contiguous_water_is_one_sheet_and_no_water_none() {
    let mut block = Vec::new();
    for layer in 0..8 {
        block.extend(plane(6.0 + f64::from(layer) * SPACING));
    }
    let view = wide(50, 33);
    let found = cells(&block, &view, SPACING);
    assert_eq!((found.width, found.height), (7, 5));
    assert!(found.data.iter().all(|cell| *cell == Cell::default()));
    assert!(cells(&[], &view, SPACING).data.iter().all(|cell| *cell == Cell::default()));
    assert!(airs(&row(&[6.0])).airs.is_empty());
}

#[test]
fn the_air_behind_the_surface_decides() {
    // The spheres mark slices 0 to 6, 25 to 38, 57 to 70. No gap counts half, and of equal ones the
    // first is chosen.
    let three = airs(&row(&[9.0, 5.0, 7.0]));
    assert_eq!(three.airs, [air(5.4375, 6.5625, 0.0), air(7.4375, 8.5625, 0.0)]);
    assert_eq!(one(&[9.0, 5.0, 7.0], 4.7), 6.0);
    // The surface of the second sphere, which may lie before the slices that the sphere marks. Then
    // the surface of the last sphere, behind which there is no gap.
    assert_eq!(one(&[9.0, 5.0, 7.0], 6.1), 8.0);
    assert_eq!(one(&[9.0, 5.0, 7.0], 8.7), 8.0);
    assert_eq!(one(&[9.0, 5.0, 7.0], EMPTY), 8.0);
    // A gap before a body is chosen, a gap before a drop is not. The boundary lies close to the
    // water before the gap.
    assert_eq!(one(&[5.0, 8.0, 8.5, 20.0], 4.7), 6.4375);
    assert_eq!(one(&[5.0, 8.0, 20.0, 20.5], 4.7), 9.4375);
    // A gap of 1.125 before a body counts 1.125 / 2.5 and is not chosen; a gap of 1.625 is chosen.
    assert_eq!(one(&[5.0, 7.0, 7.5, 20.0, 20.5], 4.7), 8.9375);
    assert_eq!(one(&[5.0, 7.5, 8.0, 20.0, 20.5], 4.7), 5.4375 + 0.8125);
    // Two layers mark slices 41 to 58: 18 slices are half-way from a drop to a body.
    assert_eq!(airs(&row(&[5.0, 8.0, 8.25])).airs, [air(5.4375, 7.5625, 0.5)]);
    // Five gaps are kept.
    let many: Vec<f64> = (0..8).map(|k| 5.0 + 2.0 * f64::from(k)).collect();
    assert_eq!(airs(&row(&many)).airs.len(), 5);
    assert_eq!(one(&many, EMPTY), 14.0);
}

#[test]
fn airs_are_lent_to_the_cells_round() {
    let mut cells = Image::new(5, 4, Cell::default());
    let (first, second) = ([air(3.0, 5.0, 1.0)], [air(7.0, 9.0, 1.0)]);
    *cells.at_mut(0, 0) = cell_of(&first);
    *cells.at_mut(2, 1) = cell_of(&second);
    let found = spread(&cells);
    // Cells to the left lend first, cells on a diagonal last.
    let expected = [[1, 1, 2, 2, 0], [1, 2, 2, 2, 0], [0, 2, 2, 2, 0], [0; 5]];
    for (y, x) in (0..4).flat_map(|y| (0..5).map(move |x| (y, x))) {
        let airs: [&[Air<f64>]; 3] = [&[], &first, &second];
        let lent = expected[y][x] > 0 && cells.at(x, y).airs.is_empty();
        let expected = Cell { airs: airs[expected[y][x]].to_vec(), lent };
        assert_eq!(found.at(x, y), expected, "({x}, {y})");
    }
}

#[test]
fn texels_are_between_the_cells_whose_airs_overlap() {
    let mut cells = Image::new(5, 1, Cell::default());
    *cells.at_mut(0, 0) = cell_of(&[air(3.0, 5.0, 1.0)]);
    *cells.at_mut(1, 0) = cell_of(&[air(3.5, 5.5, 1.0)]);
    *cells.at_mut(2, 0) = cell_of(&[air(4.25, 6.25, 1.0)]);
    // The centre of texel p lies p / 2 - 1 / 4 cells to the right of the first cell's centre. The
    // fourth cell borrows the gaps of the third.
    let depth = Image::new(40, 8, 2.0);
    let found = of_texels(&cells, &depth, 2, RULE);
    assert_eq!((found.width, found.height), (10, 2));
    let expected = [4.0, 4.125, 4.375, 4.6875, 5.0625, 5.25, 5.25, 5.25, 5.25, EMPTY];
    for (x, expected) in expected.into_iter().enumerate() {
        // In the third texel the second cell has a weight of 3/4. The limits change no boundary,
        // not even in the fifth texel.
        assert_eq!([found.at(x, 0), found.at(x, 1)], [expected; 2], "{x}");
    }
    // At level 3 each texel is one cell.
    let found = of_texels(&cells, &depth, 3, RULE);
    assert_eq!(found.data, [4.0, 4.5, 5.25, 5.25, EMPTY]);
    assert_eq!(of_texels(&cells, &depth, 0, RULE).at(8, 5), 4.0 * 0.4375 + 4.5 * 0.5625);
    // The surface of a texel is the nearest of its pixels.
    let mut near = Image::new(40, 8, 9.0);
    *cells.at_mut(0, 0) = cell_of(&[air(3.0, 5.0, 1.0), air(6.0, 8.0, 1.0)]);
    assert_eq!(of_texels(&cells, &near, 3, RULE).at(0, 0), 7.0);
    *near.at_mut(7, 6) = 2.0;
    assert_eq!(of_texels(&cells, &near, 3, RULE).at(0, 0), 4.0);
}

/// Both cells see both bodies behind the surface, but one of them has no gap before the nearer
/// body.
#[test]
fn what_more_cells_see_is_chosen() {
    let both = cell_of(&[air(3.0, 6.0, 1.0), air(8.0, 12.0, 1.0)]);
    let joined = cell_of(&[air(8.0, 12.0, 1.0)]);
    for (share, expected) in [(0.75, 4.0), (0.51, 4.0), (0.49, 9.0), (0.25, 9.0)] {
        let cells = [(both.clone(), share), (joined.clone(), 1.0 - share)];
        assert_eq!(between(&cells, 2.0, RULE).0, expected, "{share}");
        let cells = [(joined.clone(), 1.0 - share), (both.clone(), share)];
        assert_eq!(between(&cells, 2.0, RULE).0, expected, "{share}, the other way round");
    }
    // Borrowed gaps do not vote, but are used if there are no others.
    let lent = Cell { lent: true, ..both.clone() };
    assert_eq!(between(&[(lent.clone(), 0.9), (joined, 0.1)], 2.0, RULE).0, 9.0);
    assert_eq!(between(&[(lent, 1.0)], 2.0, RULE).0, 4.0);
    // The boundary lies in the range that all chosen gaps share.
    let (far, near) = (cell_of(&[air(3.0, 13.0, 1.0)]), cell_of(&[air(3.0, 3.75, 1.0)]));
    assert_eq!(between(&[(far, 0.75), (near, 0.25)], 2.0, RULE).0, 3.5);
}

#[test]
fn the_last_slice_holds_all_that_is_farther() {
    assert_eq!(airs(&row(&[5.0, 100.0])).airs, [air(5.4375, 5.0 + 255.0 / 16.0, 1.0)]);
    assert_eq!(airs(&row(&[5.0, 1e12])).airs, [air(5.4375, 5.0 + 255.0 / 16.0, 1.0)]);
    let until = |z: f64| -> Vec<f64> {
        (0..).map(|i| 5.0 + 0.25 * f64::from(i)).take_while(|d| *d <= z).collect()
    };
    // The layer at 20.25 marks up to slice 250 (15.65 / 0.0625), which leaves a gap of four slices,
    // the layer at 20.5 up to 254, the layer at 20.75 up to 255.
    for (last, far, air_from) in [
        (20.25, Some(100.0), Some(251.0)),
        (20.25, None, None),
        (20.5, Some(100.0), None),
        (20.75, Some(100.0), None),
    ] {
        let mut depths = until(last);
        depths.extend(far);
        let expected: Vec<_> =
            air_from.map(|k| air(5.0 + k / 16.0, 5.0 + 255.0 / 16.0, 1.0)).into_iter().collect();
        assert_eq!(airs(&row(&depths)).airs, expected, "{last} {far:?}");
    }
}

#[test]
fn a_sphere_at_the_eye_takes_no_part() {
    for (radii, seen) in [(1.005, false), (0.5, false), (-3.0, false), (1.02, true)] {
        let z = radii * RADIUS;
        let expected = if seen { z + 0.4375 + 1.0 } else { EMPTY };
        assert_eq!(one(&[z, 10.0], z - RADIUS), expected, "{radii} radii");
    }
}

/// The span contains all pixels that see the sphere, and ends at the silhouette.
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
                // At its extremes the silhouette may pass between the pixels' centres.
                assert!(found.start <= silhouette.start && found.end >= silhouette.end);
                assert!(found.start + 1 >= silhouette.start && found.end <= silhouette.end + 1);
            }
        }
    }
    // Closed form: the tangents have slopes of 0.4 / sqrt(1 - 0.16), and a slope of 1 is 50 pixels.
    let view = wide(100, 100);
    let sphere = Sphere { center: DVec3::new(0.0, 0.0, -1.0), radius: 0.4 };
    let half = 50.0 * 0.4 / (1.0_f64 - 0.16).sqrt();
    let (first, last) = ((49.5 - half).ceil() as usize, (49.5 + half).floor() as usize);
    assert_eq!(span(&sphere, &view, 0.0), Some((first..last + 1, first..last + 1)));
    // A span between the centres of pixels is empty; if it is grown, it contains pixels.
    let tiny = Sphere { center: DVec3::new(0.0, 0.0, -1.0), radius: 1e-4 };
    assert!(span(&tiny, &view, GROWN).is_some_and(|(columns, _)| columns.is_empty()));
    assert_eq!(span(&tiny, &view, 0.5), Some((49..51, 49..51)));
}

#[test]
fn a_cell_is_certain_unless_rounding_decides() {
    let view = wide(8, 8);
    let judge = |depths: &[f64]| judged(&row(depths), &view, SPACING, rounded).at(0, 0);
    let apart = judge(&[8.5, 10.0]);
    assert!(apart.is_certain() && apart.cell.airs == [air(8.9375, 9.5625, 0.0)], "{apart:?}");
    assert!(apart.rounding > 0.0 && apart.rounding < 2e-4);
    assert!(apart.low < 8.5 && apart.high > 8.5 + 256.0 / 16.0);
    let none = |known: &Known| known.is_certain() && known.cell.airs.is_empty();
    assert!(none(&judge(&[8.5])) && none(&judge(&[8.5, 9.375])));
    assert!(none(&judge(&[8.5, 9.45])));
    // The second sphere marks from slice 11 or from slice 10 on, so there is a gap or none.
    let edge = 8.5 + 11.0 / 16.0 + 0.4;
    let either = judge(&[8.5, edge]);
    assert!(!either.is_certain(), "{either:?}");
    assert!(judge(&[8.5, edge + 1e-3]).is_certain());
    // The second sphere marks from slice 12 or from slice 11 on, or the first sheet ends one slice
    // later: the gap has one width or another.
    for depths in [&[8.5, edge + 0.0625][..], &[8.5, 8.6, 12.0]] {
        assert!(!judge(depths).is_certain(), "{depths:?}");
    }
    // If a cell is uncertain, so are the texels around it.
    let mut cells = Image::new(2, 1, judge(&[8.5, 10.0]));
    *cells.at_mut(1, 0) = either.clone();
    let depth = Image::new(16, 8, 8.2);
    let texels = |level| judged_texels(&cells, &depth, level, RULE, 1e-6);
    let KnownTexel { boundary, low, high, certain, maybe_none, maybe_one, .. } = texels(3).at(0, 0);
    assert!(certain && maybe_one && !maybe_none && low < 9.25 && high > 9.25 && boundary == 9.25);
    assert!(high - low < 4e-4);
    // This texel may have the boundary of the first cell or its own; it always has one.
    let KnownTexel { low, high, certain, maybe_none, maybe_one, .. } = texels(3).at(1, 0);
    assert!(!certain && maybe_one && !maybe_none && low <= 9.0626 && high >= 9.2499);
    assert!(low > 9.055 && high < 9.26, "{low} {high}");
    assert!(!texels(2).at(1, 0).certain);
    // If the surface lies in the middle of the gap, rounding decides whether the gap is behind the
    // surface.
    for (z, certain) in [(9.25, false), (9.25 - 1e-2, true), (9.25 + 1e-2, true)] {
        let depth = Image::new(16, 8, z);
        let texel = judged_texels(&cells, &depth, 3, RULE, 1e-6).at(0, 0);
        assert_eq!(texel.certain, certain, "{z}");
    }
    let view = wide(8, 8);
    // A sphere that may or may not touch the cell.
    let beside = |by: f64| {
        // The sphere's left tangent lies `by` pixels to the right of the last pixel's centre.
        let angle = ((3.5 + by) / 4.0).atan() + (RADIUS / 10.0).asin();
        let (x, z) = (10.0 * angle.sin(), 10.0 * angle.cos());
        let spheres = [row(&[6.0])[0], at(x, view.ray(4, 4).y * z, z)];
        judged(&spheres, &view, SPACING, rounded).at(0, 0)
    };
    let (outside, edge, inside) = (beside(0.1), beside(GROWN), beside(-0.1));
    assert!(none(&outside), "{outside:?}");
    assert!(inside.is_certain() && inside.cell.airs.len() == 1, "{inside:?}");
    assert!(!edge.is_certain(), "{edge:?}");
}

#[test]
fn each_sheet_has_its_own_thickness() {
    let view = wide(32, 16);
    // Spheres before, at and behind the boundary. The share passes from the front to the back sheet
    // within half a spacing of the boundary; the share of the window falls to zero between half a
    // spacing and one and a half.
    let depths = [5.0, 6.875, 7.0, 7.5, 9.0];
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
            // If a sheet has no water, there is only one sheet.
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
    // The extents are odd: the last texel uses the last pixel.
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
    // Without spheres of the back sheet a texel with two sheets is empty.
    let found = back_depth(&front, &view, 1, &of(&cells), &marked);
    assert_eq!(found.at(9, 5), EMPTY);
}

#[test]
fn tiles_near_a_gap_are_made() {
    // Level 1 has 100 x 60 texels, in 7 x 4 tiles.
    let view = wide(200, 120);
    let mut cells = Image::new(25, 15, EMPTY);
    // Pixels 96 to 103 are texels 48 to 51. They lie in tile 3, beside tile 2.
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
    // Only the boundary at the centre of a cell counts.
    let mut pixels = Image::new(200, 120, EMPTY);
    let any = |pixels: &Image<f64>| {
        made(&Boundaries { texels: pixels, level: 0 }, &view, 1).data.contains(&true)
    };
    *pixels.at_mut(99, 4) = 6.0;
    assert!(!any(&pixels));
    *pixels.at_mut(100, 4) = 6.0;
    assert!(any(&pixels));
}
