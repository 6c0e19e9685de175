//! The texels of the foam images: their width, which of them see a point, and occlusion.

use super::super::{Image, View};
use glam::{DVec2, DVec3};

/// How wide a texel is at the depth of a point.
pub(super) fn texel(center: DVec3, view: &View) -> f64 {
    -center.z * view.slope_step().abs().max_element()
}

/// The pixels that may see anything within a distance of a point.
pub fn pixels(view: &View, center: DVec3, reach: f64) -> impl Iterator<Item = (usize, usize)> {
    let (middle, half) = (center.truncate(), DVec2::splat(reach));
    let (columns, rows) = view.footprint(middle, half, -center.z - reach, -center.z + reach);
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

/// The pixel in which a texel's centre lies, of an image `2^level` times as fine: the last one
/// where the texel sticks out.
pub(super) fn in_full<T: Clone>(image: &Image<T>, x: usize, y: usize, level: u32) -> T {
    // The middle of a block lies on the border of two pixels and counts to the latter.
    let middle = |i: usize| ((i << level) + (1 << level) / 2) as isize;
    image.clamped(middle(x), middle(y))
}

/// The scene's depth; what is no depth hides nothing.
pub fn scene_depth(scene: f64) -> f64 {
    if scene > 0.0 { scene } else { f64::INFINITY }
}
