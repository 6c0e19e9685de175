//! Detection of a file's format: by its first bytes, and by its name only where they are ambiguous.

use std::path::Path;

use super::error::ReadError;
use super::{foreign, heading};

/// Format hint from a file name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Extension {
    /// `.bgeo`
    Bgeo,
    /// `.geo`
    Geo,
    /// `.sc`, `.bgeosc`: Houdini's Blosc container
    Sc,
    /// `.vtk`
    Vtk,
    /// `.vtu`
    Vtu,
    /// `.vtp`
    Vtp,
    /// `.ply`
    Ply,
    /// `.npy`
    Npy,
    /// `.npz`
    Npz,
    /// `.csv`, `.tsv`
    Csv,
    /// `.xyz`, `.txt`, `.asc`, `.pts`: text or raw `f32` triples
    Xyz,
    /// `.dat`, `.extxyz`, `.out`, `.tab`, `.tec`, `.tp`: text
    Text,
    /// `.json`, `.jsonl`, `.ndjson`
    Json,
    /// `.bobj`: meshes of Blender and Mantaflow, which have no magic bytes
    Bobj,
    /// Any other extension
    Unknown,
}

impl Extension {
    /// The hint of a path; a trailing `.gz` is ignored.
    pub fn from_path(path: &Path) -> Self {
        let lower = |p: &Path| p.extension().map(|e| e.to_string_lossy().to_lowercase());
        let mut extension = lower(path);
        if extension.as_deref() == Some("gz") {
            extension = path.file_stem().and_then(|stem| lower(Path::new(stem)));
        }
        match extension.as_deref() {
            Some("bgeo") => Self::Bgeo,
            Some("geo") => Self::Geo,
            Some("sc" | "bgeosc") => Self::Sc,
            Some("vtk") => Self::Vtk,
            Some("vtu") => Self::Vtu,
            Some("vtp") => Self::Vtp,
            Some("ply") => Self::Ply,
            Some("npy") => Self::Npy,
            Some("npz") => Self::Npz,
            Some("csv" | "tsv") => Self::Csv,
            Some("dat" | "extxyz" | "out" | "tab" | "tec" | "tp") => Self::Text,
            Some("xyz" | "txt" | "asc" | "pts") => Self::Xyz,
            Some("json" | "jsonl" | "ndjson") => Self::Json,
            Some("bobj") => Self::Bobj,
            _ => Self::Unknown,
        }
    }
}

/// Encoding of the values in a VTU or VTP file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Storage {
    /// Text
    Ascii,
    /// Base64 inside each element
    InlineBase64,
    /// Base64 after the header
    AppendedBase64,
    /// Bytes after the header
    AppendedRaw,
}

/// Compression of the values in a VTU or VTP file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Compression {
    /// None
    None,
    /// zlib blocks
    Zlib,
    /// LZ4 blocks
    Lz4,
    /// xz blocks
    Lzma,
}

/// Format of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Classic Houdini BGEO, version 5
    Bgeo {
        /// Whether it is compressed with gzip
        gzip: bool,
    },
    /// Classic Houdini GEO, version 5 (ASCII)
    Geo,
    /// Legacy VTK
    VtkLegacy {
        /// Version of the file format
        version: (u8, u8),
        /// Binary; otherwise ASCII
        binary: bool,
    },
    /// VTK XML unstructured grid
    Vtu(Storage, Compression),
    /// VTK XML poly data
    Vtp(Storage, Compression),
    /// PLY as text
    PlyAscii,
    /// PLY, binary
    PlyBinary {
        /// Big-endian; otherwise little-endian
        big_endian: bool,
    },
    /// One NumPy array
    Npy,
    /// A zip of NumPy arrays
    Npz,
    /// Comma-separated values
    Csv,
    /// Text, three numbers a line
    Xyz,
    /// Zones of Tecplot, text
    Tecplot,
    /// A dump of LAMMPS or LIGGGHTS, text
    Lammps,
    /// Little-endian `f32` triples without a header
    RawF32,
    /// JSON arrays
    Json,
    /// HDF5: VTKHDF, PySPH, H5Part, H5MD or arrays in a group
    Hdf5,
    /// XDMF, with the arrays that it names
    Xdmf,
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let xml =
            |f: &mut std::fmt::Formatter<'_>, name, storage: &Storage, packed: &Compression| {
                let storage = match storage {
                    Storage::Ascii => return write!(f, "{name}, ASCII"),
                    Storage::InlineBase64 => "inline base64",
                    Storage::AppendedBase64 => "appended base64",
                    Storage::AppendedRaw => "appended raw",
                };
                let packed = match packed {
                    Compression::None => "uncompressed",
                    Compression::Zlib => "zlib",
                    Compression::Lz4 => "LZ4",
                    Compression::Lzma => "LZMA",
                };
                write!(f, "{name}, {storage}, {packed}")
            };
        match self {
            Self::Bgeo { gzip: false } => f.write_str("classic BGEO v5"),
            Self::Bgeo { gzip: true } => f.write_str("classic BGEO v5, gzip"),
            Self::Geo => f.write_str("classic GEO v5, ASCII"),
            Self::VtkLegacy { version, binary } => {
                let kind = if *binary { "binary" } else { "ASCII" };
                write!(f, "legacy VTK {}.{}, {kind}", version.0, version.1)
            }
            Self::Vtu(storage, packed) => xml(f, "VTU", storage, packed),
            Self::Vtp(storage, packed) => xml(f, "VTP", storage, packed),
            Self::PlyAscii => f.write_str("PLY, ASCII"),
            Self::PlyBinary { big_endian: false } => f.write_str("PLY, binary little-endian"),
            Self::PlyBinary { big_endian: true } => f.write_str("PLY, binary big-endian"),
            Self::Npy => f.write_str("NPY"),
            Self::Npz => f.write_str("NPZ"),
            Self::Csv => f.write_str("CSV"),
            Self::Xyz => f.write_str("XYZ, text"),
            Self::Tecplot => f.write_str("Tecplot, text"),
            Self::Lammps => f.write_str("LAMMPS dump, text"),
            Self::RawF32 => f.write_str("XYZ, raw little-endian f32"),
            Self::Json => f.write_str("JSON"),
            Self::Hdf5 => f.write_str("HDF5"),
            Self::Xdmf => f.write_str("XDMF"),
        }
    }
}

/// Formats that [`write`](super::write()) supports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WriteFormat {
    /// Classic Houdini BGEO, version 5
    Bgeo {
        /// Compressed with gzip, as by SPlisHSPlasH
        gzip: bool,
    },
    /// VTU, appended raw, zlib: what ParaView writes
    Vtu,
    /// PLY, binary little-endian
    Ply,
    /// NPZ, deflated
    Npz,
}

impl WriteFormat {
    /// The format for a name: `.bgeo`, `.bgeo.gz`, `.vtu`, `.ply` or `.npz`; `None` for any other.
    pub fn from_path(path: &Path) -> Option<Self> {
        let gzip = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"));
        match (Extension::from_path(path), gzip) {
            (Extension::Bgeo, gzip) => Some(Self::Bgeo { gzip }),
            (Extension::Vtu, false) => Some(Self::Vtu),
            (Extension::Ply, false) => Some(Self::Ply),
            (Extension::Npz, false) => Some(Self::Npz),
            _ => None,
        }
    }
}

/// The reader of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reader {
    Bgeo,
    Geo,
    VtkLegacy,
    VtkXml,
    Ply,
    Npy,
    Npz,
    Csv,
    XyzText,
    Lammps,
    XyzRaw,
    Json,
}

/// Detects the format by the first bytes, and by the extension where these are ambiguous.
pub(super) fn detect(bytes: &[u8], hint: Extension) -> Result<Reader, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::Empty);
    }
    if let Some(told) = foreign::told(bytes) {
        return Err(told);
    }
    if hint == Extension::Bobj && !is_text(bytes) {
        return Err(ReadError::Unsupported {
            what: "a mesh of a fluid (.bobj of Blender and Mantaflow)".into(),
            advice: "export the particles, as classic BGEO, VTU, PLY or NPZ",
        });
    }
    let magic = |m: &[u8]| bytes.starts_with(m);
    if magic(b"Bgeo") {
        return Ok(Reader::Bgeo);
    }
    if magic(b"PGEOMETRY") {
        return Ok(Reader::Geo);
    }
    if magic(b"\x7fNSJ") {
        return Err(ReadError::Unsupported {
            what: "Houdini's binary JSON geometry (BGEO of Houdini 12 and later)".into(),
            advice: "save classic BGEO (File Cache with the extension .bhclassic, or Partio), VTU, PLY or NPZ",
        });
    }
    if magic(b"scf1") || (hint == Extension::Sc && !is_text(bytes)) {
        return Err(ReadError::Unsupported {
            what: "Houdini's Blosc container (.bgeo.sc)".into(),
            advice: "save classic BGEO (File Cache with the extension .bhclassic, or Partio), VTU, PLY or NPZ",
        });
    }
    if magic(b"# vtk DataFile") {
        return Ok(Reader::VtkLegacy);
    }
    if magic(b"ply\n") || magic(b"ply\r") {
        return Ok(Reader::Ply);
    }
    if magic(b"\x93NUMPY") {
        return Ok(Reader::Npy);
    }
    if magic(b"PK\x03\x04") || magic(b"PK\x05\x06") {
        return Ok(Reader::Npz);
    }
    let text = is_text(bytes);
    if text {
        let body = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        if body.starts_with(b"<?xml") || body.starts_with(b"<VTKFile") || body.starts_with(b"<!--")
        {
            return Ok(Reader::VtkXml);
        }
        let noted = hint == Extension::Json && (body.starts_with(b"//") || body.starts_with(b"/*"));
        if (body.starts_with(b"[") && !is_section(body)) || body.starts_with(b"{") || noted {
            return Ok(Reader::Json);
        }
        if super::lammps::STARTS.iter().any(|start| body.starts_with(start)) {
            return Ok(Reader::Lammps);
        }
        match hint {
            Extension::Csv => return Ok(Reader::Csv),
            Extension::Xyz | Extension::Text => return Ok(Reader::XyzText),
            Extension::Unknown => {
                foreign::told_of_text(body).map_or(Ok(()), Err)?;
                if is_table(body) {
                    return Ok(Reader::XyzText);
                }
            }
            _ => {}
        }
    } else if is_readable(bytes)
        && matches!(hint, Extension::Csv | Extension::Xyz | Extension::Text)
    {
        // Text in an encoding other than UTF-8. Raw binary numbers would contain control characters.
        return Ok(if hint == Extension::Csv { Reader::Csv } else { Reader::XyzText });
    } else if hint == Extension::Xyz {
        return Ok(Reader::XyzRaw);
    }
    // Compressed or raw data may follow the XML so early that the beginning of the file is no valid text.
    if bytes.starts_with(b"<?xml") || bytes.starts_with(b"<VTKFile") {
        return Ok(Reader::VtkXml);
    }
    Err(ReadError::UnknownFormat { found: describe(bytes, hint) })
}

/// Whether a text begins with a word in brackets, as sections of tables do (`[Name]` of ANSYS CFX).
fn is_section(text: &[u8]) -> bool {
    let inner = text.get(1..).unwrap_or_default();
    let word = inner.iter().position(|b| !(b.is_ascii_alphanumeric() || *b == b' '));
    let word = inner.get(..word.unwrap_or(0)).unwrap_or_default();
    // Words that are values in JSON or Python.
    let value = [&b"true"[..], b"false", b"null", b"NaN", b"Infinity"].contains(&word);
    !value
        && word.first().is_some_and(u8::is_ascii_alphabetic)
        && inner.get(word.len()..).is_some_and(|rest| rest.starts_with(b"]"))
}

/// Min number of rows of numbers that make a text with an unknown extension a table.
const ROWS: usize = 3;

/// Whether a text begins as a table of positions: rows with equally many numbers, preceded only by column names, a
/// count, or comments.
fn is_table(text: &[u8]) -> bool {
    let head = text.get(..text.len().min(4096)).unwrap_or(text);
    // The last line may be cut.
    let whole = if head.len() < text.len() { head.iter().rposition(|b| *b == b'\n') } else { None };
    let head = head.get(..whole.unwrap_or(head.len())).unwrap_or(head);
    let lines = head.split(|b| *b == b'\n').filter(|line| !heading::is_comment(line));
    let (mut rows, mut columns, mut before) = (0, 0, 0);
    for line in lines {
        let delimiter = heading::delimiter(line);
        let fields = heading::fields(line, delimiter);
        let numbers = fields.iter().filter(|field| heading::is_number(field, delimiter)).count();
        // The first column may be an element.
        let row = fields.len() >= 3 && numbers >= 3 && numbers + 1 >= fields.len();
        match (rows, row) {
            (0, false) => before += 1,
            (0, true) => (rows, columns) = (1, fields.len()),
            (_, true) if fields.len() == columns => rows += 1,
            _ => return false,
        }
    }
    rows >= ROWS && before <= 2
}

/// Whether the beginning can be text: UTF-8 without control characters.
fn is_text(bytes: &[u8]) -> bool {
    let head = bytes.get(..bytes.len().min(4096)).unwrap_or(bytes);
    let valid = match std::str::from_utf8(head) {
        Ok(_) => true,
        // The end of the prefix may cut a character.
        Err(e) => e.error_len().is_none() && head.len() < bytes.len(),
    };
    valid && is_readable(bytes)
}

/// Whether the first 4096 bytes of a file have no control characters, as text in any encoding. Bytes that are not
/// ASCII are allowed: a unit of a column may contain a superscript.
fn is_readable(bytes: &[u8]) -> bool {
    let head = bytes.get(..bytes.len().min(4096)).unwrap_or(bytes);
    !head.iter().any(|b| b.is_ascii_control() && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0c))
}

/// Converts text in UTF-16, or with carriage returns alone at the ends of lines, to UTF-8 with line feeds; `None` for
/// all others.
pub(super) fn as_lines(bytes: &[u8]) -> Option<Vec<u8>> {
    from_utf16(bytes).or_else(|| from_old_mac(bytes))
}

fn from_old_mac(bytes: &[u8]) -> Option<Vec<u8>> {
    let head = bytes.get(..bytes.len().min(1 << 16)).unwrap_or(bytes);
    let returns = head.contains(&b'\r') && !head.contains(&b'\n') && is_text(bytes);
    // A single line may end with a carriage return.
    let several = || head.iter().filter(|b| **b == b'\r').count() > 1;
    let feed = |b: &u8| if *b == b'\r' { b'\n' } else { *b };
    (returns && several()).then(|| bytes.iter().map(feed).collect())
}

/// Converts UTF-16 text, as spreadsheets write it, with a byte order mark or with every other byte 0, to UTF-8;
/// `None` for all others.
fn from_utf16(bytes: &[u8]) -> Option<Vec<u8>> {
    type Unit = fn([u8; 2]) -> u16;
    let (mark, rest) = bytes.split_first_chunk::<2>()?;
    let (unit, rest): (Unit, _) = match mark {
        b"\xff\xfe" => (u16::from_le_bytes, rest),
        b"\xfe\xff" => (u16::from_be_bytes, rest),
        _ => {
            let (pairs, _) = bytes.get(..64)?.as_chunks::<2>();
            let readable = |b: u8| matches!(b, b' '..=b'~' | b'\t' | b'\n' | b'\r');
            let unit = if pairs.iter().all(|[low, high]| *high == 0 && readable(*low)) {
                u16::from_le_bytes
            } else if pairs.iter().all(|[high, low]| *high == 0 && readable(*low)) {
                u16::from_be_bytes
            } else {
                return None;
            };
            (unit as Unit, bytes)
        }
    };
    let decode = |bytes: &[u8]| {
        let units = bytes.as_chunks::<2>().0.iter().map(|pair| unit(*pair));
        char::decode_utf16(units)
            .map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect::<String>()
    };
    // Raw numbers may begin with the same bytes.
    let head = decode(rest.get(..rest.len().min(4096)).unwrap_or(rest));
    let text = is_readable(head.as_bytes()) && !head.contains(char::REPLACEMENT_CHARACTER);
    (text && !head.is_empty()).then(|| decode(rest).into_bytes())
}

fn describe(bytes: &[u8], hint: Extension) -> String {
    let head = bytes.get(..bytes.len().min(12)).unwrap_or(bytes);
    let named = match hint {
        Extension::Unknown => "an unknown extension".to_string(),
        hint => format!("the extension of {hint:?}"),
    };
    format!("{named} and a file that begins with \"{}\"", head.escape_ascii())
}
