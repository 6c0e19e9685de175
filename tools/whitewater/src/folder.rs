//! Finds the sequence of particle files in a folder.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::ops::Range;
use std::path::Path;

use whitewater::io::particles::{self, ReadError, sequence};

use crate::arrays;
use crate::failure::{Failure, Outcome};

/// Extensions of particle files; an extension for compression may follow.
const EXTENSIONS: [&str; 28] = [
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
    "tec",
    "tp",
    "h5",
    "hdf5",
    "vtkhdf",
    "h5part",
    "h5md",
    "xdmf",
    "xmf",
];

/// Returns a file name or pattern unchanged; for a folder, the pattern of its only sequence, or a file that lists the
/// sequence.
pub fn in_folder(input: &str) -> Outcome<String> {
    within_folder(input, DEPTH)
}

/// The same, and enters at most `depth` folders each of which is the only thing in the one before.
fn within_folder(input: &str, depth: usize) -> Outcome<String> {
    let path = Path::new(input);
    if !path.is_dir() {
        return Ok(input.to_string());
    }
    let folder = input.trim_end_matches('/');
    let folder = if folder.is_empty() { "/" } else { folder };
    let (mut names, mut lists) = (Vec::new(), Vec::new());
    let (mut folders, mut others) = (Vec::new(), Vec::new());
    let io = |error| Failure::reading(path, &error);
    for entry in std::fs::read_dir(path).map_err(io)?.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') {
            continue;
        }
        if entry.path().is_dir() {
            folders.push(name);
        } else if name.ends_with(".pvd") || name.ends_with(".series") {
            lists.push(name);
        } else if readable(&name) {
            names.push(name);
        } else {
            others.push(name);
        }
    }
    // Beside particle files they hold other things, such as settings.
    if names.is_empty() && lists.is_empty() {
        (names, others) = others.into_iter().partition(|name| is_matlab(name));
    }
    names.sort();
    let pieces = pieces(path, &names);
    names.retain(|name| !pieces.contains(name));
    if let [list] = lists.as_slice() {
        let list = format!("{folder}/{list}");
        let all = sequence::expand(std::slice::from_ref(&list), None).unwrap_or_default();
        let listed: HashSet<&std::ffi::OsStr> =
            all.iter().flat_map(|frame| frame.paths()).filter_map(Path::file_name).collect();
        if !listed.is_empty()
            && names.iter().all(|name| listed.contains(name.as_ref() as &std::ffi::OsStr))
        {
            return Ok(list);
        }
    }
    let patterns = patterns(&names);
    let patterns: BTreeMap<String, usize> = patterns
        .into_iter()
        .map(|(pattern, count)| (format!("{folder}/{pattern}"), count))
        .collect();
    let mut patterns: Vec<_> = patterns.into_iter().collect();
    patterns.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let shown = |(pattern, count): &(String, usize)| {
        format!("'{pattern}' ({count} {})", if *count == 1 { "file" } else { "files" })
    };
    match patterns.as_slice() {
        [] => {}
        [(pattern, _)] => return Ok(pattern.clone()),
        many => {
            // Velocities in files beside the positions.
            let names: Vec<_> = many.iter().map(|(pattern, _)| pattern.as_str()).collect();
            if let Some(positions) = arrays::positions_of(&names) {
                return Ok(positions.to_string());
            }
            let list: Vec<_> = many.iter().take(8).map(shown).collect();
            let why = format!(
                "{input} is a folder of several sequences: name one of {}; or, where they are parts of the same frames, \
                 several, with --join",
                list.join(", ")
            );
            return Err(Failure::input(why));
        }
    }
    folders.sort();
    others.sort();
    if let Some(pattern) = in_folders(folder, &folders) {
        return Ok(pattern);
    }
    let within = |name: &String| {
        let name = format!("{folder}/{name}");
        let inner = std::fs::read_dir(&name).into_iter().flatten().flatten();
        let any = inner.map(|entry| entry.file_name().to_string_lossy().into_owned());
        any.into_iter().any(|file| readable(&file)).then_some(name)
    };
    let inner: Vec<_> = folders.iter().filter_map(within).take(8).collect();
    // Solvers write a subfolder of particles beside logs and their own state.
    if let [one] = inner.as_slice() {
        return within_folder(one, depth);
    }
    if let ([only], true, true, true) =
        (folders.as_slice(), inner.is_empty(), others.is_empty(), depth > 0)
    {
        return within_folder(&format!("{folder}/{only}"), depth - 1);
    }
    // Files without an extension, such as OpenFOAM's, may be recognised by their contents.
    let told = others.iter().filter(|name| !name.contains('.')).take(LOOKED_AT).find_map(|name| {
        match particles::read(&path.join(name)) {
            Err(ReadError::File { path, reason })
                if matches!(*reason, ReadError::Unsupported { .. }) =>
            {
                Some(format!("{}: {reason}", path.display()))
            }
            _ => None,
        }
    });
    let cloud =
        |name: &&String| *name == "lagrangian" || path.join(name).join("lagrangian").is_dir();
    if inner.is_empty() && folders.iter().any(|name| cloud(&name)) {
        let why = "a case of OpenFOAM, whose clouds are not read; run foamToVTK and give the VTK files of the cloud that it writes";
        return Err(Failure::input(format!("{input}: {why}")));
    }
    let found = match (inner.is_empty(), others.first()) {
        (false, _) => format!("; there are some in {}{WHITEWATER}", inner.join(", ")),
        (true, Some(_)) if told.is_some() => format!(": {}", told.unwrap_or_default()),
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

/// Advice where there are several folders of particles.
const WHITEWATER: &str =
    " (spray, foam and bubbles are read by --whitewater, for example 'foam/*.bgeo')";

/// Max number of folders, each the only thing in the one before, that are entered in search of particle files.
const DEPTH: usize = 4;

/// Max number of files without a known extension whose contents are inspected.
const LOOKED_AT: usize = 4;

/// Max size in bytes of a list of pieces that is read.
const LONGEST: u64 = 1 << 20;

/// The files that other files of the folder list as their pieces.
fn pieces(folder: &Path, names: &[String]) -> HashSet<String> {
    let list = |name: &&String| [".pvtu", ".pvtp", ".vtm"].iter().any(|end| name.ends_with(end));
    let text = |name: &String| {
        let path = folder.join(name);
        let short = std::fs::metadata(&path).is_ok_and(|meta| meta.len() <= LONGEST);
        if short { std::fs::read_to_string(path).ok() } else { None }
    };
    let mut found = HashSet::new();
    for text in names.iter().filter(list).filter_map(text) {
        for word in text.split('"') {
            let name = word.rsplit(['/', '\\']).next().unwrap_or(word);
            if name.ends_with(".vtu") || name.ends_with(".vtp") {
                found.insert(name.to_string());
            }
        }
    }
    found
}

/// Returns the pattern of each sequence in a list of file names, and the number of its files. A number with a decimal
/// point or exponent is a time and becomes a `*` as a whole: if only its last digits did, each file would be a
/// sequence of its own.
fn patterns(names: &[String]) -> BTreeMap<String, usize> {
    let mut timed: BTreeMap<String, Vec<&String>> = BTreeMap::new();
    for name in names {
        let pattern = time_with_unit(name).or_else(|| time(name)).map(|time| {
            let mut pattern = name.clone();
            pattern.replace_range(time, "*");
            pattern
        });
        pattern.into_iter().for_each(|pattern| timed.entry(pattern).or_default().push(name));
    }
    let mut patterns: BTreeMap<String, usize> = BTreeMap::new();
    let mut done = HashSet::new();
    for (pattern, names) in timed {
        let plain: HashSet<String> = names.iter().map(|name| self::pattern(name)).collect();
        let units = names.iter().any(|name| time_with_unit(name).is_some());
        let times = || units || 2 * plain.len() > names.len() || have_tenths(&names);
        if plain.len() > 1 && times() {
            done.extend(names.iter().copied());
            *patterns.entry(pattern).or_default() += names.len();
        }
    }
    for name in names.iter().filter(|name| !done.contains(name)) {
        *patterns.entry(pattern(name)).or_default() += 1;
    }
    patterns
}

/// Whether the digits behind the points of numbers in names are those of times: all of 0 to 9 (or 00 to 99 and so on),
/// or some that do not follow each other, such as 0 and 5. The ranks of processes follow each other from 0 or 1 on.
fn have_tenths(names: &[&String]) -> bool {
    let behind_point = |name: &&String| {
        let (_, digits) = name[time(name)?].rsplit_once('.')?;
        Some((digits.len() as u32, digits.parse::<u32>().ok()?))
    };
    let Some(all) = names.iter().map(behind_point).collect::<Option<BTreeSet<_>>>() else {
        return false;
    };
    let (Some((length, first)), Some((longest, last))) = (all.first(), all.last()) else {
        return false;
    };
    let follow = *first <= 1 && (last - first) as usize + 1 == all.len();
    length == longest && (!follow || 10_usize.checked_pow(*length) == Some(all.len()))
}

/// Where a number begins whose first digit is at this byte: a minus belongs to it if it begins the name or follows a
/// separator.
fn with_sign(name: &str, digit: usize) -> usize {
    let Some(before) = name[..digit].strip_suffix('-') else { return digit };
    if before.ends_with(char::is_alphanumeric) { digit } else { before.len() }
}

/// Byte range of the last number with a decimal point or exponent in a file name, before the extension.
fn time(name: &str) -> Option<Range<usize>> {
    let digit = |at: usize| name.as_bytes().get(at).is_some_and(u8::is_ascii_digit);
    let run = |from: usize| (from..name.len()).find(|at| !digit(*at)).unwrap_or(name.len());
    let (mut at, mut found) = (0, None);
    while at < name.len() {
        if !digit(at) {
            at += 1;
            continue;
        }
        let (start, whole) = (at, run(at));
        let mut end = whole;
        if name[end..].starts_with('.') && digit(end + 1) {
            end = run(end + 1);
        }
        if name[end..].starts_with(['e', 'E']) {
            let sign = usize::from(name[end + 1..].starts_with(['+', '-']));
            if digit(end + 1 + sign) {
                end = run(end + 1 + sign);
            }
        }
        // If the digits before the point are padded with zeros, they are a frame number, and the digits after the
        // point are the rank of a process.
        let padded = whole - start > 1 && name[start..].starts_with('0');
        if end > whole && end < name.len() && !padded {
            found = Some(with_sign(name, start)..end);
        }
        at = end;
    }
    found
}

/// Byte range of the last number with a unit of time right behind it, the unit included.
fn time_with_unit(name: &str) -> Option<Range<usize>> {
    let stem = name.rfind('.').unwrap_or(name.len());
    let digit = |c: char| c.is_ascii_digit();
    let ends = name[..stem].char_indices().filter(|(_, c)| digit(*c)).map(|(at, _)| at + 1);
    let with_unit = |at: usize| Some((at, at + sequence::time_unit(&name[at..])?));
    let (number, end) = ends.filter_map(with_unit).next_back()?;
    let number = &name[..number];
    // The number may have a point or an exponent.
    let start = number.rfind(|c: char| !digit(c) && !matches!(c, '.' | 'e' | '+' | '-'));
    let start = start.map_or(0, |at| at + number[at..].chars().next().map_or(1, char::len_utf8));
    let leading = number[start..].find(digit)?;
    Some(with_sign(name, start + leading)..end)
}

/// Pattern of a file that exists in each of several numbered folders: `DIR/*/cloud.vtp`.
fn in_folders(folder: &str, folders: &[String]) -> Option<String> {
    let numbered = folders.iter().filter(|name| {
        let behind = name.rfind(|c: char| c.is_ascii_digit()).map(|at| &name[at + 1..]);
        behind.is_some_and(|text| text.is_empty() || sequence::time_unit(text) == Some(text.len()))
    });
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut total = 0;
    for name in numbered {
        let inner = std::fs::read_dir(format!("{folder}/{name}")).ok()?.flatten();
        let files: Vec<_> = inner
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .filter(|file| readable(file))
            .collect();
        total += usize::from(!files.is_empty());
        files.into_iter().for_each(|file| *counts.entry(file).or_default() += 1);
    }
    let all = counts.into_iter().filter(|(_, count)| *count == total && total > 1);
    let all: Vec<String> = all.map(|(file, _)| file).collect();
    let names: Vec<&str> = all.iter().map(String::as_str).collect();
    let one = match names.as_slice() {
        [one] => Some(*one),
        several => arrays::positions_of(several),
    };
    one.map(|file| format!("{folder}/*/{file}"))
}

/// MATLAB's files of version 7.3 are HDF5; of the others the reader says what to do.
fn is_matlab(name: &str) -> bool {
    name.to_lowercase().ends_with(".mat")
}

fn readable(name: &str) -> bool {
    let name = name.to_lowercase();
    let name = name.strip_suffix(".gz").unwrap_or(&name);
    let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
    // LAMMPS names its files dump.500.
    EXTENSIONS.contains(&extension) || name.starts_with("dump.")
}

/// A name with its last number replaced by `*`.
fn pattern(name: &str) -> String {
    let name = without_ranks(name);
    let name = name.as_str();
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
    let start = with_sign(name, start);
    format!("{}*{}", &name[..start], &name[after..])
}

/// A name with process ranks replaced by `*`.
fn without_ranks(name: &str) -> String {
    let (mut out, mut rest) = (String::new(), name);
    while let Some(at) = rest.find(|c: char| c.is_ascii_digit()) {
        let (text, number) = rest.split_at(at);
        let end = number.find(|c: char| !c.is_ascii_digit()).unwrap_or(number.len());
        out.push_str(text);
        out.push_str(if sequence::is_rank(text) { "*" } else { &number[..end] });
        rest = &number[end..];
    }
    out + rest
}

/// Returns advice on how to convert a file that this program does not read; `None` if it has none.
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
            ("fluid_10_rank0.csv", "fluid_*_rank*.csv"),
            ("f_proc3.vtu", "f_proc*.vtu"),
            ("step_-1.csv", "step_*.csv"),
            ("-1.csv", "*.csv"),
            ("step-1.csv", "step-*.csv"),
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
        let said = |name: &str| crate::frames::expand(&[at(name)], false).unwrap_err().message;
        assert_eq!(crate::frames::expand(&[at("out/partio")], false).unwrap().len(), 3);
        assert_eq!(
            crate::frames::within(
                &crate::frames::expand(&[at("out/partio/")], false).unwrap(),
                Some(9..=10)
            )
            .unwrap()
            .len(),
            2
        );
        std::fs::create_dir_all(at("out/state")).unwrap();
        assert!(in_folder(&at("out")).unwrap().ends_with("out/partio/Fluid_*.bgeo"));
        std::fs::create_dir_all(at("out/vtk")).unwrap();
        write("out/vtk/Fluid_8.vtk");
        for part in ["there are some in ", "out/partio", "out/vtk"] {
            assert!(said("out").contains(part), "{}", said("out"));
        }
        write("out/partio/Foam_8.bgeo");
        let text = said("out/partio");
        assert!(
            text.contains("Fluid_*.bgeo' (3 files), '") && text.contains("Foam_*.bgeo' (1 file)"),
            "{text}"
        );
        // Each frame has one file per rank and a list (.pvtu) that joins them. Then a list of all frames (.pvd) is
        // added.
        std::fs::create_dir_all(at("ranks")).unwrap();
        for number in [1, 2] {
            for rank in [0, 1] {
                write(&format!("ranks/p-{number:05}.{rank:04}.vtu"));
            }
            let list = format!(
                "<Piece Source=\"p-{number:05}.0000.vtu\"/><Piece Source=\"ranks/p-{number:05}.0001.vtu\"/>"
            );
            std::fs::write(at(&format!("ranks/p-{number:05}.pvtu")), list).unwrap();
        }
        assert!(in_folder(&at("ranks")).unwrap().ends_with("ranks/p-*.pvtu"));
        let set = |n: u8| format!("<DataSet timestep=\"{n}\" file=\"p-0000{n}.pvtu\"/>");
        let list = format!("<VTKFile><Collection>{}{}</Collection></VTKFile>", set(1), set(2));
        std::fs::write(at("ranks/p.pvd"), list).unwrap();
        assert!(in_folder(&at("ranks")).unwrap().ends_with("ranks/p.pvd"));
        // Times, as part of names and as names of folders.
        std::fs::create_dir_all(at("times")).unwrap();
        for time in ["0.4", "0.32", "0.36"] {
            write(&format!("times/t{time}.npz"));
            std::fs::create_dir_all(at(&format!("of/{time}"))).unwrap();
            write(&format!("of/{time}/cloud.vtp"));
        }
        assert!(in_folder(&at("times")).unwrap().ends_with("times/t*.npz"));
        assert!(in_folder(&at("of")).unwrap().ends_with("of/*/cloud.vtp"));
        for (name, expected) in [
            ("exp_3.200e-04.npz", Some(4..13)),
            ("t0.4.npz", Some(1..4)),
            ("dam.0008.npz", None),
            ("p-00008.0001.vtu", None),
            ("f_12.csv", None),
            ("x1e3", None),
        ] {
            assert_eq!(time(name), expected, "{name}");
        }
        for (name, expected) in [
            ("w_900us.csv", Some(2..7)),
            ("w_1.5s.csv.gz", Some(2..6)),
            ("w_2.0e-04s_a.csv", Some(2..10)),
            ("w_15\u{b5}s.csv", Some(2..7)),
            ("frame-5min.csv", Some(6..10)),
            ("10m_run.csv", None),
            ("5h3.csv", None),
        ] {
            assert_eq!(time_with_unit(name), expected, "{name}");
        }
        // Times in several units, as names of files and of folders.
        std::fs::create_dir_all(at("units")).unwrap();
        for time in ["0", "900us", "950us", "1ms", "2ms", "1.5s"] {
            write(&format!("units/w_{time}.csv"));
            std::fs::create_dir_all(at(&format!("inunits/{time}"))).unwrap();
            write(&format!("inunits/{time}/cloud.vtp"));
        }
        assert!(in_folder(&at("units")).unwrap().ends_with("units/w_*.csv"));
        assert!(in_folder(&at("inunits")).unwrap().ends_with("inunits/*/cloud.vtp"));
        let frames = crate::frames::files(&[at("units")], false).unwrap();
        let times: Vec<_> = frames.iter().map(|frame| frame.time.unwrap()).collect();
        assert_eq!(times, [0.0, 9.0e-4, 9.5e-4, 1.0e-3, 2.0e-3, 1.5]);
        // Tenths and quarters of seconds, and two ranks in each frame.
        for (folder, names) in [
            ("tenths", (0..25).map(|i| format!("{}.{}", i / 10, i % 10)).collect::<Vec<_>>()),
            ("quarters", (0..9).map(|i| format!("{:.2}", 0.25 * f64::from(i))).collect()),
            ("processes", ["10.0", "10.1", "11.0", "11.1", "12.0"].map(String::from).into()),
        ] {
            std::fs::create_dir_all(at(folder)).unwrap();
            names.iter().for_each(|name| write(&format!("{folder}/out_{name}.csv")));
            let frames = crate::frames::files(&[at(folder)], false);
            match folder {
                "processes" => assert!(frames.unwrap_err().message.contains("several sequences")),
                _ => assert_eq!(frames.unwrap().len(), names.len(), "{folder}"),
            }
        }
        // Times before the start.
        for (folder, times) in [
            ("before", ["-0.1", "0.0", "0.1"]),
            ("whole", ["-1", "0", "1"]),
            ("inunit", ["-5ms", "0ms", "5ms"]),
        ] {
            std::fs::create_dir_all(at(folder)).unwrap();
            for time in times {
                write(&format!("{folder}/out_{time}.csv"));
            }
            let frames = crate::frames::files(&[at(folder)], false).unwrap();
            let first = frames[0].path.file_name().unwrap().to_string_lossy().into_owned();
            assert_eq!((frames.len(), first), (3, format!("out_{}.csv", times[0])));
        }
        // Files of MATLAB are particles, except beside other files.
        std::fs::create_dir_all(at("matlab")).unwrap();
        write("matlab/w_1.mat");
        write("matlab/w_2.MAT");
        assert!(in_folder(&at("matlab")).unwrap_err().message.contains("several sequences"));
        std::fs::rename(at("matlab/w_2.MAT"), at("matlab/w_2.mat")).unwrap();
        write("matlab/log.out");
        assert!(in_folder(&at("matlab")).unwrap().ends_with("matlab/w_*.mat"));
        write("matlab/w_1.vtu");
        assert!(in_folder(&at("matlab")).unwrap().ends_with("matlab/w_*.vtu"));
        // A cloud of OpenFOAM, and the case that contains it.
        std::fs::create_dir_all(at("case/0.1/lagrangian/cloud")).unwrap();
        let header = "FoamFile\n{\n    class Cloud;\n}\n";
        std::fs::write(at("case/0.1/lagrangian/cloud/positions"), header).unwrap();
        for name in ["case", "case/0.1", "case/0.1/lagrangian/cloud"] {
            assert!(said(name).contains("foamToVTK"), "{name}: {}", said(name));
        }
        // Positions and velocities in separate NumPy files, all in one folder, and in one folder per frame.
        std::fs::create_dir_all(at("npy")).unwrap();
        for frame in [0, 1, 2] {
            std::fs::create_dir_all(at(&format!("each/{frame}"))).unwrap();
            for name in ["x", "v"] {
                write(&format!("npy/{name}_{frame:03}.npy"));
                write(&format!("each/{frame}/{name}.npy"));
            }
        }
        assert!(in_folder(&at("npy")).unwrap().ends_with("npy/x_*.npy"));
        assert!(in_folder(&at("each")).unwrap().ends_with("each/*/x.npy"));
        write("bi4/log.out~");
        assert!(said("bi4").contains("PartVTK"), "{}", said("bi4"));
        assert!(said("none").contains("expected particle files"), "{}", said("none"));
        // Results some folders down, and water and whitewater in folders beside each other.
        for (folder, file) in
            [("flume/out/particles", "p"), ("run/out/water", "w"), ("run/out/foam", "f")]
        {
            std::fs::create_dir_all(at(folder)).unwrap();
            write(&format!("{folder}/{file}_1.ply"));
        }
        assert!(in_folder(&at("flume")).unwrap().ends_with("flume/out/particles/p_*.ply"));
        let both = said("run");
        assert!(both.contains("run/out/foam, ") && both.contains("run/out/water (spray"), "{both}");
        // Where there is more than one folder, those further down are not searched.
        std::fs::create_dir_all(at("flume/code")).unwrap();
        assert!(said("flume").contains("expected particle files"), "{}", said("flume"));
    }
}
