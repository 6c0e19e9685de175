//! Whitewater emitted from the fluid's particles.

use super::Headless;
use super::inputs::{HOST_WRITE, input};
use crate::contract::{Count, GeneratorStep, Slot, Stream, WhitewaterParticles};
use crate::error::Error;
use crate::gpu::buffer::Buffer;
use crate::gpu::graveyard::Destroy;
use crate::whitewater::{Generator, GeneratorConfig, GeneratorSettings};

/// The generator and its state.
pub(super) struct Generating {
    pub generator: Generator,
    max_particles: u32,
    /// Whether the next frame shows the emitted particles.
    pub shown: bool,
    /// Number of fluid particles in the last step.
    count: u32,
    /// Places and ages of the particles at another time than that of the last step, if they are drawn there.
    moved: Option<Buffer>,
}

impl Generating {
    /// The particles as the next frame shows them.
    pub fn particles(&self) -> WhitewaterParticles {
        let mut particles = self.generator.particles();
        if let Some(moved) = &self.moved {
            particles.positions.buffer = moved.handle;
            particles.ages = particles.ages.map(|ages| Stream { buffer: moved.handle, ..ages });
        }
        particles
    }
}

/// The live whitewater particles, on the CPU.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Generated {
    /// World-space centres.
    pub positions: Vec<[f32; 3]>,
    /// Velocities, scene units per second.
    pub velocities: Vec<[f32; 3]>,
    /// Kinds: 0 foam, 1 spray, 2 bubble.
    pub kinds: Vec<u32>,
    /// Relative ages, 0 to 1.
    pub ages: Vec<f32>,
    /// Numbers that identify a particle from frame to frame.
    pub ids: Vec<u32>,
    /// Number of particles not emitted for lack of slots, since the start.
    pub lost: u32,
}

impl Headless {
    /// Emits whitewater from the particles uploaded last and their [`motion`](Self::motion): one step of a
    /// [`Generator`]. The frames that follow show the whitewater if [`Config::whitewater`](crate::Config::whitewater)
    /// is set. They fail if it allows only strides below 16 bytes, and lack particles if it allows fewer than
    /// `max_particles`. `dt` is the time since the previous step in seconds, `number` the step's number in the
    /// sequence, `max_particles` the maximum number of whitewater particles alive (a different value restarts the
    /// generator).
    ///
    /// # Errors
    /// No particles or no motion uploaded, no memory, and the errors of [`Generator::record_step`].
    pub fn generate(
        &mut self,
        dt: f32,
        number: u32,
        settings: &GeneratorSettings,
        max_particles: u32,
    ) -> Result<(), Error> {
        self.generate_any(Some(dt), number, settings, max_particles)
    }

    /// Like [`generate`](Self::generate), but from the current frame alone: a [snapshot](Generator::record_snapshot),
    /// which replaces the whitewater of earlier steps.
    ///
    /// # Errors
    /// Those of [`generate`](Self::generate).
    pub fn generate_snapshot(
        &mut self,
        number: u32,
        settings: &GeneratorSettings,
        max_particles: u32,
    ) -> Result<(), Error> {
        self.generate_any(None, number, settings, max_particles)
    }

    /// `dt` is that of a step, `None` for a snapshot.
    fn generate_any(
        &mut self,
        dt: Option<f32>,
        number: u32,
        settings: &GeneratorSettings,
        max_particles: u32,
    ) -> Result<(), Error> {
        let all = self.streams()?;
        let Some(velocities) = all.velocities else {
            return Err(Error::bad("velocities", "none uploaded"));
        };
        let Count::Cpu(count) = all.count else {
            return Err(Error::bad("particles", "not counted by the CPU"));
        };
        if self.generating.as_ref().is_some_and(|g| g.max_particles != max_particles)
            && let Some(old) = self.generating.take()
        {
            // SAFETY: every run waits for its end.
            unsafe { old.generator.destroy() };
        }
        // Creating the generator is the last operation that can return early before it is stored again: if it were
        // dropped, its objects would leak.
        let mut generating = match self.generating.take() {
            Some(old) => old,
            None => {
                let fluid = self.renderer.config().max_particles;
                let config = GeneratorConfig::new(fluid, max_particles);
                let generator = Generator::new(&self.context, &config)?;
                Generating { generator, max_particles, shown: false, count: 0, moved: None }
            }
        };
        let step = GeneratorStep {
            slot: Slot(0),
            positions: all.positions,
            velocities,
            ids: all.ids,
            count: Count::Cpu(count),
            dt: dt.unwrap_or(0.0),
            number,
            settings,
            before: HOST_WRITE,
            after: HOST_WRITE,
        };
        // SAFETY: cmd is recording outside a render pass; every run waits for its end.
        let result = self.run(|_, cmd| unsafe {
            match dt {
                Some(_) => generating.generator.record_step(cmd, &step),
                None => generating.generator.record_snapshot(cmd, &step),
            }
        });
        if result.is_err() {
            generating.generator.abandon(Slot(0));
        }
        if let Some(moved) = generating.moved.take() {
            moved.destroy(&self.gpu);
        }
        generating.shown = result.is_ok();
        generating.count = if result.is_ok() { count } else { 0 };
        self.generating = Some(generating);
        result
    }

    /// Hides the emitted whitewater until the next [`generate`](Self::generate).
    pub fn hide_generated(&mut self) {
        if let Some(generating) = &mut self.generating {
            generating.shown = false;
        }
    }

    /// Lets the next frames show the emitted whitewater `seconds` after the last [`generate`](Self::generate), or
    /// before it if negative: each particle is moved along its velocity. With 0 it is shown where it is. This has no
    /// effect on [`generated`](Self::generated) and on the next step, which ends it.
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn move_generated(&mut self, seconds: f32) -> Result<(), Error> {
        let Some(generating) = self.generating.as_mut() else { return Ok(()) };
        if let Some(old) = generating.moved.take() {
            old.destroy(&self.gpu);
        }
        if seconds == 0.0 {
            return Ok(());
        }
        let places = generating.generator.particles().positions;
        let drifts = generating.generator.velocities();
        let mut moved = self.read_buffer(places.buffer, places.size)?;
        let drifts = self.read_buffer(drifts.buffer, drifts.size)?;
        for (place, drift) in moved.chunks_exact_mut(4).zip(drifts.chunks_exact(4)) {
            for (at, speed) in place.iter_mut().zip(drift).take(3) {
                *at = (f32::from_bits(*at) + seconds * f32::from_bits(*speed)).to_bits();
            }
        }
        let moved = input(&self.gpu, "headless/generated/moved", bytemuck::cast_slice(&moved))?;
        if let Some(generating) = &mut self.generating {
            generating.moved = Some(moved);
        }
        Ok(())
    }

    /// Four values for each fluid particle of the last [`generate`](Self::generate): the potentials of trapped air,
    /// wave crest and energy, in the units of [`GeneratorSettings`], and the number of neighbours. All four are 0 for a
    /// particle with a non-finite or huge position or velocity. The list is empty before the first step and after one
    /// that failed.
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn potentials(&mut self) -> Result<Vec<[f32; 4]>, Error> {
        let Some(generating) = &self.generating else { return Ok(Vec::new()) };
        if generating.count == 0 {
            return Ok(Vec::new());
        }
        let (buffer, count) = (generating.generator.potentials(), generating.count);
        let words = self.read_buffer(buffer, 16 * u64::from(count))?;
        Ok(bytemuck::cast_slice(&words).to_vec())
    }

    /// Number of whitewater particles alive after the last [`generate`](Self::generate), and number of particles that
    /// were never emitted because all `max_particles` slots were taken. The second number is a total over all steps;
    /// a snapshot or another `max_particles` restarts it. Both numbers are 0 while the emitted whitewater is hidden
    /// ([`hide_generated`](Self::hide_generated)).
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn generated_count(&mut self) -> Result<(u32, u32), Error> {
        let Some(generating) = self.generating.as_ref().filter(|made| made.shown) else {
            return Ok((0, 0));
        };
        let counts = generating.generator.counts();
        let counts = self.read_buffer(counts, 24)?;
        let [high, free, made] = [counts[0], counts[3], counts[4]];
        Ok((high - free.saturating_sub(made), counts[5]))
    }

    /// The whitewater particles that are shown after the last [`generate`](Self::generate).
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn generated(&mut self) -> Result<Generated, Error> {
        let Some(generating) = self.generating.as_ref().filter(|made| made.shown) else {
            return Ok(Generated::default());
        };
        let particles = generating.generator.particles();
        let counts = generating.generator.counts();
        let [drifts, kinds] = [particles.ids, particles.kinds].map(|s| s.map(|s| s.buffer));
        let counts = self.read_buffer(counts, 24)?;
        let (high, lost) = (counts[0], counts[5]);
        let mut all = Generated { lost, ..Generated::default() };
        let (Some(drifts), Some(kinds), 1..) = (drifts, kinds, high) else { return Ok(all) };
        let places = self.read_buffer(particles.positions.buffer, 16 * u64::from(high))?;
        let drifts = self.read_buffer(drifts, 16 * u64::from(high))?;
        let kinds = self.read_buffer(kinds, 4 * u64::from(high))?;
        let vector = |words: &[u32]| [words[0], words[1], words[2]].map(f32::from_bits);
        for ((place, drift), kind) in places.chunks_exact(4).zip(drifts.chunks_exact(4)).zip(kinds)
        {
            let age = f32::from_bits(place[3]);
            if age < 1.0 {
                all.positions.push(vector(place));
                all.velocities.push(vector(drift));
                all.kinds.push(kind);
                all.ages.push(age);
                all.ids.push(drift[3]);
            }
        }
        Ok(all)
    }
}
