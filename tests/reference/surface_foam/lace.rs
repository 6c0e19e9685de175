//! Twin of the lace of thin foam: walls between bubbles of different sizes.
//!
//! A place belongs to the bubble of the largest power `r^2 - |x - c|^2`, if any is above 0; how far its power lies above
//! the next or above 0 is how far inside of it the place is, of the largest radius squared. Cells hold a bubble each. Of
//! two sizes the sum, at a place that is moved by the slope of a noise, and the noise itself.

use super::super::smoothstep;
use super::noise::noise;
use super::pattern::Phase;
use glam::{DVec3, IVec3};

/// Radii from the least to the largest, in cells.
const RADII: (f64, f64) = (0.5, 0.7);
/// How far a centre lies from its cell's, along each axis at most.
const STRAY: f64 = 0.3;
/// Of large, middling and small bubbles: width of cells, where they begin, and their part.
const SIZES: [(f64, f64, f64); 3] = [(1.0, 0.0, 0.42), (0.4, 31.7, 0.34), (0.16, 77.3, 0.24)];
/// Pixels of a cell between which it comes, in the place of its mean.
const TOLD: (f64, f64) = (1.5, 4.0);
const MEAN: f64 = 0.232;
/// Width of the noise's cells; by how much its slope moves; its own part.
const NOISE: (f64, f64, f64) = (2.6, 0.3, 0.3);
/// Median of what closes a place.
const MEDIAN: f64 = 0.22;
/// What covers half, and the scale of the logistic distribution.
const LOGISTIC: (f64, f64) = (0.33, 0.127);
/// What the opacity of foam lacks that has just closed a place, and how much more closes it wholly.
const SHEER: (f64, f64) = (0.45, 0.45);
/// Half the width of a thread's end, at least, and times the pixels of a cell.
const ENDS: (f64, f64) = (0.04, 0.7);
/// Half the width of what its edge ends over, which is half of it.
const EDGE: f64 = 0.16;

/// Of a cell: its bubble's centre, in cells, and its radius.
fn bubble(cell: IVec3) -> (DVec3, f64) {
    let [i, j, k] = cell.to_array().map(|c| c as u32);
    let joined =
        i.wrapping_mul(0x9E37_79B1) ^ j.wrapping_mul(0x85EB_CA77) ^ k.wrapping_mul(0xC2B2_AE3D);
    let mixed = (joined ^ (joined >> 15)).wrapping_mul(0x27D4_EB2F);
    let [x, y, z, r] = (mixed ^ (mixed >> 13)).to_le_bytes().map(|b| f64::from(b) / 255.0);
    let stray = STRAY * (2.0 * DVec3::new(x, y, z) - 1.0);
    (cell.as_dvec3() + 0.5 + stray, RADII.0 + (RADII.1 - RADII.0) * r)
}

/// How far inside of a bubble a place is, by all bubbles of the cells around it, more than can reach it.
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

/// How much foam it takes to close a place, which is in cells of so many pixels.
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

/// Half the width of what a thread ends over, where a cell is so many pixels wide.
pub fn ends(pixels: f64) -> f64 {
    (ENDS.1 / pixels).max(ENDS.0)
}

/// Share that threads hide of a place, of which smooth foam hides a share: of two phases of the pattern, whose distances from
/// the median are added by their parts, of foam that goes so many cells a second.
pub fn covered(hidden: f64, place: DVec3, (drift, phases): (DVec3, &[Phase]), pixels: f64) -> f64 {
    let much = LOGISTIC.0 + LOGISTIC.1 * (hidden.max(1.0e-6) / (1.0 - hidden).max(1.0e-6)).ln();
    let of = |phase: &Phase| {
        let at = place - drift * phase.carried + phase.began;
        phase.part * (closes(at, pixels) - MEDIAN)
    };
    let closes = MEDIAN + phases.iter().map(of).sum::<f64>();
    let ends = ends(pixels);
    let over = |ends: f64| smoothstep(closes - ends, closes + ends, much);
    let body = 1.0 - SHEER.0 * (1.0 - smoothstep(0.0, SHEER.1, much - closes));
    if hidden > 0.0 { 0.5 * body * (over(ends) + over(ends.max(EDGE))) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::support::scenes::Random;

    /// One phase, and foam at rest.
    const STILL: (DVec3, &[Phase]) =
        (DVec3::ZERO, &[Phase { part: 1.0, carried: 0.0, began: 0.0 }]);

    /// As much of the picture is hidden as by smooth foam, whatever share that is.
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
            // The distribution is not quite logistic.
            assert!((mean - hidden).abs() < 0.03, "{hidden}: {mean}");
            // Threads and holes: what is between, thin foam and a thread's edge, hides less than a thread's half.
            let veiled =
                places.iter().filter(|p| (0.1..0.4).contains(&covered(hidden, **p, STILL, 100.0)));
            assert!(veiled.count() < places.len() / 6, "{hidden}: a veil");
        }
        let all: f64 = places.iter().map(|place| inside(*place)).sum();
        assert!((all / places.len() as f64 - MEAN).abs() < 0.005, "the mean of the bubbles");
        assert_eq!(covered(0.0, places[0], STILL, 100.0), 0.0);
        assert_eq!(covered(1.0, places[0], STILL, 100.0), 1.0);
    }

    /// Nothing jumps where cells meet: eight of them hold all that reach a place.
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
