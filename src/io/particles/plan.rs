//! A plan to read the particles of a file in order, any number of times: all at once, or in parts.

use super::asked::Asked;
use super::columns::{Attribute, AttributeType, Column, Data, Roles, Shape};
use super::error::{Place, ReadError};
use super::meaning::Meaning;
use super::survey::{Columns, FIRST, Survey};
use super::{Format, Particles};

/// Bytes read at a time.
pub(super) const CHUNK: u64 = 1 << 18;

/// Particles read at a time in the check for errors.
const CHECKED: usize = 1 << 12;
/// Particles read at a time to find their times.
const PART: usize = 1 << 16;

/// Columns that are stored together in a file. Several tracks hold different columns of the same particles; they can
/// be read side by side, a part of the particles at a time.
pub(super) struct Track<'a> {
    /// Empty columns.
    pub(super) columns: Vec<Column>,
    /// Number of values per column for all particles; `None` if it is only known after reading.
    pub(super) lengths: Option<Vec<u64>>,
    /// Name for messages.
    pub(super) what: String,
    /// Opens a stream at the first particle, for the columns that are used.
    pub(super) open: Box<OpenTrack<'a>>,
}

type OpenTrack<'a> = dyn Fn(&[bool]) -> Result<Box<dyn Stream + 'a>, ReadError> + Send + 'a;

/// Reads a track.
pub(super) trait Stream: Send {
    /// Appends the values of up to `count` next particles to the columns that are used, and returns their number, which
    /// is less than `count` only at the end. `room` is scratch memory.
    fn read(
        &mut self,
        count: usize,
        columns: &mut [Column],
        room: &mut Vec<u8>,
    ) -> Result<usize, ReadError>;

    /// Checks what follows the last particle in the file, after all have been read. Returns the number of bytes
    /// decompressed for this track if that is limited for all tracks together, otherwise 0.
    fn finish(&mut self) -> Result<u64, ReadError> {
        Ok(0)
    }

    /// Warnings after the last particle.
    fn told(&mut self) -> Vec<String> {
        Vec::new()
    }
}

/// Where the particles of a file are, and their attributes.
pub(super) struct Plan<'a> {
    tracks: Vec<Track<'a>>,
    /// For the columns of all tracks, whether they are used.
    used: Vec<bool>,
    roles: Roles,
    /// Number of particles; `None` if it is only known after reading.
    rows: Option<usize>,
    attributes: Vec<Attribute>,
    meanings: Vec<(Meaning, Vec<String>)>,
    warnings: Vec<String>,
    time: Option<f64>,
    format: Format,
    /// Max number of bytes that all tracks together may decompress to.
    limit: u64,
    /// Time of the requested frame, if the file has a column with the time of each particle. Particles of other times
    /// are left out. `None`: all particles are kept.
    only: Option<f64>,
}

/// What a header says besides the place of the particles.
pub(super) struct About {
    /// Index of the column with the positions, if the format stores them apart.
    pub(super) placed: Option<usize>,
    pub(super) attributes: Vec<Attribute>,
    pub(super) warnings: Vec<String>,
    /// Time of the frame.
    pub(super) time: Option<f64>,
    pub(super) format: Format,
    pub(super) asked: Asked,
}

impl About {
    pub(super) fn new(format: Format, asked: &Asked) -> Self {
        Self {
            placed: None,
            attributes: Vec::new(),
            warnings: Vec::new(),
            time: None,
            format,
            asked: asked.clone(),
        }
    }

    /// Lists an attribute and returns whether its values are wanted.
    pub(super) fn list(&mut self, name: &str, components: usize, ty: AttributeType) -> bool {
        self.asked.list(&mut self.attributes, name, components, ty)
    }
}

/// Result of the first pass over all particles.
pub(super) struct Surveyed {
    /// What all particles have in common, without particles.
    pub(super) about: Particles,
    /// Number of particles in the file, and of those that are no ghosts.
    pub(super) rows: usize,
    pub(super) total: usize,
    /// All particles, if they fit in one part.
    pub(super) only: Option<Particles>,
}

impl<'a> Plan<'a> {
    pub(super) fn new(tracks: Vec<Track<'a>>, about: About, limit: u64) -> Result<Self, ReadError> {
        let About { placed, attributes, mut warnings, time, format, asked } = about;
        let shapes: Vec<_> = tracks.iter().flat_map(shapes).collect();
        let roles = Roles::find(&shapes, placed, &attributes, &asked)?;
        let meanings = roles.meanings(&shapes, &attributes);
        warnings.extend(roles.warnings());
        let known = tracks.iter().all(|track| track.lengths.is_some());
        let rows = if known { Some(roles.rows(&shapes)?) } else { None };
        let only = roles.steps.and_then(|_| asked.step()?.time);
        let mut used = vec![false; shapes.len()];
        for i in roles.used() {
            used.get_mut(i).into_iter().for_each(|used| *used = true);
        }
        Ok(Self {
            tracks,
            used,
            roles,
            rows,
            attributes,
            meanings,
            warnings,
            time,
            format,
            limit,
            only,
        })
    }

    /// Each track, with the columns of it that are used.
    fn tracks(&self) -> impl Iterator<Item = (&Track<'a>, &[bool])> {
        let mut used = self.used.as_slice();
        self.tracks.iter().map(move |track| {
            let (own, rest) = used.split_at_checked(track.columns.len()).unwrap_or_default();
            used = rest;
            (track, own)
        })
    }

    /// The origin to subtract from all positions. The first positions of the file determine it, so that all parts
    /// of a file get the same one.
    pub(super) fn origin(&self) -> [f64; 3] {
        let positions: Vec<usize> = self.roles.positions.columns().collect();
        let all = || self.tracks.iter().flat_map(|track| &track.columns);
        let exact = |(i, column): (usize, &Column)| {
            positions.contains(&i) && !matches!(column.data, Data::F32(_))
        };
        if !all().enumerate().any(exact) {
            return [0.0; 3];
        }
        let (mut columns, mut room) = (Vec::new(), Vec::new());
        let count = self.rows.unwrap_or(usize::MAX).min(FIRST);
        for (track, used) in self.tracks() {
            let first = columns.len();
            let some: Vec<bool> =
                used.iter().enumerate().map(|(i, _)| positions.contains(&(first + i))).collect();
            let mut own = track.columns.clone();
            if some.contains(&true) {
                // The error will occur again when everything is read.
                let read = (track.open)(&some).and_then(|mut s| s.read(count, &mut own, &mut room));
                if read.is_err() {
                    return [0.0; 3];
                }
            }
            columns.append(&mut own);
        }
        Columns::new(columns).origin(&self.roles)
    }

    /// Starts a pass at the first particle.
    fn start(&self) -> Result<Pass<'a>, ReadError> {
        let streams = self.tracks().map(|(track, used)| (track.open)(used));
        Ok(Pass {
            streams: streams.collect::<Result<_, _>>()?,
            left: self.rows.unwrap_or(usize::MAX),
            survey: Survey::new(self.origin()).of_time(self.only),
            room: Vec::new(),
        })
    }

    /// Starts a pass like [`start`](Self::start), after the survey.
    pub(super) fn again(&self) -> Result<Pass<'a>, ReadError> {
        let Pass { streams, left, survey, room } = self.start()?;
        Ok(Pass { streams, left, survey: survey.again(), room })
    }

    /// Reads all particles, track after track.
    pub(super) fn read(self) -> Result<Particles, ReadError> {
        let mut columns = Vec::new();
        let count = self.rows.unwrap_or(usize::MAX);
        let (mut room, mut told) = (Vec::new(), Vec::new());
        for (track, used) in self.tracks() {
            let mut own = track.columns.clone();
            let mut stream = (track.open)(used)?;
            stream.read(count, &mut own, &mut room)?;
            stream.finish()?;
            told.extend(stream.told());
            columns.append(&mut own);
        }
        let columns = Columns::new(columns);
        let mut survey = Survey::new(columns.origin(&self.roles)).of_time(self.only);
        let mut particles = survey.part(&self.roles, columns, self.format);
        survey.drop_from(&mut particles);
        let mut warnings = self.warnings;
        warnings.extend(told);
        warnings.extend(survey.finish()?);
        let time = self.time.or(survey.time());
        let (attributes, mut meanings) = (self.attributes, self.meanings);
        survey.settle(&mut meanings);
        Ok(Particles { attributes, meanings, warnings, time, ..particles })
    }

    /// Finds all errors, and everything that depends on all particles.
    pub(super) fn survey(
        &self,
        most: usize,
        show: &mut dyn FnMut(&Particles),
    ) -> Result<Surveyed, ReadError> {
        self.survey_once(most, show).map_err(|error| {
            // If there are several errors, report the one that reading all at once would find.
            if self.tracks.len() > 1 { self.check().err().unwrap_or(error) } else { error }
        })
    }

    fn survey_once(
        &self,
        most: usize,
        show: &mut dyn FnMut(&Particles),
    ) -> Result<Surveyed, ReadError> {
        let columns = self.tracks.iter().flat_map(|track| track.columns.clone()).collect();
        let columns = Columns::new(columns);
        let mut pass = self.start()?;
        let mut about = Survey::new(pass.survey.origin()).of_time(self.only).part(
            &self.roles,
            columns,
            self.format,
        );
        let mut only = Some(about.clone());
        let mut first = true;
        while let Some(part) = pass.part(self, most)? {
            show(&part);
            only = Some(part).filter(|_| first);
            first = false;
        }
        pass.finish(self)?;
        pass.survey.drop_from(&mut about);
        about.attributes.clone_from(&self.attributes);
        about.meanings.clone_from(&self.meanings);
        pass.survey.settle(&mut about.meanings);
        about.warnings.clone_from(&self.warnings);
        about.warnings.extend(pass.streams.iter_mut().flat_map(|stream| stream.told()));
        about.warnings.extend(pass.survey.finish()?);
        about.time = self.time.or(pass.survey.time());
        let (rows, total) = (pass.survey.seen(), pass.survey.kept());
        only.iter_mut().for_each(|only| {
            pass.survey.drop_from(only);
            only.time = about.time;
        });
        Ok(Surveyed { about, rows, total, only })
    }

    /// The sorted times of the frames in the file; empty if there is one frame.
    pub(super) fn times(&self) -> Result<Vec<f64>, ReadError> {
        if self.roles.steps.is_none() {
            return Ok(Vec::new());
        }
        let mut pass = self.start()?;
        while pass.part(self, PART)?.is_some() {}
        Ok(pass.survey.times())
    }

    /// Sets the number of particles that must be read.
    pub(super) fn expect(&mut self, rows: usize) {
        self.rows = Some(rows);
    }

    /// Reads everything, track after track, and drops it.
    fn check(&self) -> Result<(), ReadError> {
        let mut room = Vec::new();
        for (track, used) in self.tracks() {
            let mut columns = track.columns.clone();
            let mut stream = (track.open)(used)?;
            let mut left = self.rows.unwrap_or(usize::MAX);
            while left > 0 {
                let count = left.min(CHECKED);
                if stream.read(count, &mut columns, &mut room)? < count {
                    break;
                }
                left -= count;
                columns.iter_mut().for_each(|column| column.data.clear());
            }
            stream.finish()?;
        }
        Ok(())
    }
}

fn shapes<'a>(track: &'a Track<'_>) -> impl Iterator<Item = Shape<'a>> {
    track.columns.iter().enumerate().map(|(i, column)| Shape {
        name: &column.name,
        components: column.components,
        values: track.lengths.as_ref().and_then(|all| all.get(i).copied()).unwrap_or(0),
    })
}

/// Error: the file has changed since the survey.
pub(super) fn changed() -> ReadError {
    let expected = "the numbers of the first reading";
    ReadError::malformed(expected, "others", Place::Unknown)
}

/// One pass over a file.
pub(super) struct Pass<'a> {
    streams: Vec<Box<dyn Stream + 'a>>,
    /// Upper bound of the particles left.
    left: usize,
    survey: Survey,
    room: Vec<u8>,
}

impl Pass<'_> {
    /// The next `most` particles, fewer at the end; `None` after the last.
    pub(super) fn part(
        &mut self,
        plan: &Plan<'_>,
        most: usize,
    ) -> Result<Option<Particles>, ReadError> {
        let wanted = most.min(self.left);
        let mut count = wanted;
        let mut columns = Vec::new();
        for (stream, track) in self.streams.iter_mut().zip(&plan.tracks) {
            if count == 0 {
                break;
            }
            let mut own = track.columns.clone();
            count = count.min(stream.read(wanted, &mut own, &mut self.room)?);
            columns.append(&mut own);
        }
        // All columns get the same length, even if the file was changed meanwhile.
        let whole = |(column, used): (&Column, &bool)| {
            !used || column.data.len() == count.saturating_mul(column.components)
        };
        if (count < wanted && plan.rows.is_some()) || !columns.iter().zip(&plan.used).all(whole) {
            return Err(changed());
        }
        self.left = if count < wanted { 0 } else { self.left - count };
        Ok((count > 0).then(|| self.survey.part(&plan.roles, Columns::new(columns), plan.format)))
    }

    fn finish(&mut self, plan: &Plan<'_>) -> Result<(), ReadError> {
        let mut unpacked = 0_u64;
        for (stream, track) in self.streams.iter_mut().zip(&plan.tracks) {
            unpacked = unpacked.saturating_add(stream.finish()?);
            if unpacked > plan.limit {
                return Err(ReadError::TooLarge { what: track.what.clone(), limit: plan.limit });
            }
        }
        Ok(())
    }
}
