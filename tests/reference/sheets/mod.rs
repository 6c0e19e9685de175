//! Twin of the sheets. Where one body of water stands before another with air between, each texel
//! of the thickness has a boundary: an eye depth between the centres of the front sheet's particles
//! and those of the back sheet's.
//!
//! Let `s` be the spacing and `z` the eye depth of a centre. A sphere counts in the cells of 8x8
//! pixels that its projected box touches. The box is grown by the amount by which 0.35 s exceeds
//! four pixels. A cell has 256 depth slices of `s / 8`, from its nearest centre on; the last slice
//! holds everything farther away. A sphere marks the slices in `z - 0.8 s .. z + 0.8 s`; spheres
//! below 0.6 drawn radii mark nothing. Unmarked slices between marked ones are an air gap. The
//! first five gaps are kept. A cell without gaps borrows those of the first neighbour that has any,
//! in the order left, right, above, below, diagonals.
//!
//! A texel uses the nearest depth of its pixels as its surface, and the cells around it with
//! bilinear weights. From each cell it takes the first gap whose middle lies behind the surface. Of
//! these gaps it selects the one that begins first and all that overlap it. A gap of width `w`
//! counts `w / (2 (f - s))`, at most 1, where `f` is the falloff, times a factor from 0.05 to 1 for
//! water of 14 to 22 slices behind the gap. Borrowed gaps count 0. If the weighted sum is at
//! least one half, the selected gaps are chosen. Otherwise gaps that begin behind the first one are
//! selected in the same way, and the selection with the largest sum is chosen. Without a gap behind
//! the surface, the last gap before it is chosen. The boundary is the weighted mean of the gaps'
//! middles, but at most two spacings behind the beginning of each gap. It lies half a spacing
//! inside the range that the chosen gaps share.

mod boundaries;
mod judged;
mod parts;
#[cfg(test)]
mod tests;

use std::ops::Range;

pub use boundaries::{Cell, Rule, airs_of, cells, cells_from, counted, of_texels};
pub use judged::{KnownTexel, Slack, judged, judged_texels};
pub use parts::{
    Boundaries, back_depth, boundary_at, made, pixel_of_texel, prune, shares, thickness,
};

/// Edge of a cell in pixels.
pub const CELL: usize = 8;
/// Number of slices of a cell.
pub const SLICES: usize = 256;
/// Edge of a tile in texels of the smoothing.
pub const TILE: usize = 16;

/// Pixels by which the box of a projection is grown.
pub const GROWN: f64 = 1.0 / 64.0;
/// Depth before and behind its centre that a sphere marks, in spacings.
pub const REACH: f64 = 0.8;
/// Distance beside its box in which a sphere counts, in spacings; half a cell is subtracted.
const BESIDE: f64 = 0.35;
/// Depth of a slice, in spacings.
pub const SLICE: f64 = 0.125;
/// Spheres with a radius below this, in spacings, are drops, which mark nothing: 0.6 drawn radii.
const DROP: f64 = 0.6 * 0.656;
/// Max number of air gaps of a cell.
const AIRS: usize = 5;
/// Least width of an air gap, in spacings.
const NARROWEST: f64 = 0.5;
/// Marked slices of a drop, and of a body of water.
const BODY: [f64; 2] = [14.0, 22.0];
/// Factor of a gap before a drop.
const LEAST: f64 = 0.05;
/// Sum from which on gaps are chosen.
const CHOSEN: f64 = 0.5;
/// Max distance of the boundary behind the beginning of a gap, in spacings.
const BEYOND: f64 = 2.0;
/// Distance that the boundary keeps to the ends of the range that the gaps share, in spacings.
const CLEAR: f64 = 0.5;
/// Half the depth range in which the share passes from one sheet to the other, in spacings.
const SOFT: f64 = 0.5;
/// Distances from the boundary up to which water fills the window, and from which on it does not
/// count, in spacings.
const WINDOW: [f64; 2] = [0.5, 1.5];
/// With one sheet the window holds this many times the water's thickness.
pub const ONE_SHEET: f64 = 1e6;
/// Distance, in radii, below which the projection of a sphere is unbounded.
const UNBOUNDED: f64 = 1.01;

/// Columns and rows of pixels or cells.
pub type Part = (Range<usize>, Range<usize>);
