//! A strip of foam around an island, along the contour where a height field meets the sea.

use std::collections::HashMap;

use glam::{Vec2, vec2};

use super::terrain::Patch;

/// Triangles at sea level around an island. The vertices' only texture coordinate is v: 0 at the strip's seaward
/// edge, 1 at the shore line, 2 at its inland edge.
#[derive(Clone, Debug, Default)]
pub struct Strip {
    /// World space; y is the sea's level.
    pub positions: Vec<[f32; 3]>,
    /// One value per vertex.
    pub v: Vec<f32>,
    /// Three indices per triangle.
    pub indices: Vec<u32>,
}

/// Width of a strip on both sides of the shore line.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// Metres towards the sea.
    pub sea: f32,
    /// Metres towards the land.
    pub land: f32,
}

/// Closed contours on which a field is 0. All run around the side with positive values in the same direction.
pub fn contours(patch: Patch, field: impl Fn(Vec2) -> f32) -> Vec<Vec<Vec2>> {
    let [nx, nz] = patch.cells();
    let at = |i: usize, j: usize| j * (nx + 1) + i;
    let values: Vec<f32> = (0..=nz)
        .flat_map(|j| (0..=nx).map(move |i| (i, j)))
        .map(|(i, j)| field(patch.corner(i, j)))
        .collect();
    let inside = |corner: usize| values[corner] > 0.0;
    // The contour crosses edges of cells. Each entry leads from one crossed edge to the next, with the positive side
    // always on the same hand. An edge is named by its two corners.
    let mut next: HashMap<(usize, usize), (usize, usize)> = HashMap::new();
    for (i, j) in (0..nz).flat_map(|j| (0..nx).map(move |i| (i, j))) {
        // Each cell is two triangles, so that no case is ambiguous.
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        for [p, q, r] in [[a, b, c], [a, c, d]] {
            for (p, q, r) in [(p, q, r), (q, r, p), (r, p, q)] {
                let edge = |a: usize, b: usize| (a.min(b), a.max(b));
                match (inside(p), inside(q), inside(r)) {
                    (true, false, false) => next.insert(edge(p, q), edge(p, r)),
                    (false, true, true) => next.insert(edge(p, r), edge(p, q)),
                    _ => continue,
                };
            }
        }
    }
    let corner = |n: usize| patch.corner(n % (nx + 1), n / (nx + 1));
    let place = |(a, b): (usize, usize)| {
        // Bisection to a thousandth of a cell, because the field is not linear between two corners.
        let (mut low, mut high) = (corner(a), corner(b));
        for _ in 0..10 {
            let middle = low.midpoint(high);
            match (field(middle) > 0.0) == inside(a) {
                true => low = middle,
                false => high = middle,
            }
        }
        low.midpoint(high)
    };
    let mut loops = Vec::new();
    // Sorted, so that the order is the same in every run.
    let mut starts: Vec<_> = next.keys().copied().collect();
    starts.sort_unstable();
    for start in starts {
        let mut points = Vec::new();
        let mut edge = start;
        while let Some(following) = next.remove(&edge) {
            points.push(place(edge));
            edge = following;
        }
        // A contour that leaves the patch is not closed.
        if points.len() > 2 && edge == start {
            loops.push(points);
        }
    }
    loops
}

/// A strip along contours, in rows of vertices. `shore` is the distance from the shore line in metres, positive at
/// sea. Each vertex starts on a contour and follows the gradient of `shore` until `shore` has changed by its row's
/// distance from the shore line. Gradient lines do not cross, so the strip does not overlap itself.
pub fn along(loops: &[Vec<Vec2>], level: f32, reach: Reach, shore: impl Fn(Vec2) -> f32) -> Strip {
    const ROWS: [f32; 9] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0];
    let slope = |p: Vec2| {
        const STEP: f32 = 0.25;
        let rise = |d: Vec2| (shore(p + d) - shore(p - d)) / (2.0 * STEP);
        vec2(rise(vec2(STEP, 0.0)), rise(vec2(0.0, STEP)))
    };
    // Moves along the gradient until `shore` has changed by `by`; in a narrow bay the move ends in the bay's middle.
    let moved = |from: Vec2, by: f32| {
        const STEPS: usize = 16;
        let mut at = from;
        for _ in 0..STEPS {
            let g = slope(at);
            let next = at + by / STEPS as f32 * g / g.length_squared().max(0.1);
            if by * (shore(next) - shore(at)) <= 0.0 {
                break;
            }
            at = next;
        }
        at
    };
    let mut strip = Strip::default();
    for points in loops {
        let first = strip.positions.len() as u32;
        let rows = ROWS.len() as u32;
        for point in points {
            for v in ROWS {
                let off = if v < 1.0 { reach.sea * (1.0 - v) } else { -reach.land * (v - 1.0) };
                let p = moved(*point, off);
                strip.positions.push([p.x, level, p.y]);
                strip.v.push(v);
            }
        }
        let count = points.len() as u32;
        for i in 0..count {
            let (here, there) = (first + i * rows, first + (i + 1) % count * rows);
            for row in 0..rows - 1 {
                let (a, b, c, d) = (here + row, here + row + 1, there + row + 1, there + row);
                strip.indices.extend([a, b, c, a, c, d]);
            }
        }
    }
    strip
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_has_one_loop_and_a_ring_two() {
        let patch = Patch { low: Vec2::splat(-8.0), high: Vec2::splat(8.0), cell: 0.5 };
        let disc = contours(patch, |p| 5.0 - p.length());
        assert_eq!(disc.len(), 1);
        assert!(disc[0].iter().all(|p| (p.length() - 5.0).abs() < 0.05));
        // It is closed: its angles sum to a full turn.
        let turned: f32 =
            disc[0].iter().zip(disc[0].iter().cycle().skip(1)).map(|(a, b)| a.angle_to(*b)).sum();
        assert!((turned.abs() - std::f32::consts::TAU).abs() < 1e-3, "{turned}");
        assert_eq!(contours(patch, |p| 1.0 - (p.length() - 4.0).abs()).len(), 2);
        assert!(contours(patch, |p| p.x - 0.1).is_empty(), "it leaves the patch");
    }

    #[test]
    fn rows_lie_where_they_are_said_to() {
        let patch = Patch { low: Vec2::splat(-8.0), high: Vec2::splat(8.0), cell: 0.5 };
        let loops = contours(patch, |p| 5.0 - p.length());
        let reach = Reach { sea: 2.0, land: 1.0 };
        let strip = along(&loops, 0.3, reach, |p| p.length() - 5.0);
        for (p, v) in strip.positions.iter().zip(&strip.v) {
            let expected = if *v < 1.0 { 5.0 + 2.0 * (1.0 - v) } else { 5.0 - (v - 1.0) };
            assert!((p[0].hypot(p[2]) - expected).abs() < 0.06 && p[1] == 0.3, "{p:?} {v}");
        }
    }
}
