//! Blocks of rows, how alike they are, and where they lie.

use super::super::steps::Start;

/// A curve is at most this many times as long as its extent; a circle 2.2 times.
const CURVE: f64 = 3.0;

/// Where the first rows of a block are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    low: [f64; 3],
    high: [f64; 3],
    before: Option<[f64; 3]>,
    /// Length of the way from row to row.
    way: f64,
}

impl Extent {
    const NONE: Self =
        Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3], before: None, way: 0.0 };

    pub(super) fn add(&mut self, place: [f64; 3]) {
        for ((low, high), x) in self.low.iter_mut().zip(&mut self.high).zip(place) {
            (*low, *high) = (low.min(x), high.max(x));
        }
        if let Some(before) = self.before {
            self.way += length(place.iter().zip(before).map(|(a, b)| a - b));
        }
        self.before = Some(place);
    }

    fn is_curve(&self) -> bool {
        self.way <= CURVE * length(self.high.iter().zip(self.low).map(|(high, low)| high - low))
    }

    /// The least part that both share along an axis; below 0 if they are apart.
    fn shared(&self, other: &Self) -> f64 {
        self.part(other, |[a, b], [c, d]| b.min(d) - a.max(c))
    }

    /// The least extent of one of them along an axis, as a part of that of both together.
    fn thick(&self, other: &Self) -> f64 {
        self.part(other, |[a, b], [c, d]| (b - a).min(d - c))
    }

    /// The least part along an axis of what both together extend over; `of` finds it from their ends.
    fn part(&self, other: &Self, of: impl Fn([f64; 2], [f64; 2]) -> f64) -> f64 {
        let ours = self.low.iter().zip(&self.high);
        let all = ours.zip(other.low.iter().zip(&other.high));
        let part = all.map(|((a, b), (c, d))| {
            let whole = b.max(*d) - a.min(*c);
            if whole > 0.0 { of([*a, *b], [*c, *d]) / whole } else { 1.0 }
        });
        part.fold(1.0, f64::min)
    }
}

fn length(parts: impl Iterator<Item = f64>) -> f64 {
    parts.map(|part| part * part).sum::<f64>().sqrt()
}

/// The blocks between separators of one kind or surer ones.
#[derive(Clone)]
pub(super) struct Level {
    /// Number of blocks, and of rows of the last one.
    pub(super) blocks: u64,
    pub(super) rows: u64,
    pub(super) extent: Extent,
    /// The block before the last one.
    last: Option<(u64, Extent)>,
    pub(super) fewest: u64,
    pub(super) equal: bool,
    /// Largest ratio of the numbers of rows of neighbouring blocks, and least part of their extents that they share.
    pub(super) ratio: f64,
    pub(super) shared: f64,
    pub(super) curve: bool,
    /// Least extent of a block along an axis, as a part of that of two neighbouring ones together.
    pub(super) thick: f64,
    /// The line in which the second block begins.
    pub(super) second: u64,
    pub(super) starts: Vec<Start>,
}

impl Level {
    pub(super) const fn new() -> Self {
        Self {
            blocks: 0,
            rows: 0,
            extent: Extent::NONE,
            last: None,
            fewest: u64::MAX,
            equal: true,
            ratio: 1.0,
            shared: 1.0,
            curve: false,
            thick: 1.0,
            second: 0,
            starts: Vec::new(),
        }
    }

    /// Ends the last block.
    pub(super) fn close(&mut self) {
        if let Some((rows, extent)) = self.last.replace((self.rows, self.extent)) {
            let ratio = rows as f64 / self.rows.max(1) as f64;
            self.equal &= rows == self.rows;
            self.ratio = self.ratio.max(ratio).max(1.0 / ratio);
            self.shared = self.shared.min(extent.shared(&self.extent));
            self.thick = self.thick.min(extent.thick(&self.extent));
        }
        self.curve |= self.extent.is_curve();
        self.fewest = self.fewest.min(self.rows);
        (self.rows, self.extent) = (0, Extent::NONE);
    }
}
