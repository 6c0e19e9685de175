//! The noise that modulates a sprite, and its bounds.

use super::super::classify::pcg;
use super::SPREAD;
use crate::support::tolerance::U;
use glam::DVec3;

/// Where the noise of an id begins, in cells.
pub fn origin(id: u32) -> DVec3 {
    let uniform = |i: u32| {
        let hash = pcg(id.wrapping_mul(3).wrapping_add(i));
        f64::from(hash >> 8) / 16_777_216.0
    };
    SPREAD * DVec3::new(uniform(0), uniform(1), uniform(2))
}

/// Perlin's gradient noise at a position in cells: mean 0, absolute value at most the root of 1.5.
pub fn noise(place: DVec3) -> f64 {
    let cell = place.floor();
    let fr = place - cell;
    let fade = fr * fr * fr * (fr * (6.0 * fr - 15.0) + 10.0);
    let corner = |i: i64, j: i64, k: i64| {
        let offset = fr - DVec3::new(i as f64, j as f64, k as f64);
        // Wraps to 32 bits.
        let at = [cell.x as i64 + i, cell.y as i64 + j, cell.z as i64 + k].map(|c| c as u32);
        gradient(at, offset)
    };
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let along_x = |j, k| mix(corner(0, j, k), corner(1, j, k), fade.x);
    let along_y = |k| mix(along_x(0, k), along_x(1, k), fade.y);
    mix(along_y(0), along_y(1), fade.z)
}

/// Factors of the coordinates in a lattice point's hash, and the factor that mixes it: primes of
/// xxHash.
const LATTICE: [u32; 3] = [2_654_435_761, 2_246_822_519, 3_266_489_917];
const MIX: u32 = 668_265_263;

/// A lattice point's gradient: one of sixteen numbers, for twelve gradients of which four occur
/// twice.
pub(super) fn gradient_number([i, j, k]: [u32; 3]) -> u32 {
    let [i, j, k] = [(i, 0), (j, 1), (k, 2)].map(|(c, axis)| c.wrapping_mul(LATTICE[axis]));
    let joined = i ^ j ^ k;
    (joined ^ (joined >> 15)).wrapping_mul(MIX) >> 28
}

/// Product of an offset with the gradient of a lattice point, one of twelve vectors to the centres
/// of a cube's edges.
pub(super) fn gradient(at: [u32; 3], offset: DVec3) -> f64 {
    let h = gradient_number(at);
    let u = if h < 8 { offset.x } else { offset.y };
    let v = match h {
        0..4 => offset.y,
        12 | 14 => offset.x,
        _ => offset.z,
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// Max of [`noise`], by Jensen's inequality: a gradient's length is the root of 2, and the mean
/// square of an offset's component, weighted by the fades, is at most a quarter:
/// `(1 - F) f^2 + F (1 - f)^2 <= f (1 - f)`, as `F <= f` up to the middle.
pub fn noise_reach() -> f64 {
    1.5_f64.sqrt()
}

/// Max change of [`noise`] by a fade: by the same inequality, the two ends along it are at most
/// `sqrt(2) sqrt(f^2 + 1/2)` and that of 1 - f. The sum is convex, so its max is at 0 and 1.
fn noise_by_fade() -> f64 {
    1.0 + 3.0_f64.sqrt()
}

/// Max change of [`noise`] along an axis per cell: a gradient's component is at most 1, and the
/// slope of a fade, `30 f^2 (1 - f)^2`, at most 15/8. The noise is continuous between cells.
pub fn noise_slope() -> f64 {
    1.0 + 15.0 / 8.0 * noise_by_fade()
}

/// Error of [`noise`] in single precision at an exact position. The position in the cell and the
/// product with a gradient: 4u of components of at most 1. A fade: 15u, with 9u and 1u of the sums
/// and 3u of the products. Three mixes: 5u each of numbers of at most 2.
pub fn noise_rounding() -> f64 {
    U * (4.0 + 3.0 * 28.0 * noise_by_fade() + 3.0 * 10.0)
}
