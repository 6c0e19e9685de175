//! Reads the particles of a file in parts.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::asked::Asked;
use super::error::ReadError;
use super::format::{self, Extension};
use super::plan::{About, Pass, Plan, Surveyed, changed};
use super::rows::{self, Layout, Rows};
use super::source::{self, Content, Input, Piece, Source};
use super::{Format, Particles};
use super::{bgeo, comma, geo, lammps, numpy, ply, table, vtk_legacy, vtk_xml, xyz};

/// Number of bytes that suffice to detect the format.
const START: u64 = 1 << 16;

/// The particles of a file in parts. Together they are the particles that [`read`](super::read) returns.
///
/// The file is read twice. The first pass finds every error, so that no returned part has to be withdrawn
/// later. It also finds what only all particles together show: their number, attributes that have to be
/// dropped, warnings. The second pass returns the parts. If all particles fit in one part, the first pass keeps
/// that part, and there is no second pass.
///
/// Memory use is at most the sum of three amounts: 160 bytes per particle of a part, which includes one
/// previous part that is still in use; 2 MiB (4 MiB for VTK in gzip), or one particle's size in the file if
/// that is larger; and the file's header. For VTK XML, the header is all XML elements, without texts longer
/// than 64 characters. In addition, a block compressed with LZ4 or LZMA is decompressed as a whole, LZMA with a
/// dictionary of at most 64 MiB.
///
/// This limit holds for all formats except JSON, HDF5, XDMF, text in UTF-16 or with carriage returns alone as line
/// ends, NPY and NPZ arrays that store one component after the other (shape (n, 3) in Fortran order, (3, n) in C
/// order), NPZ in gzip or with a compression other than deflate, and VTK XML whose texts contain references (`&#32;`)
/// or CDATA.
/// Files of these kinds are read as a whole (see [`in_memory`](Self::in_memory)), except such VTK XML, which is read
/// in parts, but whose header is as long as the file. In VTK files, an attribute of cells is held as a whole if the
/// cells are in another order than the points, and the list of the cells' points if the points are also those of a
/// mesh. Because each attribute of a VTK file has a place of its own in the file, each pass decompresses gzip content
/// once per attribute.
pub struct Parts<'a> {
    about: Particles,
    total: usize,
    most: usize,
    rest: Rest<'a>,
    /// Path for error messages.
    path: Option<PathBuf>,
}

enum Rest<'a> {
    /// The second pass over the file, from its start.
    File(Box<(Plan<'a>, Option<Pass<'a>>)>),
    /// All particles, and the number that was returned so far.
    Memory(Box<Particles>, usize),
    /// After an error nothing more is returned.
    Failed,
}

impl Parts<'static> {
    /// Default number of particles per part.
    pub const USUAL: usize = 1 << 17;

    /// Opens a file to return its particles in parts of at most `most` particles each. The last part may have fewer.
    /// So may a part from which ghosts (copies of particles of other pieces) are left out; it may even be empty. A
    /// `most` of 0 counts as 1.
    ///
    /// # Errors
    /// Those of [`read`](super::read).
    pub fn open(path: &Path, most: usize) -> Result<Self, ReadError> {
        Self::open_with(path, most, |_| {})
    }

    /// Opens a file as [`open`](Self::open) does, and calls `show` with each part as soon as the first pass over the
    /// file has read it, so that a scan over all particles needs no extra pass. A part that is passed to `show` may
    /// have `ids` and `kinds` that are dropped later, and that the parts which the iterator returns lack. A file that
    /// cannot be read in parts is shown as one part.
    ///
    /// # Errors
    /// Those of [`read`](super::read). Some parts may have been shown before the error.
    pub fn open_with(
        path: &Path,
        most: usize,
        show: impl FnMut(&Particles),
    ) -> Result<Self, ReadError> {
        let io = |reason| ReadError::Io { path: path.to_path_buf(), reason };
        if std::fs::metadata(path).map_err(io)?.is_dir() {
            return Err(ReadError::Directory { path: path.to_path_buf() });
        }
        if let Some(pieces) = super::index::Pieces::of(path)? {
            let mut show = show;
            let parts = pieces
                .plan(&Asked::default())
                .and_then(|plan| Self::of_plan(plan, most, &mut show));
            let parts = parts.map_err(|error| pieces.fault(error))?;
            return Ok(Self { path: Some(path.to_path_buf()), ..parts });
        }
        #[cfg(feature = "hdf5")]
        if let Some(all) = super::of_hdf5(path, &Asked::default()) {
            let mut show = show;
            let parts = Self::of_memory(all?, most, &mut show);
            return Ok(Self { path: Some(path.to_path_buf()), ..parts });
        }
        let file = std::fs::File::open(path).map_err(io)?;
        let hint = Extension::from_path(path);
        let parts = Input::new(file).and_then(|input| Self::new(&input, hint, most, show));
        let parts = parts.map_err(|error| named(path, error))?;
        Ok(Self { path: Some(path.to_path_buf()), ..parts })
    }
}

/// The [`origin`](Particles::origin) of a file. If the file can be read in parts, only its header and its first
/// particles are read. The origin of the first frame suits a whole sequence, see [`Particles::move_to`].
///
/// # Errors
/// Those of [`read`](super::read); of a file that can be read in parts, only those that come before the particles.
pub fn find_origin(path: &Path) -> Result<[f64; 3], ReadError> {
    if let Some(pieces) = super::index::Pieces::of(path)? {
        return Ok(pieces.plan(&Asked::default())?.origin());
    }
    #[cfg(feature = "hdf5")]
    if let Some(all) = super::of_hdf5(path, &Asked::default()) {
        return Ok(all?.origin);
    }
    let io = |reason| ReadError::Io { path: path.to_path_buf(), reason };
    let input = Input::new(std::fs::File::open(path).map_err(io)?)?;
    let mut start = Vec::new();
    Source::new(&input, &input.whole(false)).fill(2, &mut start)?;
    let gzip = super::bytes::is_gzip(&start);
    let plan = plan(&input, Extension::from_path(path), gzip, &Asked::default())
        .map_err(|error| named(path, error))?;
    plan.map_or_else(|| Ok(super::read(path)?.origin), |plan| Ok(plan.origin()))
}

/// Adds the file's path to an error.
pub(super) fn named(path: &Path, error: ReadError) -> ReadError {
    let path = path.to_path_buf();
    match error {
        ReadError::Io { path: own, reason } if own.as_os_str().is_empty() => {
            ReadError::Io { path, reason }
        }
        error @ (ReadError::File { .. } | ReadError::Io { .. }) => error,
        error => ReadError::File { path, reason: Box::new(error) },
    }
}

impl<'a> Parts<'a> {
    /// Reads a file from memory, as [`read_bytes`](super::read_bytes) does.
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
        let planned = plan(input, hint, gzip, &Asked::default());
        let planned = planned
            .and_then(|plan| plan.map(|plan| Self::of_plan(plan, most, &mut show)).transpose());
        match planned {
            Ok(Some(parts)) => Ok(parts),
            Ok(None) => {
                let mut bytes = Vec::new();
                Source::new(input, &input.whole(false)).fill(u64::MAX, &mut bytes)?;
                let all = super::read_bytes(&bytes, hint)?;
                drop(bytes);
                Ok(Self::of_memory(all, most, &mut show))
            }
            Err(error) => {
                // If the compression is damaged, errors in the decompressed content are meaningless.
                if gzip {
                    Source::new(input, &input.whole(true)).finish()?;
                }
                Err(error)
            }
        }
    }

    fn of_memory(all: Particles, most: usize, show: &mut dyn FnMut(&Particles)) -> Self {
        show(&all);
        let about = Particles {
            attributes: all.attributes.clone(),
            meanings: all.meanings.clone(),
            warnings: all.warnings.clone(),
            ..slice(&all, 0..0)
        };
        let (total, most) = (all.positions.len(), most.max(1));
        Self { about, total, most, rest: Rest::Memory(Box::new(all), 0), path: None }
    }

    fn of_plan(
        mut plan: Plan<'a>,
        most: usize,
        show: &mut dyn FnMut(&Particles),
    ) -> Result<Self, ReadError> {
        let most = most.max(1);
        let Surveyed { about, rows, total, only } = plan.survey(most, show)?;
        plan.expect(rows);
        let rest = match only {
            Some(only) => Rest::Memory(Box::new(only), 0),
            None => Rest::File(Box::new((plan, None))),
        };
        Ok(Self { about, total, most, rest, path: None })
    }

    /// Total number of particles, without ghosts.
    pub fn total(&self) -> usize {
        self.total
    }

    /// What is known about all particles of the file, as a value without particles. An optional vector (velocities,
    /// ids and so on) is `Some`, but empty, if every part has it. Attributes and warnings of the file are only here;
    /// the parts list none.
    pub fn about(&self) -> &Particles {
        &self.about
    }

    /// Whether all particles are in memory, because they fit in one part or the file cannot be read in parts.
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
                    none => none.insert(plan.again()?),
                };
                let Some(mut part) = pass.part(plan, self.most)? else { return Ok(None) };
                if (self.about.ids.is_some() && part.ids.is_none())
                    || (self.about.kinds.is_some() && part.kinds.is_none())
                {
                    return Err(changed());
                }
                part.time = self.about.time;
                part.ids = part.ids.filter(|_| self.about.ids.is_some());
                part.kinds = part.kinds.filter(|_| self.about.kinds.is_some());
                Ok(Some(part))
            }
        }
    }
}

impl Iterator for Parts<'_> {
    type Item = Result<Particles, ReadError>;

    /// The next part. An error occurs only if the file has changed, or can no longer be read, since it was opened;
    /// after an error no part follows.
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

/// A range of the particles, without the data that concerns all of them.
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
        time: all.time,
        origin: all.origin,
        format: all.format,
        ..Particles::from_positions(some(Some(&all.positions), &range).unwrap_or_default())
    }
}

/// Detects the format of a file and plans how to read its particles in parts; `None` if this format can only be read
/// as a whole.
pub(super) fn plan<'a>(
    input: &Input<'a>,
    hint: Extension,
    gzip: bool,
    asked: &Asked,
) -> Result<Option<Plan<'a>>, ReadError> {
    let piece = input.whole(gzip);
    let mut start = Vec::new();
    Source::new(input, &piece).fill(START, &mut start)?;
    let all = (start.len() as u64) < START;
    // If the beginning is mostly white space, the format may be undetected; such files are not read in parts.
    if !all && start.trim_ascii_start().len() < start.len() / 2 {
        return Ok(None);
    }
    if format::as_lines(&start).is_some() {
        return Ok(None);
    }
    let reader = match format::detect(&start, hint) {
        Ok(reader) => reader,
        Err(told @ ReadError::Unsupported { .. }) => return Err(told),
        Err(_) => return Ok(None),
    };
    drop(start);
    let mut source = Source::new(input, &piece);
    let layout = match reader {
        format::Reader::Bgeo => Some(source::header(&mut source, |head| {
            let layout = bgeo::layout(head, gzip, asked)?;
            let length = layout.rows.header;
            Ok((layout, length))
        })?),
        format::Reader::Ply => {
            let layout = source::header(&mut source, |head| ply::layout(head, asked))?;
            let rows = layout.as_ref().map(|layout| &layout.rows);
            rows.map_or(Ok(()), |rows| ply::check_end(&Content::new(input, gzip)?, rows))?;
            layout
        }
        format::Reader::Npy => {
            let layout = source::header(&mut source, |head| numpy::layout(head, asked))?;
            numpy::check_end(&Content::new(input, gzip)?)?;
            layout
        }
        format::Reader::Npz if !gzip => {
            let Some(arrays) = numpy::arrays(input, asked)? else { return Ok(None) };
            let numpy::Arrays { rows, placed, attributes, warnings, time } = arrays;
            let about =
                About { placed, attributes, warnings, time, ..About::new(Format::Npz, asked) };
            return of_rows(input, rows, about).map(Some);
        }
        _ => None,
    };
    if let Some(Layout { rows, placed, attributes, warnings, format, .. }) = layout {
        let placed = placed.then_some(0);
        let about = About { placed, attributes, warnings, ..About::new(format, asked) };
        return of_rows(input, vec![(piece, rows)], about).map(Some);
    }
    let content = || Content::new(input, gzip);
    Ok(Some(match reader {
        format::Reader::Csv => table::plan(&content()?, comma::open, asked)?,
        format::Reader::XyzText => table::plan(&content()?, xyz::open, asked)?,
        format::Reader::Lammps => table::plan(&content()?, lammps::open, asked)?,
        format::Reader::XyzRaw => {
            let Layout { rows, attributes, format, .. } = xyz::raw(content()?.length(), asked)?;
            of_rows(
                input,
                vec![(piece, rows)],
                About { placed: Some(0), attributes, ..About::new(format, asked) },
            )?
        }
        format::Reader::Geo => table::plan(&content()?, geo::open, asked)?,
        format::Reader::Ply => table::plan(&content()?, ply::open, asked)?,
        format::Reader::VtkLegacy => vtk_legacy::plan(&content()?, asked)?,
        format::Reader::VtkXml => vtk_xml::plan(&content()?, asked)?,
        _ => return Ok(None),
    }))
}

/// Makes the plan by which particles are read that lie in rows of equal length: one row per particle in one file, or
/// in several arrays of a zip file, whose rows are read side by side.
fn of_rows<'a>(
    input: &Input<'a>,
    rows: Vec<(Piece, Rows)>,
    about: About,
) -> Result<Plan<'a>, ReadError> {
    let tracks = rows.into_iter().map(|(piece, rows)| {
        let input = input.clone();
        rows::track(rows, move |rows| {
            let mut source = Source::new(&input, &piece);
            source.skip(rows.header, "the header")?;
            for (what, length) in &rows.between {
                source.skip(*length, what)?;
            }
            Ok(source)
        })
    });
    Plan::new(tracks.collect(), about, input.unpack_limit())
}
