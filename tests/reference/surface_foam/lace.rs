//! Twin of the lace of thin foam: walls between bubbles of different sizes.
//!
//! A point belongs to the bubble with the largest power `r^2 - |x - c|^2`, if that is positive. The
//! difference to the next largest power, or to 0, relative to the largest radius squared, says how
//! far inside the bubble the point is. Each cell has one bubble. Several sizes are summed, at a
//! point displaced by a noise's slope, and the noise itself is added.

use super::super::smoothstep;
use super::noise::noise;
use super::pattern::Phase;
use glam::{DVec3, IVec3};

/// Min and max radius, in cells.
const RADII: (f64, f64) = (0.5, 0.7);
/// Max distance of a bubble's centre from its cell's along each axis.
const STRAY: f64 = 0.3;
/// Large, medium and small bubbles: cell width, offset and weight.
const SIZES: [(f64, f64, f64); 3] = [(1.0, 0.0, 0.42), (0.4, 31.7, 0.34), (0.16, 77.3, 0.24)];
/// Pixels per cell between which bubbles replace their mean.
const TOLD: (f64, f64) = (1.5, 4.0);
const MEAN: f64 = 0.232;
/// Cell width of the noise, displacement by its slope, and its weight.
const NOISE: (f64, f64, f64) = (2.6, 0.3, 0.3);
/// Median of `closes`.
const MEDIAN: f64 = 0.22;
/// Amount of foam that covers a half, and the scale of the logistic distribution.
const LOGISTIC: (f64, f64) = (0.33, 0.127);
/// Missing opacity where foam has just closed a hole, and the additional foam that makes it opaque.
const SHEER: (f64, f64) = (0.45, 0.45);
/// Half the width of a thread's end: the min, and the factor per pixel of a cell.
const ENDS: (f64, f64) = (0.04, 0.7);
/// Half the width of a thread's soft edge, which has half of the weight.
const EDGE: f64 = 0.16;

/// The bubble of a cell: its centre in cells, and its radius.
fn bubble(cell: IVec3) -> (DVec3, f64) {
    let [i, j, k] = cell.to_array().map(|c| c as u32);
    let joined =
        i.wrapping_mul(0x9E37_79B1) ^ j.wrapping_mul(0x85EB_CA77) ^ k.wrapping_mul(0xC2B2_AE3D);
    let mixed = (joined ^ (joined >> 15)).wrapping_mul(0x27D4_EB2F);
    let [x, y, z, r] = (mixed ^ (mixed >> 13)).to_le_bytes().map(|b| f64::from(b) / 255.0);
    let stray = STRAY * (2.0 * DVec3::new(x, y, z) - 1.0);
    (cell.as_dvec3() + 0.5 + stray, RADII.0 + (RADII.1 - RADII.0) * r)
}

/// How far inside a bubble a point is; the bubbles of all adjacent cells include every one that can
/// reach it.
fn inside(place: DVec3) -> f64 {
    let here = place.floor().as_ivec3();
    let mut powers = vec![0.0, 0.0];
    for (i, j, k) in
        (-1..=1).flat_map(|i| (-1..=1).flat_map(move |j| (-1..=1).map(move |k| (i, j, k))))
    {
        let (centre, radius) = bubble(here + IVec3::new(i, j, k));
        powers.push(radius * radius - place.distance_squared(centre));
    }
    powers.sort_by(f64::total_cmp);
    let [.., next, most] = powers[..] else { unreachable!() };
    (most - next) / (RADII.1 * RADII.1)
}

/// Amount of foam that covers a point, where a cell of the pattern is `pixels` pixels wide.
pub fn closes(place: DVec3, pixels: f64) -> f64 {
    let at = place / NOISE.0;
    let step = 1.0e-5;
    let along = |axis: DVec3| (noise(at + step * axis) - noise(at - step * axis)) / (2.0 * step);
    let slope = DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z));
    let moved = place + NOISE.1 * slope;
    let of = |&(cell, begin, part): &(f64, f64, f64)| {
        let told = smoothstep(TOLD.0, TOLD.1, pixels * cell);
        part * (MEAN + told * (inside(moved / cell + begin) - MEAN))
    };
    SIZES.iter().map(of).sum::<f64>() + NOISE.2 * noise(at)
}

/// Half the width of a thread's end, where a cell is `pixels` pixels wide.
pub fn ends(pixels: f64) -> f64 {
    (ENDS.1 / pixels).max(ENDS.0)
}

/// Amount of foam that covers a point, less the median. The distances of two pattern phases from the
/// median are summed with their weights; `drift` is the foam's velocity in cells per second.
pub fn pore(place: DVec3, (drift, phases): (DVec3, &[Phase]), pixels: f64) -> f64 {
    let of = |phase: &Phase| {
        let at = place - drift * phase.carried + phase.began;
        phase.part * (closes(at, pixels) - MEDIAN)
    };
    phases.iter().map(of).sum()
}

/// Fraction that threads cover of a point, where smooth foam would cover `hidden`.
pub fn covered(hidden: f64, place: DVec3, moving: (DVec3, &[Phase]), pixels: f64) -> f64 {
    let much = LOGISTIC.0 + LOGISTIC.1 * (hidden.max(1.0e-6) / (1.0 - hidden).max(1.0e-6)).ln();
    let closes = MEDIAN + pore(place, moving, pixels);
    let ends = ends(pixels);
    let over = |ends: f64| smoothstep(closes - ends, closes + ends, much);
    let body = 1.0 - SHEER.0 * (1.0 - smoothstep(0.0, SHEER.1, much - closes));
    if hidden > 0.0 { 0.5 * body * (over(ends) + over(ends.max(EDGE))) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::scenes::Random;

    /// A single phase, and foam at rest.
    const STILL: (DVec3, &[Phase]) =
        (DVec3::ZERO, &[Phase { part: 1.0, carried: 0.0, began: 0.0 }]);

    /// Lace covers as much of the picture as smooth foam, for any fraction.
    #[test]
    fn lace_hides_as_much_as_smooth_foam() {
        let mut random = Random(3);
        let places: Vec<_> = (0..20_000)
            .map(|_| DVec3::from([0; 3].map(|_| f64::from(random.between(-300.0, 300.0)))))
            .collect();
        for tenth in 1..10 {
            let hidden = 0.1 * f64::from(tenth);
            let all: f64 = places.iter().map(|place| covered(hidden, *place, STILL, 100.0)).sum();
            let mean = all / places.len() as f64;
            // The distribution is only approximately logistic.
            assert!((mean - hidden).abs() < 0.03, "{hidden}: {mean}");
            // The pattern has threads and holes: few points are covered by an amount between, at
            // thin spots and at threads' edges.
            let veiled =
                places.iter().filter(|p| (0.1..0.4).contains(&covered(hidden, **p, STILL, 100.0)));
            assert!(veiled.count() < places.len() / 6, "{hidden}: a veil");
        }
        let all: f64 = places.iter().map(|place| inside(*place)).sum();
        assert!((all / places.len() as f64 - MEAN).abs() < 0.005, "the mean of the bubbles");
        assert_eq!(covered(0.0, places[0], STILL, 100.0), 0.0);
        assert_eq!(covered(1.0, places[0], STILL, 100.0), 1.0);
    }

    /// There is no jump where cells meet, because the adjacent cells include every bubble that
    /// reaches a point.
    #[test]
    fn cells_leave_no_seam() {
        let mut random = Random(4);
        for _ in 0..20_000 {
            let mut place = DVec3::from([0; 3].map(|_| f64::from(random.between(-50.0, 50.0))));
            place.x = (2.0 * place.x).round() / 2.0;
            let step = 1.0e-7;
            let apart = inside(place + step) - inside(place - step);
            assert!(apart.abs() < 40.0 * step, "{place}: {apart}");
        }
    }
}
