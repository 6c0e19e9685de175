//! The renderer's own buffers after a record, for tests and tools, not for hosts.

#![cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // then nobody reads it

use ash::vk;
use bytemuck::{Pod, Zeroable};

#[cfg(doc)]
use crate::contract::Config;

/// The renderer's own buffers after a record, with the feature `diagnostics`. Their layout follows the shaders.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Diagnostics {
    /// With [`Smoothing::Query`](crate::water::Smoothing): a buffer of this many `u32`, the samples that were still active in iterations
    /// 5, 10, …, for blocks that ran (0 for others; the last block is not counted). Transfer source; last
    /// written by a transfer.
    pub active_samples: Option<(vk::Buffer, u32)>,
    /// Particle statistics.
    pub counts: Option<ParticleCounts>,
    /// Resolutions at which the frame was smoothed.
    pub levels: Option<SmoothingLevels>,
    /// Work of the smoothing: a buffer of 259 records of four `u32`. In record 0 the second word is the number
    /// of 16×16 tiles (of smoothing texels, all levels) that hold water. In record i, 1 to 257, the fourth word
    /// is the number of tiles that iteration i processes. Transfer source; last written by a compute shader,
    /// read as indirect arguments.
    pub tiles: Option<vk::Buffer>,
    /// With [`Config::sheets`] of 2: a buffer of one `f32` per texel of the frame's thickness, row by row: the
    /// eye depth between the two layers, 1e10 where there is only one. Transfer source; last written by a
    /// compute shader, read by compute and fragment shaders.
    pub sheets: Option<vk::Buffer>,
    /// With [`Kernels::Ellipsoids`](crate::water::Kernels): a buffer of 40 bytes per particle. The position where it
    /// is drawn (3×f32, world); the symmetric matrix that maps a sphere of its radius to its ellipsoid, six signed
    /// 16-bit fractions of 4: xx, yy, zz, yz, xz, xy; the same of the ellipsoid of its spray; the sum of its
    /// neighbours' weights (f32; up to 64 in films one layer thick, 64 for particles outside of the grid).
    /// Transfer source; last written and read by compute shaders.
    pub shapes: Option<vk::Buffer>,
    /// With [`Config::bubbles`]: a buffer of this many `u32` per pixel of the frame, row by row. For each
    /// layer, front to back: 256 times the blob's index in the streams plus the bubble's index, or 0xffff_ffff
    /// for none. Then the bits of the maximum opacity (f32). Transfer source; last written and read by compute
    /// shaders.
    pub bubbles: Option<(vk::Buffer, u32)>,
    /// With [`Config::bubbles`]: a buffer of five `u32`, statistics of the blobs: bits of the eye depth at
    /// which the first begins and of that at which the last begins (f32), number on the screen, number of
    /// invalid ones that were ignored (not finite, no radius), and total length of the tile lists
    /// ([`BubbleSort::Tiles`](crate::bubbles::BubbleSort::Tiles)). Transfer source; last written by a compute
    /// shader, read by compute shaders.
    pub blobs: Option<vk::Buffer>,
}

/// Layout of the smoothing levels in the images `water.surface` and `water.iterations`, and the distances at
/// which each is shown.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SmoothingLevels {
    /// Four levels of the front layer, each half the size of the previous, then three of the back layer from
    /// the second level on. Unused ones are zero. A texel of a coarser level is valid near where its level is
    /// shown; around that it is empty (1e10), and farther away it may stem from an earlier frame.
    pub level: [SmoothingLevel; 7],
    /// Size of the images (x, y), tiles per row, number of coarser levels.
    pub atlas: [i32; 4],
    /// Iterations of the first level at depth 1 on the optical axis, divided by a quarter of the cap; squared
    /// aspect of a pixel, width over height; maximum depth difference on one surface, metres; 0.
    pub near: [f32; 4],
}

/// Position of one smoothing level, and its texels.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SmoothingLevel {
    /// First texel (x, y) and size, in texels.
    pub rect: [i32; 4],
    /// Scale and offset from a point of the level (texel centres at +0.5) to the slope of its ray.
    pub slope: [f32; 4],
    /// World size of a texel per depth in x and y; its side length in pixels of the output; 0.
    pub texel: [f32; 4],
}

impl SmoothingLevels {
    /// The front layer's level that is shown at an eye depth, for the slope of its ray, and how far the next
    /// level has faded in, 0 to 1. The back layer shows the same level, but at least the second.
    pub fn shown(&self, depth: f32, slope: [f32; 2]) -> (usize, f32) {
        let [iterations, shape, ..] = self.near;
        let foreshortened = 1.0 + slope[0].powi(2) + (1.0 + slope[1].powi(2)) * shape;
        let doubled = (iterations * foreshortened / (depth * depth)).max(1.0).log2();
        let level = (0.5 * doubled).floor();
        let part = (doubled - 2.0 * level).min(1.0);
        let coarsest = self.atlas[3] as usize;
        match part * part * (3.0 - 2.0 * part) {
            _ if level as usize >= coarsest => (coarsest, 0.0),
            1.0 => (level as usize + 1, 0.0),
            fade => (level as usize, fade),
        }
    }
}

/// Buffers with particle statistics, 256 bytes per chunk. Words 0 and 5 are the number of small and of large
/// sprites, word 18 the particles dropped for non-finite positions, word 19 those classified as spray (0 in
/// `front`). Transfer source; last written by a compute shader, read as indirect arguments.
#[derive(Clone, Copy, Debug)]
pub struct ParticleCounts {
    /// Particles on the screen.
    pub all: vk::Buffer,
    /// Particles that can be visible, from which depth is splatted.
    pub front: vk::Buffer,
    /// Number of chunks.
    pub chunks: u32,
}
