//! Files that are read in parts: put together they are what reading at once gives, faults and all, and no more than
//! a part is in memory.

use std::path::PathBuf;

use super::{allocation, bad, samples};
use whitewater::io::particles::{
    Extension, Format, Particles, Parts, ReadError, WriteFormat, read, read_bytes, write, write_to,
};

/// Parts put together, with how many of them there were.
fn together(parts: Parts<'_>, size: usize) -> Result<(Particles, usize), ReadError> {
    fn append<T>(all: &mut Option<Vec<T>>, part: Option<Vec<T>>) {
        assert_eq!(all.is_some(), part.is_some(), "a list that not all parts have");
        all.iter_mut().zip(part).for_each(|(all, part)| all.extend(part));
    }
    let mut all = parts.about().clone();
    assert!(all.positions.is_empty());
    let total = parts.total();
    let mut count = 0;
    for part in parts {
        let part = part?;
        let expected = size.min(total - all.positions.len());
        assert_eq!(part.positions.len(), expected, "particles of part {count}");
        assert!(
            part.attributes.is_empty() && part.warnings.is_empty() && part.format == all.format
        );
        all.positions.extend(part.positions);
        append(&mut all.velocities, part.velocities);
        append(&mut all.densities, part.densities);
        append(&mut all.ids, part.ids);
        append(&mut all.lifetimes, part.lifetimes);
        append(&mut all.kinds, part.kinds);
        count += 1;
    }
    assert_eq!(all.positions.len(), total);
    Ok((all, count))
}

fn in_parts(bytes: &[u8], hint: Extension, size: usize) -> Result<Particles, ReadError> {
    together(Parts::of_bytes(bytes, hint, size)?, size.max(1)).map(|(all, _)| all)
}

/// All that is in them, to the last bit: no NaN is equal to itself.
fn bits(particles: &Particles) -> impl PartialEq + std::fmt::Debug + use<> {
    let word = |list: &Vec<f32>| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let vector = |list: &Vec<[f32; 3]>| word(&list.as_flattened().to_vec());
    (
        vector(&particles.positions),
        particles.velocities.as_ref().map(vector),
        [&particles.densities, &particles.lifetimes].map(|list| list.as_ref().map(word)),
        [particles.ids.clone(), particles.kinds.clone()],
        (particles.attributes.clone(), particles.warnings.clone(), particles.format),
    )
}

/// The same particles, or the same fault in the same words; of a file with several faults one that its header tells.
fn same(name: &str, bytes: &[u8], hint: Extension, sizes: &[usize]) -> bool {
    let whole = read_bytes(bytes, hint);
    for size in sizes {
        match (&whole, in_parts(bytes, hint, *size)) {
            (Ok(whole), Ok(parts)) => assert_eq!(bits(whole), bits(&parts), "{name}, {size}"),
            (Err(_), Err(ReadError::NoPositions { .. } | ReadError::Length { .. })) => {}
            (Err(whole), Err(parts)) => {
                assert_eq!(whole.to_string(), parts.to_string(), "{name}, {size}");
            }
            (whole, parts) => panic!("{name}, {size}: {whole:?} but in parts {parts:?}"),
        }
    }
    whole.is_ok()
}

/// A sample that is not read as a whole.
fn is_rows(name: &str, format: Format, gzip: bool) -> bool {
    match format {
        Format::Bgeo { .. } => true,
        Format::PlyBinary { .. } => !name.contains("lists true"),
        Format::Npy => !name.contains("Fortran"),
        Format::Npz => !gzip,
        _ => false,
    }
}

#[test]
fn parts_of_any_size_are_the_whole_together() {
    let mut rows = 0;
    for s in samples::all() {
        let packed = samples::gzip(&s.bytes);
        let twice = s.format == Format::Bgeo { gzip: true };
        for (bytes, gzip) in [(&s.bytes, false), (&packed, true)] {
            if twice && gzip {
                continue;
            }
            assert!(
                same(&s.name, bytes, s.hint, &[0, 1, 7, samples::COUNT, usize::MAX]),
                "{}",
                s.name
            );
            let parts = Parts::of_bytes(bytes, s.hint, 4).unwrap();
            assert_eq!(!parts.in_memory(), is_rows(&s.name, s.format, gzip), "{} {gzip}", s.name);
            rows += usize::from(!parts.in_memory());
            // Those that fit into one are not read again.
            assert!(Parts::of_bytes(bytes, s.hint, samples::COUNT).unwrap().in_memory());
        }
    }
    assert!(rows >= 16, "{rows}");
}

/// So many diffuse particles.
fn cloud(count: usize) -> Particles {
    let at = |i: usize| [i as f32 * 0.25, (i % 17) as f32, -(i as f32)];
    let mut all = Particles::from_positions((0..count).map(at).collect());
    all.velocities = Some((0..count).map(|i| [1.0, i as f32, 0.5]).collect());
    all.ids = Some((0..count as u32).rev().collect());
    all.kinds = Some((0..count as u32).map(|i| i % 3).collect());
    all.lifetimes = Some((0..count).map(|i| 4.0 - i as f32 / 7.0).collect());
    all
}

const FORMATS: [(WriteFormat, Extension); 4] = [
    (WriteFormat::Bgeo { gzip: false }, Extension::Bgeo),
    (WriteFormat::Bgeo { gzip: true }, Extension::Bgeo),
    (WriteFormat::Ply, Extension::Ply),
    (WriteFormat::Npz, Extension::Npz),
];

fn written(particles: &Particles, format: WriteFormat) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    write_to(&mut out, particles, format).unwrap();
    out.into_inner()
}

#[test]
fn what_only_all_particles_tell_is_told() {
    // More than the samples by which the reach of 32 bits is judged; none in the last case.
    let count = 9001;
    let mut odd = cloud(count);
    odd.positions[4000] = [f32::NAN, 0.0, 0.0];
    odd.positions[8999][1] = f32::INFINITY;
    let mut far = cloud(count);
    far.positions.iter_mut().for_each(|p| p.iter_mut().for_each(|c| *c = 3.0e6 + *c % 5.0));
    for (what, particles) in [("odd", odd), ("far", far), ("none", cloud(0))] {
        for (format, hint) in FORMATS {
            let bytes = written(&particles, format);
            assert!(same(what, &bytes, hint, &[1000, 4096, count, count + 1]));
            let warnings = read_bytes(&bytes, hint).unwrap().warnings;
            assert_eq!(warnings.is_empty(), what == "none", "{what}: {warnings:?}");
        }
    }
}

/// An attribute that only a later part shows to be none is in no part.
#[test]
fn what_is_dropped_is_dropped_from_all_parts() {
    let particles = cloud(50);
    let mut bytes = written(&particles, WriteFormat::Bgeo { gzip: false });
    // x y z w, velocity, id, lifetime, type: 40 bytes, of which the id begins at 28. Two bytes end the file.
    let row = |i: usize| bytes.len() - 2 - 40 * (50 - i);
    let (id, kind) = (row(33) + 28, row(49) + 36);
    bytes[id] = 0x80;
    for bytes in [bytes.clone(), samples::gzip(&bytes)] {
        assert!(same("ids", &bytes, Extension::Bgeo, &[1, 7, 20, 49, 50]));
        let parts = Parts::of_bytes(&bytes, Extension::Bgeo, 10).unwrap();
        let about = parts.about();
        assert!(about.ids.is_none() && about.kinds.is_some());
        assert!(about.warnings[0].contains("of particle 33"), "{:?}", about.warnings);
    }
    bytes[kind] = 0xff;
    assert!(same("both", &bytes, Extension::Bgeo, &[1, 7, 20, 49, 50]));
    // Numbers with a fraction, of which the first is told.
    let text = |kind: f32| {
        let head = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n\
                    property float y\nproperty float z\nproperty float type\nend_header\n";
        let rows = [[0.0_f32, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, kind], [2.0, 0.0, 0.0, kind]];
        [head.as_bytes(), &samples::floats(rows.as_flattened(), 4, false)].concat()
    };
    assert!(same("fraction", &text(0.5), Extension::Ply, &[1, 2, 3]));
    let sound = text(2.0);
    let parts = Parts::of_bytes(&sound, Extension::Ply, 1).unwrap();
    assert_eq!(together(parts, 1).unwrap().0.kinds, Some(vec![1, 2, 2]));
}

/// Attributes of different lengths are found by the headers, before any number is read.
#[test]
fn what_headers_tell_is_told_first() {
    let arrays = |rows: &str, length: usize| {
        let velocity = samples::npy("<f4", rows, false, 1, &vec![0; length]);
        let position = samples::npy("<f4", "(2, 3)", false, 1, &[0; 24]);
        samples::npz(&[("position", position), ("velocity", velocity)], true)
    };
    for (rows, length) in [("(1, 3)", 12), ("(3, 3)", 36), ("(2, 3)", 20), ("(2, 3)", 40)] {
        same(rows, &arrays(rows, length), Extension::Npz, &[1, 2, 3]);
    }
    let no_positions = b"ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty int q\n\
        end_header\n\0\0\0\0";
    same("no positions", no_positions, Extension::Ply, &[1]);
    let none = b"ply\nformat binary_big_endian 1.0\nelement face 0\nproperty int q\nend_header\n";
    same("no vertices", none, Extension::Ply, &[1]);
    // What lies before the vertices is passed over, in whatever kind of line the header has.
    let before = |end: &str, faces: &[u8]| {
        let head = "ply\nformat binary_big_endian 1.0\nelement face 2\nproperty short a\n\
            property uchar b\nelement vertex 2\nproperty uchar x\nproperty char y\nproperty short z\n\
            end_header\n";
        let head = head.replace('\n', end);
        [head.as_bytes(), faces, &[1, 2, 0, 3, 4, 5, 0, 6]].concat()
    };
    for end in ["\n", "\r\n", "\r"] {
        assert!(same("faces", &before(end, &[9; 6]), Extension::Ply, &[1, 2, 3]));
    }
    let cut = before("\n", &[]);
    same("faces that end", &cut[..cut.len() - 4], Extension::Ply, &[1, 2]);
}

/// Headers longer than what is read of a file first, down to the last character.
#[test]
fn long_headers_are_read_to_their_end() {
    for length in [65_533, 65_534, 65_535, 65_536, 65_537, 200_000] {
        let head = |comment: &str| {
            format!(
                "ply\r\nformat binary_little_endian 1.0\r\ncomment {comment}\r\n\
                 element vertex 2\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n\
                 end_header\r\n"
            )
        };
        let comment = "c".repeat(length - head("").len());
        let rows = samples::floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 4, false);
        let bytes = [head(&comment).as_bytes(), &rows].concat();
        assert!(same("long", &bytes, Extension::Ply, &[1, 2]), "{length}");
        assert!(same("long gzip", &samples::gzip(&bytes), Extension::Ply, &[1, 2]), "{length}");
    }
}

#[test]
fn cut_off_files_have_the_same_faults() {
    for s in samples::all() {
        let packed = samples::gzip(&s.bytes);
        for (bytes, gzip) in [(&s.bytes, false), (&packed, true)] {
            if !is_rows(&s.name, s.format, gzip) {
                continue;
            }
            for length in 0..bytes.len() {
                same(
                    &format!("{} {gzip} {length}", s.name),
                    &bytes[..length],
                    s.hint,
                    &[1, 7, 100],
                );
            }
        }
    }
}

/// What comes behind the last particle has to be sound as well: in files of more than is read to tell their format.
#[test]
fn the_end_of_what_is_packed_is_checked() {
    let particles = cloud(5000);
    for (format, hint) in FORMATS {
        let bytes = written(&particles, format);
        let end = bytes.len();
        for cut in [1, 2, 3, 4, 5, 8, 9, 20, 1000, end / 2, end - 70_000.min(end)] {
            same(&format!("{format:?} {cut}"), &bytes[..end - cut], hint, &[999, 5000]);
        }
        if format == (WriteFormat::Bgeo { gzip: true }) {
            // The checksum stands before the length, which ends it.
            let mut bytes = bytes;
            bytes[end - 8] ^= 1;
            assert!(!same("checksum", &bytes, hint, &[999, 5000]));
        }
    }
    // A number in an array that is stored as it is.
    let zeros = |shape: &str, n: usize| samples::npy("<f4", shape, false, 1, &vec![0; n]);
    let arrays = [("pos", zeros("(9000, 3)", 108_000)), ("life", zeros("(9000,)", 36_000))];
    let sound = samples::npz(&arrays, false);
    assert!(same("stored", &sound, Extension::Npz, &[1000, 9000]));
    let mut bytes = sound.clone();
    bytes[100_000] ^= 1;
    for size in [1000, 9000] {
        assert!(in_parts(&sound, Extension::Npz, size).is_ok());
        assert!(read_bytes(&bytes, Extension::Npz).is_err());
        let fault = in_parts(&bytes, Extension::Npz, size).unwrap_err().to_string();
        assert!(fault.contains("array `pos`") && fault.contains("checksum"), "{fault}");
    }
}

#[test]
fn mutations_have_the_same_faults() {
    let mut next = bad::numbers();
    let (mut cases, mut read) = (0, 0);
    for s in samples::all() {
        if !is_rows(&s.name, s.format, false) {
            continue;
        }
        for i in 0..400 {
            let mut bytes = bad::damaged(&s.bytes, &mut next);
            if i % 4 == 0 {
                bytes = samples::gzip(&bytes);
            }
            let sizes = [1 + next(samples::COUNT + 2)];
            cases += 1;
            let ((), peak) = allocation::peak(|| {
                if s.format == Format::Npz {
                    // Of an archive with several faults another may be found first.
                    match (read_bytes(&bytes, s.hint), in_parts(&bytes, s.hint, sizes[0])) {
                        (Ok(whole), Ok(parts)) => assert_eq!(bits(&whole), bits(&parts)),
                        (Err(_), Err(_)) => {}
                        (whole, parts) => {
                            panic!("{}: {:?}, {:?}", s.name, whole.err(), parts.err())
                        }
                    }
                } else {
                    read += usize::from(same(&s.name, &bytes, s.hint, &sizes));
                }
            });
            assert!(peak <= (2 << 20) + 300 * bytes.len(), "{}: {peak} bytes held", s.name);
        }
    }
    println!("{cases} damaged files, {read} of them read");
    assert!(cases > 4000 && read > 100 && read < cases / 2, "{read} of {cases}");
}

#[test]
fn what_unpacks_without_end_is_refused() {
    let mut head = written(&cloud(3), WriteFormat::Bgeo { gzip: false });
    head[9..13].copy_from_slice(&i32::MAX.to_be_bytes());
    head.resize(40 << 20, 0);
    let bomb = samples::gzip(&head);
    let (result, peak) =
        allocation::peak(|| Parts::of_bytes(&bomb, Extension::Bgeo, usize::MAX).map(drop));
    assert!(matches!(result, Err(ReadError::TooLarge { .. })), "{result:?}");
    assert!(peak < 128 << 20, "{peak}");
    let (result, peak) =
        allocation::peak(|| Parts::of_bytes(&bomb, Extension::Bgeo, 1000).map(drop));
    assert!(matches!(result, Err(ReadError::TooLarge { .. })), "{result:?}");
    assert!(peak < 2 << 20, "{peak}");
}

/// A folder of its own that is gone after the test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("whitewater-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// What is said at [`Parts`] of the bytes that are in memory.
fn bound(size: usize) -> usize {
    160 * size + (2 << 20)
}

#[test]
fn two_million_particles_take_no_more_memory_than_a_part() {
    const COUNT: usize = 2_000_000;
    const SIZE: usize = 50_000;
    let folder = Folder::new("parts");
    let particles = cloud(COUNT);
    for name in ["a.bgeo.gz", "a.ply"] {
        let path = folder.0.join(name);
        write(&path, &particles, WriteFormat::from_path(&path).unwrap()).unwrap();
        let ((), peak) = allocation::peak(|| {
            let mut shown = 0;
            let parts = Parts::open_with(&path, SIZE, |part| shown += part.positions.len());
            let parts = parts.unwrap();
            assert!(!parts.in_memory() && parts.total() == COUNT && shown == COUNT);
            let mut first = 0;
            for part in parts {
                let part = part.unwrap();
                let there = first..first + part.positions.len();
                assert!(there.len() <= SIZE, "{name}: {there:?}");
                assert_eq!(part.positions, particles.positions[there.clone()], "{name}");
                assert_eq!(part.ids, particles.ids.as_ref().map(|all| all[there.clone()].to_vec()));
                assert_eq!(
                    part.lifetimes,
                    particles.lifetimes.as_ref().map(|all| all[there.clone()].to_vec())
                );
                first = there.end;
            }
            assert_eq!(first, COUNT);
        });
        println!("{name}: {peak} bytes held at most, {} allowed", bound(SIZE));
        assert!(peak <= bound(SIZE), "{name}: {peak} bytes held, {} allowed", bound(SIZE));
        std::fs::remove_file(&path).unwrap();
    }
    // Arrays side by side, each unpacked on its own; fewer, since packing them takes long.
    let path = folder.0.join("a.npz");
    write(&path, &cloud(300_000), WriteFormat::Npz).unwrap();
    let (all, peak) = allocation::peak(|| {
        let parts = Parts::open(&path, 20_000).unwrap();
        assert!(!parts.in_memory());
        parts.map(|part| part.unwrap().positions.len()).collect::<Vec<_>>()
    });
    assert_eq!(all, [20_000; 15]);
    assert!(peak <= bound(20_000), "npz: {peak} bytes held, {} allowed", bound(20_000));
    assert_eq!(bits(&read(&path).unwrap()), {
        bits(&together(Parts::open(&path, 77_777).unwrap(), 77_777).unwrap().0)
    });
}

#[test]
fn a_file_that_changes_on_the_way_is_an_error() {
    let folder = Folder::new("changed");
    let path = folder.0.join("a.bgeo");
    let sound = written(&cloud(100), WriteFormat::Bgeo { gzip: false });
    std::fs::write(&path, &sound).unwrap();
    let mut parts = Parts::open(&path, 30).unwrap();
    assert_eq!(parts.next().unwrap().unwrap().positions.len(), 30);
    std::fs::write(&path, &sound[..sound.len() / 2]).unwrap();
    let faults: Vec<_> = parts.by_ref().filter_map(Result::err).collect();
    assert_eq!(faults.len(), 1);
    assert!(faults[0].to_string().contains("a.bgeo: the file ends too early"), "{}", faults[0]);
    assert!(parts.next().is_none());
    // An id that was none before.
    std::fs::write(&path, &sound).unwrap();
    let parts = Parts::open(&path, 30).unwrap();
    let mut other = sound.clone();
    let row = other.len() - 2 - 40;
    other[row + 28] = 0x80;
    std::fs::write(&path, &other).unwrap();
    let fault = parts.map(|part| part.map(drop)).find_map(Result::err).unwrap().to_string();
    assert!(fault.contains("a moment ago"), "{fault}");
    // What is no file has the words of reading at once.
    let missing = folder.0.join("none.ply");
    let said = |error: ReadError| error.to_string();
    assert_eq!(said(Parts::open(&missing, 1).unwrap_err()), said(read(&missing).unwrap_err()));
    assert_eq!(said(Parts::open(&folder.0, 1).unwrap_err()), said(read(&folder.0).unwrap_err()));
    std::fs::write(&path, &sound[..99]).unwrap();
    assert_eq!(said(Parts::open(&path, 1).unwrap_err()), said(read(&path).unwrap_err()));
}
