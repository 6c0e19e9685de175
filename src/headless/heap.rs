//! Simulation of bubble-foam blobs.

use super::Headless;
use super::inputs::{Bubble, Foamed};
use crate::bubbles::{
    BlobSimulation, BlobSimulationConfig, BlobSimulationSettings, BlobSimulationStep,
    DistanceField, Solid,
};
use crate::contract::{Slot, Stream};
use crate::error::Error;

impl Headless {
    /// Starts a [`BlobSimulation`] with blobs at rest, instead of an earlier one. The frames that follow show the blobs
    /// as [`heap_step`](Self::heap_step) moves them. [`Config::bubbles`](crate::Config::bubbles) needs room for their
    /// number times 2^`max_splits` ([`BlobSimulationConfig::max_splits`]). `field` holds solids that do not move.
    ///
    /// # Errors
    /// Those of [`BlobSimulation::new`] and [`BlobSimulation::record_set`]. After an error there is no simulation.
    pub fn heap(
        &mut self,
        blobs: &[Bubble],
        field: Option<&DistanceField>,
        max_splits: u32,
    ) -> Result<(), Error> {
        self.drop_heap();
        let count = u32::try_from(blobs.len()).unwrap_or(u32::MAX).max(1);
        let config = BlobSimulationConfig { max_splits, ..BlobSimulationConfig::new(count) };
        let mut heap = BlobSimulation::new(&self.context, &config, field)?;
        let staged = match Foamed::new(&self.gpu, blobs) {
            Ok(staged) => staged,
            Err(error) => {
                // SAFETY: nothing was recorded.
                unsafe { heap.destroy() };
                return Err(error);
            }
        };
        let largest = blobs.iter().map(|b| b.ball[3]).filter(|r| r.is_finite());
        let largest = largest.fold(f32::MIN_POSITIVE, f32::max);
        let streams = staged.streams();
        let set = self.run(|_, cmd| {
            // SAFETY: submitted at once, and waited for.
            unsafe { heap.record_set(cmd, Slot(0), &streams, None, largest) }
        });
        if set.is_err() {
            // SAFETY: every run waits for its end.
            unsafe { heap.destroy() };
            return set;
        }
        self.heap = Some(heap);
        Ok(())
    }

    /// Simulates one step and waits for it.
    ///
    /// # Errors
    /// No simulation, and those of [`BlobSimulation::record_step`].
    pub fn heap_step(
        &mut self,
        dt: f32,
        settings: &BlobSimulationSettings,
        solids: &[Solid],
    ) -> Result<(), Error> {
        let Some(mut heap) = self.heap.take() else {
            return Err(Error::bad("heap", "none: call heap first"));
        };
        let step = BlobSimulationStep { slot: Slot(0), dt, settings, solids };
        // SAFETY: submitted at once, and waited for.
        let result = self.run(|_, cmd| unsafe { heap.record_step(cmd, &step) });
        self.heap = Some(heap);
        result
    }

    /// Time of the last step in nanoseconds; `None` before the first.
    pub fn heap_time(&mut self) -> Option<f64> {
        let heap = self.heap.as_mut()?;
        heap.timings(Slot(0)).first().map(|timing| timing.nanoseconds)
    }

    /// The simulated blobs after the last step, in the order of [`heap`](Self::heap), followed by the slots for
    /// blobs that splitting adds. In unused slots the [`ball`](Bubble::ball) is all zeros. The list is empty without a
    /// simulation.
    ///
    /// # Errors
    /// No memory; Vulkan errors.
    pub fn heap_blobs(&mut self) -> Result<Vec<Bubble>, Error> {
        let Some((blobs, count)) = self.heap.as_ref().map(|heap| (heap.blobs(), heap.count()))
        else {
            return Ok(Vec::new());
        };
        if count == 0 {
            return Ok(Vec::new());
        }
        let mut words = |stream: Option<Stream>, each: u64| match stream {
            Some(stream) => self.read_buffer(stream.buffer, each * u64::from(count)),
            None => Ok(vec![0; (each / 4) as usize * count as usize]),
        };
        let (balls, turns) = (words(Some(blobs.spheres), 16)?, words(blobs.rotations, 16)?);
        let ids = words(blobs.ids, 4)?;
        let four = |words: &[u32], i: usize| [0, 1, 2, 3].map(|k| f32::from_bits(words[4 * i + k]));
        let blob = |(i, id): (usize, &u32)| Bubble {
            ball: four(&balls, i),
            turn: four(&turns, i),
            id: *id,
        };
        Ok(ids.iter().enumerate().map(blob).collect())
    }

    pub(super) fn drop_heap(&mut self) {
        if let Some(heap) = self.heap.take() {
            // SAFETY: every run waits for its end.
            unsafe { heap.destroy() };
        }
    }
}
