//! Reads legacy VTK, versions 1.0 to 5.1, ASCII and binary: the points of POLYDATA and UNSTRUCTURED_GRID.
//!
//! The file has four lines (`# vtk DataFile Version x.y`, a title, `ASCII` or `BINARY`, `DATASET type`), then
//! sections: a line of words, followed by values as text or as big-endian bytes. Cells are, up to version 4.2, one list
//! of `i32`, from 5.0 on `OFFSETS` and `CONNECTIVITY`; they are only read for `CELL_DATA` and beside a mesh, see
//! `cells`. `POINT_DATA n` begins the attributes: `SCALARS`, `VECTORS` and the like, or a `FIELD` of arrays. `METADATA`
//! may follow any array and ends with an empty line. The length of an unknown section cannot be determined, so reading
//! ends there with a warning.
//!
//! The reader is our own, because the crate vtkio (0.6) refuses the cells of version 5.1 as VTK 9 and meshio
//! write them (`OFFSETS vtktypeint64`).

use std::ops::Range;
use std::sync::Arc;

use super::Format;
use super::arrays::{self, Array, Segment, Stored};
use super::asked::Asked;
use super::bytes::show;
use super::cells::{self, Cells, Ends, Lists, Vertices};
use super::columns::{Attribute, AttributeType, Column, Data, PLACED};
use super::error::{Place, ReadError};
use super::plan::{About, Plan, Track};
use super::rows::{self, Field, Rows};
use super::source::{Content, truncated};
use super::text::Text;
use super::vtk_xml::{is_point, mesh_warning};

pub(super) fn plan<'a>(content: &Content<'a>, asked: &Asked) -> Result<Plan<'a>, ReadError> {
    let found = Reader::read(content, false, asked).map_err(|error| {
        // A missing number shifts what follows. A second reading, which checks the values, reports that number.
        Reader::read(content, true, asked).err().unwrap_or(error)
    })?;
    let found_cells = (found.cells, found.cell, found.vertices);
    let Reader {
        binary,
        version,
        mut attributes,
        mut warnings,
        mut found,
        points,
        time,
        mut on_cells,
        list,
        others,
        types,
        ..
    } = found;
    let Some(points) = points else {
        return Err(ReadError::malformed("a POINTS section", "none", Place::Unknown));
    };
    let count = points.rows;
    let mixed = match &types {
        Some(types) => types.rows != count,
        // Lines may join particles.
        None => found_cells.2 > 0 && (found_cells.0 > 0 || (others == 0 && found_cells.2 < count)),
    };
    let particles = match list.clone().filter(|_| mixed) {
        Some(list) => particles(list.open(content, binary)?, types, content, binary, count)?,
        None => None,
    };
    match &particles {
        Some((_, told)) => warnings.push(told.clone()),
        None if found_cells.0 > 0 && found_cells.2 == 0 => {
            warnings.push(mesh_warning(found_cells.0, found_cells.1));
        }
        None => {}
    }
    found.insert(0, points);
    let tracks = found.into_iter().map(|found| found.track(content, binary));
    let mut tracks = tracks.collect::<Result<Vec<_>, _>>()?;
    let doubled = cells::doubled(&mut on_cells.attributes, &attributes);
    warnings.extend(cells::unused(&doubled, cells::DOUBLED));
    on_cells.found.retain(|(_, name)| on_cells.attributes.iter().any(|a| a.name == *name));
    let names: Vec<String> = on_cells.attributes.iter().map(|a| a.name.clone()).collect();
    if !names.is_empty() {
        let mut all = Cells::default();
        all.compare(list.as_ref().map_or(0, |l| l.cells).saturating_add(others), count);
        if others > 0 {
            all.refuse(format!("{others} of the cells are lines or faces"));
        }
        // The lists need not be read for attributes without a meaning.
        if let Some(list) = list.filter(|_| !on_cells.found.is_empty() && !all.are_refused()) {
            all.add(count, &list.open(content, binary)?);
        }
        match all.finish() {
            Err(why) => warnings.extend(cells::unused(&names, &cells::no_particles(&why))),
            Ok(order) => {
                let uneven: Vec<String> = on_cells
                    .found
                    .iter()
                    .filter(|(found, _)| found.rows != count)
                    .map(|(_, name)| name.clone())
                    .collect();
                warnings.extend(cells::unused(&uneven, cells::UNEVEN));
                on_cells.attributes.retain(|a| !uneven.contains(&a.name));
                attributes.append(&mut on_cells.attributes);
                for (found, _) in on_cells.found.into_iter().filter(|(f, _)| f.rows == count) {
                    let track = found.track(content, binary)?;
                    tracks.push(match &order {
                        Some(order) => cells::reordered(track, order.clone()),
                        None => track,
                    });
                }
            }
        }
    }
    if let Some((rows, _)) = particles {
        let some = |track| cells::kept(track, rows.clone(), count);
        tracks = tracks.into_iter().map(some).collect();
    }
    let format = Format::VtkLegacy { version, binary };
    let about = About { placed: Some(0), attributes, warnings, time, format, asked: asked.clone() };
    Plan::new(tracks, about, content.unpack_limit())
}

/// Which points are particles, given the lists of vertices, or of all cells with their types; see [`Vertices`].
fn particles(
    lists: Lists<'_>,
    types: Option<Found>,
    content: &Content<'_>,
    binary: bool,
    points: u64,
) -> Result<Option<Particles>, ReadError> {
    let types = match types {
        Some(types) => {
            let count = types.rows;
            cells::integers(&types.track(content, binary)?, count)
        }
        None => Some(Vec::new()),
    };
    let split = types.and_then(|types| {
        lists.split(|cell| types.get(cell).is_none_or(|ty| is_point(f64::from(*ty))))
    });
    let mut all = Vertices::default();
    let inside = |list: &[u32]| list.iter().all(|point| u64::from(*point) < points);
    match split {
        Some((vertices, others)) if inside(&vertices) && inside(&others) => {
            all.some(points, vertices, others);
        }
        _ => return Ok(None),
    }
    Ok(all.finish())
}

/// The rows that are particles, and a warning about the others.
type Particles = (Arc<[Range<u64>]>, String);

/// An array that may be used.
#[derive(Clone)]
struct Found {
    name: String,
    /// Name for messages.
    what: String,
    components: usize,
    ty: AttributeType,
    /// Number of particles.
    rows: u64,
    /// Byte offset of its values.
    start: u64,
}

impl Found {
    /// A list of integers.
    fn list(name: &str, ty: AttributeType, rows: u64, start: u64) -> Self {
        Self { name: name.into(), what: name.into(), components: 1, ty, rows, start }
    }

    fn track<'a>(self, content: &Content<'a>, binary: bool) -> Result<Track<'a>, ReadError> {
        let Self { name, what, components, ty, rows, start } = self;
        let content = content.clone();
        let end = content.length();
        if !binary {
            let count = rows.saturating_mul(components as u64);
            let segment = Segment { content, start, end, count, ty, stored: Stored::Words };
            let array = Array { name: what, components, segments: vec![segment] };
            return Ok(arrays::track(Column::new(&name, components, ty), array));
        }
        let rows = Rows {
            what,
            header: start,
            between: Vec::new(),
            count: rows,
            stride: ty.size().unwrap_or(0).saturating_mul(components as u64),
            big_endian: true,
            fields: vec![Field::new(&name, components, ty, 0)?],
        };
        Ok(rows::track(rows, move |_| content.open(start, end)))
    }
}

/// Attributes of cells.
#[derive(Default)]
struct OnCells {
    attributes: Vec<Attribute>,
    /// Those that may be used, with their names in the file.
    found: Vec<(Found, String)>,
}

/// Where the points of cells are listed.
#[derive(Clone)]
struct List {
    cells: u64,
    /// Where the list of the cells' points is in the file and, from version 5.0 on, the list of offsets into it.
    points: Found,
    offsets: Option<Found>,
}

impl List {
    fn open<'a>(self, content: &Content<'a>, binary: bool) -> Result<Lists<'a>, ReadError> {
        let length = self.points.rows;
        Ok(Lists {
            cells: self.cells,
            ends: match self.offsets {
                Some(offsets) => Ends::Sums(offsets.track(content, binary)?, 0),
                None => Ends::Inside,
            },
            points: self.points.track(content, binary)?,
            length,
        })
    }
}

/// What the current attributes belong to.
#[derive(Clone, Copy, PartialEq)]
enum Of {
    Nothing,
    Points,
    Cells,
}

/// Number of cells whose types are examined.
const CELLS: usize = 1 << 10;

/// Names of sections. At the end of a file, the beginning of one is what is left of a file that was cut off.
const SECTIONS: [&str; 22] = [
    "DATASET",
    "POINTS",
    "VERTICES",
    "LINES",
    "POLYGONS",
    "TRIANGLE_STRIPS",
    "CELLS",
    "CELL_TYPES",
    "POINT_DATA",
    "CELL_DATA",
    "METADATA",
    "SCALARS",
    "COLOR_SCALARS",
    "LOOKUP_TABLE",
    "VECTORS",
    "NORMALS",
    "TENSORS",
    "TEXTURE_COORDINATES",
    "FIELD",
    "GLOBAL_IDS",
    "PEDIGREE_IDS",
    "EDGE_FLAGS",
];

/// Bytes after an array's first line in which its `LOOKUP_TABLE` line is searched.
const LOOKUP: usize = 1 << 12;

fn version(line: &[u8]) -> Option<(u8, u8)> {
    let line = std::str::from_utf8(line).ok()?;
    let (major, minor) = line.strip_prefix("# vtk DataFile Version")?.trim().split_once('.')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

struct Reader<'a> {
    text: Text<'a>,
    binary: bool,
    version: (u8, u8),
    /// Whether values that may be used are checked instead of skipped.
    check: bool,
    attributes: Vec<Attribute>,
    warnings: Vec<String>,
    found: Vec<Found>,
    points: Option<Found>,
    time: Option<f64>,
    /// Number of cells that are not points (`cells`), the type of these (`cell`), and the number of cells that are
    /// points (`vertices`).
    cells: u64,
    cell: &'static str,
    vertices: u64,
    /// Number of rows of the current POINT_DATA or CELL_DATA.
    rows: Option<u64>,
    of: Of,
    on_cells: OnCells,
    /// The file's first list of cells, if these are vertices or of mixed types, and the number of cells in other
    /// lists.
    list: Option<List>,
    others: u64,
    /// The types of all cells.
    types: Option<Found>,
    asked: Asked,
}

/// The words of a section's first line, including the keyword.
struct Words<'l> {
    line: &'l [u8],
    words: Vec<&'l [u8]>,
    place: Place,
}

impl<'l> Words<'l> {
    fn text(&self, i: usize, what: &str) -> Result<&'l str, ReadError> {
        self.words
            .get(i)
            .and_then(|word| std::str::from_utf8(word).ok())
            .ok_or_else(|| self.bad(what))
    }

    fn count(&self, i: usize, what: &str) -> Result<u64, ReadError> {
        self.text(i, what)?.parse().map_err(|_| self.bad(what))
    }

    /// A type; `Other` (bits) or `Text` for those that are no plain numbers.
    fn ty(&self, i: usize) -> Result<AttributeType, ReadError> {
        use AttributeType as T;
        Ok(match self.text(i, "a type")?.to_ascii_lowercase().as_str() {
            "bit" => T::Other,
            "char" | "signed_char" | "vtktypeint8" => T::I8,
            "unsigned_char" | "vtktypeuint8" => T::U8,
            "short" | "vtktypeint16" => T::I16,
            "unsigned_short" | "vtktypeuint16" => T::U16,
            // Ids are written as 32 bits, whatever their type in memory.
            "int" | "vtkidtype" | "vtktypeint32" => T::I32,
            "unsigned_int" | "vtktypeuint32" => T::U32,
            "long" | "long_long" | "vtktypeint64" => T::I64,
            "unsigned_long" | "unsigned_long_long" | "vtktypeuint64" => T::U64,
            "float" | "vtktypefloat32" => T::F32,
            "double" | "vtktypefloat64" => T::F64,
            "string" => T::Text,
            _ => return Err(self.bad("a VTK type such as float, double or int")),
        })
    }

    fn bad(&self, what: &str) -> ReadError {
        ReadError::malformed(what, show(self.line), self.place)
    }
}

impl<'a> Reader<'a> {
    /// Finds all arrays up to the end of the file.
    fn read(content: &Content<'a>, check: bool, asked: &Asked) -> Result<Self, ReadError> {
        let mut text = Text::new(content.open(0, content.length())?);
        let first = text.line()?.unwrap_or_default();
        let version = version(first).ok_or_else(|| {
            ReadError::malformed("`# vtk DataFile Version x.y`", show(first), Place::Line(1))
        })?;
        text.line()?;
        let kind = text.line()?.unwrap_or_default().trim_ascii();
        let binary = match kind.to_ascii_uppercase().as_slice() {
            b"ASCII" => false,
            b"BINARY" => true,
            _ => {
                return Err(ReadError::malformed(
                    "`ASCII` or `BINARY`",
                    show(kind),
                    Place::Line(3),
                ));
            }
        };
        let mut reader = Self {
            text,
            binary,
            version,
            check,
            attributes: Vec::new(),
            warnings: Vec::new(),
            found: Vec::new(),
            points: None,
            time: None,
            cells: 0,
            cell: "",
            vertices: 0,
            rows: None,
            of: Of::Nothing,
            on_cells: OnCells::default(),
            list: None,
            others: 0,
            types: None,
            asked: asked.clone(),
        };
        while let Some(line) = reader.keyword_line()? {
            if !reader.section(&line)? {
                let words = reader.words(&line);
                let (word, place) = (words.text(0, "a keyword")?.to_ascii_uppercase(), words.place);
                let cut = SECTIONS.iter().any(|section| section.starts_with(&word));
                if cut && reader.text.ahead(1)?.is_empty() {
                    let at = reader.text.at();
                    return Err(truncated("the name of a section of legacy VTK", at, 1, 0));
                }
                reader.warnings.push(format!(
                    "legacy VTK: unknown section {}{place}; it and all that follows are not read",
                    show(&line)
                ));
                break;
            }
        }
        Ok(reader)
    }

    fn keyword_line(&mut self) -> Result<Option<Vec<u8>>, ReadError> {
        self.text.skip_space()?;
        Ok(self.text.line()?.map(<[u8]>::to_vec))
    }

    fn words<'l>(&self, line: &'l [u8]) -> Words<'l> {
        Words {
            line,
            words: line.split(u8::is_ascii_whitespace).filter(|w| !w.is_empty()).collect(),
            place: Place::Byte(self.text.at().saturating_sub(line.len() as u64 + 1)),
        }
    }

    /// Reads one section; false if it is unknown.
    fn section(&mut self, line: &[u8]) -> Result<bool, ReadError> {
        let w = self.words(line);
        let keyword = w.text(0, "a keyword")?.to_ascii_uppercase();
        let rows = || self.rows.ok_or_else(|| w.bad("POINT_DATA or CELL_DATA before an attribute"));
        match keyword.as_str() {
            "DATASET" => {
                let kind = w.text(1, "a dataset type")?;
                if !["POLYDATA", "UNSTRUCTURED_GRID"].contains(&kind.to_ascii_uppercase().as_str())
                {
                    return Err(ReadError::Unsupported {
                        what: format!("the VTK dataset {kind}"),
                        advice: "particles are POLYDATA or UNSTRUCTURED_GRID: save one of these",
                    });
                }
            }
            "POINTS" => {
                let n = w.count(1, "a number of points")?;
                let ty = w.ty(2)?;
                if ty.size().is_none() {
                    return Err(w.bad("a type of numbers for the points"));
                }
                self.asked.list(&mut self.attributes, "Points", 3, ty);
                let (name, what, start) = (PLACED.into(), "POINTS".into(), self.text.at());
                self.values(ty, n.saturating_mul(3), "POINTS", true)?;
                self.points = Some(Found { name, what, components: 3, ty, rows: n, start });
            }
            "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" => {
                let (first, second) = (w.count(1, "a number of cells")?, w.count(2, "a size")?);
                // From version 5.0 on, the first count is that of offsets, which is one more than that of
                // cells.
                let cells = first.saturating_sub(u64::from(self.version.0 >= 5));
                match keyword.as_str() {
                    "VERTICES" => self.vertices = self.vertices.saturating_add(cells),
                    "POLYGONS" | "TRIANGLE_STRIPS" => {
                        (self.cells, self.cell) = (self.cells.saturating_add(cells), "polygons");
                    }
                    _ => {}
                }
                if self.version.0 >= 5 {
                    let mut lists = Vec::new();
                    for (part, count) in [("OFFSETS", first), ("CONNECTIVITY", second)] {
                        let Some(line) = self.keyword_line()? else {
                            return Err(truncated(part, self.text.at(), 1, 0));
                        };
                        let w = self.words(&line);
                        if w.text(0, part)? != part {
                            return Err(w.bad(part));
                        }
                        lists.push(Found::list(part, w.ty(1)?, count, self.text.at()));
                        self.values(w.ty(1)?, count, part, false)?;
                    }
                    let points = lists.pop();
                    self.listed(&keyword, cells, points, lists.pop());
                } else {
                    let points = Found::list(&keyword, AttributeType::I32, second, self.text.at());
                    self.values(AttributeType::I32, second, &keyword, false)?;
                    self.listed(&keyword, cells, Some(points), None);
                }
            }
            "CELL_TYPES" => {
                let n = w.count(1, "a number of cells")?;
                let types = self.cell_types(n)?;
                if 2 * types.iter().filter(|ty| !is_point(**ty)).count() > types.len() {
                    (self.cells, self.cell) = (n, "cells");
                }
                self.types = Some(Found::list(&keyword, AttributeType::I32, n, self.text.at()));
                self.values(AttributeType::I32, n, &keyword, false)?;
            }
            "POINT_DATA" | "CELL_DATA" => {
                self.rows = Some(w.count(1, "a number of values")?);
                self.of = match (keyword.as_str(), self.rows) {
                    ("POINT_DATA", _) => Of::Points,
                    (_, Some(0)) => Of::Nothing,
                    _ => Of::Cells,
                };
            }
            "METADATA" => self.skip_metadata()?,
            "SCALARS" => {
                let rows = rows()?;
                let components = match w.words.len() {
                    0..=3 => 1,
                    _ => w.count(3, "a number of components")?,
                };
                let (name, ty) = (w.text(1, "a name")?, w.ty(2)?);
                // Without a `LOOKUP_TABLE` line the values follow directly. They may begin with bytes that look like
                // white space, so nothing is consumed in that case.
                let ahead = self.text.ahead(LOOKUP)?.trim_ascii_start();
                if ahead.starts_with(b"LOOKUP_TABLE") {
                    self.keyword_line()?;
                }
                self.attribute(name, ty, rows, components)?;
            }
            "VECTORS" | "NORMALS" => {
                let rows = rows()?;
                self.attribute(w.text(1, "a name")?, w.ty(2)?, rows, 3)?;
            }
            "TENSORS" | "TENSORS6" => {
                let rows = rows()?;
                let components = if keyword == "TENSORS" { 9 } else { 6 };
                self.attribute(w.text(1, "a name")?, w.ty(2)?, rows, components)?;
            }
            "GLOBAL_IDS" | "PEDIGREE_IDS" | "EDGE_FLAGS" => {
                let rows = rows()?;
                self.attribute(w.text(1, "a name")?, w.ty(2)?, rows, 1)?;
            }
            "TEXTURE_COORDINATES" => {
                let rows = rows()?;
                let components = w.count(2, "a number of components")?;
                self.attribute(w.text(1, "a name")?, w.ty(3)?, rows, components)?;
            }
            // Colours are bytes in a binary file, and numbers from 0 to 1 in text.
            "COLOR_SCALARS" => {
                let rows = rows()?;
                let components = w.count(2, "a number of components")?;
                self.attribute(w.text(1, "a name")?, AttributeType::U8, rows, components)?;
            }
            "LOOKUP_TABLE" => {
                let n = w.count(2, "a number of colours")?;
                self.values(AttributeType::U8, n.saturating_mul(4), &keyword, false)?;
            }
            "FIELD" => {
                let arrays = w.count(2, "a number of arrays")?;
                for _ in 0..arrays {
                    self.field_array()?;
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Keeps the place of a list of cells.
    fn listed(&mut self, keyword: &str, cells: u64, points: Option<Found>, offsets: Option<Found>) {
        match (keyword, points, &self.list) {
            ("VERTICES" | "CELLS", Some(points), None) => {
                self.list = Some(List { cells, points, offsets });
            }
            _ => self.others = self.others.saturating_add(cells),
        }
    }

    /// The first of `count` cell types, without consuming them.
    fn cell_types(&mut self, count: u64) -> Result<Vec<f64>, ReadError> {
        let most = usize::try_from(count).unwrap_or(usize::MAX).min(CELLS);
        let ahead = self.text.ahead(4 * most)?;
        Ok(if self.binary {
            ahead.as_chunks::<4>().0.iter().map(|ty| f64::from(i32::from_be_bytes(*ty))).collect()
        } else {
            let words = ahead.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            // The last word may be cut off.
            let words = words.take(most.saturating_sub(1).max(1));
            words.filter_map(super::bytes::parse_number).collect()
        })
    }

    fn field_array(&mut self) -> Result<(), ReadError> {
        loop {
            let Some(line) = self.keyword_line()? else {
                return Err(truncated("the arrays of a FIELD", self.text.at(), 1, 0));
            };
            if line.trim_ascii() == b"METADATA" {
                self.skip_metadata()?;
                continue;
            }
            let w = self.words(&line);
            let name = w.text(0, "an array: name, components, tuples, type")?;
            let components = w.count(1, "an array: name, components, tuples, type")?;
            let rows = w.count(2, "an array: name, components, tuples, type")?;
            let ty = w.ty(3)?;
            if let ("TIME" | "TimeValue", 1, 1, Some(size)) = (name, components, rows, ty.size()) {
                let mut data = Data::for_type(ty);
                if self.binary {
                    data.push_bytes(ty, self.text.take(size, name)?, true);
                } else {
                    self.text.numbers(1, 1, name, &mut data)?;
                }
                self.time = data.f64(0);
                return Ok(());
            }
            return self.attribute(name, ty, rows, components);
        }
    }

    fn attribute(
        &mut self,
        name: &str,
        ty: AttributeType,
        rows: u64,
        components: u64,
    ) -> Result<(), ReadError> {
        let name = percent_decoded(name);
        let size = usize::try_from(components).unwrap_or(usize::MAX);
        let list = match self.of {
            Of::Points => Some(&mut self.attributes),
            Of::Cells => Some(&mut self.on_cells.attributes),
            Of::Nothing => None,
        };
        let keep =
            list.is_some_and(|list| self.asked.list(list, &name, size, ty)) && ty.size().is_some();
        let start = self.text.at();
        self.values(ty, rows.saturating_mul(components), &name, keep)?;
        let found = |name: &str| {
            let (name, what) = (name.to_string(), name.to_string());
            Found { name, what, components: size, ty, rows, start }
        };
        match self.of {
            Of::Points if keep => self.found.push(found(&name)),
            Of::Cells if keep => {
                self.on_cells.found.push((found(&cells::column_name(&name)), name));
            }
            _ => {}
        }
        Ok(())
    }

    /// Skips `count` values. `keep` says that they may be used; in a text file they are then checked to be numbers if
    /// `check` is set.
    fn values(
        &mut self,
        ty: AttributeType,
        count: u64,
        what: &str,
        keep: bool,
    ) -> Result<(), ReadError> {
        if ty == AttributeType::Text {
            return self.skip_texts(count, what);
        }
        if !self.binary {
            return match keep && self.check {
                true => self.text.check_numbers(ty, count, what),
                false => self.text.skip_words(count, what),
            };
        }
        let bytes = match ty.size() {
            Some(size) => count.saturating_mul(size),
            None => count.div_ceil(8), // bits
        };
        self.text.skip(bytes, what)
    }

    /// Skips texts. In ASCII there is one per line; in binary each follows its length, whose top two bits say
    /// how many bytes the length takes.
    fn skip_texts(&mut self, count: u64, what: &str) -> Result<(), ReadError> {
        for _ in 0..count {
            if !self.binary {
                if self.text.line()?.is_none() {
                    return Err(truncated(what, self.text.at(), 1, 0));
                }
                continue;
            }
            let first = self.text.take(1, what)?.first().copied().unwrap_or(0);
            let more = match first >> 6 {
                3 => 0,
                2 => 1,
                1 => 3,
                _ => 7,
            };
            let mut length = u64::from(first & 0x3f);
            for byte in self.text.take(more, what)? {
                length = length << 8 | u64::from(*byte);
            }
            self.text.skip(length, what)?;
        }
        Ok(())
    }

    fn skip_metadata(&mut self) -> Result<(), ReadError> {
        while let Some(line) = self.text.line()? {
            if line.trim_ascii().is_empty() {
                break;
            }
        }
        Ok(())
    }
}

/// Decodes codes such as %20 (space) and %25 (percent sign) in a name.
fn percent_decoded(name: &str) -> String {
    let mut out = Vec::with_capacity(name.len());
    let mut rest = name.as_bytes();
    while let Some((first, tail)) = rest.split_first() {
        let code = (*first == b'%')
            .then(|| tail.get(..2))
            .flatten()
            .and_then(|hex| std::str::from_utf8(hex).ok())
            .and_then(|hex| u8::from_str_radix(hex, 16).ok());
        out.push(code.unwrap_or(*first));
        rest = if code.is_some() { tail.get(2..).unwrap_or_default() } else { tail };
    }
    String::from_utf8_lossy(&out).into_owned()
}
