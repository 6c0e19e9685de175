//! Particles of a file a part after the other.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::columns::{Attribute, Column, Roles, Shape, Survey};
use super::error::{Place, ReadError};
use super::format::{self, Extension};
use super::rows::{Layout, Rows};
use super::source::{self, Input, Piece, Source, truncated};
use super::{Format, Particles, bgeo, numpy, ply};

/// Bytes that are read at a time.
const CHUNK: u64 = 1 << 18;

/// The particles of a file, a part after the other: together they are those that [`read`](super::read) gives.
///
/// The file is read twice. The first time finds all there is to find fault with, so that nothing has to be undone
/// later, and what only all particles tell: whether an attribute has to be dropped, what a user should know. The second
/// time gives the parts. Where all particles fit into one part it is kept from the first time.
///
/// In memory are 160 bytes at most for each particle of a part, one part that was given before among them; 2 MiB, or one
/// particle as it lies in the file where that is larger; and the header of the file. This holds for classic BGEO, binary
/// PLY without lists before or in its vertices, NPY and NPZ of arrays in C order; all but NPZ also within gzip. Other
/// files are read as a whole: see [`in_memory`](Self::in_memory).
pub struct Parts<'a> {
    about: Particles,
    total: usize,
    most: usize,
    rest: Rest<'a>,
    /// Of a file, for its errors.
    path: Option<PathBuf>,
}

enum Rest<'a> {
    /// The second time, from its start on.
    File(Box<(Plan<'a>, Option<Pass<'a>>)>),
    /// All particles, and how many were given.
    Memory(Particles, usize),
    /// Nothing comes after an error.
    Failed,
}

impl Parts<'static> {
    /// Particles of a part where nothing speaks for another number.
    pub const USUAL: usize = 1 << 17;

    /// Opens a file for parts of `most` particles, of which the last may have fewer; 0 is taken as 1.
    ///
    /// # Errors
    /// Those of [`read`](super::read).
    pub fn open(path: &Path, most: usize) -> Result<Self, ReadError> {
        Self::open_with(path, most, |_| {})
    }

    /// The same, and shows each part as it is when it is read for the first time: what is looked for in all particles
    /// takes no time of its own. Of a part that is shown `ids` and `kinds` may be there that are dropped in the end; of a
    /// file that can't be read in parts all particles are shown as one.
    ///
    /// # Errors
    /// Those of [`read`](super::read), after some parts were shown.
    pub fn open_with(
        path: &Path,
        most: usize,
        show: impl FnMut(&Particles),
    ) -> Result<Self, ReadError> {
        let io = |reason| ReadError::Io { path: path.to_path_buf(), reason };
        if std::fs::metadata(path).map_err(io)?.is_dir() {
            return Err(ReadError::Directory { path: path.to_path_buf() });
        }
        let file = std::fs::File::open(path).map_err(io)?;
        let hint = Extension::from_path(path);
        let parts = Input::new(file).and_then(|input| Self::new(&input, hint, most, show));
        let parts = parts.map_err(|error| named(path, error))?;
        Ok(Self { path: Some(path.to_path_buf()), ..parts })
    }
}

/// An error with the file it is about.
fn named(path: &Path, error: ReadError) -> ReadError {
    let path = path.to_path_buf();
    match error {
        ReadError::Io { reason, .. } => ReadError::Io { path, reason },
        error => ReadError::File { path, reason: Box::new(error) },
    }
}

impl<'a> Parts<'a> {
    /// Reads a file that lies in memory, as [`read_bytes`](super::read_bytes) does.
    ///
    /// # Errors
    /// Those of [`read_bytes`](super::read_bytes).
    pub fn of_bytes(bytes: &'a [u8], hint: Extension, most: usize) -> Result<Self, ReadError> {
        Self::new(&Input::new(std::io::Cursor::new(bytes))?, hint, most, |_| {})
    }

    fn new(
        input: &Input<'a>,
        hint: Extension,
        most: usize,
        mut show: impl FnMut(&Particles),
    ) -> Result<Self, ReadError> {
        let most = most.max(1);
        let mut start = Vec::new();
        Source::new(input, &input.whole(false)).fill(2, &mut start)?;
        let gzip = super::bytes::is_gzip(&start);
        let surveyed = Plan::new(input, hint, gzip).and_then(|plan| {
            let Some(plan) = plan else { return Ok(None) };
            let first = plan.survey(most, &mut show)?;
            Ok(Some((plan, first)))
        });
        match surveyed {
            Ok(Some((plan, Surveyed { mut about, only }))) => {
                let total = plan.rows;
                about.attributes.clone_from(&plan.attributes);
                let rest = match only {
                    Some(only) => Rest::Memory(only, 0),
                    None => Rest::File(Box::new((plan, None))),
                };
                Ok(Self { about, total, most, rest, path: None })
            }
            Ok(None) => {
                let mut bytes = Vec::new();
                Source::new(input, &input.whole(false)).fill(u64::MAX, &mut bytes)?;
                let all = super::read_bytes(&bytes, hint)?;
                drop(bytes);
                show(&all);
                let about = Particles {
                    attributes: all.attributes.clone(),
                    warnings: all.warnings.clone(),
                    ..slice(&all, 0..0)
                };
                let total = all.positions.len();
                Ok(Self { about, total, most, rest: Rest::Memory(all, 0), path: None })
            }
            Err(error) => {
                // Where the packing is at fault it is no use to look for faults in what comes out.
                if gzip {
                    Source::new(input, &input.whole(true)).finish()?;
                }
                Err(error)
            }
        }
    }

    /// Particles of all parts together.
    pub fn total(&self) -> usize {
        self.total
    }

    /// What all particles have in common: a list is there, without any particles, where each part has it; format,
    /// attributes and warnings are those of the file, and parts have no attributes and warnings of their own.
    pub fn about(&self) -> &Particles {
        &self.about
    }

    /// Whether all particles are in memory: a file of few, or of a format that can't be read in parts.
    pub fn in_memory(&self) -> bool {
        matches!(self.rest, Rest::Memory(..))
    }

    fn part(&mut self) -> Result<Option<Particles>, ReadError> {
        match &mut self.rest {
            Rest::Memory(all, given) => {
                let part = *given..self.total.min(given.saturating_add(self.most));
                *given = part.end;
                Ok((!part.is_empty()).then(|| slice(all, part)))
            }
            Rest::Failed => Ok(None),
            Rest::File(file) => {
                let (plan, pass) = file.as_mut();
                let pass = match pass {
                    Some(pass) => pass,
                    none => none.insert(plan.start()?),
                };
                let Some(mut part) = pass.part(plan, self.most)? else { return Ok(None) };
                if (self.about.ids.is_some() && part.ids.is_none())
                    || (self.about.kinds.is_some() && part.kinds.is_none())
                {
                    let expected = "the numbers that were there a moment ago";
                    return Err(ReadError::malformed(expected, "others", Place::Unknown));
                }
                part.ids = part.ids.filter(|_| self.about.ids.is_some());
                part.kinds = part.kinds.filter(|_| self.about.kinds.is_some());
                Ok(Some(part))
            }
        }
    }
}

impl Iterator for Parts<'_> {
    type Item = Result<Particles, ReadError>;

    /// The next part; after an error there are no more. There is one only where the file is not any more what it was
    /// when it was opened.
    fn next(&mut self) -> Option<Self::Item> {
        let part = self.part().map_err(|error| {
            self.rest = Rest::Failed;
            match &self.path {
                Some(path) => named(path, error),
                None => error,
            }
        });
        part.transpose()
    }
}

impl std::fmt::Debug for Parts<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Parts")
            .field("about", &self.about)
            .field("total", &self.total)
            .field("most", &self.most)
            .finish_non_exhaustive()
    }
}

/// Some of the particles, without what is of all of them.
fn slice(all: &Particles, range: Range<usize>) -> Particles {
    fn some<T: Copy>(list: Option<&Vec<T>>, range: &Range<usize>) -> Option<Vec<T>> {
        list.map(|list| list.get(range.clone()).unwrap_or_default().to_vec())
    }
    Particles {
        velocities: some(all.velocities.as_ref(), &range),
        densities: some(all.densities.as_ref(), &range),
        ids: some(all.ids.as_ref(), &range),
        lifetimes: some(all.lifetimes.as_ref(), &range),
        kinds: some(all.kinds.as_ref(), &range),
        format: all.format,
        ..Particles::from_positions(some(Some(&all.positions), &range).unwrap_or_default())
    }
}

/// What the header of a file says: where its particles are, and what they have.
struct Plan<'a> {
    input: Input<'a>,
    /// The rows of a file, or the arrays of a zip, side by side.
    streams: Vec<(Piece, Rows)>,
    roles: Roles,
    rows: usize,
    attributes: Vec<Attribute>,
    format: Format,
}

/// What was found when a file was read for the first time.
struct Surveyed {
    about: Particles,
    /// All particles, where they are one part.
    only: Option<Particles>,
}

impl<'a> Plan<'a> {
    /// None of a file that can't be read in parts.
    fn new(input: &Input<'a>, hint: Extension, gzip: bool) -> Result<Option<Self>, ReadError> {
        let piece = input.whole(gzip);
        let mut source = Source::new(input, &piece);
        let mut start = Vec::new();
        source.fill(1 << 16, &mut start)?;
        // What that is not enough to tell is no file of rows.
        let Ok(reader) = format::detect(&start, hint) else { return Ok(None) };
        drop(start);
        let mut source = Source::new(input, &piece);
        let layout = match reader {
            format::Reader::Bgeo => Some(source::header(&mut source, |head| {
                let layout = bgeo::layout(head, gzip)?;
                let length = layout.rows.header;
                Ok((layout, length))
            })?),
            format::Reader::Ply => source::header(&mut source, ply::layout)?,
            format::Reader::Npy => source::header(&mut source, numpy::layout)?,
            format::Reader::Npz if !gzip => {
                let Some(arrays) = numpy::arrays(input)? else { return Ok(None) };
                let numpy::Arrays { rows, attributes } = arrays;
                return Self::of(input, rows, None, attributes, Format::Npz).map(Some);
            }
            _ => None,
        };
        let Some(Layout { rows, placed, attributes, format }) = layout else { return Ok(None) };
        Self::of(input, vec![(piece, rows)], placed.then_some(0), attributes, format).map(Some)
    }

    fn of(
        input: &Input<'a>,
        mut streams: Vec<(Piece, Rows)>,
        placed: Option<usize>,
        attributes: Vec<Attribute>,
        format: Format,
    ) -> Result<Self, ReadError> {
        let shapes: Vec<Shape<'_>> = streams.iter().flat_map(|(_, rows)| rows.shapes()).collect();
        let roles = Roles::find(&shapes, placed, &attributes)?;
        let rows = roles.rows(&shapes)?;
        let used: Vec<_> = roles.used().collect();
        let fields = streams.iter_mut().flat_map(|(_, rows)| &mut rows.fields);
        for (i, field) in fields.enumerate() {
            field.wanted = used.contains(&i);
        }
        Ok(Self { input: input.clone(), streams, roles, rows, attributes, format })
    }

    /// From the first row on.
    fn start(&self) -> Result<Pass<'a>, ReadError> {
        let streams = self.streams.iter().map(|(piece, rows)| {
            let mut source = Source::new(&self.input, piece);
            source.skip(rows.header, "the header")?;
            for (what, length) in &rows.between {
                source.skip(*length, what)?;
            }
            source.require(rows.bytes(), &rows.what)?;
            Ok::<_, ReadError>(Stream { first: source.at(), source })
        });
        let streams = streams.collect::<Result<_, _>>()?;
        Ok(Pass { streams, left: self.rows, survey: Survey::new(self.rows), raw: Vec::new() })
    }

    /// Reads all of it.
    fn survey(&self, most: usize, mut show: impl FnMut(&Particles)) -> Result<Surveyed, ReadError> {
        let columns = self.streams.iter().flat_map(|(_, rows)| rows.columns()).collect();
        let mut about = Survey::new(0).part(&self.roles, columns, self.format);
        let mut pass = self.start()?;
        let mut only = (self.rows == 0).then(|| about.clone());
        while let Some(part) = pass.part(self, most)? {
            show(&part);
            only = (self.rows <= most).then_some(part);
        }
        pass.finish(self)?;
        pass.survey.drop_from(&mut about);
        about.warnings = pass.survey.warnings();
        Ok(Surveyed { about, only })
    }
}

/// The rows of one piece, on the way.
struct Stream<'a> {
    source: Source<'a>,
    /// Where the rows begin.
    first: u64,
}

impl Stream<'_> {
    /// The numbers of the next rows; `raw`: room for their bytes.
    fn columns(
        &mut self,
        rows: &Rows,
        count: usize,
        raw: &mut Vec<u8>,
    ) -> Result<Vec<Column>, ReadError> {
        let mut columns = rows.columns();
        if !rows.fields.iter().any(|field| field.wanted) {
            return Ok(columns);
        }
        let stride = rows.stride.max(1);
        // A header that lies about more than the file can hold gets no room for it.
        let most = usize::try_from(self.source.most_left() / stride).unwrap_or(usize::MAX);
        let mut left = count as u64;
        while left > 0 {
            let taken = left.min((CHUNK / stride).max(1));
            let bytes = taken.saturating_mul(stride);
            raw.clear();
            self.source.fill(bytes, raw)?;
            if (raw.len() as u64) < bytes {
                return Err(self.ended(rows));
            }
            rows.decode(raw, count.min(most), &mut columns);
            left -= taken;
        }
        Ok(columns)
    }

    fn ended(&self, rows: &Rows) -> ReadError {
        truncated(&rows.what, self.first, rows.bytes(), self.source.at() - self.first)
    }
}

/// Once through a file.
struct Pass<'a> {
    streams: Vec<Stream<'a>>,
    /// Particles that are still to come.
    left: usize,
    survey: Survey,
    raw: Vec<u8>,
}

impl Pass<'_> {
    fn part(&mut self, plan: &Plan<'_>, most: usize) -> Result<Option<Particles>, ReadError> {
        let count = most.min(self.left);
        if count == 0 {
            return Ok(None);
        }
        let mut columns = Vec::new();
        for (stream, (_, rows)) in self.streams.iter_mut().zip(&plan.streams) {
            columns.extend(stream.columns(rows, count, &mut self.raw)?);
        }
        self.left -= count;
        Ok(Some(self.survey.part(&plan.roles, columns, plan.format)))
    }

    /// After the last part: what comes behind it has to be sound too.
    fn finish(&mut self, plan: &Plan<'_>) -> Result<(), ReadError> {
        let mut unpacked = 0_u64;
        for (stream, (piece, rows)) in self.streams.iter_mut().zip(&plan.streams) {
            // Of an array that has no meaning nothing was read yet.
            let unread = rows.bytes().saturating_sub(stream.source.at() - stream.first);
            stream.source.skip(unread, &rows.what)?;
            stream.source.finish()?;
            unpacked = unpacked.saturating_add(stream.source.at());
            let limit = plan.input.unpack_limit();
            if unpacked > limit && plan.streams.len() > 1 {
                return Err(ReadError::TooLarge { what: piece.what.clone(), limit });
            }
        }
        Ok(())
    }
}
