//! The renderer's own buffers, which tests and tools read after a frame was recorded; hosts do not need them.

#![cfg_attr(not(feature = "diagnostics"), allow(dead_code))] // then nobody reads it

use ash::vk;
use bytemuck::{Pod, Zeroable};

#[cfg(doc)]
use crate::contract::Config;

/// The renderer's own buffers, valid after `record`, with the crate feature `diagnostics`. The shaders define their
/// layout.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Diagnostics {
    /// With [`Smoothing::Query`](crate::water::Smoothing), which runs the smoothing in blocks of five iterations: a
    /// buffer of one `u32` per block, and the number of blocks. Each `u32` is the number of samples that were still
    /// active in the block's last iteration (5, 10, …). It is 0 for a block that was skipped; the last block is not
    /// counted. The buffer has transfer-source usage; a transfer writes it last.
    pub active_samples: Option<(vk::Buffer, u32)>,
    /// Particle statistics.
    pub counts: Option<ParticleCounts>,
    /// Resolutions at which the frame was smoothed.
    pub levels: Option<SmoothingLevels>,
    /// Work of the smoothing: a buffer of 259 rows of four `u32`. In row 0 the second word is the number of tiles, in
    /// all smoothing levels together, that hold water or show foam, spray, whitewater particles or bubble foam; a
    /// tile is 16×16 texels of its level. In row i, 1 to 257, the fourth word is the number of tiles that iteration i
    /// processes. The buffer has transfer-source usage. In `record` a compute shader writes it, and it is then read
    /// as indirect arguments and by compute shaders.
    pub tiles: Option<vk::Buffer>,
    /// With [`Config::sheets`] of 2: a buffer of one `f32` per texel of the frame's thickness image, row by row: the
    /// boundary between the two layers of water, which is an eye depth in the air between them. It is 1e10 where
    /// there is one layer or none. The buffer has transfer-source usage. In `record` a compute shader writes it, and
    /// compute and fragment shaders then read it.
    pub sheets: Option<vk::Buffer>,
    /// With [`Kernels::Ellipsoids`](crate::water::Kernels): a buffer of 40 bytes per particle. These hold the
    /// position where the particle is drawn (3×f32, world); the symmetric matrix that maps a sphere of its radius to
    /// its ellipsoid (xx, yy, zz, yz, xz, xy, each stored as a quarter of its value in a signed normalised 16-bit
    /// number); the matrix of its ellipsoid as spray, in the same form; and the sum of the weights of its neighbours
    /// (f32). In thin sheets of water, one particle thick, the sum is raised towards 64, and for particles outside of
    /// the grid it is
    /// 64. The buffer has transfer-source usage. In `record` compute shaders write it and then read it.
    pub shapes: Option<vk::Buffer>,
    /// With [`Config::bubbles`]: a buffer, and its number of `u32` per pixel of the frame; the pixels follow row by
    /// row. A pixel has one word for each layer of blobs, front to back, and one more. The word of a layer is 256
    /// times the index of the blob in the streams plus the index of the bubble in this blob, or 0xffff_ffff without a
    /// blob. The last word holds the bits of an f32: the greatest opacity of a core among the blobs found at this
    /// pixel. The buffer has transfer-source usage. In `record` compute shaders write it and then read it.
    pub bubbles: Option<(vk::Buffer, u32)>,
    /// With [`Config::bubbles`]: a buffer of five `u32`, statistics of the blobs: least and greatest eye depth at
    /// which a blob begins (the bits of two f32), number of blobs on the screen, number of invalid ones that were
    /// ignored (not finite, no radius), and total length of the tile lists
    /// ([`BubbleSort::Tiles`](crate::bubbles::BubbleSort::Tiles)). The buffer has transfer-source usage. In `record` a
    /// compute shader writes it, and compute shaders then read it.
    pub blobs: Option<vk::Buffer>,
}

/// Layout of the smoothing levels (resolutions) in the images `water.surface` and `water.iterations`, and the
/// distances from the camera at which each is shown.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SmoothingLevels {
    /// Four levels of the front layer of water, each half the resolution of the previous, then three levels of the
    /// back layer, at the second to fourth of these resolutions. Unused levels are zero. A coarser level is computed
    /// only near the pixels that show it. Around these parts its texels are empty (1e10); farther away they may stem
    /// from an earlier frame.
    pub level: [SmoothingLevel; 7],
    /// Size of the images (x, y), tiles per row, number of coarser levels.
    pub atlas: [i32; 4],
    /// Four constants: the square of the smoothing's width in texels of the first level at eye depth 1, divided by a
    /// quarter of ([`Config::max_iterations`] − 2); (width / height of a pixel)², measured in the world; the depth
    /// difference in scene units up to which neighbouring texels belong to one surface; 0.
    pub near: [f32; 4],
}

/// Position of one smoothing level, and its texels.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SmoothingLevel {
    /// First texel (x, y) and size, in texels.
    pub rect: [i32; 4],
    /// Scale (x, y) and offset (z, w) that convert a point of this smoothing level, in texels with centres at +0.5,
    /// to the slope (xy / eye depth) of the view ray through it.
    pub slope: [f32; 4],
    /// Texels of this smoothing level. x, y: size of a texel in the world per unit of eye depth; z: side length of a
    /// texel in pixels of the output; w: 0.
    pub texel: [f32; 4],
}

impl SmoothingLevels {
    /// Returns which level of the front layer is shown for water at an eye depth on a view ray of a slope (0 is the
    /// first level), and how far the next coarser level has faded in, 0 to 1. For the back layer, pass the eye depth
    /// of the boundary between the layers. The back layer has no first level: where the result is the first, it shows
    /// the second, without a fade; otherwise it shows what is returned.
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

/// Buffers with particle statistics, 256 bytes for each chunk (the particles that are processed at a time). Of a
/// chunk's u32 words, word 0 is the number of small sprites, word 5 of large sprites, word 18 of particles dropped for
/// non-finite or huge positions, and word 19 of particles left out because they are only spray; in `front` the last two
/// words are 0. The buffers have transfer-source usage. In `record` a compute shader writes them, and they are then
/// read as indirect arguments and by compute and vertex shaders.
#[derive(Clone, Copy, Debug)]
pub struct ParticleCounts {
    /// Particles on the screen.
    pub all: vk::Buffer,
    /// Particles that can be visible, from which depth is splatted.
    pub front: vk::Buffer,
    /// Number of chunks.
    pub chunks: u32,
}
