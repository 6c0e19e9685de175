//! Particle caches: the files that SPH solvers, Houdini, ParaView and NumPy write.
//!
//! [`read`] reads one file into [`Particles`]. [`sequence`] expands user input (a file, a glob or a `%04d`
//! pattern) to numbered frames. [`estimate_spacing`] and [`estimate_densities`] estimate rest spacing and
//! densities that a file lacks. [`write()`] writes four of the formats.
//!
//! | format | read | written |
//! | --- | --- | --- |
//! | classic Houdini BGEO v5, plain or gzip | yes | yes |
//! | classic Houdini GEO v5 (ASCII) | yes | |
//! | Houdini 12+ BGEO / GEO (JSON), `.bgeo.sc` | refused, with advice | |
//! | legacy VTK 1.0 to 5.1, ASCII and binary: POLYDATA, UNSTRUCTURED_GRID | points, their data, data of vertex cells | |
//! | PVTU, PVTP, VTM: their pieces, as one frame; PVD, `.series`: see [`sequence`] | yes | |
//! | VTU, VTP: ASCII, inline base64, appended base64 or raw; none, zlib, LZ4, LZMA | points, their data, data of vertex cells | VTU, appended raw, zlib |
//! | PLY: ASCII, binary little and big endian | vertices | binary little endian |
//! | NPY, NPZ: integers and floats of 1 to 8 bytes, both byte orders, structured, (n, 3) and (3, n) | yes | NPZ |
//! | CSV (names of ParaView, DualSPHysics ..., or `x,y,z`), Tecplot, XYZ text, extended XYZ, XYZ raw `f32` triples | yes | |
//! | JSON: arrays, objects of arrays, arrays of objects, lines | yes | |
//! | dumps of LAMMPS and LIGGGHTS, text; positions also scaled, in a box of any shape | yes | |
//! | HDF5 (VTKHDF, PySPH, H5Part, H5MD, arrays in a group) and XDMF | with the feature `hdf5` | |
//!
//! [`Parts`] returns the particles of a file of any of these formats in parts, so that the file may be larger than
//! memory. Exceptions, which it still loads as a whole first, are JSON, HDF5, XDMF and the rare variants of other
//! formats that its documentation lists.
//!
//! A file may be compressed with gzip, and its content decides the format; the extension is only a hint. XDMF and files
//! that list others (PVTU, PVTP, VTM, PVD, `.series`) are exceptions: they need their extension and must not be
//! compressed. Case, blanks, `_ - . :` and units in the names of attributes are ignored: `Pos.x [m]` is `pos_x`. A
//! valid file of something else than particles, or of several frames, is refused: the error says what it is and what to
//! do. Ambiguous interpretations, such as that of a mesh's vertices as particles, are reported in
//! [`Particles::warnings`].
//!
//! Lengths and times keep the file's units; nothing is scaled or reordered. Ghosts (copies of particles that
//! belong to another piece of the file) are left out. An origin is subtracted only from double-precision
//! positions that are very far away ([`Particles::origin`]).
//!
//! A reader never panics and trusts no count in a header: it allocates in proportion to the file's actual size. Content
//! that decompresses to more than 16 MiB + 64 times the file's size is refused.
#![forbid(unsafe_code)]
#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::indexing_slicing)]

mod arrays;
mod asked;
mod bgeo;
mod blocks;
mod bytes;
mod cells;
mod columns;
mod comma;
mod encoded;
mod error;
mod foreign;
mod format;
mod geo;
#[cfg(feature = "hdf5")]
mod hdf5;
mod head;
mod heading;
mod index;
mod join;
mod json;
mod json_frames;
mod json_places;
mod lammps;
mod meaning;
mod names;
mod npy_header;
mod numbered;
mod numpy;
mod parts;
mod plan;
mod ply;
mod rows;
pub mod sequence;
mod source;
mod spacing;
mod steps;
mod survey;
mod table;
mod tecplot;
mod text;
mod vtk_legacy;
mod vtk_xml;
mod write;
#[cfg(feature = "hdf5")]
mod xdmf;
mod xyz;

use std::io::Read as _;
use std::path::Path;

use asked::Asked;
pub use columns::{Attribute, AttributeType, Extra};
pub use error::{Place, ReadError, WriteError};
pub use format::{Compression, Extension, Format, Storage, WriteFormat};
pub use heading::LENGTH_UNITS;
pub use meaning::Meaning;
pub use parts::{Parts, find_origin};
pub use spacing::{estimate_densities, estimate_spacing};
pub use steps::{Step, read_step, steps};
pub use write::{write, write_to};

/// One frame of particles as read from a file.
///
/// The lists of values (positions, velocities and so on) that the file has are equally long, one value per particle, in
/// the order of the particles in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Particles {
    /// Centres, in the file's unit of length. They may contain NaN or infinities, see [`count_non_finite`].
    pub positions: Vec<[f32; 3]>,
    /// Velocities, in the file's unit of length per unit of time.
    pub velocities: Option<Vec<[f32; 3]>>,
    /// Mass densities, in the file's unit.
    pub densities: Option<Vec<f32>>,
    /// Ids: integers that identify a particle from frame to frame. Ids beyond 32 bits are hashed to 32. All ids are
    /// dropped, with a warning, if any is negative, no whole number, or too large to be exact, or if more than 1 % of
    /// them repeat (more in a file in which positions repeat too).
    pub ids: Option<Vec<u32>>,
    /// Remaining lifetime of whitewater particles. A particle whose lifetime is zero or less dies with the next
    /// frame. Where a file has the attributes `life` and `age`, as Houdini writes them, it is their difference.
    pub lifetimes: Option<Vec<f32>>,
    /// Kind of a whitewater particle: 0 foam, 1 spray, 2 bubble. Other whole numbers up to 2^32 - 1 are kept; if any
    /// value is not such a number, all kinds are dropped with a warning.
    pub kinds: Option<Vec<u32>>,
    /// Every attribute in the file, including positions and attributes that are not read.
    pub attributes: Vec<Attribute>,
    /// Each meaning (position, velocity, ...) that was found in the file, with the names of its attributes; positions
    /// come first. An attribute that is named nowhere here was ignored, unless it is in [`extras`](Self::extras).
    pub meanings: Vec<(Meaning, Vec<String>)>,
    /// Attributes that were requested with [`read_with`].
    pub extras: Vec<Extra>,
    /// Time of the frame in the file's unit, if the file has it.
    pub time: Option<f64>,
    /// Offset that was subtracted from the file's positions in double precision, so that 32-bit floats can
    /// distinguish particles far from the origin; 0 if nothing was subtracted. The frames of a sequence may
    /// have different offsets, see [`move_to`](Self::move_to).
    pub origin: [f64; 3],
    /// Format of the file.
    pub format: Format,
    /// Warnings for the user: dropped values, unread parts, non-finite positions.
    pub warnings: Vec<String>,
}

impl Particles {
    /// Makes particles that have only these positions. Their format is [`Format::RawF32`], and no attributes are
    /// listed.
    pub fn from_positions(positions: Vec<[f32; 3]>) -> Self {
        Self {
            positions,
            velocities: None,
            densities: None,
            ids: None,
            lifetimes: None,
            kinds: None,
            attributes: Vec::new(),
            meanings: Vec::new(),
            extras: Vec::new(),
            time: None,
            origin: [0.0; 3],
            format: Format::RawF32,
            warnings: Vec::new(),
        }
    }

    /// Removes the particles whose entry in `kept` is false. Particles without an entry are kept.
    pub fn retain(&mut self, kept: &[bool]) {
        survey::retain(self, kept);
    }

    /// Appends the particles of another file of the same frame. If one of the two files has no particles, the result
    /// is the particles of the other with all their attributes. Otherwise velocities, densities, lifetimes, kinds and
    /// ids that only one of the files has are dropped, with a warning. All ids are dropped, with a warning, if an id
    /// of one file also occurs in the other. [`extras`](Self::extras) are NaN for particles of a file that lacks
    /// them.
    pub fn append(&mut self, other: Self) {
        join::append(self, other);
    }

    /// Changes the [`origin`](Self::origin), for example to that of a sequence's first frame, and adjusts the
    /// positions so that origin + position of each particle stays the same.
    pub fn move_to(&mut self, origin: [f64; 3]) {
        if self.origin != origin {
            let ([x, y, z], [a, b, c]) = (self.origin, origin);
            for [px, py, pz] in &mut self.positions {
                *px = (f64::from(*px) + (x - a)) as f32;
                *py = (f64::from(*py) + (y - b)) as f32;
                *pz = (f64::from(*pz) + (z - c)) as f32;
            }
            self.origin = origin;
        }
    }
}

/// Reads one file.
///
/// # Errors
/// [`ReadError::Io`] or [`ReadError::Directory`] if there is no file to read, otherwise [`ReadError::File`] with the
/// path and the error of [`read_bytes`].
pub fn read(path: &Path) -> Result<Particles, ReadError> {
    read_asked(path, &Asked::default())
}

fn read_asked(path: &Path, asked: &Asked) -> Result<Particles, ReadError> {
    let io = |reason| ReadError::Io { path: path.to_path_buf(), reason };
    if std::fs::metadata(path).map_err(io)?.is_dir() {
        return Err(ReadError::Directory { path: path.to_path_buf() });
    }
    if let Some(pieces) = index::Pieces::of(path)? {
        return pieces.plan(asked).and_then(plan::Plan::read).map_err(|error| pieces.fault(error));
    }
    #[cfg(feature = "hdf5")]
    if let Some(read) = of_hdf5(path, asked) {
        return read;
    }
    // The beginning is enough to refuse a large file in an unknown format.
    let mut head = Vec::new();
    let file = std::fs::File::open(path).map_err(io)?;
    file.take(foreign::START as u64).read_to_end(&mut head).map_err(io)?;
    if let Some(told) = foreign::told(&head) {
        return Err(ReadError::File { path: path.to_path_buf(), reason: Box::new(told) });
    }
    // If the file holds several frames, the others are not kept in memory.
    if asked.step().is_some() {
        let input = source::Input::new(std::fs::File::open(path).map_err(io)?)?;
        let mut start = Vec::new();
        source::Source::new(&input, &input.whole(false)).fill(2, &mut start)?;
        let gzip = bytes::is_gzip(&start);
        if asked.step().is_some_and(|step| step.part.is_some()) {
            let content = source::Content::new(&input, gzip);
            let content = content.map_err(|error| parts::named(path, error))?;
            if let Some(read) = json::read_part(&content, asked) {
                return Ok(read);
            }
        }
        let read = parts::plan(&input, Extension::from_path(path), gzip, asked)
            .and_then(|plan| plan.map(plan::Plan::read).transpose());
        if let Some(read) = read.map_err(|error| parts::named(path, error))? {
            return Ok(read);
        }
    }
    let bytes = std::fs::read(path).map_err(io)?;
    read_bytes_asked(&bytes, Extension::from_path(path), asked)
        .map_err(|reason| ReadError::File { path: path.to_path_buf(), reason: Box::new(reason) })
}

/// Reads an HDF5 file, or a file that refers to one; `None` for any other.
#[cfg(feature = "hdf5")]
fn of_hdf5(path: &Path, asked: &Asked) -> Option<Result<Particles, ReadError>> {
    let read = hdf5::read(path, asked).or_else(|| xdmf::read(path, asked))?;
    Some(read.map_err(|error| parts::named(path, error)))
}

/// Reads one file like [`read`], and also scalar attributes by name into [`Particles::extras`]. Case, blanks,
/// `_ - . :` and units in brackets are ignored in names. A missing attribute is no error.
///
/// # Errors
/// Those of [`read`].
pub fn read_with(path: &Path, extras: &[&str]) -> Result<Particles, ReadError> {
    read_asked(path, &Asked::new(extras))
}

/// Whether two names denote one attribute, by the rules of [`read_with`].
pub fn same_name(a: &str, b: &str) -> bool {
    names::plain(a) == names::plain(b)
}

/// Reads a file from memory. The content decides the format. `hint` matters only for text, for raw triples of `f32`,
/// and for `Bobj` and `Sc`, which are not supported.
///
/// # Errors
/// The error says what was expected, what was found, where in the file if that is known, and what to do. No input
/// causes a panic.
pub fn read_bytes(bytes: &[u8], hint: Extension) -> Result<Particles, ReadError> {
    read_bytes_asked(bytes, hint, &Asked::default())
}

fn read_bytes_asked(bytes: &[u8], hint: Extension, asked: &Asked) -> Result<Particles, ReadError> {
    if bytes::is_gzip(bytes) {
        let inner = bytes::gunzip(bytes)?;
        return read_plain(&inner, hint, true, asked);
    }
    read_plain(bytes, hint, false, asked)
}

fn read_plain(
    bytes: &[u8],
    hint: Extension,
    gzip: bool,
    asked: &Asked,
) -> Result<Particles, ReadError> {
    if let Some(text) = format::as_lines(bytes) {
        return read_plain(&text, hint, gzip, asked);
    }
    #[cfg(feature = "hdf5")]
    if hdf5::is_in(bytes) {
        return hdf5::File::of_bytes(bytes)?.read(asked);
    }
    let content = || source::Content::of_bytes(bytes);
    match format::detect(bytes, hint)? {
        format::Reader::Bgeo => bgeo::layout(bytes, gzip, asked)?.read(bytes),
        format::Reader::Geo => table::plan(&content()?, geo::open, asked)?.read(),
        format::Reader::VtkLegacy => vtk_legacy::plan(&content()?, asked)?.read(),
        format::Reader::VtkXml => vtk_xml::plan(&content()?, asked)?.read(),
        format::Reader::Ply => match ply::layout(bytes, asked)?.0 {
            Some(layout) => {
                ply::check_end(&content()?, &layout.rows)?;
                layout.read(bytes)
            }
            None => table::plan(&content()?, ply::open, asked)?.read(),
        },
        format::Reader::Npy => numpy::read_npy(bytes, asked),
        format::Reader::Npz => numpy::read_npz(bytes, asked),
        format::Reader::Csv => table::plan(&content()?, comma::open, asked)?.read(),
        format::Reader::XyzText => table::plan(&content()?, xyz::open, asked)?.read(),
        format::Reader::Lammps => table::plan(&content()?, lammps::open, asked)?.read(),
        format::Reader::XyzRaw => xyz::raw(bytes.len() as u64, asked)?.read(bytes),
        format::Reader::Json => json::read(bytes, asked),
    }
}

/// Number of positions with a NaN or an infinity. Readers keep such particles, so that indices stay valid; the
/// renderer drops them.
pub fn count_non_finite(positions: &[[f32; 3]]) -> usize {
    positions.iter().filter(|p| !p.iter().all(|c| c.is_finite())).count()
}
