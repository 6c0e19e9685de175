//! Reads Tecplot's text: `VARIABLES` names the columns, and the rows of a zone follow its `ZONE` record.
//!
//! Records may go over several lines. Zones are frames, in the order of the file. Adjacent zones are parts of one frame
//! if they have the same `SOLUTIONTIME` or, without times, if their titles differ in more than numbers (`fluid`,
//! `boundary`); the column `zone` counts them from 0. A zone has as many rows as its record says: I·J·K, or N. Of a
//! mesh, the lines of elements behind the rows are skipped.

use std::collections::BTreeSet;

use super::Format;
use super::asked::Asked;
use super::columns::{AttributeType, Column};
use super::comma::unnamed;
use super::error::{Place, ReadError};
use super::heading::{self, Heading, Line};
use super::names::have_positions;
use super::plan::About;
use super::source::Content;
use super::steps::{self, Start};
use super::table::Table;
use super::text::Text;
use super::xyz;

/// Keywords with which lines of a record begin, besides `ZONE` and `TITLE`.
const KEYS: [&[u8]; 25] = [
    b"AUXDATA",
    b"C",
    b"CONNECTIVITYSHAREZONE",
    b"D",
    b"DATAPACKING",
    b"DATASETAUXDATA",
    b"DT",
    b"E",
    b"ELEMENTS",
    b"ET",
    b"F",
    b"FILETYPE",
    b"I",
    b"J",
    b"K",
    b"N",
    b"NODES",
    b"PARENTZONE",
    b"PASSIVEVARLIST",
    b"SOLUTIONTIME",
    b"STRANDID",
    b"T",
    b"VARLOCATION",
    b"VARSHARELIST",
    b"ZONETYPE",
];

/// Name of the column that counts the zones of a frame.
const ZONE: &str = "zone";

/// Whether a line is a `ZONE` record, which begins its rows.
pub(super) fn is_zone(line: &[u8]) -> bool {
    begins(line, b"ZONE") && (line.contains(&b'=') || line.trim_ascii().len() == 4)
}

/// Whether a line is, or continues, a record other than `VARIABLES`.
pub(super) fn is_record(line: &[u8]) -> bool {
    // A line that begins with a comma continues a record.
    let line = line.trim_ascii_start();
    let line = line.strip_prefix(b",").unwrap_or(line);
    let key = |key: &&[u8]| {
        let rest = line.trim_ascii_start().get(key.len()..).unwrap_or_default();
        begins(line, key) && rest.contains(&b'=')
    };
    is_zone(line) || begins(line, b"TITLE") || KEYS.iter().any(key)
}

/// Whether a line begins with a keyword.
fn begins(line: &[u8], word: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    let behind = line.get(word.len()..).and_then(<[u8]>::first);
    let ends = behind.is_none_or(|b| b.is_ascii_whitespace() || *b == b'=');
    ends && line.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word))
}

/// The names in a `VARIABLES =` record.
pub(super) fn variables(line: &[u8]) -> Option<&[u8]> {
    let rest = line.get(b"VARIABLES".len()..).filter(|_| begins(line, b"VARIABLES"))?;
    rest.trim_ascii_start().strip_prefix(b"=")
}

/// Whether a file that begins with these lines has zones.
pub(super) fn is(lines: &[Line]) -> bool {
    lines.iter().any(|line| is_zone(&line.text))
}

/// Joins names on separate lines to the `VARIABLES =` line before them.
pub(super) fn joined(lines: Vec<Line>) -> Vec<Line> {
    let mut all: Vec<Line> = Vec::with_capacity(lines.len());
    let mut open = false;
    for line in lines {
        let text = line.text.trim_ascii();
        match all.last_mut() {
            Some(before) if open && text.starts_with(b"\"") => {
                before.text.push(b' ');
                before.text.extend(text);
                before.next = line.next;
                // The number of a line is its index in this list, so an empty line stays in place of the one
                // that was joined.
                all.push(Line { text: Vec::new(), start: line.start, next: line.next });
                let count = all.len();
                if count >= 2 {
                    all.swap(count - 2, count - 1);
                }
                continue;
            }
            _ => open = variables(text).is_some(),
        }
        all.push(line);
    }
    all
}

/// The names in the text of a `VARIABLES` record. Only quoted names may have blanks.
fn names_in(text: &[u8]) -> Vec<String> {
    let between = |c: char| c.is_whitespace() || c == ',';
    let text = String::from_utf8_lossy(text);
    let (mut names, mut rest) = (Vec::new(), text.trim_start_matches(between));
    while !rest.is_empty() {
        let (name, behind) = match rest.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').unwrap_or((quoted, "")),
            None => rest.split_once(between).unwrap_or((rest, "")),
        };
        names.push(name.trim().to_string());
        rest = behind.trim_start_matches(between);
    }
    names
}

/// Properties of a zone in its record.
#[derive(Default)]
struct Zone {
    title: String,
    time: Option<f64>,
    /// Whether the record says if the values are in rows or blocks.
    packed: bool,
    block: bool,
    /// Whether values of variables are not in the zone's own rows.
    shares: bool,
    /// Number of rows, if the record has it.
    rows: Option<u64>,
    /// Whether the rows are the nodes of a grid or of elements.
    grid: bool,
    mesh: bool,
    /// Number of elements, of which each has a line behind the rows.
    elements: Option<u64>,
}

/// The value of a key in a record.
fn value<'a>(record: &'a str, upper: &str, key: &str) -> Option<&'a str> {
    let mut from = 0;
    while let Some(found) = upper.get(from..)?.find(key) {
        let at = from + found;
        let before = upper.get(..at)?.chars().next_back();
        let behind = record.get(at + key.len()..)?.trim_start();
        let whole = before.is_none_or(|c| c.is_whitespace() || c == ',');
        if let Some(value) = behind.strip_prefix('=').filter(|_| whole) {
            let value = value.trim_start();
            return match value.strip_prefix('"') {
                Some(text) => text.split('"').next(),
                None => value.split(|c: char| c.is_whitespace() || c == ',').next(),
            };
        }
        from = at + key.len();
    }
    None
}

impl Zone {
    fn of(record: &str) -> Self {
        // A title may contain what looks like a key. Bytes keep their places.
        let quotes = record.matches('"').count().is_multiple_of(2);
        let mut inside = false;
        let keys = record.chars().map(|c| {
            inside ^= quotes && c == '"';
            if inside && c.is_ascii() && c != '"' { '_' } else { c.to_ascii_uppercase() }
        });
        let upper: String = keys.collect();
        let value = |key| value(record, &upper, key);
        let number = |key| value(key).and_then(|value| value.parse::<u64>().ok());
        let title = value("T").unwrap_or_default().to_string();
        let time = value("SOLUTIONTIME").and_then(|time| time.parse().ok());
        let titled = || {
            let words =
                title.split(|c: char| c.is_whitespace() || matches!(c, '=' | ':' | ',' | ';'));
            words.filter(|word| word.contains(['.', 'e', 'E'])).find_map(|word| word.parse().ok())
        };
        let time = time.or_else(|| xyz::time_in(title.as_bytes())).or_else(titled);
        let packing = value("DATAPACKING").or(value("F"));
        let packed = packing.is_some();
        let packing = packing.unwrap_or_default().to_ascii_uppercase();
        let kind = value("ZONETYPE").or(value("ET")).unwrap_or_default().to_ascii_uppercase();
        // Values of cells and polygons are always in blocks.
        let cells = value("VARLOCATION").is_some() && upper.contains("CELLCENTERED");
        let block = packing.contains("BLOCK") || kind.contains("POLY") || cells;
        let shares = value("VARSHARELIST").or(value("PASSIVEVARLIST")).is_some();
        let nodes = number("N").or(number("NODES"));
        let elements = number("E").or(number("ELEMENTS"));
        let mesh = kind.starts_with("FE")
            || packing.starts_with("FE")
            || value("ET").is_some()
            || (nodes.is_some() && elements.is_some());
        let sides = [number("I"), number("J"), number("K")];
        let product = sides.iter().flatten().fold(1_u64, |all, side| all.saturating_mul(*side));
        let ordered = sides.iter().any(Option::is_some).then_some(product);
        let rows = if mesh { nodes } else { ordered.or(nodes) };
        let grid = !mesh && sides.iter().skip(1).flatten().any(|side| *side > 1);
        // Such a zone has the elements of another one.
        let elements = if value("CONNECTIVITYSHAREZONE").is_some() { Some(0) } else { elements };
        Self { title, time, packed, block, shares, rows, grid, mesh, elements }
    }

    /// Fails if the zone is not read; its record begins in this line.
    fn check(&self, line: u64) -> Result<(), ReadError> {
        let (what, advice) = if self.block {
            ("a Tecplot zone in blocks", "write DATAPACKING=POINT, a line for each particle")
        } else if self.shares {
            (
                "a Tecplot zone without values of its own for all variables",
                "write all values in each zone, without VARSHARELIST and PASSIVEVARLIST",
            )
        } else if self.mesh && self.rows.is_none() {
            (
                "a Tecplot zone of a mesh without the number of its nodes",
                "write N (or NODES) in its record, or the nodes alone as I=..., F=POINT",
            )
        } else {
            return Ok(());
        };
        Err(ReadError::Unsupported { what: format!("{what} (line {line})"), advice })
    }

    /// The title without its numbers.
    fn kind(&self) -> String {
        self.title.chars().filter(|c| !c.is_ascii_digit() && !".eE+-".contains(*c)).collect()
    }
}

/// Appends a line to a record.
fn append(record: &mut String, line: &[u8]) {
    record.push(' ');
    record.push_str(&String::from_utf8_lossy(line));
}

/// Follows the zones of a table while its lines are read.
pub(super) struct Zones {
    /// The column for the zone's number, if it is used.
    column: Option<usize>,
    /// Number of zones that have begun.
    begun: u64,
    /// The record of the current zone and the number of its first line, until the first row.
    record: Option<(String, u64)>,
    zone: Zone,
    /// Number of rows, and of lines of elements, of the current zone so far.
    rows: u64,
    elements: u64,
}

impl Zones {
    pub(super) fn new(column: Option<usize>) -> Self {
        let zone = Zone::default();
        Self { column, begun: 0, record: None, zone, rows: 0, elements: 0 }
    }

    /// Called for each empty line, comment or record; `number` is the line's number.
    pub(super) fn pass(&mut self, line: &[u8], number: u64) -> Result<(), ReadError> {
        if is_zone(line) {
            self.end(number.saturating_sub(1))?;
            let record = Some((String::from_utf8_lossy(line).into_owned(), number));
            *self = Self { begun: self.begun + 1, record, ..Self::new(self.column) };
        } else if let Some((record, _)) = self.record.as_mut().filter(|_| is_record(line)) {
            append(record, line);
        }
        Ok(())
    }

    /// Called behind the record of a zone.
    fn settle(&mut self) -> Result<(), ReadError> {
        if let Some((record, line)) = self.record.take() {
            self.zone = Zone::of(&record);
            self.zone.check(line)?;
        }
        Ok(())
    }

    /// Whether a line is a row, and not an element of a mesh. Fails if there are too many rows.
    pub(super) fn is_row(&mut self, line: &[u8], number: u64) -> Result<bool, ReadError> {
        self.settle()?;
        let Some(rows) = self.zone.rows.filter(|rows| self.rows >= *rows) else { return Ok(true) };
        let node = |b: &u8| b.is_ascii_digit() || b.is_ascii_whitespace() || *b == b',';
        let more = self.zone.elements.is_none_or(|elements| self.elements < elements);
        if !self.zone.mesh || !more || !line.iter().all(node) {
            return Err(wrong_rows(rows, "more", number));
        }
        self.elements += 1;
        Ok(false)
    }

    /// Called after each row; appends the zone's number.
    pub(super) fn took(&mut self, columns: &mut [Column]) {
        self.rows += 1;
        if let Some(column) = self.column.and_then(|column| columns.get_mut(column)) {
            // Rows before the first zone have -1.
            column.data.push_number(self.begun as f64 - 1.0);
        }
    }

    /// The error if rows of the current zone are missing; `line` is the last line that was read.
    pub(super) fn missing(&self, line: u64) -> Option<ReadError> {
        let rows = self.zone.rows.filter(|rows| *rows > self.rows)?;
        Some(wrong_rows(rows, &self.rows.to_string(), line))
    }

    /// Called after the last line of a zone, which has this number.
    pub(super) fn end(&mut self, line: u64) -> Result<(), ReadError> {
        self.settle()?;
        self.missing(line).map_or(Ok(()), Err)
    }
}

/// The error for another number of rows than the record of a zone says.
fn wrong_rows(expected: u64, found: &str, line: u64) -> ReadError {
    ReadError::Unclear {
        expected: format!("{expected} rows in a zone of Tecplot, as its record says (I*J*K or N)"),
        found: found.to_string(),
        place: Place::Line(line),
        advice: "the file was cut off, or its record is wrong: write it again, a line for each particle",
    }
}

/// Where the frames of a file begin, up to frame `upto`, and their zones.
fn frames(
    content: &Content<'_>,
    upto: Option<usize>,
) -> Result<Vec<(Start, Vec<Zone>)>, ReadError> {
    let (mut text, mut number) = (Text::of(content)?, content.lines_before());
    let mut zones: Vec<(Start, Zone)> = Vec::new();
    // The current record: its position, and its text.
    let mut record: Option<(Start, String)> = None;
    let (mut different, mut timed, mut kinds) = (0, false, BTreeSet::new());
    loop {
        let (at, lines) = (text.at(), number);
        let line = text.line()?;
        number += 1;
        let passed = line.filter(|line| heading::is_comment(line) && !is_zone(line));
        if let (Some((_, record)), Some(line)) = (&mut record, passed) {
            if is_record(line) {
                append(record, line);
            }
            continue;
        }
        if let Some((start, record)) = record.take() {
            let zone = Zone::of(&record);
            zone.check(start.lines + 1)?;
            let last = zones.last().map(|(_, zone)| zone);
            let apart = last.is_none_or(|last| last.time.is_none() || last.time != zone.time);
            different += usize::from(apart);
            timed |= zone.time.is_some();
            kinds.insert(zone.kind());
            zones.push((Start { time: zone.time, ..start }, zone));
        }
        let Some(line) = line else { break };
        if is_zone(line) {
            // Zones of several kinds without times are one frame, up to the last of them.
            let several = timed || kinds.len() < 2;
            if several && upto.is_some_and(|upto| different > upto + 2) {
                break;
            }
            record =
                Some((Start { at, lines, time: None }, String::from_utf8_lossy(line).into_owned()));
        }
    }
    let together = !timed && kinds.len() > 1;
    let mut frames: Vec<(Start, Vec<Zone>)> = Vec::new();
    for (start, zone) in zones {
        match frames.last_mut() {
            Some((last, zones)) if together || (zone.time.is_some() && last.time == zone.time) => {
                zones.push(zone);
            }
            _ => frames.push((start, vec![zone])),
        }
    }
    Ok(frames)
}

/// Where the frames begin; empty if the file has no zones.
pub(super) fn starts(content: &Content<'_>) -> Result<Vec<Start>, ReadError> {
    if !is(&heading::lines(content)?) {
        return Ok(Vec::new());
    }
    Ok(frames(content, None)?.into_iter().map(|(start, _)| start).collect())
}

/// What is told of zones with this number of variables.
fn warnings(zones: &[Zone], variables: usize) -> Vec<String> {
    let count = |test: &dyn Fn(&Zone) -> bool| zones.iter().filter(|zone| test(zone)).count();
    let meshes = count(&|zone| zone.mesh);
    let grids = count(&|zone| zone.grid);
    // Lines of a block may have as many numbers as there are variables.
    let blocks = count(&|zone| {
        let whole = |rows: u64| rows > 0 && rows.is_multiple_of(variables as u64);
        !zone.packed && zone.rows.is_some_and(whole)
    });
    let all = zones.len();
    let mut told = Vec::new();
    if meshes > 0 {
        told.push(format!(
            "{meshes} of {all} zones are meshes: their nodes are taken as particles, their elements are skipped"
        ));
    }
    if grids > 0 {
        told.push(format!("{grids} of {all} zones are grids: their nodes are taken as particles"));
    }
    if blocks > 0 {
        told.push(format!(
            "{blocks} of {all} zones have no DATAPACKING: each line is taken as a particle; if all of one variable \
             come before the next, write DATAPACKING=POINT"
        ));
    }
    told
}

pub(super) fn open<'a>(
    content: &Content<'a>,
    lines: &[Line],
    asked: &Asked,
) -> Result<Table<'a>, ReadError> {
    let known = steps::known_part(content, asked)?;
    let step = asked.step().map(|step| step.index).filter(|_| known.is_none());
    let (content, known) = known.map_or((content.clone(), None), |(part, time)| (part, Some(time)));
    let mut frames = frames(&content, Some(step.unwrap_or(1)))?;
    if let (Some((second, _)), None) = (frames.get(1), step) {
        return Err(xyz::several_frames(second.lines + 1));
    }
    let zones = frames.get_mut(step.unwrap_or(0)).map(|(_, zones)| std::mem::take(zones));
    let zones = zones.unwrap_or_default();
    let starts: Vec<Start> = frames.into_iter().map(|(start, _)| start).collect();
    let (content, time) = match known {
        Some(time) => (content, time),
        None => {
            let part = steps::part(&content, &starts, step.unwrap_or(0))?;
            part.unwrap_or((content, None))
        }
    };
    let mut about = About { time, ..About::new(Format::Tecplot, asked) };
    let mut rows = lines.iter().map(|line| line.text.trim_ascii());
    let row = rows.find(|line| {
        !heading::is_comment(line) && variables(line).is_none() && !line.starts_with(b"\"")
    });
    let commas = row.is_some_and(|row| heading::delimiter(row) == Some(b','));
    let mut names = Heading::of(lines).names;
    // Names that do not fit the first row were not found, or the whole record was taken for names.
    if !have_positions(&names) || names.iter().any(|name| begins(name.as_bytes(), b"VARIABLES")) {
        let mut texts = lines.iter().map(|line| line.text.trim_ascii());
        names = texts.find_map(variables).map_or(names, names_in);
    }
    let found = row.map(|row| xyz::values(row, commas).count());
    if names.is_empty() {
        let Some(found) = found else {
            return Err(ReadError::table("lines of numbers in a zone", "none", Place::Unknown));
        };
        names.extend((0..found).map(unnamed));
    }
    if let (Some(found), Some(false)) = (found, zones.first().map(|zone| zone.packed))
        && found != names.len()
    {
        return Err(ReadError::Unsupported {
            what: format!(
                "a Tecplot zone without DATAPACKING and with {found} values in its first line, for {} variables,",
                names.len()
            ),
            advice: "write DATAPACKING=POINT, a line for each particle",
        });
    }
    let zone = (zones.len() > 1).then(|| {
        let titles: Vec<&str> = zones.iter().map(|zone| zone.title.as_str()).collect();
        about.warnings.push(format!(
            "{} zones are joined: {}; if some of them are walls, leave them out by their number, from 0 on \
             (--where 'zone=0')",
            titles.len(),
            titles.join(", ")
        ));
        about.list(ZONE, 1, AttributeType::Number).then_some(ZONE)
    });
    about.warnings.extend(warnings(&zones, names.len()));
    let text = Text::new(content.open(0, content.length())?);
    Ok(xyz::rows_of_zones(text, content.lines_before(), commas, &names, zone, about))
}
