//! Stochastic simplification (Cook, Halstead, Planck, Ryu 2007): which blobs smaller than a pixel
//! are kept, and by how much they are enlarged.

use crate::reference::classify::pcg;

/// A blob shrinks before it is removed, over this fraction of the kept share.
const FADES: f64 = 0.5;

/// A blob's rank in the order of removal, 0 to 1.
pub fn order(id: u32) -> f64 {
    f64::from(pcg(id ^ 0x6d65_7267) >> 8) / f64::from(1 << 24)
}

/// Share of the blobs that keep at least the fraction `part` of their radius. `left`: share that
/// keeps all of it.
fn share(left: f64, part: f64) -> f64 {
    (left * (1.0 + FADES * (1.0 - part))).min(1.0)
}

/// Factor for a blob's radius. `pixels`: radius in pixels; `merge`: radius in pixels below which
/// blobs are removed.
pub fn scale(pixels: f64, merge: f64, id: u32) -> f64 {
    let left = (pixels / merge).powi(2);
    if left >= 1.0 {
        return 1.0;
    }
    let part = (1.0 + (left - order(id)) / (FADES * left)).clamp(0.0, 1.0);
    // Mean of part² over all blobs, ∫ 2 p share(p) dp over p from 0 to 1, by Simpson's rule.
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
