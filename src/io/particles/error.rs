//! Errors of reading and writing particle files.

use std::path::PathBuf;

/// Where in a file something was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// Bytes from the start, from 0; of the unpacked content where the file is gzip.
    Byte(u64),
    /// Lines from the start, from 1.
    Line(u64),
    /// Not known.
    Unknown,
}

impl std::fmt::Display for Place {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Byte(offset) => write!(f, " at byte {offset}"),
            Self::Line(line) => write!(f, " in line {line}"),
            Self::Unknown => Ok(()),
        }
    }
}

/// Why a particle file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file is missing or may not be read.
    #[error("cannot read {}: {reason}; check the name and the permissions", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// A folder was named.
    #[error("{} is a directory; name a file in it, or a pattern such as {}", path.display(), path.join("*.bgeo").display())]
    Directory {
        /// The folder.
        path: PathBuf,
    },
    /// The content of a file is at fault.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong in it.
        reason: Box<ReadError>,
    },
    /// The file has no bytes.
    #[error("the file is empty; it was perhaps read while it was being written: write it again")]
    Empty,
    /// Neither the content nor the name tells the format.
    #[error(
        "expected BGEO, GEO, VTK, VTU, VTP, PLY, NPY, NPZ, HDF5, CSV, XYZ or JSON, found {found}; \
         text needs the extension .csv, .xyz or .json, raw f32 triples need .xyz"
    )]
    UnknownFormat {
        /// The first bytes, readable.
        found: String,
    },
    /// A format or a part of one that is known and not read.
    #[error("{what} is not read; {advice}")]
    Unsupported {
        /// What was found.
        what: String,
        /// What to do.
        advice: &'static str,
    },
    /// The file ends before what its header promises.
    #[error(
        "the file ends too early: {what} at byte {offset} needs {needed} bytes, {found} are there; \
         the file was cut off or its header is wrong: write it again"
    )]
    Truncated {
        /// What was being read.
        what: String,
        /// Where it begins.
        offset: u64,
        /// Bytes expected (at least).
        needed: u64,
        /// Bytes found.
        found: u64,
    },
    /// Something else stands where the format asks for a certain thing.
    #[error(
        "expected {expected}, found {found}{place}; the file is damaged or not what its header says: write it again"
    )]
    Malformed {
        /// What the format asks for.
        expected: String,
        /// What is there.
        found: String,
        /// Where.
        place: Place,
    },
    /// Text that is no table, or no list, of particles as far as it is understood.
    #[error("expected {expected}, found {found}{place}; {advice}")]
    Unclear {
        /// What was looked for.
        expected: String,
        /// What is there.
        found: String,
        /// Where.
        place: Place,
        /// What to do.
        advice: &'static str,
    },
    /// An attribute has more or fewer values than there are particles.
    #[error(
        "attribute `{attribute}`: expected {expected} values, one per particle and component, found {found}; \
         write the file again or leave the attribute out"
    )]
    Length {
        /// Its name in the file.
        attribute: String,
        /// Values there should be.
        expected: u64,
        /// Values there are.
        found: u64,
    },
    /// The file has no positions that could be recognized.
    #[error("expected positions ({expected}), found {found}; rename the columns or arrays")]
    NoPositions {
        /// The names looked for.
        expected: &'static str,
        /// The names there are.
        found: String,
    },
    /// Compressed data grows beyond what particle data can.
    #[error(
        "{what} unpacks to more than {limit} bytes, which the size of the file does not warrant; store it uncompressed"
    )]
    TooLarge {
        /// What was being unpacked.
        what: String,
        /// The limit.
        limit: u64,
    },
}

impl ReadError {
    pub(super) fn malformed(
        expected: impl Into<String>,
        found: impl Into<String>,
        place: Place,
    ) -> Self {
        Self::Malformed { expected: expected.into(), found: found.into(), place }
    }

    /// Of a table in text.
    pub(super) fn table(
        expected: impl Into<String>,
        found: impl Into<String>,
        place: Place,
    ) -> Self {
        Self::Unclear {
            expected: expected.into(),
            found: found.into(),
            place,
            advice: "a table has a line of names, such as x,y,z,vx,vy,vz, and then a line of as many numbers for each particle",
        }
    }

    /// Of JSON.
    pub(super) fn json(expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::Unclear {
            expected: expected.into(),
            found: found.into(),
            place: Place::Unknown,
            advice: "write [[x, y, z], ...], {\"position\": [[x, y, z], ...], \"velocity\": ...} or [{\"x\": x, \"y\": y, \"z\": z}, ...]",
        }
    }

    pub(super) fn truncated(
        what: impl Into<String>,
        offset: usize,
        needed: u64,
        found: usize,
    ) -> Self {
        Self::Truncated { what: what.into(), offset: offset as u64, needed, found: found as u64 }
    }
}

/// Why particles could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The file could not be made, written or renamed.
    #[error("cannot write {}: {reason}; check that the folder exists, may be written to and is not full", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// The vectors of the particles differ in length.
    #[error("{attribute} has {found} values for {expected} positions; give one for each, or none")]
    Length {
        /// The field of [`Particles`](super::Particles).
        attribute: &'static str,
        /// Positions there are.
        expected: usize,
        /// Values there are.
        found: usize,
    },
    /// A number is too large for the format.
    #[error("{what} {value} is over {limit}, the largest that {format} holds; write VTU instead")]
    Range {
        /// What it is.
        what: &'static str,
        /// The number.
        value: u64,
        /// The largest that fits.
        limit: u64,
        /// The format.
        format: &'static str,
    },
}
