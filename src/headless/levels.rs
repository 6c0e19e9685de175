//! Merges the smoothing levels (resolutions at which the water's depth is smoothed) as the picture shows them,
//! at the resolution of a layer's first and finest level.

use super::Picture;
use crate::diagnostics::{SmoothingLevel, SmoothingLevels};
use crate::frame::EMPTY;

/// A layer of water in the smoothing levels.
#[derive(Clone, Copy)]
pub struct Sheet {
    first: usize,
    /// Number of levels (halvings of resolution) by which this layer's first level is coarser than the first level of
    /// the front layer of water.
    coarser: usize,
}

/// The front layer.
pub const FRONT: Sheet = Sheet { first: 0, coarser: 0 };
/// The back layer.
pub const BACK: Sheet = Sheet { first: 4, coarser: 1 };

impl Sheet {
    /// Whether this layer exists.
    pub fn is_in(self, levels: &SmoothingLevels) -> bool {
        levels.level[self.first].rect[2] > 0
    }
}

/// Makes a picture of a layer's first level. Each texel with water gets the value of `of`, which is called with
/// the texel, its depth, the level that is visible there, and the fraction to which the next coarser level has
/// faded in. Texels without water get `none`.
fn each(
    levels: &SmoothingLevels,
    depth: &Picture<f32>,
    sheet: Sheet,
    none: f32,
    of: impl Fn([usize; 2], f32, usize, f32) -> f32,
) -> Picture<f32> {
    let level = &levels.level[sheet.first];
    let [_, _, width, height] = level.rect.map(|v| v as usize);
    let texel = |i: usize| {
        let at = [i % width, i / width];
        let z = at_texel(depth, level, at);
        if z >= EMPTY {
            return None;
        }
        let [x, y, first_x, first_y] = level.slope;
        let slope = [x * (at[0] as f32 + 0.5) + first_x, y * (at[1] as f32 + 0.5) + first_y];
        let (shown, fade) = levels.shown(z, slope);
        let fade = if shown < sheet.coarser { 0.0 } else { fade };
        Some(of(at, z, sheet.first + shown.saturating_sub(sheet.coarser), fade))
    };
    let data = (0..width * height).map(|i| texel(i).unwrap_or(none)).collect();
    Picture { width, height, data }
}

fn at_texel<T: Copy>(image: &Picture<T>, level: &SmoothingLevel, [x, y]: [usize; 2]) -> T {
    let [first_x, first_y, width, height] = level.rect.map(|v| v as usize);
    image.data[(first_y + y.min(height - 1)) * image.width + first_x + x.min(width - 1)]
}

/// The smoothed depth. `image` holds all levels.
pub fn surface(levels: &SmoothingLevels, image: &Picture<f32>, sheet: Sheet) -> Picture<f32> {
    each(levels, image, sheet, EMPTY, |at, z, shown, fade| {
        let of = |level: usize| smoothed(levels, image, sheet, level, at, z);
        if fade == 0.0 { of(shown) } else { of(shown) * (1.0 - fade) + of(shown + 1) * fade }
    })
}

/// Smoothed depth in the level `level`, interpolated at the centre of the texel `at` of the layer's first level
/// between the four texels of `level` around it. Those whose depth is far from `z` lie on another surface and do not
/// count.
fn smoothed(
    levels: &SmoothingLevels,
    image: &Picture<f32>,
    sheet: Sheet,
    level: usize,
    at: [usize; 2],
    z: f32,
) -> f32 {
    let (first, level) = (&levels.level[sheet.first], &levels.level[level]);
    let place = at.map(|v| (v as f32 + 0.5) * first.texel[2] / level.texel[2] - 0.5);
    let (mut sum, mut weights) = (0.0, 0.0);
    for i in 0..4 {
        let corner = [place[0].floor() + (i & 1) as f32, place[1].floor() + (i >> 1) as f32];
        let weight = (1.0 - (place[0] - corner[0]).abs()) * (1.0 - (place[1] - corner[1]).abs());
        let there = at_texel(image, level, corner.map(|v| v.max(0.0) as usize));
        if (there - z).abs() <= levels.near[2] {
            sum += weight * (there - z);
            weights += weight;
        }
    }
    if weights > 0.0 { z + sum / weights } else { z }
}

/// The picture `water.iterations`: for each texel of the front layer of water, the number of smoothing iterations
/// planned there; 0 without water. Where two resolution levels are blended, it is the number of the level with the
/// greater weight. `plan` holds the numbers of all levels, in one image.
pub fn iterations(
    levels: &SmoothingLevels,
    depth: &Picture<f32>,
    plan: &Picture<f32>,
) -> Picture<f32> {
    each(levels, depth, FRONT, 0.0, |at, _, shown, fade| {
        let shown = if fade < 0.5 { shown } else { shown + 1 };
        at_texel(plan, &levels.level[shown], at.map(|v| v >> shown))
    })
}
