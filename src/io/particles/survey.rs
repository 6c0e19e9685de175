//! Collects everything that depends on all particles of a file, whether they are read at once or in parts: warnings for
//! the user, and attributes to be dropped.

use std::collections::{HashMap, HashSet};

use super::columns::{Column, Data, Extra, Roles, Vector};
use super::error::ReadError;
use super::names::{self, OF_CELLS};
use super::{Format, Meaning, Particles};

/// Converts values to integers.
type Whole = fn(&Data) -> Result<Vec<u32>, usize>;

/// The columns of some particles.
pub(super) struct Columns(Vec<Column>);

impl Columns {
    pub(super) fn new(columns: Vec<Column>) -> Self {
        Self(columns)
    }

    fn f64(&self, column: usize, i: usize) -> f64 {
        self.0.get(column).and_then(|c| c.data.f64(i)).unwrap_or(f64::NAN)
    }

    fn vector(&self, vector: Vector, i: usize) -> [f64; 3] {
        match vector {
            Vector::Whole(column, 3) => [0, 1, 2].map(|k| self.f64(column, 3 * i + k)),
            Vector::Whole(column, _) => [self.f64(column, 2 * i), self.f64(column, 2 * i + 1), 0.0],
            Vector::Split(columns) => columns.map(|c| c.map_or(0.0, |column| self.f64(column, i))),
        }
    }

    pub(super) fn rows(&self, vector: Vector) -> usize {
        let values = |column: usize| self.0.get(column).map_or(0, |c| c.data.len());
        match vector {
            Vector::Whole(column, components) => values(column) / components.max(1),
            Vector::Split(columns) => columns.into_iter().flatten().next().map_or(0, values),
        }
    }

    /// The origin to subtract from the positions so that 32-bit floats can distinguish particles. It is found from the
    /// first [`FIRST`] particles, and is 0 if their positions are 32-bit floats or not distant.
    pub(super) fn origin(&self, roles: &Roles) -> [f64; 3] {
        let exact =
            |column: usize| !matches!(self.0.get(column), Some(Column { data: Data::F32(_), .. }));
        if !roles.positions.columns().any(exact) {
            return [0.0; 3];
        }
        let rows = self.rows(roles.positions).min(FIRST);
        let first: Vec<_> = (0..rows).map(|i| self.vector(roles.positions, i)).collect();
        origin(&first)
    }

    /// Takes the values of a column and frees the rest.
    fn take(&mut self, column: usize) -> Data {
        let taken = self.0.get_mut(column).map(|c| std::mem::replace(&mut c.data, Data::NONE));
        taken.unwrap_or(Data::NONE)
    }

    /// Vectors minus an origin, which is subtracted before they are rounded.
    fn take_vectors(&mut self, vector: Vector, origin: [f64; 3]) -> Vec<[f32; 3]> {
        let less = |p: [f64; 3]| {
            let ([x, y, z], [a, b, c]) = (p, origin);
            [(x - a) as f32, (y - b) as f32, (z - c) as f32]
        };
        let whole = match vector {
            Vector::Whole(column, 3) => self.0.get(column).map(|column| &column.data),
            _ => None,
        };
        let all = match whole {
            Some(Data::F32(v)) if origin == [0.0; 3] => v.as_chunks::<3>().0.to_vec(),
            Some(Data::F64(v)) => v.as_chunks::<3>().0.iter().map(|p| less(*p)).collect(),
            _ => (0..self.rows(vector)).map(|i| less(self.vector(vector, i))).collect(),
        };
        vector.columns().for_each(|column| drop(self.take(column)));
        all
    }
}

/// An attribute that is dropped because it should have integers and does not.
#[derive(Debug)]
struct Dropped {
    attribute: String,
    value: f64,
    particle: usize,
    /// If the value is too large for 32-bit floats to tell integers apart: the number from which on that is so.
    inexact: Option<f64>,
}

/// Max number of positions from which their extent is found.
const SAMPLES: usize = 8192;

/// Number of particles from which the origin is found.
pub(super) const FIRST: usize = 1024;

/// An origin is subtracted if the positions' distance from 0 is more than this multiple of their extent. At this
/// ratio a step of 32-bit floats is 1/4000 of the extent.
const FAR: f64 = 2000.0;

/// Max number of values whose repetitions are counted.
const COUNTED: usize = 1 << 12;

/// Max fraction of repeated ids; above it the attribute is not an id.
const REPEATED_IDS: f64 = 0.01;

/// Fraction of repeated positions above which there is a warning.
pub(super) const DOUBLED: f64 = 0.05;

/// Max number of times that are distinguished.
const STEPS: usize = 1 << 12;

/// Counts repetitions of values. If there are many values, it counts only those whose hash begins with `zeros`
/// zero bits.
#[derive(Debug, Default)]
pub(super) struct Repeats {
    zeros: u32,
    counts: HashMap<u64, usize>,
}

impl Repeats {
    fn add(&mut self, value: u64) {
        // All bits of the value influence the first bits of the hash (Fibonacci hashing).
        let hash = value.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        if hash.leading_zeros() >= self.zeros {
            self.count(hash);
        }
    }

    #[cold]
    fn count(&mut self, hash: u64) {
        *self.counts.entry(hash).or_default() += 1;
        while self.counts.len() > COUNTED {
            self.zeros += 1;
            let zeros = self.zeros;
            self.counts.retain(|hash, _| hash.leading_zeros() >= zeros);
        }
    }

    /// Adds a position; NaN and infinities do not count.
    pub(super) fn add_place(&mut self, [x, y, z]: [f32; 3]) {
        if x.is_finite() && y.is_finite() && z.is_finite() {
            // The sign of zero makes no difference.
            let bits = |c: f32| u64::from((c + 0.0).to_bits());
            let place = bits(x) | bits(y) << 32;
            self.add(place ^ bits(z).wrapping_mul(0xbf58_476d_1ce4_e5b9));
        }
    }

    /// Fraction of the values that had occurred before.
    pub(super) fn share(&self) -> f64 {
        let all: usize = self.counts.values().sum();
        if all == 0 { 0.0 } else { 1.0 - self.counts.len() as f64 / all as f64 }
    }

    /// How often each value occurs, if all occur equally often and not once.
    fn each(&self) -> Option<usize> {
        let first = self.counts.values().next().copied().filter(|count| *count > 1)?;
        self.counts.values().all(|count| *count == first).then_some(first)
    }

    fn most(&self) -> usize {
        self.counts.values().copied().max().unwrap_or(0)
    }
}

/// The times of the particles, in the order of the file.
#[derive(Debug, Default)]
struct Steps {
    name: String,
    first: Option<f64>,
    last: Option<f64>,
    /// Number of changes from one particle to the next.
    changes: usize,
    /// `run`: number of particles since the last change of time. `first_run`: number of particles before the first
    /// change. `even`: whether the times rise, with equally many particles of each.
    run: usize,
    first_run: usize,
    even: bool,
    different: HashSet<u64>,
}

impl Steps {
    fn add(&mut self, time: f64) {
        if self.last.is_some_and(|last| last.to_bits() == time.to_bits()) {
            self.run += 1;
            return;
        }
        match self.changes {
            _ if self.last.is_none() => self.even = true,
            0 => self.first_run = self.run,
            _ => self.even &= self.run == self.first_run,
        }
        self.even &= self.last.is_none_or(|last| last < time);
        self.run = 1;
        self.changes += usize::from(self.last.is_some());
        self.first.get_or_insert(time);
        self.last = Some(time);
        if self.different.len() <= STEPS {
            self.different.insert(time.to_bits());
        }
    }
}

/// Results so far.
#[derive(Debug)]
pub(super) struct Survey {
    /// Whether this is the first pass over the particles. It collects their times, how often ids and positions
    /// repeat, and how many values are not finite. A second pass does not need these again.
    asks: bool,
    origin: [f64; 3],
    seen: usize,
    ghosts: usize,
    /// `only`: the requested time, `None` if no time is requested. `others`: number of particles of other times so
    /// far.
    only: Option<f64>,
    others: usize,
    /// At most a few thousand positions, spread evenly over the file: the first of each `step` particles.
    samples: Vec<[f64; 3]>,
    step: usize,
    not_finite: usize,
    /// Number of velocities that are not finite; a missing one is read as NaN.
    unmoved: usize,
    /// Number of densities that are not finite, and of lifetimes that are NaN.
    no_density: usize,
    no_lifetime: usize,
    ids: Option<Dropped>,
    kinds: Option<Dropped>,
    places: Repeats,
    numbers: Repeats,
    /// Name of the ids.
    numbered: Option<String>,
    steps: Steps,
}

impl Survey {
    /// `origin` is subtracted from the positions.
    pub(super) fn new(origin: [f64; 3]) -> Self {
        Self {
            asks: true,
            origin,
            seen: 0,
            ghosts: 0,
            only: None,
            others: 0,
            samples: Vec::new(),
            step: 1,
            not_finite: 0,
            unmoved: 0,
            no_density: 0,
            no_lifetime: 0,
            ids: None,
            kinds: None,
            places: Repeats::default(),
            numbers: Repeats::default(),
            numbered: None,
            steps: Steps::default(),
        }
    }

    /// Restricts the survey to particles of one time, if they have several.
    pub(super) fn of_time(self, only: Option<f64>) -> Self {
        Self { only, ..self }
    }

    /// Prepares a second pass over the particles.
    pub(super) fn again(self) -> Self {
        Self { asks: false, ..self }
    }

    pub(super) fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// Number of particles in the file so far.
    pub(super) fn seen(&self) -> usize {
        self.seen
    }

    /// Number of particles seen so far that are kept: those that are no ghosts and have the requested time, if one is
    /// requested.
    pub(super) fn kept(&self) -> usize {
        self.seen - self.ghosts - self.others
    }

    /// The requested time, or else the time of all particles if there is only one.
    pub(super) fn time(&self) -> Option<f64> {
        self.only.or(self.one_time())
    }

    /// Removes the meaning of a time from an attribute that gave none, because its values differ or mean something
    /// else.
    pub(super) fn settle(&self, meanings: &mut Vec<(Meaning, Vec<String>)>) {
        meanings.retain(|(meaning, _)| *meaning != Meaning::Time || self.time().is_some());
    }

    fn one_time(&self) -> Option<f64> {
        let first = self.steps.first.filter(|_| !names::is_unsure_step(&self.steps.name));
        first.filter(|time| self.steps.different.len() == 1 && time.is_finite())
    }

    /// Samples some of the next `rows` positions. They are chosen by the particle's number in the file alone, because
    /// the total is not known yet.
    fn sample(&mut self, rows: usize, position: impl Fn(usize) -> [f64; 3]) {
        loop {
            let next = self.samples.len().saturating_mul(self.step);
            let Some(i) = next.checked_sub(self.seen).filter(|i| *i < rows) else { return };
            self.samples.push(position(i));
            if self.samples.len() == SAMPLES {
                let mut kept = false;
                self.samples.retain(|_| {
                    kept = !kept;
                    kept
                });
                self.step = self.step.saturating_mul(2);
            }
        }
    }

    /// Assigns meanings to the columns of the next particles.
    pub(super) fn part(
        &mut self,
        roles: &Roles,
        mut columns: Columns,
        format: Format,
    ) -> Particles {
        let rows = columns.rows(roles.positions);
        let [a, b, c] = self.origin;
        self.sample(rows, |i| {
            let [x, y, z] = columns.vector(roles.positions, i);
            [x - a, y - b, z - c]
        });
        // Each bit of a ghost type is a reason to leave a particle out; the older ghost levels are numbers
        // above 0 for ghosts.
        let kept: Option<Vec<bool>> = roles.ghosts.map(|column| {
            let bits = |i: usize| columns.f64(column, i) as i64;
            let name = columns.0.get(column).map_or("", |c| c.name.as_str());
            let own = name.strip_suffix(OF_CELLS);
            let levels = own.unwrap_or(name).ends_with("Levels");
            // Duplicated or hidden: points have bits 1 and 2 for these, cells 1 and 32.
            let mask = if own.is_some() { 33 } else { 3 };
            let copy = |bits: i64| if levels { bits > 0 } else { bits & mask != 0 };
            (0..rows).map(|i| !copy(bits(i))).collect()
        });
        let own: Option<Vec<bool>> = self.only.zip(roles.steps).map(|(time, column)| {
            (0..rows).map(|i| columns.f64(column, i).to_bits() == time.to_bits()).collect()
        });
        if let Some(column) = roles.steps.filter(|_| self.asks && self.only.is_none()) {
            if self.steps.name.is_empty() {
                self.steps.name = columns.0.get(column).map_or(String::new(), |c| c.name.clone());
            }
            (0..rows).for_each(|i| self.steps.add(columns.f64(column, i)));
        }
        let extra = |&column: &usize| {
            let name = columns.0.get(column)?.name.clone();
            Some(Extra { name, values: (0..rows).map(|i| columns.f64(column, i)).collect() })
        };
        let extras = roles.extras.iter().filter_map(extra).collect();
        // The time left is the difference, rounded only afterwards.
        let left: Option<Vec<f32>> = roles.lifetimes.zip(roles.ages).map(|(life, age)| {
            (0..rows).map(|i| (columns.f64(life, i) - columns.f64(age, i)) as f32).collect()
        });
        let positions = columns.take_vectors(roles.positions, self.origin);
        let velocities = roles.velocities.map(|v| columns.take_vectors(v, [0.0; 3]));
        let mut scalar = |column: Option<usize>| column.map(|c| columns.take(c).into_f32());
        let densities = scalar(roles.densities);
        let lifetimes = left.or_else(|| scalar(roles.lifetimes));
        let mut whole = |column: Option<usize>, to: Whole, dropped: &mut Option<Dropped>| {
            let column = column?;
            let data = columns.take(column);
            let values = to(&data).map_err(|i| {
                let value = data.f64(i).unwrap_or(f64::NAN);
                let inexact =
                    matches!(data, Data::F32(_)) && value.fract() == 0.0 && value >= data.limit();
                Dropped {
                    attribute: columns.0.get(column).map_or(String::new(), |c| c.name.clone()),
                    value,
                    particle: self.seen + i,
                    inexact: inexact.then(|| data.limit()),
                }
            });
            values.map_err(|first| dropped.get_or_insert(first)).ok()
        };
        let ids = whole(roles.ids, Data::to_ids, &mut self.ids);
        let kinds = whole(roles.kinds, Data::to_u32, &mut self.kinds);
        if let (Some(column), None) = (roles.ids, &self.numbered) {
            self.numbered = columns.0.get(column).map(|column| column.name.clone());
        }
        self.seen += rows;
        let mut particles = Particles {
            velocities,
            densities,
            ids,
            lifetimes,
            kinds,
            extras,
            format,
            origin: self.origin,
            ..Particles::from_positions(positions)
        };
        let ghosts = kept.filter(|kept| kept.contains(&false));
        if let Some(kept) = &ghosts {
            self.ghosts += kept.iter().filter(|kept| !**kept).count();
            retain(&mut particles, kept);
        }
        if let Some(own) = own.filter(|own| own.contains(&false)) {
            // Ghosts have already been removed from the particles.
            let own: Vec<bool> = match &ghosts {
                Some(kept) => {
                    own.iter().zip(kept).filter(|(_, kept)| **kept).map(|(o, _)| *o).collect()
                }
                None => own,
            };
            self.others += own.iter().filter(|own| !**own).count();
            retain(&mut particles, &own);
        }
        if self.asks {
            self.not_finite += super::count_non_finite(&particles.positions);
            self.unmoved += particles.velocities.as_deref().map_or(0, super::count_non_finite);
            let densities = particles.densities.iter().flatten();
            self.no_density += densities.filter(|density| !density.is_finite()).count();
            let lifetimes = particles.lifetimes.iter().flatten();
            self.no_lifetime += lifetimes.filter(|left| left.is_nan()).count();
            particles.positions.iter().for_each(|p| self.places.add_place(*p));
            particles.ids.iter().flatten().for_each(|id| self.numbers.add(u64::from(*id)));
        }
        particles
    }

    /// Whether too many ids repeat (more than 1 %; the limit rises with the repeated positions, because copies of a
    /// particle may share its id), so that ids do not identify particles. Both fractions are those of some thousand
    /// sampled values.
    fn repeated_ids(&self) -> bool {
        self.numbers.share() > REPEATED_IDS + 1.2 * self.places.share()
    }

    /// Removes from particles (all of a file, or a part) the ids if any id in the file is not an integer or if ids
    /// repeat, and the kinds if any kind in it is not an integer.
    pub(super) fn drop_from(&self, particles: &mut Particles) {
        if self.ids.is_some() || self.repeated_ids() {
            particles.ids = None;
        }
        if self.kinds.is_some() {
            particles.kinds = None;
        }
    }

    /// Warnings for the user, after the last part.
    ///
    /// # Errors
    /// The particles belong to several frames.
    pub(super) fn finish(&self) -> Result<Vec<String>, ReadError> {
        self.one_frame()?;
        let origin = (self.origin != [0.0; 3]).then(|| {
            let [x, y, z] = self.origin;
            format!(
                "the particles lie far from the origin, where 32-bit floats cannot resolve them: {x} {y} {z} is \
                 subtracted from their positions; scenes, and cameras in files, are relative to that"
            )
        });
        let ghosts = (self.ghosts > 0).then(|| {
            format!(
                "{} of {} particles are ghosts, which are copies of particles of other pieces; they are left out",
                self.ghosts, self.seen
            )
        });
        let not_finite = (self.not_finite > 0).then(|| {
            format!(
                "{} of {} positions are not finite (NaN or infinite, or too large for 32 bits); they are not drawn",
                self.not_finite,
                self.kept()
            )
        });
        let unmoved = (self.unmoved > 0).then(|| {
            format!(
                "{} of {} velocities are missing or not finite (NaN or infinite): foam and motion blur of these \
                 particles are not right",
                self.unmoved,
                self.kept()
            )
        });
        let no_density = (self.no_density > 0).then(|| {
            format!(
                "{} of {} densities are missing or not finite (NaN or infinite): spray of these particles is not right",
                self.no_density,
                self.kept()
            )
        });
        let no_lifetime = (self.no_lifetime > 0).then(|| {
            format!(
                "{} of {} lifetimes are missing (NaN): these particles count as dead",
                self.no_lifetime,
                self.kept()
            )
        });
        let dropped =
            [(&self.ids, " from 0 on"), (&self.kinds, " from 0 to 4294967295")].into_iter();
        let dropped = dropped.filter_map(|(dropped, limits)| {
            let Dropped { attribute, value, particle, inexact } = dropped.as_ref()?;
            if let Some(limit) = inexact {
                return Some(format!(
                    "attribute `{attribute}` is dropped: value {value} of particle {particle} is stored as a 32-bit \
                     float, which is not exact from {limit} on; write integers"
                ));
            }
            Some(format!(
                "attribute `{attribute}` is dropped: {} of particle {particle} is not a whole number{limits}",
                if value.is_nan() { "the word or NaN".into() } else { format!("value {value}") }
            ))
        });
        let repeated = (self.ids.is_none() && self.repeated_ids()).then(|| {
            let steps = self.numbers.each().map_or(String::new(), |count| {
                format!(
                    "; each occurs {count} times: if these are {count} time steps, write a column `time`, or one file \
                     per frame"
                )
            });
            format!(
                "attribute `{}` is dropped: {:.0} % of its values occur in several particles, so it does not identify \
                 them{steps}",
                self.numbered.as_deref().unwrap_or("id"),
                100.0 * self.numbers.share()
            )
        });
        let share = self.places.share();
        let doubled = (share > DOUBLED).then(|| {
            format!(
                "{:.0} % of the particles share their position with others, up to {} at one place: files may overlap, \
                 or hold unused particles",
                100.0 * share,
                self.places.most()
            )
        });
        let told = origin.into_iter().chain(resolution_warning(&self.samples)).chain(ghosts);
        Ok(told
            .chain(not_finite)
            .chain(unmoved)
            .chain(no_density)
            .chain(no_lifetime)
            .chain(dropped)
            .chain(repeated)
            .chain(doubled)
            .collect())
    }

    /// Whether the particles belong to several frames.
    fn several(&self) -> bool {
        let steps = &self.steps;
        let count = steps.different.len();
        let blocks = steps.changes + 1 == count && self.seen >= 2 * count;
        let several = match self.numbers.counts.is_empty() {
            // In several frames a particle occurs at most once per time, so ids repeat, but at most as often as
            // there are times.
            false => self.numbers.share() > REPEATED_IDS && self.numbers.most() <= count,
            // Without ids: either the particles of a time, or the times of a particle, are adjacent in the file.
            true => {
                blocks
                    || (steps.changes + 1 == self.seen
                        && self.seen >= 2 * count
                        && self.seen.is_multiple_of(count))
            }
        };
        // Of a column `t` without ids to prove it: a temperature does not rise from block to block, and kinds of
        // particles differ in their numbers.
        let even = steps.even && steps.run == steps.first_run && count > 2;
        let sure = !names::is_unsure_step(&steps.name) || !self.numbers.counts.is_empty();
        (2..=STEPS).contains(&count) && several && (sure || even)
    }

    /// The times of several frames, sorted.
    pub(super) fn times(&self) -> Vec<f64> {
        if !self.several() {
            return Vec::new();
        }
        let all = self.steps.different.iter().map(|bits| f64::from_bits(*bits));
        let mut times: Vec<f64> = all.filter(|time| time.is_finite()).collect();
        times.sort_unstable_by(f64::total_cmp);
        times
    }

    fn one_frame(&self) -> Result<(), ReadError> {
        if !self.several() {
            return Ok(());
        }
        let steps = &self.steps;
        let count = steps.different.len();
        let (first, last) = (steps.first.unwrap_or_default(), steps.last.unwrap_or_default());
        Err(ReadError::Unsupported {
            what: format!(
                "a file of {count} frames (`{}` goes from {first} to {last})",
                steps.name
            ),
            advice: "write one file per frame, with the frame's number in its name, as \
                     `for i, (t, rows) in enumerate(data.groupby('time')): rows.to_csv(f'frame_{i:04d}.csv')` of pandas does",
        })
    }
}

/// Removes particles.
pub(super) fn retain(particles: &mut Particles, kept: &[bool]) {
    fn some<T>(list: &mut Vec<T>, kept: &[bool]) {
        let mut kept = kept.iter();
        list.retain(|_| *kept.next().unwrap_or(&true));
    }
    some(&mut particles.positions, kept);
    particles.velocities.iter_mut().for_each(|list| some(list, kept));
    particles.densities.iter_mut().for_each(|list| some(list, kept));
    particles.ids.iter_mut().for_each(|list| some(list, kept));
    particles.lifetimes.iter_mut().for_each(|list| some(list, kept));
    particles.kinds.iter_mut().for_each(|list| some(list, kept));
    particles.extras.iter_mut().for_each(|extra| some(&mut extra.values, kept));
}

/// Of the middle 90 % of the positions along each axis: the largest distance from 0 and the largest extent along any
/// axis. Also the median of each axis.
fn reach_of(samples: &[[f64; 3]]) -> Option<(f64, f64, [f64; 3])> {
    let (mut extent, mut reach, mut middle) = (0.0_f64, 0.0_f64, [0.0; 3]);
    for (axis, middle) in middle.iter_mut().enumerate() {
        let mut sorted: Vec<f64> =
            samples.iter().filter_map(|p| p.get(axis).copied()).filter(|c| c.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        // From the 5th to the 95th percentile, so that outliers do not count.
        let cut = sorted.len() / 20;
        let low = sorted.get(cut)?;
        let high = sorted.get(sorted.len() - 1 - cut)?;
        *middle = *sorted.get(sorted.len() / 2)?;
        extent = extent.max(high - low);
        reach = reach.max(low.abs()).max(high.abs());
    }
    Some((reach, extent, middle))
}

/// Origin to subtract from the positions: their median, if they are distant ([`FAR`]), otherwise 0. The median is
/// rounded to about four leading digits, so that the frames of a sequence usually have the same origin.
fn origin(first: &[[f64; 3]]) -> [f64; 3] {
    let Some((reach, extent, middle)) = reach_of(first) else { return [0.0; 3] };
    if extent <= 0.0 || reach <= FAR * extent || !reach.is_finite() {
        return [0.0; 3];
    }
    let step = (reach.log2().floor() - 13.0).exp2();
    middle.map(|c| (c / step).round() * step)
}

/// Warns if the step of 32-bit floats at the positions' distance from 0 is more than a thousandth of their extent.
fn resolution_warning(samples: &[[f64; 3]]) -> Option<String> {
    let (reach, extent, _) = reach_of(samples)?;
    let resolution = reach * f64::from(f32::EPSILON);
    (extent > 0.0 && resolution > 1e-3 * extent).then(|| {
        format!(
            "the particles lie {reach:.3e} from the origin but span only {extent:.3e}: 32-bit positions are no finer \
             than {resolution:.1e} there; move them to the origin before writing the file"
        )
    })
}
