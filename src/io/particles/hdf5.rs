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
//!   have different times (see `hdf5_groups`).
//! - Gadget and SWIFT: the gas, group `PartType0`; the time is attribute `Time` of `Header`.
//! - H5MD: `particles/NAME/position/value` of shape (frames, particles, 3), and other properties likewise.
//! - Positions of shape (frames, particles, 3) in any group, or components of shape (frames, particles). Other arrays
//!   of the group with the same number of frames are attributes of these particles.
//! - Other files: the group with an array of positions; the particles of several such groups are joined.
//!
//! A unit in attribute `units` or `unit` of an array is added to its name: `position [mm]`.
//!
//! Of an HDF5 file only arrays of the requested frame that have a meaning are read. Memory use is limited by the
//! file's size.

use std::collections::{BTreeMap, HashMap};
use std::io::{Read as _, Seek as _, SeekFrom};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use hdf5_reader::error::Error;
use hdf5_reader::group::Group;
use hdf5_reader::storage::{BytesStorage, FileStorage, Storage};
use hdf5_reader::{
    ByteOrder, Dataset, Datatype, H5Type, Hdf5File, OpenOptions, SliceInfo, SliceInfoElem,
};

use super::asked::Asked;
use super::bytes::unpack_limit;
use super::cells;
use super::columns::{AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::hdf5_groups::{self, Order};
use super::hdf5_links;
use super::names;
use super::vtk_xml::{is_point, mesh_warning};
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
            return of_vtk(&grid, self.limit);
        }
        let mut frames = of_others(&self.file, &root, self.limit)?;
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
    // Integers are held in 8 bytes, half precision in 4.
    let size = if matches!(Data::for_type(ty), Data::Int(_)) { 8 } else { size.max(4) };
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
    Ok(data)
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
    let all = names.iter().filter_map(|name| group.attribute(name).ok());
    all.into_iter().find_map(|attribute| {
        attribute.read_as_f64().ok().or_else(|| attribute.read_1d::<f64>().ok()?.first().copied())
    })
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

/// The frames of a VTKHDF file.
fn of_vtk(grid: &Group, limit: usize) -> Result<Vec<Frame>, ReadError> {
    let kind = |group: &Group| {
        let attribute = group.attribute("Type").ok();
        attribute.and_then(|a| a.read_string().ok()).unwrap_or_default()
    };
    let own = kind(grid);
    let own = own.trim_end_matches('\0');
    let blocks: Vec<Group> = match own {
        "PolyData" | "UnstructuredGrid" => vec![grid.clone()],
        "MultiBlockDataSet" | "PartitionedDataSetCollection" => {
            let groups = grid.groups().map_err(failed)?;
            groups.into_iter().filter(|group| group.dataset("Points").is_ok()).collect()
        }
        _ => {
            return Err(ReadError::Unsupported {
                what: format!("VTKHDF of type {own}"),
                advice: "particles are PolyData or UnstructuredGrid: save one of these",
            });
        }
    };
    let mut frames: Vec<Frame> = Vec::new();
    for block in &blocks {
        let steps = block.group("Steps").or_else(|_| grid.group("Steps")).ok();
        let counts = list(block, "NumberOfPoints", limit)?;
        let steps = steps.as_ref().map(|steps| Steps::of(steps, block, limit)).transpose()?;
        let (on_cells, told) = of_cells(block, &counts, limit)?;
        let total = steps.as_ref().map_or(1, |steps| steps.values.len()).max(1);
        if total > GROUPS {
            return Err(ReadError::malformed("some steps", total.to_string(), Place::Unknown));
        }
        for step in 0..total {
            let (first, parts) = match &steps {
                Some(steps) => steps.at(step),
                None => (0, 0..counts.len() as u64),
            };
            let some = parts.start as usize..parts.end as usize;
            let points = counts.get(some).unwrap_or_default();
            let points = points.iter().fold(0_u64, |sum, n| sum.saturating_add(*n));
            let rows = |first: u64| Rows::Some(first..first.saturating_add(points));
            let dataset = block.dataset("Points").map_err(failed)?;
            let mut arrays = vec![Array::new("Points", dataset, rows(first))];
            let data = block.group("PointData").ok().map(|data| data.datasets());
            for dataset in data.transpose().map_err(failed)?.unwrap_or_default() {
                let name = leaf(dataset.name());
                let offsets = steps.as_ref().and_then(|steps| steps.offset(&name, step));
                arrays.push(Array::new(&name, dataset, rows(offsets.unwrap_or(first))));
            }
            for (name, dataset) in &on_cells {
                let offset = steps.as_ref().and_then(|steps| steps.offset_of_cells(name, step));
                let name = cells::column_name(name);
                arrays.push(Array::new(&name, dataset.clone(), rows(offset.unwrap_or(first))));
            }
            let part = Part {
                name: leaf(block.name()),
                arrays,
                warnings: mesh(block, limit).into_iter().chain(told.clone()).collect(),
            };
            if frames.len() <= step {
                let time = steps.as_ref().and_then(|steps| steps.values.get(step).copied());
                frames.push(Frame { time, parts: Vec::new(), pieces: false });
            }
            if let Some(frame) = frames.get_mut(step) {
                frame.parts.push(part);
            }
        }
    }
    if frames.is_empty() {
        return Err(ReadError::malformed("blocks of points", "none", Place::Unknown));
    }
    Ok(frames)
}

/// A dataset and its name.
type NamedSet = (String, Dataset);

/// The attributes of the cells of a VTKHDF block, if each cell is the point of the same index, and warnings about
/// cell attributes that are not used. `points` has the number of points of each part.
fn of_cells(
    block: &Group,
    points: &[u64],
    limit: usize,
) -> Result<(Vec<NamedSet>, Vec<String>), ReadError> {
    let datasets = |name: &str| {
        let data = block.group(name).ok().map(|data| data.datasets());
        let all = data.transpose().map_err(failed)?.unwrap_or_default();
        Ok::<Vec<_>, ReadError>(all.into_iter().map(|set| (leaf(set.name()), set)).collect())
    };
    let some = |(_, set): &NamedSet| set.shape().first().is_some_and(|rows| *rows > 0);
    let of_points = datasets("PointData")?;
    let plain: Vec<String> = of_points.iter().map(|(name, _)| names::plain(name)).collect();
    let (double, found): (Vec<NamedSet>, Vec<NamedSet>) = datasets("CellData")?
        .into_iter()
        .filter(some)
        .partition(|(name, _)| plain.contains(&names::plain(name)));
    let double = double.into_iter().map(|(name, _)| name);
    let double: Vec<String> = double.filter(|name| !names::is_ghost(name)).collect();
    let mut told: Vec<String> = cells::unused(&double, cells::DOUBLED).into_iter().collect();
    if let (false, Some(why)) = (found.is_empty(), no_vertices(block, points, limit)) {
        let names: Vec<String> = found.into_iter().map(|(name, _)| name).collect();
        told.extend(cells::unused(&names, &cells::no_particles(&why)));
        return Ok((Vec::new(), told));
    }
    Ok((found, told))
}

/// Why the cells of a VTKHDF block are not its points in the same order; `None` if each cell is one point.
fn no_vertices(block: &Group, points: &[u64], limit: usize) -> Option<String> {
    let vertices = block.group("Vertices").ok();
    let group = vertices.as_ref().unwrap_or(block);
    let all = |group: &Group, name: &str| {
        list(group, name, limit).map_err(|error| format!("`{name}` cannot be read ({error})"))
    };
    let sum = |list: &[u64]| list.iter().fold(0_u64, |sum, n| sum.saturating_add(*n));
    let others = ["Lines", "Polygons", "Strips"].into_iter().filter_map(|name| {
        let group = block.group(name).ok()?;
        Some(sum(&list(&group, "NumberOfCells", limit).ok()?))
    });
    let others = others.fold(0, u64::saturating_add);
    if others > 0 {
        return Some(format!("{others} of the cells are lines or faces"));
    }
    let lists = ["NumberOfCells", "Offsets", "Connectivity"].map(|name| all(group, name));
    let [Ok(counts), Ok(offsets), Ok(connectivity)] = lists else {
        return lists.into_iter().find_map(Result::err);
    };
    if counts != points {
        let (cells, points) = (sum(&counts), sum(points));
        return Some(format!("there are {cells} cells for {points} points"));
    }
    // Steps may share their cells.
    let counted = |from: &mut std::slice::Iter<'_, u64>, count: u64| {
        (0..count).all(|i| from.next() == Some(&i))
    };
    let (mut offsets, mut connectivity) = (offsets.iter(), connectivity.iter());
    let in_order = points.iter().all(|n| {
        (offsets.len() == 0 || counted(&mut offsets, n.saturating_add(1)))
            && (connectivity.len() == 0 || counted(&mut connectivity, *n))
    });
    let read = offsets.len() == 0 && connectivity.len() == 0;
    (!in_order || !read).then(|| "the cells are not the points in their order".to_string())
}

/// Where the particles of each step begin.
struct Steps {
    values: Vec<f64>,
    points: Vec<u64>,
    parts: Vec<u64>,
    counts: Vec<u64>,
    /// Names of the arrays that have an offset of their own for each step, with these offsets: arrays of points, and
    /// arrays of cells.
    arrays: [Vec<(String, Vec<u64>)>; 2],
}

impl Steps {
    fn of(steps: &Group, block: &Group, limit: usize) -> Result<Self, ReadError> {
        let dataset = steps.dataset("Values").map_err(failed)?;
        let data = numbers(&dataset, type_of(&dataset), &Rows::All, limit)?;
        let values: Vec<f64> = (0..data.len()).filter_map(|i| data.f64(i)).collect();
        // In a collection each block has its own steps.
        let own = block.group("Steps").unwrap_or_else(|_| steps.clone());
        let mut arrays = [const { Vec::new() }; 2];
        for (to, name) in arrays.iter_mut().zip(["PointDataOffsets", "CellDataOffsets"]) {
            let Ok(group) = own.group(name) else { continue };
            for dataset in group.datasets().map_err(failed)? {
                let name = leaf(dataset.name());
                let offsets = list(&group, &name, limit)?;
                to.push((name, offsets));
            }
        }
        let points = list(&own, "PointOffsets", limit)?;
        let or = |name: &str, each: u64| match own.dataset(name) {
            Ok(_) => list(&own, name, limit),
            Err(_) => Ok(vec![each; values.len()]),
        };
        let (parts, counts) = (or("PartOffsets", 0)?, or("NumberOfParts", 1)?);
        Ok(Self { values, points, parts, counts, arrays })
    }

    /// The first point of a step, and its parts.
    fn at(&self, step: usize) -> (u64, Range<u64>) {
        let of = |list: &[u64]| list.get(step).copied().unwrap_or(0);
        let part = of(&self.parts);
        (of(&self.points), part..part.saturating_add(of(&self.counts)))
    }

    fn offset(&self, name: &str, step: usize) -> Option<u64> {
        let [arrays, _] = &self.arrays;
        let (_, offsets) = arrays.iter().find(|(array, _)| array == name)?;
        offsets.get(step).copied()
    }

    fn offset_of_cells(&self, name: &str, step: usize) -> Option<u64> {
        let [_, arrays] = &self.arrays;
        let (_, offsets) = arrays.iter().find(|(array, _)| array == name)?;
        offsets.get(step).copied()
    }
}

/// Warning about the vertices of a mesh.
fn mesh(block: &Group, limit: usize) -> Option<String> {
    let cells = |name: &str| {
        let group = block.group(name).ok()?;
        Some(
            list(&group, "NumberOfCells", limit)
                .ok()?
                .iter()
                .fold(0_u64, |sum, n| sum.saturating_add(*n)),
        )
    };
    let polygons = cells("Polygons").unwrap_or(0).saturating_add(cells("Strips").unwrap_or(0));
    if polygons > 0 && cells("Vertices").unwrap_or(0) == 0 {
        return Some(mesh_warning(polygons, "polygons"));
    }
    let types = list(block, "Types", limit).unwrap_or_default();
    let more = types.iter().filter(|ty| !is_point(**ty as f64)).count();
    (2 * more > types.len()).then(|| mesh_warning(types.len() as u64, "cells"))
}

/// Frames of positions with an additional dimension, and their times.
fn stacked(arrays: &[Array], limit: usize) -> Result<Option<Frames>, ReadError> {
    let names: Vec<&str> = arrays.iter().map(|array| array.name.as_str()).collect();
    let apart = names::have_positions(&names);
    let count = arrays.iter().find_map(|array| match array.dataset.shape() {
        [count, _, 2 | 3] if names::is_position(&array.name) => Some(*count),
        [count, particles] if apart && names::is_component(&array.name) && *particles > 3 => {
            Some(*count)
        }
        _ => None,
    });
    let Some(count) = count else { return Ok(None) };
    let of = |array: &Array| array.dataset.shape().first() == Some(&count);
    let times = arrays
        .iter()
        .find(|array| names::is_time(&array.name) && array.dataset.ndim() == 1 && of(array));
    let times =
        times.map(|array| numbers(&array.dataset, type_of(&array.dataset), &Rows::All, limit));
    let times = times.transpose()?;
    let frames = (0..count.min(GROUPS as u64)).map(|frame| {
        let own = arrays.iter().filter(|array| !names::is_time(&array.name)).map(|array| {
            let rows = if of(array) { Rows::Frame(frame) } else { Rows::All };
            Array::new(&array.name, array.dataset.clone(), rows)
        });
        (times.as_ref().and_then(|times| times.f64(frame as usize)), own.collect())
    });
    Ok(Some(frames.collect()))
}

/// The last component of a path.
fn leaf(path: &str) -> String {
    path.rsplit('/').next().unwrap_or(path).to_string()
}

/// The time of each frame, and its attributes.
type Frames = Vec<(Option<f64>, Vec<Array>)>;

/// A group with positions.
struct Found {
    path: String,
    frames: Frames,
}

impl Found {
    /// The dataset of the positions, which differs between groups unless one is a link to the other.
    fn address(&self) -> u64 {
        let mut arrays = self.frames.iter().flat_map(|(_, arrays)| arrays);
        let position =
            |array: &&Array| names::is_position(&array.name) || names::is_component(&array.name);
        arrays.find(position).map_or(u64::MAX, |array| array.dataset.address())
    }

    /// The time, unless there are several.
    fn time(&self) -> Option<f64> {
        match self.frames.as_slice() {
            [(time, _)] => *time,
            _ => None,
        }
    }
}

/// The first of some names.
fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let first: Vec<_> = names.by_ref().take(24).collect();
    let more = match names.count() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!("{}{more}", first.join(", "))
}

/// The frames of a file that is not VTKHDF, found by its arrays and by the names of its groups.
fn of_others(file: &Hdf5File, root: &Group, limit: usize) -> Result<Vec<Frame>, ReadError> {
    let mut search = Search { file, limit, looked: 0, found: vec![], seen: vec![], links: vec![] };
    search.group(root, ("", 0), None)?;
    let Search { mut found, seen, links, .. } = search;
    if found.is_empty() && !links.is_empty() {
        let links = listed(links.iter().map(String::as_str));
        return Err(ReadError::Unsupported {
            what: format!("an HDF5 file that has no positions but links to other files ({links})"),
            advice: "give the file that a link leads to, or copy its data into this one",
        });
    }
    if found.is_empty() {
        let names: Vec<_> = seen.into_iter().take(24).collect();
        let found = if names.is_empty() { "no arrays at all".into() } else { names.join(", ") };
        return Err(ReadError::NoPositions { expected: names::POSITION_NAMES, found });
    }
    let mut told = Vec::new();
    if !links.is_empty() {
        let links = listed(links.iter().map(String::as_str));
        told.push(format!("links to other files are not followed: {links}"));
    }
    // Of groups with the same positions, the one with the most arrays is read, and of these one with a number.
    let worth = |found: &Found| {
        let arrays = found.frames.first().map_or(0, |(_, arrays)| arrays.len());
        (arrays, found.path.contains(|c: char| c.is_ascii_digit()))
    };
    let mut best = HashMap::new();
    for found in &found {
        let best = best.entry(found.address()).or_insert((worth(found), found.path.clone()));
        if worth(found) > best.0 {
            *best = (worth(found), found.path.clone());
        }
    }
    found.retain(|found| best.get(&found.address()).is_some_and(|(_, path)| *path == found.path));
    // Groups with other names beside the fluid hold walls. Gadget calls gas `PartType0`.
    let gas = |found: &Found| found.path.to_lowercase().split('/').any(|name| name == "parttype0");
    let fluid = |found: &Found| {
        let path = found.path.to_lowercase();
        ["fluid", "water", "liquid"].iter().any(|name| path.contains(name))
    };
    let mut keep = |kept: &dyn Fn(&Found) -> bool| {
        if !found.iter().any(kept) {
            return;
        }
        let (fluids, passed): (Vec<_>, Vec<_>) = found.drain(..).partition(kept);
        if !passed.is_empty() {
            let passed = listed(passed.iter().map(|found| found.path.as_str()));
            told.push(format!("groups that are not fluid are not read: {passed}"));
        }
        found = fluids;
    };
    keep(&gas);
    keep(&fluid);
    let groups: Vec<_> = found.iter().map(|found| (found.path.as_str(), found.time())).collect();
    let mut frames = match hdf5_groups::order(&groups) {
        Order::Unsure if found.iter().all(|found| found.frames.len() < 2) => {
            let groups = listed(groups.iter().map(|(path, _)| *path));
            return Err(ReadError::Unsupported {
                what: format!(
                    "an HDF5 file of several groups whose names do not say what they are ({groups})"
                ),
                advice: "rename them, in h5py with h.move('OLD', 'NEW'): `water` is read alone, `step_1` and \
                         `step_2` are frames, `rank_1` and `rank_2` are pieces of one frame",
            });
        }
        Order::Frames(of) => {
            let (mut all, mut beside) = (BTreeMap::<usize, Vec<Found>>::new(), Vec::new());
            for (found, frame) in found.into_iter().zip(of) {
                match frame {
                    Some(frame) => all.entry(frame).or_default().push(found),
                    None => beside.push(found.path),
                }
            }
            if !beside.is_empty() {
                let beside = listed(beside.iter().map(String::as_str));
                told.push(format!("groups beside the frames are not read: {beside}"));
            }
            all.into_values().flat_map(merged).collect()
        }
        Order::Together | Order::Unsure => merged(found),
    };
    let parts = frames.iter_mut().filter_map(|frame| frame.parts.first_mut());
    parts.for_each(|part| part.warnings.extend(told.clone()));
    Ok(frames)
}

/// Joins groups frame by frame.
fn merged(found: Vec<Found>) -> Vec<Frame> {
    let paths: Vec<_> = found.iter().map(|found| found.path.as_str()).collect();
    let pieces = hdf5_groups::are_pieces(&paths);
    let mut frames: Vec<Frame> = Vec::new();
    for Found { path, frames: own } in found {
        for (i, (time, arrays)) in own.into_iter().enumerate() {
            if frames.len() <= i {
                frames.push(Frame { time, parts: Vec::new(), pieces });
            }
            if let Some(frame) = frames.get_mut(i) {
                frame.parts.push(Part { name: path.clone(), arrays, warnings: Vec::new() });
            }
        }
    }
    frames
}

/// A search for positions.
struct Search<'a> {
    file: &'a Hdf5File,
    limit: usize,
    /// Number of groups that were searched.
    looked: usize,
    found: Vec<Found>,
    /// Arrays, for messages.
    seen: Vec<String>,
    /// Links to other files, for messages.
    links: Vec<String>,
}

impl Search<'_> {
    /// Searches this group and those below it. `time` is that of the groups around it.
    fn group(
        &mut self,
        group: &Group,
        (path, depth): (&str, usize),
        time: Option<f64>,
    ) -> Result<(), ReadError> {
        self.looked += 1;
        if self.looked > GROUPS || depth > DEEP {
            return Ok(());
        }
        let (groups, datasets) = group.members().map_err(failed)?;
        self.links.extend(hdf5_links::external(self.file, group, path).map_err(failed)?);
        let arrays: Vec<Array> = datasets
            .into_iter()
            .map(|dataset| Array::new(&leaf(dataset.name()), dataset, Rows::All).with_unit())
            .collect();
        let time = number(group, &["TimeValue", "time", "Time", "t"])
            .or_else(|| self.time(&arrays))
            .or(time);
        self.seen.extend(arrays.iter().map(|array| match array.dataset.dtype() {
            Datatype::Compound { .. } => format!(
                "{path}/{} (a table: save each of its columns as a dataset, h[name] = table[name] in h5py)",
                array.name
            ),
            _ => format!("{path}/{}", array.name),
        }));
        let names: Vec<&str> = arrays.iter().map(|array| array.name.as_str()).collect();
        if names::may_have_positions(&names) {
            let frames = stacked(&arrays, self.limit)?.unwrap_or_else(|| vec![(time, arrays)]);
            self.found.push(Found { path: path.into(), frames });
        }
        // H5MD: one group per property, with its values in one dataset.
        let value = |group: &Group| {
            let dataset = group.dataset("value").ok()?;
            let frames = dataset.shape().first().copied().filter(|_| dataset.ndim() >= 2)?;
            Some((leaf(group.name()), dataset, frames))
        };
        let position = groups.iter().find(|group| leaf(group.name()) == "position");
        if let Some((_, _, frames)) = position.and_then(value).filter(|(_, d, _)| d.ndim() == 3) {
            let all: Vec<_> = groups.iter().filter_map(value).collect();
            let times = position.and_then(|position| {
                let dataset = position.dataset("time").ok()?;
                numbers(&dataset, type_of(&dataset), &Rows::All, self.limit).ok()
            });
            let frames = (0..frames.min(GROUPS as u64)).map(|frame| {
                let own = all.iter().filter(|(_, _, count)| *count > frame);
                let arrays = own.map(|(name, dataset, _)| {
                    Array::new(name, dataset.clone(), Rows::Frame(frame)).with_unit()
                });
                (times.as_ref().and_then(|times| times.f64(frame as usize)), arrays.collect())
            });
            self.found.push(Found { path: path.into(), frames: frames.collect() });
            return Ok(());
        }
        for inner in &groups {
            let path = format!("{path}/{}", leaf(inner.name()));
            self.group(inner, (&path, depth + 1), time)?;
        }
        Ok(())
    }

    /// The time in a dataset of one value.
    fn time(&self, arrays: &[Array]) -> Option<f64> {
        let time = arrays.iter().find(|array| {
            let one = array.dataset.shape().iter().all(|n| *n == 1);
            one && ["time", "times", "timevalue", "t"].contains(&names::plain(&array.name).as_str())
        })?;
        numbers(&time.dataset, type_of(&time.dataset), &Rows::All, self.limit).ok()?.f64(0)
    }
}
