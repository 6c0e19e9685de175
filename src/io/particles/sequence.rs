//! Expands user input to numbered frames.

mod inputs;
mod names;
mod order;

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use super::index;
use super::steps::Step;
use inputs::expand_one;
pub use names::{is_rank, time_unit};
use order::{Named, listed_frames, number};

/// One file of a sequence.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Number in the file's name, or in its folder's name if all files are named alike. If there is no such number, or
    /// a time instead, or if a list of files gives the order, the frame's index in the sequence, from 0.
    pub number: u64,
    /// Time of the frame; `None` if neither a list nor the names tell it. It is in seconds if the numbers in the names
    /// of the files or their folders have a unit (`t_900us`, `0.5s/cloud`; see [`time_unit`]). Otherwise it is in the
    /// unit of the files' author: from a list of files (`.pvd`, `.series`), or from a number with a decimal point or an
    /// exponent in a name (`t0.32`, `0.32/cloud`, `4.0e-04`).
    pub time: Option<f64>,
    /// Whether the time is in seconds, as a unit in the name says.
    pub in_seconds: bool,
    /// The file.
    pub path: PathBuf,
    /// Other files with particles of the same frame.
    pub also: Vec<PathBuf>,
    /// Which frame of the file this is, if the file holds several. [`expand`] leaves it `None`, because it does not
    /// read files of particles.
    pub step: Option<Step>,
}

impl Frame {
    fn new(number: u64, time: Option<f64>, path: PathBuf) -> Self {
        Self { number, time, in_seconds: false, path, also: Vec::new(), step: None }
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

/// Reads a range of frames: `A-B` is A to B, both included; `A` is frame A alone.
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

/// Expands inputs to the frames of one sequence, in the order of their numbers. With `frames`, only those with a number
/// in this range are returned.
///
/// An input is a file, a list of files with times (ParaView's `.pvd` and `.series`), a pattern with `*`, `?` or
/// `[...]`, or one with `%d` or `%04d` in the file name. A name that exists is taken literally. All inputs
/// together are one sequence, so a pattern that the shell has expanded gives the same result. A frame's number
/// is the last run of digits in its name that differs between files, so `run2_frame_10` is frame 10; for a
/// pattern with `%d` it is the number there. If all file names are alike, the number is in their folders
/// (`10/cloud.vtp`). A number with a decimal point or an exponent is a time. A minus belongs to a number if it
/// follows a separator (`step--1` is -1). Times order the frames, which are then counted from 0. Whole numbers with one
/// unit of time (`t_5ms`, `t_10ms`) stay the frames' numbers; if the units differ (`t_900us`, `t_1ms`), the times order
/// the frames. A number after `rank`, `proc` and the like is that of a process, whose file is a part of a frame.
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
            None => named.push(Named::new(path, said)),
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
    let mut all = number(named)?;
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

/// The frames of `found` whose numbers are in the range `frames`. With `None` there is no range, and all of `found`
/// is returned.
///
/// # Errors
/// [`SequenceError::OutsideRange`] if there is a range and no frame is in it.
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
