//! Reads NumPy arrays (NPY, versions 1 to 3) and zips of them (NPZ).
//!
//! An NPY file is `\x93NUMPY`, two bytes of version, the length of the header (`u16`, from version 2 `u32`, both
//! little-endian), a header that is a Python dict `{'descr': '<f4', 'fortran_order': False, 'shape': (10, 3), }`,
//! and the values. Only the three known keys of the header are parsed. `descr` may be a list of fields,
//! `[('pos', '<f4', (3,)), ...]`.
//!
//! A row is a particle. The array has shape (n, 3) or (3, n), in C or Fortran order. Two columns are two-dimensional
//! positions; the last three of six columns are velocities. In an array of shape (t, n, 3) the first dimension counts
//! frames, which are read one by one: see `steps`. In an NPZ file, an array `time` of one value is the frame's time.
//!
//! The reader is our own, because the crate npyz (0.9) brings a whole Python parser with big integers for
//! three keys, returns values only in the type in which they are stored, and does not check the shape against
//! the size of the file.

use std::io::{Cursor as IoCursor, Read};

use super::asked::Asked;
use super::bytes::{Cursor, unpack, unpack_limit};
use super::columns::{Attribute, AttributeType, Column, Data, Table};
use super::error::{Place, ReadError};
use super::names;
use super::npy_header::{Header, One, WIDE, every, header};
use super::rows::{Field, Layout, Rows};
use super::source::{self, Check, Content, Input, Packing, Piece, Source};
use super::{Format, Particles};

/// An array seen as rows.
struct Rowed {
    rows: u64,
    /// Values per row.
    components: usize,
    /// Whether components are stored one after the other.
    transposed: bool,
}

/// Advice for an array of several frames.
const FRAMES: &str =
    "save a file for each: for i, frame in enumerate(a): np.save(f'frame_{i:04d}.npy', frame)";

impl Header {
    fn words(&self) -> String {
        let extents: Vec<_> = self.shape.iter().map(u64::to_string).collect();
        let comma = if self.shape.len() == 1 { "," } else { "" };
        format!("({}{comma}) and dtype {}", extents.join(", "), self.descr)
    }

    fn ty(&self) -> AttributeType {
        self.members.first().map_or(AttributeType::Other, |member| member.ty)
    }

    /// How an array divides into rows, one per particle. `vector` says that its values are vectors with one component
    /// per dimension of space.
    fn rowed(&self, name: &str, vector: bool) -> Result<Rowed, ReadError> {
        let rowed = self.in_rows(name, vector)?;
        // In Fortran order, the elements of one frame of several are not contiguous.
        let strided = self.frame.is_some() && self.fortran;
        Ok(Rowed { transposed: rowed.transposed || strided, ..rowed })
    }

    fn in_rows(&self, name: &str, vector: bool) -> Result<Rowed, ReadError> {
        let count = |n: u64| usize::try_from(n).unwrap_or(usize::MAX);
        let list = |rows| Rowed { rows, components: 1, transposed: false };
        match *self.shape.as_slice() {
            [] => Ok(list(1)),
            [rows] => Ok(list(rows)),
            [1, rows] if !vector => Ok(list(rows)),
            [components @ (2 | 3), rows] if vector && rows >= WIDE => {
                Ok(Rowed { rows, components: count(components), transposed: !self.fortran })
            }
            [rows, components] => {
                let transposed = self.fortran && components > 1;
                Ok(Rowed { rows, components: count(components), transposed })
            }
            [frames, rows, 2 | 3 | 6] => Err(ReadError::Unsupported {
                what: format!(
                    "array `{name}` of shape {}, {frames} frames of {rows} particles,",
                    self.words()
                ),
                advice: FRAMES,
            }),
            _ => Err(ReadError::Unsupported {
                what: format!("array `{name}` of shape {}", self.words()),
                advice: "save an array of shape (n, 3) for each frame: a.reshape(-1, 3)",
            }),
        }
    }

    /// Returns the rows of the array as they are stored after a header of `header` bytes; the number of rows and of
    /// values in each; and warnings about the array. `placed` says that the values are positions, whatever the
    /// array's name.
    fn rows(
        &self,
        header: u64,
        name: &str,
        placed: bool,
        asked: &Asked,
    ) -> Result<(Rows, Rowed, Vec<String>), ReadError> {
        let mut warnings = Vec::new();
        let vector = !self.structured && (placed || names::is_vector(name));
        let rowed = self.rowed(name, vector)?;
        let mut fields = Vec::new();
        let mut big_endian = self.members.first().is_some_and(|member| member.big_endian);
        if self.structured {
            if rowed.components != 1 {
                let (frames, rows) = (rowed.rows, rowed.components);
                return Err(ReadError::Unsupported {
                    what: format!(
                        "array `{name}` of shape {}, {frames} frames of {rows} particles,",
                        self.words()
                    ),
                    advice: FRAMES,
                });
            }
            let used =
                self.members.iter().filter(|m| asked.wants(&m.name) && m.ty.size().is_some());
            big_endian = used.clone().any(|member| member.big_endian);
            if used
                .clone()
                .any(|member| member.big_endian != big_endian && member.ty.size() != Some(1))
            {
                return Err(self.unsupported(name));
            }
            for member in used {
                fields.push(Field::new(&member.name, member.components, member.ty, member.offset)?);
            }
        } else {
            let size = self.ty().size().ok_or_else(|| self.unsupported(name))?;
            let components = rowed.components;
            let first = if vector && components > 3 { 3 } else { components };
            fields.push(Field::new(name, first, self.ty(), 0)?);
            if first < components {
                let velocities = placed && components == 6;
                if velocities {
                    fields.push(Field::new("velocity", 3, self.ty(), 3 * size)?);
                }
                let then = if velocities { "velocities" } else { "not read" };
                let moves = !placed && names::VELOCITY.contains(&names::plain(name).as_str());
                warnings.push(format!(
                    "array `{name}` has {components} columns: the first 3 are taken as {}, the others are {then}",
                    if moves { "velocities" } else { "positions" }
                ));
            }
        }
        let stride = self.size.saturating_mul(rowed.components as u64);
        let before = match self.frame {
            Some(one) if !self.fortran => {
                one.index.saturating_mul(rowed.rows.saturating_mul(stride))
            }
            _ => 0,
        };
        let rows = Rows {
            what: format!("array `{name}`"),
            header: header.saturating_add(before),
            between: Vec::new(),
            count: rowed.rows,
            stride,
            big_endian,
            fields,
        };
        Ok((rows, rowed, warnings))
    }

    /// The warning that the array is left out, if it holds no numbers and none are needed.
    fn left_out(&self, name: &str) -> Option<String> {
        let numbers = self.structured || self.ty().size().is_some();
        (!numbers && names::may_be_text(name)).then(|| {
            let what = match self.ty() {
                AttributeType::Text => "text",
                _ if self.has_objects() => "Python objects",
                _ => "values of another kind",
            };
            format!("array `{name}` is not read: it holds {what} (dtype {})", self.descr)
        })
    }

    fn has_objects(&self) -> bool {
        self.descr.ends_with('O')
    }

    fn unsupported(&self, name: &str) -> ReadError {
        if self.has_objects() {
            return ReadError::Unsupported {
                what: format!("array `{name}` of Python objects (dtype object)"),
                advice: "save arrays of numbers: np.savez(file, position=p, velocity=v)",
            };
        }
        ReadError::Unsupported {
            what: format!("array `{name}` of dtype {}", self.descr),
            advice: "save it as float32, float64 or an integer type: a.astype('f4')",
        }
    }

    /// All values of the array, attribute after attribute.
    fn columns(
        &self,
        cursor: &mut Cursor<'_>,
        name: &str,
        placed: bool,
        table: &mut Table,
    ) -> Result<Vec<Column>, ReadError> {
        let (rows, rowed, told) = self.rows(0, name, placed, &table.asked)?;
        cursor.take(rows.header, &rows.what)?;
        let strided = match self.frame.filter(|_| self.fortran) {
            Some(one) => {
                let all = cursor.take(rows.bytes().saturating_mul(one.count), &rows.what)?;
                Some(every(all, self.size, one))
            }
            None => None,
        };
        let raw = match &strided {
            Some(strided) => strided,
            None => cursor.take(rows.bytes(), &rows.what)?,
        };
        table.warnings.extend(told);
        let mut columns = rows.columns();
        if self.structured || !rowed.transposed {
            rows.decode(raw, rows.count as usize, &vec![true; columns.len()], &mut columns);
            return Ok(columns);
        }
        let mut data = Data::for_type(self.ty());
        data.push_bytes(self.ty(), raw, rows.big_endian);
        let mut from = 0;
        for column in &mut columns {
            column.data = data.turned(rowed.components, from, column.components);
            from += column.components;
        }
        Ok(columns)
    }

    /// Lists the attributes of the array.
    fn list(&self, table: &mut Table, name: &str) {
        if self.structured {
            for member in self.members.iter().filter(|member| !member.name.is_empty()) {
                table.list(&member.name, member.components, member.ty);
            }
            return;
        }
        let components = self.rowed(name, names::is_vector(name)).map(|rowed| rowed.components);
        let product = || {
            let n = self.shape.iter().skip(1).fold(1_u64, |n, d| n.saturating_mul(*d));
            usize::try_from(n).unwrap_or(usize::MAX)
        };
        table.list(name, components.unwrap_or_else(|_| product()), self.ty());
    }

    /// Whether the array may hold positions, whatever its name.
    fn may_be_positions(&self) -> bool {
        let vectors = matches!(*self.shape.as_slice(), [_, 3 | 6] | [_, _, 3 | 6])
            || matches!(*self.shape.as_slice(), [3, n] | [_, 3, n] if n >= WIDE);
        !self.structured
            && vectors
            && matches!(self.ty(), AttributeType::F16 | AttributeType::F32 | AttributeType::F64)
    }
}

const NPY: &str = "array";

/// Refuses a file with anything after its array.
pub(super) fn check_end(content: &Content<'_>) -> Result<(), ReadError> {
    let (header, length) = source::header(&mut content.open(0, content.length())?, |head| {
        let mut cursor = Cursor::new(head);
        let header = header(&mut cursor)?;
        let length = cursor.at() as u64;
        Ok(((header, length), length))
    })?;
    let end = length.saturating_add(header.bytes());
    let more = content.length().saturating_sub(end);
    if more == 0 {
        return Ok(());
    }
    let mut start = Vec::new();
    content.open(end, content.length())?.fill(6, &mut start)?;
    if start == b"\x93NUMPY" {
        return Err(ReadError::Unsupported {
            what: format!(
                "a file of several arrays ({more} bytes follow the first, of shape {})",
                header.words()
            ),
            advice: "call np.save with a new file name for each: np.save(f'frame_{i:04d}.npy', a)",
        });
    }
    Err(ReadError::malformed(
        format!("the end of the file after an array of shape {}", header.words()),
        format!("{more} more bytes"),
        Place::Byte(end),
    ))
}

pub(super) fn read_npy(bytes: &[u8], asked: &Asked) -> Result<Particles, ReadError> {
    let (layout, _) = layout(bytes, asked)?;
    check_end(&Content::of_bytes(bytes)?)?;
    if let Some(layout) = layout {
        return layout.read(bytes);
    }
    let mut cursor = Cursor::new(bytes);
    let header = of_positions(&mut cursor, asked)?;
    let mut table = Table::new(asked);
    header.list(&mut table, NPY);
    let mut columns = header.columns(&mut cursor, NPY, true, &mut table)?.into_iter();
    table.positions = columns.next().map(|column| (column.components, column.data));
    table.columns.extend(columns);
    table.assemble(Format::Npy)
}

/// Parses the header of an NPY file (or of its beginning), and returns its length. `None` for the layout if
/// the particles are not stored one after the other.
pub(super) fn layout(bytes: &[u8], asked: &Asked) -> Result<(Option<Layout>, u64), ReadError> {
    let mut cursor = Cursor::new(bytes);
    let header = of_positions(&mut cursor, asked)?;
    let length = cursor.at() as u64;
    let mut table = Table::new(asked);
    header.list(&mut table, NPY);
    let (rows, rowed, warnings) = header.rows(length, NPY, true, asked)?;
    let layout = (!rowed.transposed).then_some(Layout {
        rows,
        placed: !header.structured,
        attributes: table.attributes,
        warnings,
        format: Format::Npy,
        asked: asked.clone(),
    });
    Ok((layout, length))
}

fn of_positions(cursor: &mut Cursor<'_>, asked: &Asked) -> Result<Header, ReadError> {
    let header = header(cursor)?;
    header.check_order(NPY)?;
    let frame = header.frames(false).and_then(|count| one(asked, count));
    let header = header.of_frame(frame, true);
    if header.has_objects() {
        return Err(header.unsupported(NPY));
    }
    if !header.structured && header.rowed(NPY, true)?.components < 2 {
        return Err(ReadError::Unsupported {
            what: format!("an array of shape {}", header.words()),
            advice: "save an array of shape (n, 3): a.reshape(-1, 3)",
        });
    }
    Ok(header)
}

/// The requested frame, out of `count`.
fn one(asked: &Asked, count: u64) -> Option<One> {
    let index = asked.step()?.index as u64;
    (count > 0).then(|| One { index: index.min(count - 1), count })
}

/// The times of the frames in an array, or in a zip of arrays; empty for one frame.
pub(super) fn times(input: &Input<'_>, zip: bool) -> Result<Vec<Option<f64>>, ReadError> {
    let frames = |count: Option<u64>| match count.and_then(|n| usize::try_from(n).ok()) {
        Some(count) if count <= MOST => vec![None; count],
        _ => Vec::new(),
    };
    if !zip {
        let mut source = Source::new(input, &input.whole(false));
        let header = source::header(&mut source, |head| {
            let mut cursor = Cursor::new(head);
            let header = header(&mut cursor)?;
            Ok((header, cursor.at() as u64))
        })?;
        header.check_order(NPY)?;
        return Ok(frames(header.frames(false)));
    }
    let mut archive = zip::ZipArchive::new(input.section()).map_err(bad_zip)?;
    let (_, chosen) = choose(&mut archive, &Asked::default())?;
    let mut times = frames(chosen.frames);
    if let (Some(name), false) = (chosen.times, times.is_empty()) {
        let mut file = archive.by_name(&format!("{name}.npy")).map_err(bad_zip)?;
        let mut raw = Vec::new();
        let all = file.by_ref().take(TIMES).read_to_end(&mut raw);
        let mut cursor = Cursor::new(&raw);
        // If the times cannot be read, the frames are listed without times.
        if let (Ok(_), Ok(header)) = (all, header(&mut cursor))
            && let Ok(columns) =
                header.columns(&mut cursor, &name, false, &mut Table::new(&Asked::default()))
            && let [column] = columns.as_slice()
        {
            let found = (0..times.len()).map(|i| column.data.f64(i).filter(|t| t.is_finite()));
            times = found.collect();
        }
    }
    Ok(times)
}

/// Max number of frames in a file (`MOST`), and max number of bytes read from the array of the frames' times
/// (`TIMES`).
const MOST: usize = 1 << 20;
const TIMES: u64 = 16 << 20;

pub(super) fn read_npz(bytes: &[u8], asked: &Asked) -> Result<Particles, ReadError> {
    let mut archive = zip::ZipArchive::new(IoCursor::new(bytes)).map_err(bad_zip)?;
    let mut budget = unpack_limit(bytes.len());
    let (mut table, mut chosen) = choose(&mut archive, asked)?;
    for i in 0..archive.len() {
        let mut file = archive.by_index(i).map_err(bad_zip)?;
        let Some(name) = wanted_array(&mut file, &chosen, asked) else { continue };
        if let Some((_, told)) = chosen.left_out.iter().find(|(out, _)| *out == name) {
            table.warnings.push(told.clone());
            continue;
        }
        let raw = unpack(&mut file, budget, &format!("array `{name}`"), 0)?;
        budget = budget.saturating_sub(raw.len());
        let mut cursor = Cursor::new(&raw);
        let header = chosen.frame(header(&mut cursor)?, &name, asked);
        let placed = chosen.positions.as_ref() == Some(&name);
        let mut columns = header.columns(&mut cursor, &name, placed, &mut table)?.into_iter();
        if placed {
            table.positions = columns.next().map(|column| (column.components, column.data));
        }
        table.columns.extend(columns);
    }
    table.warnings.append(&mut chosen.warnings);
    table.time = chosen.time;
    let mut particles = table.assemble(Format::Npz)?;
    if let (Some(name), Some((_, names))) = (chosen.positions, particles.meanings.first_mut()) {
        *names = vec![name];
    }
    Ok(particles)
}

/// The arrays of a zip.
pub(super) struct Arrays {
    /// Arrays that may be used, and their positions in the file.
    pub(super) rows: Vec<(Piece, Rows)>,
    /// Index of the column that holds the positions, whatever its name.
    pub(super) placed: Option<usize>,
    pub(super) attributes: Vec<Attribute>,
    pub(super) warnings: Vec<String>,
    pub(super) time: Option<f64>,
}

/// Reads the headers of the arrays in an NPZ file. `None` if one array's compression or order of values prevents
/// reading it row by row.
pub(super) fn arrays(input: &Input<'_>, asked: &Asked) -> Result<Option<Arrays>, ReadError> {
    let mut archive = zip::ZipArchive::new(input.section()).map_err(bad_zip)?;
    let (mut table, mut chosen) = choose(&mut archive, asked)?;
    let (mut found, mut placed, mut columns) = (Vec::new(), None, 0);
    for i in 0..archive.len() {
        let mut file = archive.by_index(i).map_err(bad_zip)?;
        let Some(name) = wanted_array(&mut file, &chosen, asked) else { continue };
        if let Some((_, told)) = chosen.left_out.iter().find(|(out, _)| *out == name) {
            table.warnings.push(told.clone());
            continue;
        }
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
        let header = chosen.frame(header, &name, asked);
        let of_positions = chosen.positions.as_ref() == Some(&name);
        let (rows, rowed, told) = header.rows(length, &name, of_positions, asked)?;
        if rowed.transposed {
            return Ok(None);
        }
        table.warnings.extend(told);
        if of_positions {
            placed = Some(columns);
        }
        columns += rows.fields.len();
        found.push((piece, rows));
    }
    table.warnings.append(&mut chosen.warnings);
    let Table { attributes, warnings, .. } = table;
    Ok(Some(Arrays { rows: found, placed, attributes, warnings, time: chosen.time }))
}

fn bad_zip(error: zip::result::ZipError) -> ReadError {
    let expected = "a sound zip of arrays (NPZ), with its list of contents at the end";
    ReadError::malformed(expected, error.to_string(), Place::Unknown)
}

/// The arrays of an NPZ file that are used although their names are not known ones.
#[derive(Default)]
struct Chosen {
    /// Structured arrays, for their fields.
    structured: Vec<String>,
    /// The array taken as positions, if none has such a name.
    positions: Option<String>,
    /// Number of frames, and the array with their times.
    frames: Option<u64>,
    times: Option<String>,
    /// Time of the only frame, from an array of one value.
    time: Option<f64>,
    warnings: Vec<String>,
    /// Arrays of no numbers that are not read, and the warnings that say so.
    left_out: Vec<(String, String)>,
}

impl Chosen {
    /// The array's entry for the requested frame.
    fn frame(&self, header: Header, name: &str, asked: &Asked) -> Header {
        let one = self.frames.and_then(|count| one(asked, count));
        header.of_frame(one, names::is_vector(name) || self.positions.as_deref() == Some(name))
    }
}

/// Lists the arrays of a zip by their headers, and chooses those to read; an array with an unreadable header is
/// skipped.
fn choose<R: Read + std::io::Seek>(
    archive: &mut zip::ZipArchive<R>,
    asked: &Asked,
) -> Result<(Table, Chosen), ReadError> {
    let (mut table, mut chosen) = (Table::new(asked), Chosen::default());
    let (mut all, mut able, mut headers) = (Vec::new(), Vec::new(), Vec::new());
    let mut others = Vec::new();
    let mut best = usize::MAX;
    for i in 0..archive.len() {
        let mut file = archive.by_index(i).map_err(bad_zip)?;
        let Ok(name) = file.name().map(|name| name.into_owned()) else { continue };
        let Some(name) = name.strip_suffix(".npy").map(str::to_string) else {
            others.push(name);
            continue;
        };
        let mut head = Vec::new();
        let _ = file.by_ref().take(4096).read_to_end(&mut head);
        let mut cursor = Cursor::new(&head);
        let Ok(header) = header(&mut cursor) else { continue };
        let rank = names::time_rank(&name).filter(|rank| *rank < best);
        if let Some(rank) = rank.filter(|_| header.shape.iter().all(|extent| *extent == 1)) {
            let values = header.columns(&mut cursor, &name, false, &mut Table::new(asked));
            let value = values.ok().and_then(|columns| columns.first()?.data.f64(0));
            if let Some(time) = value.filter(|time| time.is_finite()) {
                (chosen.time, best) = (Some(time), rank);
            }
        }
        if header.structured && !asked.wants(&name) {
            let fields = header.members.iter().map(|member| member.name.clone());
            all.extend(fields);
            chosen.structured.push(name.clone());
        } else {
            if header.may_be_positions() && !asked.wants(&name) {
                able.push(name.clone());
            }
            all.push(name.clone());
        }
        if let Some(told) = header.left_out(&name) {
            chosen.left_out.push((name.clone(), told));
        }
        headers.push((name, header));
    }
    if headers.is_empty() && !others.is_empty() {
        return Err(other_zip(&others));
    }
    // `savez` numbers unnamed arrays in their order.
    able.sort();
    let sure =
        |able: &[String]| able.len() == 1 || able.first().is_some_and(|name| name == "arr_0");
    if !names::may_have_positions(&all) && sure(&able) {
        let others = able.len() - 1;
        chosen.positions = able.into_iter().next();
        let name = chosen.positions.clone().unwrap_or_default();
        let more = if others > 0 {
            format!(
                ", {others} others of its shape are not read: names tell what they are (np.savez(file, position=p, \
                 velocity=v))"
            )
        } else {
            String::new()
        };
        chosen
            .warnings
            .push(format!("no array is called positions: `{name}` is taken as them{more}"));
    }
    let objects = headers.iter().filter(|(_, header)| header.has_objects());
    let objects: Vec<_> = objects.map(|(name, _)| format!("`{name}`")).take(4).collect();
    if !names::may_have_positions(&all) && chosen.positions.is_none() && !objects.is_empty() {
        return Err(ReadError::Unsupported {
            what: format!(
                "a zip of arrays without positions, but with Python objects (in {}; perhaps of PySPH)",
                objects.join(", ")
            ),
            advice: "save arrays of numbers: np.savez(file, position=p, velocity=v); from PySPH, write HDF5",
        });
    }
    let frames = headers.iter().filter_map(|(name, header)| {
        let component = names::is_component(name);
        let placed = names::is_position(name) || chosen.positions.as_ref() == Some(name);
        let counts = header.structured || placed || component;
        counts.then(|| header.frames(component)).flatten()
    });
    chosen.frames = frames.max();
    for (name, header) in headers.iter().filter(|(_, header)| !header.structured) {
        if names::is_position(name) || chosen.positions.as_ref() == Some(name) {
            header.check_order(name)?;
        }
    }
    let of_frames = headers.iter().filter(|(_, header)| {
        let numbers = !header.structured && header.ty().size().is_some();
        numbers && chosen.frames.is_some_and(|frames| header.shape == [frames])
    });
    let times = of_frames.filter_map(|(name, _)| Some((names::time_rank(name)?, name)));
    chosen.times = times.min_by_key(|(rank, _)| *rank).map(|(_, name)| name.clone());
    for (name, header) in headers {
        chosen.frame(header, &name, asked).list(&mut table, &name);
    }
    Ok((table, chosen))
}

/// The error for a zip without arrays that holds these files.
fn other_zip(files: &[String]) -> ReadError {
    if files.iter().any(|file| file.starts_with("xl/")) {
        return ReadError::Unsupported {
            what: "a workbook of Excel".into(),
            advice: "save the sheet as CSV",
        };
    }
    let named: Vec<_> = files.iter().take(3).map(String::as_str).collect();
    let more = match files.len() {
        0..4 => String::new(),
        count => format!(" and {} more", count - 3),
    };
    ReadError::Unsupported {
        what: format!("a zip that holds {}{more}", named.join(", ")),
        advice: "unpack it and give the files of particles in it",
    }
}

/// The name of an array that may be used.
fn wanted_array(
    file: &mut zip::read::ZipFile<'_, impl Read>,
    chosen: &Chosen,
    asked: &Asked,
) -> Option<String> {
    let name = file.name().ok()?.strip_suffix(".npy")?.to_string();
    let used = asked.wants(&name)
        || chosen.structured.contains(&name)
        || chosen.positions.as_ref() == Some(&name);
    used.then_some(name)
}
