//! Twin of the sheets: where one body of water stands before another with air between, each texel of
//! the thickness has a boundary, the eye depth between the centres of the front sheet and of the back
//! one. With `s` the spacing and `z` the eye depth of a centre, the spheres whose box, grown by what
//! 0.35 s are there beyond four pixels, touches a cell of 8x8 pixels mark the slices of `s / 2` from
//! the nearest of them on that lie in `z - 0.75 s .. z + 0.75 s`, 256 slices in all (what lies farther
//! is in the last). Unmarked slices with marked ones behind them are air; the first five are kept.
//! Cells without air borrow that of the first that has any of those at the left, right, above, below
//! and on the diagonals. Spheres of less than 0.6 drawn radii mark nothing.
//!
//! A texel goes by the nearest depth of its pixels and by the cells round it, with bilinear weights.
//! Of each cell it takes the first air whose middle lies behind that depth, and of those the one that
//! begins first, with all that overlap it. They count for `w / (2 (f - s))`, at most 1, each, with `w`
//! their width and `f` the falloff, times 0.05 to 1 for water behind them of three to six slices;
//! borrowed ones for nothing. If that is half or more in all, these are chosen; otherwise the same is
//! asked of what begins behind the first, and what counts for most is chosen. Without any air behind
//! the surface it is the last before it. The boundary is the weighted mean of their middles, or of two
//! spacings behind where they begin, kept half a spacing inside of what they have in common.

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
/// Slices of a cell.
pub const SLICES: usize = 256;
/// Edge of a tile in texels of the smoothing.
pub const TILE: usize = 16;

/// How far the box of a projection is grown, in pixels.
pub const GROWN: f64 = 1.0 / 64.0;
/// Depth from a centre that its sphere marks, in spacings.
const REACH: f64 = 0.75;
/// What a sphere counts for beside its box, in spacings, less half a cell.
const BESIDE: f64 = 0.35;
/// A slice, in spacings.
const SLICE: f64 = 0.5;
/// Spheres smaller than this, in spacings, are drops: 0.6 of the drawn radius.
const DROP: f64 = 0.6 * 0.656;
/// Airs of a cell.
const AIRS: usize = 5;
/// Marked slices of a drop, and of a body.
const BODY: [f64; 2] = [3.0, 6.0];
/// What air before a drop counts for.
const LEAST: f64 = 0.05;
/// What airs count for that are chosen.
const CHOSEN: f64 = 0.5;
/// The boundary lies no farther than so many spacings behind the water before it.
const BEYOND: f64 = 2.0;
/// Half the depth in which the share of the sheets goes over, in spacings.
const SOFT: f64 = 0.5;
/// Water so near to the boundary fills the window between the sheets, and so far none of it.
const WINDOW: [f64; 2] = [0.5, 1.0];
/// Where there is one sheet the window holds so many times the water.
pub const ONE_SHEET: f64 = 1e6;
/// Nearer than this, in radii, a projection has no bounds.
const UNBOUNDED: f64 = 1.01;

/// Columns and rows of pixels or cells.
pub type Part = (Range<usize>, Range<usize>);
