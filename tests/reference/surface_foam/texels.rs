//! Texels of the foam images: their width, the pixels in which a point may be visible, and the
//! depth of the scene.

use super::super::{Image, View};
use glam::{DVec2, DVec3};

/// Width of a texel, in world units, at the depth of a point.
pub(super) fn texel(center: DVec3, view: &View) -> f64 {
    -center.z * view.slope_step().abs().max_element()
}

/// Pixels whose rays may pass within `reach` of a point.
pub fn pixels(view: &View, center: DVec3, reach: f64) -> impl Iterator<Item = (usize, usize)> {
    let (middle, half) = (center.truncate(), DVec2::splat(reach));
    let (columns, rows) = view.footprint(middle, half, -center.z - reach, -center.z + reach);
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

/// Value of the full image at the centre of a texel that covers `2^level` pixels along each axis.
/// If the centre lies outside the image, the last pixel is used.
pub(super) fn in_full<T: Clone>(image: &Image<T>, x: usize, y: usize, level: u32) -> T {
    // The centre of a block lies on the border of two pixels; the one with the higher index is
    // used.
    let middle = |i: usize| ((i << level) + (1 << level) / 2) as isize;
    image.clamped(middle(x), middle(y))
}

/// Depth of the scene. A value that is no valid depth counts as infinitely far, so that it hides
/// nothing.
pub fn scene_depth(scene: f64) -> f64 {
    if scene > 0.0 { scene } else { f64::INFINITY }
}
