//! In-place exclusive prefix sum.

use whitewater::Error;
use whitewater::headless::Device;

use crate::balls::shader;
use crate::vulkan::{Buffer, Frame, Pass, READ, UPDATE, WRITE};

/// Values per block (glsl/include/scan.glsl).
const BLOCK: u64 = 2048;

/// Exclusive prefix sum (Blelloch 1990).
pub(crate) struct Scan<'d> {
    blocks: Pass<'d>,
    sums: Pass<'d>,
    apply: Pass<'d>,
}

impl<'d> Scan<'d> {
    /// `bricks`: values are marks; each that is not 0 counts as 1.
    pub fn new(device: &'d Device, bricks: bool) -> Result<Self, Error> {
        let constants = [(0, u32::from(bricks))];
        Ok(Self {
            blocks: Pass::new(device, "scan_blocks", shader!("scan_blocks"), 2, &constants)?,
            sums: Pass::new(device, "scan_sums", shader!("scan_sums"), 1, &constants)?,
            apply: Pass::new(device, "scan_apply", shader!("scan_apply"), 2, &constants)?,
        })
    }

    /// Records the sums of `count` values, which shaders have written. The total is stored after the sums of the
    /// blocks.
    pub fn record(
        &self,
        frame: &mut Frame<'_>,
        view: &Buffer<'_>,
        blocks: &Buffer<'_>,
        values: &Buffer<'_>,
        count: u64,
    ) -> Result<(), Error> {
        let groups = [count.div_ceil(BLOCK) as u32, 1];
        let push = [count as u32, 0, 0];
        frame.barrier(&[(values, UPDATE, READ), (blocks, UPDATE, WRITE)]);
        frame.dispatch(&self.blocks, view, &[blocks, values], push, groups)?;
        frame.barrier(&[(blocks, WRITE, UPDATE)]);
        frame.dispatch(&self.sums, view, &[blocks], push, [1, 1])?;
        frame.barrier(&[(blocks, UPDATE, READ), (values, READ, UPDATE)]);
        frame.dispatch(&self.apply, view, &[blocks, values], push, groups)
    }

    /// Bytes of the block sums of `count` values.
    pub fn bytes(count: u64) -> u64 {
        4 * (count.div_ceil(BLOCK) + 1)
    }

    /// Index of the total among the block sums of `count` values.
    pub fn sum_of(count: u64) -> u64 {
        count.div_ceil(BLOCK)
    }
}
