//! In-place exclusive prefix sum (Blelloch, Prefix sums and their applications, 1990), in three dispatches: sums of
//! blocks, prefix sum of the block sums, prefix sum within each block.
//! Reads, writes: the values. Writes: their total, into a word of the buffer of counts.

use crate::gpu::memory::MemoryLocation;
use ash::vk;
use bytemuck::NoUninit;

use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::{COMPUTE_READ_WRITE, buffer};
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::{Descriptors, Resource, bind_set};
use crate::gpu::pipeline::Pipeline;
use crate::gpu::shader;

/// Maximum number of groups per dispatch; their invocations loop over the remaining blocks.
const MOST_GROUPS: u32 = 4096;
/// Values per block (glsl/include/scan.glsl).
const BLOCK: u32 = 1024;

/// Descriptor sets per scan.
pub const SETS: u32 = 3;

#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Push {
    most: u32,
    count: u32,
    total: u32,
}
shader::assert_layout!(shader::GPU_SCAN_SUM_COMP, "Push", Push { most, count, total });

/// The three passes.
pub struct Scan {
    sum: Pipeline,
    blocks: Pipeline,
    apply: Pipeline,
    sums: Buffer,
}

impl Scan {
    /// A scan of up to `most` values.
    pub fn new(gpu: &Gpu, name: &str, most: u32) -> Result<Self, Error> {
        Ok(Self {
            sum: Pipeline::compute(gpu, shader::GPU_SCAN_SUM_COMP, &[])?,
            blocks: Pipeline::compute(gpu, shader::GPU_SCAN_BLOCKS_COMP, &[])?,
            apply: Pipeline::compute(gpu, shader::GPU_SCAN_APPLY_COMP, &[])?,
            sums: Buffer::new(
                gpu,
                name,
                4 * u64::from(most.div_ceil(BLOCK)).max(1),
                vk::BufferUsageFlags::STORAGE_BUFFER,
                MemoryLocation::GpuOnly,
            )?,
        })
    }

    /// Replaces values by their exclusive prefix sum. `count` is the index of the word in `counts` that holds how
    /// many of the `most` values take part, from the first on; with `None` all do. `total` is the index of the word
    /// in `counts` that receives their sum. Both buffers must be in the state in which compute shaders use them, and
    /// are in the same state afterwards.
    pub fn record(
        &self,
        (gpu, cmd, descriptors): (&Gpu, vk::CommandBuffer, &Descriptors),
        counts: &Buffer,
        (values, most): (&Buffer, u32),
        count: Option<u32>,
        total: u32,
    ) -> Result<(), Error> {
        let sets = self.sets(gpu, descriptors, counts, values)?;
        self.record_with((gpu, cmd, sets), counts, (values, most), count, total);
        Ok(())
    }

    /// Descriptor sets for [`record_with`](Self::record_with), for repeated scans of the same values.
    pub fn sets(
        &self,
        gpu: &Gpu,
        descriptors: &Descriptors,
        counts: &Buffer,
        values: &Buffer,
    ) -> Result<[vk::DescriptorSet; SETS as usize], Error> {
        let all = [
            (1, Resource::buffer(counts)),
            (2, Resource::buffer(&self.sums)),
            (3, Resource::buffer(values)),
        ];
        let set = |pipeline| descriptors.set(gpu, pipeline, &all);
        Ok([set(&self.sum)?, set(&self.blocks)?, set(&self.apply)?])
    }

    /// [`record`](Self::record) with sets that were created before for the same buffers.
    pub fn record_with(
        &self,
        (gpu, cmd, sets): (&Gpu, vk::CommandBuffer, [vk::DescriptorSet; SETS as usize]),
        counts: &Buffer,
        (values, most): (&Buffer, u32),
        count: Option<u32>,
        total: u32,
    ) {
        let push = Push { most, count: count.unwrap_or(u32::MAX), total };
        let groups = most.div_ceil(BLOCK).clamp(1, MOST_GROUPS);
        let passes = [(&self.sum, groups), (&self.blocks, 1), (&self.apply, groups)];
        for ((pipeline, groups), set) in passes.into_iter().zip(sets) {
            let both = COMPUTE_READ_WRITE;
            let shared = [counts, values, &self.sums];
            gpu.barriers(cmd, &[], &shared.map(|shared| buffer(shared.handle, both, both)));
            pipeline.bind(gpu, cmd);
            bind_set(gpu, cmd, pipeline, set);
            pipeline.push(gpu, cmd, &push);
            // SAFETY: cmd is recording outside a render pass, pipeline and set are bound.
            unsafe { gpu.device.cmd_dispatch(cmd, groups, 1, 1) };
        }
    }

    pub fn memory(&self) -> u64 {
        self.sums.size
    }
}
