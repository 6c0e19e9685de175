//! Properties that are found from a few frames of a sequence.

use std::cell::OnceCell;
use std::ops::Range;

use whitewater::io::particles::Particles;
use whitewater::io::particles::sequence::Frame;

use crate::bounds::{Bounds, Extent};
use crate::failure::Outcome;
use crate::fluids;
use crate::odd::{self, Size};
use crate::placing::{self, Placing};
use crate::reader::{Has, Reader};
use crate::surface_foam;
use crate::tracks::{self, Motion};

/// Number of probed frames. Water that flows in and comes to rest differs from frame to frame, so two or three would
/// not be enough.
const PROBES: usize = 16;

/// At most `PROBES` (16) frames, spread evenly over the whole sequence, from which the look is found. They do not
/// depend on which range of frames a run draws.
pub struct Probes {
    pub frames: Vec<Particles>,
    /// Extents of the frames. They take much of a short run's time, so they are found once.
    extents: OnceCell<Vec<Extent>>,
    pub numbers: Vec<u64>,
    /// Frame numbers per second ([`rate`]).
    pub fps: Option<f32>,
    /// Number of the sequence's first frame.
    pub first: u64,
    /// Attributes that any of the files has itself.
    pub own: Has,
}

/// Number of frame pairs from which the time step is estimated; some may lack the necessary data.
const PAIRS: usize = 6;

/// Frame numbers per second, and how they were found: from velocities, positions and ids if the files have them, and
/// else from the frames' times. (Estimated velocities do not count, because they depend on the rate.)
pub fn rate(reader: &Reader<'_>, all: &[Frame], own: Has) -> Option<(f32, &'static str)> {
    let by_motion = if own.velocities && own.ids { by_motion(reader, all) } else { None };
    by_motion
        .map(|rate| (rate, "from velocities and positions"))
        .or_else(|| by_time(reader, all).map(|rate| (rate, "from the frames' times")))
}

/// Min difference of the times of two frames; numbers with a smaller difference are not taken for seconds.
const LEAST: f32 = 1.0e-4;

/// Frame numbers per second from the times of two neighbouring frames: those that can be read, else those whose times
/// are in a list or in their names, although a file is missing.
pub fn by_time(reader: &Reader<'_>, all: &[Frame]) -> Option<f32> {
    let listed = || {
        let times = |pair: &[Frame]| {
            let [a, b] = pair else { return None };
            let (seconds, numbers) = ((b.time? - a.time?) as f32, b.number.checked_sub(a.number)?);
            let named = a.in_seconds && b.in_seconds;
            let fits = if named { seconds > 0.0 } else { seconds > LEAST && seconds < 1.0 };
            fits.then_some(numbers as f32 / seconds)
        };
        times(all.windows(2).find(|pair| pair.iter().all(|frame| frame.time.is_some()))?)
    };
    reader.rate().or_else(listed)
}

/// Frame numbers per second, from the velocities and positions of two consecutive frames in the middle of the sequence.
fn by_motion(reader: &Reader<'_>, all: &[Frame]) -> Option<f32> {
    let apart = |pair: &[Frame]| {
        let [a, b] = pair else { return None };
        let (first, second) = (reader.as_it_is(a).ok()?, reader.as_it_is(b).ok()?);
        let motion = tracks::motion(&first, &second)?;
        let seconds = match motion {
            Motion::Seconds(seconds) | Motion::Turned(_, seconds) => Some(seconds),
            Motion::Rows => None,
        };
        reader.doubt(motion);
        Some(seconds.map(|seconds| (b.number - a.number) as f32 / seconds))
    };
    let middle = all.len().saturating_sub(1) / 2;
    let pairs = all.windows(2).skip(middle).chain(all.windows(2).take(middle));
    pairs.take(PAIRS).find_map(apart)?
}

/// The median step between frame numbers.
pub fn step_of(all: &[Frame]) -> f32 {
    let apart: Vec<f32> =
        all.windows(2).map(|two| (two[1].number - two[0].number) as f32).collect();
    surface_foam::quantile(apart, 0.5).unwrap_or(1.0).max(1.0)
}

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
        // If no probed frame can be read, use another readable one, or report the first failure.
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
        let mut own = reader.seen;
        let fps = rate(reader, all, own).map(|(rate, _)| rate);
        if reader.drops_ids() {
            own.ids = false;
            frames.iter_mut().for_each(|frame| frame.ids = None);
        }
        let first = all.first().map_or(0, |f| f.number);
        Ok(Self { frames, extents: OnceCell::new(), numbers, fps, first, own })
    }

    /// A message about what missing attributes mean for foam: if no probed frame has velocities (those that were
    /// found from the positions count), or if several files have velocities of their own but no ids. The caller asks
    /// for it only if foam is wanted.
    pub fn missing(&self, files: usize) -> Option<String> {
        let velocities = self.frames.iter().any(|frame| frame.velocities.is_some());
        let Has { velocities: own, ids, .. } = self.own;
        Some(match files {
            1 if !velocities => {
                let ids = if ids { "" } else { " and no ids" };
                format!(
                    "no velocities{ids}: no foam (in a sequence velocities are found if particles have ids or keep \
                     their order)"
                )
            }
            _ if !velocities && !ids => {
                "no velocities and no ids, and particles do not keep their order: no foam".into()
            }
            _ if !velocities => {
                "no velocities, and ids that do not identify particles from frame to frame: no foam".into()
            }
            2.. if own && !ids => {
                "no ids: foam is found for each frame by itself (with ids it forms and decays on the particles)".into()
            }
            _ => return None,
        })
    }

    /// The extent of each frame.
    pub fn extents(&self) -> &[Extent] {
        let all = || self.frames.iter().map(|frame| Extent::of(&frame.positions)).collect();
        self.extents.get_or_init(all)
    }

    /// Places the frames anew.
    pub fn place(&mut self, placing: Placing) {
        self.extents = OnceCell::new();
        self.frames.iter_mut().for_each(|frame| placing.place(frame));
    }

    pub fn spacing(&self) -> Option<f32> {
        self.extents().iter().find_map(|extent| extent.spacing)
    }

    /// A message if the water's extent is implausible.
    pub fn unit_hint(&self) -> Option<String> {
        if let Some(named) = self.frames.iter().find_map(placing::named_hint) {
            return Some(named);
        }
        let extent = self.bounds()?.size().max_element();
        let fastest = self.frames.iter().filter_map(placing::fastest);
        placing::hint(extent, fastest.reduce(f32::max))
    }

    /// The size of the water in a usual frame.
    pub fn usual(&self) -> Option<Size> {
        Size::usual(self.sizes().collect())
    }

    /// A warning about frames in another unit that are not among those `drawn`, but change the view.
    pub fn in_another_unit(&self, drawn: &[Frame]) -> Option<String> {
        let usual = self.usual()?;
        let is_drawn = |size: &Size| drawn.iter().any(|frame| frame.number == size.number);
        let others = self.sizes().filter(|size| !is_drawn(size));
        let spacing = |number: u64| {
            let at = self.numbers.iter().position(|known| *known == number)?;
            whitewater::io::particles::estimate_spacing(&self.frames.get(at)?.positions)
        };
        let told = |size: Size| size.told(&usual, || [size.number, usual.number].map(spacing));
        odd::together(others.filter_map(told))
    }

    fn sizes(&self) -> impl Iterator<Item = Size> {
        let each = self.numbers.iter().zip(&self.frames);
        each.filter_map(|(number, frame)| Size::of(*number, &frame.positions))
    }

    pub fn bounds(&self) -> Option<Bounds> {
        self.extents().iter().filter_map(|extent| extent.bulk).reduce(|a, b| a.union(&b))
    }

    /// Rest density in the unit of the file: 1000 if the median of the densities is near it, otherwise their 0.9
    /// quantile.
    pub fn rest_density(&self) -> Option<f32> {
        self.rest_density_of((0, 1))
    }

    /// Rest density of one of several fluids, from its particles in a probed frame: `fluid` is its index, `count` the
    /// number of fluids.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fluids::Fluids;
    use whitewater::io::particles::sequence;

    /// The list of a sequence tells the frame rate although a file of it is missing.
    #[test]
    fn a_list_tells_the_rate_of_frames_that_are_missing() {
        let folder = tempfile::tempdir().unwrap();
        let set =
            |i: usize| format!("<DataSet timestep=\"{}\" file=\"{i}.csv\"/>", 0.04 * i as f64);
        for i in [0, 2] {
            std::fs::write(folder.path().join(format!("{i}.csv")), "x,y,z\n1,2,3\n").unwrap();
        }
        let list = folder.path().join("a.pvd");
        let sets: String = (0..3).map(set).collect();
        std::fs::write(&list, format!("<VTKFile><Collection>{sets}</Collection></VTKFile>"))
            .unwrap();
        let all = sequence::expand(&[list.display().to_string()], None).unwrap();
        let fluids = Fluids::default();
        let reader = Reader::new(&all, Placing::default(), (&[], &fluids), None);
        assert_eq!(rate(&reader, &all, Has::default()).unwrap().0.round(), 25.0);
        // Step numbers are no times.
        let steps: Vec<Frame> = all
            .iter()
            .map(|frame| Frame { time: Some(frame.number as f64), ..frame.clone() })
            .collect();
        let reader = Reader::new(&steps, Placing::default(), (&[], &fluids), None);
        assert_eq!(rate(&reader, &steps, Has::default()), None);
    }
}
