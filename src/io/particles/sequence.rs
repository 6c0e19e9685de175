//! Expands user input to numbered frames.

use std::cmp::Ordering;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use super::index;
use super::steps::Step;

/// One file of a sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Number in the file's name. If the names have no number, or a time instead, or if a list of files gives the
    /// order, the frame's index in the sequence, from 0.
    pub number: u64,
    /// Time of the frame in the author's unit: from a list of files (`.pvd`, `.series`), or from a number with a
    /// decimal point or an exponent in the file's or its folder's name (`t0.32`, `0.32/cloud`, `4.0e-04`).
    pub time: Option<f64>,
    /// The file.
    pub path: PathBuf,
    /// Other files with particles of the same frame.
    pub also: Vec<PathBuf>,
    /// Which frame of the file this is, if the file holds several. [`expand`] leaves it `None`, because it does not read
    /// files of particles.
    pub step: Option<Step>,
}

impl Frame {
    fn new(number: u64, time: Option<f64>, path: PathBuf) -> Self {
        Self { number, time, path, also: Vec::new(), step: None }
    }

    /// All files of the frame.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        std::iter::once(&self.path).chain(&self.also).map(PathBuf::as_path)
    }
}

/// Why inputs yield no frames.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// No input.
    #[error("no input; name a file, a pattern such as 'fluid_*.bgeo', or 'fluid_%04d.bgeo'")]
    NoInput,
    /// A plain name that is not a file.
    #[error("{input}: no such file; check the name, or use a pattern such as 'fluid_*.bgeo'")]
    NotFound {
        /// As given.
        input: String,
    },
    /// A folder.
    #[error("{input} is a directory; name its files by a pattern such as '{input}/*.bgeo'")]
    Directory {
        /// As given.
        input: String,
    },
    /// A pattern that matches no file.
    #[error("{pattern}: no file fits; {near}")]
    NoMatch {
        /// As given.
        pattern: String,
        /// Similar names that exist.
        near: String,
    },
    /// An invalid pattern.
    #[error("{pattern}: expected {expected}")]
    Pattern {
        /// As given.
        pattern: String,
        /// Expected form.
        expected: String,
    },
    /// No frame is in the range.
    #[error(
        "no frame {}; {}",
        if first == last { first.to_string() } else { format!("from {first} to {last}") },
        match (below, above) {
            (None, None) => "no frame was found".to_owned(),
            _ if lowest == highest => format!("the only frame found is {lowest}"),
            (Some(a), Some(b)) => format!("the nearest of {count} found are {a} and {b}"),
            (Some(one), None) | (None, Some(one)) => format!("the nearest of {count} found is {one}"),
        }
    )]
    OutsideRange {
        /// First requested number.
        first: u64,
        /// Last requested number.
        last: u64,
        /// Frames found.
        count: usize,
        /// Largest number found that is below the range.
        below: Option<u64>,
        /// Smallest number found that is above the range.
        above: Option<u64>,
        /// Smallest number found.
        lowest: u64,
        /// Largest number found.
        highest: u64,
    },
    /// Two files with one number.
    #[error("{} and {} are both frame {number}: a sequence has one file for each; {advice}", first.display(), second.display())]
    Twice {
        /// The number.
        number: u64,
        /// One file.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// What to do.
        advice: String,
    },
    /// One of several given files is only a piece of a frame, as an index file shows; it would be mistaken for
    /// a whole frame.
    #[error("{} is a piece of the frame {}: give that one, or a pattern of its kind", file.display(), index.display())]
    Piece {
        /// The piece.
        file: PathBuf,
        /// The index that lists it.
        index: PathBuf,
    },
    /// A symbolic link whose target does not exist.
    #[error("{} is a link to {}, which does not exist; put that file back or delete the link", path.display(), target.display())]
    Link {
        /// The link.
        path: PathBuf,
        /// The target of the link.
        target: PathBuf,
    },
    /// A folder or file could not be listed.
    #[error("cannot look at {}: {reason}; check the name and the permissions", path.display())]
    Io {
        /// The path.
        path: PathBuf,
        /// The system's reason.
        reason: std::io::Error,
    },
}

/// Reads a range of frames, `A-B` (both included) or `A`.
///
/// # Errors
/// [`SequenceError::Pattern`] if the text is neither `A` nor `A-B` with whole numbers, or if `B` is less than `A`.
pub fn parse_range(text: &str) -> Result<RangeInclusive<u64>, SequenceError> {
    let bad = || SequenceError::Pattern {
        pattern: text.into(),
        expected: "a range of frames such as 10-50 with the smaller number first, or one number"
            .into(),
    };
    let number = |t: &str| t.trim().parse::<u64>().map_err(|_| bad());
    let (first, last) = match text.split_once('-') {
        Some((first, last)) => (number(first)?, number(last)?),
        None => (number(text)?, number(text)?),
    };
    if first > last {
        return Err(bad());
    }
    Ok(first..=last)
}

/// Expands inputs to the frames of one sequence, in the order of their numbers.
///
/// An input is a file, a list of files with times (ParaView's `.pvd` and `.series`), a pattern with `*`, `?` or
/// `[...]`, or one with `%d` or `%04d` in the file name. A name that exists is taken literally. All inputs
/// together are one sequence, so a pattern that the shell has expanded gives the same result. A frame's number
/// is the last run of digits in its name that differs between files, so `run2_frame_10` is frame 10; for a
/// pattern with `%d` it is the number there. If all file names are alike, the number is in their folders
/// (`10/cloud.vtp`). A number with a decimal point or an exponent is a time. A minus belongs to a number if it
/// follows a separator (`step--1` is -1). Times order the frames, which are then counted from 0. A number after
/// `rank`, `proc` and the like is that of a process, whose file is a part of a frame.
///
/// # Errors
/// Every input must give at least one file. Otherwise the error says which input gave none, and what exists instead.
/// For other errors see [`SequenceError`].
pub fn expand<S: AsRef<str>>(
    inputs: &[S],
    frames: Option<RangeInclusive<u64>>,
) -> Result<Vec<Frame>, SequenceError> {
    within(expand_all(inputs, false)?, frames)
}

/// Like [`expand`], but files with the same number are parts of one frame: all but the first are in
/// [`Frame::also`].
///
/// # Errors
/// Those of [`expand`], except [`SequenceError::Twice`].
pub fn expand_joined<S: AsRef<str>>(
    inputs: &[S],
    frames: Option<RangeInclusive<u64>>,
) -> Result<Vec<Frame>, SequenceError> {
    within(expand_all(inputs, true)?, frames)
}

fn expand_all<S: AsRef<str>>(inputs: &[S], join: bool) -> Result<Vec<Frame>, SequenceError> {
    if inputs.is_empty() {
        return Err(SequenceError::NoInput);
    }
    let mut paths = Vec::new();
    for input in inputs {
        paths.extend(expand_one(input.as_ref())?);
    }
    let mut named = Vec::new();
    for (path, said) in paths {
        let listed = index::frames(&path).map_err(|found| SequenceError::Pattern {
            pattern: path.display().to_string(),
            expected: format!("a list of files: {found}"),
        })?;
        match listed {
            Some(files) => named.extend(listed_frames(files)),
            None => named.push(Named::new(path, said.map(|number| (number, None)))),
        }
    }
    let said = |named: &Named| named.said.map(|(number, _)| number);
    let order = |a: &Named, b: &Named| a.cmp(b).then_with(|| a.path.cmp(&b.path));
    named.sort_by(|a, b| order(a, b).then(said(a).cmp(&said(b))));
    // A list may name a file at several times, such as walls that rest.
    named.dedup_by(|a, b| a.path == b.path && (said(a) == said(b) || !a.listed || !b.listed));
    if named.len() > 1
        && let Some((file, index)) =
            named.iter().take(2).find_map(|named| Some((&named.path, index::lists(&named.path)?)))
    {
        return Err(SequenceError::Piece { file: file.clone(), index });
    }

    // Files with the same time in a list are parts of one frame, written by several processes or for several
    // blocks.
    let listed = named.iter().all(|named| named.listed);
    let mut all = number(named);
    all.sort_by_key(|f| f.number);
    let mut found: Vec<Frame> = Vec::new();
    for b in all {
        let Some(a) = found.last_mut().filter(|a| a.number == b.number) else {
            found.push(b);
            continue;
        };
        if join || listed {
            a.also.push(b.path);
        } else {
            return Err(SequenceError::Twice {
                number: a.number,
                first: a.path.clone(),
                second: b.path.clone(),
                advice: advice(&a.path, &b.path),
            });
        }
    }
    Ok(found)
}

/// The frames whose numbers are in a range.
///
/// # Errors
/// [`SequenceError::OutsideRange`] if there is none.
pub fn within(
    mut found: Vec<Frame>,
    frames: Option<RangeInclusive<u64>>,
) -> Result<Vec<Frame>, SequenceError> {
    let Some(range) = frames else {
        return Ok(found);
    };
    let (count, lowest, highest) =
        (found.len(), found.first().map_or(0, |f| f.number), found.last().map_or(0, |f| f.number));
    let below = found.iter().map(|f| f.number).filter(|n| n < range.start()).max();
    let above = found.iter().map(|f| f.number).filter(|n| n > range.end()).min();
    found.retain(|f| range.contains(&f.number));
    if found.is_empty() {
        return Err(SequenceError::OutsideRange {
            first: *range.start(),
            last: *range.end(),
            count,
            below,
            above,
            lowest,
            highest,
        });
    }
    Ok(found)
}

/// Expands one input to files, with their numbers if the input determines them.
fn expand_one(input: &str) -> Result<Vec<(PathBuf, Option<u64>)>, SequenceError> {
    let path = Path::new(input);
    if path.is_dir() {
        return Err(SequenceError::Directory { input: input.trim_end_matches('/').into() });
    }
    let exists = path.try_exists();
    if matches!(exists, Ok(true)) {
        return Ok(vec![(path.to_path_buf(), None)]);
    }
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    if name.contains('%') {
        return expand_printf(input, path, &name);
    }
    if input.contains(['*', '?', '[']) {
        return Ok(expand_glob(input)?.into_iter().map(|path| (path, None)).collect());
    }
    Err(match exists {
        Err(reason) => SequenceError::Io { path: path.to_path_buf(), reason },
        Ok(_) => match is_file(path) {
            Err(told) => told,
            Ok(_) => SequenceError::NotFound { input: input.into() },
        },
    })
}

/// Whether `path` is a file; false if nothing is there. If it is a link to nothing, or its metadata cannot be read for
/// another reason, the result is an error, because the sequence would silently lack a frame.
fn is_file(path: &Path) -> Result<bool, SequenceError> {
    match std::fs::metadata(path) {
        Ok(found) => Ok(found.is_file()),
        Err(reason) if reason.kind() == std::io::ErrorKind::NotFound => {
            // Editors lock a file by a hidden link to nothing.
            let hidden = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
            match std::fs::read_link(path) {
                Ok(target) if !hidden => {
                    Err(SequenceError::Link { path: path.to_path_buf(), target })
                }
                _ => Ok(false),
            }
        }
        Err(reason) => Err(SequenceError::Io { path: path.to_path_buf(), reason }),
    }
}

fn expand_glob(input: &str) -> Result<Vec<PathBuf>, SequenceError> {
    let matches = glob::glob(input).map_err(|e| SequenceError::Pattern {
        pattern: input.into(),
        expected: format!("a pattern of *, ? and [...]: {e}"),
    })?;
    let mut paths = Vec::new();
    for entry in matches {
        let path = entry.map_err(|e| SequenceError::Io {
            path: e.path().to_path_buf(),
            reason: std::io::Error::new(e.error().kind(), e.error().to_string()),
        })?;
        if is_file(&path)? {
            paths.push(path);
        }
    }
    if paths.is_empty() {
        return Err(SequenceError::NoMatch {
            pattern: input.into(),
            near: near(Path::new(input).parent()),
        });
    }
    Ok(paths)
}

fn expand_printf(
    input: &str,
    path: &Path,
    name: &str,
) -> Result<Vec<(PathBuf, Option<u64>)>, SequenceError> {
    let bad = || SequenceError::Pattern {
        pattern: input.into(),
        expected: "one number such as %d or %04d in the file's name".into(),
    };
    let (prefix, rest) = name.split_once('%').ok_or_else(bad)?;
    let (spec, suffix) = rest.split_once('d').ok_or_else(bad)?;
    if suffix.contains('%') {
        return Err(bad());
    }
    let width: usize = match spec {
        "" => 1,
        spec => spec.strip_prefix('0').and_then(|w| w.parse().ok()).ok_or_else(bad)?,
    };
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let io = |reason| SequenceError::Io { path: folder.to_path_buf(), reason };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        let file = entry.file_name();
        let digits = file.to_str().and_then(|f| f.strip_prefix(prefix)?.strip_suffix(suffix));
        // Digits as printf would write the number: padded to the width, and not further.
        let all = |d: &&str| !d.is_empty() && d.bytes().all(|b| b.is_ascii_digit());
        let Some(digits) = digits.filter(all).map(str::to_string) else { continue };
        let wide = digits.len() > width && !digits.starts_with('0');
        let fits = digits.len() == width || wide;
        if fits && is_file(&entry.path())? {
            // Joined to the given path, so that messages show the user's spelling.
            paths.push((path.with_file_name(file), digits.parse().ok()));
        }
    }
    if paths.is_empty() {
        return Err(SequenceError::NoMatch { pattern: input.into(), near: near(Some(folder)) });
    }
    Ok(paths)
}

/// Lists similar names in a folder, for the error that nothing matches.
fn near(folder: Option<&Path>) -> String {
    let folder = match folder {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let Ok(entries) = std::fs::read_dir(folder) else {
        return format!("the folder {} cannot be read; check its name", folder.display());
    };
    let mut names: Vec<_> =
        entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    match names.first() {
        Some(first) => {
            format!("{} has {} entries, the first is {first}", folder.display(), names.len())
        }
        None => format!("{} is empty", folder.display()),
    }
}

/// What to do with two files with the same number.
fn advice(first: &Path, second: &Path) -> String {
    let name = |path: &Path| path.file_name().map(|n| n.to_string_lossy().into_owned());
    let (a, b) = (name(first).unwrap_or_default(), name(second).unwrap_or_default());
    let text = |name: &str| name.chars().filter(|c| !c.is_ascii_digit()).collect::<String>();
    if text(&a) == text(&b) {
        let index = "name the file that lists them (.pvtu, .pvtp, .pvd), join them (--join of the tool), or narrow \
                     the pattern to one sequence";
        return format!("if these are pieces of one frame, {index}");
    }
    // The frame's number is usually the last in the name.
    let end = a.rfind(|c: char| c.is_ascii_digit()).map_or(0, |i| i + 1);
    let (head, tail) = a.split_at_checked(end).unwrap_or_default();
    let pattern = format!("{}*{tail}", head.trim_end_matches(|c: char| c.is_ascii_digit()));
    format!(
        "narrow the pattern to one sequence, such as '{}', or join them (--join of the tool)",
        first.with_file_name(pattern).display()
    )
}

/// A number in a name.
#[derive(Debug, Clone, PartialEq)]
struct Number {
    value: f64,
    /// Its value as an integer, if it has no sign, point or exponent.
    whole: Option<u64>,
    /// Number of characters.
    width: usize,
    /// The integers before and after the decimal point, and the number of digits after it; `None` if the number
    /// has no point, or has a sign or an exponent.
    pair: Option<(u64, u64, usize)>,
    /// Whether it has a point or an exponent.
    decimal: bool,
}

/// A part of a name: a number or the text between two numbers.
#[derive(Debug, Clone, PartialEq)]
enum Part {
    Text(String),
    Number(Number),
}

/// A file. `levels` holds the name of the file without extension, the name of its folder, of the folder above,
/// and so on, each split into numbers and text.
struct Named {
    levels: Vec<Vec<Part>>,
    /// The frame's number and time, if a list of files or a `%d` in the input determines them; `None` if only the
    /// name can tell.
    said: Option<(u64, Option<f64>)>,
    /// Whether they come from a list of files.
    listed: bool,
    path: PathBuf,
}

/// Files of a list, numbered from 0 in the order of their times.
fn listed_frames(mut files: Vec<(PathBuf, Option<f64>)>) -> Vec<Named> {
    let timed = files.iter().all(|(_, time)| time.is_some());
    if timed {
        files.sort_by(|a, b| a.1.unwrap_or_default().total_cmp(&b.1.unwrap_or_default()));
    }
    let mut frames: Vec<Named> = Vec::new();
    for (path, time) in files {
        let last = frames.last().and_then(|frame| frame.said);
        let number = match last {
            Some((number, before)) if timed && before == time => number,
            Some((number, _)) => number + 1,
            None => 0,
        };
        let named = Named::new(path, Some((number, time)));
        frames.push(Named { listed: true, ..named });
    }
    frames
}

impl Named {
    fn new(path: PathBuf, said: Option<(u64, Option<f64>)>) -> Self {
        let mut names =
            path.components().rev().map(|c| c.as_os_str().to_string_lossy().into_owned());
        let mut levels = vec![parts(stem(&names.next().unwrap_or_default()))];
        levels.extend(names.map(|name| parts(&name)));
        Self { levels, said, listed: false, path }
    }

    fn cmp(&self, other: &Self) -> Ordering {
        let all = |named: &Self| named.levels.len();
        let folders = self.levels.iter().skip(1).rev().zip(other.levels.iter().skip(1).rev());
        let mut order = all(self).cmp(&all(other));
        order = folders.fold(order, |order, (a, b)| order.then_with(|| compare(a, b)));
        match (self.levels.first(), other.levels.first()) {
            (Some(a), Some(b)) => order.then_with(|| compare(a, b)),
            _ => order,
        }
    }

    /// The numbers in one name of the path (`level` 0 is the file, 1 its folder), without process ranks, and whether
    /// the name has a process rank.
    fn numbers(&self, level: usize) -> (Vec<&Number>, bool) {
        let (mut numbers, mut ranked, mut before) = (Vec::new(), false, "");
        for part in self.levels.get(level).into_iter().flatten() {
            match part {
                Part::Number(number) if !is_rank(before) => numbers.push(number),
                Part::Number(_) => ranked = true,
                Part::Text(text) => before = text,
            }
        }
        (numbers, ranked)
    }
}

/// Words before a process rank; each process writes a part of each frame.
const RANKS: [&str; 9] =
    ["rank", "proc", "processor", "process", "piece", "mpi", "cpu", "subdomain", "thread"];

/// Whether `text` ends in a word such as `rank` or `proc`, so that a number after it is a process rank, as in
/// `fluid_10_rank0`. Each process writes a part of each frame.
pub fn is_rank(text: &str) -> bool {
    let text = text.trim_end_matches(['_', '-', '.', '=']);
    let word = text.rsplit(|c: char| !c.is_ascii_alphabetic()).next().unwrap_or(text);
    RANKS.iter().any(|rank| word.eq_ignore_ascii_case(rank))
}

/// The name of a file without extension, and without a second one if the last is `gz` or `sc`.
fn stem(name: &str) -> &str {
    let cut = |name: &str| {
        let (stem, extension) = name.rsplit_once('.')?;
        let letter = extension.starts_with(|c: char| c.is_ascii_alphabetic());
        (letter && !stem.is_empty()).then_some((stem.len(), matches!(extension, "gz" | "sc")))
    };
    let Some((end, packed)) = cut(name) else { return name };
    let stem = name.get(..end).unwrap_or(name);
    match cut(stem).filter(|_| packed) {
        Some((end, _)) => stem.get(..end).unwrap_or(stem),
        None => stem,
    }
}

/// Number of digits at the start.
fn digits(text: &str) -> usize {
    text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len())
}

/// Splits a name into numbers and text.
fn parts(name: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut text = String::new();
    let mut rest = name;
    while let Some(first) = rest.chars().next() {
        let sign = first == '-' && !text.ends_with(|c: char| c.is_alphanumeric()) && {
            // The first minus of `step-1` is a separator, the second of `step--1` is a sign.
            !text.is_empty() || parts.is_empty()
        };
        let unsigned = rest.get(usize::from(sign)..).unwrap_or_default();
        let Some(mut number) = Number::parse(unsigned) else {
            text.push(first);
            rest = rest.get(first.len_utf8()..).unwrap_or_default();
            continue;
        };
        if sign {
            number = Number { value: -number.value, whole: None, pair: None, ..number };
        }
        rest = unsigned.get(number.width..).unwrap_or_default();
        if !text.is_empty() {
            parts.push(Part::Text(std::mem::take(&mut text)));
        }
        parts.push(Part::Number(number));
    }
    if !text.is_empty() {
        parts.push(Part::Text(text));
    }
    parts
}

impl Number {
    /// Parses the number at the start of a text. `00008.0000` is two numbers, and so is `1.2.3`.
    fn parse(text: &str) -> Option<Self> {
        let integer = digits(text);
        let whole = text.get(..integer)?;
        let plain: u64 = whole.parse().ok()?;
        let behind = |at: usize| text.get(at..).unwrap_or_default();
        let mut end = integer;
        let mut pair = None;
        let fraction = behind(integer).strip_prefix('.').map_or(0, digits);
        let padded = whole.len() > 1 && whole.starts_with('0');
        let dotted =
            behind(integer + 1 + fraction).strip_prefix('.').is_some_and(|t| digits(t) > 0);
        if fraction > 0 && !padded && !dotted {
            end = integer + 1 + fraction;
            let digits = text.get(integer + 1..end)?;
            pair = digits.parse().ok().map(|behind| (plain, behind, fraction));
        }
        // `2e4` is part of a name; `2e+04` and `2.0e4` are numbers.
        if let Some(exponent) = behind(end).strip_prefix(['e', 'E']) {
            let signed = exponent.starts_with(['+', '-']);
            let count = exponent.get(usize::from(signed)..).map_or(0, digits);
            let last = end + 1 + usize::from(signed) + count;
            let ends = !behind(last).starts_with(|c: char| c.is_alphanumeric());
            if count > 0 && ends && (signed || end > integer) {
                end = last;
                pair = None;
            }
        }
        let decimal = end > integer;
        let value = text.get(..end)?.parse().ok()?;
        Some(Self { value, whole: Some(plain).filter(|_| !decimal), width: end, pair, decimal })
    }

    fn cmp(&self, other: &Self) -> Ordering {
        let whole = || Some(self.whole?.cmp(&other.whole?));
        let order = whole().unwrap_or_else(|| self.value.total_cmp(&other.value));
        order.then(self.width.cmp(&other.width))
    }
}

fn compare(a: &[Part], b: &[Part]) -> Ordering {
    for (a, b) in a.iter().zip(b) {
        let order = match (a, b) {
            (Part::Text(a), Part::Text(b)) => a.cmp(b),
            (Part::Number(a), Part::Number(b)) => a.cmp(b),
            (Part::Number(_), Part::Text(_)) => Ordering::Less,
            (Part::Text(_), Part::Number(_)) => Ordering::Greater,
        };
        if order != Ordering::Equal {
            return order;
        }
    }
    a.len().cmp(&b.len())
}

/// The number in each file's name that distinguishes it from the others. `None` if a name has no number, or if it is
/// unclear which of its numbers counts the frames.
fn telling(named: &[Named]) -> Option<Vec<Number>> {
    let depth = named.iter().map(|named| named.levels.len()).min().unwrap_or(0);
    for level in 0..depth {
        let ranked = named.iter().any(|named| named.numbers(level).1);
        let numbers: Vec<_> = named.iter().map(|named| named.numbers(level).0).collect();
        let runs = numbers.first().map_or(0, Vec::len);
        let same = numbers.iter().all(|n| n.len() == runs);
        let first = |run: usize| numbers.first().and_then(|first| first.get(run).copied());
        let differs = |run: &usize| numbers.iter().any(|n| n.get(*run).copied() != first(*run));
        // The last number that differs between files. `None` if the names do not have equally many numbers;
        // then the last number of each name counts.
        let run = (0..runs).rev().find(differs).filter(|_| same);
        // A hash or the seconds of an hour may follow the frame's number. Then the files, which are sorted by
        // all numbers in their names, are not in the order of the last one.
        let values = |run: usize| numbers.iter().map(move |n| n.get(run).map(|n| n.value));
        let sorted = |run: usize| values(run).is_sorted();
        let single = |run: usize| {
            let mut bits: Vec<_> = values(run).map(|v| v.map(f64::to_bits)).collect();
            bits.sort_unstable();
            bits.windows(2).all(|pair| pair.first() != pair.last())
        };
        let run = match run {
            Some(last) if !sorted(last) && single(last) => {
                let first = (0..last).find(differs);
                Some(first.filter(|first| sorted(*first) && single(*first))?)
            }
            run => run,
        };
        let own = |n: &Vec<&Number>| match run {
            Some(run) => n.get(run).copied().cloned(),
            None => n.last().copied().cloned(),
        };
        let alike = same && run.is_none();
        if !alike || (level == 0 && named.len() == 1 && runs > 0) {
            return numbers.iter().map(own).collect();
        }
        // Files with the same name in many folders.
        let names = named.iter().map(|named| named.levels.get(level));
        let text = |parts: Option<&Vec<Part>>| parts.cloned();
        let other = names.clone().any(|n| text(n) != text(names.clone().next().flatten()));
        if other {
            if runs == 0 && ranked {
                // Parts of one frame.
                return Some(vec![Number::parse("0")?; named.len()]);
            }
            return if runs > 0 { numbers.iter().map(own).collect() } else { None };
        }
    }
    None
}

/// Assigns numbers to files; files without a number are counted in their order.
fn number(mut named: Vec<Named>) -> Vec<Frame> {
    if named.iter().all(|named| named.said.is_some()) {
        let frame = |named: Named| {
            let (number, time) = named.said.unwrap_or_default();
            Frame::new(number, time, named.path)
        };
        return named.into_iter().map(frame).collect();
    }
    let Some(numbers) = telling(&named) else {
        let frame = |(i, named): (usize, Named)| Frame::new(i as u64, None, named.path);
        return named.into_iter().enumerate().map(frame).collect();
    };
    let whole: Option<Vec<u64>> = numbers.iter().map(|number| number.whole).collect();
    if let Some(whole) = whole {
        let frame = |(named, number): (Named, u64)| Frame::new(number, None, named.path);
        return named.into_iter().zip(whole).map(frame).collect();
    }
    // Programs write times either with a fixed number of decimals or without zeros at the end. In names that do
    // neither, `1.10` is therefore the pair of integers 1 and 10, which follows `1.9`.
    let pairs: Option<Vec<_>> = numbers.iter().map(|number| number.pair).collect();
    let widths = |pairs: &[(u64, u64, usize)]| {
        let first = pairs.first().map_or(0, |pair| pair.2);
        let zero = pairs.iter().any(|(_, behind, _)| behind.is_multiple_of(10) && *behind > 0);
        pairs.iter().any(|pair| pair.2 != first) && zero
    };
    let pairs = pairs.filter(|pairs| widths(pairs));
    let decimal = numbers.iter().any(|number| number.decimal) && pairs.is_none();
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    let key = |i: usize| -> (Option<(u64, u64)>, f64) {
        let pair = pairs.as_ref().and_then(|pairs| pairs.get(i)).map(|pair| (pair.0, pair.1));
        (pair, numbers.get(i).map_or(0.0, |number| number.value))
    };
    let by = |a: &usize, b: &usize| {
        let (a, b) = (key(*a), key(*b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    };
    order.sort_by(by);
    let mut frames = Vec::new();
    let mut last: Option<(usize, u64)> = None;
    for i in order {
        // Files with the same time have the same number.
        let number = match last {
            Some((before, number)) if by(&before, &i) == Ordering::Equal => number,
            Some((_, number)) => number + 1,
            None => 0,
        };
        last = Some((i, number));
        let time = numbers.get(i).map(|number| number.value).filter(|_| decimal);
        if let Some(named) = named.get_mut(i) {
            frames.push(Frame::new(number, time, std::mem::take(&mut named.path)));
        }
    }
    frames
}
