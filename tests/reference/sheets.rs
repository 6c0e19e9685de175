//! Twin of the sheets: where one body of water stands before another with air between, each texel of
//! the thickness has a boundary, the eye depth between the centres of the front sheet and of the back
//! one. With `s` the spacing and `z` the eye depth of a centre, the spheres whose box, grown by what
//! 0.35 s are there beyond four pixels, touches a cell of 8x8 pixels mark the slices of `s / 2` from the nearest of them on that lie in `z - 0.75 s ..
//! z + 0.75 s`, 32 slices in all (what lies farther is in the last). Unmarked slices with marked ones
//! behind them are air. The boundary is the middle of the first air before a body, six marked slices
//! or all to the last one, else of the first air. It is spread to the cells round, and interpolated.

use super::depth::splat_where;
use super::thickness::{self, Amplitude};
use super::{EMPTY, Image, Sphere, View, is_surface, smoothstep};
use glam::DVec2;
use std::ops::Range;

/// Edge of a cell in pixels.
pub const CELL: usize = 8;
/// Slices of a cell.
pub const SLICES: usize = 32;
/// Edge of a tile in texels of the smoothing.
pub const TILE: usize = 16;

/// How far the box of a projection is grown, in pixels.
pub const GROWN: f64 = 1.0 / 64.0;
/// Depth from a centre that its sphere marks, in spacings.
const REACH: f64 = 0.75;
/// What a sphere counts for beside its box, in spacings, less half a cell.
const BESIDE: f64 = 0.35;
/// A slice, in spacings.
const SLICE: f64 = 0.5;
/// Marked slices of a body.
const BODY: usize = 6;
/// Half the depth in which the share of the sheets goes over, in spacings.
const SOFT: f64 = 0.5;
/// Water so near to the boundary fills the window between the sheets, and so far none of it.
const WINDOW: [f64; 2] = [0.5, 1.0];
/// Where there is one sheet the window holds so many times the water.
pub const ONE_SHEET: f64 = 1e6;
/// Nearer than this, in radii, a projection has no bounds.
const UNBOUNDED: f64 = 1.01;

/// Columns and rows of pixels or cells.
pub type Part = (Range<usize>, Range<usize>);

/// The pixels whose centres lie in the bounding box of a sphere's projection, grown by so many
/// pixels; none where the projection has no bounds. The tangents through the eye lie at `asin(r / l)`
/// to either side of the centre's direction, in the planes of x and of y, at its distance l there.
pub fn span(sphere: &Sphere, view: &View, grown: f64) -> Option<Part> {
    span_with(sphere, view, DVec2::splat(grown))
}

/// The pixels whose cells a sphere counts in.
pub fn counted(sphere: &Sphere, view: &View, spacing: f64, grown: f64) -> Option<Part> {
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
fn cells_of((columns, rows): Part) -> Part {
    let cells = |pixels: Range<usize>| match pixels.is_empty() {
        true => 0..0,
        false => pixels.start / CELL..(pixels.end - 1) / CELL + 1,
    };
    let (columns, rows) = (cells(columns), cells(rows));
    // No pixel of a row is none at all.
    if rows.is_empty() { (0..0, 0..0) } else { (columns, rows) }
}

/// A value for each cell of a view.
fn by_cell<T: Clone>(view: &View, value: T) -> Image<T> {
    Image::new(view.width.div_ceil(CELL), view.height.div_ceil(CELL), value)
}

/// The slice of a depth behind the nearest, of the first or the last.
fn slice(behind: f64, spacing: f64) -> usize {
    // The cast saturates.
    ((behind / (SLICE * spacing)).floor().max(0.0) as usize).min(SLICES - 1)
}

/// Twice the slice in which the boundary lies, if there is one.
fn middle_of_air(marked: &[bool; SLICES]) -> Option<usize> {
    let run = |from: usize, of: bool| (from..SLICES).find(|k| marked[*k] != of).unwrap_or(SLICES);
    let (mut first, mut a) = (None, run(0, true));
    while a < SLICES {
        let w = run(a, false);
        if w == SLICES {
            break;
        }
        let e = run(w, true);
        if e - w >= BODY || e == SLICES {
            return Some(a + w);
        }
        first = first.or(Some(a + w));
        a = e;
    }
    first
}

/// The boundary of a cell, of the depths of the spheres that touch it.
fn boundary(depths: &[f64], spacing: f64) -> f64 {
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

/// Boundaries of cells, spread to those round them that have none: the mean by the inverse square
/// of the distance.
pub fn spread(cells: &Image<f64>) -> Image<f64> {
    Image::from_fn(cells.width, cells.height, |x, y| {
        let own = cells.at(x, y);
        if is_surface(own) {
            return own;
        }
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dx, dy) in (-1..=1_isize).flat_map(|dy| (-1..=1_isize).map(move |dx| (dx, dy))) {
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
fn round(p: (usize, usize), level: u32, width: usize, height: usize) -> Vec<(usize, usize, f64)> {
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

/// By how much what decides of a sphere may be off.
#[derive(Clone, Copy, Debug)]
pub struct Slack {
    /// Of its depth.
    pub depth: f64,
    /// Of the ends of its span, in pixels.
    pub pixels: f64,
}

/// What is known of a boundary.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Without slack.
    pub boundary: f64,
    /// Whether a sphere may touch the cell, or one that the texel goes by.
    pub touched: bool,
    /// Whether there may be none, and whether there may be one.
    pub maybe_none: bool,
    pub maybe_one: bool,
    /// Whether nothing but the rounding of one number is left open.
    pub certain: bool,
    /// Least and greatest that it may be, if there is one.
    pub low: f64,
    pub high: f64,
}

impl Known {
    fn none(touched: bool) -> Self {
        let (maybe_none, maybe_one, certain) = (true, false, true);
        let (boundary, low, high) = (EMPTY, f64::INFINITY, 0.0);
        Self { boundary, touched, maybe_none, maybe_one, certain, low, high }
    }

    /// The weighted mean of those that there are; `boundary` is that without slack.
    fn mean(of: &[(Self, f64)], boundary: f64) -> Self {
        let touched = of.iter().any(|(known, _)| known.touched);
        let there: Vec<_> = of.iter().filter(|(known, _)| known.maybe_one).collect();
        let certain = of.iter().all(|(known, _)| known.certain);
        let weights: f64 = there.iter().map(|t| t.1).sum();
        let mean = |bound: fn(&Self) -> f64| {
            there.iter().map(|(known, weight)| bound(known) * weight).sum::<f64>() / weights
        };
        let (low, high) = match certain && !there.is_empty() {
            true => (mean(|known| known.low), mean(|known| known.high)),
            false => (
                there.iter().map(|t| t.0.low).fold(f64::INFINITY, f64::min),
                there.iter().map(|t| t.0.high).fold(0.0, f64::max),
            ),
        };
        let maybe_none = of.iter().all(|(known, _)| known.maybe_none);
        Self { boundary, touched, maybe_none, maybe_one: !there.is_empty(), certain, low, high }
    }
}

/// The spheres that touch a cell, by the least and the greatest that their depths may be: those that
/// do whatever the slack, and all that may.
#[derive(Clone, Default)]
struct Touching {
    surely: Vec<(f64, f64)>,
    maybe: Vec<(f64, f64)>,
}

/// Each cell with what rounding may make of it: the bounds of all depths and spans are carried
/// through the definition.
pub fn judged(
    spheres: &[Sphere],
    view: &View,
    spacing: f64,
    slack: impl Fn(&Sphere) -> Slack,
) -> Image<Known> {
    let mut touching = by_cell(view, Touching::default());
    for sphere in spheres {
        let (z, slack) = (-sphere.center.z, slack(sphere));
        let depths = (z - slack.depth, z + slack.depth);
        // The box of the sphere at its nearest, where it is, and at its farthest.
        let moved = [-1.0, 0.0, 1.0].map(|by| {
            let mut moved = *sphere;
            moved.center.z -= by * slack.depth;
            moved
        });
        let spans =
            |grown: f64| moved.map(|sphere| counted(&sphere, view, spacing, grown).map(cells_of));
        let everywhere = |spans: [Option<Part>; 3]| {
            let parts = spans.into_iter().collect::<Option<Vec<_>>>()?;
            let common = |pick: fn(&Part) -> &Range<usize>| {
                let start = parts.iter().map(|p| pick(p).start).max().unwrap_or(0);
                start..parts.iter().map(|p| pick(p).end).min().unwrap_or(0)
            };
            Some((common(|p| &p.0), common(|p| &p.1)))
        };
        let mut maybe = by_cell(view, false);
        for (columns, rows) in spans(GROWN + slack.pixels).into_iter().flatten() {
            for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
                *maybe.at_mut(x, y) = true;
            }
        }
        let surely = everywhere(spans(GROWN - slack.pixels)).unwrap_or_default();
        for (i, _) in maybe.data.iter().enumerate().filter(|(_, maybe)| **maybe) {
            let cell = &mut touching.data[i];
            cell.maybe.push(depths);
            if surely.0.contains(&(i % maybe.width)) && surely.1.contains(&(i / maybe.width)) {
                cell.surely.push(depths);
            }
        }
    }
    let exact = boundaries(spheres, view, spacing);
    let cells = touching.data.iter().zip(&exact.data);
    let data = cells.map(|(touching, boundary)| judge(touching, *boundary, spacing));
    Image { width: exact.width, height: exact.height, data: data.collect() }
}

/// Slices that rounding may leave open and are all tried, marked and not.
const OPEN: usize = 10;

/// What the slack of the depths and of who touches it makes of a cell.
fn judge(touching: &Touching, boundary: f64, spacing: f64) -> Known {
    let Touching { surely, maybe } = touching;
    let mut known = Known { boundary, ..Known::none(!maybe.is_empty()) };
    // Any of these is the nearest: one that surely touches the cell, or one before that which may.
    let surest = surely.iter().map(|z| z.1).fold(f64::INFINITY, f64::min);
    let nearest = maybe.iter().filter(|z| z.0 <= surest);
    known.maybe_none = surely.is_empty();
    let (mut ends, mut rounding) = (Vec::new(), 0.0_f64);
    for nearest in nearest {
        let (low, high) = (nearest.0, nearest.1.min(surest));
        rounding = rounding.max(nearest.1 - nearest.0);
        let (mut sure, mut possible) = ([false; SLICES], [false; SLICES]);
        let reach = REACH * spacing;
        for z in maybe.iter().filter(|z| z.1 >= low) {
            let first = slice(z.0 - reach - high, spacing);
            let last = slice(z.1 + reach - low, spacing);
            possible[first..=last].fill(true);
        }
        for z in surely.iter().chain([nearest]) {
            let first = slice(z.1 - reach - low, spacing);
            let last = slice(z.0 + reach - high, spacing);
            if first <= last {
                sure[first..=last].fill(true);
            }
        }
        let open: Vec<_> = (0..SLICES).filter(|k| possible[*k] && !sure[*k]).collect();
        if open.len() > OPEN {
            known.maybe_none = true;
            ends.extend([(low, 0), (high, 2 * SLICES)]);
            continue;
        }
        for bits in 0..1_u32 << open.len() {
            let mut marked = sure;
            for (i, k) in open.iter().enumerate() {
                marked[*k] = bits >> i & 1 == 1;
            }
            match middle_of_air(&marked) {
                Some(twice) => ends.extend([(low, twice), (high, twice)]),
                None => known.maybe_none = true,
            }
        }
    }
    known.maybe_one = !ends.is_empty();
    if known.maybe_one {
        let at = |(from, twice): &(f64, usize)| from + *twice as f64 * 0.5 * SLICE * spacing;
        known.low = ends.iter().map(at).fold(f64::INFINITY, f64::min);
        known.high = ends.iter().map(at).fold(0.0, f64::max);
        known.certain = !known.maybe_none && known.high - known.low <= 1.001 * rounding;
    } else {
        known.maybe_none = true;
    }
    known
}

/// What the slack of the cells makes of the texels of the thickness.
pub fn judged_texels(cells: &Image<Known>, full: &View, level: u32) -> Image<Known> {
    let exact = cells.map(|cell| cell.boundary);
    let (exact_spread, exact_texels) = (spread(&exact), of_texels(&exact, full, level));
    let spread = Image::from_fn(cells.width, cells.height, |x, y| {
        let own = cells.at(x, y);
        if !own.maybe_none {
            return own;
        }
        let there = (-1..=1_isize).flat_map(|dy| (-1..=1_isize).map(move |dx| (dx, dy)));
        let round: Vec<_> = there
            .filter(|at| *at != (0, 0))
            .filter_map(|(dx, dy)| {
                let there = cells.checked(x as isize + dx, y as isize + dy)?;
                Some((there, 1.0 / (dx * dx + dy * dy) as f64))
            })
            .collect();
        let mut mean = Known::mean(&round, exact_spread.at(x, y));
        mean.touched = own.touched;
        if own.maybe_one {
            mean.certain = false;
            (mean.low, mean.high) = (mean.low.min(own.low), mean.high.max(own.high));
            mean.maybe_one = true;
        }
        mean
    });
    let view = full.reduced(level);
    Image::from_fn(view.width, view.height, |x, y| {
        let round = round((x, y), level, cells.width, cells.height);
        let of: Vec<_> = round.iter().map(|(i, j, weight)| (spread.at(*i, *j), *weight)).collect();
        Known::mean(&of, exact_texels.at(x, y))
    })
}

/// How much of a splat with its centre at a depth belongs to the front sheet, and to the window
/// between the sheets.
pub fn shares(z: f64, boundary: f64, spacing: f64) -> (f64, f64) {
    if !is_surface(boundary) {
        return (1.0, ONE_SHEET);
    }
    let soft = SOFT * spacing;
    let back = smoothstep(boundary - soft, boundary + soft, z);
    let [near, far] = WINDOW.map(|part| part * spacing);
    (1.0 - back, 1.0 - smoothstep(near, far, (z - boundary).abs()))
}

/// The thickness of the front sheet, of the back one and of the window between them. `full` is the
/// view of the frame, whose scene hides what lies behind it.
pub fn thickness(
    spheres: &[Sphere],
    full: &View,
    level: u32,
    boundaries: &Image<f64>,
    spacing: f64,
    amplitude: Amplitude,
) -> Image<[f64; 3]> {
    let view = full.reduced(level);
    let all = thickness::splat(spheres, &view, None, amplitude);
    let share = |pick: fn((f64, f64)) -> f64| {
        thickness::splat_where(spheres, &view, None, amplitude, |x, y, sphere| {
            pick(shares(-sphere.center.z, boundaries.at(x, y), spacing))
        })
    };
    let (front, window) = (share(|shares| shares.0), share(|shares| shares.1));
    Image::from_fn(view.width, view.height, |x, y| match is_surface(boundaries.at(x, y)) {
        true => [front.at(x, y), all.at(x, y) - front.at(x, y), window.at(x, y)],
        false => [all.at(x, y), 0.0, ONE_SHEET * all.at(x, y)],
    })
}

/// Leaves the boundaries where there is something to tell apart; elsewhere all is the front sheet's.
pub fn prune(boundaries: &mut Image<f64>, thickness: &mut Image<[f64; 3]>) {
    for (boundary, texel) in boundaries.data.iter_mut().zip(&mut thickness.data) {
        let [front, back, _] = *texel;
        if front == 0.0 || back == 0.0 {
            *boundary = EMPTY;
            *texel = [front + back, 0.0, ONE_SHEET * (front + back)];
        }
    }
}

/// The boundaries of a frame: one for each texel of the thickness, of a level.
#[derive(Clone, Copy, Debug)]
pub struct Boundaries<'a> {
    pub texels: &'a Image<f64>,
    pub level: u32,
}

impl Boundaries<'_> {
    /// Of the texel that a pixel lies in.
    pub fn of_pixel(&self, x: usize, y: usize) -> f64 {
        self.texels.at(x >> self.level, y >> self.level)
    }
}

/// The pixel that a texel of `2^level` pixels, one at least a level coarser than the frame, goes by.
pub fn pixel_of_texel(full: &View, level: u32, x: usize, y: usize) -> (usize, usize) {
    let along = |i: usize, extent: usize| ((i << level) + (1 << level) / 2).min(extent - 1);
    (along(x, full.width), along(y, full.height))
}

/// The boundary at a texel of the back sheet's depth.
pub fn boundary_at(
    boundaries: &Boundaries<'_>,
    full: &View,
    level: u32,
    x: usize,
    y: usize,
) -> f64 {
    let (x, y) = pixel_of_texel(full, level, x, y);
    boundaries.of_pixel(x, y)
}

/// The depth of the back sheet at a level: the nearest hit of the ray through a texel's centre with
/// the spheres of the back sheet, whatever the scene hides; where there is one sheet the depth image,
/// and nothing away from all gaps.
pub fn back_depth(
    spheres: &[Sphere],
    full: &View,
    level: u32,
    boundaries: &Boundaries<'_>,
    depth: &Image<f64>,
) -> Image<f64> {
    let (view, made) = (full.reduced(level), made(boundaries, full, level));
    let at = |x, y| boundary_at(boundaries, full, level, x, y);
    let hits = splat_where(spheres, &view, |x, y, sphere| -sphere.center.z >= at(x, y));
    Image::from_fn(view.width, view.height, |x, y| {
        if !made.at(x, y) {
            EMPTY
        } else if is_surface(at(x, y)) {
            hits.at(x, y)
        } else {
            let (x, y) = pixel_of_texel(full, level, x, y);
            depth.at(x, y)
        }
    })
}

/// The texels whose tile is made: within a tile's edge of it lies a cell at whose middle there are
/// two sheets.
pub fn made(boundaries: &Boundaries<'_>, full: &View, level: u32) -> Image<bool> {
    let view = full.reduced(level);
    let (columns, rows) = (full.width.div_ceil(CELL), full.height.div_ceil(CELL));
    let split = Image::from_fn(columns, rows, |x, y| {
        let middle = |k: usize, extent: usize| (CELL * k + CELL / 2).min(extent - 1);
        is_surface(boundaries.of_pixel(middle(x, full.width), middle(y, full.height)))
    });
    // Cells that overlap the texels from a tile before one to a tile behind it.
    let cells = |tile: usize, cells: usize| {
        let edge = TILE << level;
        let pixels = (tile * edge).saturating_sub(edge)..(tile + 2) * edge;
        pixels.start / CELL..pixels.end.div_ceil(CELL).min(cells)
    };
    let tiles = |texels: usize| texels.div_ceil(TILE);
    let tiles = Image::from_fn(tiles(view.width), tiles(view.height), |x, y| {
        let columns = cells(x, split.width);
        cells(y, split.height).any(|y| columns.clone().any(|x| split.at(x, y)))
    });
    Image::from_fn(view.width, view.height, |x, y| tiles.at(x / TILE, y / TILE))
}

#[cfg(test)]
mod tests {
    use super::super::depth;
    use super::super::tests::view;
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
    fn the_first_air_before_a_body_decides() {
        // Slices 0 and 1, 6 to 9, 14 to 19: the last are a body.
        assert_eq!(one(&row(&[9.5, 5.0, 9.0, 7.0])), 5.0 + 12.0 * 0.25);
        // 14 to 18 are none: the first air.
        assert_eq!(one(&row(&[5.0, 7.0, 9.0, 9.25])), 5.0 + 4.0 * 0.25);
        // All to the last slice are, and the first body decides.
        assert_eq!(one(&row(&[5.0, 7.0, 40.0])), 5.0 + 20.5 * 0.25);
        assert_eq!(one(&row(&[5.0, 7.0, 7.5, 40.0])), 5.0 + 4.0 * 0.25);
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
}
