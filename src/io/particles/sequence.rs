//! From what a user names to numbered frames.

use std::cmp::Ordering;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// One file of a sequence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// The number in its name; where names have none, its place in the order, from 0.
    pub number: u64,
    /// The file.
    pub path: PathBuf,
}

/// Why inputs give no frames.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// Nothing was named.
    #[error("no input; name a file, a pattern such as 'fluid_*.bgeo', or 'fluid_%04d.bgeo'")]
    NoInput,
    /// A plain name that is no file.
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
    /// A pattern that fits no file.
    #[error("{pattern}: no file fits; {near}")]
    NoMatch {
        /// As given.
        pattern: String,
        /// What is there instead.
        near: String,
    },
    /// A pattern that cannot be understood.
    #[error("{pattern}: expected {expected}")]
    Pattern {
        /// As given.
        pattern: String,
        /// What it should be.
        expected: String,
    },
    /// All files lie outside the range.
    #[error(
        "no frame from {first} to {last}: the {count} files found are frames {lowest} to {highest}"
    )]
    OutsideRange {
        /// Of the range.
        first: u64,
        /// Of the range.
        last: u64,
        /// Files found.
        count: usize,
        /// Smallest number found.
        lowest: u64,
        /// Largest number found.
        highest: u64,
    },
    /// Two files of one number.
    #[error("{} and {} are both frame {number}; narrow the pattern to one sequence", first.display(), second.display())]
    Twice {
        /// The number.
        number: u64,
        /// One file.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
    /// The folder or a file could not be looked at.
    #[error("cannot list {}: {reason}; check the name and the permissions", path.display())]
    Io {
        /// What was being listed.
        path: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
}

/// Reads a range of frames, `A-B` (both included) or `A`.
///
/// # Errors
/// [`SequenceError::Pattern`] where it is none of these, or `B` is less than `A`.
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
/// An input is a file, a pattern with `*`, `?` or `[...]`, or one with `%d` or `%04d` in the file's name. A name
/// that is a file is taken as that file, whatever is in it. All inputs together are one sequence, so that a
/// pattern the shell has expanded gives the same as one it has not. The number of a frame is the run of digits
/// in its name that differs from file to file (the last such), so `run2_frame_10` is frame 10.
///
/// # Errors
/// Says which input gave nothing, and what is there instead. Every input must give a file.
pub fn expand<S: AsRef<str>>(
    inputs: &[S],
    frames: Option<RangeInclusive<u64>>,
) -> Result<Vec<Frame>, SequenceError> {
    if inputs.is_empty() {
        return Err(SequenceError::NoInput);
    }
    let mut paths = Vec::new();
    for input in inputs {
        paths.extend(expand_one(input.as_ref())?);
    }
    let mut named: Vec<(Vec<Part>, PathBuf)> = paths.into_iter().map(|p| (parts(&p), p)).collect();
    named.sort_by(|a, b| compare(&a.0, &b.0).then_with(|| a.1.cmp(&b.1)));
    named.dedup_by(|a, b| a.1 == b.1);

    let mut found = number(named);
    found.sort_by_key(|f| f.number);
    for pair in found.windows(2) {
        if let [a, b] = pair
            && a.number == b.number
        {
            return Err(SequenceError::Twice {
                number: a.number,
                first: a.path.clone(),
                second: b.path.clone(),
            });
        }
    }
    let Some(range) = frames else {
        return Ok(found);
    };
    let (count, lowest, highest) =
        (found.len(), found.first().map_or(0, |f| f.number), found.last().map_or(0, |f| f.number));
    found.retain(|f| range.contains(&f.number));
    if found.is_empty() {
        return Err(SequenceError::OutsideRange {
            first: *range.start(),
            last: *range.end(),
            count,
            lowest,
            highest,
        });
    }
    Ok(found)
}

fn expand_one(input: &str) -> Result<Vec<PathBuf>, SequenceError> {
    let path = Path::new(input);
    if path.is_dir() {
        return Err(SequenceError::Directory { input: input.trim_end_matches('/').into() });
    }
    if path.exists() {
        return Ok(vec![path.to_path_buf()]);
    }
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    if name.contains('%') {
        return expand_printf(input, path, &name);
    }
    if input.contains(['*', '?', '[']) {
        return expand_glob(input);
    }
    Err(SequenceError::NotFound { input: input.into() })
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
        if path.is_file() {
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

fn expand_printf(input: &str, path: &Path, name: &str) -> Result<Vec<PathBuf>, SequenceError> {
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
        // As printf would write the number: padded to the width, and no further.
        let fits = digits.is_some_and(|d| {
            !d.is_empty()
                && d.bytes().all(|b| b.is_ascii_digit())
                && (d.len() == width || (d.len() > width && !d.starts_with('0')))
        });
        if fits && entry.path().is_file() {
            // Joined to what was given, so that messages show the user's spelling.
            paths.push(path.with_file_name(file));
        }
    }
    if paths.is_empty() {
        return Err(SequenceError::NoMatch { pattern: input.into(), near: near(Some(folder)) });
    }
    Ok(paths)
}

/// What a folder has, for the message that nothing fits.
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

/// A run of a name.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Text(String),
    /// Value, and how many digits it was written with.
    Number(u64, usize),
}

/// The runs of the file's name without its extension, after its folder.
fn parts(path: &Path) -> Vec<Part> {
    let folder = path.parent().map(|p| p.to_string_lossy().into_owned());
    let mut parts = vec![Part::Text(folder.unwrap_or_default())];
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    // Up to the first dot that letters follow: `frame_1.5.bgeo.gz` keeps `frame_1.5`.
    let stem_end = name
        .match_indices('.')
        .find(|(i, _)| {
            let next = name.get(i + 1..).and_then(|rest| rest.chars().next());
            *i > 0 && next.is_some_and(|c| !c.is_ascii_digit())
        })
        .map_or(name.len(), |(i, _)| i);
    let (stem, _) = name.split_at_checked(stem_end).unwrap_or((&name, ""));
    let mut rest = stem;
    while let Some(first) = rest.chars().next() {
        let digit = first.is_ascii_digit();
        let end = rest.find(|c: char| c.is_ascii_digit() != digit).unwrap_or(rest.len());
        let (run, tail) = rest.split_at_checked(end).unwrap_or((rest, ""));
        match run.parse() {
            Ok(value) if digit => parts.push(Part::Number(value, run.len())),
            _ => parts.push(Part::Text(run.to_string())),
        }
        rest = tail;
    }
    parts
}

fn compare(a: &[Part], b: &[Part]) -> Ordering {
    for (a, b) in a.iter().zip(b) {
        let order = match (a, b) {
            (Part::Text(a), Part::Text(b)) => a.cmp(b),
            (Part::Number(a, m), Part::Number(b, n)) => a.cmp(b).then(m.cmp(n)),
            (Part::Number(..), Part::Text(_)) => Ordering::Less,
            (Part::Text(_), Part::Number(..)) => Ordering::Greater,
        };
        if order != Ordering::Equal {
            return order;
        }
    }
    a.len().cmp(&b.len())
}

/// Gives each file its number; files without one are counted in their order.
fn number(named: Vec<(Vec<Part>, PathBuf)>) -> Vec<Frame> {
    let numbers: Vec<Vec<u64>> = named
        .iter()
        .map(|(parts, _)| {
            parts
                .iter()
                .filter_map(|p| match p {
                    Part::Number(value, _) => Some(*value),
                    Part::Text(_) => None,
                })
                .collect()
        })
        .collect();
    let runs = numbers.first().map_or(0, Vec::len);
    let same_runs = numbers.iter().all(|n| n.len() == runs);
    // The last run that differs; the last run where none does (one file) or names are built differently.
    let differing = (0..runs).rev().find(|i| {
        same_runs && numbers.iter().any(|n| n.get(*i) != numbers.first().and_then(|f| f.get(*i)))
    });
    let counted = numbers.iter().any(Vec::is_empty);
    named
        .into_iter()
        .zip(numbers)
        .enumerate()
        .map(|(i, ((_, path), numbers))| {
            let own = match differing {
                Some(run) => numbers.get(run),
                None => numbers.last(),
            };
            let number = match own {
                Some(number) if !counted => *number,
                _ => i as u64,
            };
            Frame { number, path }
        })
        .collect()
}
