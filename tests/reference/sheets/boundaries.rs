//! The boundaries themselves: which cells a sphere counts in, the air of a cell, the spread to the cells
//! round and to the texels.

use glam::DVec2;
use std::ops::Range;

use super::super::{EMPTY, Image, Sphere, View, is_surface};

use super::{BESIDE, BODY, CELL, DROP, GROWN, NEAR, Part, REACH, SLICE, SLICES, UNBOUNDED};

/// The pixels whose centres lie in the bounding box of a sphere's projection, grown by so many
/// pixels; none where the projection has no bounds. The tangents through the eye lie at `asin(r / l)`
/// to either side of the centre's direction, in the planes of x and of y, at its distance l there.
pub fn span(sphere: &Sphere, view: &View, grown: f64) -> Option<Part> {
    span_with(sphere, view, DVec2::splat(grown))
}

/// The pixels whose cells a sphere counts in.
pub fn counted(sphere: &Sphere, view: &View, spacing: f64, grown: f64) -> Option<Part> {
    if sphere.radius < DROP * spacing {
        return None;
    }
    let texel = DVec2::new(view.c_x(), view.c_y()) * -sphere.center.z;
    let beside = BESIDE * spacing / texel - 0.5 * CELL as f64;
    span_with(sphere, view, grown + beside.max(DVec2::ZERO))
}

fn span_with(sphere: &Sphere, view: &View, grown: DVec2) -> Option<Part> {
    let (c, d) = (sphere.center, -sphere.center.z);
    if d <= UNBOUNDED * sphere.radius {
        return None;
    }
    let tangents = |across: f64| {
        let (middle, half) = (across.atan2(d), (sphere.radius / across.hypot(d)).asin());
        ((middle - half).tan(), (middle + half).tan())
    };
    let ((left, right), (low, high)) = (tangents(c.x), tangents(c.y));
    let a = view.pixel_of_slope(DVec2::new(left, low));
    let b = view.pixel_of_slope(DVec2::new(right, high));
    // A negative focal length swaps the two. The casts saturate.
    let range = |a: f64, b: f64, grown: f64, extent: usize| {
        let first = (a.min(b) - grown - 0.5).ceil().max(0.0) as usize;
        let past = ((a.max(b) + grown - 0.5).floor() + 1.0).max(0.0) as usize;
        first.min(extent)..past.min(extent).max(first.min(extent))
    };
    Some((range(a.x, b.x, grown.x, view.width), range(a.y, b.y, grown.y, view.height)))
}

/// The cells of a part of the pixels.
pub fn cells_of((columns, rows): Part) -> Part {
    let cells = |pixels: Range<usize>| match pixels.is_empty() {
        true => 0..0,
        false => pixels.start / CELL..(pixels.end - 1) / CELL + 1,
    };
    let (columns, rows) = (cells(columns), cells(rows));
    // No pixel of a row is none at all.
    if rows.is_empty() { (0..0, 0..0) } else { (columns, rows) }
}

/// A value for each cell of a view.
pub fn by_cell<T: Clone>(view: &View, value: T) -> Image<T> {
    Image::new(view.width.div_ceil(CELL), view.height.div_ceil(CELL), value)
}

/// The slice of a depth behind the nearest, of the first or the last.
pub fn slice(behind: f64, spacing: f64) -> usize {
    // The cast saturates.
    ((behind / (SLICE * spacing)).floor().max(0.0) as usize).min(SLICES - 1)
}

/// Twice the slice in which the boundary lies, if there is one.
pub fn middle_of_air(marked: &[bool; SLICES]) -> Option<usize> {
    let run = |from: usize, of: bool| (from..SLICES).find(|k| marked[*k] != of).unwrap_or(SLICES);
    let (mut first, mut body, mut a) = (None, None, run(0, true));
    while a < SLICES {
        let w = run(a, false);
        if w == SLICES {
            break;
        }
        let e = run(w, true);
        if e - w >= BODY || e == SLICES {
            body = Some(a + w);
        }
        first = first.or(Some(a + w));
        a = e;
    }
    body.or(first)
}

/// The boundary of a cell, of the depths of the spheres that touch it.
pub fn boundary(depths: &[f64], spacing: f64) -> f64 {
    let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min);
    let mut marked = [false; SLICES];
    for z in depths {
        let first = slice(z - REACH * spacing - nearest, spacing);
        let last = slice(z + REACH * spacing - nearest, spacing);
        marked[first..=last].fill(true);
    }
    match middle_of_air(&marked) {
        Some(twice) => nearest + twice as f64 * 0.5 * SLICE * spacing,
        None => EMPTY,
    }
}

/// The cells round one, from it.
pub fn around() -> impl Iterator<Item = (isize, isize)> {
    let near = -NEAR..=NEAR;
    near.clone().flat_map(move |dy| near.clone().map(move |dx| (dx, dy)))
}

/// Boundaries of cells, spread to those round them that have none: the mean by the inverse square
/// of the distance.
pub fn spread(cells: &Image<f64>) -> Image<f64> {
    Image::from_fn(cells.width, cells.height, |x, y| {
        let own = cells.at(x, y);
        if is_surface(own) {
            return own;
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dx, dy) in around() {
            let there = cells.checked(x as isize + dx, y as isize + dy);
            if let Some(there) = there.filter(|b| is_surface(*b)) {
                let weight = 1.0 / (dx * dx + dy * dy) as f64;
                sum += weight * there;
                weights += weight;
            }
        }
        if weights > 0.0 { sum / weights } else { EMPTY }
    })
}

/// The cells round a texel of the thickness, with their weights; more than zero all.
pub fn round(
    p: (usize, usize),
    level: u32,
    width: usize,
    height: usize,
) -> Vec<(usize, usize, f64)> {
    let along = |p: usize, cells: usize| {
        let at = (p as f64 + 0.5) * f64::from(1 << level) / CELL as f64 - 0.5;
        let (i, f) = (at.floor(), at - at.floor());
        let cell = |i: f64| (i.max(0.0) as usize).min(cells - 1);
        [(cell(i), 1.0 - f), (cell(i + 1.0), f)]
    };
    let columns = along(p.0, width);
    let all = along(p.1, height).into_iter().flat_map(|(y, v)| columns.map(|(x, u)| (x, y, u * v)));
    all.filter(|t| t.2 > 0.0).collect()
}

/// The boundary of each texel of the thickness, of those of the cells.
pub fn of_texels(cells: &Image<f64>, full: &View, level: u32) -> Image<f64> {
    let (cells, view) = (spread(cells), full.reduced(level));
    Image::from_fn(view.width, view.height, |x, y| {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (i, j, weight) in round((x, y), level, cells.width, cells.height) {
            if is_surface(cells.at(i, j)) {
                sum += weight * cells.at(i, j);
                weights += weight;
            }
        }
        if weights > 0.0 { sum / weights } else { EMPTY }
    })
}

/// The boundary of each cell, [`EMPTY`] where it holds one sheet or none. `spheres`: those that the
/// culling leaves.
pub fn boundaries(spheres: &[Sphere], view: &View, spacing: f64) -> Image<f64> {
    let spans =
        spheres.iter().map(|sphere| (-sphere.center.z, counted(sphere, view, spacing, GROWN)));
    boundaries_of(spans, view, spacing)
}

/// The same from depths and spans.
pub fn boundaries_of(
    spans: impl Iterator<Item = (f64, Option<Part>)>,
    view: &View,
    spacing: f64,
) -> Image<f64> {
    let mut depths = by_cell(view, Vec::new());
    for (z, pixels) in spans.filter_map(|(z, pixels)| Some((z, pixels?))) {
        let (columns, rows) = cells_of(pixels);
        for y in rows {
            for x in columns.clone() {
                depths.at_mut(x, y).push(z);
            }
        }
    }
    depths.map(|depths| boundary(depths, spacing))
}
