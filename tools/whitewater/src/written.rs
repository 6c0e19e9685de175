//! No file is written over one that is read.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::args::DrawArgs;
use crate::failure::{Failure, Outcome};
use crate::output::{Output, Target};
use crate::settings::SettingsFile;

/// Fails if a file that an option names as output is one of the files that are read, however the paths are spelled.
pub fn check<'a>(
    written: impl IntoIterator<Item = (&'static str, PathBuf)>,
    read: impl IntoIterator<Item = &'a Path>,
) -> Outcome<()> {
    // What does not exist is no input. A link is written through.
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let existing = |(flag, path): (&'static str, PathBuf)| Some((flag, real(&path)?, path));
    let written: Vec<_> = written.into_iter().filter_map(existing).collect();
    if written.is_empty() {
        return Ok(());
    }
    let read: HashSet<PathBuf> = read.into_iter().filter_map(real).collect();
    match written.iter().find(|(_, real, _)| read.contains(real)) {
        Some((flag, _, path)) => {
            let path = path.display();
            Err(Failure::usage(format!("{flag}: {path} is an input; name another file")))
        }
        None => Ok(()),
    }
}

/// The files with measurements.
pub fn measured(args: &DrawArgs) -> impl Iterator<Item = (&'static str, PathBuf)> {
    let timings = args.timings.iter().map(|path| ("--timings", path.clone()));
    timings.chain(args.trace.iter().map(|path| ("--trace", path.clone())))
}

/// Fails if pictures or measurements would be written over the settings, the environment, the pictures that the
/// settings name, or one of the files `others`, or two of them to one file.
pub fn check_pictures(args: &DrawArgs, others: &[Option<&Path>]) -> Outcome<()> {
    let mut named: Vec<PathBuf> = Vec::new();
    let outputs = args.outputs.iter().map(|path| ("--output", path.clone()));
    for (flag, path) in outputs.chain(measured(args)) {
        if named.contains(&path) {
            let path = path.display();
            let why = format!("{flag}: {path} is named twice; name another file");
            return Err(Failure::usage(why));
        }
        named.push(path);
    }
    let settings = SettingsFile::of_args(args)?;
    let environment = Some(Path::new(&args.environment)).filter(|path| *path != "sky");
    let read: Vec<&Path> = (others.iter().copied().flatten())
        .chain(args.settings.as_deref())
        .chain(environment)
        .chain(settings.files())
        .collect();
    // Of the frames of a sequence, those that an input's name could be.
    let digits = |path: &Path| -> Vec<u64> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name.split(|c: char| !c.is_ascii_digit()).filter_map(|word| word.parse().ok()).collect()
    };
    let numbers: Vec<u64> = read.iter().flat_map(|path| digits(path)).chain([0]).collect();
    let mut written = Vec::new();
    for output in &args.outputs {
        for sequence in [false, true] {
            // An output that no frame can be written to is reported elsewhere.
            let Ok(target) = Target::<Output>::of_frames(output, sequence) else { continue };
            written.extend(numbers.iter().map(|number| ("--output", target.path(*number))));
        }
    }
    check(written.into_iter().chain(measured(args)), read)
}
