//! Reads PLY: the properties of the element `vertex`, in ASCII and in binary of either byte order.
//!
//! The header consists of lines (`ply`, `format`, `element name count`, `property type name`, `property list
//! type type name`, `comment`, `obj_info`, `end_header`). The elements follow in the order of the header, row
//! after row. Elements before the vertices are skipped, and so are lists. What follows the vertices is passed over, to
//! find a false count of vertices: rows of polygons would be taken as vertices, or vertices be left out.
//!
//! The reader is our own, because the crate ply-rs-bw (4.0) keeps a map of names for each vertex if the
//! properties are not known at compile time: 870 bytes for a vertex of 28 bytes in the file.

use super::Format;
use super::asked::Asked;
use super::bytes::{Cursor, parse_number, show};
use super::columns::{AttributeType, Column, Data};
use super::error::{Place, ReadError};
use super::plan::About;
use super::rows::{Field, Layout, Rows};
use super::source::{self, Content, truncated};
use super::table::{RowReader, Table};
use super::text::Text;
use super::vtk_xml::mesh_warning;

/// A property: a number, or a list with the type of its length.
#[derive(Clone)]
struct Property {
    name: String,
    ty: AttributeType,
    list: Option<AttributeType>,
}

#[derive(Clone)]
struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

impl Element {
    fn what(&self) -> String {
        format!("element `{}`", self.name)
    }

    /// Bytes per row in a binary file; `None` if rows differ in length.
    fn stride(&self) -> Option<u64> {
        self.properties.iter().map(|p| p.list.map_or(p.ty.size(), |_| None)).sum()
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

/// Parses the header of a file (or of its beginning), and returns its length. `None` for the layout if rows
/// differ in length (in text, and with lists before the vertices or in them), or if other rows follow the vertices.
pub(super) fn layout(bytes: &[u8], asked: &Asked) -> Result<(Option<Layout>, u64), ReadError> {
    let mut cursor = Cursor::new(bytes);
    let (encoding, elements) = header(&mut cursor)?;
    let header = cursor.at() as u64;
    let (before, vertex) = split(&elements)?;
    let between = before.iter().map(|e| Some((e.what(), e.count.saturating_mul(e.stride()?))));
    let between: Option<Vec<_>> = between.collect();
    let alike = encoding != Encoding::Ascii && behind(&elements, before).next().is_none();
    let (Some(between), Some(stride), true) = (between, vertex.stride(), alike) else {
        return Ok((None, header));
    };
    let mut attributes = Vec::new();
    let mut fields = Vec::new();
    let mut offset = 0;
    for property in &vertex.properties {
        if asked.list(&mut attributes, &property.name, 1, property.ty) {
            fields.push(Field::new(&property.name, 1, property.ty, offset)?);
        }
        offset += property.ty.size().unwrap_or(0);
    }
    let big_endian = encoding == Encoding::Big;
    let layout = Layout {
        rows: Rows {
            what: vertex.what(),
            header,
            between,
            count: vertex.count,
            stride,
            big_endian,
            fields,
        },
        placed: false,
        attributes,
        warnings: faces(&elements),
        format: Format::PlyBinary { big_endian },
        asked: asked.clone(),
    };
    Ok((Some(layout), header))
}

/// Warnings about a mesh.
fn faces(elements: &[Element]) -> Vec<String> {
    let of_faces = |e: &&Element| e.count > 0 && matches!(e.name.as_str(), "face" | "tristrips");
    let faces = elements.iter().find(of_faces);
    faces.map(|faces| mesh_warning(faces.count, "polygons")).into_iter().collect()
}

/// Splits the elements into those before the vertices, and the vertices.
fn split(elements: &[Element]) -> Result<(&[Element], &Element), ReadError> {
    // Other programs use other names for the points.
    let name =
        |of: &Element| matches!(of.name.as_str(), "point" | "points" | "particle" | "particles");
    let at = elements.iter().position(|element| element.name == "vertex");
    at.or_else(|| elements.iter().position(name))
        .and_then(|at| Some((elements.get(..at)?, elements.get(at)?)))
        .ok_or_else(|| ReadError::malformed("an element `vertex`", "none", Place::Unknown))
}

/// The elements behind the vertices that have rows, given those before them.
fn behind<'e>(elements: &'e [Element], before: &[Element]) -> impl Iterator<Item = &'e Element> {
    let rows = |element: &&Element| element.count > 0 && !element.properties.is_empty();
    elements.iter().skip(before.len() + 1).filter(rows)
}

/// Checks that nothing but white space follows the vertices of a binary file whose rows have one length.
///
/// # Errors
/// [`ReadError::Malformed`] if more follows, such as vertices that the header does not count.
pub(super) fn check_end(content: &Content<'_>, rows: &Rows) -> Result<(), ReadError> {
    let between: u64 = rows.between.iter().fold(0, |sum, (_, length)| sum.saturating_add(*length));
    let end = rows.header.saturating_add(between).saturating_add(rows.bytes());
    if rows.count == 0 || end >= content.length() {
        return Ok(());
    }
    let mut text = Text::new(content.open(end, content.length())?);
    text.skip_space()?;
    if text.ahead(1)?.is_empty() {
        return Ok(());
    }
    let found = format!("{} more bytes", content.length() - end);
    let expected = format!("nothing after the {} rows of {}", rows.count, rows.what);
    Err(ReadError::malformed(expected, found, Place::Byte(end)))
}

fn header(cursor: &mut Cursor<'_>) -> Result<(Encoding, Vec<Element>), ReadError> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut number = 0;
    loop {
        number += 1;
        let Some(line) = header_line(cursor) else {
            return Err(ReadError::truncated("the header, up to `end_header`,", cursor.at(), 1, 0));
        };
        let bad = |expected: &str| ReadError::malformed(expected, show(line), Place::Line(number));
        let text = String::from_utf8_lossy(line);
        let words: Vec<_> = text.split_ascii_whitespace().collect();
        match words.as_slice() {
            ["ply"] | ["comment" | "obj_info", ..] | [] => {}
            ["format", name, _version] => {
                encoding = Some(match *name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => {
                        return Err(bad("format ascii, binary_little_endian or binary_big_endian"));
                    }
                });
            }
            ["element", name, count] => elements.push(Element {
                name: (*name).to_string(),
                count: count.parse().map_err(|_| bad("a number of elements"))?,
                properties: Vec::new(),
            }),
            ["property", rest @ ..] => {
                const TYPE: &str = "a PLY type such as float, double, int or uchar";
                let (ty, list, name) = match rest {
                    ["list", length, ty, name] => {
                        let length = scalar(length).ok_or_else(|| bad(TYPE))?;
                        (ty, Some(length), name)
                    }
                    [ty, name] => (ty, None, name),
                    _ => return Err(bad("a property: type and name")),
                };
                let property = Property {
                    name: (*name).to_string(),
                    ty: scalar(ty).ok_or_else(|| bad(TYPE))?,
                    list,
                };
                elements
                    .last_mut()
                    .ok_or_else(|| bad("an element before a property"))?
                    .properties
                    .push(property);
            }
            ["end_header"] => {
                let encoding = encoding.ok_or_else(|| bad("a `format` line before the end"))?;
                return Ok((encoding, elements));
            }
            _ => return Err(bad("a line of a PLY header")),
        }
    }
}

/// Reads a line, which may end with a carriage return alone, as in the oldest files.
fn header_line<'a>(cursor: &mut Cursor<'a>) -> Option<&'a [u8]> {
    let rest = cursor.rest();
    let end = rest.iter().position(|b| matches!(b, b'\n' | b'\r'))?;
    let pair = rest.get(end) == Some(&b'\r') && rest.get(end + 1) == Some(&b'\n');
    let line = cursor.take(end as u64, "").ok()?;
    cursor.take(if pair { 2 } else { 1 }, "").ok()?;
    Some(line)
}

fn scalar(name: &str) -> Option<AttributeType> {
    use AttributeType as T;
    Some(match name {
        "char" | "int8" => T::I8,
        "uchar" | "uint8" => T::U8,
        "short" | "int16" => T::I16,
        "ushort" | "uint16" => T::U16,
        "int" | "int32" => T::I32,
        "uint" | "uint32" => T::U32,
        "int64" => T::I64,
        "uint64" => T::U64,
        "float" | "float32" => T::F32,
        "double" | "float64" => T::F64,
        _ => return None,
    })
}

/// Opens the vertices of a file whose rows differ in length.
pub(super) fn open<'a>(content: &Content<'a>, asked: &Asked) -> Result<Table<'a>, ReadError> {
    let header = |head: &[u8]| {
        let mut cursor = Cursor::new(head);
        let header = header(&mut cursor)?;
        let length = cursor.at() as u64;
        Ok(((header, length), length))
    };
    let ((encoding, elements), length) =
        source::header(&mut content.open(0, content.length())?, header)?;
    let (before, vertex) = split(&elements)?;
    let mut text = Text::new(content.open(length, content.length())?);
    for element in before {
        let mut rows = ElementRows::new(element, encoding, &text, element.what())?;
        while rows.next(&mut text, &[], &mut [])? {}
    }
    let format = match encoding {
        Encoding::Ascii => Format::PlyAscii,
        encoding => Format::PlyBinary { big_endian: encoding == Encoding::Big },
    };
    let mut about = About { warnings: faces(&elements), ..About::new(format, asked) };
    let (mut columns, mut taken) = (Vec::new(), Vec::new());
    for property in &vertex.properties {
        let ty = property.list.map_or(property.ty, |_| AttributeType::List);
        let keep = about.list(&property.name, 1, ty) && property.list.is_none();
        taken.push(keep.then_some(columns.len()));
        if keep {
            columns.push(Column::new(&property.name, 1, property.ty));
        }
    }
    let rows = ElementRows::new(vertex, encoding, &text, vertex.what())?;
    // Some programs count no vertices and write the rest all the same.
    let rest = (vertex.count > 0).then(|| Rest {
        encoding,
        elements: behind(&elements, before).cloned().collect(),
        vertices: vertex.count,
        after: format!("after the {} rows of {}", vertex.count, vertex.what()),
    });
    Ok(Table { columns, about, rows: Box::new(Vertices { text, rows, taken, rest }) })
}

/// What follows the vertices.
struct Rest {
    encoding: Encoding,
    elements: Vec<Element>,
    /// Number of vertices.
    vertices: u64,
    /// Where the elements are, in words.
    after: String,
}

impl Rest {
    /// Passes over it.
    ///
    /// # Errors
    /// It is not what the header says.
    fn check(&self, text: &mut Text<'_>) -> Result<(), ReadError> {
        let mut all = vec![self.after.clone()];
        for element in &self.elements {
            let what = format!("{}, {}", element.what(), self.after);
            let mut rows = ElementRows::new(element, self.encoding, text, what)?;
            // By chance other bytes may have the lengths of polygons, but hardly their indices.
            rows.below = (element.name == "face").then_some(self.vertices);
            while rows.next(text, &[], &mut [])? {}
            all.push(format!("the {} of {}", element.count, element.what()));
        }
        text.skip_space()?;
        let place = text.place();
        match text.token()? {
            None => Ok(()),
            Some(more) => {
                let expected = format!("nothing {}", all.join(" and "));
                Err(ReadError::malformed(expected, show(more), place))
            }
        }
    }
}

struct Vertices<'a> {
    text: Text<'a>,
    rows: ElementRows,
    /// For each property, the index of the column that takes its values.
    taken: Vec<Option<usize>>,
    /// What follows them, if it is to be checked.
    rest: Option<Rest>,
}

impl RowReader for Vertices<'_> {
    fn next(&mut self, columns: &mut [Column]) -> Result<bool, ReadError> {
        if self.rows.next(&mut self.text, &self.taken, columns)? {
            return Ok(true);
        }
        self.rest.take().map_or(Ok(()), |rest| rest.check(&mut self.text))?;
        Ok(false)
    }
}

/// Reads the rows of an element.
struct ElementRows {
    properties: Vec<Property>,
    encoding: Encoding,
    what: String,
    left: u64,
    /// Number of vertices, if lists of their indices are to be checked.
    below: Option<u64>,
}

impl ElementRows {
    /// `what` names the element in messages.
    fn new(
        element: &Element,
        encoding: Encoding,
        text: &Text<'_>,
        what: String,
    ) -> Result<Self, ReadError> {
        let properties = element.properties.clone();
        // A row without properties has no length, so its count could be anything.
        let left = if properties.is_empty() { 0 } else { element.count };
        if encoding == Encoding::Ascii {
            // Each number takes at least two bytes with its space, so a count that is too large for the file
            // fails here.
            let numbers = left.saturating_mul(properties.len() as u64);
            let (least, there) = (numbers.saturating_mul(2).saturating_sub(1), text.left());
            if least > there {
                return Err(truncated(&what, text.at(), least, there));
            }
        }
        Ok(Self { properties, encoding, what, left, below: None })
    }

    /// Reads the next row; `taken` says which of `columns`, if any, takes a property's value. False after the
    /// last row.
    fn next(
        &mut self,
        text: &mut Text<'_>,
        taken: &[Option<usize>],
        columns: &mut [Column],
    ) -> Result<bool, ReadError> {
        if self.left == 0 {
            return Ok(false);
        }
        self.left -= 1;
        for (i, property) in self.properties.iter().enumerate() {
            let column = taken.get(i).copied().flatten().and_then(|i| columns.get_mut(i));
            let data = column.map(|column| &mut column.data);
            match self.encoding {
                Encoding::Ascii => property.read_text(text, (&self.what, self.below), data)?,
                encoding => {
                    property.read_binary(text, (&self.what, self.below), encoding, data)?;
                }
            }
        }
        Ok(true)
    }
}

impl Property {
    /// Number of vertices below which the numbers of this list must be; `None` if they are no indices.
    fn indices(&self, below: Option<u64>) -> Option<u64> {
        let named = matches!(self.name.as_str(), "vertex_indices" | "vertex_index");
        below.filter(|_| named && self.list.is_some())
    }

    /// The error for a list of indices that has another number, or none.
    fn no_index(&self, what: &str, below: u64, found: String, place: Place) -> ReadError {
        let expected = format!("indices below {below} in the list `{}` of {what}", self.name);
        ReadError::malformed(expected, found, place)
    }

    fn read_binary(
        &self,
        text: &mut Text<'_>,
        (what, below): (&str, Option<u64>),
        encoding: Encoding,
        data: Option<&mut Data>,
    ) -> Result<(), ReadError> {
        let big_endian = encoding == Encoding::Big;
        let size = self.ty.size().unwrap_or(0);
        let Some(length) = self.list else {
            let raw = text.take(size, what)?;
            if let Some(data) = data {
                data.push_bytes(self.ty, raw, big_endian);
            }
            return Ok(());
        };
        let place = text.place();
        let raw = text.take(length.size().unwrap_or(0), what)?;
        let mut number = Data::for_type(length);
        number.push_bytes(length, raw, big_endian);
        let length = list_length(&number).ok_or_else(|| {
            let expected = format!("the length of the list `{}` in {what}", self.name);
            ReadError::malformed(expected, show(raw), place)
        })?;
        let Some(below) = self.indices(below) else {
            return text.skip(length.saturating_mul(size), what);
        };
        if length == 0 {
            return Err(self.no_index(what, below, "none".into(), place));
        }
        for _ in 0..length {
            let place = text.place();
            let mut number = Data::for_type(self.ty);
            number.push_bytes(self.ty, text.take(size, what)?, big_endian);
            let index = number.f64(0).filter(|index| (0.0..below as f64).contains(index));
            if index.is_none() {
                let found = number.f64(0).unwrap_or(f64::NAN).to_string();
                return Err(self.no_index(what, below, found, place));
            }
        }
        Ok(())
    }

    fn read_text(
        &self,
        text: &mut Text<'_>,
        (what, below): (&str, Option<u64>),
        data: Option<&mut Data>,
    ) -> Result<(), ReadError> {
        text.skip_space()?;
        let (place, at) = (text.place(), text.at());
        let token = text.token()?.ok_or_else(|| truncated(what, at, 1, 0))?;
        let bad = |expected: &str| {
            let expected = format!("{expected} of `{}` in {what}", self.name);
            ReadError::malformed(expected, show(token), place)
        };
        if self.list.is_some() {
            let length = std::str::from_utf8(token).ok().and_then(|t| t.parse::<u64>().ok());
            let length = length.ok_or_else(|| bad("the length of the list"))?;
            let below = self.indices(below);
            if let (Some(below), 0) = (below, length) {
                return Err(self.no_index(what, below, "none".into(), place));
            }
            for _ in 0..length {
                let (place, at) = (text.place(), text.at());
                let token = text.token()?.ok_or_else(|| truncated(what, at, 1, 0))?;
                let index = parse_number(token);
                if let Some(below) = below
                    && !index.is_some_and(|index| (0.0..below as f64).contains(&index))
                {
                    return Err(self.no_index(what, below, show(token), place));
                }
            }
            return Ok(());
        }
        let number = match data {
            Some(data) => data.push_text(token),
            None => parse_number(token).is_some(),
        };
        if number { Ok(()) } else { Err(bad("a number as the value")) }
    }
}

fn list_length(number: &Data) -> Option<u64> {
    match number {
        Data::Int(v) => v.first().and_then(|n| u64::try_from(*n).ok()),
        _ => None,
    }
}
