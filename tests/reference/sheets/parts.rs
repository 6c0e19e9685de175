//! Results of the boundaries: the thickness of each sheet, and the depth of the back sheet.

use super::super::depth::splat_where;
use super::super::thickness::{self, Amplitude};
use super::super::{EMPTY, Image, Sphere, View, is_surface, smoothstep};

use super::{CELL, ONE_SHEET, SOFT, TILE, WINDOW};

/// Shares of a splat whose centre has the depth z: in the front sheet, and in the window between
/// the sheets.
pub fn shares(z: f64, boundary: f64, spacing: f64) -> (f64, f64) {
    if !is_surface(boundary) {
        return (1.0, ONE_SHEET);
    }
    let soft = SOFT * spacing;
    let back = smoothstep(boundary - soft, boundary + soft, z);
    let [near, far] = WINDOW.map(|part| part * spacing);
    (1.0 - back, 1.0 - smoothstep(near, far, (z - boundary).abs()))
}

/// Thickness of the front sheet, of the back sheet and of the window between them. `full`: view of
/// the frame at full resolution.
pub fn thickness(
    spheres: &[Sphere],
    full: &View,
    level: u32,
    boundaries: &Image<f64>,
    spacing: f64,
    amplitude: Amplitude,
) -> Image<[f64; 3]> {
    let view = full.reduced(level);
    let all = thickness::splat(spheres, &view, None, amplitude);
    let share = |pick: fn((f64, f64)) -> f64| {
        thickness::splat_where(spheres, &view, None, amplitude, |x, y, sphere| {
            pick(shares(-sphere.center.z, boundaries.at(x, y), spacing))
        })
    };
    let (front, window) = (share(|shares| shares.0), share(|shares| shares.1));
    Image::from_fn(view.width, view.height, |x, y| match is_surface(boundaries.at(x, y)) {
        true => [front.at(x, y), all.at(x, y) - front.at(x, y), window.at(x, y)],
        false => [all.at(x, y), 0.0, ONE_SHEET * all.at(x, y)],
    })
}

/// Removes the boundaries where a sheet has no water; all water belongs to the front sheet there.
pub fn prune(boundaries: &mut Image<f64>, thickness: &mut Image<[f64; 3]>) {
    for (boundary, texel) in boundaries.data.iter_mut().zip(&mut thickness.data) {
        let [front, back, _] = *texel;
        if front == 0.0 || back == 0.0 {
            *boundary = EMPTY;
            *texel = [front + back, 0.0, ONE_SHEET * (front + back)];
        }
    }
}

/// The boundaries of a frame, one for each texel of the thickness at its level.
#[derive(Clone, Copy, Debug)]
pub struct Boundaries<'a> {
    pub texels: &'a Image<f64>,
    pub level: u32,
}

impl Boundaries<'_> {
    /// Boundary of the texel that contains a pixel.
    pub fn of_pixel(&self, x: usize, y: usize) -> f64 {
        self.texels.at(x >> self.level, y >> self.level)
    }
}

/// The pixel whose boundary a texel of `2^level` pixels uses; `level` is at least 1.
pub fn pixel_of_texel(full: &View, level: u32, x: usize, y: usize) -> (usize, usize) {
    let along = |i: usize, extent: usize| ((i << level) + (1 << level) / 2).min(extent - 1);
    (along(x, full.width), along(y, full.height))
}

/// The boundary at a texel of the back sheet's depth.
pub fn boundary_at(
    boundaries: &Boundaries<'_>,
    full: &View,
    level: u32,
    x: usize,
    y: usize,
) -> f64 {
    let (x, y) = pixel_of_texel(full, level, x, y);
    boundaries.of_pixel(x, y)
}

/// Depth of the back sheet at a level: the nearest hit of the ray through a texel's centre with the
/// spheres of the back sheet, even behind the scene. With one sheet it is the depth image, and away
/// from all gaps it is EMPTY.
pub fn back_depth(
    spheres: &[Sphere],
    full: &View,
    level: u32,
    boundaries: &Boundaries<'_>,
    depth: &Image<f64>,
) -> Image<f64> {
    let (view, made) = (full.reduced(level), made(boundaries, full, level));
    let at = |x, y| boundary_at(boundaries, full, level, x, y);
    let hits = splat_where(spheres, &view, |x, y, sphere| -sphere.center.z >= at(x, y));
    Image::from_fn(view.width, view.height, |x, y| {
        if !made.at(x, y) {
            EMPTY
        } else if is_surface(at(x, y)) {
            hits.at(x, y)
        } else {
            let (x, y) = pixel_of_texel(full, level, x, y);
            depth.at(x, y)
        }
    })
}

/// Texels of the tiles that are made. A tile is made if a cell within a tile's edge of it has two
/// sheets at its centre.
pub fn made(boundaries: &Boundaries<'_>, full: &View, level: u32) -> Image<bool> {
    let view = full.reduced(level);
    let (columns, rows) = (full.width.div_ceil(CELL), full.height.div_ceil(CELL));
    let split = Image::from_fn(columns, rows, |x, y| {
        let middle = |k: usize, extent: usize| (CELL * k + CELL / 2).min(extent - 1);
        is_surface(boundaries.of_pixel(middle(x, full.width), middle(y, full.height)))
    });
    // Cells that overlap the tile or a neighbouring tile.
    let cells = |tile: usize, cells: usize| {
        let edge = TILE << level;
        let pixels = (tile * edge).saturating_sub(edge)..(tile + 2) * edge;
        pixels.start / CELL..pixels.end.div_ceil(CELL).min(cells)
    };
    let tiles = |texels: usize| texels.div_ceil(TILE);
    let tiles = Image::from_fn(tiles(view.width), tiles(view.height), |x, y| {
        let columns = cells(x, split.width);
        cells(y, split.height).any(|y| columns.clone().any(|x| split.at(x, y)))
    });
    Image::from_fn(view.width, view.height, |x, y| tiles.at(x / TILE, y / TILE))
}
