//! PLY: the properties of the element `vertex`, in ASCII, binary little-endian and binary big-endian.
//!
//! A header of lines (`ply`, `format`, `element name count`, `property type name`, `property list type type
//! name`, `comment`, `obj_info`, `end_header`), then the elements in the order of the header, row after row.
//! Elements before the vertices are passed over, what follows them is not read; lists are skipped.
//!
//! Own, since the crate for it (ply-rs-bw 4.0) keeps a map of names for each vertex where the properties are not
//! known when it is compiled: 870 bytes for one that has 28 in the file.

use super::bytes::{Cursor, parse_number, show};
use super::columns::{AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::rows::{Field, Layout, Rows};
use super::{Format, Particles};

/// One property: a number, or a list with the type of its length.
struct Property {
    name: String,
    ty: AttributeType,
    list: Option<AttributeType>,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

impl Element {
    fn what(&self) -> String {
        format!("element `{}`", self.name)
    }

    /// Bytes of a row in a binary file, where all are alike.
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

pub(super) fn read(bytes: &[u8]) -> Result<Particles, ReadError> {
    if let Some(layout) = layout(bytes)?.0 {
        return layout.read(bytes);
    }
    let mut cursor = Cursor::new(bytes);
    let (encoding, elements) = header(&mut cursor)?;
    let (before, vertex) = split(&elements)?;
    for element in before {
        rows(&mut cursor, encoding, element, &mut [])?;
    }
    vertices(&mut cursor, encoding, vertex)
}

/// What the header says and its length, of a file or the beginning of one; none where rows differ in length: of text,
/// and where there are lists up to the vertices.
pub(super) fn layout(bytes: &[u8]) -> Result<(Option<Layout>, u64), ReadError> {
    let mut cursor = Cursor::new(bytes);
    let (encoding, elements) = header(&mut cursor)?;
    let header = cursor.at() as u64;
    let (before, vertex) = split(&elements)?;
    let between = before.iter().map(|e| Some((e.what(), e.count.saturating_mul(e.stride()?))));
    let between: Option<Vec<_>> = between.collect();
    let (Some(between), Some(stride), true) =
        (between, vertex.stride(), encoding != Encoding::Ascii)
    else {
        return Ok((None, header));
    };
    let mut table = Table::default();
    let mut fields = Vec::new();
    let mut offset = 0;
    for property in &vertex.properties {
        if table.list(&property.name, 1, property.ty) {
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
        attributes: table.attributes,
        format: Format::PlyBinary { big_endian },
    };
    Ok((Some(layout), header))
}

/// The elements before the vertices, and those.
fn split(elements: &[Element]) -> Result<(&[Element], &Element), ReadError> {
    let at = elements.iter().position(|element| element.name == "vertex");
    at.and_then(|at| Some((elements.get(..at)?, elements.get(at)?)))
        .ok_or_else(|| ReadError::malformed("an element `vertex`", "none", Place::Unknown))
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

/// A line that may end with a carriage return alone, as the oldest files have it.
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

fn vertices(
    cursor: &mut Cursor<'_>,
    encoding: Encoding,
    element: &Element,
) -> Result<Particles, ReadError> {
    let mut table = Table::default();
    let mut columns: Vec<Option<Data>> = Vec::new();
    for property in &element.properties {
        let ty = property.list.map_or(property.ty, |_| AttributeType::List);
        let keep = table.list(&property.name, 1, ty) && property.list.is_none();
        columns.push(keep.then(|| Data::for_type(property.ty)));
    }
    rows(cursor, encoding, element, &mut columns)?;
    for (property, data) in element.properties.iter().zip(columns) {
        if let Some(data) = data {
            table.push(&property.name, 1, data);
        }
    }
    table.assemble(match encoding {
        Encoding::Ascii => Format::PlyAscii,
        encoding => Format::PlyBinary { big_endian: encoding == Encoding::Big },
    })
}

/// Reads all rows of an element into the columns that are wanted; all are passed over where there are none.
fn rows(
    cursor: &mut Cursor<'_>,
    encoding: Encoding,
    element: &Element,
    columns: &mut [Option<Data>],
) -> Result<(), ReadError> {
    let what = || element.what();
    // Without properties a row takes no room, and a count could be anything.
    if element.properties.is_empty() {
        return Ok(());
    }
    if encoding == Encoding::Ascii {
        // A number and a space each, so a count that lies ends here.
        let least = element
            .count
            .saturating_mul(element.properties.len() as u64)
            .saturating_mul(2)
            .saturating_sub(1);
        let rest = cursor.rest().len();
        if least > rest as u64 {
            return Err(ReadError::truncated(what(), cursor.at(), least, rest));
        }
        for _ in 0..element.count {
            ascii_row(cursor, element, columns)?;
        }
        return Ok(());
    }
    let big_endian = encoding == Encoding::Big;
    for _ in 0..element.count {
        for (i, property) in element.properties.iter().enumerate() {
            let size = property.ty.size().unwrap_or(0);
            if let Some(length) = property.list {
                let place = cursor.place();
                let raw = cursor.take(length.size().unwrap_or(0), &what())?;
                let mut number = Data::for_type(length);
                number.push_bytes(length, raw, big_endian);
                let length = list_length(&number).ok_or_else(|| {
                    ReadError::malformed(
                        format!("the length of the list `{}`", property.name),
                        show(raw),
                        place,
                    )
                })?;
                cursor.take(length.saturating_mul(size), &what())?;
            } else {
                let raw = cursor.take(size, &what())?;
                if let Some(Some(data)) = columns.get_mut(i) {
                    data.push_bytes(property.ty, raw, big_endian);
                }
            }
        }
    }
    Ok(())
}

fn list_length(number: &Data) -> Option<u64> {
    match number {
        Data::Int(v) => v.first().and_then(|n| u64::try_from(*n).ok()),
        _ => None,
    }
}

fn ascii_row(
    cursor: &mut Cursor<'_>,
    element: &Element,
    columns: &mut [Option<Data>],
) -> Result<(), ReadError> {
    for (i, property) in element.properties.iter().enumerate() {
        let mut next = || {
            cursor.skip_space();
            let place = cursor.place();
            let token = cursor
                .token()
                .ok_or_else(|| ReadError::truncated(element.what(), cursor.at(), 1, 0))?;
            Ok::<_, ReadError>((token, place))
        };
        let (token, place) = next()?;
        let bad = |expected: &str| {
            ReadError::malformed(format!("{expected} of `{}`", property.name), show(token), place)
        };
        if property.list.is_some() {
            let length = std::str::from_utf8(token).ok().and_then(|t| t.parse::<u64>().ok());
            for _ in 0..length.ok_or_else(|| bad("the length of the list"))? {
                next()?;
            }
        } else if let Some(Some(data)) = columns.get_mut(i) {
            if !data.push_text(token) {
                return Err(bad("a number as the value"));
            }
        } else if parse_number(token).is_none() {
            return Err(bad("a number as the value"));
        }
    }
    Ok(())
}
