//! Expands an input (a file, a pattern) to files.

use std::path::{Path, PathBuf};

use super::SequenceError;
use super::names;

/// A file, and the frame's number and time if the input determines them.
type Found = (PathBuf, Option<(u64, Option<f64>)>);

/// Expands one input to files.
pub(super) fn expand_one(input: &str) -> Result<Vec<Found>, SequenceError> {
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

fn expand_printf(input: &str, path: &Path, name: &str) -> Result<Vec<Found>, SequenceError> {
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
            let number = digits.parse().ok();
            let found = number.map(|number| (number, names::seconds(number, suffix)));
            paths.push((path.with_file_name(file), found));
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
