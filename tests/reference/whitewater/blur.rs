//! Twin of the blur of shadow and light.

use super::super::{Image, View};
use super::{Occlusion, Seen};

/// Step between the values of a blur with this reach in pixels: at most 32 values on each side, and
/// an odd step, so that all pixels of each 4x4 block contribute.
/// `a_wide_blur_is_nearly_the_gaussian`, which uses all pixels, shows that these values are enough.
fn step_of(reach: usize) -> usize {
    (1..).step_by(2).find(|step| reach.div_ceil(*step) <= 32).unwrap_or(1)
}

/// Shadow and light, a number and a colour, blurred along rows and then along columns. The radius
/// is that of the pixel's own first pass. Pixels without foam, or more than a particle's diameter
/// before or behind, do not contribute. Pixels without foam keep their value.
pub fn blur(
    values: &Image<[f64; 4]>,
    front: &Image<Option<Seen>>,
    view: &View,
    settings: &Occlusion,
) -> Image<[f64; 4]> {
    let rows = along(values, front, view, settings, (1, 0));
    along(&rows, front, view, settings, (0, 1))
}

/// The blur along one axis.
fn along(
    values: &Image<[f64; 4]>,
    front: &Image<Option<Seen>>,
    view: &View,
    settings: &Occlusion,
    (dx, dy): (isize, isize),
) -> Image<[f64; 4]> {
    Image::from_fn(view.width, view.height, |x, y| {
        let Some(seen) = front.at(x, y) else { return values.at(x, y) };
        let radius = settings.blur * 0.5 * settings.search(seen.h, 1) * view.extent().y;
        let radius = radius.max(settings.least_blur);
        let sigma = 0.5 * radius;
        let gap = 2.0 * seen.h * seen.depth / view.focal().y.abs();
        let gap = gap.max(2.0 * settings.least_blur * view.c_y() * seen.depth);
        let (at, last) = if dx == 1 { (x, view.width - 1) } else { (y, view.height - 1) };
        // Outside the picture there are no values.
        let reach = radius.floor().min(at.max(last - at) as f64) as usize;
        let step = step_of(reach);
        let most = (reach / step * step) as isize;
        let (mut sum, mut weights) = ([0.0; 4], 0.0);
        for i in (-most..=most).step_by(step) {
            let (x, y) = (x as isize + i * dx, y as isize + i * dy);
            let (Some(Some(there)), Some(value)) = (front.checked(x, y), values.checked(x, y))
            else {
                continue;
            };
            if (there.depth - seen.depth).abs() > gap {
                continue;
            }
            let away = i as f64;
            // The pixel itself has the full weight, however narrow the blur.
            let weight = if i == 0 { 1.0 } else { (-away * away / (2.0 * sigma * sigma)).exp() };
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += weight * value;
            }
            weights += weight;
        }
        sum.map(|sum| sum / weights)
    })
}
