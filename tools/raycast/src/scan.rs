//! In-place exclusive prefix sum.

use whitewater::Error;
use whitewater::headless::Device;

use crate::balls::shader;
use crate::vulkan::{Buffer, Frame, Pass, READ, UPDATE, WRITE};

/// Numbers of a block of a scan (glsl/include/scan.glsl).
const BLOCK: u64 = 2048;

/// Sums of all before each (Blelloch 1990).
pub(crate) struct Scan<'d> {
    blocks: Pass<'d>,
    sums: Pass<'d>,
    apply: Pass<'d>,
}

impl<'d> Scan<'d> {
    /// `bricks`: numbers are marks, which are counted.
    pub fn new(device: &'d Device, bricks: bool) -> Result<Self, Error> {
        let constants = [(0, u32::from(bricks))];
        Ok(Self {
            blocks: Pass::new(device, "scan_blocks", shader!("scan_blocks"), 2, &constants)?,
            sums: Pass::new(device, "scan_sums", shader!("scan_sums"), 1, &constants)?,
            apply: Pass::new(device, "scan_apply", shader!("scan_apply"), 2, &constants)?,
        })
    }

    /// Of so many values, which shaders have written; the sum of all stands in the blocks after the last.
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

    /// Bytes of the blocks of so many values.
    pub fn bytes(count: u64) -> u64 {
        4 * (count.div_ceil(BLOCK) + 1)
    }

    /// Which of the blocks' words is the sum of so many values.
    pub fn sum_of(count: u64) -> u64 {
        count.div_ceil(BLOCK)
    }
}
