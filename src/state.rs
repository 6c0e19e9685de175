//! State of the surface foam on a body of water, which outlives a frame and is shared by all views.

use std::sync::Arc;

use ash::vk;

use crate::check;
use crate::context::Context;
use crate::contract::{Slot, Stream, SurfaceFoamStep};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::descriptors::Descriptors;
use crate::gpu::timing::{Timer, Timing};
use crate::water::Classify;

crate::contract::with!(SurfaceFoamStateConfig);

/// Configuration of a [`SurfaceFoamState`]. It determines how much memory is allocated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SurfaceFoamStateConfig {
    /// Maximum number of particles per step.
    pub max_particles: u32,
    /// Maximum stride of the streams in bytes, a multiple of 4 (default 16).
    pub max_stride: u32,
}

impl SurfaceFoamStateConfig {
    /// The defaults for a number of particles.
    pub fn new(max_particles: u32) -> Self {
        Self { max_particles, max_stride: 16 }
    }
}

struct StateSlot {
    descriptors: Descriptors,
    timer: Timer,
}

/// State of the surface foam on one body of water: for each particle id its phase, which is water, foam, or the
/// transition from one to the other. All views share the state. It is advanced once per simulation step
/// ([`record_step`](Self::record_step)), not once per frame or view.
pub struct SurfaceFoamState {
    gpu: Arc<Gpu>,
    config: SurfaceFoamStateConfig,
    classify: Classify,
    slots: Vec<StateSlot>,
    /// Whether the odd table holds the state.
    odd: bool,
    /// Whether the tables may still be undefined: neither a step nor a restoration was recorded.
    fresh: bool,
    /// Slot of the step recorded last, and the value of `fresh` before it, which `abandon` brings back. `None` if there
    /// is no step to take back: none was recorded since the last reset, restoration or `abandon`, or the last one
    /// failed.
    last: Option<(Slot, bool)>,
}

impl SurfaceFoamState {
    /// Creates the pipelines of the foam simulation and allocates its memory: per particle 60 bytes for the two
    /// tables of phases (water, foam or a transition), and 8 more for foam amount and age. It starts without foam;
    /// the first step needs no [`record_reset`](Self::record_reset).
    ///
    /// # Errors
    /// Bad configuration; no memory; Vulkan errors.
    pub fn new(context: &Context, config: &SurfaceFoamStateConfig) -> Result<Self, Error> {
        if config.max_particles == 0 {
            return Err(Error::bad(
                "SurfaceFoamStateConfig.max_particles",
                "zero; it sizes the buffers",
            ));
        }
        if config.max_stride < 4 || !config.max_stride.is_multiple_of(4) {
            let why = format!("{} is not a multiple of 4", config.max_stride);
            return Err(Error::bad("SurfaceFoamStateConfig.max_stride", why));
        }
        let gpu = Gpu::new(context);
        let made = Classify::new(&gpu, config.max_particles, config.max_stride).and_then(|c| {
            let slot = |_| {
                let descriptors = Descriptors::new(&gpu, c.sets())?;
                Ok(StateSlot { descriptors, timer: Timer::new(&gpu)? })
            };
            let slots = (0..gpu.slots).map(slot).collect::<Result<Vec<_>, Error>>()?;
            Ok((c, slots))
        });
        match made {
            Ok((classify, slots)) => Ok(Self {
                gpu,
                config: *config,
                classify,
                slots,
                odd: false,
                fresh: true,
                last: None,
            }),
            Err(error) => {
                // Nothing was submitted with the objects created before the failure.
                gpu.destroy();
                Err(error)
            }
        }
    }

    /// Records one step of the surface foam's simulation. It never submits, waits or allocates device memory.
    ///
    /// # Errors
    /// `record_step` returns [`Error::BadInput`] with the field before it records a command; after any other error
    /// discard the command buffer and call [`abandon`](Self::abandon).
    ///
    /// # Safety
    /// The conditions of [`Renderer::record`](crate::Renderer::record) hold. Foam steps are submitted in the order
    /// they were recorded, before the frames that show them.
    pub unsafe fn record_step(
        &mut self,
        cmd: vk::CommandBuffer,
        step: &SurfaceFoamStep<'_>,
    ) -> Result<(), Error> {
        // Earlier work of the slot is complete, so it cannot be taken back. A step in another slot still can, if this
        // one is refused.
        self.last.take_if(|(slot, _)| *slot == step.slot);
        self.check(step)?;
        // If the step fails below, `abandon` has nothing to revert.
        self.last = None;
        let slot = &mut self.slots[step.slot.0 as usize];
        slot.descriptors.reset(&self.gpu)?;
        self.gpu.begin_label(cmd, c"whitewater/step");
        slot.timer.reset(&self.gpu, cmd);
        if self.fresh {
            self.classify.record_clear(&self.gpu, cmd, self.odd);
        }
        let (gpu, timer) = (&self.gpu, &mut slot.timer);
        self.classify.record(gpu, cmd, &slot.descriptors, timer, step, self.odd)?;
        self.gpu.end_label(cmd);
        self.odd = !self.odd;
        self.last = Some((step.slot, std::mem::take(&mut self.fresh)));
        Ok(())
    }

    /// Records a reset of the foam: all particles are water again. [`abandon`](Self::abandon) cannot revert steps
    /// before it.
    ///
    /// # Safety
    /// Those of [`record_step`](Self::record_step).
    pub unsafe fn record_reset(&mut self, cmd: vk::CommandBuffer) {
        self.last = None;
        self.classify.record_clear(&self.gpu, cmd, self.odd);
    }

    /// Bytes of a saved state.
    pub fn size(&self) -> u64 {
        self.classify.size()
    }

    /// Records a copy of the state after the last step into a buffer of the host.
    /// [`record_restore`](Self::record_restore) restores it, here or in another run with the same
    /// configuration, and the sequence continues as if it had not been interrupted.
    ///
    /// # Safety
    /// The buffer has transfer-destination usage, at least [`size`](Self::size) bytes after `offset` (a multiple of
    /// 4), and no pending access. The conditions of [`record_step`](Self::record_step) hold too.
    pub unsafe fn record_save(&mut self, cmd: vk::CommandBuffer, to: vk::Buffer, offset: u64) {
        // `fresh` stays, so that the next step clears the state even if `cmd` is discarded.
        if self.fresh {
            self.classify.record_clear(&self.gpu, cmd, self.odd);
        }
        self.classify.record_copy(&self.gpu, cmd, self.odd, (to, offset), true);
    }

    /// Records the restoration of a saved state of the foam. [`abandon`](Self::abandon) cannot revert steps before
    /// it.
    ///
    /// # Safety
    /// Those of [`record_save`](Self::record_save), with transfer-source usage.
    pub unsafe fn record_restore(&mut self, cmd: vk::CommandBuffer, from: vk::Buffer, offset: u64) {
        (self.fresh, self.last) = (false, None);
        self.classify.record_copy(&self.gpu, cmd, self.odd, (from, offset), false);
    }

    /// Foam amount (0 to 1) and age (seconds), two `f32` for each particle, in the order of the particles in the last
    /// step: the input [`Particles::surface_foam`](crate::Particles::surface_foam). A step leaves this buffer ready
    /// for reads by compute shaders, vertex shaders and copies, and the next step waits for reads recorded before it,
    /// so [`Particles::before`](crate::Particles::before) and `after` need not cover it. The buffer stays the same
    /// during the life of the state.
    pub fn foam(&self) -> Stream {
        let buffer = &self.classify.foam;
        let size = 8 * u64::from(self.config.max_particles);
        Stream { buffer: buffer.handle, size, offset: 0, stride: 8 }
    }

    /// Times of the slot's last finished step, in the form of [`Renderer::timings`](crate::Renderer::timings).
    pub fn timings(&mut self, slot: Slot) -> &[Timing] {
        match self.slots.get_mut(slot.0 as usize) {
            Some(state) => state.timer.timings(&self.gpu),
            None => &[],
        }
    }

    /// Takes back the last recorded step, if it was recorded with this slot: the state is again what it was before
    /// that step. Otherwise the state stays. Call it if the step's command buffer was discarded instead of submitted.
    /// Earlier steps cannot be taken back, except by [`record_restore`](Self::record_restore). The call frees
    /// nothing, so it is safe even while GPU work is pending.
    pub fn abandon(&mut self, slot: Slot) {
        if let Some(state) = self.slots.get_mut(slot.0 as usize) {
            state.timer.abandon();
        }
        if let Some((_, first)) = self.last.take_if(|(last, _)| *last == slot) {
            self.odd = !self.odd;
            self.fresh = first;
        }
    }

    /// Bytes of device memory in use.
    pub fn memory(&self) -> u64 {
        self.classify.memory()
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

    /// Validates a step.
    fn check(&self, step: &SurfaceFoamStep<'_>) -> Result<(), Error> {
        check::step(
            ["SurfaceFoamStep.slot", "SurfaceFoamStep.dt"],
            step.slot,
            self.slots.len(),
            step.dt,
        )?;
        step.settings.check()?;
        let fields = ["SurfaceFoamStep.count", "SurfaceFoamStep.count.offset"];
        let most = ("SurfaceFoamStateConfig.max_particles", self.config.max_particles);
        let count = check::count(fields, step.count, most, &self.gpu.limits)?;
        let stream = |field, stream: &Stream, bytes| {
            stream.check(
                field,
                bytes,
                count,
                ("SurfaceFoamStateConfig.max_stride", self.config.max_stride),
            )
        };
        stream("SurfaceFoamStep.velocities", &step.velocities, 12)?;
        if let Some(densities) = &step.densities {
            stream("SurfaceFoamStep.densities", densities, 4)?;
        }
        if let Some(ids) = &step.ids {
            stream("SurfaceFoamStep.ids", ids, 4)?;
        }
        Ok(())
    }
}
