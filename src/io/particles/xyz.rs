//! XYZ: a line of numbers for each particle, or raw little-endian `f32` triples without any header.
//!
//! Of a line the first three numbers are the position; spaces, tabs, commas and semicolons separate. Empty lines
//! and lines that begin with `#`, `%` or `//` are passed over. A first line of one number is the count, and the
//! line after it may be a comment. A first line of names (`x y z vx vy vz`) names the columns.

use super::bytes::{Cursor, parse_number, show};
use super::columns::{AttributeType, Data, Table, names_position};
use super::error::{Place, ReadError};
use super::{Format, Particles};

pub(super) fn read_raw(bytes: &[u8]) -> Result<Particles, ReadError> {
    if !bytes.len().is_multiple_of(12) {
        return Err(ReadError::malformed(
            "text, or raw f32 triples of 12 bytes each",
            format!("{} bytes, {} too many", bytes.len(), bytes.len() % 12),
            Place::Byte((bytes.len() - bytes.len() % 12) as u64),
        ));
    }
    let mut table = Table::default();
    table.list("position", 3, AttributeType::F32);
    let mut data = Data::F32(Vec::new());
    data.push_bytes(AttributeType::F32, bytes, false);
    table.positions = Some(data);
    table.assemble(Format::RawF32)
}

pub(super) fn read_text(bytes: &[u8]) -> Result<Particles, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut cursor = Cursor::new(bytes);
    let mut table = Table::default();
    let mut names: Vec<String> = Vec::new();
    let mut columns: Vec<Option<Data>> = Vec::new();
    let mut promised = None;
    let mut rows = 0_u64;
    let mut number = 0_u64;
    while let Some(line) = cursor.line() {
        number += 1;
        let line = line.trim_ascii();
        if line.is_empty() || [&b"#"[..], b"%", b"//"].iter().any(|c| line.starts_with(c)) {
            continue;
        }
        if names.is_empty() {
            let words: Vec<_> = words(line).collect();
            let numeric = words.iter().all(|w| parse_number(w).is_some());
            if promised.is_none() && words.len() == 1 && numeric {
                let count = std::str::from_utf8(line).ok().and_then(|w| w.parse::<u64>().ok());
                promised = Some(count.ok_or_else(|| {
                    ReadError::malformed(
                        "three numbers, or the number of particles",
                        show(line),
                        Place::Line(number),
                    )
                })?);
                continue;
            }
            let header: Vec<String> = words
                .iter()
                .map(|w| String::from_utf8_lossy(w).trim_matches('"').to_string())
                .collect();
            let named = !numeric && header.iter().any(|n| names_position(n));
            if !named && promised.is_some() && (!numeric || words.len() < 3) {
                if number > 2 {
                    return Err(bad_line(line, number));
                }
                continue; // the comment after the count
            }
            names = if named {
                header
            } else {
                let mut names: Vec<_> = ["x", "y", "z"].map(String::from).into();
                if words.len() > 3 {
                    table.warnings.push(format!(
                        "no line of names: the first 3 of {} columns are taken as positions, the others are not read",
                        words.len()
                    ));
                    names.extend((4..=words.len()).map(|i| format!("column {i}")));
                }
                names
            };
            for name in &names {
                let keep = table.list(name, 1, AttributeType::Number);
                columns.push(keep.then(|| Data::F64(Vec::new())));
            }
            if named {
                continue;
            }
        }
        let mut words = words(line);
        for column in &mut columns {
            let word = words.next().ok_or_else(|| bad_line(line, number))?;
            if column.as_mut().is_some_and(|data| !data.push_text(word)) {
                return Err(bad_line(line, number));
            }
        }
        rows += 1;
    }
    if let Some(promised) = promised.filter(|n| *n != rows) {
        return Err(ReadError::Length {
            attribute: "position".into(),
            expected: promised,
            found: rows,
        });
    }
    if names.is_empty() {
        table.positions = Some(Data::F64(Vec::new()));
        if promised.is_none() {
            return Err(ReadError::malformed("lines of three numbers", "none", Place::Unknown));
        }
    }
    for (name, data) in names.iter().zip(columns) {
        if let Some(data) = data {
            table.push(name, 1, data);
        }
    }
    table.assemble(Format::Xyz)
}

fn bad_line(line: &[u8], number: u64) -> ReadError {
    ReadError::malformed(
        "as many numbers as in the lines before, three at least",
        show(line),
        Place::Line(number),
    )
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|b| b.is_ascii_whitespace() || matches!(b, b',' | b';'))
        .filter(|word| !word.is_empty())
}
