//! Bounding box of the bulk of the particles, robust against outliers.

use std::collections::{HashMap, HashSet};

use glam::Vec3;
use whitewater::LightVolume;
use whitewater::io::particles::estimate_spacing;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: Vec3,
    pub max: Vec3,
}

/// Coordinates of at least this size count as outliers. With a scene of such a size, the determinant of the light's
/// projection, 1 / size³, would underflow in single precision. (The pass `cull` drops particles with coordinates of
/// 1e18 or more.)
const FAR: f32 = 1.0e12;
/// A particle is an outlier if it lies beyond the quartiles of an axis by more than this many interquartile ranges
/// (of the axis with the largest range). Evenly spread water reaches half a range beyond its quartiles, a splash a
/// few ranges. In a picture of bounds that reach 100 ranges, the bulk would be a few pixels.
const REACH: f32 = 100.0;
/// Width of a grid cell in spacings. A cell of this width holds 27 particles inside a body of water, 9 of a sheet
/// that is one particle thick, 3 of a line of particles.
const CELL: f32 = 3.0;
/// Min number of particles in a cell that is water and not spray.
const DENSE: usize = 5;
/// Min share of all particles that a body (connected cells of water) has to hold, in order to belong to the bulk.
const BODY: f32 = 0.05;
/// How far spray may reach beyond the bulk to the sides and upwards, as a part of the bulk's longest side. Below the
/// bulk is the floor that the water stands on, so the limit there is one grid cell.
const SPRAY: f32 = 0.5;
/// Part of the bulk's longest side by which the bounds still reach above the bulk, if particles above it fly farther
/// than [`SPRAY`] and are ignored.
const SPLASH: f32 = 0.15;
/// Particles farther away than [`SPRAY`] are ignored if on that side they are fewer than this share of all particles.
const STRAY: f32 = 0.08;
/// Number of particles from which quartiles are computed.
const SAMPLES: usize = 65_536;

/// The box outside of which particles are outliers; `None` without particles.
fn plausible(positions: &[[f32; 3]]) -> Option<Bounds> {
    let step = positions.len().div_ceil(SAMPLES).max(1);
    let near = |p: &&[f32; 3]| p.iter().all(|c| c.abs() < FAR);
    let sample: Vec<[f32; 3]> = positions.iter().step_by(step).filter(near).copied().collect();
    let last = sample.len().checked_sub(1)?;
    let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
    for axis in 0..3 {
        let mut values: Vec<f32> = sample.iter().map(|p| p[axis]).collect();
        let quarter = sample.len() / 4;
        low[axis] = *values.select_nth_unstable_by(quarter.min(last), f32::total_cmp).1;
        high[axis] = *values.select_nth_unstable_by(last - quarter.min(last), f32::total_cmp).1;
    }
    // A sheet has an interquartile range of 0 across its plane, so the largest of the three ranges counts. If half of
    // all particles are at one place, all three are 0, and only `FAR` limits the box.
    let range = (high - low).max_element();
    let reach = if range > 0.0 { REACH * range } else { FAR };
    Some(Bounds {
        min: (low - reach).max(Vec3::splat(-FAR)),
        max: (high + reach).min(Vec3::splat(FAR)),
    })
}

/// Positions without NaN and infinities, without coordinates of [`FAR`] or more, and without outliers beyond
/// [`REACH`].
pub fn together(positions: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let Some(plausible) = plausible(positions) else { return Vec::new() };
    positions.iter().copied().filter(|p| plausible.contains(Vec3::from(*p))).collect()
}

/// Number of finite positions that [`together`] drops.
pub fn count_far(positions: &[[f32; 3]]) -> usize {
    let plausible = plausible(positions);
    let far = |p: &Vec3| p.is_finite() && !plausible.is_some_and(|near| near.contains(*p));
    positions.iter().map(|p| Vec3::from(*p)).filter(far).count()
}

/// What the positions of a frame say about their extent.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Rest spacing, estimated from the positions that [`together`] keeps. `None` if it cannot be estimated.
    pub spacing: Option<f32>,
    /// [`Bounds::of_bulk`].
    pub bulk: Option<Bounds>,
}

impl Extent {
    pub fn of(positions: &[[f32; 3]]) -> Self {
        let positions = together(positions);
        let spacing = estimate_spacing(&positions);
        Self { spacing, bulk: Bounds::of_near(&positions, spacing) }
    }
}

impl Bounds {
    /// Bounding box of the particles that [`together`] keeps, without strays. Strays are at most 1 in 500 particles
    /// at each end of an axis, if they are far from the rest, and the few particles that fly farther than spray from
    /// the bodies of water. `None` without particles.
    pub fn of_bulk(positions: &[[f32; 3]]) -> Option<Self> {
        Extent::of(positions).bulk
    }

    fn of_near(positions: &[[f32; 3]], spacing: Option<f32>) -> Option<Self> {
        let mut bounds = Self { min: Vec3::ZERO, max: Vec3::ZERO };
        for axis in 0..3 {
            let mut values: Vec<f32> = positions.iter().map(|p| p[axis]).collect();
            values.sort_unstable_by(f32::total_cmp);
            let (first, last) = (*values.first()?, *values.last()?);
            let cut = values.len() / 500;
            let (low, high) = (values[cut], values[values.len() - 1 - cut]);
            // Particles just outside the quantiles belong to the bulk.
            let near = 0.2 * (high - low);
            bounds.min[axis] = first.max(low - near);
            bounds.max[axis] = last.min(high + near);
        }
        let bodies = spacing.and_then(|spacing| Self::of_bodies(positions, CELL * spacing));
        Some(bounds.within_reach_of(bodies, positions))
    }

    /// Shrinks the box on each side on which only few particles ([`STRAY`]) are farther from the bodies of water than
    /// spray flies ([`SPRAY`]). Below the water only a grid cell counts as near, because the floor is there.
    fn within_reach_of(self, bodies: Option<(Self, f32)>, positions: &[[f32; 3]]) -> Self {
        let Some((bodies, cell)) = bodies else { return self };
        let reach = (SPRAY * bodies.size().max_element()).max(cell);
        let mut near = bodies.padded(reach);
        near.min.y = bodies.min.y - cell;
        let few = |beyond: &dyn Fn(&[f32; 3]) -> bool| {
            let count = positions.iter().filter(|p| beyond(p)).count();
            (count as f32) < STRAY * positions.len() as f32
        };
        let mut bounds = self;
        for axis in 0..3 {
            // Few particles nearer than that are ignored as well, except for a splash.
            if bounds.min[axis] < near.min[axis] && few(&|p| p[axis] < near.min[axis]) {
                bounds.min[axis] = bodies.min[axis];
            }
            if bounds.max[axis] > near.max[axis] && few(&|p| p[axis] > near.max[axis]) {
                let splash = if axis == 1 { SPLASH * bodies.size().max_element() } else { 0.0 };
                bounds.max[axis] = bodies.max[axis] + splash;
            }
        }
        bounds
    }

    /// Bounding box of the bodies of water, and the width of a cell, as given. A body consists of connected cells with at least
    /// [`DENSE`] particles each, which together hold at least [`BODY`] of all particles. `None` if there is no body.
    fn of_bodies(positions: &[[f32; 3]], cell: f32) -> Option<(Self, f32)> {
        let mut cells: HashMap<[i64; 3], (usize, Self)> = HashMap::new();
        for p in positions {
            let p = Vec3::from(*p);
            let one = Self { min: p, max: p };
            let (count, about) =
                cells.entry((p / cell).to_array().map(|c| c.floor() as i64)).or_insert((0, one));
            (*count, *about) = (*count + 1, about.union(&one));
        }
        cells.retain(|_, (count, _)| *count >= DENSE);
        let mut left: HashSet<[i64; 3]> = cells.keys().copied().collect();
        let mut all: Option<Self> = None;
        while let Some(first) = left.iter().next().copied() {
            left.remove(&first);
            let (mut open, mut count, mut about) = (vec![first], 0, None::<Self>);
            while let Some(at) = open.pop() {
                let (own, bounds) = cells[&at];
                count += own;
                about = Some(about.map_or(bounds, |about| about.union(&bounds)));
                for i in 0..27 {
                    let beside = [at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1];
                    if left.remove(&beside) {
                        open.push(beside);
                    }
                }
            }
            if count as f32 >= BODY * positions.len() as f32 {
                all = all.into_iter().chain(about).reduce(|a, b| a.union(&b));
            }
        }
        Some((all?, cell))
    }

    pub fn center(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    pub fn size(&self) -> Vec3 {
        self.max - self.min
    }

    /// A sphere around the box, with a margin.
    pub fn region(&self) -> LightVolume {
        let radius = (0.52 * self.size().length()).max(1.0e-6);
        LightVolume { center: self.center().to_array(), radius }
    }

    pub fn contains(&self, p: Vec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box enlarged by a length on all sides.
    pub fn padded(&self, by: f32) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strays_do_not_count() {
        let mut positions: Vec<[f32; 3]> =
            (0..2000).map(|i| [(i % 20) as f32, (i / 20 % 10) as f32, (i / 200) as f32]).collect();
        positions.push([0.0, 1.0e6, 0.0]);
        positions.push([f32::NAN, 0.0, 0.0]);
        let bounds = Bounds::of_bulk(&positions).unwrap();
        assert_eq!(bounds.min, Vec3::ZERO);
        assert!((bounds.max - Vec3::new(19.0, 9.0, 9.0)).abs().max_element() < 2.0, "{bounds:?}");
        assert_eq!(Bounds::of_bulk(&[]), None);
        assert_eq!(Bounds::of_bulk(&[[f32::NAN; 3]]), None);
    }

    /// The bounds stay close to the water if 3 % of the particles leaked below it or were thrown out; a splash is
    /// part of the bulk and inside the bounds.
    #[test]
    fn what_leaked_or_flew_away_does_not_count() {
        let block: Vec<[f32; 3]> = (0..4000)
            .map(|i| [(i % 20) as f32, (i / 20 % 10) as f32, (i / 200) as f32].map(|c| 0.1 * c))
            .collect();
        let clean = Bounds::of_bulk(&block).unwrap();
        let noise = |i: usize, seed: usize| ((i * 7919 + seed * 104_729) as f32).sin();
        let with = |more: &dyn Fn(usize) -> [f32; 3]| {
            let mut positions = block.clone();
            positions.extend((0..120).map(more));
            Bounds::of_bulk(&positions).unwrap()
        };
        let leaked =
            with(&|i| [0.95 + 0.5 * noise(i, 1), -0.2 * i as f32, 0.95 + 0.5 * noise(i, 2)]);
        assert!(leaked.min.y >= clean.min.y - 0.31 && leaked.max == clean.max, "{leaked:?}");
        let thrown = with(&|i| [1, 2, 3].map(|seed| 30.0 * noise(i, seed)));
        let reach = 0.5 * clean.size().max_element() + 0.01;
        assert!(thrown.max.cmple(clean.max + reach).all(), "{thrown:?}");
        assert!(thrown.min.cmpge(clean.min - reach).all() && thrown.min.y > clean.min.y - 0.31);
        let splash =
            with(&|i| [0.95 + 0.1 * noise(i, 1), 0.9 + 0.01 * i as f32, 0.95 + 0.1 * noise(i, 2)]);
        assert!(splash.max.y > 1.7, "{splash:?}");
        // Water below falling water is no leak: it is a tenth of all.
        let mut positions = block.clone();
        positions.extend((0..500).map(|i| [0.3 * (i % 25) as f32, -5.0, 0.3 * (i / 25) as f32]));
        assert!(Bounds::of_bulk(&positions).unwrap().min.y < -1.0);
    }

    #[test]
    fn what_is_absurdly_far_does_not_count() {
        // A grid, a sheet of one layer, and a few particles.
        let grid = |size: [usize; 3]| -> Vec<[f32; 3]> {
            let [a, b, c] = size;
            (0..a * b * c)
                .map(|i| [(i % a) as f32, (i / a % b) as f32, (i / a / b) as f32])
                .collect()
        };
        for size in [[7, 7, 7], [30, 1, 30], [300, 1, 1], [2, 2, 1]] {
            let near = grid(size);
            let clean = Bounds::of_bulk(&near).unwrap();
            assert_eq!(count_far(&near), 0, "{size:?}");
            for far in [1.0e20, -3.0e38, 1.0e17, 1.0e11, 1.0e6] {
                let mut positions = near.clone();
                positions.insert(1, [0.0, far, 0.0]);
                assert_eq!(Bounds::of_bulk(&positions), Some(clean), "{size:?} {far}");
                assert_eq!(count_far(&positions), 1, "{size:?} {far}");
                assert_eq!(together(&positions), near);
            }
        }
        // Without a range every coordinate that can be drawn counts.
        let same = [[1.0; 3], [1.0; 3], [1.0; 3], [1.0; 3], [9.0, 1.0, 1.0], [1.0e20; 3]];
        assert_eq!(Bounds::of_bulk(&same).unwrap().max, Vec3::new(9.0, 1.0, 1.0));
        assert_eq!(count_far(&same), 1);
        assert_eq!(Bounds::of_bulk(&[[1.0e20; 3]]), None);
        assert_eq!(count_far(&[[1.0e20; 3]]), 1);
        assert_eq!(count_far(&[[f32::NAN; 3]]), 0);
    }
}
