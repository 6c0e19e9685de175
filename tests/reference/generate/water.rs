//! Valid fluid particles, and the search for those near a point.

use super::support;
use glam::DVec3;
use std::collections::HashMap;

/// Numbers of this size or larger are invalid as positions and velocities; in single precision,
/// slightly below 1e18.
const NOWHERE: f64 = 1e18_f32 as f64;
/// A position this many supports away is invalid too.
const FARTHEST: f64 = (1_u64 << 30) as f64;
/// Within this many supports of a support's edge, rounding decides whether a particle is a
/// neighbour.
const EDGE: f64 = 1e-5;

/// A fluid; all vectors have the same length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fluid {
    /// Positions in scene units.
    pub positions: Vec<[f32; 3]>,
    /// Velocities in scene units per second.
    pub velocities: Vec<[f32; 3]>,
    /// Ids.
    pub ids: Vec<u32>,
}

/// A valid fluid particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    /// Its index.
    pub index: usize,
    /// Position in scene units.
    pub position: DVec3,
    /// Velocity in scene units per second.
    pub velocity: DVec3,
}

/// A neighbour, or a possible one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Near {
    /// The particle.
    pub part: Part,
    /// Vector from the particle to the place, in scene units.
    pub offset: DVec3,
    /// q, its length in supports.
    pub q: f64,
}

impl Near {
    /// Whether the particle is a neighbour of the place.
    pub fn counts(&self) -> bool {
        self.q < 1.0
    }

    /// Whether rounding decides that.
    pub fn loose(&self) -> bool {
        (self.q - 1.0).abs() <= EDGE
    }

    /// W.
    pub fn weight(&self) -> f64 {
        1.0 - self.q
    }
}

impl Fluid {
    /// The valid particles.
    pub(super) fn parts(&self, spacing: f32) -> impl Iterator<Item = Part> + '_ {
        (0..self.positions.len()).filter_map(move |index| self.part(index, spacing))
    }

    /// A particle, if it is valid.
    pub(super) fn part(&self, index: usize, spacing: f32) -> Option<Part> {
        let position = DVec3::from(self.positions[index].map(f64::from));
        let velocity = DVec3::from(self.velocities[index].map(f64::from));
        let is = |v: DVec3| v.is_finite() && v.abs().max_element() < NOWHERE;
        let here = (position / support(spacing)).abs().max_element() < FARTHEST;
        (is(position) && is(velocity) && here).then_some(Part { index, position, velocity })
    }
}

/// Particles that are or may be neighbours of a position.
pub(super) fn near(
    place: DVec3,
    spacing: f32,
    parts: impl Iterator<Item = Part>,
) -> impl Iterator<Item = Near> {
    let all = parts.map(move |part| {
        let offset = place - part.position;
        Near { part, offset, q: offset.length() / support(spacing) }
    });
    all.filter(|one| one.counts() || one.loose())
}

/// The parts, by grid cells.
pub(super) struct Grid {
    spacing: f32,
    cells: HashMap<[i64; 3], Vec<Part>>,
}

impl Grid {
    /// The grid of a fluid.
    pub fn new(fluid: &Fluid, spacing: f32) -> Self {
        let mut grid = Self { spacing, cells: HashMap::new() };
        for part in fluid.parts(spacing) {
            grid.cells.entry(grid.cell(part.position)).or_default().push(part);
        }
        grid
    }

    /// The cell of a place; cells are slightly wider than a support. Distant places saturate.
    fn cell(&self, place: DVec3) -> [i64; 3] {
        (place / (1.001 * support(self.spacing))).floor().to_array().map(|x| x as i64)
    }

    /// Like [`near`], with all particles.
    pub fn near(&self, place: DVec3) -> impl Iterator<Item = Near> {
        let middle = self.cell(place);
        let around = (0..27).filter_map(move |n| {
            let step = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
            self.cells.get(&[0, 1, 2].map(|axis| middle[axis].saturating_add(step[axis])))
        });
        near(place, self.spacing, around.flatten().copied())
    }

    /// The particles within this many supports of a place.
    pub fn within(&self, place: DVec3, supports: f64) -> impl Iterator<Item = Near> {
        let (middle, reach) = (self.cell(place), supports.ceil() as i64);
        let along =
            move |axis: usize| (-reach..=reach).map(move |step| middle[axis].saturating_add(step));
        let cells = along(0)
            .flat_map(move |x| along(1).flat_map(move |y| along(2).map(move |z| [x, y, z])));
        let parts = cells.filter_map(|cell| self.cells.get(&cell)).flatten();
        let all = parts.map(move |part| {
            let offset = place - part.position;
            Near { part: *part, offset, q: offset.length() / support(self.spacing) }
        });
        all.filter(move |near| near.q < supports)
    }
}
