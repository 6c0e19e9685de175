//! Reads whitewater particles from files of the same frames.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::f32::consts::PI;
use std::iter;
use std::path::PathBuf;

use glam::Vec3;
use whitewater::Settings;
use whitewater::WhitewaterSettings;
use whitewater::headless::{self, Headless};
use whitewater::io::particles::{Particles, Parts};

use crate::args::Whitewater;
use crate::blur;
use crate::bubbles::Random;
use crate::failure::{Failure, Outcome};
use crate::frames;
use crate::generate::Generate;
use crate::placing::{self, Placing};
use crate::settings::SettingsFile;

/// Number of probed whitewater frames, from which the longest lifetime and the number of particles per column are
/// found.
const PROBES: usize = 16;

/// Source of the whitewater particles.
pub enum WhitewaterSource {
    Files(Files),
    Made(Box<Generate>),
}

impl WhitewaterSource {
    /// Whether a frame's particles have velocities.
    pub fn moves(&self, frame: u64) -> Outcome<bool> {
        match self {
            Self::Files(files) => Ok(files.open(frame)?.moves()),
            Self::Made(_) => Ok(true),
        }
    }

    /// Shows a frame's particles where they are `seconds` after the frame, or before it if negative: each is moved
    /// along its velocity. They have been shown at the frame's time before.
    pub fn show(&self, headless: &mut Headless, frame: u64, seconds: f32) -> Outcome<()> {
        match self {
            Self::Files(files) => {
                let reading = files.open(frame)?;
                if reading.moves() { reading.upload(headless, seconds) } else { Ok(()) }
            }
            Self::Made(_) => Ok(headless.move_generated(seconds)?),
        }
    }
}

/// Files of a sequence, by frame number.
pub struct Files {
    frames: BTreeMap<u64, Vec<(PathBuf, Option<u32>)>>,
    placing: Placing,
    /// The longest remaining lifetime; `None` if no file stores lifetimes.
    life: Option<f32>,
    /// Mean number of particles of each kind (foam, spray, bubbles) in a vertical column that holds any of that kind;
    /// `None` if there are none.
    columns: [Option<f32>; 3],
    /// Max number of particles in a frame.
    most: usize,
    /// Size and number of drawn particles, if they were found.
    drawn: Option<Drawn>,
    /// Warnings about the probed files. Of those that differ only in their numbers, the first one.
    told: Vec<String>,
}

/// How the particles of files are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Drawn {
    /// Radii of foam, spray and bubbles.
    radii: [f32; 3],
    /// Number of drawn particles for each particle of a file.
    copies: u32,
    /// Particle spacing of the water.
    spacing: f32,
}

/// The whitewater particles of a frame, in opened files. They are read and uploaded part by part, so that only one
/// part is in memory. That is possible because camera and light are found from the water's particles alone.
pub struct Reading {
    files: Vec<(Parts<'static>, Option<u32>)>,
    placing: Placing,
    life: Option<f32>,
    drawn: Option<Drawn>,
}

/// A part of the particles, ready for upload.
struct Part {
    positions: Vec<[f32; 3]>,
    velocities: Option<Vec<[f32; 3]>>,
    kinds: Vec<u32>,
    radii: Option<Vec<f32>>,
    ages: Vec<f32>,
    ids: Option<Vec<u32>>,
}

/// Number of kinds: foam, spray and bubbles. An unknown kind counts as foam.
const KINDS: usize = 3;

fn kind_of(number: u32) -> usize {
    usize::try_from(number).ok().filter(|kind| *kind < KINDS).unwrap_or(0)
}

/// Number of sizes of whitewater particles: the radius of each is divided by a whole number from 1 to this one,
/// chosen per particle. (Akinci et al. 2013, Sec. 2.1, have 5; with only five sizes single particles stand out.)
pub const VARIETY: u32 = 8;
/// Mean thickness that one foam particle adds to a column, if its radius is the column's width: the area π of its
/// disc, times the mean of its squared size (1 to 1 / [`VARIETY`]), times the mean of its profile 1 - x^2.25 over the
/// disc, where x is the distance from the centre relative to the radius.
const SHARE: f32 = {
    let (mut squares, mut i) = (0.0, 1);
    while i <= VARIETY {
        squares += 1.0 / (i * i) as f32;
        i += 1;
    }
    PI * squares / VARIETY as f32 * (1.0 - 2.0 / 4.25)
};
/// Wanted opacity of a column with the mean number of particles. It is reached if they are spread evenly and the
/// radius is within its limits; a few randomly placed particles leave gaps and hide less on average.
const HIDDEN: f32 = 0.8;
/// Half-intensity thickness ([`Sizes::half`]) if a file has few whitewater particles. In the centre of a single
/// particle the thickness is 1, so the opacity is 1 / (1 + 0.12), that of a drop of white water.
const FEW: f32 = 0.12;
/// Each whitewater particle is drawn as several copies if a column that holds any foam (or any spray) has on average
/// fewer particles than the first number here. The second is the max number of copies of a particle, the third the
/// max number of all drawn particles.
const COPIES: (f32, u32, usize) = (270.0, 64, 3_000_000);
/// Max distance of a copy from the particle that it copies, in spacings, for foam, spray and bubbles.
const SCATTER: [f32; KINDS] = [1.2, 2.0, 0.8];
/// Factor on the vertical distance of copies of foam that floats.
const FLAT: f32 = 1.0 / 3.0;
/// Factors on the distance of copies along the motion of their particle and across it, for spray and for foam that
/// flies: torn water flies in strands.
const STRAND: [f32; 2] = [2.0, 0.4];
/// Foam floats if the vertical part of its direction of motion, 0 to 1, is at most the first value. It flies if that
/// part is at least the second value. Files tell foam from spray by the number of neighbours, so that most of a
/// dense splash is foam.
const FLIES: [f32; 2] = [0.1, 0.4];
/// Min and max radius of a whitewater particle, in spacings of the water. The search for shadows does not resolve
/// smaller spheres, and larger ones are seen as single balls.
const RADII: [f32; 2] = [0.1, 0.14];

/// Size and opacity of whitewater particles. For the same splash a file may hold ten thousand or ten million
/// particles. Akinci's constants are for millions; ten thousand would look like a haze with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// Radii of foam, spray and bubbles.
    pub radii: [f32; 3],
    /// Half-intensity thickness, ρ_mod of the intensity.
    pub half: f32,
}

impl Sizes {
    /// Size and opacity from `columns`, the mean number of particles in a column, one spacing squared, that holds
    /// any. A column of `n` particles with a radius of `r` spacings has the thickness `SHARE n r^2`. The radius is
    /// chosen within [`RADII`] so that the mean column has the opacity [`HIDDEN`] with `half` = [`FEW`]. If even the
    /// min radius gives more opacity than that, `half` rises, at most to the source's 3, so that the opacity is
    /// [`HIDDEN`] again; with still more particles the opacity is higher. For `half` only foam and spray count,
    /// because bubbles are seen through water.
    pub fn of_columns(columns: [Option<f32>; 3], spacing: f32) -> Self {
        let WhitewaterSettings { half_intensity_thickness: most, exponent, .. } =
            WhitewaterSettings::of_spacing(spacing);
        let odds = HIDDEN / (1.0 - HIDDEN);
        let thickness = (FEW * odds).powf(exponent.recip());
        let least = RADII[0];
        let radius = |n: f32| (thickness / (SHARE * n)).sqrt().clamp(least, RADII[1]);
        let radii = columns.map(|n| n.map_or(RADII[1], radius));
        let thickest =
            columns.iter().zip(radii).take(2).filter_map(|(n, r)| Some(SHARE * (*n)? * r * r));
        let half = thickest.fold(0.0, f32::max).powf(exponent) / odds;
        Self { radii: radii.map(|r| r * spacing), half: half.clamp(FEW, most) }
    }
}

/// Counts particles of each kind in columns of one spacing squared.
#[derive(Default)]
pub struct Columns {
    /// Counts of the current frame.
    here: HashMap<[i64; 2], [u32; KINDS]>,
    /// Sums over all frames: particles, and columns that hold any.
    sums: [[u64; 2]; KINDS],
}

impl Columns {
    /// Adds the particles of a frame, or a part of them.
    pub fn add(&mut self, part: &Particles, kind: Option<u32>, placing: Placing, spacing: f32) {
        let across = [0, 1, 2].map(|axis| placing.up.axis() != axis);
        for (i, position) in part.positions.iter().enumerate() {
            let gone =
                part.lifetimes.as_ref().is_some_and(|left| left[i].is_nan() || left[i] <= 0.0);
            let mut level =
                position.iter().zip(across).filter(|(_, across)| *across).map(|(c, _)| *c);
            let level = [level.next(), level.next()].map(Option::unwrap_or_default);
            if gone || !level.iter().all(|c| c.is_finite()) {
                continue;
            }
            let column = level.map(|c| (c * placing.scale / spacing).floor() as i64);
            let kind = kind.or_else(|| Some(part.kinds.as_ref()?[i])).map_or(0, kind_of);
            self.here.entry(column).or_default()[kind] += 1;
        }
    }

    pub fn end_frame(&mut self) {
        for counts in self.here.drain().map(|(_, counts)| counts) {
            for (sums, count) in self.sums.iter_mut().zip(counts).filter(|(_, count)| *count > 0) {
                *sums = [sums[0] + u64::from(count), sums[1] + 1];
            }
        }
    }

    /// Mean number of particles of each kind in a column that holds any.
    pub fn means(&self) -> [Option<f32>; KINDS] {
        self.sums.map(|[all, columns]| (columns > 0).then(|| all as f32 / columns as f32))
    }
}

impl Files {
    /// Finds the files; `None` if none are named. `single` is the number of the only frame, if there is one; a single
    /// file then belongs to it, whatever number is in its name. `spacing` is the water's.
    pub fn find(
        named: &[Whitewater],
        placing: Placing,
        single: Option<u64>,
        spacing: f32,
    ) -> Outcome<Option<Self>> {
        if named.is_empty() {
            return Ok(None);
        }
        let mut frames: BTreeMap<u64, Vec<_>> = BTreeMap::new();
        for named in named {
            let Whitewater::Files { kind, files } = named else {
                let why =
                    "--whitewater: expected 'generate' or files, found both or one of it twice";
                return Err(Failure::usage(why));
            };
            let found = frames::files(std::slice::from_ref(files), false)?;
            let alone = single.filter(|_| found.len() == 1);
            for frame in found {
                let number = alone.unwrap_or(frame.number);
                frames.entry(number).or_default().push((frame.path, *kind));
            }
        }
        let mut files = Self {
            frames,
            placing,
            life: None,
            columns: [None; 3],
            most: 0,
            drawn: None,
            told: Vec::new(),
        };
        files.look(spacing);
        Ok(Some(files))
    }

    /// Reads at most [`PROBES`] frames, spread over the whole sequence, so that lifetime and density that are found
    /// do not depend on which range of frames is drawn.
    fn look(&mut self, spacing: f32) {
        let step = self.frames.len().div_ceil(PROBES).max(1);
        let (mut longest, mut columns, mut here) = (None, Columns::default(), 0);
        let mut known = HashSet::new();
        for (path, kind, last) in self.frames.values().step_by(step).flat_map(|files| {
            let last = files.len() - 1;
            files.iter().enumerate().map(move |(i, (path, kind))| (path, *kind, i == last))
        }) {
            let mut most: Option<f32> = None;
            let read = Parts::open_with(path, Parts::USUAL, |part| {
                let lifetimes = part.lifetimes.iter().flatten().copied();
                most = lifetimes.filter(|l| l.is_finite()).chain(most).reduce(f32::max);
                columns.add(part, kind, self.placing, spacing);
                here += part.positions.len();
            });
            // If a file cannot be read, the error is reported when its frame is drawn.
            if let Ok(read) = read {
                longest = most.into_iter().chain(longest).reduce(f32::max);
                for warning in &read.about().warnings {
                    let kind: String = warning.chars().filter(|c| !c.is_ascii_digit()).collect();
                    if known.insert(kind) {
                        self.told.push(format!("--whitewater: {}: {warning}", path.display()));
                    }
                }
            }
            if last {
                columns.end_frame();
                self.most = self.most.max(std::mem::take(&mut here));
            }
        }
        self.life = longest.filter(|life| *life > 0.0);
        self.columns = columns.means();
    }

    /// Sets radii and opacity from how densely the particles lie, unless the settings file has them. The thesis' look
    /// is not changed.
    pub fn choose(&mut self, file: &SettingsFile, settings: &mut Settings) {
        if file.is_thesis() {
            return;
        }
        let table = &file.whitewater;
        let said = table.radii.is_some() || table.radius.is_some();
        let spacing = settings.water.spacing;
        let few = || if said { 1 } else { copies(self.columns, self.most) };
        let copies = table.copies.map_or_else(few, |copies| copies.clamp(1, 64));
        let columns = self.columns.map(|n| n.map(|n| n * copies as f32));
        let found = Sizes::of_columns(columns, spacing);
        let radii = table.radii.or((!said).then_some(found.radii));
        if let Some(radii) = radii {
            self.drawn = Some(Drawn { radii, copies, spacing });
            settings.whitewater.radius = radii.into_iter().fold(0.0, f32::max);
        }
        settings.whitewater.half_intensity_thickness =
            table.half_intensity_thickness.unwrap_or(found.half);
    }

    /// Radii of foam, spray and bubbles, if they differ.
    pub fn radii(&self) -> Option<[f32; 3]> {
        self.drawn.map(|drawn| drawn.radii)
    }

    /// Number of drawn particles of the fullest probed frame.
    pub fn fullest(&self) -> usize {
        self.most * self.copies() as usize
    }

    /// Number of drawn particles for each particle of a file.
    pub fn copies(&self) -> u32 {
        self.drawn.map_or(1, |drawn| drawn.copies)
    }

    /// Messages about the files: warnings about the probed ones, and if some frames have no file with their number.
    /// Fails if no frame has one.
    pub fn missing(&self, frames: &[u64]) -> Outcome<Vec<String>> {
        Ok(self.told.iter().cloned().chain(self.without(frames)?).collect())
    }

    fn without(&self, frames: &[u64]) -> Outcome<Option<String>> {
        let without = frames.iter().filter(|frame| !self.frames.contains_key(frame));
        let without: Vec<_> = without.collect();
        let Some(first) = without.first() else { return Ok(None) };
        if without.len() == frames.len()
            && let (Some((low, files)), Some((high, _))) =
                (self.frames.first_key_value(), self.frames.last_key_value())
        {
            let file = files.first().map_or(String::new(), |(path, _)| path.display().to_string());
            let range = |low: &u64, high: &u64| match low == high {
                true => format!("{low}"),
                false => format!("{low} to {high}"),
            };
            let last = frames.last().unwrap_or(first);
            return Err(Failure::input(format!(
                "--whitewater: expected files of the frames {}, found {} files of the numbers {}, the first {file}: the \
                 last number in the name is the frame; rename one of the sequences",
                range(frames.first().unwrap_or(first), last),
                self.frames.len(),
                range(low, high),
            )));
        }
        let (count, total) = (without.len(), frames.len());
        Ok(Some(format!(
            "--whitewater: {count} of {total} frames, from {first} on, have no file with their number and are drawn without \
             whitewater particles"
        )))
    }

    /// Opens the files of a frame; the result is empty if there is no file with its number.
    pub fn open(&self, frame: u64) -> Outcome<Reading> {
        let named = self.frames.get(&frame).into_iter().flatten();
        let open =
            |(path, kind): &(PathBuf, _)| Outcome::Ok((Parts::open(path, Parts::USUAL)?, *kind));
        let files = named.map(open).collect::<Outcome<_>>()?;
        Ok(Reading { files, placing: self.placing, life: self.life, drawn: self.drawn })
    }
}

impl Reading {
    /// Number of particles in all files.
    pub fn read(&self) -> usize {
        self.files.iter().map(|(parts, _)| parts.total()).sum()
    }

    /// Number of drawn particles of all files.
    pub fn total(&self) -> usize {
        let copies = self.drawn.map_or(1, |drawn| drawn.copies as usize);
        self.files.iter().map(|(parts, _)| parts.total() * copies).sum()
    }

    /// Whether the files have velocities.
    pub fn moves(&self) -> bool {
        self.files.iter().any(|(parts, _)| parts.about().velocities.is_some())
    }

    /// Reads the frame's whitewater particles from its files and uploads them, each moved along its velocity to its
    /// place `seconds` after the frame. They stay on the device until the next upload.
    pub fn upload(self, headless: &mut Headless, seconds: f32) -> Outcome<()> {
        let mut upload = headless.whitewater_parts(self.total())?;
        let mut first = 0;
        // Ids are used only if all files have them.
        let identified = self.files.iter().all(|(parts, _)| parts.about().ids.is_some());
        for (parts, kind) in self.files {
            for part in parts {
                let seen = (self.placing, self.life, self.drawn);
                let part = Part::new(part?, kind, seen, first, seconds);
                first = first.wrapping_add(part.positions.len() as u32);
                upload.push(&headless::Whitewater {
                    positions: &part.positions,
                    kinds: Some(&part.kinds),
                    radii: part.radii.as_deref(),
                    ages: Some(&part.ages),
                    ids: part.ids.as_deref().filter(|_| identified),
                })?;
            }
        }
        Ok(upload.finish()?)
    }
}

impl Part {
    fn new(
        mut read: Particles,
        kind: Option<u32>,
        (placing, life, drawn): (Placing, Option<f32>, Option<Drawn>),
        first: u32,
        seconds: f32,
    ) -> Self {
        // The message is not shown: that of the water says the same.
        _ = placing::agree(&mut read, placing.scale);
        placing.place(&mut read);
        if let Some(velocities) = &read.velocities {
            read.positions = blur::moved(&read.positions, velocities, seconds);
        }
        let count = read.positions.len();
        let kinds = kind.map(|kind| vec![kind; count]).or(read.kinds);
        let age = |left: f32| match life {
            // A particle whose remaining lifetime is 0 or less is dead.
            Some(life) if left > 0.0 => (1.0 - left / life).max(0.0),
            _ => 1.0,
        };
        let ages = read.lifetimes.map(|left| left.into_iter().map(age).collect());
        let kinds = kinds.unwrap_or_else(|| vec![0; count]);
        let mut part = Self {
            positions: read.positions,
            velocities: read.velocities,
            radii: None,
            kinds,
            ages: ages.unwrap_or_else(|| vec![0.0; count]),
            ids: read.ids,
        };
        if let Some(drawn) = drawn {
            part.scatter(&drawn, first);
            let of_kind = |kind: &u32| drawn.radii[kind_of(*kind)];
            part.radii = Some(part.kinds.iter().map(of_kind).collect());
        }
        part
    }

    /// Replaces each particle by its copies. The first copy is at the particle's place, the others lie around it,
    /// those of flying particles along the motion. Their offsets depend on the particle's id, or on its index if it has
    /// none.
    fn scatter(&mut self, drawn: &Drawn, first: u32) {
        let copies = drawn.copies as usize;
        if copies < 2 {
            return;
        }
        let known = |i: usize| self.ids.as_ref().map_or(first.wrapping_add(i as u32), |ids| ids[i]);
        let mut positions = Vec::with_capacity(self.positions.len() * copies);
        for (i, &p) in self.positions.iter().enumerate() {
            positions.push(p);
            let kind = kind_of(self.kinds[i]);
            let velocity = self.velocities.as_ref().map(|all| Vec3::from(all[i]));
            let motion = velocity.and_then(Vec3::try_normalize);
            // How far the particle flies (1) instead of floating (0).
            let flies = match (kind, motion) {
                (0, Some(motion)) => {
                    ((motion.y.abs() - FLIES[0]) / (FLIES[1] - FLIES[0])).clamp(0.0, 1.0)
                }
                (1, _) => 1.0,
                _ => 0.0,
            };
            // The distances are uniformly distributed, so the copies are denser near the particle than farther away.
            let reach = SCATTER[kind] * drawn.spacing;
            let flat = if kind == 0 { FLAT + (1.0 - FLAT) * flies } else { 1.0 };
            let [along, across] = STRAND.map(|strand| 1.0 + flies * (strand - 1.0));
            // Multiplying by the golden ratio's bits spreads the seeds of consecutive ids.
            let mut random = Random((u64::from(known(i)) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
            positions.extend((1..copies).map(|_| {
                let away = Vec3::from([(); 3].map(|()| 2.0 * random.next() - 1.0));
                let away = away.normalize_or_zero() * random.next() * reach;
                let away = away * Vec3::new(1.0, flat, 1.0);
                let away = motion.map_or(away, |motion| {
                    let part = away.dot(motion) * motion;
                    along * part + across * (away - part)
                });
                (Vec3::from(p) + away).to_array()
            }));
        }
        let each =
            |values: &[f32]| values.iter().flat_map(|v| iter::repeat_n(*v, copies)).collect();
        self.positions = positions;
        self.velocities = None;
        self.ages = each(&self.ages);
        self.kinds = self.kinds.iter().flat_map(|v| iter::repeat_n(*v, copies)).collect();
        self.ids = self.ids.take().map(|ids| {
            let number =
                |id: u32| (0..drawn.copies).map(move |k| id.wrapping_mul(drawn.copies) + k);
            ids.into_iter().flat_map(number).collect()
        });
    }
}

/// Number of particles drawn for each particle of a file. `columns` is the mean number per column of each kind; the
/// sparser one of foam and spray decides. `most` is the number of particles in the fullest frame, which limits the
/// copies.
fn copies(columns: [Option<f32>; KINDS], most: usize) -> u32 {
    let (wanted, copies, all) = COPIES;
    let fewest = columns.into_iter().take(2).flatten().fold(f32::INFINITY, f32::min);
    let room = (all / most.max(1)).clamp(1, copies as usize) as u32;
    ((wanted / fewest).ceil() as u32).clamp(1, room)
}

/// Parses `generate` or `[KIND=]FILES`.
pub fn named(text: &str) -> Result<Whitewater, String> {
    if text == "generate" {
        return Ok(Whitewater::Generate);
    }
    let kinds = [("foam=", 0), ("spray=", 1), ("bubble=", 2)];
    let found = kinds.into_iter().find_map(|(name, kind)| Some((text.strip_prefix(name)?, kind)));
    let (files, kind) = match found {
        Some((files, kind)) => (files, Some(kind)),
        None => (text, None),
    };
    if files.is_empty() {
        return Err("expected files, as in whitewater_%04d.bgeo or bubble=bubbles_*.bgeo".into());
    }
    Ok(Whitewater::Files { kind, files: files.into() })
}

/// The number of particles, if the renderer supports it.
pub fn counted(count: usize) -> Outcome<u32> {
    u32::try_from(count)
        .map_err(|_| Failure::input("expected fewer than 2^32 whitewater particles, found more"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::Up;

    #[test]
    fn frames_without_a_file_are_told() {
        let frames = [2, 4].map(|frame| (frame, vec![(PathBuf::new(), None)])).into();
        let columns = [None; 3];
        let placing = Placing::default();
        let told = Vec::new();
        let files = Files { frames, placing, life: None, columns, most: 0, drawn: None, told };
        assert!(files.missing(&[2, 4]).unwrap().is_empty());
        let said = files.missing(&[2, 3, 4, 5]).unwrap().remove(0);
        assert!(said.contains("2 of 4 frames, from 3 on"), "{said}");
        let failure = files.missing(&[10, 11]).unwrap_err();
        for part in ["frames 10 to 11", "2 files of the numbers 2 to 4"] {
            assert!(failure.message.contains(part), "{}", failure.message);
        }
    }

    /// Warnings about whitewater files are not lost; those of one kind are said once.
    #[test]
    fn warnings_about_files_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        for (name, row) in [("w_1.csv", "nan,0,0"), ("w_2.csv", "0,nan,0\n1,nan,0")] {
            std::fs::write(at(name), format!("x,y,z\n0,0,0\n{row}\n")).unwrap();
        }
        let named = [Whitewater::Files { kind: None, files: at("w_*.csv") }];
        let files = Files::find(&named, Placing::default(), None, 0.1).unwrap().unwrap();
        let told = files.missing(&[1, 2]).unwrap();
        assert!(told.len() == 1 && told[0].contains("w_1.csv: "), "{told:?}");
    }

    /// Returns the opacity, 0 to 1, of a column of `n` foam particles (Akinci et al. 2013, Sec. 2.3).
    fn hidden(n: f32, radius: f32, half: f32) -> f32 {
        let power = (SHARE * n * radius * radius).powf(1.25);
        power / (half + power)
    }

    /// Test: the size and number of copies that are chosen give the same patch of foam, 40 by 40 columns, an opacity
    /// of 0.55 to 0.65 if it has a thousand particles, [`HIDDEN`] with 2500 to a million, more with ten million. With the radius and half-intensity thickness of the paper ten thousand would give less than 0.02.
    #[test]
    fn ten_thousand_and_ten_million_read_as_foam() {
        let of = |n: f32, spacing: f32| {
            let Sizes { radii, half } = Sizes::of_columns([Some(n), None, None], spacing);
            (hidden(n, radii[0] / spacing, half), radii[0] / spacing, half)
        };
        let of_count = |count: f32| {
            let n = count / 1600.0;
            of(n * copies([Some(n), None, None], count as usize) as f32, 0.02)
        };
        let all = [1.0e3, 2.5e3, 1.0e4, 1.0e5, 1.0e6, 3.0e6, 1.0e7].map(of_count);
        assert!(
            all.windows(2).all(|two| two[0].0 < two[1].0 + 1.0e-5),
            "more hides no less: {all:?}"
        );
        let [thousand, between, ten, hundred, million, _, most] = all;
        // Even 64 copies make only 40 per column: the radius is at its max.
        assert!(thousand.1 == RADII[1] && thousand.2 == FEW, "{thousand:?}");
        assert!((0.55..0.65).contains(&thousand.0), "{thousand:?}");
        let hides = |of: &(f32, f32, f32)| (of.0 / HIDDEN - 1.0).abs() < 1.0e-4;
        // The radius decreases with the number to its min; from there on the half-intensity thickness rises.
        assert!(hides(&between) && between.2 < 1.0001 * FEW, "{between:?}");
        assert!(between.1 > 1.01 * RADII[0] && between.1 < 0.99 * RADII[1], "{between:?}");
        assert!([ten, hundred, million].iter().all(hides), "{ten:?} {hundred:?} {million:?}");
        assert!(ten.2 > FEW, "{ten:?}");
        assert!(most.0 > HIDDEN && most.2 == 3.0, "{most:?}");
        assert!([ten, hundred, million, most].iter().all(|of| (of.1 - RADII[0]).abs() < 1.0e-6));
        assert!(hidden(1.0e4 / 1600.0, 0.15, 3.0) < 0.02, "as the source's numbers have it");
        // The result does not depend on the unit.
        assert!((of(30.0, 0.02).1 - of(30.0, 5.0).1).abs() < 1.0e-6);
        // Sparse spray and dense foam get different radii. Which radius a missing kind gets does not matter.
        let Sizes { radii, .. } = Sizes::of_columns([Some(200.0), Some(2.0), None], 1.0);
        assert_eq!(radii, [RADII[0], RADII[1], RADII[1]]);
    }

    #[test]
    fn few_are_drawn_as_several_where_each_lies() {
        assert_eq!(
            copies([Some(280.0), Some(270.0), Some(1.0)], 1_000_000),
            1,
            "bubbles need none"
        );
        assert_eq!(copies([Some(120.0), Some(10.0), None], 10_000), 27);
        assert_eq!(copies([Some(0.5), None, None], 10_000), COPIES.1);
        assert_eq!(copies([Some(0.5), None, None], 1_000_000), 3, "no more of all");
        assert_eq!(copies([None; 3], 0), 1);
        let mut read = Particles::from_positions((0..6_u8).map(|i| [f32::from(i); 3]).collect());
        read.kinds = Some(vec![0, 1, 2, 0, 1, 2]);
        read.lifetimes = Some(vec![1.0, 2.0, 0.5, 1.0, 2.0, 0.5]);
        read.ids = Some((10..16).collect());
        let radii = [0.01, 0.02, 0.03];
        let drawn = Drawn { radii, copies: 5, spacing: 0.1 };
        let of = |read: Particles, drawn| {
            Part::new(read, None, (Placing::default(), Some(2.0), drawn), 0, 0.0)
        };
        let (one, all) = (of(read.clone(), None), of(read.clone(), Some(drawn)));
        assert_eq!((all.positions.len(), all.radii.as_ref().map(Vec::len)), (30, Some(30)));
        for (i, copies) in all.positions.chunks(5).enumerate() {
            assert_eq!(copies[0], one.positions[i]);
            let reach = 0.1 * SCATTER[i % 3];
            let off = |p: &[f32; 3]| Vec3::from(*p) - Vec3::from(one.positions[i]);
            let tall = if i % 3 == 0 { reach / 3.0 } else { reach };
            let near =
                |p: &[f32; 3]| off(p).length() <= 1.001 * reach && off(p).y.abs() <= 1.001 * tall;
            assert!(copies.iter().all(near), "{copies:?}");
            assert!(copies[1..].iter().all(|p| off(p).length() > 0.0), "{copies:?}");
            assert_eq!(all.ages[5 * i..][..5], [one.ages[i]; 5]);
            assert_eq!(all.radii.as_ref().unwrap()[5 * i + 4], radii[i % 3]);
        }
        let mut ids = all.ids.clone().unwrap();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), 30);
        // At another index of the file, the same particle has the same copies.
        read.positions.reverse();
        read.ids.as_mut().unwrap().reverse();
        read.kinds.as_mut().unwrap().reverse();
        read.lifetimes.as_mut().unwrap().reverse();
        let turned = of(read, Some(drawn));
        assert_eq!(turned.positions[25..], all.positions[..5]);
    }

    /// The kind that is named on the command line overrides the kinds in the file. Without either, all is foam.
    #[test]
    fn a_named_kind_overrides_the_files() {
        let mut read = Particles::from_positions(vec![[0.0; 3]; 3]);
        let kinds = |read: &Particles, kind| {
            Part::new(read.clone(), kind, (Placing::default(), None, None), 0, 0.0).kinds
        };
        assert_eq!([None, Some(1)].map(|kind| kinds(&read, kind)), [[0; 3], [1; 3]]);
        read.kinds = Some(vec![0, 1, 2]);
        assert_eq!(
            [None, Some(1), Some(2)].map(|kind| kinds(&read, kind)),
            [[0, 1, 2], [1; 3], [2; 3]]
        );
    }

    /// Test: copies of moving spray lie along its motion; those of foam, and of spray at rest, lie as without velocities.
    #[test]
    fn copies_of_what_flies_are_a_strand() {
        let motion = Vec3::new(2.0, -1.0, 2.0);
        let mut read = Particles::from_positions(vec![[1.0; 3]; 4]);
        read.kinds = Some(vec![0, 0, 1, 1]);
        read.ids = Some(vec![6, 7, 8, 9]);
        let drawn = Some(Drawn { radii: [0.01; 3], copies: 64, spacing: 0.1 });
        let still = Part::new(read.clone(), None, (Placing::default(), None, drawn), 0, 0.0);
        let steep = Vec3::new(1.0, 2.0, -2.0);
        read.velocities =
            Some([Vec3::new(2.0, 0.1, 2.0), steep, motion, Vec3::ZERO].map(Into::into).to_vec());
        let moving = Part::new(read, None, (Placing::default(), None, drawn), 0, 0.0);
        assert_eq!(moving.positions[..64], still.positions[..64], "floating foam");
        assert_eq!(moving.positions[192..], still.positions[192..], "spray at rest");
        // Foam at rest is flat, foam that flies is not.
        for (motion, first, high) in [(steep, 64, 3.0), (motion, 128, 1.0)] {
            let both = moving.positions[first..first + 64].iter().zip(&still.positions[first..]);
            for (at, round) in both {
                let [at, round] = [at, round].map(|p| Vec3::from(*p) - Vec3::ONE);
                let round = round * Vec3::new(1.0, high, 1.0);
                // Parts of an offset along the motion and across it.
                let parts = |off: Vec3| [off.dot(motion) / 3.0, off.cross(motion).length() / 3.0];
                for (i, factor) in [2.0, 0.4].into_iter().enumerate() {
                    let difference = parts(at)[i] - factor * parts(round)[i];
                    assert!(difference.abs() < 1.0e-5, "{at} of {round}");
                }
            }
        }
    }

    #[test]
    fn columns_are_counted_by_kind() {
        let mut part = Particles::from_positions(vec![
            [0.1, 5.0, 0.2],
            [0.3, -9.0, 0.4],
            [0.1, 0.0, 0.9],
            [1.5, 0.0, 0.5],
            [-0.1, 0.0, 0.5],
            [0.5, 0.0, f32::NAN],
            [9.5, 0.0, 0.0],
        ]);
        part.kinds = Some(vec![0, 0, 1, 9, 0, 0, 0]);
        part.lifetimes = Some(vec![1.0, 1.0, 1.0, 1.0, 1.0, 1.0, -2.0]);
        let mut columns = Columns::default();
        let counted = |columns: &mut Columns, kind, up| {
            columns.add(&part, kind, Placing { up, ..Placing::default() }, 1.0);
            columns.end_frame();
            columns.means()
        };
        // Four foam particles in three columns; particles with NaN or without remaining lifetime count in none.
        assert_eq!(counted(&mut columns, None, Up::Y), [Some(4.0 / 3.0), Some(1.0), None]);
        assert_eq!(counted(&mut columns, None, Up::Y), [Some(4.0 / 3.0), Some(1.0), None]);
        let mut columns = Columns::default();
        assert_eq!(counted(&mut columns, Some(2), Up::Y), [None, None, Some(5.0 / 3.0)]);
        // In z-up files x and y are horizontal, so the particle without a z counts: four of the six particles are at
        // y = 0, in three columns, and the other two are in a column each.
        let mut columns = Columns::default();
        assert_eq!(counted(&mut columns, Some(0), Up::Z)[0], Some(6.0 / 5.0));
        // Two files of one frame count in the same columns.
        let mut columns = Columns::default();
        columns.add(&part, Some(0), Placing::default(), 1.0);
        assert_eq!(counted(&mut columns, Some(0), Up::Y)[0], Some(10.0 / 3.0));
    }

    #[test]
    fn files_are_named_with_their_kind() {
        let of = |kind, files: &str| Ok(Whitewater::Files { kind, files: files.into() });
        assert_eq!(named("a_%d.bgeo"), of(None, "a_%d.bgeo"));
        assert_eq!(named("foam=b*.ply"), of(Some(0), "b*.ply"));
        assert_eq!(named("spray=b*.ply"), of(Some(1), "b*.ply"));
        assert_eq!(named("bubble=b*.ply"), of(Some(2), "b*.ply"));
        assert_eq!(named("oil=b.ply"), of(None, "oil=b.ply"));
        assert_eq!(named("generate"), Ok(Whitewater::Generate));
        assert_eq!(named("./generate"), of(None, "./generate"));
        assert!(named("spray=").is_err() && named("").is_err());
    }
}
