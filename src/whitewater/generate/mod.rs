//! Whitewater emission for a fluid that has none: fast water emits spray, foam and bubbles where it traps air or
//! where its waves break (Ihmsen, Akinci, Akinci, Teschner, Unified spray, foam and bubbles for particle-based
//! fluids, 2012).
//!
//! A step finds the fluid's neighbours with a hashed grid, advances the whitewater particles, and emits new ones.
//! Sums over neighbours are in fixed point, new particles get their slots in the buffers from a prefix sum, and
//! random numbers depend on ids. A sequence therefore gives the same particles in every run, also if a run continues
//! from a saved state ([`Generator::record_save`]). There is one exception: if more than 256 fluid particles share a
//! bucket of the grid, thirty times as many as water has in a cell, their order on the device decides which of them
//! are visited. For a single frame, a snapshot ([`Generator::record_snapshot`]) gives the whitewater that a steady
//! flow would have left, by tracing each fluid particle back along the flow.
//! Reads: the fluid's positions, velocities and ids. Writes: whitewater particles, potentials.

mod passes;
pub mod settings;

use std::sync::Arc;

use ash::vk;

use crate::check;
use crate::context::Context;
use crate::contract::{Count, GeneratorStep, Slot, Stream, WhitewaterParticles};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::access::COMPUTE_READ;
use crate::gpu::buffer::Buffer;
use crate::gpu::descriptors::Descriptors;
use crate::gpu::timing::{Timer, Timing};
use passes::{DRIFT, KIND, PARTICLE, Passes};
pub use settings::{GeneratorConfig, GeneratorSettings, PotentialRange};

struct GeneratorSlot {
    descriptors: Descriptors,
    timer: Timer,
}

/// Emits whitewater from the particles of one body of water, and moves and ages it, step by step. Several views of
/// the water can share one generator.
pub struct Generator {
    gpu: Arc<Gpu>,
    config: GeneratorConfig,
    passes: Passes,
    slots: Vec<GeneratorSlot>,
    /// Whether the buffers may still be undefined: neither a step nor a restoration was recorded.
    fresh: bool,
    /// Slot of the step recorded last, and the value of `fresh` before it, which `abandon` brings back. `None` if there
    /// is no step to take back: none was recorded since the last reset, restoration or `abandon`, or the last one
    /// failed.
    last: Option<(Slot, bool)>,
}

impl Generator {
    /// Creates pipelines and allocates memory: 76 to 80 bytes per fluid particle, 44 per whitewater particle.
    /// The generator starts without whitewater; the first step needs no [`record_reset`](Self::record_reset).
    ///
    /// # Errors
    /// Bad configuration; no memory; Vulkan errors.
    pub fn new(context: &Context, config: &GeneratorConfig) -> Result<Self, Error> {
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
                // Nothing was submitted with the objects created before the failure.
                gpu.destroy();
                Err(error)
            }
        }
    }

    /// Records one step: whitewater particles advance, and the fluid emits new ones. It never submits, waits or
    /// allocates device memory.
    ///
    /// # Errors
    /// [`Error::BadInput`], which names the field of `step`, before the first command is recorded. After any other
    /// error, discard the command buffer and call [`abandon`](Self::abandon).
    ///
    /// # Safety
    /// The conditions of [`Renderer::record`](crate::Renderer::record) hold. Steps are submitted in the order in
    /// which they were recorded, before the frames that show them.
    pub unsafe fn record_step(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &GeneratorStep<'_>,
    ) -> Result<(), Error> {
        self.record_any(cmd, step, false)
    }

    /// Records a snapshot instead of a step: the whitewater of a steady state, as if the fluid had always moved as it
    /// does now. It replaces the whitewater of earlier steps. Each fluid particle is traced back along the flow to 15
    /// moments within the longest lifetime; foam emitted at a moment has the age since then. [`GeneratorStep::dt`]
    /// has no effect. Steps may follow.
    ///
    /// # Errors
    /// The errors of [`record_step`](Self::record_step).
    ///
    /// # Safety
    /// As [`record_step`](Self::record_step).
    pub unsafe fn record_snapshot(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &GeneratorStep<'_>,
    ) -> Result<(), Error> {
        self.record_any(cmd, step, true)
    }

    fn record_any(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &GeneratorStep<'_>,
        snapshot: bool,
    ) -> Result<(), Error> {
        // Earlier work of the slot is complete, so it cannot be taken back. A step in another slot still can, if this
        // one is refused.
        self.last.take_if(|(slot, _)| *slot == step.slot);
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

    /// Records a reset to no whitewater particles.
    ///
    /// # Safety
    /// The conditions of [`record_step`](Self::record_step) hold.
    pub unsafe fn record_reset(&mut self, cmd: vk::CommandBuffer) {
        self.last = None;
        self.passes.record_clear(&self.gpu, cmd);
    }

    /// The whitewater particles after the last step, for [`Frame::whitewater`](crate::Frame::whitewater) of renderers
    /// on the same queue whose [`WhitewaterConfig::max_stride`](super::WhitewaterConfig) is at least 16. Their
    /// buffers also have transfer-source usage.
    pub fn particles(&self) -> WhitewaterParticles {
        let buffers = &self.passes.buffers;
        let [particles, drifts, kinds] =
            [(&buffers.particles, PARTICLE), (&buffers.drifts, DRIFT), (&buffers.kinds, KIND)]
                .map(|(own, stride)| self.stream(own, stride));
        WhitewaterParticles {
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

    /// Velocities of these particles (3×f32, scene units per second), in the same order.
    pub fn velocities(&self) -> Stream {
        self.stream(&self.passes.buffers.drifts, DRIFT)
    }

    fn stream(&self, own: &Buffer, stride: u64) -> Stream {
        let size = stride * u64::from(self.config.max_particles);
        Stream { buffer: own.handle, size, offset: 0, stride: stride as u32 }
    }

    /// Four `f32` for each fluid particle of the last step, in the order of the particles in that step's input: the
    /// potentials of trapped air, wave crest and energy, in the units of [`GeneratorSettings`], and the number of
    /// neighbours. All four are 0 for a particle with a non-finite or huge position or velocity (10¹⁸, or a position
    /// of 2³¹ spacings). The buffer has transfer-source usage.
    pub fn potentials(&self) -> vk::Buffer {
        self.passes.buffers.potentials.handle
    }

    /// Six `u32`. The first is the number of slots in the streams of [`particles`](Self::particles) that have been
    /// used. The next four are for the last step: its fluid particles; those of them with valid position and
    /// velocity; slots that were free before its emission, among the used ones; particles that it emitted, including
    /// those that found no slot. The sixth is the number of particles that found no slot, in all steps. The first and
    /// the sixth count from the last [`record_reset`](Self::record_reset) or
    /// [`record_snapshot`](Self::record_snapshot) on; [`record_restore`](Self::record_restore) brings back the saved
    /// ones. The buffer has transfer-source usage. A compute shader writes it, as it does the potentials; after a
    /// step, compute shaders and copies may read both.
    pub fn counts(&self) -> vk::Buffer {
        self.passes.buffers.counts.handle
    }

    /// Bytes of a saved state.
    pub fn size(&self) -> u64 {
        self.passes.size()
    }

    /// Records a copy of the state after the last recorded step into `to`, a buffer that the host owns. After
    /// [`record_restore`](Self::record_restore), in this run or in another one with the same configuration, the
    /// sequence continues from this state as if it had not been interrupted.
    ///
    /// # Safety
    /// The buffer `to` has transfer-destination usage and [`size`](Self::size) bytes from `offset` (a multiple of 4)
    /// on, and no pending access (a barrier before this copy suffices). The conditions of
    /// [`record_step`](Self::record_step) hold, too.
    pub unsafe fn record_save(&mut self, cmd: vk::CommandBuffer, to: vk::Buffer, offset: u64) {
        // `fresh` stays, so that the next step clears the state even if `cmd` is discarded.
        if self.fresh {
            self.passes.record_clear(&self.gpu, cmd);
        }
        self.passes.record_copy(&self.gpu, cmd, (to, offset), true);
    }

    /// Records a copy into the generator from `from`, a buffer that the host owns and in which
    /// [`record_save`](Self::record_save) has saved a state.
    ///
    /// # Safety
    /// The buffer `from` has transfer-source usage and [`size`](Self::size) bytes from `offset` (a multiple of 4) on,
    /// and no pending writes (a barrier before this copy suffices). The conditions of
    /// [`record_step`](Self::record_step) hold, too.
    pub unsafe fn record_restore(&mut self, cmd: vk::CommandBuffer, from: vk::Buffer, offset: u64) {
        // A step before is no longer one to take back.
        (self.fresh, self.last) = (false, None);
        self.passes.record_copy(&self.gpu, cmd, (from, offset), false);
    }

    /// Times of the slot's last finished step, in the form of [`Renderer::timings`](crate::Renderer::timings).
    pub fn timings(&mut self, slot: Slot) -> &[Timing] {
        match self.slots.get_mut(slot.0 as usize) {
            Some(own) => own.timer.timings(&self.gpu),
            None => &[],
        }
    }

    /// Takes back the last recorded step, if it was recorded with this slot: the state is again what it was before
    /// that step. Otherwise the state stays. Call it if the step's command buffer was discarded instead of submitted.
    /// Earlier steps cannot be taken back, except by [`record_restore`](Self::record_restore).
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

    /// Frees everything. A plain drop is safe, but leaks.
    ///
    /// # Safety
    /// All recorded work is complete, or will never be submitted.
    pub unsafe fn destroy(self) {
        let gpu = self.gpu.clone();
        drop(self);
        gpu.destroy();
    }

    /// Checks the values of a step.
    fn check(&self, step: &GeneratorStep<'_>) -> Result<(), Error> {
        check::step(
            ["GeneratorStep.slot", "GeneratorStep.dt"],
            step.slot,
            self.slots.len(),
            step.dt,
        )?;
        step.settings.check()?;
        let fields = ["GeneratorStep.count", "GeneratorStep.count.offset"];
        let most = ("GeneratorConfig.max_fluid", self.config.max_fluid);
        let count = check::count(fields, step.count, most, &self.gpu.limits)?;
        let most = ("GeneratorConfig.max_stride", self.config.max_stride);
        step.positions.check("GeneratorStep.positions", 12, count, most)?;
        step.velocities.check("GeneratorStep.velocities", 12, count, most)?;
        if let Some(ids) = &step.ids {
            ids.check("GeneratorStep.ids", 4, count, most)?;
        }
        Ok(())
    }
}
