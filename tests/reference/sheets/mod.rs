//! Twin of the sheets: where one body of water stands before another with air between, each texel of
//! the thickness has a boundary, the eye depth between the centres of the front sheet and of the back
//! one. With `s` the spacing and `z` the eye depth of a centre, the spheres whose box, grown by what
//! 0.35 s are there beyond four pixels, touches a cell of 8x8 pixels mark the slices of `s / 2` from
//! the nearest of them on that lie in `z - 0.75 s .. z + 0.75 s`, 32 slices in all (what lies farther
//! is in the last). Unmarked slices with marked ones behind them are air. The boundary is the middle
//! of the last air before a body, six marked slices or all to the last one, else of the first air. It
//! is spread to the cells round it, and interpolated. Spheres of less than 0.6 drawn radii mark nothing.

mod boundaries;
mod judged;
mod parts;
#[cfg(test)]
mod tests;

use std::ops::Range;

pub use boundaries::{boundaries, boundaries_of, counted, of_texels};
pub use judged::{Known, Slack, judged, judged_texels};
pub use parts::{
    Boundaries, back_depth, boundary_at, made, pixel_of_texel, prune, shares, thickness,
};

/// Edge of a cell in pixels.
pub const CELL: usize = 8;
/// Slices of a cell.
pub const SLICES: usize = 32;
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
/// How many cells away a boundary is handed to.
const NEAR: isize = 1;
/// Marked slices of a body.
const BODY: usize = 6;
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
