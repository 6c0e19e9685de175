//! Reads text dumps of LAMMPS and LIGGGHTS: `ITEM:` lines, each followed by its data. `ITEM: ATOMS` names the
//! columns.
//!
//! Scaled positions (`xs ys zs`, `xsu ysu zsu`) are in units of the edges a, b, c of the box: position = origin +
//! xs·a + ys·b + zs·c. The box is described by three lines after `BOX BOUNDS` (both ends of each side), `BOX BOUNDS
//! xy xz yz` (both ends of the upright box that encloses the tilted box, and the tilts) or `BOX BOUNDS abc origin`
//! (any three edges, and the origin).

use super::Format;
use super::asked::Asked;
use super::bytes::{parse_number, show};
use super::error::{Place, ReadError};
use super::plan::About;
use super::source::Content;
use super::steps::{self, Start};
use super::table::Table;
use super::text::Text;
use super::xyz::{self, Basis};

/// Byte strings with one of which a dump begins. A unit or a time may precede the step number.
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
            let Some(line) = text.line()? else {
                // A step that was cut off before its atoms is one too, so that its loss is told.
                if number > lines {
                    starts.push(Start { at, lines, time });
                }
                return Ok(starts);
            };
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
    match steps::asked_part(content, asked, starts)? {
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
    let mut bounds = Bounds::default();
    let bad = |line: &[u8], number| {
        ReadError::malformed(
            "the items of a dump of LAMMPS, ATOMS after their number",
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
        if let Some(words) = line.strip_prefix(b"ITEM: BOX BOUNDS") {
            bounds = Bounds::of(words);
            continue;
        }
        if bounds.left > 0 {
            bounds.left -= 1;
            bounds.lines.push((line, content.lines_before() + number));
            continue;
        }
        let Some(names) = line.strip_prefix(b"ITEM: ATOMS") else { continue };
        let count = count.ok_or_else(|| bad(&line, number))?;
        let names = String::from_utf8_lossy(names);
        let mut names: Vec<String> = names.split_whitespace().map(str::to_string).collect();
        let scaled = choose(&mut names);
        let basis = match scaled.is_empty() {
            true => None,
            false => Some(bounds.basis(&scaled, &names)?),
        };
        // The line of the names may be cut off too.
        if count > 0 && text.ahead(1)?.is_empty() {
            return Err(xyz::cut(true, (count, 0), content.lines_before() + number));
        }
        let about = About { time, ..About::new(Format::Lammps, asked) };
        let start = text.at();
        let text = Text::new(content.open(start, content.length())?);
        return Ok(xyz::rows(
            text,
            content.lines_before() + number,
            Some(count),
            false,
            (&names, basis),
            about,
            None,
        ));
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// Renames one column of each axis to the axis (`x`): the position as it is (`x`), else unwrapped, that is, not
/// wrapped into the periodic box (`xu`), else scaled (`xs`), else scaled and unwrapped (`xsu`). Returns the axes that
/// are scaled, with the names of their columns in the file.
fn choose(names: &mut [String]) -> Vec<(usize, String)> {
    let mut scaled = Vec::new();
    for (i, axis) in AXES.into_iter().enumerate() {
        for suffix in ["", "u", "s", "su"] {
            let own = format!("{axis}{suffix}");
            let Some(name) = names.iter_mut().find(|name| **name == own) else { continue };
            *name = axis.to_string();
            if suffix.starts_with('s') {
                scaled.push((i, own));
            }
            break;
        }
    }
    scaled
}

/// The lines that describe the box.
#[derive(Default)]
struct Bounds {
    kind: Kind,
    /// Number of lines still to come.
    left: u64,
    /// The lines, with their numbers.
    lines: Vec<(Vec<u8>, u64)>,
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Kind {
    /// There is no box.
    #[default]
    None,
    /// Each line has both ends of a side.
    Straight,
    /// Tilted box: each of the three lines has both ends of the upright box that encloses it, along one axis, and
    /// then a tilt: xy, xz, yz.
    Tilted,
    /// Each line has an edge, and a coordinate of the origin.
    General,
}

impl Bounds {
    /// From the words behind `ITEM: BOX BOUNDS`.
    fn of(words: &[u8]) -> Self {
        let words: Vec<_> = words.split(u8::is_ascii_whitespace).collect();
        let kind = match (words.contains(&&b"abc"[..]), words.contains(&&b"xy"[..])) {
            (true, _) => Kind::General,
            (_, true) => Kind::Tilted,
            _ => Kind::Straight,
        };
        Self { kind, left: 3, lines: Vec::new() }
    }

    /// The N numbers of each of the box's three lines.
    fn numbers<const N: usize>(&self, expected: &str) -> Result<[[f64; N]; 3], ReadError> {
        let mut all = [[0.0; N]; 3];
        for (i, row) in all.iter_mut().enumerate() {
            let (line, number) =
                self.lines.get(i).map_or((&b"none"[..], 0), |(line, number)| (line, *number));
            let words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            let found: Option<Vec<f64>> = words.map(parse_number).collect();
            let found = found.and_then(|found| <[f64; N]>::try_from(found).ok());
            let found = found.filter(|found| found.iter().all(|x| x.is_finite()));
            *row = found
                .ok_or_else(|| ReadError::malformed(expected, show(line), Place::Line(number)))?;
        }
        Ok(all)
    }

    /// Origin and edges of the box. Source: LAMMPS' documentation, `Howto_triclinic`.
    fn cell(&self) -> Result<([f64; 3], [[f64; 3]; 3]), ReadError> {
        Ok(match self.kind {
            Kind::None => {
                return Err(ReadError::Unsupported {
                    what: "a dump of scaled positions without `ITEM: BOX BOUNDS`".into(),
                    advice: "dump x y z, or xu yu zu",
                });
            }
            Kind::Straight => {
                let [[ax, bx], [ay, by], [az, bz]] =
                    self.numbers("both ends of each side of the box")?;
                ([ax, ay, az], [[bx - ax, 0.0, 0.0], [0.0, by - ay, 0.0], [0.0, 0.0, bz - az]])
            }
            Kind::Tilted => {
                let [[ax, bx, xy], [ay, by, xz], [az, bz, yz]] =
                    self.numbers("both ends and the tilt of each side of the box")?;
                // The ends are those of the box that encloses the tilted one.
                let (low, high) = (
                    [0.0, xy, xz, xy + xz].into_iter().fold(0.0, f64::min),
                    [0.0, xy, xz, xy + xz].into_iter().fold(0.0, f64::max),
                );
                let (ax, bx) = (ax - low, bx - high);
                let (ay, by) = (ay - yz.min(0.0), by - yz.max(0.0));
                ([ax, ay, az], [[bx - ax, 0.0, 0.0], [xy, by - ay, 0.0], [xz, yz, bz - az]])
            }
            Kind::General => {
                let [[ax, ay, az, x], [bx, by, bz, y], [cx, cy, cz, z]] =
                    self.numbers("an edge of the box and a coordinate of its origin")?;
                ([x, y, z], [[ax, ay, az], [bx, by, bz], [cx, cy, cz]])
            }
        })
    }

    /// How the columns of scaled axes become positions.
    fn basis(&self, scaled: &[(usize, String)], names: &[String]) -> Result<Basis, ReadError> {
        let (origin, edges) = self.cell()?;
        let is_scaled = |axis: usize| scaled.iter().any(|(i, _)| *i == axis);
        // A position along a scaled axis needs the scaled coordinates of all edges that extend along that axis.
        for (axis, edge) in edges.iter().enumerate() {
            for (along, length) in edge.iter().enumerate() {
                if *length != 0.0 && is_scaled(along) && !is_scaled(axis) {
                    let all: Vec<_> = scaled.iter().map(|(_, name)| name.as_str()).collect();
                    let others = AXES.into_iter().enumerate();
                    let others =
                        others.filter(|(i, a)| !is_scaled(*i) && names.iter().any(|n| n == a));
                    let others: Vec<_> = others.map(|(_, axis)| axis).collect();
                    return Err(ReadError::Unsupported {
                        what: format!(
                            "a dump of positions that are scaled along some axes only ({}{}{}) in a tilted box",
                            all.join(" "),
                            if others.is_empty() { "" } else { ", and not " },
                            others.join(" ")
                        ),
                        advice: "dump x y z, xu yu zu, or all of xs ys zs",
                    });
                }
            }
        }
        Ok(Basis { scaled: [0, 1, 2].map(is_scaled), origin, edges })
    }
}
