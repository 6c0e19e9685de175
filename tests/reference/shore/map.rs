//! The signed distance to the shore line over a grid of heights.
//!
//! A texel with a neighbour on the other side of the line has a seed: the point on the way to that
//! neighbour where the height is 0, for the nearest such neighbour, to 1/16 texel. A texel's value
//! is the distance from its centre to a segment of one texel's length through its nearest seed,
//! across the heights' gradient there; negative in water. Lengths are in texels with centres at
//! +0.5, until the end.
//!
//! [`Shore`] computes it in another way: from the line where the heights are 0, linear along the
//! edges between centres.

use glam::DVec2;

use super::bounded::{Bounded, U, exact};
use super::texture::STEP;

/// Seed positions are in steps of a texel over this.
const PARTS: f64 = 16.0;

/// Heights, row by row.
#[derive(Clone, Debug)]
pub struct Heights {
    /// Texels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Height above the water's level, row by row.
    data: Vec<f64>,
}

/// Position of a seed in sixteenths of a texel.
pub type Seed = [i64; 2];

const BESIDE: [[isize; 2]; 4] = [[1, 0], [-1, 0], [0, 1], [0, -1]];

fn middle(x: usize, y: usize) -> DVec2 {
    DVec2::new(x as f64 + 0.5, y as f64 + 0.5)
}

fn place(seed: Seed) -> DVec2 {
    DVec2::new(seed[0] as f64, seed[1] as f64) / PARTS
}

impl Heights {
    /// Heights in single precision, relative to the level.
    pub fn new(width: usize, height: usize, level: f32, data: &[f32]) -> Self {
        assert_eq!(data.len(), width * height, "{width} x {height} heights");
        let data = data.iter().map(|h| f64::from(*h) - f64::from(level)).collect();
        Self { width, height, data }
    }

    /// Height above the level of the nearest texel inside.
    pub fn at(&self, x: isize, y: isize) -> f64 {
        let x = x.clamp(0, self.width as isize - 1) as usize;
        let y = y.clamp(0, self.height as isize - 1) as usize;
        self.data[y * self.width + x]
    }

    /// Whether a texel is land.
    pub fn land(&self, x: usize, y: usize) -> bool {
        self.data[y * self.width + x] > 0.0
    }

    /// The neighbours on the other side of the line: fraction of the way, and direction.
    fn ways(&self, x: usize, y: usize) -> impl Iterator<Item = (Bounded, [isize; 2])> {
        let (px, py) = (x as isize, y as isize);
        let here = self.at(px, py);
        BESIDE.into_iter().filter_map(move |to| {
            let there = self.at(px + to[0], py + to[1]);
            let rounded = |v: f64| exact(v).wider(U * v.abs());
            let part = || rounded(here) / (rounded(here) - rounded(there));
            ((here > 0.0) != (there > 0.0)).then(|| (part(), to))
        })
    }

    /// The seed of a texel. For equal distances the order is right, left, below, above.
    pub fn seed(&self, x: usize, y: usize) -> Option<Seed> {
        let least = self.ways(x, y).reduce(|a, b| if b.0.value < a.0.value { b } else { a });
        least.map(|(part, to)| on_the_way(x, y, part.value, to, 0.0))
    }

    /// All seeds that single precision may give this texel.
    pub fn may_be(&self, x: usize, y: usize) -> Vec<Seed> {
        let bound = self.ways(x, y).map(|(part, _)| part.high()).fold(f64::INFINITY, f64::min);
        let mut all = Vec::new();
        for (part, to) in self.ways(x, y).filter(|(part, _)| part.low() <= bound) {
            // The position, its product and its sum.
            let off = part.error + 3.0 * U * (x.max(y) as f64 + 2.0);
            let ends = [-off, off].map(|off| on_the_way(x, y, part.value, to, off));
            for sy in ends[0][1].min(ends[1][1])..=ends[0][1].max(ends[1][1]) {
                for sx in ends[0][0].min(ends[1][0])..=ends[0][0].max(ends[1][0]) {
                    all.push([sx, sy]);
                }
            }
        }
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The seeds of all texels, row by row.
    pub fn seeds(&self) -> Vec<Option<Seed>> {
        let all = 0..self.width * self.height;
        all.map(|i| self.seed(i % self.width, i / self.width)).collect()
    }

    /// Gradient at a position, of heights interpolated between four texel centres inside the grid.
    /// On a line of centres these are the ones to the right or below, at the last line the ones
    /// before, because a clamped cell would flatten the gradient.
    fn gradient(&self, at: DVec2) -> [Bounded; 2] {
        let last = DVec2::new(self.width as f64, self.height as f64) - 2.0;
        let from = (at - 0.5).floor().max(DVec2::ZERO).min(last);
        let part = at - 0.5 - from;
        let (x, y) = (from.x as isize, from.y as isize);
        let h = |dx: isize, dy: isize| {
            let height = self.at(x + dx, y + dy);
            exact(height).wider(U * height.abs())
        };
        let mixed = |a: Bounded, b: Bounded, t: f64| a * (1.0 - t) + b * t;
        let [a, b, c, d] = [h(0, 0), h(1, 0), h(0, 1), h(1, 1)];
        [mixed(b - a, d - c, part.y), mixed(c - a, d - b, part.x)]
    }

    /// Distance from a point to the segment of a seed, in texels.
    pub fn apart(&self, at: DVec2, seed: Seed) -> Bounded {
        let to = at - place(seed);
        let [gx, gy] = self.gradient(place(seed));
        let gradient = DVec2::new(gx.value, gy.value);
        let off = gx.error.hypot(gy.error);
        let far = to.length();
        if gradient == DVec2::ZERO && off == 0.0 {
            return exact(far).wider(9.0 * U * far);
        }
        // A direction errs by the vector's error over its length; square root, quotient and
        // products add 16u.
        let length = gradient.length();
        let turned = off / (length - off).max(f64::MIN_POSITIVE) + 16.0 * U;
        let axis = gradient / length.max(f64::MIN_POSITIVE);
        let off = (turned * far).min(2.0 * far);
        let across = exact(to.dot(axis).abs()).wider(off);
        let past = exact(to.perp_dot(axis).abs()).wider(off) - 0.5;
        let past = past.max(0.0);
        let value = across.value.hypot(past.value);
        // No segment through the seed can be nearer or farther than this.
        let low = across.low().max(0.0).hypot(past.low().max(0.0)).max(far - 0.5);
        let high = across.high().hypot(past.high()).min(far);
        Bounded::between(low.min(value), value, high.max(value)).wider(11.0 * U * far)
    }

    /// The signed distance of each texel, in scene units, by its nearest seed; if several are
    /// equally near, the bounds include all. `edge`: width of a texel in scene units. None without
    /// seeds.
    pub fn map(&self, seeds: &[Option<Seed>], edge: f64) -> Option<Map> {
        let mut known: Vec<Seed> = seeds.iter().copied().flatten().collect();
        known.sort_unstable();
        known.dedup();
        let tree = Tree::new(known.iter().map(|s| place(*s)).collect());
        let texel = |i: usize| {
            let (x, y) = (i % self.width, i / self.width);
            let at = middle(x, y);
            let (_, nearest) = tree.nearest(at)?;
            let all = nearest.iter().map(|i| self.apart(at, known[*i]));
            let either = all.reduce(|a, b| {
                Bounded::between(a.low().min(b.low()), a.value, a.high().max(b.high()))
            })?;
            let distance = either * edge;
            Some(if self.land(x, y) { distance } else { -distance })
        };
        let values = (0..self.width * self.height).map(texel).collect::<Option<_>>()?;
        Some(Map { width: self.width, height: self.height, values })
    }

    /// The nearest seeds of a texel by comparing all: the squared distance in sixteenths, and all
    /// seeds at that distance.
    pub fn nearest(&self, seeds: &[Option<Seed>], x: usize, y: usize) -> Option<(i64, Vec<Seed>)> {
        let at = [x, y].map(|v| 16 * v as i64 + 8);
        let square = |s: &Seed| (s[0] - at[0]).pow(2) + (s[1] - at[1]).pow(2);
        let least = seeds.iter().flatten().map(square).min()?;
        let mut all: Vec<_> =
            seeds.iter().flatten().copied().filter(|s| square(s) == least).collect();
        all.sort_unstable();
        all.dedup();
        Some((least, all))
    }
}

/// A seed at fraction `part` of the way to a neighbour, moved by `off`.
fn on_the_way(x: usize, y: usize, part: f64, to: [isize; 2], off: f64) -> Seed {
    let at = middle(x, y);
    let step = |at: f64, to: isize| {
        let moved = if to == 0 { at } else { at + part * to as f64 + off };
        (moved * PARTS + 0.5).floor() as i64
    };
    [step(at.x, to[0]), step(at.y, to[1])]
}

/// Signed distances to the shore in scene units, negative in water.
#[derive(Clone, Debug)]
pub struct Map {
    /// Texels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row.
    pub values: Vec<Bounded>,
}

impl Map {
    /// Converts a position in scene units to texels; `corner` is the map's corner, `edge` the width
    /// of a texel.
    pub fn texels(place: [Bounded; 2], corner: [f64; 2], edge: f64) -> [Bounded; 2] {
        [0, 1].map(|i| (place[i] - corner[i]) / edge)
    }

    /// Whether a position lies between the outer texel centres. None if rounding decides.
    pub fn inside(&self, place: [Bounded; 2]) -> Option<bool> {
        let ends = [self.width as f64, self.height as f64];
        let within = |by: f64| {
            (0..2).all(|i| {
                let off = by * place[i].error;
                0.5 - off <= place[i].value && place[i].value <= ends[i] - 0.5 + off
            })
        };
        (within(1.0) == within(-1.0)).then(|| within(0.0))
    }

    /// Distance interpolated linearly between texel centres, constant beyond the outer ones. A
    /// hardware filter's position errs by half a step; `by_filter` is false if the shader
    /// interpolates in single precision.
    pub fn at(&self, place: [Bounded; 2], by_filter: bool) -> Bounded {
        let ends = [self.width, self.height].map(|n| n as isize - 1);
        let get = |x: isize, y: isize| {
            self.values[y.clamp(0, ends[1]) as usize * self.width + x.clamp(0, ends[0]) as usize]
        };
        let place = place.map(|p| {
            let off = p.error + U * (p.value.abs() + p.error + 0.5);
            (p.value - 0.5, off + if by_filter { STEP } else { 0.0 })
        });
        let [x, y] = place.map(|(at, _)| at.floor() as isize);
        let [fx, fy] = place.map(|(at, _)| at - at.floor());
        let value = (1.0 - fy) * ((1.0 - fx) * get(x, y).value + fx * get(x + 1, y).value)
            + fy * ((1.0 - fx) * get(x, y + 1).value + fx * get(x + 1, y + 1).value);
        let (mut own, mut most, mut steps) = (0.0_f64, 0.0_f64, [0.0_f64; 2]);
        let spans =
            place.map(|(at, off)| [(at - off).floor() as isize, (at + off).floor() as isize]);
        for y in spans[1][0]..=spans[1][1] + 1 {
            for x in spans[0][0]..=spans[0][1] + 1 {
                let here = get(x, y);
                (own, most) = (own.max(here.error), most.max(here.value.abs()));
                if x <= spans[0][1] {
                    steps[0] = steps[0].max((get(x + 1, y).value - here.value).abs());
                }
                if y <= spans[1][1] {
                    steps[1] = steps[1].max((get(x, y + 1).value - here.value).abs());
                }
            }
        }
        let moved = steps[0] * place[0].1 + steps[1] * place[1].1;
        exact(value).wider(own + moved + 9.0 * U * most)
    }
}

impl Map {
    /// Change of the distance per texel at a position, from the four texels around it; on a line of
    /// centres the bounds include the cells on both sides.
    pub fn slope(&self, place: [Bounded; 2]) -> [Bounded; 2] {
        let last = [self.width, self.height].map(|n| n as f64 - 2.0);
        let get = |x: f64, y: f64| self.values[y as usize * self.width + x as usize].value;
        let spans = [0, 1].map(|i| {
            let off = place[i].error + 4.0 * U * (place[i].value.abs() + 1.0);
            [place[i].value - 0.5 - off, place[i].value - 0.5 + off]
        });
        let cells = [0, 1].map(|i| spans[i].map(|v| v.floor().clamp(0.0, last[i])));
        let own = |i: usize| (place[i].value - 0.5).floor().clamp(0.0, last[i]);
        let slopes = |[x, y]: [f64; 2], [fx, fy]: [f64; 2]| {
            let [a, b, c, d] = [get(x, y), get(x + 1.0, y), get(x, y + 1.0), get(x + 1.0, y + 1.0)];
            let mixed = |a: f64, b: f64, t: f64| a + (b - a) * t.clamp(0.0, 1.0);
            [mixed(b - a, d - c, fy), mixed(c - a, d - b, fx)]
        };
        let cell = [own(0), own(1)];
        let value = slopes(cell, [0, 1].map(|i| place[i].value - 0.5 - cell[i]));
        let (mut low, mut high) = (value, value);
        for y in [cells[1][0], cells[1][1]] {
            for x in [cells[0][0], cells[0][1]] {
                for k in 0..4 {
                    let at = [spans[0][k & 1] - x, spans[1][k >> 1] - y];
                    let found = slopes([x, y], at);
                    for i in 0..2 {
                        (low[i], high[i]) = (low[i].min(found[i]), high[i].max(found[i]));
                    }
                }
            }
        }
        let most = self.values.iter().map(|v| v.value.abs()).fold(0.0, f64::max);
        [0, 1].map(|i| Bounded::between(low[i], value[i], high[i]).wider(6.0 * U * most))
    }
}

/// The max and the mean difference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Max of the absolute differences.
    pub most: f64,
    /// Mean of the absolute differences.
    pub mean: f64,
}

/// The difference between found and expected values.
pub fn difference(found: impl IntoIterator<Item = f64>, expected: &[f64]) -> Difference {
    let (mut most, mut total, mut count) = (0.0_f64, 0.0, 0);
    for (found, expected) in found.into_iter().zip(expected) {
        let off = (found - expected).abs();
        (most, total, count) = (most.max(off), total + off, count + 1);
    }
    assert_eq!(count, expected.len(), "as many are found as expected");
    Difference { most, mean: total / count.max(1) as f64 }
}

/// A k-d tree of points, split along x and y in turn.
#[derive(Clone, Debug)]
pub struct Tree {
    points: Vec<(DVec2, usize)>,
}

impl Tree {
    /// The tree of points, which are identified by their indices.
    pub fn new(points: Vec<DVec2>) -> Self {
        let mut points: Vec<_> = points.into_iter().enumerate().map(|(i, p)| (p, i)).collect();
        halve(&mut points, 0);
        Self { points }
    }

    /// The smallest distance from `at` to a point, and all points at that distance.
    pub fn nearest(&self, at: DVec2) -> Option<(f64, Vec<usize>)> {
        let (mut least, mut all) = (f64::INFINITY, Vec::new());
        self.visit(at, &mut |point, i| {
            let far = at.distance(point);
            if far < least {
                least = far;
                all.clear();
            }
            if far == least {
                all.push(i);
            }
            least
        });
        (!all.is_empty()).then_some((least, all))
    }

    /// Calls `found` for points, until the others are farther away than its last result.
    fn visit(&self, at: DVec2, found: &mut impl FnMut(DVec2, usize) -> f64) {
        let mut reach = f64::INFINITY;
        search(&self.points, 0, at, &mut reach, found);
    }
}

fn halve(points: &mut [(DVec2, usize)], axis: usize) {
    if points.len() > 1 {
        let half = points.len() / 2;
        points.select_nth_unstable_by(half, |a, b| a.0[axis].total_cmp(&b.0[axis]));
        let (left, right) = points.split_at_mut(half);
        halve(left, 1 - axis);
        halve(&mut right[1..], 1 - axis);
    }
}

fn search(
    points: &[(DVec2, usize)],
    axis: usize,
    at: DVec2,
    reach: &mut f64,
    found: &mut impl FnMut(DVec2, usize) -> f64,
) {
    let half = points.len() / 2;
    let Some(&(point, i)) = points.get(half) else { return };
    let beyond = at[axis] - point[axis];
    let (left, right) = (&points[..half], &points[half + 1..]);
    let (near, far) = if beyond < 0.0 { (left, right) } else { (right, left) };
    search(near, 1 - axis, at, reach, found);
    *reach = found(point, i);
    if beyond.abs() <= *reach {
        search(far, 1 - axis, at, reach, found);
    }
}

/// The line where the heights are 0: one or two segments in each square of four centres.
#[derive(Clone, Debug)]
pub struct Shore {
    /// End points of the segments, in texels.
    pub segments: Vec<[DVec2; 2]>,
    tree: Tree,
}

impl Shore {
    /// Marching squares. If two opposite corners are land, they are connected if the saddle between
    /// them is land.
    pub fn new(heights: &Heights) -> Self {
        let mut segments = Vec::new();
        for y in 0..heights.height.saturating_sub(1) {
            for x in 0..heights.width.saturating_sub(1) {
                square(heights, x, y, &mut segments);
            }
        }
        let tree = Tree::new(segments.iter().map(|[a, b]| (a + b) * 0.5).collect());
        Self { segments, tree }
    }

    /// Distance from a point to the line; infinite without a line. A segment is at most √2 long.
    pub fn distance(&self, at: DVec2) -> f64 {
        let mut least = f64::INFINITY;
        self.tree.visit(at, &mut |_, i| {
            least = least.min(from_segment(at, self.segments[i]));
            least + 0.75
        });
        least
    }

    /// Distance to the nearest of all segments.
    pub fn distance_by_all(&self, at: DVec2) -> f64 {
        self.segments.iter().map(|s| from_segment(at, *s)).fold(f64::INFINITY, f64::min)
    }

    /// Distances of all texels in scene units, negative in water.
    pub fn distances(&self, heights: &Heights, edge: f64) -> Vec<f64> {
        let texel = |i: usize| {
            let (x, y) = (i % heights.width, i / heights.width);
            let distance = edge * self.distance(middle(x, y));
            if heights.land(x, y) { distance } else { -distance }
        };
        (0..heights.width * heights.height).map(texel).collect()
    }
}

/// Distance from a point to a segment.
pub fn from_segment(at: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let (to, along) = (at - a, b - a);
    let part = to.dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    (to - along * part.clamp(0.0, 1.0)).length()
}

fn square(heights: &Heights, x: usize, y: usize, segments: &mut Vec<[DVec2; 2]>) {
    // In order around the square.
    let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[dx, dy]| [x + dx, y + dy]);
    let h = corners.map(|[x, y]| heights.at(x as isize, y as isize));
    let land = corners.map(|[x, y]| heights.land(x, y));
    let crossing = |i: usize| {
        let j = (i + 1) % 4;
        let [a, b] = [corners[i], corners[j]].map(|[x, y]| middle(x, y));
        (land[i] != land[j]).then(|| a.lerp(b, h[i] / (h[i] - h[j])))
    };
    let on = [0, 1, 2, 3].map(crossing);
    if let [Some(a), Some(b), Some(c), Some(d)] = on {
        let saddle = (h[0] * h[2] - h[1] * h[3]) / (h[0] + h[2] - h[1] - h[3]);
        // Connecting two corners cuts off each of the other two.
        let joined = (saddle > 0.0) == land[0];
        segments.extend(if joined { [[a, b], [c, d]] } else { [[d, a], [b, c]] });
    } else {
        let two: Vec<_> = on.into_iter().flatten().collect();
        if let [a, b] = two[..] {
            segments.push([a, b]);
        }
    }
}
