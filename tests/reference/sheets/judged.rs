//! Effect of rounding on the boundaries: the error bounds of all depths and spans, carried through
//! the definition.

use std::ops::Range;

use super::super::{EMPTY, Image, Sphere, View};

use super::boundaries::{
    AROUND, Cell, Rule, airs_of, between, by_cell, cells, cells_of, counted, front, round, slice,
    spread,
};
use super::{GROWN, Part, REACH, SLICE, SLICES};

/// Error bounds of the numbers that decide in which cells and slices a sphere counts.
#[derive(Clone, Copy, Debug)]
pub struct Slack {
    /// Error of the depth.
    pub depth: f64,
    /// Error of the ends of the span, in pixels.
    pub pixels: f64,
}

/// What is known of a cell's air gaps.
#[derive(Clone, Debug)]
pub struct Known {
    /// The cell without rounding errors.
    pub cell: Cell,
    /// Whether a sphere may touch the cell.
    pub touched: bool,
    /// All cells that rounding may produce, each up to the error `rounding`; `None` if there are
    /// too many to try.
    pub answers: Option<Vec<Cell>>,
    /// Error of the gaps' ends in each answer.
    pub rounding: f64,
    /// Range of depths that contains all possible gaps.
    pub low: f64,
    pub high: f64,
}

/// What is known of a texel's boundary.
#[derive(Clone, Copy, Debug)]
pub struct KnownTexel {
    /// Boundary without rounding errors.
    pub boundary: f64,
    /// Whether a sphere may touch a cell around the texel.
    pub touched: bool,
    /// Whether there may be no boundary, and whether there may be one.
    pub maybe_none: bool,
    pub maybe_one: bool,
    /// Whether the boundary is known up to the rounding of a depth.
    pub certain: bool,
    /// Min and max boundary, if there is one.
    pub low: f64,
    pub high: f64,
}

/// Min and max depths of spheres that touch a cell: of those that certainly do, and of all that
/// possibly do.
#[derive(Clone, Default)]
struct Touching {
    surely: Vec<(f64, f64)>,
    maybe: Vec<(f64, f64)>,
}

/// What rounding may make of each cell. The error bounds of all depths and spans are carried
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
        // Boxes of the sphere at its min depth, at its depth and at its max depth.
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
    let exact = cells(spheres, view, spacing);
    let cells = touching.data.iter().zip(&exact.data);
    let data = cells.map(|(touching, cell)| judge(touching, cell, spacing));
    Image { width: exact.width, height: exact.height, data: data.collect() }
}

/// Max number of slices that rounding may leave undecided; all combinations of marked and unmarked
/// are tried.
const OPEN: usize = 8;
/// Max number of combinations of neighbouring cells that are tried.
const TRIED: usize = 256;

impl Known {
    pub fn is_certain(&self) -> bool {
        self.answers.as_ref().is_some_and(|answers| answers.len() == 1)
    }

    fn add(&mut self, answer: Cell) {
        if let Some(answers) = self.answers.as_mut().filter(|all| !all.contains(&answer)) {
            answers.push(answer);
        }
    }

    /// Whether the cell may have no air gap of its own.
    fn maybe_none(&self) -> bool {
        self.answers.as_ref().is_none_or(|all| all.iter().any(|cell| cell.airs.is_empty()))
    }
}

/// Cells that may result from the errors of the depths and from spheres that possibly touch the
/// cell.
fn judge(touching: &Touching, cell: &Cell, spacing: f64) -> Known {
    let Touching { surely, maybe } = touching;
    // The nearest sphere may be any that possibly touches the cell and may be nearer than the
    // nearest certain one.
    let surest = surely.iter().map(|z| z.1).fold(f64::INFINITY, f64::min);
    let nearest: Vec<_> = maybe.iter().filter(|z| z.0 <= surest).collect();
    let low = nearest.iter().map(|z| z.0).fold(f64::INFINITY, f64::min);
    let high = nearest.iter().map(|z| z.1.min(surest)).fold(0.0, f64::max);
    let mut known = Known {
        cell: cell.clone(),
        touched: !maybe.is_empty(),
        answers: Some(Vec::new()),
        rounding: 0.0,
        low,
        high: high + SLICES as f64 * SLICE * spacing,
    };
    if surely.is_empty() {
        known.add(Cell::default());
    }
    for nearest in nearest {
        let (low, high) = (nearest.0, nearest.1.min(surest));
        known.rounding = known.rounding.max(nearest.1 - nearest.0);
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
            known.answers = None;
            return known;
        }
        for bits in 0..1_u32 << open.len() {
            let mut marked = sure;
            for (i, k) in open.iter().enumerate() {
                marked[*k] = bits >> i & 1 == 1;
            }
            let z = 0.5 * (nearest.0 + nearest.1);
            let airs = airs_of(&marked).iter().map(|air| air.behind(z, spacing)).collect();
            known.add(Cell { airs, lent: false });
        }
    }
    known
}

/// What rounding may make of each texel's boundary. The depth image has no error. `relative`:
/// relative error that the arithmetic adds to a boundary.
pub fn judged_texels(
    cells: &Image<Known>,
    depth: &Image<f64>,
    level: u32,
    rule: Rule,
    relative: f64,
) -> Image<KnownTexel> {
    let exact = spread(&cells.map(|known| known.cell.clone()));
    // Each cell with all gaps that it may have or borrow.
    let lent = Image::from_fn(cells.width, cells.height, |x, y| {
        let mut all = cells.at(x, y);
        all.cell = exact.at(x, y);
        if !all.maybe_none() {
            return all;
        }
        if let Some(answers) = &mut all.answers {
            answers.retain(|answer| !answer.airs.is_empty());
        }
        for (dx, dy) in AROUND {
            let Some(there) = cells.checked(x as isize + dx, y as isize + dy) else { continue };
            all.rounding = all.rounding.max(there.rounding);
            (all.low, all.high) = (all.low.min(there.low), all.high.max(there.high));
            match &there.answers {
                Some(answers) => answers
                    .iter()
                    .filter(|answer| !answer.airs.is_empty())
                    .for_each(|answer| all.add(Cell { lent: true, ..answer.clone() })),
                None => all.answers = None,
            }
            // This neighbour certainly has gaps, so the cell asks no other.
            if !there.maybe_none() {
                return all;
            }
        }
        all.add(Cell::default());
        all
    });
    let texels = |extent: usize| extent.div_ceil(1 << level);
    Image::from_fn(texels(depth.width), texels(depth.height), |x, y| {
        let round = round((x, y), level, cells.width, cells.height);
        let of: Vec<_> = round.iter().map(|(i, j, weight)| (lent.at(*i, *j), *weight)).collect();
        let z = front(depth, level, (x, y));
        let exact: Vec<_> =
            of.iter().map(|(known, weight)| (known.cell.clone(), *weight)).collect();
        let boundary = between(&exact, z, rule).0;
        let rounding = of.iter().map(|(known, _)| known.rounding).fold(0.0, f64::max);
        let least = of.iter().map(|(known, _)| known.low).fold(f64::INFINITY, f64::min);
        let most = of.iter().map(|(known, _)| known.high).fold(0.0, f64::max);
        // Error of a difference of two depths. Below it is divided by `full` for the sums, which
        // contain widths over `full`.
        let off = 2.0 * (rounding + relative * most);
        // All combinations of what the cells may be.
        let mut together = Some(vec![Vec::new()]);
        for (known, weight) in &of {
            together = together.zip(known.answers.as_ref()).and_then(|(all, answers)| {
                let more = all.iter().flat_map(|so_far: &Vec<(Cell, f64)>| {
                    let with = |answer: &Cell| {
                        so_far.iter().cloned().chain([(answer.clone(), *weight)]).collect()
                    };
                    answers.iter().map(with).collect::<Vec<_>>()
                });
                let more: Vec<_> = more.collect();
                (more.len() <= TRIED).then_some(more)
            });
        }
        let found: Option<Vec<f64>> = together.and_then(|all| {
            let asked = all.iter().map(|cells| between(cells, z, rule));
            asked
                .map(|(at, near)| {
                    (near[0] > off && near[1] > off / rule.full() + relative).then_some(at)
                })
                .collect()
        });
        let touched = round.iter().any(|(i, j, _)| cells.at(*i, *j).touched);
        let open = KnownTexel {
            boundary,
            touched,
            maybe_none: of.iter().all(|(known, _)| known.maybe_none()),
            maybe_one: most > 0.0,
            certain: false,
            low: least,
            high: most,
        };
        let Some(found) = found else { return open };
        let there = || found.iter().copied().filter(|at| *at < EMPTY);
        let low = there().fold(f64::INFINITY, f64::min) - rounding;
        let high = there().fold(0.0, f64::max) + rounding;
        let (maybe_none, maybe_one) = (found.contains(&EMPTY), there().next().is_some());
        // Answers with the same gaps differ by no more than the error of a depth.
        let certain = maybe_none != maybe_one && high - low <= 3.0 * rounding + off;
        KnownTexel { maybe_none, maybe_one, certain: certain || !maybe_one, low, high, ..open }
    })
}
