//! Reads text dumps of LAMMPS and LIGGGHTS: `ITEM:` lines, each followed by its data. `ITEM: ATOMS` names the
//! columns.

use super::Format;
use super::asked::Asked;
use super::bytes::{parse_number, show};
use super::error::{Place, ReadError};
use super::names::have_positions;
use super::plan::About;
use super::source::Content;
use super::steps::{self, Start};
use super::table::Table;
use super::text::Text;
use super::xyz;

/// Beginnings of such a file. A unit or a time may precede the step number.
pub(super) const STARTS: [&[u8]; 3] = [b"ITEM: TIMESTEP", b"ITEM: UNITS", b"ITEM: TIME"];

/// Max number of lines before the atoms.
const LINES: u64 = 64;

/// Where the frames of a file begin, up to frame `upto`.
pub(super) fn starts(content: &Content<'_>, upto: Option<usize>) -> Result<Vec<Start>, ReadError> {
    let (mut starts, mut text, mut number) = (Vec::new(), Text::of(content)?, 0_u64);
    while upto.is_none_or(|upto| starts.len() <= upto + 1) {
        let (at, lines) = (text.at(), number);
        let (mut time, mut left, mut before) = (None, None::<u64>, Item::Other);
        loop {
            let Some(line) = text.line()? else { return Ok(starts) };
            number += 1;
            let line = line.trim_ascii();
            let word = std::str::from_utf8(line).unwrap_or_default();
            match before {
                Item::Time => time = word.parse().ok(),
                Item::Count => left = word.parse().ok(),
                Item::Other => {}
            }
            before = match line {
                b"ITEM: TIME" => Item::Time,
                b"ITEM: NUMBER OF ATOMS" => Item::Count,
                _ => Item::Other,
            };
            if line.starts_with(b"ITEM: ATOMS") || number - lines > LINES {
                break;
            }
        }
        starts.push(Start { at, lines, time });
        for _ in 0..left.unwrap_or(0) {
            if text.line()?.is_none() {
                return Ok(starts);
            }
            number += 1;
        }
        text.skip_space()?;
    }
    Ok(starts)
}

/// Meaning of the line after an `ITEM:` line.
enum Item {
    Time,
    Count,
    Other,
}

pub(super) fn open<'a>(content: &Content<'a>, asked: &Asked) -> Result<Table<'a>, ReadError> {
    let starts = asked.step().map(|step| starts(content, Some(step.index))).transpose()?;
    let part = asked.step().zip(starts);
    match part.map_or(Ok(None), |(step, starts)| steps::part(content, &starts, step.index))? {
        Some((content, _)) => open_one(&content, &asked.clone().of_step(None)),
        None => open_one(content, asked),
    }
}

fn open_one<'a>(content: &Content<'a>, asked: &Asked) -> Result<Table<'a>, ReadError> {
    let mut text = Text::of(content)?;
    let mut number = 0;
    let (mut time, mut timed) = (None, false);
    let mut count = None;
    let mut counts = false;
    let (mut corners, mut bounds_left, mut tilted) = (Vec::new(), 0, false);
    let mut sides = Vec::new();
    let bad = |line: &[u8], number| {
        ReadError::malformed(
            "the items of a dump, ATOMS after their number",
            show(line),
            Place::Line(number),
        )
    };
    loop {
        let line = text.line()?.filter(|_| number < LINES);
        let line = line.ok_or_else(|| bad(b"none", number))?.trim_ascii().to_vec();
        number += 1;
        if std::mem::take(&mut timed) {
            time = parse_number(&line);
            continue;
        }
        timed = line == b"ITEM: TIME";
        if std::mem::take(&mut counts) {
            let found = std::str::from_utf8(&line).ok().and_then(|line| line.parse::<u64>().ok());
            count = Some(found.ok_or_else(|| bad(&line, number))?);
            continue;
        }
        counts = line == b"ITEM: NUMBER OF ATOMS";
        if let Some(bounds) = line.strip_prefix(b"ITEM: BOX BOUNDS") {
            tilted = bounds.windows(2).any(|w| w == b"xy");
            bounds_left = 3;
            continue;
        }
        if bounds_left > 0 {
            bounds_left -= 1;
            let mut words = line.split(u8::is_ascii_whitespace).filter_map(parse_number);
            corners.extend(words.next().zip(words.next()));
            continue;
        }
        let Some(names) = line.strip_prefix(b"ITEM: ATOMS") else { continue };
        let count = count.ok_or_else(|| bad(&line, number))?;
        let names = String::from_utf8_lossy(names);
        let mut names: Vec<String> = names.split_whitespace().map(str::to_string).collect();
        if !have_positions(&names) {
            // Unwrapped positions count as positions; scaled ones need the box.
            for name in &mut names {
                if let "xu" | "yu" | "zu" = name.as_str() {
                    name.pop();
                }
            }
            // Scaled positions are fractions of the sides of the box.
            for (name, side) in names.iter_mut().flat_map(|name| {
                let scaled = ["xs", "ys", "zs", "xsu", "ysu", "zsu"].iter().position(|n| n == name);
                scaled.map(|side| (name, side % 3))
            }) {
                let axis = ["x", "y", "z"].get(side).copied().unwrap_or_default();
                *name = axis.to_string();
                match corners.get(side) {
                    Some((from, to)) if !tilted => sides.push((axis, *from, *to)),
                    _ => {
                        return Err(ReadError::Unsupported {
                            what: "a dump of scaled positions (xs ys zs) in a box that is not straight".into(),
                            advice: "dump x y z, or xu yu zu",
                        });
                    }
                }
            }
        }
        let about = About { time, ..About::new(Format::Lammps, asked) };
        let start = text.at();
        let text = Text::new(content.open(start, content.length())?);
        return Ok(xyz::rows(
            text,
            content.lines_before() + number,
            Some(count),
            false,
            (&names, &sides),
            about,
        ));
    }
}
