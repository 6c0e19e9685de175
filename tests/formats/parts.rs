//! Files that are read in parts. All parts together equal the particles that `read` returns, errors
//! are the same, and at most one part is in memory.

use std::fmt::Write;

use super::folder::Folder;
use super::{allocation, bad, samples};
use whitewater::io::particles::{
    Compression, Extension, Format, Particles, Parts, ReadError, Storage, WriteFormat, read,
    read_bytes, write, write_to,
};

/// Joins the parts, and counts them.
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

/// All data of the particles. Floats are compared by their bits, because no NaN equals itself.
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

/// Asserts that reading in parts gives the same particles or the same error as reading at once. If
/// rows have a fixed length and a file has several errors, the parts may report one that the header
/// shows. Returns whether the file was read.
fn same(name: &str, bytes: &[u8], hint: Extension, sizes: &[usize]) -> bool {
    let whole = read_bytes(bytes, hint);
    for size in sizes {
        match (&whole, in_parts(bytes, hint, *size)) {
            (Ok(whole), Ok(parts)) => assert!(bits(whole) == bits(&parts), "{name}, {size}"),
            (Err(_), Err(ReadError::NoPositions { .. } | ReadError::Length { .. }))
                if matches!(hint, Extension::Bgeo | Extension::Ply | Extension::Npz) => {}
            (Err(whole), Err(parts)) => {
                assert_eq!(whole.to_string(), parts.to_string(), "{name}, {size}");
            }
            (whole, parts) => {
                panic!("{name}, {size}: {:?} but in parts {:?}", whole.as_ref().err(), parts.err())
            }
        }
    }
    whole.is_ok()
}

/// Whether the rows of a sample have a fixed length. An NPZ archive counts if its arrays do.
fn is_rows(name: &str, format: Format, gzip: bool) -> bool {
    match format {
        Format::Bgeo { .. } => true,
        Format::PlyBinary { .. } => !name.contains("lists true"),
        Format::Npy => !name.contains("Fortran"),
        Format::Npz => !gzip,
        _ => false,
    }
}

/// Whether a sample is read in parts instead of as a whole.
fn comes_in_parts(name: &str, format: Format, gzip: bool) -> bool {
    match format {
        Format::Json => false,
        Format::Npy | Format::Npz => is_rows(name, format, gzip),
        _ => true,
    }
}

#[test]
fn parts_of_any_size_are_the_whole_together() {
    fn goes_to_another_thread<T: Send>() {}
    goes_to_another_thread::<Parts<'_>>();
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
            let expected = comes_in_parts(&s.name, s.format, gzip);
            assert_eq!(!parts.in_memory(), expected, "{} {gzip}", s.name);
            rows += usize::from(!parts.in_memory());
            // If all particles fit into one part, the first pass keeps them.
            assert!(Parts::of_bytes(bytes, s.hint, samples::COUNT).unwrap().in_memory());
        }
    }
    assert!(rows > 900, "{rows}");
}

/// This many whitewater particles, with all attributes.
fn cloud(count: usize) -> Particles {
    let at = |i: usize| [i as f32 * 0.25, (i % 17) as f32, -(i as f32)];
    let mut all = Particles::from_positions((0..count).map(at).collect());
    all.velocities = Some((0..count).map(|i| [1.0, i as f32, 0.5]).collect());
    all.ids = Some((0..count as u32).rev().collect());
    all.kinds = Some((0..count as u32).map(|i| i % 3).collect());
    all.lifetimes = Some((0..count).map(|i| 4.0 - i as f32 / 7.0).collect());
    all.densities = Some((0..count).map(|i| 900.0 + (i % 400) as f32 / 4.0).collect());
    all
}

const FORMATS: [(WriteFormat, Extension); 5] = [
    (WriteFormat::Vtu, Extension::Vtu),
    (WriteFormat::Bgeo { gzip: false }, Extension::Bgeo),
    (WriteFormat::Bgeo { gzip: true }, Extension::Bgeo),
    (WriteFormat::Ply, Extension::Ply),
    (WriteFormat::Npz, Extension::Npz),
];

/// A CSV table with one line per particle.
fn table(particles: &Particles) -> Vec<u8> {
    let [ids, kinds] = [&particles.ids, &particles.kinds].map(|list| list.as_ref().unwrap());
    let mut out = String::from("x,y,z,vx,vy,vz,id,type,lifetime\n");
    for (i, position) in particles.positions.iter().enumerate() {
        for x in position.iter().chain(&particles.velocities.as_ref().unwrap()[i]) {
            write!(out, "{x},").unwrap();
        }
        let left = particles.lifetimes.as_ref().unwrap()[i];
        writeln!(out, "{},{},{left}", ids[i], kinds[i]).unwrap();
    }
    out.into_bytes()
}

fn written(particles: &Particles, format: WriteFormat) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    write_to(&mut out, particles, format).unwrap();
    out.into_inner()
}

type Make = Box<dyn Fn(&Particles) -> Vec<u8>>;

/// A way to write particles with all attributes.
struct Maker {
    name: String,
    hint: Extension,
    make: Make,
}

/// Formats that are read in parts and whose rows have no fixed length.
fn makers() -> Vec<Maker> {
    let mut all = Vec::new();
    let mut add = |name: &str, hint, make: Make| {
        all.push(Maker { name: name.into(), hint, make });
    };
    add("csv", Extension::Csv, Box::new(table));
    let xyz = |all: &Particles| {
        let line = |p: &[f32; 3]| format!("{} {}\t{}\n", p[0], p[1], p[2]);
        all.positions.iter().map(line).collect::<String>().into_bytes()
    };
    add("xyz", Extension::Xyz, Box::new(xyz));
    add(
        "raw xyz",
        Extension::Xyz,
        Box::new(|all| samples::floats(all.positions.as_flattened(), 4, false)),
    );
    add("geo", Extension::Geo, Box::new(|all| samples::geo(all).into_bytes()));
    for (version, binary, double) in
        [("2.0", true, false), ("4.2", false, true), ("5.1", false, false), ("5.1", true, true)]
    {
        add(
            &format!("vtk {version} binary {binary}"),
            Extension::Vtk,
            Box::new(move |all| samples::vtk(all, version, binary, double, double)),
        );
    }
    for (format, lists) in [
        ("ascii", false),
        ("ascii", true),
        ("binary_little_endian", true),
        ("binary_big_endian", true),
    ] {
        add(
            &format!("ply {format} lists {lists}"),
            Extension::Ply,
            Box::new(move |all| samples::ply(all, format, false, lists)),
        );
    }
    for storage in
        [Storage::Ascii, Storage::InlineBase64, Storage::AppendedBase64, Storage::AppendedRaw]
    {
        for compression in [Compression::None, Compression::Zlib, Compression::Lz4] {
            for bits in [0, 13, 30] {
                let [vtp, big, wide, pieces, double] = [1, 2, 4, 8, 16].map(|bit| bits & bit != 0);
                let xml = samples::Xml { vtp, storage, compression, big, wide, pieces, double };
                add(
                    &format!("{storage:?} {compression:?} {bits}"),
                    Extension::Vtu,
                    Box::new(move |all| xml.bytes(all)),
                );
            }
        }
    }
    all
}

/// The files are larger than one read from the file, so that reads end within lines, words, blocks
/// and groups of base64.
#[test]
fn large_files_are_read_across_all_that_is_read_at_a_time() {
    let mut next = bad::numbers();
    let particles = cloud(12_000);
    for (i, Maker { name, hint, make }) in makers().into_iter().enumerate() {
        let bytes = make(&particles);
        let size = 1 + next(12_000);
        assert!(same(&name, &bytes, hint, &[size, 1 + next(2000)]), "{name}");
        let whole = read_bytes(&bytes, hint).unwrap();
        assert_eq!(whole.positions, particles.positions, "{name}");
        assert!(whole.ids == particles.ids || hint == Extension::Xyz, "{name}");
        if i % 3 == 0 {
            assert!(same(&name, &samples::gzip(&bytes), hint, &[size]), "{name} gzip");
        }
    }
}

/// Pieces of a VTK file whose data are stored in another order than the pieces, and text without a
/// line break at its end.
#[test]
fn pieces_lie_in_any_order() {
    let particles = cloud(2000);
    let mut turned = particles.positions.clone();
    turned.rotate_left(4);
    for Maker { name, hint, make } in makers() {
        let mut bytes = make(&particles);
        let find = |bytes: &[u8], what: &[u8]| {
            bytes
                .windows(what.len())
                .enumerate()
                .filter(|(_, w)| *w == what)
                .map(|(i, _)| i)
                .collect::<Vec<_>>()
        };
        let (starts, ends) = (find(&bytes, b"<Piece"), find(&bytes, b"</Piece>\n"));
        if let ([first, second, _], [_, _, end]) = (&starts[..], &ends[..]) {
            bytes[*first..end + 9].rotate_left(second - first);
            let whole = read_bytes(&bytes, hint).unwrap();
            assert!(whole.positions == turned, "{name}");
        }
        while bytes.last() == Some(&b'\n') && hint != Extension::Xyz {
            bytes.pop();
        }
        assert!(same(&name, &bytes, hint, &[700]), "{name}");
        assert!(same(&name, &samples::gzip(&bytes), hint, &[1, 700, 1999]), "{name} gzip");
    }
}

/// Errors anywhere in files that are larger than one read from the file.
#[test]
fn large_files_that_are_damaged_have_the_same_faults() {
    let mut next = bad::numbers();
    let particles = cloud(9000);
    let (mut cases, mut read) = (0, 0);
    for Maker { name, hint, make } in makers() {
        let sound = make(&particles);
        for i in 0..16 {
            let mut bytes = sound.clone();
            // Damage in the middle of the file does not hit the header.
            let at = bytes.len() / 4 + next(bytes.len() / 2);
            match i % 4 {
                0 => bytes = bad::damaged(&bytes, &mut next),
                1 => bytes[at] ^= 1 << next(8),
                2 => bytes[at] = b"x-. \n=A\xff"[next(8)],
                _ => bytes.truncate(at),
            }
            cases += 1;
            read += usize::from(same(&name, &bytes, hint, &[1 + next(4000)]));
        }
    }
    println!("{cases} damaged files, {read} of them read");
    assert!(cases > 700 && read > 100 && read < cases / 2, "{read} of {cases}");
}

#[test]
fn what_only_all_particles_tell_is_told() {
    // More particles than the sample that tells whether positions need more than 32 bits. The last
    // case has no particles.
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
        let bytes = table(&particles);
        assert!(same(what, &bytes, Extension::Csv, &[1000, 4096, count, count + 1]));
        let warnings = read_bytes(&bytes, Extension::Csv).unwrap().warnings;
        assert_eq!(warnings.is_empty(), what == "none", "{what}: {warnings:?}");
    }
}

/// If a later part shows that an attribute is invalid, no part has this attribute.
#[test]
fn what_is_dropped_is_dropped_from_all_parts() {
    let particles = cloud(50);
    let mut bytes = written(&particles, WriteFormat::Bgeo { gzip: false });
    // A row has x y z w, velocity, density, id, lifetime, type: 44 bytes, with the id at byte 32.
    // Two bytes follow the last row.
    let row = |i: usize| bytes.len() - 2 - 44 * (50 - i);
    let (id, kind) = (row(33) + 32, row(49) + 40);
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
    let mut odd = String::from_utf8(table(&particles)).unwrap();
    for (from, to) in [(",16,0,", ",-16,0,"), (",0,1,", ",0,1.5,")] {
        assert!(odd.contains(from));
        odd = odd.replace(from, to);
        assert!(same(to, odd.as_bytes(), Extension::Csv, &[1, 7, 20, 49, 50]));
        let parts = Parts::of_bytes(odd.as_bytes(), Extension::Csv, 10).unwrap();
        assert!(parts.about().ids.is_none() && !parts.about().warnings.is_empty());
        assert_eq!(parts.about().kinds.is_some(), to != ",0,1.5,");
    }
    // Several types are not integers; the message names the first.
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

/// Attributes of different lengths are found from the headers, before any number is read.
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
    // Elements before the vertices are skipped, whatever line ending the header uses.
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

/// Headers longer than the first read from the file, for every alignment of the end.
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
            if !comes_in_parts(&s.name, s.format, gzip) {
                continue;
            }
            // Other samples are cut at fewer lengths: their encodings differ little at the start of
            // the file.
            let rows = is_rows(&s.name, s.format, gzip);
            let step = if rows { 1 } else { (bytes.len() / 40).max(1) };
            for length in (0..bytes.len()).step_by(step) {
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

/// The bytes after the last particle are checked too, in files larger than the read that detects
/// the format.
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
            // The checksum comes before the length, which ends the file.
            let mut bytes = bytes;
            bytes[end - 8] ^= 1;
            assert!(!same("checksum", &bytes, hint, &[999, 5000]));
        }
    }
    // A flipped bit of a number in an uncompressed array of a ZIP archive.
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
        if !comes_in_parts(&s.name, s.format, false) {
            continue;
        }
        let of_many = matches!(s.format, Format::Vtu(..) | Format::Vtp(..));
        for i in 0..if of_many { 24 } else { 400 } {
            let mut bytes = bad::damaged(&s.bytes, &mut next);
            if i % 4 == 0 {
                bytes = samples::gzip(&bytes);
            }
            let sizes = [1 + next(samples::COUNT + 2)];
            cases += 1;
            let ((), peak) = allocation::peak(|| {
                if s.format == Format::Npz {
                    // If an archive has several errors, the two ways of reading may find different
                    // ones first.
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
            // The LZMA decoder allocates its whole dictionary.
            let fixed = if s.name.contains("lzma") { 68 << 20 } else { 2 << 20 };
            assert!(peak <= fixed + 300 * bytes.len(), "{}: {peak} bytes held", s.name);
        }
    }
    println!("{cases} damaged files, {read} of them read");
    assert!(cases > 20_000 && read > 1000 && read < cases / 2, "{read} of {cases}");
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
    let text = samples::gzip(&vec![b'0'; 40 << 20]);
    let xml = samples::gzip(&[&b"<VTKFile>"[..], &vec![b'<'; 40 << 20]].concat());
    for (bomb, hint) in [(&bomb, Extension::Bgeo), (&text, Extension::Csv), (&xml, Extension::Vtu)]
    {
        let (result, peak) = allocation::peak(|| Parts::of_bytes(bomb, hint, 1000).map(drop));
        assert!(matches!(result, Err(ReadError::TooLarge { .. })), "{result:?}");
        assert!(peak < 2 << 20, "{hint:?}: {peak}");
    }
}

/// Memory bound that [`Parts`] documents.
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
        let path = folder.path().join(name);
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
    // The arrays of an archive are unpacked side by side. There are fewer particles, because
    // compression is slow.
    let path = folder.path().join("a.npz");
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

/// The other formats have the same memory bound, also within gzip.
#[test]
fn text_and_arrays_take_no_more_memory_than_a_part() {
    const COUNT: usize = 50_000;
    const SIZE: usize = 1000;
    let particles = cloud(COUNT);
    for (i, Maker { name, hint, make }) in makers().into_iter().enumerate() {
        let plain = make(&particles);
        let packed = (i % 5 == 0).then(|| samples::gzip(&plain));
        for bytes in std::iter::once(&plain).chain(&packed) {
            let gzip = bytes.len() != plain.len();
            let (found, peak) = allocation::peak(|| {
                let parts = Parts::of_bytes(bytes, hint, SIZE).unwrap();
                assert!(!parts.in_memory());
                let mut last = None;
                let mut found = 0;
                for part in parts {
                    found += part.as_ref().unwrap().positions.len();
                    last = Some(part);
                }
                drop(last);
                found
            });
            println!("{name}, gzip {gzip}: {peak} bytes held, {} allowed", bound(SIZE));
            assert!(found == COUNT && peak <= bound(SIZE), "{name} {gzip}: {peak} bytes held");
        }
    }
}

/// Columns that would be positions if there were no better ones.
#[test]
fn columns_of_no_meaning_take_no_memory() {
    const SIZE: usize = 20_000;
    let more = ["point", "points", "position", "pos", "coords", "p"].map(|name| {
        [":0", ":1", ":2", "_x", "_y", "_z"].map(|end| format!(",{name}{end}")).concat()
    });
    let mut text = format!("x,y,z{}\n", more.concat());
    (0..60_000).for_each(|i| text += &format!("{i},1,2{}\n", ",7".repeat(36)));
    let (found, peak) = allocation::peak(|| {
        let parts = Parts::of_bytes(text.as_bytes(), Extension::Csv, SIZE).unwrap();
        parts.map(|part| part.unwrap().positions.len()).sum::<usize>()
    });
    assert!(found == 60_000 && peak <= bound(SIZE), "{found}: {peak} bytes held");
}

/// A velocity that is split into three attributes is read from three positions of the file, and the
/// file may be compressed twice.
#[test]
fn many_attributes_take_no_more_memory_than_is_said() {
    const SIZE: usize = 500;
    let particles = cloud(30_000);
    for compression in [Compression::None, Compression::Zlib, Compression::Lz4] {
        for storage in [Storage::AppendedBase64, Storage::Ascii] {
            let xml = samples::Xml {
                vtp: true,
                storage,
                compression,
                big: false,
                wide: false,
                pieces: false,
                double: true,
            };
            let text = String::from_utf8(xml.bytes(&particles)).unwrap();
            let from = text.find("<DataArray type=\"Float64\" Name=\"density\"").unwrap();
            let to = from + text[from..].find("<DataArray type=\"UInt64\" Name=\"id\"").unwrap();
            let density = &text[from..to];
            let more = ["vx", "vy", "vz", "lifetime", "type"]
                .map(|name| density.replace("\"density\"", &format!("\"{name}\"")));
            let text = text[..from].to_string() + &more.concat() + &text[from..];
            let text = text.replace("Name=\"velocity\"", "Name=\"other\"");
            let packed = samples::gzip(text.as_bytes());
            for (bytes, fixed) in [(text.as_bytes(), 2 << 20), (&packed, 4 << 20)] {
                let (found, peak) = allocation::peak(|| {
                    let mut parts = Parts::of_bytes(bytes, Extension::Vtp, SIZE).unwrap();
                    let about = parts.about();
                    assert!(about.velocities.is_some() && about.lifetimes.is_some());
                    assert!(about.ids.is_some() && about.densities.is_some());
                    parts.try_fold(0, |sum, part| part.map(|part| sum + part.positions.len()))
                });
                println!("{storage:?} {compression:?}: {peak} bytes held, {fixed} allowed");
                assert_eq!(found.unwrap(), 30_000);
                assert!(peak <= 160 * SIZE + fixed, "{storage:?} {compression:?}: {peak}");
            }
        }
    }
}

/// A VTP file of `count` points in blocks of zlib, with `behind` unused bytes after each block.
fn blocks(count: usize, blocks: usize, behind: usize) -> (Vec<u8>, Vec<[f32; 3]>) {
    let positions = cloud(count).positions;
    let raw = samples::floats(positions.as_flattened(), 4, false);
    let size = raw.len() / blocks;
    let packed = raw.chunks(size).map(|block| {
        let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        std::io::Write::write_all(&mut packed, block).unwrap();
        let mut packed = packed.finish().unwrap();
        packed.resize(packed.len() + behind, 0x55);
        packed
    });
    let packed: Vec<Vec<u8>> = packed.collect();
    let mut head = vec![packed.len() as u32, size as u32, 0];
    head.extend(packed.iter().map(|block| block.len() as u32));
    let bytes = [
        format!(
            "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece \
             NumberOfPoints=\"{count}\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" \
             format=\"appended\" offset=\"0\"/></Points></Piece></PolyData><AppendedData encoding=\"raw\">_"
        )
        .into_bytes(),
        samples::ints(&head, 4, false),
        packed.concat(),
    ]
    .concat();
    (bytes, positions)
}

/// If a whole array is one block, it is unpacked piece by piece.
#[test]
fn a_block_may_be_larger_than_a_part() {
    const COUNT: usize = 400_000;
    let (bytes, _) = blocks(COUNT, 1, 0);
    let (all, peak) = allocation::peak(|| {
        let parts = Parts::of_bytes(&bytes, Extension::Vtp, 1000).unwrap();
        parts.map(|part| part.unwrap().positions.len()).sum::<usize>()
    });
    assert!(all == COUNT && peak <= bound(1000), "{all} {peak}");
    assert!(same("block", &bytes, Extension::Vtp, &[150_001]));
    // The block unpacks to more bytes than its header says.
    let size = (12 * COUNT as u32).to_le_bytes();
    let at = bytes.windows(4).position(|window| window == size).unwrap();
    let mut more = bytes.clone();
    more[at..at + 4].copy_from_slice(&(12 * COUNT as u32 - 12).to_le_bytes());
    let at = more.windows(6).position(|window| window == b"400000").unwrap();
    more[at..at + 6].copy_from_slice(b"399999");
    assert!(!same("more", &more, Extension::Vtp, &[1000, 150_001]));
    let said = read_bytes(&more, Extension::Vtp).unwrap_err().to_string();
    assert!(said.contains("unpacks to more than 4799988 bytes"), "{said}");
    // A wrong byte, missing bytes, and a wrong checksum.
    let (at, end) = (bytes.len() - 100, bytes.len() - 1);
    for (name, bytes) in [
        ("flipped", [&bytes[..at], &[!bytes[at]], &bytes[at + 1..]].concat()),
        ("cut off", bytes[..at].to_vec()),
        ("checksum", [&bytes[..end], &[!bytes[end]]].concat()),
    ] {
        assert!(!same(name, &bytes, Extension::Vtp, &[1000, 150_001]), "{name}");
    }
}

#[test]
fn what_is_behind_the_end_of_a_block_is_passed_over() {
    for behind in [0, 1, 40_000] {
        let (bytes, positions) = blocks(9000, 3, behind);
        assert!(same("behind", &bytes, Extension::Vtp, &[1, 1700, 9000]), "{behind}");
        assert_eq!(read_bytes(&bytes, Extension::Vtp).unwrap().positions, positions, "{behind}");
    }
}

/// Padding may only end base64: within the text it is an error, wherever a chunk of decoded text
/// ends.
#[test]
fn padding_stands_at_the_end_alone() {
    let xml = samples::Xml {
        vtp: true,
        storage: Storage::AppendedBase64,
        compression: Compression::None,
        big: false,
        wide: true,
        pieces: false,
        double: false,
    };
    let sound = xml.bytes(&cloud(5000));
    let text = String::from_utf8(sound.clone()).unwrap();
    let offset = text.rfind("offset=\"").unwrap() + 8;
    let offset: usize = text[offset..].split('"').next().unwrap().parse().unwrap();
    let points = text.find("\n   _").unwrap() + 5 + offset;
    let steps = [12, 16_384, 16_396, 2 * 16_384, 2 * 16_384 + 12, 3 * 16_384, 4 * 16_384];
    for end in steps.into_iter().flat_map(|step| step - 4..step + 8) {
        let mut bytes = sound.clone();
        bytes[points + end] = b'=';
        assert!(!same("padding", &bytes, Extension::Vtp, &[700]), "{end}");
        let said = read_bytes(&bytes, Extension::Vtp).unwrap_err().to_string();
        // Here the padding ends text that could be a separate header, so the numbers lack a byte.
        let expected = if end == 11 { "needs 60000 bytes" } else { "base64 in array `Points`" };
        assert!(said.contains(expected), "{end}: {said}");
    }
}

/// Long texts in XML elements are read directly from the file. Whatever surrounds them, the result
/// is as if the file were in memory.
#[test]
fn long_texts_in_elements_are_read_where_they_are() {
    let numbers = |count: usize| {
        let row = |i: usize| format!("{i} {} -{i}\n", i % 7);
        (0..count).map(row).collect::<String>()
    };
    let file = |points: usize, before: &str, inside: &str, after: &str| {
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\"><PolyData>{before}\n<Piece \
             NumberOfPoints=\"{points}\">\n<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" \
             format=\"ascii\">{inside}</DataArray></Points>{after}</Piece></PolyData></VTKFile>\n"
        )
    };
    let long = numbers(500);
    let (first, second) = long.split_at(long.find("250 ").unwrap());
    let space = " \n".repeat(300);
    let comment = format!("<!-- a > b, <DataArray> \" {space} -->");
    let key = "<InformationKey name=\"r\"><Value index=\"0\">1</Value></InformationKey>";
    let named = format!("<FieldData><DataArray Name=\"{}>\"/></FieldData>", "a".repeat(99));
    let other = format!("<FieldData><DataArray type=\"Int32\">{long}</DataArray></FieldData>");
    for (name, bytes) in [
        ("plain", file(500, "", &long, "")),
        ("mark", file(500, "", &long, "").replace("<?xml", "\u{feff}<?xml")),
        ("lines", file(500, "", &long, "").replace('\n', "\r\n")),
        ("space", file(500, &space, &format!("{space}{long}{space}"), &space)),
        ("comments", file(500, &comment, &format!("{comment}{long}{comment}9"), &comment)),
        ("key", file(500, "", &format!("{space}{key}{space}{long}{key}{space}"), "")),
        ("attribute", file(500, &named, &long, &named)),
        ("other", file(500, &other, &long, &other)),
        ("instruction", file(500, "<?a b > c?>", &format!("<?a b?>{long}"), "")),
        // Texts with references or CDATA cannot be read directly from the file.
        ("entity", file(500, "", &format!("{first}&#32;{second}"), "")),
        ("characters", file(500, "", &format!("<![CDATA[{first}]]>{second}"), "")),
        ("characters behind", file(500, "", &format!("{first}<![CDATA[{second}]]>"), "")),
    ] {
        for bytes in [bytes.as_bytes(), &samples::gzip(bytes.as_bytes())] {
            same(name, bytes, Extension::Vtp, &[1, 77, 400]);
            let whole = read_bytes(bytes, Extension::Vtp).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(whole.positions.len(), 500, "{name}");
            assert_eq!(whole.positions[499], [499.0, (499 % 7) as f32, -499.0], "{name}");
        }
    }
    // Errors name the place in the file.
    let line = |text: &str, needle: &str| text[..text.find(needle).unwrap()].split('\n').count();
    let say = |bytes: &[u8]| {
        assert!(!same("fault", bytes, Extension::Vtp, &[1, 77, 400]));
        read_bytes(bytes, Extension::Vtp).unwrap_err().to_string()
    };
    let data = |name: &str, inside: &str| {
        format!(
            "<PointData>\n<DataArray type=\"Int32\" Name=\"{name}\">{inside}</DataArray></PointData>"
        )
    };
    let ids = (0..500).map(|i| format!("{i}\n")).collect::<String>();
    for (inside, expected) in [
        (ids.replace("\n250\n", "\nx50\n"), "a number for id, found \"x50\" in line"),
        (ids.replace("\n250\n", "\n"), "id at byte"),
        (format!("{ids}7"), "expected 500 values"),
    ] {
        let text = file(500, &space, &long, &data("id", &inside));
        let said = say(text.as_bytes());
        assert!(said.contains(expected), "{said}");
        let place = match expected.contains("line") {
            true => format!("in line {}", line(&text, "<DataArray type=\"Int32\"")),
            false => format!("at byte {}", text.find("<DataArray type=\"Int32\"").unwrap()),
        };
        assert!(said.contains(&place) || expected.contains("500"), "{said}, not {place}");
    }
    let text = file(500, &space, &long, &format!("{space}{}<a b=c/>", "x".repeat(70)));
    let column = text.lines().find_map(|line| line.find("<a b=c")).unwrap() + 6;
    let said = say(text.as_bytes());
    let place = format!(" at {}:{column} in line", line(&text, "<a b=c"));
    assert!(said.contains(&place), "{said}, not {place}");
    let (before, after) = text.split_at(text.find("<a b=c").unwrap());
    let bytes = [before.as_bytes(), b"\xff", after.as_bytes()].concat();
    let said = say(&bytes);
    assert!(
        said.contains(&format!("UTF-8, found another byte at byte {}", before.len())),
        "{said}"
    );
}

#[test]
fn a_file_that_changes_on_the_way_is_an_error() {
    let folder = Folder::new("changed");
    let path = folder.path().join("a.bgeo");
    let sound = written(&cloud(100), WriteFormat::Bgeo { gzip: false });
    std::fs::write(&path, &sound).unwrap();
    let mut parts = Parts::open(&path, 30).unwrap();
    assert_eq!(parts.next().unwrap().unwrap().positions.len(), 30);
    std::fs::write(&path, &sound[..sound.len() / 2]).unwrap();
    let faults: Vec<_> = parts.by_ref().filter_map(Result::err).collect();
    assert_eq!(faults.len(), 1);
    assert!(faults[0].to_string().contains("a.bgeo: the file ends too early"), "{}", faults[0]);
    assert!(parts.next().is_none());
    // The second pass finds an invalid id that was valid in the first pass.
    std::fs::write(&path, &sound).unwrap();
    let parts = Parts::open(&path, 30).unwrap();
    let mut other = sound.clone();
    let row = other.len() - 2 - 44;
    other[row + 32] = 0x80;
    std::fs::write(&path, &other).unwrap();
    let fault = parts.map(|part| part.map(drop)).find_map(Result::err).unwrap().to_string();
    assert!(fault.contains("the first reading"), "{fault}");
    // The file becomes shorter, longer, or gets an invalid number between the two passes.
    let rows = table(&cloud(100));
    let xml = samples::Xml {
        vtp: false,
        storage: Storage::AppendedRaw,
        compression: Compression::None,
        big: false,
        wide: false,
        pieces: false,
        double: false,
    };
    let arrays = xml.bytes(&cloud(100));
    for (name, sound) in [("a.csv", rows), ("a.vtu", arrays)] {
        let path = folder.path().join(name);
        let cut = sound[..sound.len() * 2 / 3].to_vec();
        let longer = [&sound[..], b"1,2,3,4,5,6,7,8,9\n"].concat();
        let mut other = sound.clone();
        other[sound.len() * 2 / 3] = b'x';
        let mut changes = vec![("cut", cut, 1), ("longer", longer, 0)];
        if name == "a.csv" {
            let text = String::from_utf8(sound.clone()).unwrap();
            let without = |line: &str| line.rsplit_once(',').unwrap().0.to_string() + "\n";
            changes.push(("a number that is none", other, 1));
            changes.push((
                "a column less",
                text.lines().map(without).collect::<String>().into(),
                1,
            ));
        }
        for (what, now, faults) in changes {
            std::fs::write(&path, &sound).unwrap();
            let mut parts = Parts::open(&path, 30).unwrap();
            std::fs::write(&path, &now).unwrap();
            let found: Vec<_> = parts.by_ref().collect();
            let last = found.iter().filter_map(|part| part.as_ref().err()).map(ToString::to_string);
            let last: Vec<_> = last.collect();
            assert_eq!(last.len(), faults, "{name} {what}: {last:?}");
            assert!(last.iter().all(|said| said.contains(name)), "{last:?}");
            let positions = found.iter().flatten().map(|part| part.positions.len()).sum::<usize>();
            assert_eq!(positions == 100, faults == 0, "{name} {what}");
            assert!(parts.next().is_none());
        }
    }
    // Errors of missing or wrong files have the same text as those of `read`.
    let missing = folder.path().join("none.ply");
    let said = |error: ReadError| error.to_string();
    assert_eq!(said(Parts::open(&missing, 1).unwrap_err()), said(read(&missing).unwrap_err()));
    assert_eq!(
        said(Parts::open(folder.path(), 1).unwrap_err()),
        said(read(folder.path()).unwrap_err())
    );
    std::fs::write(&path, &sound[..99]).unwrap();
    assert_eq!(said(Parts::open(&path, 1).unwrap_err()), said(read(&path).unwrap_err()));
}
