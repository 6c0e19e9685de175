//! Reads VTK XML: unstructured grids (VTU) and poly data (VTP), in every encoding that VTK and ParaView
//! write.
//!
//! An XML header lists pieces and their arrays. Values are text or base64 inside the element, or base64 or
//! raw bytes after `<AppendedData>` and an underscore. Raw bytes make the file invalid XML, so the header is
//! cut off before them. This module finds the arrays; `head` finds long texts in elements, and `encoded`
//! reads bytes.
//!
//! The reader is our own, because the crate vtkio (0.6) reads ASCII, but none of these: raw appended data
//! ends its XML parser, appended compressed base64 is truncated, and inline base64 is not decoded.

use std::path::Path;

use roxmltree::Node;

use super::arrays::{self, Array, Segment, Stored};
use super::asked::Asked;
use super::bytes::show;
use super::cells::{self, Cells, Ends, Lists, Vertices};
use super::columns::{Attribute, AttributeType, Column, PLACED};
use super::encoded::Encoding;
use super::error::{Place, ReadError};
use super::head::{Head, Words};
use super::plan::{About, Plan, Track};
use super::source::Content;
use super::text::Text;
use super::{Compression, Format, Storage};

pub(super) fn plan<'a>(content: &Content<'a>, asked: &Asked) -> Result<Plan<'a>, ReadError> {
    plan_files(&[(Path::new(""), content.clone())], Vec::new(), asked)
}

/// Plans the reading of pieces that are in several files and together form one frame. An error names its file, if
/// that has a path.
pub(super) fn plan_files<'a>(
    files: &[(&Path, Content<'a>)],
    warnings: Vec<String>,
    asked: &Asked,
) -> Result<Plan<'a>, ReadError> {
    let mut grid = Grid { warnings, asked: asked.clone(), ..Grid::default() };
    for (path, content) in files {
        let mut read = || {
            let mut cut = grid.clone();
            if cut.read(content, &Head::read(content, true)?)? {
                grid = cut;
                return Ok(());
            }
            match grid.read(content, &Head::read(content, false)?)? {
                true => Ok(()),
                false => Err(ReadError::malformed("texts in elements", "others", Place::Unknown)),
            }
        };
        read().map_err(|error| match path.as_os_str().is_empty() {
            true => error,
            false => ReadError::File { path: path.to_path_buf(), reason: Box::new(error) },
        })?;
    }
    grid.plan(files.len() > 1)
}

/// What all pieces have in common, in one file or several.
#[derive(Clone, Default)]
struct Grid<'a> {
    attributes: Vec<Attribute>,
    found: Vec<(Column, Array<'a>)>,
    format: Option<Format>,
    warnings: Vec<String>,
    time: Option<f64>,
    limit: u64,
    /// Number of cells of a mesh, and their type.
    cells: u64,
    cell: &'static str,
    on_cells: OnCells<'a>,
    vertices: Vertices,
    asked: Asked,
}

/// Attributes of cells.
#[derive(Clone, Default)]
struct OnCells<'a> {
    attributes: Vec<Attribute>,
    found: Vec<(Column, Array<'a>)>,
    cells: Cells,
}

/// Number of values per component.
fn length(array: &Array<'_>) -> u64 {
    let values = array.segments.iter().fold(0_u64, |sum, s| sum.saturating_add(s.count));
    values / (array.components.max(1) as u64)
}

/// Adds the attributes of cells to those of points, if each cell is a particle. Returns the tracks that read the
/// values of the added attributes.
fn join_cells<'a>(
    on_cells: OnCells<'a>,
    points: u64,
    attributes: &mut Vec<Attribute>,
    warnings: &mut Vec<String>,
) -> Vec<Track<'a>> {
    let OnCells { attributes: mut own, found, cells } = on_cells;
    let doubled = cells::doubled(&mut own, attributes);
    warnings.extend(cells::unused(&doubled, cells::DOUBLED));
    let order = match cells.finish() {
        Ok(order) => order,
        Err(why) => {
            let names: Vec<String> = own.into_iter().map(|a| a.name).collect();
            warnings.extend(cells::unused(&names, &cells::no_particles(&why)));
            return Vec::new();
        }
    };
    let mut tracks = Vec::new();
    for (column, array) in found {
        if !own.iter().any(|a| a.name == array.name) {
            continue;
        }
        if length(&array) != points {
            own.retain(|a| a.name != array.name);
            warnings.extend(cells::unused(&[array.name], cells::UNEVEN));
            continue;
        }
        let track = arrays::track(column, array);
        tracks.push(match &order {
            Some(order) => cells::reordered(track, order.clone()),
            None => track,
        });
    }
    attributes.append(&mut own);
    tracks
}

impl<'a> Grid<'a> {
    fn plan(self, several: bool) -> Result<Plan<'a>, ReadError> {
        let Self { mut attributes, mut found, mut warnings, time, limit, asked, .. } = self;
        // A grid without points has no particles, which is no error.
        if found.is_empty() {
            let none = Array { name: PLACED.into(), components: 3, segments: Vec::new() };
            found.push((Column::new(PLACED, 3, AttributeType::F32), none));
        }
        let points = found.first().map_or(0, |(_, array)| length(array));
        if several {
            found.retain(|(_, array)| {
                let all = length(array) == points;
                if !all {
                    let name = &array.name;
                    attributes.retain(|a| a.name != *name);
                    warnings.push(format!("attribute `{name}` is dropped: not all pieces have it"));
                }
                all
            });
        }
        let particles = self.vertices.finish();
        match &particles {
            Some((_, told)) => warnings.push(told.clone()),
            None if self.cells > 0 => warnings.push(mesh_warning(self.cells, self.cell)),
            None => {}
        }
        let format = self.format.unwrap_or(Format::Vtu(Storage::Ascii, Compression::None));
        let tracks = found.into_iter().map(|(column, array)| arrays::track(column, array));
        let mut tracks: Vec<_> = tracks.collect();
        tracks.append(&mut join_cells(self.on_cells, points, &mut attributes, &mut warnings));
        if let Some((rows, _)) = particles {
            let some = |track| cells::kept(track, rows.clone(), points);
            tracks = tracks.into_iter().map(some).collect();
        }
        let about = About { placed: Some(0), attributes, warnings, time, format, asked };
        Plan::new(tracks, about, limit)
    }

    /// Adds the pieces of a file to the grid. Returns false if `head`, which leaves out long texts, lacks one that is
    /// needed and cannot be read from its place in the file.
    fn read(&mut self, content: &Content<'a>, head: &Head) -> Result<bool, ReadError> {
        let document = head.parse()?;
        let root = document.root_element();
        let kind = root.attribute("type").unwrap_or_default();
        let vtp = match (root.tag_name().name(), kind) {
            ("VTKFile", "UnstructuredGrid") => false,
            ("VTKFile", "PolyData") => true,
            ("VTKFile", "PUnstructuredGrid" | "PPolyData" | "Collection") => {
                return Err(ReadError::Unsupported {
                    what: format!("the VTK index file of type {kind}"),
                    advice: "it only names other files: give it by its path, with them beside it",
                });
            }
            ("VTKFile", _) => {
                return Err(ReadError::Unsupported {
                    what: format!("VTK XML of type \"{kind}\""),
                    advice: "particles are UnstructuredGrid or PolyData: save one of these",
                });
            }
            (name, _) => {
                return Err(ReadError::Unsupported {
                    what: format!("XML of `{name}`, where a VTKFile element was expected,"),
                    advice: if name == "Xdmf" {
                        "it names arrays of HDF5: give it by its path, as .xdmf or .xmf, with these beside it"
                    } else {
                        "particles are VTK XML: save VTU or VTP"
                    },
                });
            }
        };
        let compression = match root.attribute("compressor").unwrap_or_default() {
            "" => Compression::None,
            "vtkZLibDataCompressor" => Compression::Zlib,
            "vtkLZ4DataCompressor" => Compression::Lz4,
            "vtkLZMADataCompressor" => Compression::Lzma,
            other => {
                return Err(ReadError::Unsupported {
                    what: format!("VTK XML packed by {other}"),
                    advice: "save with zlib, LZ4, LZMA or no compression",
                });
            }
        };
        let mut reader = Reader {
            content,
            head,
            big_endian: match root.attribute("byte_order") {
                Some("BigEndian") => true,
                Some("LittleEndian") | None => false,
                Some(other) => return Err(attribute_error("byte_order", other)),
            },
            wide: match root.attribute("header_type") {
                Some("UInt64") => true,
                Some("UInt32") | None => false,
                Some(other) => return Err(attribute_error("header_type", other)),
            },
            compression,
            appended: head.appended.map(|at| Appended::parse(content, at)).transpose()?,
            budget: content.unpack_limit(),
        };
        self.limit = self.limit.saturating_add(content.unpack_limit());
        for piece in root.descendants().filter(|node| node.has_tag_name("Piece")) {
            let points: u64 = reader.parsed(&piece, "NumberOfPoints", None)?;
            if points == 0 {
                continue;
            }
            let Some(array) = child(&piece, "Points").and_then(|p| child(&p, "DataArray")) else {
                return Err(ReadError::malformed(
                    "Points with a DataArray in each Piece",
                    "none",
                    head.place(&piece),
                ));
            };
            let (name, components, ty) = reader.described(&array)?;
            // The name that VTK itself gives them.
            let name = if array.has_attribute("Name") { name } else { "Points".into() };
            let first_piece = self.found.is_empty();
            if components != 3 || ty.size().is_none() {
                return Err(ReadError::malformed(
                    "Points with three numbers each",
                    format!("{components} x {ty}"),
                    head.place(&array),
                ));
            }
            if first_piece {
                self.asked.list(&mut self.attributes, &name, components, ty);
                let storage = reader.storage(&array)?;
                self.format = Some(match vtp {
                    true => Format::Vtp(storage, compression),
                    false => Format::Vtu(storage, compression),
                });
            }
            let segment = reader.segment(&array, &name, ty, points.saturating_mul(3))?;
            let Some(segment) = segment else { return Ok(false) };
            let points_column = Column::new(PLACED, 3, ty);
            if first_piece {
                self.found.push((points_column, Array { name, components, segments: Vec::new() }));
            }
            reader.add(self.found.first_mut(), segment, &array)?;
            let (cells, cell) = reader.mesh(&piece);
            if cells > 0 {
                self.cells = self.cells.saturating_add(cells);
                self.cell = cell;
            }
            match reader.vertices(&piece, points, vtp, &mut self.vertices) {
                Ok(()) => {}
                Err(Missing::List) => self.vertices.all(points, false),
                Err(Missing::Text) => return Ok(false),
            }
            if !reader.cells(&piece, points, &mut self.on_cells, &self.asked)? {
                return Ok(false);
            }
            let Some(point_data) = child(&piece, "PointData") else { continue };
            for array in point_data.children().filter(|n| n.has_tag_name("DataArray")) {
                let (name, components, ty) = reader.described(&array)?;
                let wanted = if first_piece {
                    self.asked.list(&mut self.attributes, &name, components, ty)
                } else {
                    self.asked.wants(&name)
                };
                if !wanted || ty.size().is_none() {
                    continue;
                }
                let count = points.saturating_mul(components as u64);
                let Some(segment) = reader.segment(&array, &name, ty, count)? else {
                    return Ok(false);
                };
                let same = self.found.iter().skip(1).position(|(column, _)| column.name == name);
                // A second array of the same name makes the attribute too long, which is detected at the end.
                let at = same.map_or(self.found.len(), |at| at + 1);
                if same.is_none() {
                    let column = Column::new(&name, components, ty);
                    self.found.push((column, Array { name, components, segments: Vec::new() }));
                }
                reader.add(self.found.get_mut(at), segment, &array)?;
            }
        }
        let data = root.descendants().find(|node| node.has_tag_name("FieldData"));
        let mut arrays = data.iter().flat_map(|data| data.children());
        let time = arrays.find(|a| matches!(a.attribute("Name"), Some("TimeValue" | "TIME")));
        if let (Some(array), None) = (time, self.time) {
            self.time = reader.peek(&array, 1).and_then(|found| found.first().copied());
        }
        Ok(true)
    }
}

/// Warning about the vertices of a mesh.
pub(super) fn mesh_warning(cells: u64, cell: &str) -> String {
    format!(
        "this is a mesh of {cells} {cell}: its vertices are taken as particles; particles fill the water, vertices only lie \
         on it: give the particles that the mesh was made of"
    )
}

fn child<'a, 'i>(node: &Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|n| n.has_tag_name(name))
}

fn array_of<'a, 'i>(node: &Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|array| array.attribute("Name") == Some(name))
}

fn attribute_error(name: &str, value: &str) -> ReadError {
    ReadError::malformed(format!("a known `{name}`"), format!("\"{value}\""), Place::Unknown)
}

/// The bytes after the header.
#[derive(Clone, Copy)]
struct Appended {
    base64: bool,
    /// Byte offset of the first one.
    start: u64,
}

impl Appended {
    /// Parses from the element on, which begins at `at`.
    fn parse(content: &Content<'_>, at: u64) -> Result<Self, ReadError> {
        let mut text = Text::new(content.open(at, content.length())?);
        let tag = text.until(b'>')?;
        let mark = text.until(b'_')?;
        let (Some(tag), Some(_)) = (tag, mark) else {
            return Err(ReadError::malformed(
                "an underscore before the appended data",
                "none",
                Place::Byte(at),
            ));
        };
        let start = text.at();
        let has = |word: &[u8]| tag.windows(word.len()).any(|w| w == word);
        if has(b"base64") {
            Ok(Self { base64: true, start })
        } else if has(b"raw") {
            Ok(Self { base64: false, start })
        } else {
            Err(ReadError::malformed(
                "appended data in `raw` or `base64`",
                show(&tag),
                Place::Byte(start),
            ))
        }
    }
}

/// Whether a cell of this type consists of points or nothing.
pub(super) fn is_point(cell: f64) -> bool {
    cell <= 2.0
}

/// Why the points of cells are unknown.
enum Missing {
    /// There is no list of them that can be read.
    List,
    /// The head leaves out their text, which cannot be read from its place in the file.
    Text,
}

/// Finds the arrays.
struct Reader<'h, 'a> {
    content: &'h Content<'a>,
    head: &'h Head,
    big_endian: bool,
    /// Whether headers have 64 bits.
    wide: bool,
    compression: Compression,
    appended: Option<Appended>,
    /// Number of bytes that may still be decompressed, in all arrays together, because several arrays may refer
    /// to the same data.
    budget: u64,
}

impl<'a> Reader<'_, 'a> {
    /// A numeric attribute of an element.
    fn parsed(
        &self,
        node: &Node<'_, '_>,
        name: &str,
        default: Option<u64>,
    ) -> Result<u64, ReadError> {
        let value = match (node.attribute(name), default) {
            (None, Some(default)) => return Ok(default),
            (value, _) => value.unwrap_or_default(),
        };
        value.trim().parse().map_err(|_| {
            ReadError::malformed(
                format!("a number as `{name}`"),
                format!("\"{value}\""),
                self.head.place(node),
            )
        })
    }

    /// Name, number of components and type of an array.
    fn described(&self, array: &Node<'_, '_>) -> Result<(String, usize, AttributeType), ReadError> {
        use AttributeType as T;
        let ty = match array.attribute("type").unwrap_or_default() {
            "Int8" => T::I8,
            "UInt8" => T::U8,
            "Int16" => T::I16,
            "UInt16" => T::U16,
            "Int32" => T::I32,
            "UInt32" => T::U32,
            "Int64" => T::I64,
            "UInt64" => T::U64,
            "Float32" => T::F32,
            "Float64" => T::F64,
            "String" => T::Text,
            _ => T::Other,
        };
        let name = array.attribute("Name").unwrap_or("unnamed").to_string();
        let components = self.parsed(array, "NumberOfComponents", Some(1))?;
        Ok((name, usize::try_from(components).unwrap_or(usize::MAX), ty))
    }

    /// Returns the number of cells in a piece and the word for their type, if most of them are not single points;
    /// otherwise 0.
    fn mesh(&mut self, piece: &Node<'_, '_>) -> (u64, &'static str) {
        let number = |name: &str| piece.attribute(name).and_then(|n| n.trim().parse().ok());
        let polygons =
            ["NumberOfPolys", "NumberOfStrips"].map(|name| number(name).unwrap_or(0_u64));
        let polygons = polygons.into_iter().fold(0, u64::saturating_add);
        if polygons > 0 && number("NumberOfVerts").unwrap_or(0) == 0 {
            return (polygons, "polygons");
        }
        let cells = number("NumberOfCells").unwrap_or(0);
        let types = child(piece, "Cells").and_then(|cells| array_of(&cells, "types"));
        let types = types.filter(|_| cells > 0).and_then(|types| self.peek(&types, cells));
        let types = types.unwrap_or_default();
        let more = types.iter().filter(|ty| !is_point(**ty)).count();
        if 2 * more > types.len() { (cells, "cells") } else { (0, "") }
    }

    /// Finds which points of a piece are particles.
    fn vertices(
        &mut self,
        piece: &Node<'_, '_>,
        points: u64,
        vtp: bool,
        all: &mut Vertices,
    ) -> Result<(), Missing> {
        let number =
            |name: &str| piece.attribute(name).and_then(|n| n.trim().parse().ok()).unwrap_or(0_u64);
        let (mut vertices, mut others) = (Vec::new(), Vec::new());
        if vtp {
            let names = [
                ("Lines", "NumberOfLines"),
                ("Strips", "NumberOfStrips"),
                ("Polys", "NumberOfPolys"),
            ];
            let alone = names.iter().all(|(_, count)| number(count) == 0);
            let count = number("NumberOfVerts");
            if count == 0 || (alone && count >= points) {
                if alone {
                    all.all(points, count > 0);
                } else {
                    all.none(points);
                }
                return Ok(());
            }
            let ends = self.integers(piece, "Verts", "offsets", count)?;
            let last = u64::from(ends.last().copied().unwrap_or(0));
            if alone && last >= points {
                all.all(points, true);
                return Ok(());
            }
            vertices = self.integers(piece, "Verts", "connectivity", last)?;
            for (name, count) in names.into_iter().filter(|(_, count)| number(count) > 0) {
                let ends = self.integers(piece, name, "offsets", number(count))?;
                let last = u64::from(ends.last().copied().unwrap_or(0));
                others.append(&mut self.integers(piece, name, "connectivity", last)?);
            }
        } else {
            let count = number("NumberOfCells");
            if count == 0 {
                all.all(points, false);
                return Ok(());
            }
            let first = child(piece, "Cells").and_then(|cells| array_of(&cells, "types"));
            let first = first.and_then(|types| self.peek(&types, count)).ok_or(Missing::List)?;
            // All types are only read if particles and other points may be mixed.
            if count == points && first.iter().all(|ty| is_point(*ty)) {
                all.all(points, true);
                return Ok(());
            }
            let types = self.integers(piece, "Cells", "types", count)?;
            let is_vertex = |ty: &u32| is_point(f64::from(*ty));
            if !types.iter().any(is_vertex) {
                all.none(points);
                return Ok(());
            }
            let ends = self.integers(piece, "Cells", "offsets", count)?;
            let last = u64::from(ends.last().copied().unwrap_or(0));
            if last >= points && types.iter().all(is_vertex) {
                all.all(points, true);
                return Ok(());
            }
            let list = self.integers(piece, "Cells", "connectivity", last)?;
            let mut start = 0;
            for (end, ty) in ends.into_iter().zip(&types) {
                let own = list.get(start..end as usize).ok_or(Missing::List)?;
                if is_vertex(ty) { &mut vertices } else { &mut others }.extend_from_slice(own);
                start = end as usize;
            }
        }
        if vertices.iter().chain(&others).any(|point| u64::from(*point) >= points) {
            return Err(Missing::List);
        }
        all.some(points, vertices, others);
        Ok(())
    }

    /// The values of a list of a piece's cells.
    fn integers(
        &mut self,
        piece: &Node<'_, '_>,
        cells: &str,
        name: &str,
        count: u64,
    ) -> Result<Vec<u32>, Missing> {
        let list = child(piece, cells).and_then(|cells| array_of(&cells, name));
        let list = list.ok_or(Missing::List)?;
        let (_, components, ty) = self.described(&list).map_err(|_| Missing::List)?;
        if components != 1 || ty.size().is_none() {
            return Err(Missing::List);
        }
        // These values do not concern the particles' own.
        let budget = self.budget;
        let segment = self.segment(&list, name, ty, count);
        self.budget = budget;
        let segment = segment.map_err(|_| Missing::List)?.ok_or(Missing::Text)?;
        let array = Array { name: name.into(), components: 1, segments: vec![segment] };
        let track = arrays::track(Column::new(name, 1, ty), array);
        cells::integers(&track, count).ok_or(Missing::List)
    }

    /// Finds the attributes of a piece's cells, and whether each cell is one of its points. Returns false if the
    /// head, which leaves out long texts, lacks one that is needed and cannot be read from its place in the file.
    fn cells(
        &mut self,
        piece: &Node<'_, '_>,
        points: u64,
        on_cells: &mut OnCells<'a>,
        asked: &Asked,
    ) -> Result<bool, ReadError> {
        let arrays = child(piece, "CellData").into_iter().flat_map(|data| data.children());
        let arrays: Vec<_> = arrays.filter(|n| n.has_tag_name("DataArray")).collect();
        // Of poly data, the values of vertices come before those of other cells.
        let number = |name: &str| self.parsed(piece, name, Some(0));
        let counts = ["NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys"];
        let (verts, cells) = match child(piece, "Cells") {
            Some(node) => (Some(node), number("NumberOfCells")?),
            None => {
                let all = counts.iter().map(|name| number(name));
                let all = all.collect::<Result<Vec<_>, _>>()?;
                (child(piece, "Verts"), all.into_iter().fold(0, u64::saturating_add))
            }
        };
        if arrays.is_empty() || cells == 0 {
            on_cells.cells.skip(points);
            return Ok(true);
        }
        on_cells.cells.compare(cells, points);
        let mut meant = false;
        for array in arrays {
            let (name, components, ty) = self.described(&array)?;
            let known = on_cells.attributes.iter().any(|a| a.name == name);
            let wanted = match known {
                true => asked.wants(&name),
                false => asked.list(&mut on_cells.attributes, &name, components, ty),
            };
            if !wanted || ty.size().is_none() || on_cells.cells.are_refused() {
                continue;
            }
            meant = true;
            let count = cells.saturating_mul(components as u64);
            let Some(segment) = self.segment(&array, &name, ty, count)? else { return Ok(false) };
            let own = cells::column_name(&name);
            let same = on_cells.found.iter().position(|(_, found)| found.name == name);
            let at = same.unwrap_or(on_cells.found.len());
            if same.is_none() {
                let array = Array { name, components, segments: Vec::new() };
                on_cells.found.push((Column::new(&own, components, ty), array));
            }
            self.add(on_cells.found.get_mut(at), segment, &array)?;
        }
        // The lists need not be read for attributes without a meaning.
        if !meant {
            on_cells.cells.skip(points);
            return Ok(true);
        }
        let list = |name: &str| {
            let list = array_of(&verts?, name)?;
            let (_, components, ty) = self.described(&list).ok()?;
            (components == 1 && ty.size().is_some()).then_some((list, ty))
        };
        let Some((offsets, connectivity)) = list("offsets").zip(list("connectivity")) else {
            on_cells.cells.refuse("they do not list their points".into());
            return Ok(true);
        };
        let mut tracks = Vec::new();
        for (name, (list, ty)) in [("offsets", offsets), ("connectivity", connectivity)] {
            let segment = match self.segment(&list, name, ty, cells) {
                Ok(Some(segment)) => segment,
                Ok(None) => return Ok(false),
                Err(error) => {
                    on_cells.cells.refuse(format!("their list cannot be read ({error})"));
                    return Ok(true);
                }
            };
            let array = Array { name: name.into(), components: 1, segments: vec![segment] };
            tracks.push(arrays::track(Column::new(name, 1, ty), array));
        }
        let (points_of, sums) = (tracks.pop(), tracks.pop());
        if let Some((points_of, sums)) = points_of.zip(sums) {
            let ends = Ends::Sums(sums, 1);
            on_cells.cells.add(points, &Lists { cells, ends, points: points_of, length: cells });
        }
        Ok(true)
    }

    /// Reads an array of `count` values, at most its first 1024. The result of an error is `None`, because these
    /// values do not concern the particles.
    fn peek(&mut self, array: &Node<'_, '_>, count: u64) -> Option<Vec<f64>> {
        let budget = self.budget;
        let (name, _, ty) = self.described(array).ok()?;
        let segment = self.segment(array, &name, ty, count);
        self.budget = budget;
        arrays::first(segment.ok()??, ty)
    }

    fn storage(&self, array: &Node<'_, '_>) -> Result<Storage, ReadError> {
        match array.attribute("format").unwrap_or("ascii") {
            "ascii" => Ok(Storage::Ascii),
            "binary" => Ok(Storage::InlineBase64),
            "appended" => match self.appended {
                Some(Appended { base64: false, .. }) => Ok(Storage::AppendedRaw),
                Some(Appended { base64: true, .. }) => Ok(Storage::AppendedBase64),
                None => Err(ReadError::malformed(
                    "AppendedData in the file",
                    "none; it was perhaps cut off",
                    self.head.place(array),
                )),
            },
            other => Err(ReadError::malformed(
                "format `ascii`, `binary` or `appended`",
                format!("\"{other}\""),
                self.head.place(array),
            )),
        }
    }

    /// The place of an array's `count` values in the file; `None` if the values are in a text that the head leaves
    /// out and that cannot be read from its place.
    fn segment(
        &mut self,
        array: &Node<'_, '_>,
        name: &str,
        ty: AttributeType,
        count: u64,
    ) -> Result<Option<Segment<'a>>, ReadError> {
        let storage = self.storage(array)?;
        let offset = self.head.offset(array);
        if storage != Storage::Ascii {
            let bytes = count.saturating_mul(ty.size().unwrap_or(1));
            if self.budget <= bytes {
                let what = format!("array `{name}`");
                return Err(ReadError::TooLarge { what, limit: self.budget });
            }
            self.budget -= bytes;
        }
        let encoding = |base64| Encoding {
            base64,
            compression: self.compression,
            big_endian: self.big_endian,
            wide: self.wide,
        };
        let (stored, text) = match (storage, self.appended) {
            (Storage::Ascii, _) => {
                (Stored::OwnWords(offset, self.head.place(array)), self.head.words(array))
            }
            (Storage::AppendedRaw | Storage::AppendedBase64, Some(Appended { base64, start })) => {
                let at = self.parsed(array, "offset", None)?;
                let start = start.saturating_add(at);
                (Stored::Bytes(encoding(base64), start), Words::There(start, u64::MAX))
            }
            _ => (Stored::Bytes(encoding(true), offset), self.head.words(array)),
        };
        let (content, start, end) = match text {
            // The element may contain information keys besides the text.
            Words::Here(text) => {
                let text = text.as_bytes().to_vec();
                let length = text.len() as u64;
                (Content::of_bytes(text)?, 0, length)
            }
            Words::There(start, end) => (self.content.clone(), start, end),
            Words::Mixed => return Ok(None),
        };
        Ok(Some(Segment { content, start, end, count, ty, stored }))
    }

    /// Adds a segment to an attribute, which must have the same shape.
    fn add(
        &self,
        to: Option<&mut (Column, Array<'a>)>,
        segment: Segment<'a>,
        array: &Node<'_, '_>,
    ) -> Result<(), ReadError> {
        let Some((column, found)) = to else { return Ok(()) };
        let (name, components, _) = self.described(array)?;
        if components != found.components || !column.data.takes(segment.ty) {
            return Err(ReadError::malformed(
                format!("the same type and components of `{name}` in all pieces"),
                "others",
                self.head.place(array),
            ));
        }
        found.segments.push(segment);
        Ok(())
    }
}
