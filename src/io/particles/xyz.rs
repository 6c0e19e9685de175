//! XYZ: a line of numbers for each particle, or raw little-endian `f32` triples without any header.
//!
//! Of a line the first three numbers are the position; spaces, tabs, commas and semicolons separate. Empty lines
//! and lines that begin with `#`, `%` or `//` are passed over. A first line of one number is the count, and the
//! line after it may be a comment. A first line of names (`x y z vx vy vz`) names the columns.

use super::Format;
use super::bytes::{parse_number, show};
use super::columns::{self, AttributeType, Column, PLACED, names_position};
use super::error::{Place, ReadError};
use super::plan::About;
use super::rows::{Field, Layout, Rows};
use super::source::Content;
use super::table::{RowReader, Table};
use super::text::Text;

/// So many bytes of raw triples.
pub(super) fn raw(length: u64) -> Result<Layout, ReadError> {
    if !length.is_multiple_of(12) {
        return Err(ReadError::malformed(
            "text, or raw f32 triples of 12 bytes each",
            format!("{length} bytes, {} too many", length % 12),
            Place::Byte(length - length % 12),
        ));
    }
    let mut attributes = Vec::new();
    columns::list(&mut attributes, "position", 3, AttributeType::F32);
    Ok(Layout {
        rows: Rows {
            what: "the points".into(),
            header: 0,
            between: Vec::new(),
            count: length / 12,
            stride: 12,
            big_endian: false,
            fields: vec![Field::new(PLACED, 3, AttributeType::F32, 0)?],
        },
        placed: true,
        attributes,
        format: Format::RawF32,
    })
}

pub(super) fn open<'a>(content: &Content<'a>) -> Result<Table<'a>, ReadError> {
    let mut about =
        About { placed: None, attributes: Vec::new(), warnings: Vec::new(), format: Format::Xyz };
    let mut lines = Lines {
        text: Text::of(content)?,
        number: 0,
        rows: 0,
        promised: None,
        columns: Vec::new(),
        unread: None,
    };
    let names = lines.names(&mut about)?;
    if names.is_empty() {
        lines.end()?;
        if lines.promised.is_none() {
            return Err(ReadError::malformed("lines of three numbers", "none", Place::Unknown));
        }
        about.placed = Some(0);
        let columns = vec![Column::new(PLACED, 3, AttributeType::Number)];
        return Ok(Table { columns, about, rows: Box::new(lines) });
    }
    let mut columns = Vec::new();
    for name in &names {
        let keep = columns::list(&mut about.attributes, name, 1, AttributeType::Number);
        lines.columns.push(keep.then_some(columns.len()));
        if keep {
            columns.push(Column::new(name, 1, AttributeType::Number));
        }
    }
    Ok(Table { columns, about, rows: Box::new(lines) })
}

struct Lines<'a> {
    text: Text<'a>,
    /// Of the line that was read last.
    number: u64,
    /// Particles until now.
    rows: u64,
    promised: Option<u64>,
    /// For each word of a line the column that takes it.
    columns: Vec<Option<usize>>,
    /// The first particle, where no names stand before it.
    unread: Option<Vec<u8>>,
}

impl Lines<'_> {
    /// Names of the columns, from the first line that tells them; none where there is no such line.
    fn names(&mut self, about: &mut About) -> Result<Vec<String>, ReadError> {
        while let Some(line) = self.text.line()? {
            self.number += 1;
            let line = line.trim_ascii();
            if is_comment(line) {
                continue;
            }
            let words: Vec<_> = words(line).collect();
            let numeric = words.iter().all(|w| parse_number(w).is_some());
            if self.promised.is_none() && words.len() == 1 && numeric {
                let count = std::str::from_utf8(line).ok().and_then(|w| w.parse::<u64>().ok());
                self.promised = Some(count.ok_or_else(|| {
                    ReadError::malformed(
                        "three numbers, or the number of particles",
                        show(line),
                        Place::Line(self.number),
                    )
                })?);
                continue;
            }
            let header: Vec<String> = words
                .iter()
                .map(|w| String::from_utf8_lossy(w).trim_matches('"').to_string())
                .collect();
            if !numeric && header.iter().any(|n| names_position(n)) {
                return Ok(header);
            }
            if self.promised.is_some() && (!numeric || words.len() < 3) {
                if self.number > 2 {
                    return Err(bad_line(line, self.number));
                }
                continue; // the comment after the count
            }
            let mut names: Vec<_> = ["x", "y", "z"].map(String::from).into();
            if words.len() > 3 {
                about.warnings.push(format!(
                    "no line of names: the first 3 of {} columns are taken as positions, the others are not read",
                    words.len()
                ));
                names.extend((4..=words.len()).map(|i| format!("column {i}")));
            }
            self.unread = Some(line.to_vec());
            return Ok(names);
        }
        Ok(Vec::new())
    }

    /// After the last line.
    fn end(&self) -> Result<(), ReadError> {
        match self.promised {
            Some(expected) if expected != self.rows => {
                let attribute = "position".into();
                Err(ReadError::Length { attribute, expected, found: self.rows })
            }
            _ => Ok(()),
        }
    }
}

impl RowReader for Lines<'_> {
    fn next(&mut self, columns: &mut [Column]) -> Result<bool, ReadError> {
        if let Some(line) = self.unread.take() {
            row(&line, self.number, &self.columns, columns)?;
            self.rows += 1;
            return Ok(true);
        }
        while let Some(line) = self.text.line()? {
            self.number += 1;
            let line = line.trim_ascii();
            if !is_comment(line) {
                row(line, self.number, &self.columns, columns)?;
                self.rows += 1;
                return Ok(true);
            }
        }
        self.end()?;
        Ok(false)
    }
}

/// Appends the numbers of a line; `taken`: for each word the column that takes it.
fn row(
    line: &[u8],
    number: u64,
    taken: &[Option<usize>],
    columns: &mut [Column],
) -> Result<(), ReadError> {
    let mut words = words(line);
    for column in taken {
        let word = words.next().ok_or_else(|| bad_line(line, number))?;
        let column = column.and_then(|i| columns.get_mut(i));
        if column.is_some_and(|column| !column.data.push_text(word)) {
            return Err(bad_line(line, number));
        }
    }
    Ok(())
}

/// Whether a line, without the space around it, is passed over.
fn is_comment(line: &[u8]) -> bool {
    line.is_empty() || [&b"#"[..], b"%", b"//"].iter().any(|c| line.starts_with(c))
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
