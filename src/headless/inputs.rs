//! The particles of a frame, and the foam that a step makes of their motion.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;

use super::Headless;
use crate::contract::{Access, Count, DiffuseParticles, Particles, Slot, Step, Stream};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::gpu::buffer::Buffer;
use crate::gpu::graveyard::Destroy;
use crate::state::{State, StateConfig};
use crate::water::settings::FoamSettings;

/// What the foam of the particles goes by.
pub(super) struct Foaming {
    pub state: State,
    /// By the particles that are here now.
    stepped: bool,
}

/// Diffuse particles of a frame, each attribute as long as `positions`. What they are is said at
/// [`DiffuseParticles`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Diffuse<'a> {
    /// World-space centres.
    pub positions: &'a [[f32; 3]],
    /// 0 foam, 1 spray, 2 bubble.
    pub kinds: Option<&'a [u32]>,
    /// Radii, scene units.
    pub radii: Option<&'a [f32]>,
    /// What of their lives has passed, 0 to 1.
    pub ages: Option<&'a [f32]>,
    /// Numbers that follow them from frame to frame.
    pub ids: Option<&'a [u32]>,
}

/// The same on the device.
pub(super) struct Diffusing {
    count: u32,
    positions: Buffer,
    kinds: Option<Buffer>,
    radii: Option<Buffer>,
    ages: Option<Buffer>,
    ids: Option<Buffer>,
}

impl Diffusing {
    fn new(gpu: &Arc<Gpu>, diffuse: &Diffuse<'_>) -> Result<Self, Error> {
        let count = diffuse.positions.len();
        let lengths = [
            diffuse.kinds.map(<[_]>::len),
            diffuse.radii.map(<[_]>::len),
            diffuse.ages.map(<[_]>::len),
            diffuse.ids.map(<[_]>::len),
        ];
        if lengths.into_iter().flatten().any(|length| length != count) {
            return Err(Error::bad("diffuse", "an attribute is not as long as positions"));
        }
        let some = |name, bytes: Option<&[u8]>| bytes.map(|b| input(gpu, name, b)).transpose();
        Ok(Self {
            count: u32::try_from(count).map_err(|_| Error::bad("diffuse", "more than 2^32"))?,
            positions: input(gpu, "headless/diffuse", bytemuck::cast_slice(diffuse.positions))?,
            kinds: some("headless/diffuse/kinds", diffuse.kinds.map(bytemuck::cast_slice))?,
            radii: some("headless/diffuse/radii", diffuse.radii.map(bytemuck::cast_slice))?,
            ages: some("headless/diffuse/ages", diffuse.ages.map(bytemuck::cast_slice))?,
            ids: some("headless/diffuse/ids", diffuse.ids.map(bytemuck::cast_slice))?,
        })
    }

    pub fn streams(&self) -> DiffuseParticles {
        let words = |buffer: &Option<Buffer>| buffer.as_ref().map(|buffer| stream(buffer, 4));
        DiffuseParticles {
            kinds: words(&self.kinds),
            radii: words(&self.radii),
            ages: words(&self.ages),
            ids: words(&self.ids),
            before: HOST_WRITE,
            after: HOST_WRITE,
            ..DiffuseParticles::new(stream(&self.positions, 12), Count::Cpu(self.count))
        }
    }
}

/// Written by the CPU before the submit.
pub(super) const HOST_WRITE: Access = Access::new(
    vk::PipelineStageFlags2::HOST,
    vk::AccessFlags2::HOST_WRITE,
    vk::ImageLayout::GENERAL,
);

/// A buffer for shaders to read, with its contents.
fn input(gpu: &Arc<Gpu>, name: &str, bytes: &[u8]) -> Result<Buffer, Error> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
    let size = bytes.len().max(16) as u64;
    let mut buffer = Buffer::new(gpu, name, size, usage, MemoryLocation::CpuToGpu)?;
    buffer.mapped_mut()[..bytes.len()].copy_from_slice(bytes);
    Ok(buffer)
}

pub(super) fn stream(buffer: &Buffer, stride: u32) -> Stream {
    Stream { buffer: buffer.handle, size: buffer.size, offset: 0, stride }
}

impl Headless {
    /// Uploads the particles of a frame.
    ///
    /// # Errors
    /// More than [`Config::max_particles`](crate::Config::max_particles), densities of another length,
    /// no memory.
    pub fn particles(
        &mut self,
        positions: &[[f32; 3]],
        densities: Option<&[f32]>,
    ) -> Result<(), Error> {
        if densities.is_some_and(|d| d.len() != positions.len()) {
            return Err(Error::bad("densities", "not as many as positions"));
        }
        if let Some(foam) = &mut self.foam {
            foam.stepped = false;
        }
        self.count = u32::try_from(positions.len())
            .map_err(|_| Error::bad("positions", "more than 2^32"))?;
        let old = [&mut self.positions, &mut self.densities, &mut self.velocities, &mut self.ids];
        for old in old.into_iter().filter_map(Option::take) {
            old.destroy(&self.gpu);
        }
        let make = |name, bytes: &[u8]| input(&self.gpu, name, bytes);
        self.positions = Some(make("headless/positions", bytemuck::cast_slice(positions))?);
        if let Some(densities) = densities {
            self.densities = Some(make("headless/densities", bytemuck::cast_slice(densities))?);
        }
        Ok(())
    }

    /// Uploads how the particles uploaded last move: their velocities, for foam, spray and motion
    /// vectors, and `ids` that follow them from frame to frame, so that the noise in their foam and
    /// their droplets do.
    ///
    /// # Errors
    /// Not as many as positions, no memory.
    pub fn motion(&mut self, velocities: &[[f32; 3]], ids: Option<&[u32]>) -> Result<(), Error> {
        let all = |length: usize| length == self.count as usize;
        if !all(velocities.len()) || ids.is_some_and(|ids| !all(ids.len())) {
            return Err(Error::bad("velocities", "not as many as positions, or as ids"));
        }
        for old in [self.velocities.take(), self.ids.take()].into_iter().flatten() {
            old.destroy(&self.gpu);
        }
        let make = |name, bytes: &[u8]| input(&self.gpu, name, bytes);
        self.velocities = Some(make("headless/velocities", bytemuck::cast_slice(velocities))?);
        if let Some(ids) = ids {
            self.ids = Some(make("headless/ids", bytemuck::cast_slice(ids))?);
        }
        Ok(())
    }

    /// Uploads the diffuse particles of a frame, with [`Config::diffuse`](crate::Config::diffuse); `None`: there
    /// are none.
    ///
    /// # Errors
    /// Attributes of another length, no memory; then there are none.
    pub fn diffuse(&mut self, diffuse: Option<&Diffuse<'_>>) -> Result<(), Error> {
        self.diffuse = None;
        self.hide_generated();
        self.gpu.bury();
        self.diffuse = diffuse.map(|diffuse| Diffusing::new(&self.gpu, diffuse)).transpose()?;
        Ok(())
    }

    /// What of the particles is foam, with [`Config::foam`](crate::Config::foam): a step of a
    /// [`State`] by their [`motion`](Self::motion). `dt`: seconds since the step before; without, or
    /// without ids, a frame stands for itself.
    ///
    /// # Errors
    /// No motion, no memory, and as [`State::record_step`].
    pub fn step(&mut self, dt: Option<f32>, settings: &FoamSettings) -> Result<(), Error> {
        let Some(velocities) = &self.velocities else {
            return Err(Error::bad("velocities", "none uploaded"));
        };
        let velocities = stream(velocities, 12);
        // The last that can fail before the state is put back: dropped, it would leak.
        let mut state = match self.foam.take() {
            Some(old) => old.state,
            None => {
                let config = StateConfig::new(self.renderer.config().max_particles);
                // SAFETY: the device is ours and outlives the state (field order, `finish`).
                unsafe { State::new(&self.device.host(1), &config) }?
            }
        };
        let step = Step {
            slot: Slot(0),
            velocities,
            densities: self.densities.as_ref().map(|buffer| stream(buffer, 4)),
            ids: self.ids.as_ref().filter(|_| dt.is_some()).map(|ids| stream(ids, 4)),
            count: Count::Cpu(self.count),
            dt: dt.unwrap_or(0.0),
            settings,
            before: HOST_WRITE,
            after: HOST_WRITE,
        };
        // SAFETY: cmd is recording outside a render pass; every run waits for its end.
        let result = self.run(|_, cmd| unsafe { state.record_step(cmd, &step) });
        if result.is_err() {
            state.abandon(Slot(0));
        }
        self.foam = Some(Foaming { state, stepped: result.is_ok() });
        result
    }

    /// The particles as a frame takes them.
    pub(super) fn streams(&self) -> Result<Particles, Error> {
        let Some(positions) = &self.positions else {
            return Err(Error::bad("particles", "none uploaded"));
        };
        let foam = self.foam.as_ref().filter(|foam| foam.stepped).map(|foam| Stream {
            buffer: foam.state.foam(),
            size: 8 * u64::from(self.renderer.config().max_particles),
            offset: 0,
            stride: 8,
        });
        Ok(Particles {
            densities: self.densities.as_ref().map(|buffer| stream(buffer, 4)),
            velocities: self.velocities.as_ref().map(|buffer| stream(buffer, 12)),
            ids: self.ids.as_ref().map(|buffer| stream(buffer, 4)),
            foam,
            before: HOST_WRITE,
            after: HOST_WRITE,
            ..Particles::new(stream(positions, 12), Count::Cpu(self.count))
        })
    }
}
