//! Which of the blobs too small to be seen are kept, and with which size (Cook, Halstead, Planck, Ryu 2007).

use crate::reference::classify::pcg;

/// Over this part of the share that is left a blob shrinks before it goes.
const FADES: f64 = 0.5;

/// A blob's place in the order in which they go, 0 to 1.
pub fn order(id: u32) -> f64 {
    f64::from(pcg(id ^ 0x6d65_7267) >> 8) / f64::from(1 << 24)
}

/// Share of blobs that keep at least so much of their radius, where `left` is the share that keeps all of it.
fn share(left: f64, part: f64) -> f64 {
    (left * (1.0 + FADES * (1.0 - part))).min(1.0)
}

/// What a blob's radius is multiplied by. `pixels`: of its radius; `merge`: below which blobs merge.
pub fn scale(pixels: f64, merge: f64, id: u32) -> f64 {
    let left = (pixels / merge).powi(2);
    if left >= 1.0 {
        return 1.0;
    }
    let part = (1.0 + (left - order(id)) / (FADES * left)).clamp(0.0, 1.0);
    // The mean of part², by Simpson's rule over where part² has no kinks: ∫ 2 p · share(p) dp.
    let steps = 1000;
    let mean: f64 = (0..=steps)
        .map(|i| {
            let p = f64::from(i) / f64::from(steps);
            let weight = if i == 0 || i == steps { 1.0 } else { [2.0, 4.0][i as usize % 2] };
            weight * 2.0 * p * share(left, p)
        })
        .sum::<f64>()
        / (3.0 * f64::from(steps));
    part / mean.sqrt()
}
