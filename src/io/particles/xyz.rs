//! Reads XYZ: one line of numbers per particle, or raw little-endian `f32` triples without a header.
//!
//! The first three numbers of a line are the position; spaces, tabs, commas and semicolons separate the
//! numbers. Empty lines, and lines that begin with `#`, `%` or `//`, are skipped, unless they separate frames, see
//! `blocks`. One line of words below the rows is skipped. A line of names (`x y z vx vy
//! vz`) before the numbers, with `#` or without, names the columns.
//!
//! A first line with a single number is the count, as in chemistry. The next line is then a comment, which
//! may name the columns (`Properties=species:S:1:pos:R:3`, extended XYZ). Without names, the first column is
//! taken as the element and not as a position if it holds words or, in a file with a count and four or more
//! columns, integers from 1 on.

use super::Format;
use super::asked::Asked;
use super::blocks::{self, Blocks};
use super::bytes::{parse_number, show};
use super::columns::{AttributeType, Column, PLACED};
use super::comma::{self, passed_over, unnamed};
use super::error::{Place, ReadError};
use super::heading::{self, Heading, Line, is_comment, number_with_comma};
use super::names;
use super::plan::About;
use super::rows::{Field, Layout, Rows};
use super::source::Content;
use super::steps::{self, Start};
use super::table::{RowReader, Table};
use super::tecplot;
use super::text::Text;

/// The layout of raw triples in a file of this length.
pub(super) fn raw(length: u64, asked: &Asked) -> Result<Layout, ReadError> {
    if !length.is_multiple_of(12) {
        return Err(ReadError::malformed(
            "text, or raw f32 triples of 12 bytes each",
            format!("{length} bytes, {} too many", length % 12),
            Place::Byte(length - length % 12),
        ));
    }
    let mut attributes = Vec::new();
    asked.list(&mut attributes, "position", 3, AttributeType::F32);
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
        warnings: Vec::new(),
        format: Format::RawF32,
        asked: asked.clone(),
    })
}

/// Positions at which the frames of an XYZ file with particle counts begin, up to the one after frame `upto`; empty
/// for any other file.
pub(super) fn starts(content: &Content<'_>, upto: Option<usize>) -> Result<Vec<Start>, ReadError> {
    let lines = heading::lines(content)?;
    let Some(Counted { heading, .. }) = Counted::of(&lines) else { return Ok(Vec::new()) };
    let first = lines.iter().position(|line| !is_comment(&line.text)).unwrap_or(0);
    let commented = heading.line > first as u64 + 1;
    let (mut starts, mut text, mut number) = (Vec::new(), Text::of(content)?, 0_u64);
    while upto.is_none_or(|upto| starts.len() <= upto + 1) {
        let (at, lines) = (text.at(), number);
        let Some(line) = text.line()? else { break };
        number += 1;
        if is_comment(line) {
            continue;
        }
        let count = std::str::from_utf8(line.trim_ascii()).ok().and_then(|line| line.parse().ok());
        let Some(count) = count else { break };
        let mut time = None;
        if commented {
            time = text.line()?.and_then(time_in);
            number += 1;
        }
        starts.push(Start { at, lines, time });
        let mut left: u64 = count;
        while left > 0 {
            let Some(line) = text.line()? else { return Ok(starts) };
            number += 1;
            left -= u64::from(!is_comment(line));
        }
    }
    Ok(starts)
}

/// The time in a comment: `Time=0.1`. What is in quotes does not count: `pbc="T T T"`.
pub(super) fn time_in(comment: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(comment).ok()?;
    let quotes = text.matches('"').count().is_multiple_of(2);
    let (mut inside, mut before) = (false, ' ');
    for (at, c) in text.char_indices() {
        inside ^= quotes && c == '"';
        let begins = before.is_whitespace() || matches!(before, ',' | ';' | '=' | ':' | '"');
        before = c;
        if inside || !begins {
            continue;
        }
        if let Some(time) = text.get(at..).and_then(time_at) {
            return Some(time);
        }
    }
    None
}

/// The time that begins a text: `time=0.1`, `T: 0.1` or `time 0.1`, but not `T 0.1`: a flag may be called so.
fn time_at(text: &str) -> Option<f64> {
    let behind = |word: &str| {
        let (start, rest) = text.split_at_checked(word.len())?;
        start.eq_ignore_ascii_case(word).then_some(rest)
    };
    let long = behind("time");
    let rest = long.or_else(|| behind("t"))?;
    let value = rest.trim_start();
    let spaced = long.is_some() && value.len() < rest.len();
    let value = match value.strip_prefix(['=', ':']) {
        Some(value) => value.trim_start(),
        None if spaced => value,
        None => return None,
    };
    let value = value.strip_prefix('"').unwrap_or(value);
    let ends = |c: char| c.is_whitespace() || matches!(c, ',' | ';' | '=' | ':' | '"');
    let value = value.split(ends).next()?;
    value.parse().ok().filter(|time: &f64| time.is_finite())
}

pub(super) fn open<'a>(content: &Content<'a>, asked: &Asked) -> Result<Table<'a>, ReadError> {
    let lines = heading::lines(content)?;
    if tecplot::is(&lines) {
        return tecplot::open(content, &lines, asked);
    }
    let counted = Counted::of(&lines).is_some();
    drop(lines);
    if counted && let Some((content, time)) = steps::asked_part(content, asked, starts)? {
        let mut table = open_one(&content, &asked.clone().of_step(None))?;
        table.about.time = table.about.time.or(time);
        return Ok(table);
    }
    open_one(content, asked)
}

fn open_one<'a>(content: &Content<'a>, asked: &Asked) -> Result<Table<'a>, ReadError> {
    let mut about = About::new(Format::Xyz, asked);
    let lines = heading::lines(content)?;
    let counted = Counted::of(&lines);
    let (heading, promised) = match counted {
        Some(Counted { heading, count, time }) => {
            about.time = time;
            (heading, Some(count))
        }
        None => (Heading::of(&lines), None),
    };
    let named = !heading.names.is_empty();
    if let (Some(delimiter), true, None) = (heading.delimiter, named, promised) {
        return comma::open_at(content, heading, delimiter, asked);
    }
    about.warnings.extend(passed_over(heading.passed));
    about.warnings.extend(heading.misfit);
    let first = lines.iter().find(|line| line.start >= heading.at && !is_comment(&line.text));
    let mut names = heading.names;
    let commas = heading.delimiter == Some(b',');
    match first {
        None if promised.is_none() && !named => {
            return Err(ReadError::table("lines of three numbers", "none", Place::Unknown));
        }
        Some(line) if !named => {
            let row: Vec<_> = values(&line.text, commas).collect();
            let element = element(&lines, heading.at, commas, promised.is_some());
            let from = usize::from(element.is_some());
            if row.len() < from + 2 {
                return Err(bad_line(&line.text, content.lines_before() + heading.line + 1));
            }
            let counts = promised.is_none()
                && counts(&lines, heading.at, |line| words(line, commas).next().and_then(number));
            let from = if counts { 1 } else { from };
            let first = if counts { "id" } else { "element" };
            names.extend((0..from).map(|_| first.to_string()));
            names.extend((from..row.len()).map(|i| unnamed(i - from)));
            about.warnings.extend(match counts {
                true => Some(counted_warning(row.len())),
                false => unnamed_warning(element, row.len()),
            });
        }
        _ => {}
    }
    if names.is_empty() {
        names.extend((0..3).map(unnamed));
    }
    if promised.is_some() {
        let text = Text::new(content.open(heading.at, content.length())?);
        let number = content.lines_before() + heading.line;
        return Ok(rows(text, number, promised, commas, (&names, None), about, None));
    }
    let (at, head) = (heading.at, &heading.text);
    let blocks = Blocks::new(&lines, (at, head), &names, commas.then_some(b','));
    let all = blocks::Rows { blocks, at, lines: heading.line };
    let part = all.clone().part(content, asked)?;
    about.time = part.time;
    about.warnings.extend(part.told);
    let text = Text::new(content.open(part.from, part.to)?);
    let blocks = Some((part.blocks, all));
    Ok(rows(text, part.lines, None, commas, (&names, None), about, blocks))
}

/// The box whose edges scale positions.
#[derive(Clone, Copy)]
pub(super) struct Basis {
    /// Which axes are scaled.
    pub(super) scaled: [bool; 3],
    pub(super) origin: [f64; 3],
    pub(super) edges: [[f64; 3]; 3],
}

impl Basis {
    /// Replaces the last value of each scaled axis' column by the position.
    fn apply(&self, axes: &[Option<usize>; 3], columns: &mut [Column]) {
        let last = |axis: &Option<usize>| {
            let data = &columns.get((*axis)?)?.data;
            data.f64(data.len().checked_sub(1)?)
        };
        let [a, b, c] = axes.each_ref().map(last);
        let values = [a, b, c].into_iter().zip(self.scaled);
        let values: Vec<f64> =
            values.map(|(value, scaled)| value.filter(|_| scaled).unwrap_or(0.0)).collect();
        for (k, (axis, origin)) in axes.iter().zip(self.origin).enumerate() {
            let edges = values.iter().zip(&self.edges);
            let position: f64 =
                edges.map(|(value, edge)| value * edge.get(k).copied().unwrap_or(0.0)).sum();
            let column = axis.filter(|_| self.scaled.get(k) == Some(&true));
            if let Some(column) = column.and_then(|i| columns.get_mut(i)) {
                column.data.set_last(origin + position);
            }
        }
    }
}

/// Reads rows with these column names, after this number of lines.
pub(super) fn rows<'a>(
    text: Text<'a>,
    number: u64,
    promised: Option<u64>,
    commas: bool,
    (names, basis): (&[String], Option<Basis>),
    mut about: About,
    blocks: Option<(Blocks, blocks::Rows)>,
) -> Table<'a> {
    let mut rows = Lines {
        text,
        number,
        rows: 0,
        promised,
        dump: about.format == Format::Lammps,
        commas,
        columns: Vec::new(),
        basis: basis.map(|basis| (basis, [None; 3])),
        zones: None,
        blocks,
        numbered: None,
        told: Vec::new(),
    };
    let mut columns = Vec::new();
    for name in names {
        let (name, ty) = match name.strip_suffix(TEXT) {
            Some(name) => (name, AttributeType::Text),
            None => (name.as_str(), AttributeType::Number),
        };
        let keep = about.list(name, 1, ty) && ty == AttributeType::Number;
        rows.columns.push(keep.then_some(columns.len()));
        if keep {
            let axis = ["x", "y", "z"].iter().position(|axis| *axis == name);
            if let (Some((_, axes)), Some(axis)) = (&mut rows.basis, axis)
                && let Some(free @ None) = axes.get_mut(axis)
            {
                *free = Some(columns.len());
            }
            columns.push(Column::new(name, 1, AttributeType::Number));
        }
    }
    Table { columns, about, rows: Box::new(rows) }
}

/// Reads the rows of a Tecplot file, whose zones are parts of the table. `zone` is `Some` if there are several zones;
/// it then holds the name of the column for the zone's number, if that column is used.
pub(super) fn rows_of_zones<'a>(
    text: Text<'a>,
    number: u64,
    commas: bool,
    names: &[String],
    zone: Option<Option<&str>>,
    mut about: About,
) -> Table<'a> {
    let mut columns = Vec::new();
    let keep = |name: &String| {
        let keep = about.list(name, 1, AttributeType::Number);
        let at = columns.len();
        columns.extend(keep.then(|| Column::new(name, 1, AttributeType::Number)));
        keep.then_some(at)
    };
    let taken: Vec<Option<usize>> = names.iter().map(keep).collect();
    let zone = zone.flatten().map(|name| {
        columns.push(Column::new(name, 1, AttributeType::Number));
        columns.len() - 1
    });
    let zones = Some(tecplot::Zones::new(zone));
    let rows = Lines {
        text,
        number,
        rows: 0,
        promised: None,
        dump: false,
        commas,
        columns: taken,
        basis: None,
        zones,
        blocks: None,
        numbered: None,
        told: Vec::new(),
    };
    Table { columns, about, rows: Box::new(rows) }
}

/// What the first column holds if it is the element.
#[derive(Clone, Copy, PartialEq)]
enum Element {
    Words,
    Integers,
}

/// A warning that columns without names are not read, or that the first column may be no element.
fn unnamed_warning(element: Option<Element>, columns: usize) -> Option<String> {
    let more = columns > 3 + usize::from(element.is_some());
    let rest = if more { ", the others are not read" } else { "" };
    match element {
        None if more => Some(format!(
            "no line of names: the first 3 of {columns} columns are taken as positions, the others are not read"
        )),
        Some(Element::Words) if more => Some(format!(
            "no line of names: the first of {columns} columns is taken as the element, the 3 behind it as \
             positions{rest}"
        )),
        // Nothing but the values tells such a column from a coordinate.
        Some(Element::Integers) => Some(format!(
            "no line of names: the first of {columns} columns, whole numbers, is taken as the element, the 3 behind it \
             as positions{rest}; if it is x, name all columns in the line below the count: x y z density"
        )),
        _ => None,
    }
}

/// Min number of lines for which the first column may be taken as a particle number.
const COUNTED: usize = 8;

/// Whether the first column numbers the lines consecutively, beginning with 0 or 1, and at least three more columns
/// follow.
pub(super) fn counts(lines: &[Line], at: u64, first: impl Fn(&[u8]) -> Option<f64>) -> bool {
    let rows = lines.iter().filter(|line| line.start >= at && !is_comment(&line.text));
    let rows: Vec<&Line> = rows.collect();
    let start = rows.first().and_then(|row| first(&row.text));
    let columns = rows
        .first()
        .map_or(0, |row| heading::fields(&row.text, heading::delimiter(&row.text)).len());
    let counted =
        |(i, row): (usize, &&Line)| first(&row.text) == start.map(|start| start + i as f64);
    rows.len() >= COUNTED
        && columns > 3
        && start.is_some_and(|start| start == 0.0 || start == 1.0)
        && rows.iter().enumerate().all(counted)
}

/// Warning about such a column.
pub(super) fn counted_warning(columns: usize) -> String {
    let rest = if columns > 4 { ", the others are not read" } else { "" };
    format!(
        "no line of names: the first of {columns} columns counts the particles and is taken as the id, the 3 behind it as \
         positions{rest}"
    )
}

/// The element in the column before the position, if there is one: the first column holds words or, in a file with a
/// particle count, integers from 1 on.
fn element(lines: &[Line], at: u64, commas: bool, counted: bool) -> Option<Element> {
    let rows = lines.iter().filter(|line| line.start >= at && !is_comment(&line.text));
    let rows: Vec<Vec<_>> = rows.map(|line| words(&line.text, commas).collect()).collect();
    let numbers = |row: &Vec<&[u8]>| row.iter().filter(|w| number(w).is_some()).count();
    let first = |test: &dyn Fn(&[u8]) -> bool| {
        // The lines may include some of the next frame.
        rows.first().and_then(|row| row.first()).is_some_and(|word| test(word))
    };
    let of_word = first(&|word| number(word).is_none());
    // No element has the number 0.
    let whole =
        |word: &[u8]| word.iter().all(u8::is_ascii_digit) && word.iter().any(|b| *b != b'0');
    let same = rows.first().map_or(0, Vec::len);
    let of_number = counted
        && same > 3
        && rows
            .iter()
            .filter(|row| row.len() == same)
            .all(|row| row.first().is_some_and(|w| whole(w)));
    let enough = rows.first().is_some_and(|row| numbers(row) >= 3);
    match (of_word, of_number) {
        _ if !enough => None,
        (true, _) => Some(Element::Words),
        (false, true) => Some(Element::Integers),
        (false, false) => None,
    }
}

/// The beginning of a file with a count.
struct Counted {
    heading: Heading,
    count: u64,
    /// The time in the comment.
    time: Option<f64>,
}

impl Counted {
    /// `None` if the first line is no count.
    fn of(lines: &[Line]) -> Option<Self> {
        let at = lines.iter().position(|line| !is_comment(&line.text))?;
        let first = lines.get(at)?;
        let text = std::str::from_utf8(first.text.trim_ascii()).ok()?;
        let count = text.parse().ok()?;
        let mut heading = Heading {
            delimiter: None,
            names: Vec::new(),
            at: first.next,
            line: at as u64 + 1,
            passed: 0,
            text: Vec::new(),
            misfit: None,
        };
        let time = None;
        let Some(comment) = lines.get(at + 1) else { return Some(Self { heading, count, time }) };
        let row = lines.iter().skip(at + 2).find(|line| !is_comment(&line.text));
        heading.delimiter = heading::delimiter(row.map_or(&comment.text, |row| &row.text));
        let commas = heading.delimiter == Some(b',');
        let fields = |line: &Line| words(&line.text, commas).count();
        let numbers = words(&comment.text, commas).filter(|w| number(w).is_some()).count();
        let alike = row.is_none_or(|row| fields(row) == fields(comment));
        if numbers >= 2 && numbers == fields(comment) && alike {
            // This line is not a comment but the first particle.
            return Some(Self { heading, count, time });
        }
        heading.at = comment.next;
        heading.line += 1;
        heading.names = properties(&comment.text).unwrap_or_else(|| {
            let names = heading::fields(&comment.text, None);
            let same = row.is_some_and(|row| fields(row) == names.len());
            if same && names::have_positions(&names) { names } else { Vec::new() }
        });
        Some(Self { heading, count, time: time_in(&comment.text) })
    }
}

/// Marks the name of a column that is not numeric.
const TEXT: &str = "\0";

/// Names of the columns from the comment of extended XYZ, one per component.
fn properties(comment: &[u8]) -> Option<Vec<String>> {
    let text = std::str::from_utf8(comment).ok()?;
    let start = text.to_ascii_lowercase().find("properties=")? + "properties=".len();
    let value = text.get(start..)?.trim_start_matches(['"', '\'']);
    let value = value.split(|c: char| c.is_whitespace() || c == '"' || c == '\'').next()?;
    let words: Vec<_> = value.split(':').collect();
    let mut names = Vec::new();
    for property in words.chunks(3) {
        let [name, kind, count] = property else { return None };
        let count: usize = count.parse().ok().filter(|count| (1..=64).contains(count))?;
        let numbers = matches!(*kind, "R" | "I");
        for i in 0..count {
            names.push(match (numbers, count) {
                (false, _) => format!("{name}{TEXT}"),
                (true, 1) => (*name).to_string(),
                (true, _) => format!("{name}:{i}"),
            });
        }
    }
    Some(names).filter(|names| names::have_positions(names))
}

struct Lines<'a> {
    text: Text<'a>,
    /// Number of the line that was read last.
    number: u64,
    /// Number of particles so far.
    rows: u64,
    promised: Option<u64>,
    /// Whether the file is a dump of LAMMPS.
    dump: bool,
    /// Whether commas separate fields.
    commas: bool,
    /// For each word of a line of text, the index of the column that stores it; `None`: it is skipped.
    columns: Vec<Option<usize>>,
    /// The box that scales positions, and the columns of the axes.
    basis: Option<(Basis, [Option<usize>; 3])>,
    /// The Tecplot zones of the rows.
    zones: Option<tecplot::Zones>,
    /// What may separate steps of a table without a count, and all rows of the file.
    blocks: Option<(Blocks, blocks::Rows)>,
    /// Whether the first row begins with a number; `None` before it is read.
    numbered: Option<bool>,
    told: Vec<String>,
}

impl Lines<'_> {
    /// Called after the last line.
    fn end(&mut self) -> Result<(), ReadError> {
        if let Some(zones) = &mut self.zones {
            zones.end(self.number)?;
        }
        if let Some((blocks, _)) = &mut self.blocks {
            self.told.extend(blocks.told()?);
        }
        match self.promised {
            Some(expected) if expected != self.rows => {
                Err(cut(self.dump, (expected, self.rows), self.number))
            }
            _ => Ok(()),
        }
    }
}

/// The error for another number of rows than the file announces; `line` is the last line that was read.
pub(super) fn cut(dump: bool, (expected, found): (u64, u64), line: u64) -> ReadError {
    let expected_rows = match dump {
        true => {
            format!("{expected} rows in a dump of LAMMPS, as its `ITEM: NUMBER OF ATOMS` says")
        }
        false => format!("{expected} rows in an XYZ file, as the count above them says"),
    };
    let advice = match (found < expected, dump) {
        (true, true) => {
            "the dump was cut off: write it again; the whole steps before this one can be read"
        }
        (true, false) => {
            "the file was cut off: write it again; the whole frames before this one can be read"
        }
        (false, _) => "the number or the rows are wrong: write the file again",
    };
    let place = Place::Line(line);
    ReadError::Unclear { expected: expected_rows, found: found.to_string(), place, advice }
}

impl RowReader for Lines<'_> {
    fn next(&mut self, columns: &mut [Column]) -> Result<bool, ReadError> {
        while let Some(line) = self.text.line()? {
            self.number += 1;
            let line = line.trim_ascii();
            let mut passed = is_comment(line);
            if let Some((blocks, _)) = &mut self.blocks {
                blocks.line(line, 0, self.number - 1);
                passed |= blocks.passes(line);
            }
            if passed {
                if let Some(zones) = &mut self.zones {
                    zones.pass(line, self.number)?;
                }
                continue;
            }
            if let Some(zones) = &mut self.zones {
                let names = tecplot::variables(line).is_some() || line.starts_with(b"\"");
                if names || !zones.is_row(line, self.number)? {
                    continue;
                }
            }
            let next = || line.iter().all(u8::is_ascii_digit) || line.starts_with(b"ITEM:");
            if self.promised == Some(self.rows) && next() {
                return Err(several_frames(self.number));
            }
            let digit = line.first().is_some_and(|b| b.is_ascii_digit() || b"+-.".contains(b));
            let begins =
                digit || words(line, self.commas).next().is_some_and(|w| number(w).is_some());
            let whole = self.promised.is_none_or(|promised| promised == self.rows);
            let other = *self.numbered.get_or_insert(begins) && !begins;
            // A line of words below the table.
            if other && whole && self.zones.is_none() && !self.dump {
                let empty = |c: &Column| Column::new(&c.name, c.components, AttributeType::Number);
                let mut none: Vec<Column> = columns.iter().map(empty).collect();
                let read = row(line, self.number, self.commas, &self.columns, &mut none);
                if let Err(error) = read {
                    let told = comma::below_warning(line);
                    self.text.skip_space()?;
                    if !self.text.ahead(1)?.is_empty() {
                        return Err(error);
                    }
                    self.told.push(told);
                    self.end()?;
                    return Ok(false);
                }
            }
            let read = row(line, self.number, self.commas, &self.columns, columns);
            if let Ok(true) = read {
                // A line that is too long was not cut off.
                let found = values(line, self.commas).count();
                return Err(wrong_count(line, self.number, self.columns.len(), found));
            }
            if let Err(error) = read {
                // The last row may be cut off within.
                let promised = self.promised.filter(|promised| *promised > self.rows);
                let zone = self.zones.as_ref().and_then(|zones| zones.missing(self.number));
                self.text.skip_space()?;
                return Err(match (self.text.ahead(1)?.is_empty(), promised, zone) {
                    (true, Some(promised), _) => cut(self.dump, (promised, self.rows), self.number),
                    (true, None, Some(zone)) => zone,
                    (true, None, None) => error.in_last_row(),
                    (false, ..) => error,
                });
            }
            if let Some((basis, axes)) = &self.basis {
                basis.apply(axes, columns);
            }
            if let Some(zones) = &mut self.zones {
                zones.took(columns);
            }
            self.rows += 1;
            return Ok(true);
        }
        self.end()?;
        Ok(false)
    }

    fn told(&mut self) -> Vec<String> {
        std::mem::take(&mut self.told)
    }

    fn blocks(&self) -> Option<blocks::Rows> {
        self.blocks.as_ref().map(|(_, all)| all.clone())
    }
}

/// Error: a file with more than one frame.
pub(super) fn several_frames(line: u64) -> ReadError {
    ReadError::Unsupported {
        what: format!("a file of several frames (the second begins in line {line})"),
        advice: "write one file per frame, with the frame's number in its name, or cut this one: split -d -l LINES \
                 FILE frame_",
    }
}

/// Appends the values of a line, and returns whether more follow. `taken` holds, for each word, the column that takes
/// it.
fn row(
    line: &[u8],
    number: u64,
    commas: bool,
    taken: &[Option<usize>],
    columns: &mut [Column],
) -> Result<bool, ReadError> {
    let mut all = words(line, commas);
    for (i, column) in taken.iter().enumerate() {
        let word = all.next().ok_or_else(|| wrong_count(line, number, taken.len(), i))?;
        let Some(column) = column.and_then(|i| columns.get_mut(i)) else { continue };
        if column.data.push_text(word) {
            continue;
        }
        let value = number_with_comma(word).filter(|_| !commas);
        let value = value.or_else(|| names::may_be_text(&column.name).then_some(f64::NAN));
        if !value.is_some_and(|x| column.data.push_number(x)) {
            let expected = format!("a number in column {} (`{}`)", i + 1, column.name);
            return Err(ReadError::table(expected, show(word), Place::Line(number)));
        }
    }
    Ok(all.next().is_some_and(|word| !is_remark(word)))
}

/// Error: a line with another number of values than there are columns.
fn wrong_count(line: &[u8], number: u64, expected: usize, found: usize) -> ReadError {
    let found = format!("{found} in {}", show(line));
    ReadError::table(format!("{expected} values in each line"), found, Place::Line(number))
}

fn bad_line(line: &[u8], number: u64) -> ReadError {
    ReadError::table(
        "as many numbers as in the lines before, three at least",
        show(line),
        Place::Line(number),
    )
}

fn number(word: &[u8]) -> Option<f64> {
    parse_number(word).or_else(|| number_with_comma(word))
}

/// Splits a line into words. If `commas` is false, commas are decimal commas.
fn words(line: &[u8], commas: bool) -> impl Iterator<Item = &[u8]> {
    // Vectors may be in brackets.
    let between = move |b: &u8| match b {
        b',' => commas,
        b';' | b'(' | b')' | b'[' | b']' => true,
        b => b.is_ascii_whitespace(),
    };
    line.split(between).filter(|word| !word.is_empty())
}

/// The words of a line up to a comment at its end.
pub(super) fn values(line: &[u8], commas: bool) -> impl Iterator<Item = &[u8]> {
    words(line, commas).take_while(|word| !is_remark(word))
}

fn is_remark(word: &[u8]) -> bool {
    word.starts_with(b"//") || matches!(word.first(), Some(b'#' | b'%' | b'!'))
}
