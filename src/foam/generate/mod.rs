//! Diffuse particles of a fluid that has none: spray, foam and bubbles by where the water traps air, where its waves
//! break and how fast it is (Ihmsen, Akinci, Akinci, Teschner, Unified spray, foam and bubbles for particle-based
//! fluids, 2012).
//!
//! A step finds the fluid's neighbours by a hashed grid, moves the diffuse particles on, and adds new ones. What they
//! are made of is summed in whole steps, places are given by prefix sums and random numbers belong to ids: a
//! sequence gives the same particles in every run, and however it is cut into jobs
//! ([`Generator::record_save`]). Only where more than 256 of the fluid share a bucket of the grid, thirty times what
//! water has in a cell, does it depend on the device which of them are looked at. Of a single frame a snapshot
//! ([`Generator::record_snapshot`]) has what a steady flow like it would have left: by the water that each particle of the
//! fluid comes from.
//! Reads: the fluid's positions, velocities and ids. Writes: diffuse particles, potentials.

mod passes;
pub mod settings;

use std::sync::Arc;

use ash::vk;

use crate::check;
use crate::context::Context;
use crate::contract::{Count, DiffuseParticles, GenerateStep, Slot, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::COMPUTE_READ;
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Descriptors;
use crate::gpu::timing::{Timer, Timing};
use passes::{DRIFT, KIND, PARTICLE, Passes};
pub use settings::{GenerateConfig, GenerateSettings, Limits};

struct GeneratorSlot {
    descriptors: Descriptors,
    timer: Timer,
}

/// Spray, foam and bubbles of one body of water, made of its particles step by step. Views share them.
pub struct Generator {
    gpu: Arc<Gpu>,
    config: GenerateConfig,
    passes: Passes,
    slots: Vec<GeneratorSlot>,
    /// Nothing was recorded yet: the buffers hold anything.
    fresh: bool,
    /// The last step, until it is abandoned: its slot, and whether it was the first.
    last: Option<(Slot, bool)>,
}

impl Generator {
    /// Makes pipelines and memory: 76 to 80 bytes a particle of the fluid, 44 a diffuse one.
    ///
    /// # Errors
    /// Bad configuration, no memory, and what Vulkan reports.
    pub fn new(context: &Context, config: &GenerateConfig) -> Result<Self, Error> {
        config.check()?;
        let gpu = Gpu::new(context);
        let made = Passes::new(&gpu, config).and_then(|passes| {
            let slot = |_| {
                let descriptors = Descriptors::new(&gpu, passes.sets())?;
                Ok(GeneratorSlot { descriptors, timer: Timer::new(&gpu)? })
            };
            let slots = (0..gpu.slots).map(slot).collect::<Result<Vec<_>, Error>>()?;
            Ok((passes, slots))
        });
        match made {
            Ok((passes, slots)) => {
                Ok(Self { gpu, config: *config, passes, slots, fresh: true, last: None })
            }
            Err(error) => {
                // Nothing was submitted with what was made before the failure.
                gpu.destroy();
                Err(error)
            }
        }
    }

    /// Records one step: the diffuse particles move on, and the fluid makes new ones. Never submits, waits or
    /// allocates device memory.
    ///
    /// # Errors
    /// [`Error::BadInput`] with the field, before the first command; after any other error discard the
    /// command buffer and tell with [`abandon`](Self::abandon).
    ///
    /// # Safety
    /// As [`Renderer::record`](crate::Renderer::record); steps are submitted in the order they were
    /// recorded, before the frames that show them.
    pub unsafe fn record_step(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &GenerateStep<'_>,
    ) -> Result<(), Error> {
        self.record_any(cmd, step, false)
    }

    /// Records a snapshot in place of a step: the diffuse particles that there would be if the fluid had moved like this for
    /// as long as foam lives, whatever was before. What each particle's water made is looked for back along the flow, at 15
    /// moments; foam is as old as that is long ago. [`GenerateStep::dt`] is of no effect. Steps may follow.
    ///
    /// # Errors
    /// As [`record_step`](Self::record_step).
    ///
    /// # Safety
    /// As [`record_step`](Self::record_step).
    pub unsafe fn record_snapshot(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &GenerateStep<'_>,
    ) -> Result<(), Error> {
        self.record_any(cmd, step, true)
    }

    fn record_any(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &GenerateStep<'_>,
        snapshot: bool,
    ) -> Result<(), Error> {
        // A step that fails below leaves nothing to take back.
        self.last = None;
        self.check(step)?;
        self.last = Some((step.slot, self.fresh));
        let slot = &mut self.slots[step.slot.0 as usize];
        slot.descriptors.reset(&self.gpu)?;
        self.gpu.begin_label(cmd, c"whitewater/generate");
        slot.timer.reset(&self.gpu, cmd);
        if std::mem::take(&mut self.fresh) && !snapshot {
            self.passes.record_clear(&self.gpu, cmd);
        }
        let (gpu, timer) = (&self.gpu, &mut slot.timer);
        self.passes.record(gpu, cmd, &slot.descriptors, timer, step, snapshot)?;
        self.gpu.end_label(cmd);
        Ok(())
    }

    /// Records that there are no diffuse particles again.
    ///
    /// # Safety
    /// As [`record_step`](Self::record_step).
    pub unsafe fn record_reset(&mut self, cmd: vk::CommandBuffer) {
        self.fresh = false;
        self.passes.record_clear(&self.gpu, cmd);
    }

    /// The diffuse particles after the last step, for [`Frame::diffuse`](crate::Frame::diffuse) of renderers on the
    /// same queue whose [`DiffuseConfig::max_stride`](super::DiffuseConfig) is 16 or more. Their buffers are transfer
    /// sources too.
    pub fn particles(&self) -> DiffuseParticles {
        let buffers = &self.passes.buffers;
        let [particles, drifts, kinds] =
            [(&buffers.particles, PARTICLE), (&buffers.drifts, DRIFT), (&buffers.kinds, KIND)]
                .map(|(own, stride)| self.stream(own, stride));
        DiffuseParticles {
            positions: particles,
            kinds: Some(kinds),
            radii: None,
            ages: Some(Stream { offset: 12, ..particles }),
            ids: Some(Stream { offset: 12, ..drifts }),
            count: Count::Gpu { buffer: buffers.counts.handle, offset: 0 },
            packets: None,
            fluid_depth: None,
            before: COMPUTE_READ,
            after: COMPUTE_READ,
        }
    }

    /// Their velocities (3×f32, scene units per second), in the same order.
    pub fn velocities(&self) -> Stream {
        self.stream(&self.passes.buffers.drifts, DRIFT)
    }

    fn stream(&self, own: &Buffer, stride: u64) -> Stream {
        let size = stride * u64::from(self.config.max_particles);
        Stream { buffer: own.handle, size, offset: 0, stride: stride as u32 }
    }

    /// Of each particle of the last step's fluid, in its order, four `f32`: trapped air, wave crest, energy, number
    /// of neighbours, as [`GenerateSettings`] has them; zeros of particles that take no part. Transfer source.
    pub fn potentials(&self) -> vk::Buffer {
        self.passes.buffers.potentials.handle
    }

    /// Six `u32`: places in the streams of [`particles`](Self::particles) that were ever taken; particles of the last
    /// step's fluid; of them those that take part; free places before the step's new particles; new particles, those
    /// among them that were lost for want of room; all that ever were. Transfer source; as the potentials last
    /// written by a compute shader, then free to be read.
    pub fn counts(&self) -> vk::Buffer {
        self.passes.buffers.counts.handle
    }

    /// Bytes of a saved state.
    pub fn size(&self) -> u64 {
        self.passes.size()
    }

    /// Records a copy of the state after the last step into a buffer of the host's, from which
    /// [`record_restore`](Self::record_restore) brings it back, here or in another run with the same
    /// configuration: a sequence goes on as if it had not been cut.
    ///
    /// # Safety
    /// The buffer has transfer-destination usage and [`size`](Self::size) bytes from `offset` (a multiple of
    /// 4) on, and is ready; else as [`record_step`](Self::record_step).
    pub unsafe fn record_save(&mut self, cmd: vk::CommandBuffer, to: vk::Buffer, offset: u64) {
        if std::mem::take(&mut self.fresh) {
            self.passes.record_clear(&self.gpu, cmd);
        }
        self.passes.record_copy(&self.gpu, cmd, (to, offset), true);
    }

    /// Records a copy of a saved state back.
    ///
    /// # Safety
    /// As [`record_save`](Self::record_save), with transfer-source usage.
    pub unsafe fn record_restore(&mut self, cmd: vk::CommandBuffer, from: vk::Buffer, offset: u64) {
        self.fresh = false;
        self.passes.record_copy(&self.gpu, cmd, (from, offset), false);
    }

    /// Times of the slot's last finished step, as [`Renderer::timings`](crate::Renderer::timings).
    pub fn timings(&mut self, slot: Slot) -> &[Timing] {
        match self.slots.get_mut(slot.0 as usize) {
            Some(own) => own.timer.timings(&self.gpu),
            None => &[],
        }
    }

    /// Says that the step recorded last, with this slot, was thrown away: the state is that before it. Earlier steps
    /// cannot be taken back; [`record_restore`](Self::record_restore) can.
    pub fn abandon(&mut self, slot: Slot) {
        if let Some(own) = self.slots.get_mut(slot.0 as usize) {
            own.timer.abandon();
        }
        if let Some((_, first)) = self.last.take_if(|(last, _)| *last == slot) {
            self.fresh = first;
        }
    }

    /// Bytes of device memory in use.
    pub fn memory(&self) -> u64 {
        self.passes.memory()
    }

    /// Frees everything. A plain drop leaks it, safely.
    ///
    /// # Safety
    /// The GPU is done with all recorded work, or it will never be submitted.
    pub unsafe fn destroy(self) {
        let gpu = self.gpu.clone();
        drop(self);
        gpu.destroy();
    }

    /// Everything that can be wrong with a step.
    fn check(&self, step: &GenerateStep<'_>) -> Result<(), Error> {
        check::step(
            ["GenerateStep.slot", "GenerateStep.dt"],
            step.slot,
            self.slots.len(),
            step.dt,
        )?;
        step.settings.check()?;
        let fields = ["GenerateStep.count", "GenerateStep.count.offset"];
        let most = ("GenerateConfig.max_fluid", self.config.max_fluid);
        let count = check::count(fields, step.count, most, &self.gpu.limits)?;
        let most = ("GenerateConfig.max_stride", self.config.max_stride);
        step.positions.check("GenerateStep.positions", 12, count, most)?;
        step.velocities.check("GenerateStep.velocities", 12, count, most)?;
        if let Some(ids) = &step.ids {
            ids.check("GenerateStep.ids", 4, count, most)?;
        }
        Ok(())
    }
}
