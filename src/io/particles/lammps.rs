//! Dumps of LAMMPS and LIGGGHTS in text: `ITEM:` lines with what follows them, of which `ITEM: ATOMS` names the columns.

use super::Format;
use super::asked::Asked;
use super::bytes::{parse_number, show};
use super::error::{Place, ReadError};
use super::names::have_positions;
use super::plan::About;
use super::source::Content;
use super::table::Table;
use super::text::Text;
use super::xyz;

/// What such a file begins with; a unit or a time may stand above the number of the step.
pub(super) const STARTS: [&[u8]; 3] = [b"ITEM: TIMESTEP", b"ITEM: UNITS", b"ITEM: TIME"];

/// Lines above the atoms: more are there in no dump.
const LINES: u64 = 64;

pub(super) fn open<'a>(content: &Content<'a>, asked: &Asked) -> Result<Table<'a>, ReadError> {
    let mut text = Text::of(content)?;
    let mut number = 0;
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
            // Unwrapped positions are positions; scaled ones need the box.
            for name in &mut names {
                if let "xu" | "yu" | "zu" = name.as_str() {
                    name.pop();
                }
            }
            // Scaled ones are parts of the sides of the box.
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
        let about = About::new(Format::Lammps, asked);
        let start = text.at();
        let text = Text::new(content.open(start, content.length())?);
        return Ok(xyz::rows(text, number, Some(count), false, (&names, &sides), about));
    }
}
