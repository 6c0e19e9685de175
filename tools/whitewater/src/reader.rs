//! The frames of `render` in drawing order: turned to y-up, with warnings about unusual data, and with
//! velocities from frame to frame where the files have none.

use std::cell::OnceCell;
use std::collections::HashMap;

use glam::Vec3;
use whitewater::io::particles::Particles;
use whitewater::io::particles::sequence::Frame;

use crate::args::Up;
use crate::bounds;
use crate::extras::{self, Condition};
use crate::failure::Outcome;
use crate::fluids::Fluids;
use crate::placing::Placing;
use crate::radii::{self, Split};
use crate::surface_foam::quantile;

/// Frames a second, where that can't be found.
pub const DEFAULT_FPS: f32 = 30.0;

/// A particle that goes farther from frame to frame than this part of what lies between two of them is another one
/// by the same name, or place in the file.
const FAR: f32 = 0.25;
/// Times that are seconds are no nearer each other than this.
const LEAST: f32 = 1.0e-4;
/// Particles that are looked at for that.
const LOOKED_AT: usize = 4096;

/// What the frame after one needs of it.
struct Known {
    number: u64,
    positions: Vec<[f32; 3]>,
    ids: Option<Vec<u32>>,
}

/// Reads frames of a sequence.
pub struct Reader<'a> {
    all: &'a [Frame],
    placing: Placing,
    conditions: &'a [Condition],
    fluids: &'a Fluids,
    /// Radii of particles in the first frame that was read: the least, the middle one, the largest.
    pub radii: Option<[f32; 3]>,
    /// How large particles are split, by the first frame that was read.
    split: OnceCell<Option<Split>>,
    /// Frames a second, where velocities are to be found; else none are.
    fps: Option<f32>,
    last: Option<Known>,
    /// Some were found.
    pub found_velocities: bool,
    /// What frames of the sequence have; one that has not is told of.
    pub expected: Has,
    /// What those have that were read.
    pub seen: Has,
}

impl<'a> Reader<'a> {
    pub fn new(
        all: &'a [Frame],
        placing: Placing,
        (conditions, fluids): (&'a [Condition], &'a Fluids),
        fps: Option<f32>,
    ) -> Self {
        Self {
            all,
            placing,
            conditions,
            fluids,
            radii: None,
            split: OnceCell::new(),
            fps,
            last: None,
            found_velocities: false,
            expected: Has::default(),
            seen: Has::default(),
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
            // As the file has it, so that the frames after are the same however a sequence is cut into jobs.
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
                    let seconds = (frame.number as f32 - known.number as f32) / fps;
                    particles.velocities = velocities(&particles, &known, seconds);
                    self.found_velocities |= particles.velocities.is_some();
                }
            }
        }
        if let Some(names) = lacks.names() {
            let found = Has::of(&particles).without(own).and(lacks).names();
            let found = found.map_or(String::new(), |found| {
                format!("; {found} are found by where particles are in the frame beside it")
            });
            particles.warnings.push(format!("no {names}, which other frames have{found}"));
        }
        Ok(particles)
    }

    /// Frames a second by the times that the first files say, or their names, where these are no numbers of steps.
    pub fn rate(&self) -> Option<f32> {
        let [a, b, ..] = self.all else { return None };
        let [first, second] = [a, b].map(|frame| self.as_it_is(frame).ok()?.time.or(frame.time));
        let seconds = (second? - first?) as f32;
        // Steps are a whole number apart.
        (seconds > LEAST && seconds < 1.0).then(|| (b.number - a.number) as f32 / seconds)
    }

    /// The radius to which larger particles are split; none where all are alike.
    pub fn base(&self) -> Option<f32> {
        Some(self.split.get().copied()??.base * self.placing.scale)
    }

    /// Has particles drawn alike, whatever their radii.
    pub fn alike(&mut self) {
        self.split = OnceCell::from(None);
    }

    /// Has frames turned from now on; those that were read are by whoever has them.
    pub fn turn(&mut self, up: Up) {
        self.placing.up = up;
        self.last = None;
    }

    /// Has velocities found by another rate, where they are found.
    pub fn set_rate(&mut self, fps: f32) {
        self.fps = self.fps.map(|_| fps);
    }

    /// A frame without what is found or told of it.
    pub fn as_it_is(&self, frame: &Frame) -> Outcome<Particles> {
        let mut particles = extras::read(frame, self.conditions, self.fluids)?;
        extras::select(&mut particles, self.conditions, &frame.path)?;
        let told = extras::told(&particles, self.conditions, self.fluids);
        self.fluids.divide(&mut particles, &frame.path)?;
        let copies = extras::without_copies(&mut particles);
        particles.warnings.extend(told);
        if copies > 0 {
            particles
                .warnings
                .push(format!("{copies} copies of particles at the same place are left out"));
        }
        if let Some(split) = self.split.get_or_init(|| Split::of(&particles))
            && let Some(count) = split.apply(&mut particles)
        {
            particles.warnings.push(format!(
                "radii differ: {count} particles are drawn as {}, so many that each fills its part",
                particles.positions.len()
            ));
        }
        self.placing.place(&mut particles);
        Ok(particles)
    }

    /// Has the frame before one, or after the first, as the last that was read. One that can't be read tells when its
    /// turn comes.
    fn neighbour(&mut self, number: u64) {
        let before = self.all.iter().filter(|frame| frame.number < number).max_by_key(|f| f.number);
        let after = self.all.iter().filter(|frame| frame.number > number).min_by_key(|f| f.number);
        let Some(neighbour) = before.or(after) else {
            self.last = None;
            return;
        };
        if self.last.as_ref().is_none_or(|last| last.number != neighbour.number) {
            let known = |Particles { positions, ids, .. }| Known {
                number: neighbour.number,
                positions,
                ids,
            };
            self.last = self.as_it_is(neighbour).ok().map(known);
        }
    }
}

/// What particles have that makes a difference to the picture.
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

    /// In words; none where there is nothing.
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

/// Ids of another frame, where particles are in the same order there: nearly all are nearly where they were.
fn ids_by_place(now: &Particles, known: &Known) -> Option<Vec<u32>> {
    let ids = known.ids.as_ref().filter(|ids| ids.len() == now.positions.len())?;
    let most = FAR * size(&now.positions)?;
    let near = now.positions.iter().zip(&known.positions);
    let near = near.filter(|(a, b)| Vec3::from(**a).distance(Vec3::from(**b)) <= most).count();
    (10 * near > 9 * ids.len()).then(|| ids.clone())
}

/// How fast particles go, by where they are and were so many seconds ago. Told by their ids or, where neither frame has
/// any and both have as many, by their places in the files. What is new is at rest; none where most are, or fly about
/// as only those do whose order is another in each file.
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

/// How far from each other any two particles are, in the middle.
fn size(positions: &[[f32; 3]]) -> Option<f32> {
    let count = positions.len();
    let step = (count / LOOKED_AT).max(1);
    let apart = |i: usize| {
        // No neighbours in a file's order, which is often one in space.
        let other = (i + count / 2 + i * 7919) % count;
        Vec3::from(positions[i]).distance(Vec3::from(positions[other]))
    };
    let all = (0..count).step_by(step).map(apart).filter(|d| d.is_finite()).collect();
    quantile(all, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block that has moved by so much since.
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
        // The frame after: time runs the other way.
        assert!(nearly(&velocities(&now, &known, -0.1).unwrap(), [-0.5, 0.0, 0.2]));
        now.ids = Some((0..1000).collect());
        // One frame alone has ids.
        assert!(velocities(&now, &known, 0.1).is_none());
        known.positions.reverse();
        known.ids = Some((0..1000).rev().collect());
        assert!(nearly(&velocities(&now, &known, 0.1).unwrap(), [0.5, 0.0, -0.2]));
        // One that is new is at rest, and so is one that has jumped.
        known.ids = Some((1..1001).rev().collect());
        known.positions[0] = [90.0; 3];
        let mut ids: Vec<u32> = (0..1000).collect();
        ids.swap(0, 5);
        now.ids = Some(ids);
        let found = velocities(&now, &known, 0.1).unwrap();
        assert_eq!(found[5], [0.0; 3]);
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
