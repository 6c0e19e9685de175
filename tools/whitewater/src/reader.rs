//! Reads the frames of `render` in drawing order: rotated to y-up, with warnings about unusual data, and with
//! velocities from finite differences if the files have none.

use std::cell::{Cell, OnceCell};
use std::collections::HashMap;

use glam::Vec3;
use whitewater::io::particles::sequence::Frame;
use whitewater::io::particles::{Particles, estimate_spacing};

use crate::args::Up;
use crate::bounds;
use crate::extras::{self, Condition};
use crate::failure::{Failure, Outcome};
use crate::fluids::Fluids;
use crate::odd::Size;
use crate::placing::{self, Placing};
use crate::radii::{self, Split};
use crate::surface_foam::quantile;
use crate::tracks::Motion;

/// Frames per second if no rate can be found.
pub const DEFAULT_FPS: f32 = 30.0;

/// Max displacement of a particle between frames, as a part of the water's size. If it moves farther, another
/// particle is assumed to have taken its id or index.
const FAR: f32 = 0.25;
/// Min difference of the times of two frames, seconds; numbers with a smaller difference are not taken for seconds.
const LEAST: f32 = 1.0e-4;
/// Number of particles from which the water's size is estimated.
const LOOKED_AT: usize = 4096;
/// Max number of frames that are tried one after the other while they cannot be read.
const TRIED: usize = 6;

/// Data of a frame for the velocities of the next one.
struct Known {
    number: u64,
    positions: Vec<[f32; 3]>,
    ids: Option<Vec<u32>>,
}

/// Reads frames of a sequence.
pub struct Reader<'a> {
    all: &'a [Frame],
    placing: Placing,
    /// Origin of the positions: that of `placing` or, if it is 0, that of the first frame read that has particles. An
    /// empty or damaged frame has none.
    origin: OnceCell<[f64; 3]>,
    conditions: &'a [Condition],
    fluids: &'a Fluids,
    /// The attribute that the user named as radii.
    radius: Option<&'a str>,
    /// Whether the attribute that is called only `r` holds radii (`Ok`), or why not (`Err`); determined by the first
    /// frame that was read.
    unsure: OnceCell<Option<Result<(), String>>>,
    /// Min, median and max radius in the first frame that was read.
    pub radii: Option<[f32; 3]>,
    /// How large particles are split; determined by the first frame that was read.
    split: OnceCell<Option<Split>>,
    /// Result of [`Reader::rate`].
    by_time: OnceCell<Option<f32>>,
    /// Frames per second if velocities are estimated, otherwise `None`.
    fps: Option<f32>,
    last: Option<Known>,
    /// Whether any velocities were estimated.
    pub found_velocities: bool,
    /// The attributes (velocities, ids, densities) that some of the probed frames have, at most 16 of the sequence. A
    /// frame that lacks one of them gets a warning.
    pub expected: Has,
    /// Attributes of the frames read so far.
    pub seen: Has,
    /// Size of the water in a usual frame, in metres. A frame in another unit gets a warning.
    pub usual: Option<Size>,
    /// Its spacing, if it was needed.
    usual_spacing: OnceCell<Option<f32>>,
    /// What is wrong with ids or velocities, as the motion between two frames shows.
    doubt: OnceCell<Motion>,
    /// Whether the conditions held for a particle of any frame so far. Until then a frame without one is an error.
    matched: Cell<bool>,
}

impl<'a> Reader<'a> {
    pub fn new(
        all: &'a [Frame],
        placing: Placing,
        (conditions, fluids): (&'a [Condition], &'a Fluids),
        fps: Option<f32>,
    ) -> Self {
        let known = placing.origin != [0.0; 3];
        let origin = if known { OnceCell::from(placing.origin) } else { OnceCell::new() };
        Self {
            all,
            placing,
            origin,
            conditions,
            fluids,
            radius: None,
            unsure: OnceCell::new(),
            radii: None,
            split: OnceCell::new(),
            by_time: OnceCell::new(),
            fps,
            last: None,
            found_velocities: false,
            expected: Has::default(),
            seen: Has::default(),
            usual: None,
            usual_spacing: OnceCell::new(),
            doubt: OnceCell::new(),
            matched: Cell::new(false),
        }
    }

    pub fn read(&mut self, frame: &Frame) -> Outcome<Particles> {
        let mut particles = self.as_it_is(frame)?;
        let far = bounds::count_far(&particles.positions);
        if far > 0 {
            particles.warnings.push(format!(
                "{far} of {} positions are absurdly far from the rest, or from the origin; camera, ground \
                 and light are found without them",
                particles.positions.len()
            ));
        }
        let told = self.in_another_unit(frame.number, &particles.positions);
        particles.warnings.extend(told);
        let own = Has::of(&particles);
        self.seen = self.seen.or(own);
        if self.radii.is_none() {
            self.radii =
                radii::radii(&particles).map(|radii| radii.map(|r| r * self.placing.scale));
        }
        let lacks = self.expected.without(own);
        if let Some(fps) = self.fps
            && (!own.velocities || lacks.ids)
        {
            self.neighbour(frame.number);
            let known = self.last.take();
            // Without the estimated attributes, so that the next frame does not depend on which frames were read
            // before.
            self.last = Some(Known {
                number: frame.number,
                positions: particles.positions.clone(),
                ids: particles.ids.clone(),
            });
            if let Some(known) = known {
                if lacks.ids {
                    particles.ids = ids_by_place(&particles, &known);
                }
                if !own.velocities {
                    let seconds = later(frame.number, known.number) / fps;
                    particles.velocities = velocities(&particles, &known, seconds);
                    self.found_velocities |= particles.velocities.is_some();
                }
            }
        }
        if let Some(names) = lacks.names() {
            let found = Has::of(&particles).without(own).and(lacks).names();
            let found = found.map_or(String::new(), |found| {
                format!("; {found} are found from the particles of the neighbouring frame")
            });
            particles.warnings.push(format!("no {names}, which other frames have{found}"));
        }
        Ok(particles)
    }

    /// Frames per second from the times in the names of two neighbouring files, if they are in seconds; else from the
    /// times stored in these files, or from others in their names, unless those are step numbers. The two are the first
    /// ones that can be read.
    pub fn rate(&self) -> Option<f32> {
        *self.by_time.get_or_init(|| self.find_rate())
    }

    fn find_rate(&self) -> Option<f32> {
        let time = |frame: &Frame| {
            let read = extras::read(frame, self.conditions, self.fluids, self.radius).ok()?;
            Some(read.time.or(frame.time))
        };
        let times = |pair: &[Frame]| {
            let [a, b] = pair else { return None };
            let named = a.in_seconds && b.in_seconds;
            let [first, second] = if named { [a.time, b.time] } else { [time(a)?, time(b)?] };
            Some((first, second, named, later(b.number, a.number)))
        };
        let (first, second, named, numbers) = self.all.windows(2).take(TRIED).find_map(times)?;
        let seconds = (second? - first?) as f32;
        // Step numbers differ by whole numbers, so that without a unit only a part of a second is a time.
        let fits = if named { seconds > 0.0 } else { seconds > LEAST && seconds < 1.0 };
        fits.then_some(numbers / seconds)
    }

    /// The radius that larger particles are split to; `None` if radii are alike.
    pub fn base(&self) -> Option<f32> {
        Some(self.split.get().copied()??.base * self.placing.scale)
    }

    /// Disables radii of the files: all particles are drawn with one radius.
    pub fn alike(&mut self) {
        self.split = OnceCell::from(None);
        self.unsure = OnceCell::from(None);
    }

    /// Takes an attribute with this name as radii.
    pub fn take_radii(&mut self, name: &'a str) {
        self.radius = Some(name);
    }

    /// The name of the radii, if it does not say so itself.
    pub fn radii_name(&self) -> Option<&str> {
        let unsure = matches!(self.unsure.get(), Some(Some(Ok(()))));
        self.radius.or(unsure.then_some(radii::UNSURE))
    }

    /// Sets the up axis for frames that are read from now on; the caller rotates earlier ones.
    pub fn turn(&mut self, up: Up) {
        self.placing.up = up;
        self.last = None;
    }

    /// Origin of the positions of all frames, once one with particles was read; before that 0.
    pub fn origin(&self) -> [f64; 3] {
        self.origin.get().copied().unwrap_or_default()
    }

    /// Sets the rate for estimated velocities, if velocities are estimated.
    pub fn set_rate(&mut self, fps: f32) {
        self.fps = self.fps.map(|_| fps);
    }

    /// A warning about a frame in another unit than the usual one, which is read again to find its spacing.
    fn in_another_unit(&self, number: u64, positions: &[[f32; 3]]) -> Option<String> {
        let usual = self.usual?;
        let of_usual = || {
            let frame = self.all.iter().find(|frame| frame.number == usual.number)?;
            estimate_spacing(&self.as_it_is(frame).ok()?.positions)
        };
        let other = || *self.usual_spacing.get_or_init(of_usual);
        Size::of(number, positions)?.told(&usual, || [estimate_spacing(positions), other()])
    }

    /// Takes note of what the motion between two frames shows. Ids that are only numbers of rows are dropped from frames
    /// that are read from now on.
    pub fn doubt(&self, motion: Motion) {
        let _ = self.doubt.set(motion);
    }

    /// Whether ids are dropped.
    pub fn drops_ids(&self) -> bool {
        self.doubt.get() == Some(&Motion::Rows)
    }

    /// Warning about ids or velocities.
    pub fn doubted(&self) -> Option<String> {
        self.doubt.get().and_then(Motion::warning)
    }

    /// Reads a frame without estimated attributes and without warnings about missing ones.
    pub fn as_it_is(&self, frame: &Frame) -> Outcome<Particles> {
        let mut particles = extras::read(frame, self.conditions, self.fluids, self.radius)?;
        if !particles.positions.is_empty() {
            let _ = self.origin.set(particles.origin);
        }
        match extras::select(&mut particles, self.conditions, &frame.path)? {
            // Probably a wrong value.
            Some(why) if !self.matched.get() => {
                return Err(Failure::input(format!("{}: {why}", frame.path.display())));
            }
            Some(why) => particles.warnings.push(why),
            None if particles.positions.is_empty() => {}
            None => self.matched.set(true),
        }
        let told = extras::told(&particles, self.conditions, self.fluids);
        self.fluids.divide(&mut particles, &frame.path)?;
        let copies = extras::without_copies(&mut particles);
        particles.warnings.extend(told);
        if copies > 0 {
            particles
                .warnings
                .push(format!("{copies} copies of particles at the same place are left out"));
        }
        if let Some(name) = self.radius {
            radii::take(&mut particles, name, &frame.path)?;
        } else if !particles.positions.is_empty()
            && extras::find(&particles, radii::UNSURE).is_some()
        {
            match self.unsure.get_or_init(|| radii::unsure(&particles)) {
                Some(Ok(())) => radii::take(&mut particles, radii::UNSURE, &frame.path)?,
                Some(Err(why)) => particles.warnings.push(radii::unused(why)),
                None => {}
            }
        }
        // A frame without particles says nothing about the radii of the others.
        if !particles.positions.is_empty()
            && let Some(split) = self.split.get_or_init(|| Split::of(&particles))
            && let Some(count) = split.apply(&mut particles)
        {
            particles.warnings.push(format!(
                "radii differ: {count} particles are split into {} of one radius, by volume",
                particles.positions.len()
            ));
        }
        let speeds = placing::agree(&mut particles, self.placing.scale);
        particles.warnings.extend(speeds);
        Placing { origin: self.origin(), ..self.placing }.place(&mut particles);
        if self.drops_ids() {
            particles.ids = None;
        }
        particles.warnings.extend(self.doubted());
        Ok(particles)
    }

    /// Reads into `last` the nearest readable frame before frame `number` or, if there is none, after it. If a frame
    /// cannot be read, the error is reported when it is drawn.
    fn neighbour(&mut self, number: u64) {
        let mut before: Vec<&Frame> = self.all.iter().filter(|f| f.number < number).collect();
        let mut after: Vec<&Frame> = self.all.iter().filter(|f| f.number > number).collect();
        before.sort_by_key(|frame| std::cmp::Reverse(frame.number));
        after.sort_by_key(|frame| frame.number);
        for neighbour in before.into_iter().take(TRIED).chain(after.into_iter().take(TRIED)) {
            let number = neighbour.number;
            if self.last.as_ref().is_some_and(|last| last.number == number) {
                return;
            }
            if let Ok(Particles { positions, ids, .. }) = self.as_it_is(neighbour) {
                self.last = Some(Known { number, positions, ids });
                return;
            }
        }
        self.last = None;
    }
}

/// How much later a frame is than another one, in frame numbers; negative if it is earlier. Only the difference is
/// rounded, because numbers above 2^24 are not exact in 32 bits.
fn later(number: u64, other: u64) -> f32 {
    let apart = number.abs_diff(other) as f32;
    if number < other { -apart } else { apart }
}

/// Attributes that change the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Has {
    pub velocities: bool,
    pub ids: bool,
    pub densities: bool,
}

impl Has {
    pub fn of(particles: &Particles) -> Self {
        Self {
            velocities: particles.velocities.is_some(),
            ids: particles.ids.is_some(),
            densities: particles.densities.is_some(),
        }
    }

    fn zip(self, other: Self, with: fn(bool, bool) -> bool) -> Self {
        Self {
            velocities: with(self.velocities, other.velocities),
            ids: with(self.ids, other.ids),
            densities: with(self.densities, other.densities),
        }
    }

    pub fn or(self, other: Self) -> Self {
        self.zip(other, |a, b| a | b)
    }

    fn and(self, other: Self) -> Self {
        self.zip(other, |a, b| a & b)
    }

    fn without(self, other: Self) -> Self {
        self.zip(other, |a, b| a & !b)
    }

    /// The names in words; `None` if there is none.
    pub fn names(self) -> Option<String> {
        let all =
            [(self.velocities, "velocities"), (self.ids, "ids"), (self.densities, "densities")];
        let names: Vec<_> = all.into_iter().filter(|(has, _)| *has).map(|(_, name)| name).collect();
        let (last, rest) = names.split_last()?;
        Some(if rest.is_empty() {
            (*last).to_string()
        } else {
            format!("{} and {last}", rest.join(", "))
        })
    }
}

/// Ids for the particles of this frame, copied from the neighbouring frame; `None` unless the particles have the same
/// order in both, that is, nearly all particles with the same index have moved little.
fn ids_by_place(now: &Particles, known: &Known) -> Option<Vec<u32>> {
    let ids = known.ids.as_ref().filter(|ids| ids.len() == now.positions.len())?;
    let most = FAR * size(&now.positions)?;
    let near = now.positions.iter().zip(&known.positions);
    let near = near.filter(|(a, b)| Vec3::from(**a).distance(Vec3::from(**b)) <= most).count();
    (10 * near > 9 * ids.len()).then(|| ids.clone())
}

/// Velocities from the positions in this frame and in another one, `seconds` earlier. Particles are matched by id or,
/// if neither frame has ids and the counts are equal, by index. A new particle is at rest. `None` if most particles
/// are new or move implausibly far, which means that the order differs from file to file.
fn velocities(now: &Particles, known: &Known, seconds: f32) -> Option<Vec<[f32; 3]>> {
    let before: Vec<Option<[f32; 3]>> = match (&now.ids, &known.ids) {
        (Some(ids), Some(before)) => {
            let before: HashMap<u32, [f32; 3]> =
                before.iter().copied().zip(known.positions.iter().copied()).collect();
            ids.iter().map(|id| before.get(id).copied()).collect()
        }
        (None, None) if now.positions.len() == known.positions.len() => {
            known.positions.iter().copied().map(Some).collect()
        }
        _ => return None,
    };
    let most = FAR * size(&now.positions)?;
    let moved: Vec<Option<Vec3>> = now
        .positions
        .iter()
        .zip(before)
        .map(|(now, before)| Some(Vec3::from(*now) - Vec3::from(before?)))
        .map(|moved| moved.filter(|moved| moved.length() <= most))
        .collect();
    (2 * moved.iter().flatten().count() > moved.len()).then(|| {
        moved.iter().map(|moved| (moved.unwrap_or_default() / seconds).to_array()).collect()
    })
}

/// Median distance between pairs of particles.
fn size(positions: &[[f32; 3]]) -> Option<f32> {
    let count = positions.len();
    let step = (count / LOOKED_AT).max(1);
    let apart = |i: usize| {
        // The two are chosen far apart in the file, because particles that are close in a file often are close in
        // space.
        let other = (i + count / 2 + i * 7919) % count;
        Vec3::from(positions[i]).distance(Vec3::from(positions[other]))
    };
    let all = (0..count).step_by(step).map(apart).filter(|d| d.is_finite()).collect();
    quantile(all, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block, and the same block before it moved by `moved`.
    fn pair(moved: [f32; 3]) -> (Particles, Known) {
        let at = |i: u32| [i % 10, i / 10 % 10, i / 100].map(|i| 0.1 * i as f32);
        let positions: Vec<_> = (0..1000).map(at).collect();
        let now = positions.iter().map(|p| (Vec3::from(*p) + Vec3::from(moved)).to_array());
        let now = Particles::from_positions(now.collect());
        (now, Known { number: 1, positions, ids: None })
    }

    fn nearly(found: &[[f32; 3]], expected: [f32; 3]) -> bool {
        found.iter().all(|v| Vec3::from(*v).distance(Vec3::from(expected)) < 1.0e-4)
    }

    #[test]
    fn velocities_are_told_by_place_or_by_id() {
        let (mut now, mut known) = pair([0.05, 0.0, -0.02]);
        let found = velocities(&now, &known, 0.1).unwrap();
        assert!(nearly(&found, [0.5, 0.0, -0.2]), "{:?}", found[0]);
        // Against the next frame, time runs backwards.
        assert!(nearly(&velocities(&now, &known, -0.1).unwrap(), [-0.5, 0.0, 0.2]));
        now.ids = Some((0..1000).collect());
        // Only one of the frames has ids.
        assert!(velocities(&now, &known, 0.1).is_none());
        known.positions.reverse();
        known.ids = Some((0..1000).rev().collect());
        assert!(nearly(&velocities(&now, &known, 0.1).unwrap(), [0.5, 0.0, -0.2]));
        // A particle that is new or has jumped is at rest; the others move as before.
        let mut ids: Vec<u32> = (0..1000).rev().collect();
        ids[999] = 1000;
        known.ids = Some(ids);
        known.positions[0] = [90.0; 3];
        let found = velocities(&now, &known, 0.1).unwrap();
        assert_eq!([found[0], found[999]], [[0.0; 3]; 2]);
        assert!(nearly(&found[1..999], [0.5, 0.0, -0.2]));
    }

    /// Frames of these numbers, each with the text of its file; one without a text has no file.
    fn frames(folder: &tempfile::TempDir, files: &[(u64, Option<String>)]) -> Vec<Frame> {
        let of = |(number, text): &(u64, Option<String>)| {
            let path = folder.path().join(format!("f_{number}.csv"));
            text.iter().for_each(|text| std::fs::write(&path, text).unwrap());
            let (number, also) = (*number, Vec::new());
            Frame { number, time: None, in_seconds: false, path, also, step: None }
        };
        files.iter().map(of).collect()
    }

    /// A block of particles, moved along x by so much; each row ends with `more`.
    fn rows(names: &str, moved: f64, more: &str) -> Option<String> {
        let at = |i: u32| [i % 5, i / 5 % 5, i / 25].map(|c| 0.1 * f64::from(c));
        let row = |[x, y, z]: [f64; 3]| format!("{},{y},{z}{more}\n", x + moved);
        Some(format!("{names}\n") + &(0..125).map(at).map(row).collect::<String>())
    }

    /// Differences of large frame numbers are exact, and a frame that cannot be read is passed over.
    #[test]
    fn velocities_are_found_from_the_nearest_frame() {
        let fluids = Fluids::default();
        let large = 1 << 24;
        let file = |moved: f64| rows("x,y,z", moved, "");
        // Velocities of the second and the third frame; a frame without a file has none.
        let (fast, slow) = (Some(0.2), Some(0.1));
        for (files, expected) in [
            (
                [(large + 1, file(0.0)), (large + 2, file(0.01)), (large + 3, file(0.02))],
                [slow, slow],
            ),
            ([(1, file(0.0)), (2, None), (3, file(0.02))], [None, slow]),
            ([(1, None), (3, file(0.0)), (4, file(0.02))], [fast, fast]),
        ] {
            let folder = tempfile::tempdir().unwrap();
            let all = frames(&folder, &files);
            for (frame, expected) in all[1..].iter().zip(expected) {
                let mut reader = Reader::new(&all, Placing::default(), (&[], &fluids), Some(10.0));
                let read = reader.read(frame).ok();
                let found = read.map(|read| read.velocities.unwrap());
                assert_eq!(found.is_some(), expected.is_some(), "{}", frame.number);
                if let (Some(found), Some(x)) = (found, expected) {
                    assert!(nearly(&found, [x, 0.0, 0.0]), "{}: {:?}", frame.number, found[0]);
                }
            }
        }
    }

    /// Without its first frame a sequence has the same rate. Times whose unit is named may be seconds apart.
    #[test]
    fn the_rate_is_that_of_readable_frames() {
        let folder = tempfile::tempdir().unwrap();
        let fluids = Fluids::default();
        let at = |time: &str| rows("x,y,z,time", 0.0, &format!(",{time}"));
        let mut all = frames(&folder, &[(1, None), (2, at("0.04")), (3, at("0.08"))]);
        let rate =
            |all: &[Frame]| Reader::new(all, Placing::default(), (&[], &fluids), None).rate();
        assert!((rate(&all).unwrap() - 25.0).abs() < 1.0e-3, "{:?}", rate(&all));
        for (frame, time) in all.iter_mut().zip([1.0, 3.0, 5.0]) {
            (frame.time, frame.in_seconds) = (Some(time), true);
        }
        assert_eq!(rate(&all), Some(0.5));
        all.iter_mut().for_each(|frame| frame.in_seconds = false);
        std::fs::write(&all[1].path, rows("x,y,z", 0.0, "").unwrap()).unwrap();
        std::fs::write(&all[2].path, rows("x,y,z", 0.0, "").unwrap()).unwrap();
        assert_eq!(rate(&all), None, "numbers without a unit");
    }

    /// An empty first frame decides nothing: neither whether radii differ nor where the water is.
    #[test]
    fn an_empty_frame_decides_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let fluids = Fluids::default();
        let mut full = rows("x,y,z,radius", 1.0e6, ",0.05").unwrap();
        (0..20).for_each(|i| full += &format!("1000002,{i},0,0.1\n"));
        let empty = Some("x,y,z,radius\n".to_string());
        let all = frames(&folder, &[(1, None), (2, empty), (3, Some(full))]);
        let reader = Reader::new(&all, Placing::default(), (&[], &fluids), None);
        assert!(reader.as_it_is(&all[0]).is_err());
        assert!(reader.as_it_is(&all[1]).unwrap().positions.is_empty());
        let read = reader.as_it_is(&all[2]).unwrap();
        assert!(read.warnings.iter().any(|told| told.contains("are split into")));
        assert!(reader.base().is_some() && (reader.origin()[0] - 1.0e6).abs() < 1.0e4);
        let apart = read.positions[1][0] - read.positions[0][0];
        assert!((apart - 0.1).abs() < 1.0e-3, "{apart}");
    }

    /// If no particle matches `--where`, that is an error, unless some did in another frame.
    #[test]
    fn a_frame_without_a_match_is_empty() {
        let folder = tempfile::tempdir().unwrap();
        let fluids = Fluids::default();
        let of = |number: &str| rows("x,y,z,Type", 0.0, &format!(",{number}"));
        let all = frames(&folder, &[(1, of("1")), (2, of("2")), (3, of("1"))]);
        let conditions = [extras::condition("Type=2").unwrap()];
        let reader = Reader::new(&all, Placing::default(), (&conditions, &fluids), None);
        let error = reader.as_it_is(&all[0]).unwrap_err();
        assert!(error.message.contains("f_1.csv: --where 'Type=2'"), "{}", error.message);
        assert_eq!(reader.as_it_is(&all[1]).unwrap().positions.len(), 125);
        let none = reader.as_it_is(&all[2]).unwrap();
        assert!(none.positions.is_empty() && none.warnings[0].contains("found none"));
    }

    #[test]
    fn another_order_has_no_velocities() {
        let (mut now, mut known) = pair([0.01; 3]);
        for i in 0..1000 {
            now.positions.swap(i, (i * 619 + 311) % 1000);
        }
        assert!(velocities(&now, &known, 0.1).is_none());
        known.positions.pop();
        assert!(velocities(&now, &known, 0.1).is_none());
        let none = Particles::from_positions(Vec::new());
        let known = Known { number: 1, positions: Vec::new(), ids: None };
        assert!(velocities(&none, &known, 0.1).is_none());
    }
}
