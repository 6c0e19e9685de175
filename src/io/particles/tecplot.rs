//! Reads Tecplot's text: `VARIABLES` names the columns, and the rows of a zone follow its `ZONE` record.
//!
//! Records may go over several lines. Zones are frames, in the order of the file. Adjacent zones are parts of one frame
//! if they have the same `SOLUTIONTIME` or, without times, if their titles differ in more than numbers (`fluid`,
//! `boundary`); the column `zone` counts them from 0.

use super::Format;
use super::asked::Asked;
use super::columns::AttributeType;
use super::comma::unnamed;
use super::error::{Place, ReadError};
use super::heading::{self, Heading, Line};
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

/// Properties of a zone in its record.
#[derive(Default)]
struct Zone {
    title: String,
    time: Option<f64>,
    block: bool,
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
        let upper = record.to_ascii_uppercase();
        let value = |key| value(record, &upper, key);
        let title = value("T").unwrap_or_default().to_string();
        let time = value("SOLUTIONTIME").and_then(|time| time.parse().ok());
        let titled = || {
            let words =
                title.split(|c: char| c.is_whitespace() || matches!(c, '=' | ':' | ',' | ';'));
            words.filter(|word| word.contains(['.', 'e', 'E'])).find_map(|word| word.parse().ok())
        };
        let time = time.or_else(|| xyz::time_in(title.as_bytes())).or_else(titled);
        let packing = value("DATAPACKING").or(value("F")).unwrap_or_default();
        let block = packing.to_ascii_uppercase().contains("BLOCK");
        Self { title, time, block }
    }

    /// The title without its numbers.
    fn kind(&self) -> String {
        self.title.chars().filter(|c| !c.is_ascii_digit() && !".eE+-".contains(*c)).collect()
    }
}

/// Positions at which the frames of a file begin, up to frame `upto`, and the titles of their zones.
fn frames(
    content: &Content<'_>,
    upto: Option<usize>,
) -> Result<Vec<(Start, Vec<String>)>, ReadError> {
    let (mut text, mut number) = (Text::of(content)?, 0_u64);
    let mut zones: Vec<(Start, Zone)> = Vec::new();
    // The current record: its position, and its text.
    let mut record: Option<(Start, String)> = None;
    let mut different = 0;
    loop {
        let (at, lines) = (text.at(), number);
        let line = text.line()?;
        number += 1;
        let more = line.is_some_and(|line| is_record(line) && !is_zone(line));
        if let Some((_, record)) = record.as_mut().filter(|_| more) {
            record.push(' ');
            record.push_str(&String::from_utf8_lossy(line.unwrap_or_default()));
            continue;
        }
        if let Some((start, record)) = record.take() {
            let zone = Zone::of(&record);
            if zone.block {
                return Err(ReadError::Unsupported {
                    what: format!("a Tecplot zone in blocks (line {})", start.lines + 1),
                    advice: "write DATAPACKING=POINT, a line for each particle",
                });
            }
            let last = zones.last().map(|(_, zone)| zone);
            let apart = last.is_none_or(|last| last.time.is_none() || last.time != zone.time);
            different += usize::from(apart);
            zones.push((Start { time: zone.time, ..start }, zone));
        }
        let Some(line) = line else { break };
        if is_zone(line) {
            if upto.is_some_and(|upto| different > upto + 2) {
                break;
            }
            record =
                Some((Start { at, lines, time: None }, String::from_utf8_lossy(line).into_owned()));
        }
    }
    let timed = zones.iter().any(|(_, zone)| zone.time.is_some());
    let mut kinds: Vec<String> = zones.iter().map(|(_, zone)| zone.kind()).collect();
    kinds.sort();
    kinds.dedup();
    let together = !timed && kinds.len() > 1;
    let mut frames: Vec<(Start, Vec<String>)> = Vec::new();
    for (start, zone) in zones {
        match frames.last_mut() {
            Some((last, titles)) if together || (zone.time.is_some() && last.time == zone.time) => {
                titles.push(zone.title);
            }
            _ => frames.push((start, vec![zone.title])),
        }
    }
    Ok(frames)
}

/// The times of the frames.
pub(super) fn times(content: &Content<'_>) -> Result<Vec<Option<f64>>, ReadError> {
    if !is(&heading::lines(content)?) {
        return Ok(Vec::new());
    }
    Ok(frames(content, None)?.into_iter().map(|(start, _)| start.time).collect())
}

pub(super) fn open<'a>(
    content: &Content<'a>,
    lines: &[Line],
    asked: &Asked,
) -> Result<Table<'a>, ReadError> {
    let heading = Heading::of(lines);
    let step = asked.step().map(|step| step.index);
    let mut frames = frames(content, Some(step.unwrap_or(1)))?;
    if let (Some((second, _)), None) = (frames.get(1), step) {
        return Err(xyz::several_frames(second.lines + 1));
    }
    let titles = frames.get_mut(step.unwrap_or(0)).map(|(_, titles)| std::mem::take(titles));
    let titles = titles.unwrap_or_default();
    let starts: Vec<Start> = frames.into_iter().map(|(start, _)| start).collect();
    let part = steps::part(content, &starts, step.unwrap_or(0))?;
    let (content, time) = part.unwrap_or((content.clone(), None));
    let mut about = About { time, ..About::new(Format::Tecplot, asked) };
    let row =
        lines.iter().find(|line| line.start >= heading.at && !heading::is_comment(&line.text));
    let commas = heading.delimiter == Some(b',');
    let mut names = heading.names;
    if names.is_empty() {
        let Some(row) = row else {
            return Err(ReadError::table("lines of numbers in a zone", "none", Place::Unknown));
        };
        names.extend((0..heading::fields(&row.text, heading.delimiter).len()).map(unnamed));
    }
    let zone = (titles.len() > 1).then(|| {
        about.warnings.push(format!(
            "{} zones are joined: {}; if some of them are walls, leave them out by their number, from 0 on \
             (--where 'zone=0')",
            titles.len(),
            titles.join(", ")
        ));
        about.list(ZONE, 1, AttributeType::Number).then_some(ZONE)
    });
    let text = Text::new(content.open(0, content.length())?);
    Ok(xyz::rows_of_zones(text, content.lines_before(), commas, &names, zone, about))
}
