//! Comma-separated values: a line of names and a line for each particle.
//!
//! ParaView names components `Points:0` or `Points_0`; plain names are `x,y,z,vx,vy,vz`. Semicolons and tabs
//! separate too. Without a line of names the first three columns are the positions. An empty field is NaN.

use super::Format;
use super::bytes::{parse_number, show};
use super::columns::{self, AttributeType, Column, names_position};
use super::error::{Place, ReadError};
use super::plan::About;
use super::source::{Content, Source, inner_error};
use super::table::{RowReader, Table};
use super::text::Text;

pub(super) fn open<'a>(content: &Content<'a>) -> Result<Table<'a>, ReadError> {
    let mut text = Text::of(content)?;
    let start = text.at();
    let mut first = Vec::new();
    while let Some(line) = text.line()? {
        if !line.trim_ascii().is_empty() {
            first = line.to_vec();
            break;
        }
    }
    let count = |d: u8| first.iter().filter(|b| **b == d).count();
    let delimiter = [b',', b';', b'\t'].into_iter().rev().max_by_key(|d| count(*d)).unwrap_or(b',');
    if count(delimiter) == 0 {
        return super::xyz::open(content);
    }
    // A line of names may be written as a comment.
    let hashed = first.starts_with(b"#")
        && first.split(|b| *b == delimiter).any(|f| names_position(&field_name(f)));
    let mut builder = csv::ReaderBuilder::new();
    builder.has_headers(false).delimiter(delimiter).trim(csv::Trim::All).buffer_capacity(1 << 16);
    if !hashed {
        builder.comment(Some(b'#'));
    }
    let mut records = Records {
        reader: builder.from_reader(content.open(start, content.length())?),
        names: Vec::new(),
        columns: Vec::new(),
        record: csv::ByteRecord::new(),
        unread: false,
    };
    let mut about =
        About { placed: None, attributes: Vec::new(), warnings: Vec::new(), format: Format::Csv };
    let mut columns = Vec::new();
    if records.next_record()? {
        let header = records.record.iter().any(|f| !f.is_empty() && parse_number(f).is_none());
        for (i, field) in records.record.iter().enumerate() {
            let name = match (header, i) {
                (true, _) => field_name(field),
                (false, 0) => "x".into(),
                (false, 1) => "y".into(),
                (false, 2) => "z".into(),
                (false, i) => format!("column {}", i + 1),
            };
            let keep = columns::list(&mut about.attributes, &name, 1, AttributeType::Number);
            records.columns.push(keep.then_some(columns.len()));
            if keep {
                columns.push(Column::new(&name, 1, AttributeType::Number));
            }
            records.names.push(name);
        }
        records.unread = !header;
        if !header && records.names.len() > 3 {
            about.warnings.push(format!(
                "no line of names: the first 3 of {} columns are taken as positions, the others are not read",
                records.names.len()
            ));
        }
    }
    Ok(Table { columns, about, rows: Box::new(records) })
}

struct Records<'a> {
    reader: csv::Reader<Source<'a>>,
    names: Vec<String>,
    /// For each name the column that takes its numbers.
    columns: Vec<Option<usize>>,
    record: csv::ByteRecord,
    /// Whether the record is there and was not given yet.
    unread: bool,
}

impl Records<'_> {
    fn next_record(&mut self) -> Result<bool, ReadError> {
        self.reader.read_byte_record(&mut self.record).map_err(|e| {
            let line = e.position().map_or(Place::Unknown, |p| Place::Line(p.line()));
            let expected = format!("{} fields in each line", self.names.len());
            let text = e.to_string();
            match e.into_kind() {
                csv::ErrorKind::UnequalLengths { len, .. } => {
                    ReadError::malformed(expected, format!("{len}"), line)
                }
                csv::ErrorKind::Io(reason) => inner_error(reason),
                _ => ReadError::malformed(expected, text, line),
            }
        })
    }
}

impl RowReader for Records<'_> {
    fn next(&mut self, columns: &mut [Column]) -> Result<bool, ReadError> {
        if !std::mem::take(&mut self.unread) && !self.next_record()? {
            return Ok(false);
        }
        for ((field, column), name) in self.record.iter().zip(&self.columns).zip(&self.names) {
            let Some(column) = column.and_then(|i| columns.get_mut(i)) else { continue };
            let field = if field.is_empty() { b"nan" } else { field };
            if !column.data.push_text(field) {
                let line = self.record.position().map_or(Place::Unknown, |p| Place::Line(p.line()));
                return Err(ReadError::malformed(
                    format!("a number in column `{name}`"),
                    show(field),
                    line,
                ));
            }
        }
        Ok(true)
    }
}

fn field_name(field: &[u8]) -> String {
    String::from_utf8_lossy(field).trim_start_matches('#').trim().trim_matches('"').to_string()
}
