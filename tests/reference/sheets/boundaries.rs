//! The boundaries: the cells in which a sphere counts, the air gaps of a cell, the borrowing of
//! gaps, and the boundary of a texel.

use glam::DVec2;
use std::ops::Range;

use super::super::{EMPTY, Image, Sphere, View};

use super::{
    AIRS, BESIDE, BEYOND, BODY, CELL, CHOSEN, CLEAR, DROP, GROWN, LEAST, NARROWEST, Part, REACH,
    SLICE, SLICES, UNBOUNDED,
};

/// Pixels whose centres lie in the bounding box of a sphere's projection, grown by `grown` pixels;
/// `None` if the projection is unbounded. In the planes of x and of y the tangents through the eye
/// lie `asin(r / l)` on either side of the direction to the centre, whose distance in that plane is
/// l.
pub fn span(sphere: &Sphere, view: &View, grown: f64) -> Option<Part> {
    span_with(sphere, view, DVec2::splat(grown))
}

/// Pixels whose cells a sphere counts in.
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
    // A negative focal length swaps a and b. The casts saturate.
    let range = |a: f64, b: f64, grown: f64, extent: usize| {
        let first = (a.min(b) - grown - 0.5).ceil().max(0.0) as usize;
        let past = ((a.max(b) + grown - 0.5).floor() + 1.0).max(0.0) as usize;
        first.min(extent)..past.min(extent).max(first.min(extent))
    };
    Some((range(a.x, b.x, grown.x, view.width), range(a.y, b.y, grown.y, view.height)))
}

/// Cells that contain these pixels.
pub fn cells_of((columns, rows): Part) -> Part {
    let cells = |pixels: Range<usize>| match pixels.is_empty() {
        true => 0..0,
        false => pixels.start / CELL..(pixels.end - 1) / CELL + 1,
    };
    let (columns, rows) = (cells(columns), cells(rows));
    // Without rows there are no cells, whatever the columns.
    if rows.is_empty() { (0..0, 0..0) } else { (columns, rows) }
}

/// An image with a value for each cell of a view.
pub fn by_cell<T: Clone>(view: &View, value: T) -> Image<T> {
    Image::new(view.width.div_ceil(CELL), view.height.div_ceil(CELL), value)
}

/// Slice of a depth behind the nearest centre, limited to the first and the last slice.
pub fn slice(behind: f64, spacing: f64) -> usize {
    // The cast saturates.
    ((behind / (SLICE * spacing)).floor().max(0.0) as usize).min(SLICES - 1)
}

/// An air gap between two runs of marked slices. `body`: 0 if the water behind the gap is a drop, 1
/// if it is a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air<T> {
    /// Where the gap begins, and where the water behind it begins.
    pub from: T,
    pub to: T,
    pub body: f64,
}

impl Air<usize> {
    /// The gap in eye depths.
    pub fn behind(&self, nearest: f64, spacing: f64) -> Air<f64> {
        let [from, to] = [self.from, self.to].map(|k| nearest + k as f64 * (SLICE * spacing));
        Air { from, to, body: self.body }
    }
}

/// The first air gaps of a cell. Between two marked slices, less than half a spacing without
/// marks is water.
pub fn airs_of(marked: &[bool]) -> Vec<Air<usize>> {
    let mut runs = Vec::new();
    for (k, _) in marked.iter().enumerate().filter(|(_, marked)| **marked) {
        match runs.last_mut() {
            Some(Range { end, .. }) if ((k - *end) as f64) * SLICE < NARROWEST => *end = k + 1,
            _ => runs.push(k..k + 1),
        }
    }
    let between = runs.windows(2).map(|two| {
        let water = &two[1];
        // Water that reaches the last slice may continue, so it counts as a body.
        let body = match water.end >= SLICES - 1 {
            true => 1.0,
            false => ((water.len() as f64 - BODY[0]) / (BODY[1] - BODY[0])).clamp(0.0, 1.0),
        };
        Air { from: two[0].end, to: water.start, body }
    });
    between.take(AIRS).collect()
}

/// The air gaps of a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cell {
    pub airs: Vec<Air<f64>>,
    /// Whether the gaps are borrowed from another cell.
    pub lent: bool,
}

/// The air gaps of a cell, from the depths of the spheres that touch it.
pub fn cell(depths: &[f64], spacing: f64) -> Cell {
    let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min);
    let mut marked = [false; SLICES];
    for z in depths {
        let first = slice(z - REACH * spacing - nearest, spacing);
        let last = slice(z + REACH * spacing - nearest, spacing);
        marked[first..=last].fill(true);
    }
    let airs = airs_of(&marked).iter().map(|air| air.behind(nearest, spacing)).collect();
    Cell { airs, lent: false }
}

/// Offsets to the neighbours of a cell, in the order in which it looks for gaps to borrow.
pub const AROUND: [(isize, isize); 8] =
    [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1)];

/// Cells without air gaps borrow those of the first neighbour that has any.
pub fn spread(cells: &Image<Cell>) -> Image<Cell> {
    Image::from_fn(cells.width, cells.height, |x, y| {
        let own = cells.at(x, y);
        let there = |(dx, dy)| cells.checked(x as isize + dx, y as isize + dy);
        let lender = AROUND.into_iter().filter_map(there).find(|cell| !cell.airs.is_empty());
        match lender {
            Some(lender) if own.airs.is_empty() => Cell { airs: lender.airs, lent: true },
            _ => own,
        }
    })
}

/// The cells around a texel of the thickness, with their bilinear weights, which are above zero.
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

/// Parameters of the boundaries.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    pub spacing: f64,
    /// Depths that differ by more belong to different surfaces.
    pub falloff: f64,
}

impl Rule {
    /// Width from which on an air gap counts fully.
    pub fn full(&self) -> f64 {
        2.0 * (self.falloff - self.spacing).max(CLEAR * self.spacing)
    }
}

/// Boundary of a texel whose surface lies at depth z, from the cells around it and their weights.
/// Also returns the smallest difference in any comparison that decided: of depths, and of sums of
/// the gaps' counts.
pub fn between(cells: &[(Cell, f64)], z: f64, rule: Rule) -> (f64, [f64; 2]) {
    let (spacing, full) = (rule.spacing, rule.full());
    let mut near = [f64::INFINITY; 2];
    // First the gaps behind the surface, then those before it.
    for behind in [true, false] {
        let (mut best, mut after) = (None::<(f64, f64)>, 0.0);
        loop {
            let own = |cell: &Cell, near: &mut [f64; 2]| {
                let mut found = None;
                for air in &cell.airs {
                    let past = air.from + air.to - 2.0 * z;
                    near[0] = near[0].min(0.5 * past.abs());
                    if behind && past > 0.0 && found.is_none() {
                        if air.from != after {
                            near[0] = near[0].min((air.from - after).abs());
                        }
                        found = (air.from >= after).then_some(*air);
                    }
                    if !behind && past <= 0.0 {
                        found = Some(*air);
                    }
                }
                found
            };
            let of: Vec<_> = cells.iter().map(|(cell, _)| own(cell, &mut near)).collect();
            let ahead =
                |a: &Air<f64>, b: &Air<f64>| if behind { b.from - a.from } else { a.to - b.to };
            let Some(first) =
                of.iter().flatten().copied().reduce(|a, b| if ahead(&b, &a) > 0.0 { b } else { a })
            else {
                break;
            };
            let (mut sum, mut weights, mut open) = (0.0, 0.0, 0.0);
            let (mut start, mut end) = (0.0_f64, f64::INFINITY);
            for (air, (cell, weight)) in of.iter().zip(cells) {
                let Some(air) = air else { continue };
                // Rounding may make another gap the first. Gaps with equal ends stem from one
                // sphere, so they stay equal.
                let ahead = ahead(&first, air);
                near[0] = near[0].min(if ahead == 0.0 { f64::INFINITY } else { ahead });
                near[0] = near[0].min((first.to - air.from).abs().min((air.to - first.from).abs()));
                if air.from >= first.to || air.to <= first.from {
                    continue;
                }
                let width = air.to - air.from;
                sum += weight * (air.from + (0.5 * width).min(BEYOND * spacing));
                weights += weight;
                (start, end) = (start.max(air.from), end.min(air.to));
                let counts = LEAST + (1.0 - LEAST) * air.body;
                open += if cell.lent { 0.0 } else { weight * (width / full).min(1.0) * counts };
            }
            let (mut at, rest) = (sum / weights, 0.5 * (end - start));
            near[0] = near[0].min(rest.abs());
            if rest > 0.0 {
                let edge = rest.min(CLEAR * spacing);
                at = at.clamp(start + edge, end - edge);
            }
            near[1] = near[1].min((open - CHOSEN).abs());
            // If both sums are zero, rounding does not change their order.
            if let Some((most, _)) = best.filter(|(most, _)| open != 0.0 || *most != 0.0) {
                near[1] = near[1].min((open - most).abs());
            }
            if best.is_none_or(|(most, _)| open > most) {
                best = Some((open, at));
            }
            if !behind || open >= CHOSEN {
                break;
            }
            after = first.to;
        }
        if let Some((_, at)) = best {
            return (at, near);
        }
    }
    (EMPTY, near)
}

/// Nearest depth of a texel's pixels.
pub fn front(depth: &Image<f64>, level: u32, p: (usize, usize)) -> f64 {
    let pixels = |p: usize, extent: usize| p << level..((p + 1) << level).min(extent);
    let all = pixels(p.1, depth.height)
        .flat_map(|y| pixels(p.0, depth.width).map(move |x| depth.at(x, y)));
    all.fold(EMPTY, f64::min)
}

/// Boundary of each texel of the thickness, from the cells' air gaps and the depth image.
pub fn of_texels(cells: &Image<Cell>, depth: &Image<f64>, level: u32, rule: Rule) -> Image<f64> {
    let cells = spread(cells);
    let texels = |extent: usize| extent.div_ceil(1 << level);
    Image::from_fn(texels(depth.width), texels(depth.height), |x, y| {
        let round = round((x, y), level, cells.width, cells.height);
        let of: Vec<_> = round.into_iter().map(|(i, j, weight)| (cells.at(i, j), weight)).collect();
        between(&of, front(depth, level, (x, y)), rule).0
    })
}

/// Air gaps of each cell. `spheres`: those that culling keeps.
pub fn cells(spheres: &[Sphere], view: &View, spacing: f64) -> Image<Cell> {
    let spans =
        spheres.iter().map(|sphere| (-sphere.center.z, counted(sphere, view, spacing, GROWN)));
    cells_from(spans, view, spacing)
}

/// Air gaps of each cell, from the depths and spans of spheres.
pub fn cells_from(
    spans: impl Iterator<Item = (f64, Option<Part>)>,
    view: &View,
    spacing: f64,
) -> Image<Cell> {
    let mut depths = by_cell(view, Vec::new());
    for (z, pixels) in spans.filter_map(|(z, pixels)| Some((z, pixels?))) {
        let (columns, rows) = cells_of(pixels);
        for y in rows {
            for x in columns.clone() {
                depths.at_mut(x, y).push(z);
            }
        }
    }
    depths.map(|depths| cell(depths, spacing))
}
