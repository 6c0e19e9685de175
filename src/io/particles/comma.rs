//! Comma-separated values: a line of names and a line for each particle.
//!
//! ParaView names components `Points:0` or `Points_0`; plain names are `x,y,z,vx,vy,vz`. Semicolons and tabs
//! separate too. Without a line of names the first three columns are the positions. An empty field is NaN.

use super::bytes::{parse_number, show};
use super::columns::{AttributeType, Data, Table, names_position};
use super::error::{Place, ReadError};
use super::{Format, Particles};

pub(super) fn read(bytes: &[u8]) -> Result<Particles, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let first =
        bytes.split(|b| *b == b'\n').find(|line| !line.trim_ascii().is_empty()).unwrap_or_default();
    let count = |d: u8| first.iter().filter(|b| **b == d).count();
    let delimiter = [b',', b';', b'\t'].into_iter().rev().max_by_key(|d| count(*d)).unwrap_or(b',');
    if count(delimiter) == 0 {
        return super::xyz::read_text(bytes);
    }
    // A line of names may be written as a comment.
    let hashed = first.starts_with(b"#")
        && first.split(|b| *b == delimiter).any(|f| names_position(&field_name(f)));
    let mut builder = csv::ReaderBuilder::new();
    builder.has_headers(false).delimiter(delimiter).trim(csv::Trim::All);
    if !hashed {
        builder.comment(Some(b'#'));
    }
    let mut reader = builder.from_reader(bytes);

    let mut table = Table::default();
    let mut columns: Vec<Option<Data>> = Vec::new();
    let mut names: Vec<String> = Vec::new();
    let mut record = csv::ByteRecord::new();
    loop {
        let more = reader.read_byte_record(&mut record).map_err(|e| {
            let line = e.position().map_or(Place::Unknown, |p| Place::Line(p.line()));
            let expected = format!("{} fields in each line", names.len());
            match e.kind() {
                csv::ErrorKind::UnequalLengths { len, .. } => {
                    ReadError::malformed(expected, format!("{len}"), line)
                }
                _ => ReadError::malformed(expected, e.to_string(), line),
            }
        })?;
        if !more {
            break;
        }
        if names.is_empty() {
            let header = record.iter().any(|f| !f.is_empty() && parse_number(f).is_none());
            for (i, field) in record.iter().enumerate() {
                let name = match (header, i) {
                    (true, _) => field_name(field),
                    (false, 0) => "x".into(),
                    (false, 1) => "y".into(),
                    (false, 2) => "z".into(),
                    (false, i) => format!("column {}", i + 1),
                };
                let keep = table.list(&name, 1, AttributeType::Number);
                columns.push(keep.then(|| Data::F64(Vec::new())));
                names.push(name);
            }
            if header {
                continue;
            }
            if names.len() > 3 {
                table.warnings.push(format!(
                    "no line of names: the first 3 of {} columns are taken as positions, the others are not read",
                    names.len()
                ));
            }
        }
        for ((field, column), name) in record.iter().zip(&mut columns).zip(&names) {
            let Some(data) = column else { continue };
            let field = if field.is_empty() { b"nan" } else { field };
            if !data.push_text(field) {
                let line = record.position().map_or(Place::Unknown, |p| Place::Line(p.line()));
                return Err(ReadError::malformed(
                    format!("a number in column `{name}`"),
                    show(field),
                    line,
                ));
            }
        }
    }
    for (name, data) in names.iter().zip(columns) {
        if let Some(data) = data {
            table.push(name, 1, data);
        }
    }
    table.assemble(Format::Csv)
}

fn field_name(field: &[u8]) -> String {
    String::from_utf8_lossy(field).trim_start_matches('#').trim().trim_matches('"').to_string()
}
