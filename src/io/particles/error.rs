//! Errors of reading and writing particle files.

use std::path::PathBuf;

/// Position in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Place {
    /// Byte offset, from 0. It counts from the start of the file, in gzip files from the start of the decompressed
    /// content, in NPZ files from the start of the unpacked array.
    Byte(u64),
    /// Line number, from 1
    Line(u64),
    /// Unknown
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
        /// The system's error.
        reason: std::io::Error,
    },
    /// The path is a folder.
    #[error("{} is a directory; name a file in it, or a pattern such as {}", path.display(), path.join("*.bgeo").display())]
    Directory {
        /// The folder.
        path: PathBuf,
    },
    /// The content of the file is invalid.
    #[error("{}: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The error in it.
        reason: Box<ReadError>,
    },
    /// The file has no bytes.
    #[error("the file is empty; it was perhaps read while it was being written: write it again")]
    Empty,
    /// Neither content nor name identifies the format.
    #[error(
        "expected BGEO, GEO, VTK, VTU, VTP, PLY, NPY, NPZ, HDF5, CSV, XYZ or JSON, found {found}; \
         text needs the extension .csv, .xyz or .json, raw f32 triples need .xyz"
    )]
    UnknownFormat {
        /// The first bytes, in readable form.
        found: String,
    },
    /// A known format, or a part of one, that is not supported.
    #[error("{what} is not read; {advice}")]
    Unsupported {
        /// What was found.
        what: String,
        /// Advice for the user.
        advice: &'static str,
    },
    /// The file ends before the data that its header declares.
    #[error(
        "the file ends too early: {what} at byte {offset} needs {needed} bytes, {found} are there; \
         the file was cut off or its header is wrong: write it again"
    )]
    Truncated {
        /// What was being read.
        what: String,
        /// Byte offset of its beginning.
        offset: u64,
        /// Min number of bytes expected.
        needed: u64,
        /// Number of bytes found.
        found: u64,
    },
    /// The content violates the format.
    #[error(
        "expected {expected}, found {found}{place}; the file is damaged or not what its header says: write it again"
    )]
    Malformed {
        /// What the format requires.
        expected: String,
        /// What the file contains.
        found: String,
        /// Position in the file.
        place: Place,
    },
    /// Text that could not be interpreted as a table or list of particles.
    #[error("expected {expected}, found {found}{place}; {advice}")]
    Unclear {
        /// What was expected.
        expected: String,
        /// What the file contains.
        found: String,
        /// Position in the file.
        place: Place,
        /// Advice for the user.
        advice: &'static str,
    },
    /// An attribute has more or fewer values than there are particles.
    #[error(
        "attribute `{attribute}`: expected {expected} values, one per particle and component, found {found}; \
         write the file again or leave the attribute out"
    )]
    Length {
        /// Name in the file.
        attribute: String,
        /// Expected number of values.
        expected: u64,
        /// Number of values found.
        found: u64,
    },
    /// The file has no recognizable positions.
    #[error("expected positions ({expected}), found {found}; rename the columns or arrays")]
    NoPositions {
        /// Recognized names.
        expected: &'static str,
        /// Names in the file.
        found: String,
    },
    /// Compressed data that decompresses to more than particle data plausibly can.
    #[error(
        "{what} unpacks to more than {limit} bytes, which the size of the file does not warrant; store it uncompressed"
    )]
    TooLarge {
        /// What was being decompressed.
        what: String,
        /// Limit in bytes.
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

    /// An error in a text table.
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

    /// The same error in the last row of a table, which was probably cut off.
    pub(super) fn in_last_row(self) -> Self {
        match self {
            Self::Unclear { expected, found, place, .. } => Self::Unclear {
                expected,
                found,
                place,
                advice: "this is the last line of the table, which was perhaps cut off: write it again",
            },
            other => other,
        }
    }

    /// An error in JSON.
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
    /// The file could not be created, written or renamed.
    #[error("cannot write {}: {reason}; check that the folder exists, may be written to and is not full", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's error.
        reason: std::io::Error,
    },
    /// The vectors of the particles differ in length.
    #[error("{attribute} has {found} values for {expected} positions; give one for each, or none")]
    Length {
        /// The field of [`Particles`](super::Particles).
        attribute: &'static str,
        /// Number of positions.
        expected: usize,
        /// Number of values.
        found: usize,
    },
    /// A number is too large for the format.
    #[error("{what} {value} is over {limit}, the largest that {format} holds; write VTU instead")]
    Range {
        /// Name of the number.
        what: &'static str,
        /// The number.
        value: u64,
        /// Max value that the format can store.
        limit: u64,
        /// The format.
        format: &'static str,
    },
}
