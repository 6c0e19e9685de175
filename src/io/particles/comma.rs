//! Reads comma-separated values: a line of names, and one line per particle.
//!
//! ParaView names components `Points:0` or `Points_0`, DualSPHysics `Pos.x [m]`; plain names are `x,y,z,vx,vy,vz`.
//! Semicolons and tabs are separators too; then a comma is a decimal comma. Comments and other lines may
//! precede the names, and a separator may end each line. Without a line of names the first three columns are
//! the positions. An empty field is NaN. Lines between the rows may separate frames, see `blocks`, and one line of
//! words below them is skipped.

use super::Format;
use super::asked::Asked;
use super::blocks::{self, Blocks, Label, Watched};
use super::bytes::show;
use super::columns::{AttributeType, Column};
use super::error::{Place, ReadError};
use super::heading::{self, Heading, number_with_comma};
use super::names::may_be_text;
use super::plan::About;
use super::source::{Content, inner_error};
use super::table::{RowReader, Table};
use super::tecplot;
use super::xyz;

pub(super) fn open<'a>(content: &Content<'a>, asked: &Asked) -> Result<Table<'a>, ReadError> {
    let lines = heading::lines(content)?;
    if tecplot::is(&lines) {
        return tecplot::open(content, &lines, asked);
    }
    let heading = Heading::of(&lines);
    if let Some(name) = heading::in_a_cell(&lines, &heading) {
        return Err(ReadError::Unsupported {
            what: format!("a table with a vector in each cell of column `{name}`"),
            advice: "write a column for each component: x,y,z",
        });
    }
    let first = |line: &[u8]| {
        let fields = heading::fields(line, heading.delimiter);
        super::bytes::parse_number(fields.first()?.as_bytes())
    };
    if let (Some(delimiter), true) = (heading.delimiter, heading.names.is_empty())
        && xyz::counts(&lines, heading.at, first)
    {
        let row = lines.iter().find(|line| line.start == heading.at);
        let columns = row.map_or(0, |row| heading::fields(&row.text, heading.delimiter).len());
        let names =
            std::iter::once("id".to_string()).chain((0..columns.saturating_sub(1)).map(unnamed));
        let heading = Heading { names: names.collect(), ..heading };
        let mut table = open_at(content, heading, delimiter, asked)?;
        table.about.warnings.push(xyz::counted_warning(columns));
        return Ok(table);
    }
    match heading.delimiter {
        Some(delimiter) => open_at(content, heading, delimiter, asked),
        None => xyz::open(content, asked),
    }
}

/// Reads rows with this separator.
pub(super) fn open_at<'a>(
    content: &Content<'a>,
    heading: Heading,
    delimiter: u8,
    asked: &Asked,
) -> Result<Table<'a>, ReadError> {
    let mut about = About::new(Format::Csv, asked);
    let header = !heading.names.is_empty();
    let lines = heading::lines(content)?;
    let first = lines.iter().find(|line| line.start == heading.at).filter(|_| !header);
    let first = first.map_or(0, |line| heading::fields(&line.text, Some(delimiter)).len());
    let columns = if header { heading.names.clone() } else { (0..first).map(unnamed).collect() };
    let blocks = Blocks::new(&lines, (heading.at, &heading.text), &columns, Some(delimiter));
    drop(lines);
    let rows = || blocks::Rows { blocks: blocks.clone(), at: heading.at, lines: heading.line };
    let part = rows().part(content, asked)?;
    about.time = part.time;
    about.warnings.extend(part.told);
    let source = content.open(part.from, part.to)?;
    let mut builder = csv::ReaderBuilder::new();
    builder.has_headers(false).delimiter(delimiter).trim(csv::Trim::All).buffer_capacity(1 << 16);
    builder.comment(Some(b'#')).flexible(true);
    let mut records = Records {
        reader: builder.from_reader(Watched::new(source, part.blocks, part.lines)),
        rows: rows(),
        heading: heading::fields(&heading.text, Some(delimiter)),
        lines: part.lines,
        decimal_comma: delimiter != b',',
        names: Vec::new(),
        columns: Vec::new(),
        record: csv::ByteRecord::new(),
        unread: false,
        is_number_first: false,
        numbered: None,
        told: Vec::new(),
    };
    let mut columns = Vec::new();
    let mut names = heading.names;
    if !header && records.next_record()? {
        records.unread = true;
        let fields: Vec<_> = records.record.iter().collect();
        let last = fields.iter().rposition(|field| !field.is_empty()).map_or(0, |i| i + 1);
        names.extend((0..last).map(unnamed));
        if last > 3 {
            about.warnings.push(format!(
                "no line of names: the first 3 of {last} columns are taken as positions, the others are not read"
            ));
        }
    }
    about.warnings.extend(passed_over(heading.passed));
    about.warnings.extend(heading.misfit);
    for name in names {
        let keep = about.list(&name, 1, AttributeType::Number);
        records.columns.push(keep.then_some(columns.len()));
        if keep {
            columns.push(Column::new(&name, 1, AttributeType::Number));
        }
        records.names.push(name);
    }
    Ok(Table { columns, about, rows: Box::new(records) })
}

/// Name for a column without one.
pub(super) fn unnamed(i: usize) -> String {
    match ["x", "y", "z"].get(i) {
        Some(name) => (*name).to_string(),
        None => format!("column {}", i + 1),
    }
}

/// Warning about lines above the table.
pub(super) fn passed_over(lines: u64) -> Option<String> {
    (lines > 0).then(|| format!("{lines} lines above the names and numbers are skipped"))
}

/// Warning about a line below the table.
pub(super) fn below_warning(line: &[u8]) -> String {
    format!("the last line is no row and is skipped: {}", show(line))
}

struct Records<'a> {
    reader: csv::Reader<Watched<'a>>,
    /// All rows of the file, and the line of names.
    rows: blocks::Rows,
    heading: Vec<String>,
    /// Lines before the first row.
    lines: u64,
    /// Whether decimal commas are allowed.
    decimal_comma: bool,
    names: Vec<String>,
    /// For each name, the index of the column that takes its values.
    columns: Vec<Option<usize>>,
    record: csv::ByteRecord,
    /// Whether a record was read that was not returned yet.
    unread: bool,
    /// Whether the record begins with a number.
    is_number_first: bool,
    /// Whether the first row begins with a number; `None` before it is read.
    numbered: Option<bool>,
    told: Vec<String>,
}

impl Records<'_> {
    /// Reads the next line that is not blank; false at the end.
    fn next_record(&mut self) -> Result<bool, ReadError> {
        loop {
            let read = self.read_record()?;
            let blank = self.record.len() == 1 && self.record.iter().all(<[u8]>::is_empty);
            // In a table of one column, such a line is a missing value.
            if !read || !((blank && self.names.len() != 1) || self.is_between()) {
                return Ok(read);
            }
        }
    }

    /// Whether the record is no row but the names again, or a time, between steps.
    fn is_between(&self) -> bool {
        if self.numbered == Some(false) || self.is_number_first {
            return false;
        }
        let names = self.heading.iter().map(String::as_bytes);
        let again = !self.heading.is_empty() && self.record.iter().eq(names);
        let fields: Vec<&[u8]> = self.record.iter().filter(|field| !field.is_empty()).collect();
        again || Label::alone(&fields.join(&b' ')).is_some()
    }

    /// Whether the record, if it is the last one, is a line below the table (`Total: 1234`).
    fn is_below(&self) -> bool {
        let few = || self.record.len() < self.names.len();
        let text = || self.names.first().is_some_and(|name| may_be_text(name));
        self.numbered == Some(true) && !self.is_number_first && (few() || !text())
    }

    fn read_record(&mut self) -> Result<bool, ReadError> {
        let lines = self.lines;
        let read = self.reader.read_byte_record(&mut self.record).map_err(|e| {
            let line = e.position().map_or(Place::Unknown, |p| Place::Line(lines + p.line()));
            let expected = format!("{} fields in each line", self.names.len());
            let text = e.to_string();
            match e.into_kind() {
                csv::ErrorKind::Io(reason) => inner_error(reason),
                _ => ReadError::table(expected, text, line),
            }
        })?;
        let first = String::from_utf8_lossy(self.record.iter().next().unwrap_or_default());
        self.is_number_first = heading::is_number(&first, self.decimal_comma.then_some(b';'));
        Ok(read)
    }

    /// The error for a line that is no row of values; if the line begins a second table, an error that says so.
    fn no_row(&self, expected: String, found: String) -> ReadError {
        if self.numbered == Some(true) && !self.is_number_first {
            return ReadError::Unsupported {
                what: format!("a table of several parts (another one begins{})", self.place()),
                advice: "write one file per frame, with the frame's number in its name",
            };
        }
        ReadError::table(expected, found, self.place())
    }

    fn place(&self) -> Place {
        self.record.position().map_or(Place::Unknown, |p| Place::Line(self.lines + p.line()))
    }
}

impl RowReader for Records<'_> {
    fn next(&mut self, columns: &mut [Column]) -> Result<bool, ReadError> {
        if !std::mem::take(&mut self.unread) && !self.next_record()? {
            self.told.extend(self.reader.get_mut().blocks.told()?);
            return Ok(false);
        }
        if self.is_below() {
            let fields: Vec<&[u8]> = self.record.iter().filter(|field| !field.is_empty()).collect();
            let told = below_warning(&fields.join(&b' '));
            let found = self.record.len().to_string();
            let error = self.no_row(format!("{} fields in each line", self.names.len()), found);
            if self.next_record()? {
                return Err(error);
            }
            self.told.push(told);
            self.told.extend(self.reader.get_mut().blocks.told()?);
            return Ok(false);
        }
        self.row(columns).map_err(|error| match self.next_record() {
            Ok(false) => error.in_last_row(),
            _ => error,
        })?;
        Ok(true)
    }

    fn told(&mut self) -> Vec<String> {
        std::mem::take(&mut self.told)
    }

    fn blocks(&self) -> Option<blocks::Rows> {
        Some(self.rows.clone())
    }
}

impl Records<'_> {
    /// Appends the values of the record.
    fn row(&mut self, columns: &mut [Column]) -> Result<(), ReadError> {
        // A separator may end the line.
        let more = self.record.iter().skip(self.names.len());
        if self.record.len() < self.names.len() || more.into_iter().any(|f| !f.is_empty()) {
            return Err(self.no_row(
                format!("{} fields in each line", self.names.len()),
                format!("{}", self.record.len()),
            ));
        }
        for ((field, column), name) in self.record.iter().zip(&self.columns).zip(&self.names) {
            let Some(column) = column.and_then(|i| columns.get_mut(i)) else { continue };
            let field = if field.is_empty() { b"nan" } else { field };
            if column.data.push_text(field) {
                continue;
            }
            let number = number_with_comma(field).filter(|_| self.decimal_comma);
            let number = number.or_else(|| may_be_text(name).then_some(f64::NAN));
            if !number.is_some_and(|number| column.data.push_number(number)) {
                return Err(self.no_row(format!("a number in column `{name}`"), show(field)));
            }
        }
        if self.numbered.is_none() {
            self.numbered = Some(self.is_number_first);
        }
        Ok(())
    }
}
