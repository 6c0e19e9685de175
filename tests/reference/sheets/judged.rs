//! What rounding may make of the boundaries: the bounds of all depths and spans, carried through the
//! definition.

use std::ops::Range;

use super::super::{EMPTY, Image, Sphere, View};

use super::boundaries::{
    around, boundaries, by_cell, cells_of, counted, middle_of_air, of_texels, round, slice, spread,
};
use super::{GROWN, Part, REACH, SLICE, SLICES};

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
        let round: Vec<_> = around()
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
