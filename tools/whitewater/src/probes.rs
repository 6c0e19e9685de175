//! What is found from a few frames of a sequence.

use std::ops::Range;

use whitewater::io::particles::sequence::Frame;
use whitewater::io::particles::{self, Particles};

use crate::bounds::{self, Bounds};
use crate::failure::Outcome;
use crate::fluids;
use crate::placing;
use crate::reader::{Has, Reader};
use crate::surface_foam;

/// Frames of a sequence that are looked at: as water comes in and comes to rest, few are like the rest.
const PROBES: usize = 16;

/// A few frames of the whole sequence, from which its look is found: the same however it is cut into jobs.
pub struct Probes {
    pub frames: Vec<Particles>,
    pub numbers: Vec<u64>,
    /// Frames a second by two that follow each other.
    pub fps: Option<f32>,
    /// The number of the first of the sequence.
    pub first: u64,
    /// What any of the files has of its own.
    pub own: Has,
}

/// Pairs of frames that are asked how far they are apart: some may lack what tells it.
const PAIRS: usize = 6;

impl Probes {
    pub fn read(reader: &mut Reader<'_>, all: &[Frame], left: &[Frame]) -> Outcome<Self> {
        let mut picks: Vec<usize> =
            (0..PROBES).map(|i| i * (all.len() - 1) / (PROBES - 1)).collect();
        picks.dedup();
        let (mut frames, mut numbers) = (Vec::new(), Vec::new());
        let mut first_failure = None;
        for pick in picks {
            match reader.read(&all[pick]) {
                Ok(particles) => {
                    frames.push(particles);
                    numbers.push(all[pick].number);
                }
                Err(failure) => _ = first_failure.get_or_insert(failure),
            }
        }
        // All of them are bad: whichever can be read, or the reason why none can.
        if frames.is_empty() {
            let readable = left.iter().find_map(|frame| reader.read(frame).ok());
            match (readable, first_failure) {
                (Some(particles), _) => {
                    frames.push(particles);
                    numbers.push(0);
                }
                (None, Some(failure)) => return Err(failure),
                (None, None) => {}
            }
        }
        let own = reader.seen;
        // Of velocities that are found by it the rate is what they say: as the files have them.
        let apart = |pair: &[Frame]| {
            let [a, b] = pair else { return None };
            let (first, second) = (reader.as_it_is(a).ok()?, reader.as_it_is(b).ok()?);
            let seconds = surface_foam::seconds(&first, &second)?;
            Some((b.number - a.number) as f32 / seconds)
        };
        let middle = (all.len() - 1) / 2;
        let fps = all.windows(2).skip(middle).chain(all.windows(2).take(middle)).take(PAIRS);
        let fps = if own.velocities && own.ids { fps.filter_map(apart).next() } else { None };
        let first = all.first().map_or(0, |f| f.number);
        Ok(Self { frames, numbers, fps, first, own })
    }

    /// What to say of what none of the files of a sequence has, where foam is wanted.
    pub fn missing(&self, files: usize) -> Option<String> {
        let velocities = self.frames.iter().any(|frame| frame.velocities.is_some());
        let Has { velocities: own, ids, .. } = self.own;
        Some(match files {
            1 if !velocities => {
                let ids = if ids { "" } else { " and no ids" };
                format!(
                    "no velocities{ids}: no foam (of a sequence velocities are found, where particles have ids or keep \
                     their order)"
                )
            }
            _ if !velocities && !ids => {
                "no velocities and no ids, and particles do not keep their order: no foam".into()
            }
            _ if !velocities => {
                "no velocities, and ids that tell no particle from frame to frame: no foam".into()
            }
            2.. if own && !ids => {
                "no ids: foam is found anew in each frame (with ids it comes and goes with the particles)".into()
            }
            _ => return None,
        })
    }

    pub fn spacing(&self) -> Option<f32> {
        let each = |f: &Particles| particles::estimate_spacing(&bounds::together(&f.positions));
        self.frames.iter().find_map(each)
    }

    /// A word on what is no likely extent of water.
    pub fn unit_hint(&self) -> Option<String> {
        if let Some(named) = self.frames.iter().find_map(placing::named_hint) {
            return Some(named);
        }
        let extent = self.bounds()?.size().max_element();
        let fastest = self.frames.iter().filter_map(placing::fastest);
        placing::hint(extent, fastest.reduce(f32::max))
    }

    pub fn bounds(&self) -> Option<Bounds> {
        self.frames.iter().filter_map(|f| Bounds::of_bulk(&f.positions)).reduce(|a, b| a.union(&b))
    }

    /// In the unit of the file: 1000 where that fits, else what most of the particles have.
    pub fn rest_density(&self) -> Option<f32> {
        self.rest_density_of((0, 1))
    }

    /// The same of one of so many fluids.
    pub fn rest_density_of(&self, (fluid, count): (usize, usize)) -> Option<f32> {
        let part = |frame: &'_ Particles| {
            let Range { start, end } = fluids::ranges(frame, count).get(fluid)?.clone();
            frame.densities.as_ref()?.get(start as usize..end as usize).map(<[f32]>::to_vec)
        };
        let densities = self.frames.iter().filter_map(part).find(|part| !part.is_empty())?;
        let mut sorted: Vec<f32> =
            densities.iter().copied().filter(|d| d.is_finite() && *d > 0.0).collect();
        sorted.sort_unstable_by(f32::total_cmp);
        let median = *sorted.get(sorted.len() / 2)?;
        let high = *sorted.get(sorted.len() * 9 / 10)?;
        Some(if (600.0..1500.0).contains(&median) { 1000.0 } else { high })
    }
}
