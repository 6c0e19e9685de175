//! Reads HDF5: VTKHDF, files of PySPH, H5Part and H5MD, and any other with positions in a group.
//!
//! The crate hdf5-reader (pure Rust) reads the container; this module finds the arrays.
//!
//! These layouts of a file are recognized:
//! - VTKHDF: group `VTKHDF` of type PolyData or UnstructuredGrid, or of blocks of these. The points of all
//!   parts and steps are stored in sequence; group `Steps` says where a step begins.
//! - PySPH: `particles/NAME/arrays`, one array per property; the time is attribute `t` of `solver_data`. If there are
//!   several kinds of particles, those called fluid are read.
//! - H5Part: groups `Step#N`. Other groups are frames if the word before a number in their name says so, or if they
//!   have different times (see `groups`).
//! - Gadget and SWIFT: the gas, group `PartType0`; the time is attribute `Time` of `Header`.
//! - H5MD: `particles/NAME/position/value` of shape (frames, particles, 3), and other properties likewise.
//! - Positions of shape (frames, particles, 3) in any group, or components of shape (frames, particles). Other arrays
//!   of the group with the same number of frames are attributes of these particles.
//! - openPMD: `position/x`, `position/y`, `position/z` and other groups of components in the group of the particles.
//! - Other files: the group with an array of positions; the particles of several such groups are joined.
//!
//! Values that netCDF packed (attributes `scale_factor` and `add_offset`) are unpacked.
//!
//! A unit in attribute `units` or `unit` of an array is added to its name: `position [mm]`.
//!
//! Of an HDF5 file only arrays of the requested frame that have a meaning are read. Memory use is limited by the
//! file's size.

mod groups;
mod links;
mod search;
mod vtk;

use std::io::{Read as _, Seek as _, SeekFrom};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use hdf5_reader::error::Error;
use hdf5_reader::group::Group;
use hdf5_reader::storage::{BytesStorage, FileStorage, Storage};
use hdf5_reader::{
    Attribute, ByteOrder, Dataset, Datatype, H5Type, Hdf5File, OpenOptions, SliceInfo,
    SliceInfoElem,
};

use super::asked::Asked;
use super::bytes::unpack_limit;
use super::columns::{AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::names;
use super::{Format, Particles};

/// Magic bytes of HDF5.
const MAGIC: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Where HDF5 may begin: at 0, or behind a user block, as MATLAB 7.3 writes one.
fn starts() -> impl Iterator<Item = usize> {
    std::iter::once(0).chain((9..=20).map(|power| 1 << power))
}

/// Whether a file is HDF5.
fn is_one(path: &Path) -> bool {
    let Ok(mut file) = std::fs::File::open(path) else { return false };
    let mut has = |at: usize, word: &[u8]| {
        let mut found = Vec::new();
        let sought = file.seek(SeekFrom::Start(at as u64));
        let read = sought.and_then(|_| (&file).take(word.len() as u64).read_to_end(&mut found));
        read.is_ok() && found == word
    };
    is_here(&mut has)
}

/// Whether these bytes are HDF5.
pub(super) fn is_in(bytes: &[u8]) -> bool {
    is_here(&mut |at, word| bytes.get(at..).is_some_and(|rest| rest.starts_with(word)))
}

/// Whether a content is HDF5; `has` tells whether it has certain bytes at an offset.
fn is_here(has: &mut dyn FnMut(usize, &[u8]) -> bool) -> bool {
    // The first file in a tar archive begins at 512.
    starts().any(|at| has(at, MAGIC)) && !has(257, b"ustar")
}

/// Compares the file's length with the length in its superblock, as the HDF5 library does. Without this check a file
/// that was cut off could lose attributes, such as units, without an error.
///
/// # Errors
/// [`ReadError::Truncated`] if the file is shorter.
fn whole(storage: &dyn Storage) -> Result<(), ReadError> {
    let bytes = |at: u64, count: usize| {
        let range = storage.read_range(at, count).ok()?;
        Some(range.to_vec()).filter(|bytes| bytes.len() == count)
    };
    let number = |at: u64, size: u8| {
        let bytes = bytes(at, size.into())?;
        Some(bytes.iter().rev().fold(0, |number: u64, byte| number << 8 | u64::from(*byte)))
    };
    let end = || {
        let begins = |at: &u64| bytes(*at, MAGIC.len()).is_some_and(|found| found == MAGIC);
        let start = starts().map(|at| at as u64).find(begins)?;
        let version = number(start + 8, 1)?;
        // The width of addresses, and the third of the addresses is that of the end.
        let (width, addresses) = match version {
            0 => (13, 24),
            1 => (13, 28),
            _ => (9, 12),
        };
        let width = number(start + width, 1).filter(|width| matches!(width, 2 | 4 | 8))?;
        number(start + addresses + 2 * width, width as u8)
    };
    match end() {
        Some(end) if end > storage.len() => Err(ReadError::Truncated {
            what: "HDF5, as its header says,".into(),
            offset: 0,
            needed: end,
            found: storage.len(),
        }),
        _ => Ok(()),
    }
}

/// Times of the frames of a file; `None` for another format.
pub(super) fn times(path: &Path) -> Option<Result<Vec<Option<f64>>, ReadError>> {
    is_one(path).then(|| File::open(path)?.times())
}

/// The particles of a file; `None` for another format.
pub(super) fn read(path: &Path, asked: &Asked) -> Option<Result<Particles, ReadError>> {
    is_one(path).then(|| File::open(path)?.read(asked))
}

/// Max number of groups that are searched, and max depth.
const GROUPS: usize = 1 << 12;
const DEEP: usize = 6;
/// Max plausible size in bytes of a header, and of a chunk; HDF5 itself writes smaller ones.
const HEADER: usize = 1 << 22;

/// An open file.
pub(super) struct File {
    file: Hdf5File,
    /// Max number of bytes that a dataset may decompress to.
    limit: usize,
}

/// The particles of a frame, and where they are stored.
struct Frame {
    time: Option<f64>,
    parts: Vec<Part>,
    /// Whether the names of the parts say that they are pieces of a whole.
    pieces: bool,
}

/// The particles of a frame that are in one group.
struct Part {
    /// Name for messages.
    name: String,
    arrays: Vec<Array>,
    warnings: Vec<String>,
}

/// An attribute.
struct Array {
    name: String,
    dataset: Dataset,
    rows: Rows,
}

/// The values of a dataset that belong to the particles.
#[derive(Clone)]
enum Rows {
    All,
    /// A range of rows.
    Some(Range<u64>),
    /// One frame of a dataset whose first dimension is frames.
    Frame(u64),
}

impl File {
    /// Opens a file; parts are read as needed.
    pub(super) fn open(path: &Path) -> Result<Self, ReadError> {
        Self::of(Arc::new(FileStorage::open(path).map_err(failed)?))
    }

    /// Opens a file in memory.
    pub(super) fn of_bytes(bytes: &[u8]) -> Result<Self, ReadError> {
        Self::of(Arc::new(BytesStorage::new(bytes.to_vec())))
    }

    fn of(storage: Arc<dyn Storage>) -> Result<Self, ReadError> {
        whole(&*storage)?;
        let limit = unpack_limit(usize::try_from(storage.len()).unwrap_or(usize::MAX));
        let options = OpenOptions::default()
            .with_max_read_bytes(limit)
            .with_max_chunk_bytes(limit)
            .with_max_object_header_bytes(HEADER)
            .with_chunk_cache_bytes(0);
        let file = Hdf5File::from_storage_with_options(storage, options).map_err(failed)?;
        Ok(Self { file, limit })
    }

    /// Reads a dataset by its path.
    pub(super) fn numbers(&self, path: &str) -> Result<(Vec<u64>, Data), ReadError> {
        let dataset = self.file.dataset(path).map_err(failed)?;
        let shape = dataset.shape().to_vec();
        let ty = type_of(&dataset);
        Ok((shape, numbers(&dataset, ty, &Rows::All, self.limit)?))
    }

    /// Times of the frames, if known.
    pub(super) fn times(&self) -> Result<Vec<Option<f64>>, ReadError> {
        Ok(self.frames()?.iter().map(|frame| frame.time).collect())
    }

    pub(super) fn read(&self, asked: &Asked) -> Result<Particles, ReadError> {
        let mut frames = self.frames()?;
        let count = frames.len();
        let frame = match asked.step() {
            Some(step) => step.index,
            None if count > 1 => return Err(several(count)),
            None => 0,
        };
        if frame >= count {
            return Err(ReadError::malformed(
                format!("frame {frame}"),
                format!("{count} frames"),
                Place::Unknown,
            ));
        }
        frames.swap_remove(frame).read(asked, self.limit)
    }

    fn frames(&self) -> Result<Vec<Frame>, ReadError> {
        let root = self.file.root_group().map_err(failed)?;
        if let Ok(grid) = root.group("VTKHDF") {
            return vtk::frames(&grid, self.limit);
        }
        let mut frames = search::frames(&self.file, &root, self.limit)?;
        let time = [("solver_data", "t"), ("Header", "Time")]
            .into_iter()
            .find_map(|(group, name)| number(&root.group(group).ok()?, &[name]));
        if let [frame] = frames.as_mut_slice() {
            frame.time = frame.time.or(time);
        }
        Ok(frames)
    }
}

/// Error: several frames where one is expected.
fn several(count: usize) -> ReadError {
    ReadError::Unsupported {
        what: format!("an HDF5 file of {count} frames, of which none is named,"),
        advice: "write one file per frame, with the frame's number in its name",
    }
}

/// Converts an error of the crate.
fn failed(error: Error) -> ReadError {
    match error {
        Error::Io(reason) => ReadError::Io { path: std::path::PathBuf::new(), reason },
        Error::UnsupportedFilter(what) => ReadError::Unsupported {
            what: format!("HDF5 that is packed by another program ({what})"),
            advice: "save it with compression='gzip', or without",
        },
        error @ (Error::UnsupportedEncoding(_) | Error::ResourceLimit(_)) => {
            ReadError::Unsupported {
                what: format!("this HDF5 ({error})"),
                advice: "save it again by h5repack, or its arrays as NPZ",
            }
        }
        error => ReadError::malformed("sound HDF5", error.to_string(), Place::Unknown),
    }
}

/// Type of the values of a dataset.
fn type_of(dataset: &Dataset) -> AttributeType {
    use AttributeType as T;
    match dataset.dtype() {
        Datatype::FloatingPoint { size: 4, .. } => T::F32,
        Datatype::FloatingPoint { size: 8, .. } => T::F64,
        // Byte 13 is the number of bits of the exponent; bfloat16 has 8.
        Datatype::FloatingPoint { size: 2, .. }
            if dataset.raw_datatype().is_ok_and(|raw| raw.get(13) == Some(&5)) =>
        {
            T::F16
        }
        Datatype::FixedPoint { size, signed, .. } => match (size, signed) {
            (1, true) => T::I8,
            (1, false) => T::U8,
            (2, true) => T::I16,
            (2, false) => T::U16,
            (4, true) => T::I32,
            (4, false) => T::U32,
            (8, true) => T::I64,
            (8, false) => T::U64,
            _ => T::Other,
        },
        Datatype::String { .. } => T::Text,
        _ => T::Other,
    }
}

/// A number of half precision, which the crate does not convert.
#[derive(Clone)]
struct Half(half::f16);

impl H5Type for Half {
    fn hdf5_type() -> Datatype {
        Datatype::FloatingPoint { size: 2, byte_order: ByteOrder::LittleEndian }
    }

    fn from_bytes(bytes: &[u8], ty: &Datatype) -> Result<Self, Error> {
        match (bytes.first_chunk(), ty) {
            (Some(bytes), Datatype::FloatingPoint { size: 2, byte_order }) => {
                Ok(Self(match byte_order {
                    ByteOrder::LittleEndian => half::f16::from_le_bytes(*bytes),
                    ByteOrder::BigEndian => half::f16::from_be_bytes(*bytes),
                }))
            }
            _ => Err(Error::InvalidData("half precision in another size".into())),
        }
    }

    fn element_size(_: &Datatype) -> usize {
        2
    }
}

/// Number of rows of a dataset that are read at a time, unless it is stored in larger chunks.
const ROWS: u64 = 1 << 17;

/// Selections of rows to read in sequence. Each ends at a chunk boundary, so that no rows of another selection are
/// decompressed with it.
fn selections(dataset: &Dataset, rows: &Rows) -> Vec<SliceInfo> {
    let all = SliceInfoElem::Slice { start: 0, end: u64::MAX, step: 1 };
    let of = |first: Option<SliceInfoElem>| {
        let mut selections = vec![all.clone(); dataset.ndim()];
        if let (Some(to), Some(first)) = (selections.first_mut(), first) {
            *to = first;
        }
        SliceInfo { selections }
    };
    let total = dataset.shape().first().copied().unwrap_or(0);
    let (start, end) = match rows {
        Rows::Frame(frame) => return vec![of(Some(SliceInfoElem::Index(*frame)))],
        Rows::All => (0, total),
        Rows::Some(rows) => (rows.start, rows.end.min(total)),
    };
    if end.saturating_sub(start) <= ROWS {
        let first = SliceInfoElem::Slice { start, end, step: 1 };
        return vec![of(Some(first).filter(|_| matches!(rows, Rows::Some(_))))];
    }
    let chunk = dataset.chunks().and_then(|chunks| chunks.first().copied()).unwrap_or(1).max(1);
    let step = ROWS.div_ceil(u64::from(chunk)).saturating_mul(u64::from(chunk));
    let mut parts = Vec::new();
    let mut at = start;
    while at < end {
        // Ends at a chunk boundary.
        let next = (at / step).saturating_add(1).saturating_mul(step).min(end);
        parts.push(of(Some(SliceInfoElem::Slice { start: at, end: next, step: 1 })));
        at = next;
    }
    parts
}

/// Reads values of a dataset. Fails if they need more bytes than the file's size warrants: chunks that were never
/// written take no space in the file, so a small file may declare a huge dataset.
fn numbers(
    dataset: &Dataset,
    ty: AttributeType,
    rows: &Rows,
    limit: usize,
) -> Result<Data, ReadError> {
    use AttributeType as T;
    let Some(size) = ty.size() else { return Ok(Data::NONE) };
    let (first, rest) = dataset.shape().split_first().map_or((1, &[][..]), |(n, rest)| (*n, rest));
    let some = match rows {
        Rows::All => first,
        Rows::Some(some) => some.end.min(first).saturating_sub(some.start),
        Rows::Frame(_) => 1,
    };
    let packed = Packed::of(dataset)?;
    // Integers and unpacked values are held in 8 bytes, half precision in 4.
    let wide = packed.is_some() || matches!(Data::for_type(ty), Data::Int(_));
    let size = if wide { 8 } else { size.max(4) };
    // Empty rows take time as well, so they count as one byte.
    let bytes = rest.iter().fold(some.saturating_mul(size), |n, d| n.saturating_mul((*d).max(1)));
    if bytes > limit as u64 {
        let what = format!("dataset `{}`", dataset.name());
        return Err(ReadError::TooLarge { what, limit: limit as u64 });
    }
    let mut data = Data::for_type(ty);
    for selection in selections(dataset, rows) {
        /// Reads values of one type and converts them.
        macro_rules! read {
            ($number:ty, $v:ident, $target:ty) => {{
                let read = dataset.read_slice::<$number>(&selection).map_err(failed)?;
                $v.extend(read.iter().map(|x| *x as $target));
            }};
        }
        match (&mut data, ty) {
            (Data::F32(v), T::F16) => {
                let read = dataset.read_slice::<Half>(&selection).map_err(failed)?;
                v.extend(read.iter().map(|x| x.0.to_f32()));
            }
            (Data::F32(v), T::F32) => read!(f32, v, f32),
            (Data::F64(v), T::F64) => read!(f64, v, f64),
            (Data::Int(v), T::I8) => read!(i8, v, i64),
            (Data::Int(v), T::U8) => read!(u8, v, i64),
            (Data::Int(v), T::I16) => read!(i16, v, i64),
            (Data::Int(v), T::U16) => read!(u16, v, i64),
            (Data::Int(v), T::I32) => read!(i32, v, i64),
            (Data::Int(v), T::U32) => read!(u32, v, i64),
            (Data::Int(v), T::I64) => read!(i64, v, i64),
            (Data::Int(v), T::U64) => {
                let read = dataset.read_slice::<u64>(&selection).map_err(failed)?;
                v.extend(read.iter().map(|x| i64::try_from(*x).unwrap_or(i64::MAX)));
            }
            _ => {}
        }
    }
    Ok(match packed {
        Some(packed) => packed.unpacked(data),
        None => data,
    })
}

/// How netCDF packed the values of a dataset.
struct Packed {
    scale: f64,
    offset: f64,
    /// The stored number of a missing value.
    missing: Option<f64>,
}

impl Packed {
    /// `None` if the values are stored as they are.
    fn of(dataset: &Dataset) -> Result<Option<Self>, ReadError> {
        let of = |name: &str| {
            let Ok(attribute) = dataset.attribute(name) else { return Ok(None) };
            let bad = || ReadError::Unsupported {
                what: format!("dataset `{}`, whose `{name}` is not a number,", dataset.name()),
                advice: "write that attribute as a number, or the values unpacked, without it",
            };
            value(&attribute).map(Some).ok_or_else(bad)
        };
        let (scale, offset) = (of("scale_factor")?, of("add_offset")?);
        if scale.is_none() && offset.is_none() {
            return Ok(None);
        }
        let missing = dataset.attribute("_FillValue").ok();
        Ok(Some(Self {
            scale: scale.unwrap_or(1.0),
            offset: offset.unwrap_or(0.0),
            missing: missing.as_ref().and_then(value),
        }))
    }

    fn unpacked(&self, data: Data) -> Data {
        let one = |x: f64| match self.missing {
            Some(missing) if missing == x => f64::NAN,
            _ => x * self.scale + self.offset,
        };
        Data::F64(match data {
            Data::F32(v) => v.into_iter().map(|x| one(f64::from(x))).collect(),
            Data::F64(v) => v.into_iter().map(one).collect(),
            Data::Int(v) => v.into_iter().map(|x| one(x as f64)).collect(),
        })
    }
}

/// Memory that a process may still allocate, in bytes; `None` if the system does not report it.
fn memory_left() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Min size of a frame in bytes from which it is compared with the available memory.
const LARGE: u64 = 1 << 28;

/// Refuses a frame that does not fit in memory: HDF5 is not read in parts.
fn fits(particles: u64, bytes: u64) -> Result<(), ReadError> {
    if bytes < LARGE {
        return Ok(());
    }
    // A test allocation fails at a memory limit of the process. The system may grant more than it has, so the
    // free memory is compared too.
    let mut probe: Vec<u8> = Vec::new();
    let probed = usize::try_from(bytes).is_ok_and(|bytes| probe.try_reserve_exact(bytes).is_ok());
    if probed && memory_left().is_none_or(|left| bytes <= left) {
        return Ok(());
    }
    let mib = |bytes: u64| bytes >> 20;
    let left =
        memory_left().map_or(String::new(), |left| format!(" of {} MiB that are free", mib(left)));
    Err(ReadError::Unsupported {
        what: format!("a frame of {particles} particles, which takes {} MiB{left},", mib(bytes)),
        advice: "write it as VTU, PLY, NPZ or BGEO, which are read in parts, or as several frames",
    })
}

/// Reads a list of integers.
fn list(group: &Group, name: &str, limit: usize) -> Result<Vec<u64>, ReadError> {
    let dataset = group.dataset(name).map_err(failed)?;
    let data = numbers(&dataset, type_of(&dataset), &Rows::All, limit)?;
    let value = |i| data.f64(i).map_or(0, |x| x as u64);
    Ok((0..data.len()).map(value).collect())
}

/// The first of these attributes that is a number.
fn number(group: &Group, names: &[&str]) -> Option<f64> {
    let mut all = names.iter().filter_map(|name| group.attribute(name).ok());
    all.find_map(|attribute| value(&attribute))
}

/// The number in an attribute.
fn value(attribute: &Attribute) -> Option<f64> {
    attribute.read_as_f64().ok().or_else(|| attribute.read_1d::<f64>().ok()?.first().copied())
}

impl Array {
    fn new(name: &str, dataset: Dataset, rows: Rows) -> Self {
        Self { name: name.into(), dataset, rows }
    }

    /// Whether it is a vector whose components are stored one after the other, or a column of MATLAB, which stores a
    /// row.
    fn turned(&self) -> bool {
        let turned = match self.dataset.shape() {
            [1, n] => *n > 3,
            [2 | 3, n] => *n > 3 && names::is_vector(&self.name),
            _ => false,
        };
        turned && matches!(self.rows, Rows::All)
    }

    /// Adds a unit that is stored beside the values to a name with a meaning, where columns of a table have it.
    fn with_unit(mut self) -> Self {
        let unit = ["units", "unit"].into_iter().find_map(|name| {
            let unit = self.dataset.attribute(name).ok()?.read_string().ok()?;
            Some(unit.trim_matches(|c: char| c == '\0' || c.is_whitespace()).to_string())
        });
        let unit = unit.filter(|unit| unit.starts_with(char::is_alphabetic) && unit.len() <= 16);
        if let Some(unit) = unit.filter(|_| names::known(&names::plain(&self.name))) {
            let name = format!("{} [{unit}]", self.name);
            if names::plain(&name) == names::plain(&self.name) {
                self.name = name;
            }
        }
        self
    }

    /// Number of particles, and of values per particle.
    fn shape(&self) -> (u64, usize) {
        let shape = self.dataset.shape();
        if let ([components, count], true) = (shape, self.turned()) {
            return (*count, *components as usize);
        }
        let shape = match self.rows {
            Rows::Frame(_) => shape.get(1..).unwrap_or_default(),
            _ => shape,
        };
        let (rows, rest) = shape.split_first().map_or((1, &[][..]), |(rows, rest)| (*rows, rest));
        let components = rest.iter().fold(1_u64, |n, d| n.saturating_mul(*d));
        let rows = match &self.rows {
            Rows::Some(some) => some.end.min(rows).saturating_sub(some.start),
            _ => rows,
        };
        (rows, usize::try_from(components).unwrap_or(usize::MAX))
    }
}

impl Frame {
    fn read(self, asked: &Asked, limit: usize) -> Result<Particles, ReadError> {
        let Self { time, mut parts, pieces } = self;
        if parts.iter().any(Part::has_some) {
            parts.retain(Part::has_some);
        }
        let mut table = Table::new(asked);
        table.time = time;
        let several = parts.len() > 1;
        if several {
            let (count, names) = (parts.len(), listed(parts.iter().map(|part| part.name.as_str())));
            table.warnings.push(match pieces {
                true => format!("{count} groups are read as pieces of one frame: {names}"),
                false => format!(
                    "{count} groups are joined: {names}; if some of them are walls, give the file of the water alone"
                ),
            });
        }
        let parts: Vec<Part> = parts.into_iter().map(Part::without_empty).collect();
        // Memory for the arrays as read, for the particles, and for results computed from them; in total 4 times the
        // array size was measured.
        let wanted = parts.iter().flat_map(|part| &part.arrays).filter(|a| asked.wants(&a.name));
        let values = wanted.clone().map(|array| {
            let (rows, components) = array.shape();
            rows.saturating_mul(components as u64)
                .saturating_mul(type_of(&array.dataset).size().unwrap_or(0).max(4))
        });
        let bytes = values.fold(0_u64, u64::saturating_add).saturating_mul(4);
        let particles = wanted.map(|array| array.shape().0).max().unwrap_or(0);
        fits(particles, bytes)?;
        let mut all: Vec<(String, usize, Data, usize)> = Vec::new();
        let count = parts.len();
        for (i, part) in parts.into_iter().enumerate() {
            table.warnings.extend(part.warnings);
            for array in part.arrays {
                let ((rows, components), ty) = (array.shape(), type_of(&array.dataset));
                let known = table.attributes.iter().any(|a| a.name == array.name);
                let wanted = match known {
                    true => asked.wants(&array.name),
                    false => table.list(&array.name, components, ty),
                };
                if !wanted || ty.size().is_none() {
                    continue;
                }
                let data = numbers(&array.dataset, ty, &array.rows, limit)?;
                let turned = array.turned();
                let data = if turned { data.turned(components, 0, components) } else { data };
                let expected = rows.saturating_mul(components as u64);
                if data.len() as u64 != expected {
                    let (attribute, found) = (array.name, data.len() as u64);
                    return Err(ReadError::Length { attribute, expected, found });
                }
                let same = all.iter_mut().find(|(name, ..)| *name == array.name);
                match same {
                    Some((_, before, to, parts)) if *before == components && *parts == i => {
                        *parts += usize::from(to.append(data));
                    }
                    None if i == 0 => all.push((array.name, components, data, 1)),
                    _ => {}
                }
            }
        }
        for (name, components, data, parts) in all {
            if parts < count {
                table
                    .warnings
                    .push(format!("attribute `{name}` is dropped: not all groups have it"));
                continue;
            }
            table.push(&name, components, data);
        }
        table.assemble(Format::Hdf5)
    }
}

impl Part {
    fn has_some(&self) -> bool {
        self.arrays.iter().any(|array| array.shape().0 > 0)
    }

    /// Removes empty arrays, unless all are empty: PySPH has an empty array for each property that is not
    /// stored.
    fn without_empty(mut self) -> Self {
        let some = self.has_some();
        self.arrays.retain(|array| !some || array.shape().0 > 0);
        self
    }
}

/// The last component of a path.
fn leaf(path: &str) -> String {
    path.rsplit('/').next().unwrap_or(path).to_string()
}

/// The first of some names.
pub(super) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let first: Vec<_> = names.by_ref().take(24).collect();
    let more = match names.count() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{}{more}", first.join(", "))
}
