//! Input files, and what to do if nothing matches.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::Path;

use whitewater::io::particles::sequence::{self, Frame, SequenceError};
use whitewater::io::particles::{self, Step};

use crate::failure::{Failure, Outcome};

/// The frames of one sequence, or those of one file that holds several. A folder of one sequence is that; where nothing fits a
/// name, what would is said. `join`: files of one number are one frame.
pub fn expand(inputs: &[String], join: bool) -> Outcome<Vec<Frame>> {
    Ok(in_files(files(inputs, join)?))
}

/// The same without a look into files.
pub fn files(inputs: &[String], join: bool) -> Outcome<Vec<Frame>> {
    let inputs = inputs.iter().map(|input| in_folder(input)).collect::<Outcome<Vec<_>>>()?;
    let expand = if join { sequence::expand_joined } else { sequence::expand };
    expand(&inputs, None).map_err(advised)
}

/// Those of them that are in a range.
pub fn within(all: &[Frame], range: Option<RangeInclusive<u64>>) -> Outcome<Vec<Frame>> {
    Ok(sequence::within(all.to_vec(), range)?)
}

/// The frames of a file that holds several, in its place.
pub fn in_files(frames: Vec<Frame>) -> Vec<Frame> {
    let [frame] = frames.as_slice() else { return frames };
    if !frame.also.is_empty() {
        return frames;
    }
    // A file that can't be read tells when its turn comes.
    let steps = particles::steps(&frame.path).unwrap_or_default();
    if steps.is_empty() {
        return frames;
    }
    let of = |step: Step| Frame {
        number: step.index as u64,
        time: step.time,
        step: Some(step),
        ..frame.clone()
    };
    steps.into_iter().map(of).collect()
}

/// A failure to expand inputs, with advice where their form is that of another program.
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

/// Extensions of particle files; a second one, of packing, may follow.
const EXTENSIONS: [&str; 26] = [
    "bgeo",
    "geo",
    "vtk",
    "vtu",
    "vtp",
    "pvtu",
    "pvtp",
    "vtm",
    "ply",
    "npy",
    "npz",
    "csv",
    "txt",
    "dat",
    "xyz",
    "json",
    "dump",
    "lammpstrj",
    "tab",
    "h5",
    "hdf5",
    "vtkhdf",
    "h5part",
    "h5md",
    "xdmf",
    "xmf",
];

/// The input, or of a folder the pattern of the one sequence in it.
pub fn in_folder(input: &str) -> Outcome<String> {
    let path = Path::new(input);
    if !path.is_dir() {
        return Ok(input.to_string());
    }
    let folder = input.trim_end_matches('/');
    let folder = if folder.is_empty() { "/" } else { folder };
    let mut patterns: BTreeMap<String, usize> = BTreeMap::new();
    let (mut folders, mut others) = (Vec::new(), Vec::new());
    let io = |error| Failure::reading(path, &error);
    for entry in std::fs::read_dir(path).map_err(io)?.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') {
            continue;
        }
        if entry.path().is_dir() {
            folders.push(name);
        } else if readable(&name) {
            *patterns.entry(format!("{folder}/{}", pattern(&name))).or_default() += 1;
        } else {
            others.push(name);
        }
    }
    // Lists of the frames beside it name the same ones.
    let mut patterns: Vec<_> = patterns.into_iter().collect();
    patterns.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let shown = |(pattern, count): &(String, usize)| {
        format!("'{pattern}' ({count} {})", if *count == 1 { "file" } else { "files" })
    };
    match patterns.as_slice() {
        [] => {}
        [(pattern, _)] => return Ok(pattern.clone()),
        many => {
            let list: Vec<_> = many.iter().take(8).map(shown).collect();
            let why = format!(
                "{input} is a folder of several sequences: name one of {}",
                list.join(", ")
            );
            return Err(Failure::input(why));
        }
    }
    folders.sort();
    others.sort();
    let within = |name: &String| {
        let name = format!("{folder}/{name}");
        let inner = std::fs::read_dir(&name).into_iter().flatten().flatten();
        let any = inner.map(|entry| entry.file_name().to_string_lossy().into_owned());
        any.into_iter().any(|file| readable(&file)).then_some(name)
    };
    let inner: Vec<_> = folders.iter().filter_map(within).take(8).collect();
    let found = match (inner.is_empty(), others.first()) {
        (false, _) => format!("; there are some in {}", inner.join(", ")),
        (true, Some(first)) => {
            let known = others.iter().find_map(|name| Some((name, unread(name)?)));
            let first = known.map_or(first, |(name, _)| name);
            let advice = known.map_or(String::new(), |(_, advice)| format!("; {advice}"));
            format!(", found {} others, such as {first}{advice}", others.len())
        }
        (true, None) => String::new(),
    };
    Err(Failure::input(format!("{input}: expected particle files in the folder{found}")))
}

fn readable(name: &str) -> bool {
    let name = name.to_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
    // As LAMMPS names them: dump.500.
    EXTENSIONS.contains(&extension) || name.starts_with("dump.")
}

/// A name with `*` in the place of its last number.
fn pattern(name: &str) -> String {
    let stem =
        name.find('.').filter(|at| *at > 0 && !name.starts_with("dump.")).unwrap_or(name.len());
    let digits = |c: char| c.is_ascii_digit();
    // The number may be between two points.
    let (before, after) = match name[..stem].rfind(digits) {
        Some(last) => (last, last + 1),
        None => match name.rfind(digits) {
            Some(last) => (last, last + 1),
            None => return name.to_string(),
        },
    };
    let start = name[..=before].rfind(|c: char| !digits(c)).map_or(0, |at| at + 1);
    format!("{}*{}", &name[..start], &name[after..])
}

/// What to do with a file of a program that writes none of what is read here.
pub fn unread(name: &str) -> Option<&'static str> {
    let name = name.to_lowercase();
    let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
    Some(match extension {
        "bi4" | "ibi4" | "obi4" => {
            "DualSPHysics' own format: PartVTK -dirin FOLDER -savevtk PartFluid -onlytype:-all,+fluid writes VTK"
        }
        "pkl" | "pickle" => "a pickle: save positions and velocities by numpy.savez",
        "abc" | "usd" | "usdc" | "vdb" | "bhclassic" => {
            "save the points as BGEO (Houdini's .bhclassic), PLY, VTU or CSV"
        }
        "sc" => "packed by blosc: save .bgeo or .bgeo.gz",
        _ => return None,
    })
}

/// How other programs name the number of a frame: Rust and Python, Houdini, Nuke and Maya, and printf with blanks.
const FOREIGN: [&str; 6] = ["{", "#", "$F", "<", "@", "%"];

/// The pattern in the form that is understood here, where it is one of another program.
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
    // Padded as the files are, where they are.
    let fits = |name: &str| sequence::expand(&[format!("{folder}{name}")], None).is_ok();
    if !fits(&name) {
        let padded = (2..=10).map(|width| name.replace("%d", &format!("%0{width}d")));
        name = padded.into_iter().find(|name| fits(name)).unwrap_or(name);
    }
    let found = if fits(&name) { "" } else { ", or * for any text" };
    Some(format!(
        "the number of a frame is %d here, or %04d where it has four digits{found}: '{folder}{name}'"
    ))
}

/// The same without the padding, or with another one, where files fit that.
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
    fn a_folder_is_the_sequence_in_it() {
        for (name, expected) in [
            ("ParticleData_Fluid_8.vtk", "ParticleData_Fluid_*.vtk"),
            ("f2_0008.bgeo.gz", "f2_*.bgeo.gz"),
            ("dam.0008.npz", "dam.*.npz"),
            ("dump.500", "dump.*"),
            ("dump.500.lammpstrj", "dump.*.lammpstrj"),
            ("cloud.vtp", "cloud.vtp"),
            ("8.csv", "*.csv"),
        ] {
            assert_eq!(pattern(name), expected);
        }
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        let write = |name: &str| std::fs::write(at(name), "").unwrap();
        std::fs::create_dir_all(at("out/partio")).unwrap();
        std::fs::create_dir_all(at("bi4")).unwrap();
        std::fs::create_dir_all(at("none")).unwrap();
        write("bi4/Part_0001.bi4");
        for number in [8, 9, 10] {
            write(&format!("out/partio/Fluid_{number}.bgeo"));
        }
        write("out/log.txt~");
        let said = |name: &str| expand(&[at(name)], false).unwrap_err().message;
        assert_eq!(expand(&[at("out/partio")], false).unwrap().len(), 3);
        assert_eq!(
            within(&expand(&[at("out/partio/")], false).unwrap(), Some(9..=10)).unwrap().len(),
            2
        );
        assert!(
            said("out").contains("there are some in ") && said("out").contains("out/partio"),
            "{}",
            said("out")
        );
        write("out/partio/Foam_8.bgeo");
        let text = said("out/partio");
        assert!(
            text.contains("Fluid_*.bgeo' (3 files), '") && text.contains("Foam_*.bgeo' (1 file)"),
            "{text}"
        );
        write("bi4/log.out~");
        assert!(said("bi4").contains("PartVTK"), "{}", said("bi4"));
        assert!(said("none").contains("expected particle files"), "{}", said("none"));
    }

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
        // A plain name.
        assert!(!said("a.bgeo").contains("%d.bgeo'"), "{}", said("a.bgeo"));
    }
}
