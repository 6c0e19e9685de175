//! Classic Houdini ASCII geometry, version 5 (`.geo` before Houdini 12).
//!
//! `PGEOMETRY V5`, counts as `NPoints n`, `NPointAttrib n` ..., then `PointAttrib` with a line for each
//! attribute (name, components, type, defaults; of an index attribute the texts), then a line for each point:
//! `x y z w (values)`, without brackets where there are no attributes. The rest is not read.

use super::bytes::{Cursor, parse_number, show};
use super::columns::{AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::{Format, Particles};

pub(super) fn read(bytes: &[u8]) -> Result<Particles, ReadError> {
    let mut cursor = Cursor::new(bytes);
    let mut number = 1_u64;
    let first = cursor.line().unwrap_or_default();
    if first.trim_ascii() != b"PGEOMETRY V5" {
        return Err(ReadError::malformed("`PGEOMETRY V5`", show(first), Place::Line(1)));
    }
    // The counts stand on a few lines of `name number` pairs.
    let mut points = None;
    let mut attributes = None;
    while points.is_none() || attributes.is_none() {
        number += 1;
        let Some(line) = cursor.line() else {
            return Err(ReadError::truncated(
                "the counts NPoints and NPointAttrib",
                cursor.at(),
                1,
                0,
            ));
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

    let mut table = Table::default();
    table.list("position", 3, AttributeType::F32);
    // For each attribute: its name, its components and its numbers where they are wanted.
    let mut columns: Vec<(String, usize, Option<Data>)> = Vec::new();
    while (columns.len() as u64) < attributes {
        number += 1;
        let Some(line) = cursor.line() else {
            return Err(ReadError::truncated("the point attributes", cursor.at(), 1, 0));
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
        let keep = table.list(name, usize::from(size), ty) && ty != AttributeType::Text;
        columns.push((name.to_string(), usize::from(size), keep.then(|| Data::for_type(ty))));
    }

    let mut positions = Vec::new();
    let mut read = 0;
    while read < points {
        number += 1;
        let Some(line) = cursor.line() else {
            return Err(ReadError::truncated(
                "the points",
                cursor.at(),
                (points - read).saturating_mul(8),
                0,
            ));
        };
        let mut words = words(line);
        let bad = || {
            ReadError::malformed(
                "a point: x y z w and its attributes",
                show(line),
                Place::Line(number),
            )
        };
        let Some(first) = words.next() else { continue };
        if first == b"PointAttrib" {
            continue;
        }
        positions.push(parse_number(first).ok_or_else(bad)? as f32);
        for k in 0..3 {
            let value = words.next().and_then(parse_number).ok_or_else(bad)?;
            if k < 2 {
                positions.push(value as f32);
            }
        }
        for (_, size, data) in &mut columns {
            for _ in 0..*size {
                let word = words.next().ok_or_else(bad)?;
                if data.as_mut().is_some_and(|data| !data.push_text(word)) {
                    return Err(bad());
                }
            }
        }
        read += 1;
    }
    table.positions = Some(Data::F32(positions));
    for (name, size, data) in columns {
        if let Some(data) = data {
            table.push(&name, size, data);
        }
    }
    table.assemble(Format::Geo)
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|b| b.is_ascii_whitespace() || matches!(b, b'(' | b')'))
        .filter(|word| !word.is_empty())
}
