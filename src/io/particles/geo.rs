//! Classic Houdini ASCII geometry, version 5 (`.geo` before Houdini 12).
//!
//! The file has `PGEOMETRY V5`, counts such as `NPoints n` and `NPointAttrib n`, then `PointAttrib` with one
//! line per attribute (name, components, type, defaults; for an index attribute also the texts), then one
//! line per point: `x y z w (values)`, without brackets if there are no attributes. The rest is not read.

use super::Format;
use super::asked::Asked;
use super::bytes::{parse_number, show};
use super::columns::{AttributeType, Column, PLACED};
use super::error::{Place, ReadError};
use super::plan::About;
use super::source::{Content, truncated};
use super::table::{RowReader, Table};
use super::text::Text;

pub(super) fn open<'a>(content: &Content<'a>, asked: &Asked) -> Result<Table<'a>, ReadError> {
    let mut text = Text::new(content.open(0, content.length())?);
    let mut number = 1_u64;
    let first = text.line()?.unwrap_or_default();
    if first.trim_ascii() != b"PGEOMETRY V5" {
        return Err(ReadError::malformed("`PGEOMETRY V5`", show(first), Place::Line(1)));
    }
    // The counts are on a few lines of `name number` pairs.
    let mut points = None;
    let mut attributes = None;
    while points.is_none() || attributes.is_none() {
        number += 1;
        let Some(line) = text.line()? else {
            return Err(truncated("the counts NPoints and NPointAttrib", text.at(), 1, 0));
        };
        let words: Vec<_> = words(line).collect();
        for pair in words.chunks_exact(2) {
            let [name, value] = pair else { continue };
            let target = match *name {
                b"NPoints" => &mut points,
                b"NPointAttrib" => &mut attributes,
                _ => continue,
            };
            let value = std::str::from_utf8(value).ok().and_then(|v| v.parse().ok());
            let value: u64 = value
                .ok_or_else(|| ReadError::malformed("a count", show(line), Place::Line(number)))?;
            *target = Some(value);
        }
    }
    let (points, attributes) = (points.unwrap_or(0), attributes.unwrap_or(0));

    let mut about = About { placed: Some(0), ..About::new(Format::Geo, asked) };
    about.list("position", 3, AttributeType::F32);
    let mut columns = vec![Column::new(PLACED, 3, AttributeType::F32)];
    let mut fields = Vec::new();
    while (fields.len() as u64) < attributes {
        number += 1;
        let Some(line) = text.line()? else {
            return Err(truncated("the point attributes", text.at(), 1, 0));
        };
        let words: Vec<_> = words(line).collect();
        let [name, size, ty, ..] = words.as_slice() else {
            continue; // `PointAttrib` or an empty line
        };
        let size = std::str::from_utf8(size).ok().and_then(|v| v.parse::<u16>().ok());
        let (Some(size), Ok(name)) = (size, std::str::from_utf8(name)) else {
            return Err(ReadError::malformed(
                "a point attribute: name, size, type",
                show(line),
                Place::Line(number),
            ));
        };
        let size = usize::from(size);
        let ty = match *ty {
            b"float" | b"vector" => AttributeType::F32,
            b"int" => AttributeType::I32,
            b"index" => AttributeType::Text,
            other => {
                return Err(ReadError::malformed(
                    "type float, int, index or vector",
                    show(other),
                    Place::Line(number),
                ));
            }
        };
        let keep = about.list(name, size, ty) && ty != AttributeType::Text;
        fields.push(Field { size, column: keep.then_some(columns.len()) });
        if keep {
            columns.push(Column::new(name, size, ty));
        }
    }
    let rows = Box::new(Points { text, number, left: points, fields });
    Ok(Table { columns, about, rows })
}

/// An attribute in the line of a point.
struct Field {
    /// Number of words.
    size: usize,
    column: Option<usize>,
}

struct Points<'a> {
    text: Text<'a>,
    /// Number of the line that was read last.
    number: u64,
    left: u64,
    fields: Vec<Field>,
}

impl RowReader for Points<'_> {
    fn next(&mut self, columns: &mut [Column]) -> Result<bool, ReadError> {
        while self.left > 0 {
            self.number += 1;
            let Some(line) = self.text.line()? else {
                let needed = self.left.saturating_mul(8);
                return Err(truncated("the points", self.text.at(), needed, 0));
            };
            let mut words = words(line).peekable();
            if words.peek().is_some_and(|first| first != b"PointAttrib") {
                let point = point(words, &self.fields, columns);
                let expected = "a point: x y z w and its attributes";
                let place = Place::Line(self.number);
                point.ok_or_else(|| ReadError::malformed(expected, show(line), place))?;
                self.left -= 1;
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// Appends the values of a point to the columns; the first column holds the positions. `None` if a value is not a
/// number.
fn point<'l>(
    mut words: impl Iterator<Item = &'l [u8]>,
    fields: &[Field],
    columns: &mut [Column],
) -> Option<()> {
    let positions = columns.first_mut()?;
    for _ in 0..3 {
        positions.data.push_text(words.next()?).then_some(())?;
    }
    parse_number(words.next()?)?;
    for field in fields {
        for _ in 0..field.size {
            let word = words.next()?;
            if let Some(column) = field.column.and_then(|i| columns.get_mut(i)) {
                column.data.push_text(word).then_some(())?;
            }
        }
    }
    Some(())
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|b| b.is_ascii_whitespace() || matches!(b, b'(' | b')'))
        .filter(|word| !word.is_empty())
}
