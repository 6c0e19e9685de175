//! Expands inputs to frames, and advises if nothing matches.

use std::ops::RangeInclusive;

use whitewater::io::particles::sequence::{self, Frame, SequenceError};
use whitewater::io::particles::{self, Step};

use crate::failure::{Failure, Outcome};
use crate::folder::in_folder;

/// The frames of one sequence, or of one file that holds several frames. A folder stands for the
/// sequence in it. If no file matches an input, the error suggests a pattern that would match. With `join`, files
/// with the same number are one frame.
pub fn expand(inputs: &[String], join: bool) -> Outcome<Vec<Frame>> {
    Ok(in_files(files(inputs, join)?))
}

/// The same without opening files.
pub fn files(inputs: &[String], join: bool) -> Outcome<Vec<Frame>> {
    let inputs = inputs.iter().map(|input| in_folder(input)).collect::<Outcome<Vec<_>>>()?;
    let expand = if join { sequence::expand_joined } else { sequence::expand };
    expand(&inputs, None).map_err(advised)
}

/// The frames in a range of numbers.
pub fn within(all: &[Frame], range: Option<RangeInclusive<u64>>) -> Outcome<Vec<Frame>> {
    Ok(sequence::within(all.to_vec(), range)?)
}

/// Replaces a single file that holds several frames by these frames.
pub fn in_files(frames: Vec<Frame>) -> Vec<Frame> {
    let [frame] = frames.as_slice() else { return frames };
    if !frame.also.is_empty() {
        return frames;
    }
    // If the file cannot be read, the error is reported when it is drawn.
    let steps = particles::steps(&frame.path).unwrap_or_default();
    if steps.is_empty() {
        return frames;
    }
    let of = |step: Step| Frame {
        number: step.index as u64,
        time: step.time,
        in_seconds: false,
        step: Some(step),
        ..frame.clone()
    };
    steps.into_iter().map(of).collect()
}

/// Makes a failure of an error about the input files, with advice if the file pattern has the wrong padding of the
/// number or the placeholder of another program.
pub fn advised(error: SequenceError) -> Failure {
    let advice = match &error {
        SequenceError::NotFound { input } => foreign(input),
        SequenceError::NoMatch { pattern, .. } => padded(pattern).or_else(|| foreign(pattern)),
        SequenceError::Pattern { pattern, .. } => foreign(pattern),
        _ => None,
    };
    let failure = Failure::from(error);
    match advice {
        Some(advice) => Failure { message: format!("{}; {advice}", failure.message), ..failure },
        None => failure,
    }
}

/// Placeholders for the frame number in other programs, recognised only for advice: `{}` of Rust
/// and Python, `$F` of Houdini, `#`, `<>` and `@` of Nuke and Maya, and `%4d` of printf.
const FOREIGN: [&str; 6] = ["{", "#", "$F", "<", "@", "%"];

/// Advice with the equivalent pattern, if the pattern has a placeholder of another program.
fn foreign(pattern: &str) -> Option<String> {
    let (folder, name) = match pattern.rsplit_once('/') {
        Some((folder, name)) => (format!("{folder}/"), name),
        None => (String::new(), pattern),
    };
    let (at, mark) = FOREIGN.iter().filter_map(|mark| Some((name.find(mark)?, *mark))).min()?;
    let (before, rest) = name.split_at(at);
    let end = match mark {
        "{" => rest.find('}')? + 1,
        "<" => rest.find('>')? + 1,
        "$F" => 2 + rest[2..].bytes().take_while(u8::is_ascii_digit).count(),
        "%" => rest.find('d')? + 1,
        mark => rest.len() - rest.trim_start_matches(mark).len(),
    };
    let mut name = before.to_string() + "%d" + &rest[end..];
    // The number is padded as the files are.
    let fits = |name: &str| sequence::expand(&[format!("{folder}{name}")], None).is_ok();
    if !fits(&name) {
        let padded = (2..=10).map(|width| name.replace("%d", &format!("%0{width}d")));
        name = padded.into_iter().find(|name| fits(name)).unwrap_or(name);
    }
    let found = if fits(&name) { "" } else { ", or * for any text" };
    Some(format!(
        "write the frame number as %d, or as %04d if it has four digits{found}: '{folder}{name}'"
    ))
}

/// Advice with another padding of the frame number, if files match it.
fn padded(pattern: &str) -> Option<String> {
    let (before, rest) = pattern.rsplit_once('%')?;
    let (spec, after) = rest.split_once('d')?;
    if !spec.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let specs = std::iter::once(String::new()).chain((2..=10).map(|width| format!("0{width}")));
    let others = specs.filter(|other| other != spec);
    others.map(|other| format!("{before}%{other}d{after}")).find_map(|other| {
        let count = sequence::expand(std::slice::from_ref(&other), None).ok()?.len();
        let files = if count == 1 { "file fits" } else { "files fit" };
        let how = if other.contains("%d") { " (their numbers have no zeros in front)" } else { "" };
        Some(format!("{count} {files} '{other}'{how}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_of_other_programs_are_told() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        for name in ["u_8.bgeo", "u_9.bgeo", "u_10.bgeo", "p_0008.bgeo", "p_0009.bgeo"] {
            std::fs::write(at(name), "").unwrap();
        }
        let said = |name: &str| expand(&[at(name)], false).unwrap_err().message;
        for name in [
            "u_{}.bgeo",
            "u_{:04d}.bgeo",
            "u_####.bgeo",
            "u_$F4.bgeo",
            "u_$F.bgeo",
            "u_<f>.bgeo",
            "u_%4d.bgeo",
        ] {
            let text = said(name);
            assert!(text.ends_with("u_%d.bgeo'") && text.contains("%04d"), "{name}: {text}");
        }
        assert!(said("p_####.bgeo").ends_with("p_%04d.bgeo'"), "{}", said("p_####.bgeo"));
        assert!(
            said("none_####.bgeo").contains("or * for any text: "),
            "{}",
            said("none_####.bgeo")
        );
        let text = said("u_%04d.bgeo");
        assert!(text.contains("3 files fit") && text.contains("u_%d.bgeo' (their"), "{text}");
        assert!(said("p_%d.bgeo").contains("2 files fit"), "{}", said("p_%d.bgeo"));
        // A name without a placeholder.
        assert!(!said("a.bgeo").contains("%d.bgeo'"), "{}", said("a.bgeo"));
    }
}
