//! NumPy arrays (NPY, versions 1 to 3) and zips of them (NPZ).
//!
//! An NPY file is `\x93NUMPY`, two bytes of version, the length of the header (`u16`, from version 2 `u32`, both
//! little-endian), a header that is a Python dict `{'descr': '<f4', 'fortran_order': False, 'shape': (10, 3), }`,
//! and the numbers. The header is three known keys, read here.
//!
//! Own, since the crate for it (npyz 0.9) brings a whole Python parser with big integers for these three keys,
//! gives numbers only as the very type they are stored in, and does not hold the shape against the bytes there are.

use std::io::{Cursor as IoCursor, Read};

use super::bytes::{Cursor, show, unpack, unpack_limit};
use super::columns::{Attribute, AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::names;
use super::rows::{Field, Layout, Rows};
use super::source::{self, Check, Input, Packing, Piece, Source};
use super::{Format, Particles};

/// What the header of an array says.
struct Header {
    ty: AttributeType,
    big_endian: bool,
    fortran: bool,
    shape: Vec<u64>,
    descr: String,
}

impl Header {
    fn count(&self) -> u64 {
        self.shape.iter().fold(1_u64, |n, d| n.saturating_mul(*d))
    }

    /// Values per row: 1 for a list, the second extent for a table.
    fn components(&self) -> usize {
        let n = self.shape.iter().skip(1).fold(1_u64, |n, d| n.saturating_mul(*d));
        usize::try_from(n).unwrap_or(usize::MAX)
    }

    /// Bytes of a number.
    fn size(&self, name: &str) -> Result<u64, ReadError> {
        self.ty.size().ok_or_else(|| ReadError::Unsupported {
            what: format!("array `{name}` of dtype {}", self.descr),
            advice: "save it as float32, float64 or an integer type: a.astype('f4')",
        })
    }

    /// All of the first component come first, then all of the second ...
    fn is_transposed(&self) -> bool {
        self.fortran && self.shape.len() == 2 && self.components() > 1
    }

    /// Where its numbers are, after so many bytes of header; none where particle does not follow particle.
    fn rows(&self, header: u64, name: &str) -> Result<Option<Rows>, ReadError> {
        let stride = self.size(name)?.saturating_mul(self.components() as u64);
        if self.is_transposed() {
            return Ok(None);
        }
        Ok(Some(Rows {
            what: format!("array `{name}`"),
            header,
            between: Vec::new(),
            count: self.shape.first().copied().unwrap_or(1),
            stride,
            big_endian: self.big_endian,
            fields: vec![Field::new(name, self.components(), self.ty, 0)?],
        }))
    }
}

const NPY: &str = "array";

pub(super) fn read_npy(bytes: &[u8]) -> Result<Particles, ReadError> {
    if let Some(layout) = layout(bytes)?.0 {
        return layout.read(bytes);
    }
    let mut cursor = Cursor::new(bytes);
    let header = of_positions(&mut cursor)?;
    let mut table = Table::default();
    table.list(NPY, header.components(), header.ty);
    table.positions = Some(values(&mut cursor, &header, NPY)?);
    table.assemble(Format::Npy)
}

/// What the header of an NPY says and its length, of a file or the beginning of one; none where particle does not
/// follow particle.
pub(super) fn layout(bytes: &[u8]) -> Result<(Option<Layout>, u64), ReadError> {
    let mut cursor = Cursor::new(bytes);
    let header = of_positions(&mut cursor)?;
    let length = cursor.at() as u64;
    let mut table = Table::default();
    table.list(NPY, header.components(), header.ty);
    let layout = header.rows(length, NPY)?.map(|rows| Layout {
        rows,
        placed: true,
        attributes: table.attributes,
        warnings: Vec::new(),
        format: Format::Npy,
    });
    Ok((layout, length))
}

fn of_positions(cursor: &mut Cursor<'_>) -> Result<Header, ReadError> {
    let header = header(cursor)?;
    if header.shape.len() != 2 || header.components() != 3 {
        return Err(ReadError::malformed(
            "an array of shape (n, 3)",
            format!("shape {:?}", header.shape),
            Place::Unknown,
        ));
    }
    Ok(header)
}

pub(super) fn read_npz(bytes: &[u8]) -> Result<Particles, ReadError> {
    let mut archive = zip::ZipArchive::new(IoCursor::new(bytes)).map_err(bad_zip)?;
    let mut budget = unpack_limit(bytes.len());
    let mut table = Table::default();
    for i in 0..archive.len() {
        let mut file = archive.by_index(i).map_err(bad_zip)?;
        let Some(name) = wanted_array(&mut file, &mut table) else { continue };
        let raw = unpack(&mut file, budget, &format!("array `{name}`"), 0)?;
        budget = budget.saturating_sub(raw.len());
        let mut cursor = Cursor::new(&raw);
        let header = header(&mut cursor)?;
        table.list(&name, header.components(), header.ty);
        let data = values(&mut cursor, &header, &name)?;
        table.push(&name, header.components(), data);
    }
    table.assemble(Format::Npz)
}

/// Arrays of a zip.
pub(super) struct Arrays {
    /// Those that may be used, and where they lie.
    pub(super) rows: Vec<(Piece, Rows)>,
    pub(super) attributes: Vec<Attribute>,
}

/// What the headers of the arrays in a zip say; none where one can't be read row after row.
pub(super) fn arrays(input: &Input<'_>) -> Result<Option<Arrays>, ReadError> {
    let mut archive = zip::ZipArchive::new(input.section()).map_err(bad_zip)?;
    let mut table = Table::default();
    let mut found = Vec::new();
    for i in 0..archive.len() {
        let mut file = archive.by_index(i).map_err(bad_zip)?;
        let Some(name) = wanted_array(&mut file, &mut table) else { continue };
        let packing = match file.compression() {
            zip::CompressionMethod::Stored => Packing::None,
            zip::CompressionMethod::Deflated => Packing::Deflate,
            _ => return Ok(None),
        };
        let Some(start) = file.data_start() else { return Ok(None) };
        let piece = Piece {
            start,
            end: start.saturating_add(file.compressed_size()),
            packing,
            what: format!("array `{name}`"),
            check: Some(Check { crc: file.crc32(), size: file.size() }),
        };
        let header = source::header(&mut Source::new(input, &piece), |head| {
            let mut cursor = Cursor::new(head);
            let header = header(&mut cursor)?;
            let length = cursor.at() as u64;
            Ok(((header, length), length))
        });
        let (header, length) = header?;
        table.list(&name, header.components(), header.ty);
        let Some(rows) = header.rows(length, &name)? else { return Ok(None) };
        found.push((piece, rows));
    }
    Ok(Some(Arrays { rows: found, attributes: table.attributes }))
}

fn bad_zip(error: zip::result::ZipError) -> ReadError {
    ReadError::malformed("a sound zip of arrays", error.to_string(), Place::Unknown)
}

/// The name of an array that may be used. Another one is listed.
fn wanted_array(file: &mut zip::read::ZipFile<'_, impl Read>, table: &mut Table) -> Option<String> {
    let name = file.name().ok()?.strip_suffix(".npy")?.to_string();
    if names::wanted(&name) {
        return Some(name);
    }
    // Its header alone is of interest; one that cannot be read is no reason to stop.
    let mut head = Vec::new();
    let _ = file.by_ref().take(4096).read_to_end(&mut head);
    if let Ok(header) = header(&mut Cursor::new(&head)) {
        table.list(&name, header.components(), header.ty);
    }
    None
}

fn values(cursor: &mut Cursor<'_>, header: &Header, name: &str) -> Result<Data, ReadError> {
    let size = header.size(name)?;
    let raw = cursor.take(header.count().saturating_mul(size), &format!("array `{name}`"))?;
    let mut data = Data::for_type(header.ty);
    data.push_bytes(header.ty, raw, header.big_endian);
    Ok(if header.is_transposed() { data.transposed(header.components()) } else { data })
}

fn header(cursor: &mut Cursor<'_>) -> Result<Header, ReadError> {
    const WHAT: &str = "the header of an array";
    let magic = cursor.take(6, WHAT)?;
    if magic != b"\x93NUMPY" {
        return Err(ReadError::malformed(
            "an array that begins with \\x93NUMPY",
            show(magic),
            Place::Byte(0),
        ));
    }
    let [major, minor] = cursor.array::<2>(WHAT)?;
    let length = match major {
        1 => u64::from(u16::from_le_bytes(cursor.array(WHAT)?)),
        2 | 3 => u64::from(u32::from_le_bytes(cursor.array(WHAT)?)),
        _ => {
            return Err(ReadError::Unsupported {
                what: format!("NPY version {major}.{minor}"),
                advice: "save with numpy.save or numpy.savez",
            });
        }
    };
    let place = cursor.place();
    let raw = cursor.take(length, WHAT)?;
    let bad = |key: &str| ReadError::malformed(format!("`{key}` in {WHAT}"), show(raw), place);
    let text = std::str::from_utf8(raw).map_err(|_| bad("descr"))?;
    // The value of a key runs from the colon on.
    let value = |key: &str| {
        let start = text.find(&format!("'{key}'"))? + key.len() + 2;
        Some(text.get(start..)?.trim_start().strip_prefix(':')?.trim_start())
    };
    let descr = value("descr").ok_or_else(|| bad("descr"))?;
    let descr = match descr.strip_prefix('\'').and_then(|d| d.split_once('\'')) {
        Some((descr, _)) => descr.to_string(),
        None => "of several fields".to_string(),
    };
    let fortran = value("fortran_order").ok_or_else(|| bad("fortran_order"))?;
    let shape = value("shape")
        .and_then(|v| v.strip_prefix('(')?.split_once(')'))
        .ok_or_else(|| bad("shape"))?
        .0;
    let shape = shape
        .split(',')
        .map(str::trim)
        .filter(|n| !n.is_empty())
        .map(|n| n.trim_end_matches('L').parse())
        .collect::<Result<Vec<u64>, _>>()
        .map_err(|_| bad("shape"))?;
    Ok(Header {
        ty: dtype(descr.trim_start_matches(['<', '>', '=', '|'])),
        big_endian: descr.starts_with('>'),
        fortran: fortran.starts_with("True"),
        shape,
        descr,
    })
}

fn dtype(name: &str) -> AttributeType {
    use AttributeType as T;
    match name {
        "i1" => T::I8,
        "u1" | "b1" => T::U8,
        "i2" => T::I16,
        "u2" => T::U16,
        "i4" => T::I32,
        "u4" => T::U32,
        "i8" => T::I64,
        "u8" => T::U64,
        "f4" => T::F32,
        "f8" => T::F64,
        _ => T::Other,
    }
}
