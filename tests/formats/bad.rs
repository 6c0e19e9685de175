//! Bad input gives an error that describes the problem: never a panic, and never an allocation for
//! a false size in a header.

use std::path::Path;

use super::samples::{self, Has};
use super::{allocation, samples::npy};
use whitewater::io::particles::{
    Compression, Extension, Format, Particles, Parts, ReadError, Storage, read, read_bytes,
    read_step, steps,
};

const HINTS: [Extension; 15] = [
    Extension::Bgeo,
    Extension::Geo,
    Extension::Sc,
    Extension::Vtk,
    Extension::Vtu,
    Extension::Vtp,
    Extension::Ply,
    Extension::Npy,
    Extension::Npz,
    Extension::Csv,
    Extension::Xyz,
    Extension::Text,
    Extension::Json,
    Extension::Bobj,
    Extension::Unknown,
];

/// Asserts that reading fails, and that the message contains each of `parts`. Returns the error.
fn refused(bytes: &[u8], hint: Extension, parts: &[&str]) -> ReadError {
    match read_bytes(bytes, hint) {
        Ok(p) => panic!(
            "{} particles read from {:?}",
            p.positions.len(),
            bytes.escape_ascii().to_string()
        ),
        Err(e) => {
            for part in parts {
                assert!(e.to_string().contains(part), "`{part}` is not in: {e}");
            }
            e
        }
    }
}

/// Reads bytes. Asserts what holds for every result, and that memory is proportional to the input.
fn read_checked(name: &str, bytes: &[u8], hint: Extension) -> Result<Particles, ReadError> {
    let (result, peak) = allocation::peak(|| read_bytes(bytes, hint));
    // The LZMA decoder allocates its whole dictionary, at most 64 MiB, and up to 2 MiB more.
    let fixed = if name.contains("lzma") { 68 << 20 } else { 1 << 20 };
    // Compressed samples have a few kB at most. LZ4 and JSON take up to 300 bytes per byte of
    // input.
    let limit = fixed + 300 * bytes.len();
    assert!(peak <= limit, "{name}: {peak} bytes held for {} of input", bytes.len());
    if let Ok(p) = &result {
        let n = p.positions.len();
        let lengths = [
            p.velocities.as_ref().map(Vec::len),
            p.densities.as_ref().map(Vec::len),
            p.ids.as_ref().map(Vec::len),
            p.lifetimes.as_ref().map(Vec::len),
            p.kinds.as_ref().map(Vec::len),
        ];
        assert!(lengths.iter().flatten().all(|l| *l == n), "{name}: {lengths:?} for {n}");
    }
    if let Err(e) = &result {
        assert!(e.to_string().len() < 3000, "{name}: {e}");
    }
    result
}

#[test]
fn no_bytes() {
    for hint in HINTS {
        assert!(matches!(refused(b"", hint, &["empty"]), ReadError::Empty));
    }
    let empty = samples::gzip(b"");
    assert!(matches!(refused(&empty, Extension::Bgeo, &[]), ReadError::Empty));
}

#[test]
fn missing_file_and_directory() {
    let missing = read(Path::new("/no/such/folder/frame_1.bgeo")).unwrap_err();
    assert!(matches!(missing, ReadError::Io { .. }));
    assert!(missing.to_string().contains("frame_1.bgeo"));
    let folder = read(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap_err();
    assert!(matches!(folder, ReadError::Directory { .. }));
    assert!(folder.to_string().contains("*.bgeo"));
}

#[test]
fn unknown_extension() {
    let error = refused(
        b"1 2 3\n",
        Extension::from_path(Path::new("a.abc")),
        &["unknown extension", "1 2 3"],
    );
    assert!(matches!(error, ReadError::UnknownFormat { .. }));
    // Rows of three numbers are positions, also below names, or below a count and a comment.
    let rows = "0.5 1 2\n0.5 1 3\n0.5 1 4\n";
    for head in ["", "# dam\n", "x y z\n", "3\n\n", "3\nframe 1\n"] {
        let p = read_bytes(format!("{head}{rows}").as_bytes(), Extension::Unknown).unwrap();
        assert_eq!(p.positions[2], [0.5, 1.0, 4.0], "{head}");
    }
    let p = read_bytes(rows.replace(' ', ",").as_bytes(), Extension::Unknown).unwrap();
    assert_eq!(p.positions.len(), 3);
    for other in [
        "a log\n1 2 3\n4 5\n6 7 8\n",
        "1 2\n3 4\n5 6\n",
        "one two three\nfour\nfive\n1 2 3\n1 2 3\n1 2 3\n",
    ] {
        refused(other.as_bytes(), Extension::Unknown, &["unknown extension"]);
    }
    // A wrong file extension does not permit guessing either.
    refused(b"1 2 3\n", Extension::Ply, &["Ply"]);
    refused(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11], Extension::Unknown, &[]);
}

#[test]
fn known_formats_that_are_not_read_say_what_to_do() {
    refused(b"\x7fNSJb\0\0\0", Extension::Bgeo, &["Houdini", "classic BGEO"]);
    refused(b"scf1\0\0\0\0", Extension::Sc, &["Blosc", "classic BGEO"]);
    refused(b"[\"fileversion\",\"18.5\"]", Extension::Geo, &["Houdini", "classic BGEO"]);
    refused(
        b"<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid/></VTKFile>",
        Extension::Vtu,
        &["names other files"],
    );
    refused(
        b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n",
        Extension::Vtk,
        &["STRUCTURED_POINTS", "POLYDATA"],
    );
    refused(&npy("<f16", "(1, 3)", false, 1, &[0; 48]), Extension::Npy, &["<f16", "astype"]);
}

#[test]
fn wrong_counts() {
    // More points than bytes, and the largest numbers that the header can hold.
    for (at, value) in [(9, 12_i32), (9, i32::MAX), (9, -1), (25, 1000), (25, i32::MAX)] {
        let mut bytes = samples::bgeo(&samples::cloud());
        bytes[at..at + 4].copy_from_slice(&value.to_be_bytes());
        assert!(read_checked("bgeo", &bytes, Extension::Bgeo).is_err(), "{at} {value}");
    }
    let swap = |bytes: Vec<u8>, from: &str, to: &str| {
        let at = bytes
            .windows(from.len())
            .position(|w| w == from.as_bytes())
            .unwrap_or_else(|| panic!("no {from}"));
        [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat()
    };
    let huge = "18446744073709551615";
    for binary in [false, true] {
        for (from, to) in [
            ("POINTS 11", format!("POINTS {huge}")),
            ("CELLS 12 11", format!("CELLS {huge} {huge}")),
            ("density 1 11", format!("density 1 {huge}")),
            ("FieldData 3", format!("FieldData {huge}")),
            ("density 1 11", "density 3 11".into()),
            ("density 1 11", "density 1 10".into()),
            ("POINT_DATA 11", "POINT_DATA 10".into()),
        ] {
            let bytes =
                swap(samples::vtk(&samples::cloud(), "5.1", binary, false, false), from, &to);
            let result = read_checked("vtk", &bytes, Extension::Vtk);
            assert!(result.is_err(), "{binary} {from} {to}");
        }
    }
    for storage in
        [Storage::Ascii, Storage::InlineBase64, Storage::AppendedBase64, Storage::AppendedRaw]
    {
        for compression in [Compression::None, Compression::Zlib, Compression::Lz4] {
            let xml = samples::Xml {
                vtp: false,
                storage,
                compression,
                big: false,
                wide: false,
                pieces: false,
                double: false,
            };
            for points in ["10", "12", huge, "-1", "many"] {
                let bytes = swap(
                    xml.bytes(&samples::cloud()),
                    "NumberOfPoints=\"11\"",
                    &format!("NumberOfPoints=\"{points}\""),
                );
                assert!(
                    read_checked("vtu", &bytes, Extension::Vtu).is_err(),
                    "{storage:?} {compression:?} {points}"
                );
            }
        }
    }
    for format in ["ascii", "binary_little_endian"] {
        for count in ["12", huge, "-1"] {
            let bytes = swap(
                samples::ply(&samples::cloud(), format, false, false),
                "vertex 11",
                &format!("vertex {count}"),
            );
            assert!(read_checked("ply", &bytes, Extension::Ply).is_err(), "{format} {count}");
        }
    }
    for shape in
        ["(12, 3)", "(18446744073709551615, 3)", "(11, 4)", "(33,)", "(4294967296, 4294967296, 3)"]
    {
        let bytes = npy("<f4", shape, false, 1, &[0; 132]);
        assert!(read_checked("npy", &bytes, Extension::Npy).is_err(), "{shape}");
    }
    let raw = samples::floats(samples::cloud().positions.as_flattened(), 4, false);
    refused(&raw[..raw.len() - 1], Extension::Xyz, &["12 bytes", "byte 120"]);
    refused(b"3\n0 0 0\n1 1 1\n", Extension::Xyz, &["expected 3", "found 2"]);
}

#[test]
fn lengths_that_differ_name_the_attribute() {
    let json = b"{\"position\": [[0,0,0],[1,1,1]], \"density\": [1000]}";
    let error = refused(json, Extension::Json, &["density", "expected 2", "found 1"]);
    assert!(matches!(error, ReadError::Length { .. }));
    let arrays = [
        ("position", npy("<f4", "(2, 3)", false, 1, &[0; 24])),
        ("velocity", npy("<f4", "(1, 3)", false, 1, &[0; 12])),
    ];
    refused(&samples::npz(&arrays, true), Extension::Npz, &["velocity", "expected 6", "found 3"]);
}

#[test]
fn places_are_told() {
    refused(b"x,y,z\n0,0,0\n0,zero,0\n", Extension::Csv, &["line 3", "zero", "`y`"]);
    refused(b"x,y,z\n0,0,0\n0,0\n", Extension::Csv, &["line 3", "3 fields"]);
    refused(b"0 0 0\n0 0\n", Extension::Xyz, &["line 2"]);
    refused(b"[[0,0,0],\n[0,0]]", Extension::Json, &["3 numbers", "found 2"]);
    refused(b"[[0,0,0],\n[0,0 0]]", Extension::Json, &["line 2"]);
    refused(
        b"a,b\n1,2\n",
        Extension::Csv,
        &["expected positions", "a: 1 x number", "b: 1 x number"],
    );
    refused(
        b"ply\nformat ascii 1.0\nelement vertex one\n",
        Extension::Ply,
        &["line 3", "vertex one"],
    );
    // The message names the missing number instead of the next line, which the reader takes for it.
    let head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n";
    let vtk = |points: &str| format!("{head}{points}\nPOINT_DATA 2\nVECTORS v float\n1 2 3 4 5 6");
    let said = ["a number for POINTS, found \"POINT_DATA\"", "at byte 74"];
    refused(vtk("0 0 0 1").as_bytes(), Extension::Vtk, &said);
    assert!(read_bytes(vtk("0 0 0 1 1 1").as_bytes(), Extension::Vtk).is_ok());
    let mut bytes = samples::bgeo(&samples::cloud());
    bytes.truncate(200);
    refused(&bytes, Extension::Bgeo, &["the points", "at byte 154", "528", "46 are there"]);
}

/// If two arrays may be the velocities, one is used, but the other must be valid too.
#[test]
fn arrays_that_have_no_meaning_are_checked() {
    let array = |name: &str, numbers: &str| {
        format!(
            "<DataArray type=\"Float32\" Name=\"{name}\" NumberOfComponents=\"3\">{numbers}</DataArray>"
        )
    };
    let file = |second: &str| {
        format!(
            "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\"><PointData>{}{}</PointData>\
             <Points>{}</Points></Piece></PolyData></VTKFile>",
            array("velocity", "1 2 3"),
            array("v", second),
            array("Points", "0 0 0"),
        )
    };
    let sound = read_bytes(file("4 5 6").as_bytes(), Extension::Vtp).unwrap();
    assert_eq!(sound.velocities, Some(vec![[1.0, 2.0, 3.0]]));
    for (numbers, said) in [("4 x 6", "a number for v"), ("4 5", "v at byte"), ("4 5 6 7", "`v`")] {
        refused(file(numbers).as_bytes(), Extension::Vtp, &[said]);
    }
}

#[test]
fn an_unknown_vtk_section_ends_the_reading_with_a_warning() {
    let mut bytes = samples::vtk(&samples::cloud(), "4.2", true, false, false);
    bytes.extend(b"HYPERDATA h 3\n\x00\x01\x02");
    let p = read_bytes(&bytes, Extension::Vtk).unwrap();
    samples::check("vtk", &p, Has::All);
    let place = format!("at byte {}", bytes.len() - 17);
    assert!(
        p.warnings[0].contains("HYPERDATA") && p.warnings[0].contains(&place),
        "{:?}",
        p.warnings
    );
}

#[test]
fn nan_and_infinity_are_kept_and_counted() {
    let text = "x y z\n0 0 0\nnan 0 0\n0 -inf 0\n1 1 1e300\n-1.#IND 0 0\n";
    let p = read_bytes(text.as_bytes(), Extension::Xyz).unwrap();
    assert_eq!(p.positions.len(), 5);
    assert_eq!(whitewater::io::particles::count_non_finite(&p.positions), 4);
    assert!(p.warnings.iter().any(|w| w.contains("4 of 5")), "{:?}", p.warnings);
    let clean = read_bytes(b"0 0 0\n1 1 1\n", Extension::Xyz).unwrap();
    assert!(clean.warnings.is_empty(), "{:?}", clean.warnings);
}

#[test]
fn ids_that_do_not_fit_are_dropped() {
    for id in ["-1", "0.5", "1e30", "nan"] {
        let text = format!("x,y,z,id\n0,0,0,1\n1,1,1,{id}\n");
        let p = read_bytes(text.as_bytes(), Extension::Csv).unwrap();
        assert_eq!(p.ids, None, "{id}");
        assert!(p.warnings.iter().any(|w| w.contains("`id`")), "{id}: {:?}", p.warnings);
    }
    let arrays = [
        ("x", npy("<f4", "(2, 3)", false, 1, &[0; 24])),
        ("id", npy("<u8", "(2,)", false, 1, &[0xff; 16])),
    ];
    let p = read_bytes(&samples::npz(&arrays, false), Extension::Npz).unwrap();
    assert_eq!(p.ids, None);
    let p = read_bytes(b"x,y,z,id\n0,0,0,4294967295\n", Extension::Csv).unwrap();
    assert_eq!(p.ids, Some(vec![u32::MAX]));
}

/// The lower halves of ids beyond 32 bits may repeat: here they are numbers of particles within a process.
#[test]
fn long_ids_differ_as_a_whole() {
    let row = |i: u64| {
        format!("{},{},{},{}\n", i % 10, i / 10 % 10, i / 100, ((i / 50) << 32) | (i % 50))
    };
    let frame = |order: fn(u64) -> u64| {
        let text: String = (0..1000).map(|i| row(order(i))).collect();
        read_bytes(format!("x,y,z,id\n{text}").as_bytes(), Extension::Csv).unwrap()
    };
    let [first, second] = [frame(|i| i), frame(|i| 999 - i)];
    assert!(first.warnings.is_empty(), "{:?}", first.warnings);
    let ids = first.ids.unwrap();
    assert_eq!(ids[..50], *(0..50).collect::<Vec<_>>());
    assert_eq!(ids.iter().collect::<std::collections::HashSet<_>>().len(), 1000);
    // A particle has one id in all frames.
    assert!(second.ids.unwrap().iter().rev().eq(&ids));
}

#[test]
fn far_from_the_origin_is_warned_of() {
    let row = |offset: f64| format!("{} 0 0\n{} 0 1\n", offset, offset + 1.0);
    let far = read_bytes(row(1e5).as_bytes(), Extension::Xyz).unwrap();
    assert!(far.warnings.iter().any(|w| w.contains("origin")), "{:?}", far.warnings);
    let near = read_bytes(row(1e3).as_bytes(), Extension::Xyz).unwrap();
    assert!(near.warnings.is_empty(), "{:?}", near.warnings);
}

#[test]
fn what_unpacks_without_end_is_refused() {
    let bomb = samples::gzip(&vec![b'0'; 40 << 20]);
    let (result, peak) = allocation::peak(|| read_bytes(&bomb, Extension::Xyz));
    assert!(matches!(result, Err(ReadError::TooLarge { .. })), "{result:?}");
    assert!(peak < 64 << 20, "{peak}");
}

#[test]
fn pieces_that_share_data_are_bounded() {
    // A thousand pieces refer to the same compressed array of a hundred thousand points.
    use std::io::Write;
    let raw = vec![0_u8; 1_200_000];
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    packed.write_all(&raw).unwrap();
    let packed = packed.finish().unwrap();
    let piece = "<Piece NumberOfPoints=\"100000\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece>";
    let mut bytes = format!(
        "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><PolyData>{}</PolyData><AppendedData encoding=\"raw\">_",
        piece.repeat(1000)
    )
    .into_bytes();
    bytes.extend(samples::ints(&[1, 1_200_000, 0, packed.len() as u32], 4, false));
    bytes.extend(packed);
    let (result, peak) = allocation::peak(|| read_bytes(&bytes, Extension::Vtp));
    assert!(matches!(result, Err(ReadError::TooLarge { .. })));
    assert!(peak < 128 << 20, "{peak}");
}

/// Every file cut off at some forty lengths, spread over the file.
#[test]
fn cut_off_files() {
    for s in samples::all() {
        // More lengths are not needed: the encodings differ little at the start of the file.
        let step = (s.bytes.len() / 40).max(1);
        for length in (0..s.bytes.len()).step_by(step) {
            let result = read_checked(&s.name, &s.bytes[..length], s.hint);
            // A binary file that lacks half of its bytes cannot be read.
            let binary = !s.bytes.is_ascii() && s.has == Has::All;
            if binary && length < s.bytes.len() / 2 && !s.name.contains("bgeo") {
                assert!(result.is_err() || s.name.starts_with("vtk"), "{} at {length}", s.name);
            }
        }
    }
}

/// Pseudo-random numbers below a given one. The seed is constant, so that a failure can be
/// reproduced.
pub fn numbers() -> impl FnMut(usize) -> usize {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move |n: usize| {
        // xorshift64*, shifts 12, 25, 27
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % n.max(1)
    }
}

/// Damages a file with flipped bits, cuts, and duplicated or removed ranges.
pub fn damaged(bytes: &[u8], next: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..1 + next(4) {
        let (a, b) = (next(bytes.len()), next(bytes.len()));
        match next(8) {
            0 => bytes.truncate(a),
            1 => drop(bytes.drain(a.min(b)..a.max(b))),
            2 => {
                let part = bytes[a.min(b)..a.max(b)].to_vec();
                bytes.splice(a..a, part);
            }
            3 if a < bytes.len() => bytes[a] = [0, 0xff, 0x7f, b'9', b'-'][next(5)],
            // Digits turn into false counts.
            4 => {
                if let Some(i) = bytes.iter().skip(a).position(u8::is_ascii_digit) {
                    bytes.splice(a + i..=a + i, b"999999999999".iter().copied().take(1 + next(12)));
                }
            }
            _ if a < bytes.len() => bytes[a] ^= 1 << next(8),
            _ => {}
        }
    }
    bytes
}

/// Number of times that each file is damaged. `WHITEWATER_ROUNDS` multiplies it, for runs of an
/// hour; `WHITEWATER_FORMAT` limits the test to files whose name begins so.
pub fn rounds(usual: usize) -> usize {
    let times = std::env::var("WHITEWATER_ROUNDS").ok().and_then(|times| times.parse().ok());
    usual * times.unwrap_or(1)
}

#[test]
fn mutations() {
    let mut next = numbers();
    let (mut cases, mut read) = (0, 0);
    let only = std::env::var("WHITEWATER_FORMAT").unwrap_or_default();
    for s in samples::all().into_iter().filter(|s| s.name.starts_with(&only)) {
        for _ in 0..rounds(16) {
            let bytes = damaged(&s.bytes, &mut next);
            let hint = if next(8) == 0 { HINTS[next(HINTS.len())] } else { s.hint };
            cases += 1;
            read += usize::from(read_checked(&s.name, &bytes, hint).is_ok());
        }
    }
    println!("{cases} damaged files, {read} of them read");
    assert!(!only.is_empty() || cases > 5000, "{cases}");
    assert!(read > 0 && read < cases, "{read} of {cases}");
}

/// Valid files of other formats are named in the error, with a way to convert them. The error does
/// not call them damaged.
#[test]
fn files_of_other_formats_are_named() {
    let zip = |name: &str| {
        let mut out = b"PK\x03\x04".to_vec();
        out.extend([0; 22]);
        out.extend((name.len() as u16).to_le_bytes());
        out.extend([0; 2]);
        out.extend(name.as_bytes());
        out
    };
    for (bytes, hint, parts) in [
        #[cfg(not(feature = "hdf5"))]
        (&b"\x89HDF\r\n\x1a\n\0\0"[..], Extension::Unknown, ["HDF5", "h5py"]),
        (&b"Ogawa\xff\0\x01"[..], Extension::Unknown, ["Alembic", "BGEO"]),
        (b"PXR-USDC\0", Extension::Unknown, ["USD", "BGEO"]),
        (b"#usda 1.0\n", Extension::Unknown, ["USD", "BGEO"]),
        (&zip("dam.usdc"), Extension::Unknown, ["USD", "BGEO"]),
        (&zip("[Content_Types].xml"), Extension::Csv, ["spreadsheet", "CSV"]),
        (b"\x20\x42\x44\x56\0\0\0\0\xe0\0\0\0", Extension::Unknown, ["OpenVDB", "particles"]),
        (b"\x7fNSJb\0\0\0", Extension::Bgeo, ["Houdini 12", "classic"]),
        (b"#FileJBD BI4          \n", Extension::Unknown, ["DualSPHysics", "PartVTK"]),
        (b"\x10\x27\0\0\0\0\x80\x3f", Extension::Bobj, ["mesh", "particles"]),
        (&samples::gzip(b"\x10\x27\0\0\0\0\x80\x3f"), Extension::Bobj, ["mesh", "particles"]),
        (b"PB02\x10\x27\0\0", Extension::Unknown, ["Mantaflow", "BGEO"]),
        (&samples::gzip(b"MNT3\x10\x27\0\0"), Extension::Unknown, ["Mantaflow", "particles"]),
        (b"# .PCD v0.7\nVERSION 0.7\n", Extension::Xyz, ["PCD", "PLY"]),
        (b"<?xml version=\"1.0\"?><Xdmf Version=\"3.0\"/>", Extension::Unknown, ["Xdmf", "HDF5"]),
        (
            b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
            Extension::Bgeo,
            ["Git LFS", "git lfs pull"],
        ),
        (b"<!DOCTYPE html>\n<html>", Extension::Vtu, ["web page", "itself"]),
        (
            b"FoamFile\n{\n    class Cloud;\n}\n1\n(\n(0 0 0) 0\n)\n",
            Extension::Unknown,
            ["OpenFOAM", "foamToVTK"],
        ),
        (b"\x28\xb5\x2f\xfd\0", Extension::Bgeo, ["zstd", "unpack"]),
    ] {
        let error = refused(bytes, hint, &parts);
        assert!(matches!(error, ReadError::Unsupported { .. }), "{error:?}");
        let parts = Parts::of_bytes(bytes, hint, 10).map(|_| ()).unwrap_err();
        assert_eq!(parts.to_string(), error.to_string());
    }
}

/// Zips and texts that are no particles, but hold them.
#[test]
fn containers_of_particles_are_named() {
    let zip = |names: &[&str]| {
        let mut archive = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        for name in names {
            archive.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        }
        archive.finish().unwrap().into_inner()
    };
    let mut tar = vec![0; 512];
    tar[..5].copy_from_slice(b"a.csv");
    tar[257..262].copy_from_slice(b"ustar");
    let gro = "Water in a box\n  2\n    1SOL     OW    1   0.126   1.624   1.679\n    1SOL    HW1    2   \
               0.190   1.661   1.747\n   1.8   1.8   1.8\n";
    let rows = "v 0.1 0.2 0.3\n".repeat(1000);
    assert_eq!(read_bytes(rows.as_bytes(), Extension::Unknown).unwrap().positions.len(), 1000);
    let obj = format!("# Blender 4.0\nmtllib a.mtl\no water\n{rows}");
    for (bytes, parts) in [
        (zip(&["docProps/app.xml", "xl/workbook.xml"]), ["Excel", "CSV"]),
        (zip(&["a.csv"]), ["a zip that holds a.csv is", "unpack"]),
        (zip(&["a.csv", "b.csv", "c.csv", "d.csv"]), ["a.csv, b.csv, c.csv and 1 more", "unpack"]),
        (tar.clone(), ["an archive", "tar xf"]),
        (samples::gzip(&tar), ["an archive", "tar xf"]),
        (obj.into(), ["Wavefront", "grep '^v '"]),
        (gro.into(), ["GROMACS", "MDAnalysis"]),
    ] {
        let error = refused(&bytes, Extension::Unknown, &parts);
        assert!(matches!(error, ReadError::Unsupported { .. }), "{error:?}");
        let parts = Parts::of_bytes(&bytes, Extension::Unknown, 10).map(|_| ()).unwrap_err();
        assert_eq!(parts.to_string(), error.to_string());
    }
}

/// Rows of PLY after those that the header counts.
#[test]
fn more_rows_of_ply_than_counted() {
    let ply = |more: &str, rows: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n{more}\
             end_header\n{rows}"
        )
    };
    let face = "element face 1\nproperty list uchar int vertex_indices\n";
    for (more, rows) in
        [("", "0 0 0\n0 0 1"), ("", "0 0 0\n0 0 1\n\n \r\n"), (face, "0 0 0\n0 0 1\n2 0 1\n")]
    {
        let p = read_bytes(ply(more, rows).as_bytes(), Extension::Ply).unwrap();
        assert_eq!(p.positions.len(), 2);
    }
    for more in ["", "element face 0\nproperty list uchar int vertex_indices\n"] {
        let text = ply(more, "0 0 0\n0 0 1\n0.5 0 2\n0 0 3\n");
        let parts = ["nothing after the 2 rows of element `vertex`", "found \"0.5\""];
        let error = refused(text.as_bytes(), Extension::Ply, &parts).to_string();
        let parts = Parts::of_bytes(text.as_bytes(), Extension::Ply, 1).map(|_| ()).unwrap_err();
        assert_eq!(parts.to_string(), error);
    }
}

/// A file that was cut off is read as the whole one, or the error says so and what to do. Only a table without a count
/// may lack rows without a word.
#[test]
fn files_that_were_cut_off_are_told() {
    let check = |name: &str, cut: Result<Particles, ReadError>, whole: &Particles| match cut {
        Ok(p) => {
            let same = Particles { warnings: Vec::new(), ..p.clone() }
                == Particles { warnings: Vec::new(), ..whole.clone() };
            // Legacy VTK has no mark of its end.
            let told = same || !p.warnings.is_empty() || name.starts_with("vtk ");
            assert!(told, "{name}: another result without a word");
        }
        Err(error) => assert!(error.to_string().contains("write it again"), "{name}: {error}"),
    };
    for sample in samples::all() {
        let whole = read_bytes(&sample.bytes, sample.hint).unwrap();
        if matches!(sample.format, Format::Csv | Format::Xyz | Format::RawF32) {
            continue;
        }
        for part in [15, 40, 65, 90, 97] {
            let cut = read_bytes(&sample.bytes[..sample.bytes.len() * part / 100], sample.hint);
            check(&format!("{} {part}", sample.name), cut, &whole);
        }
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats/hdf5");
    for name in ["units.h5", "pysph.hdf5", "grid.vtkhdf", "steps.h5part", "matlab.mat"] {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        for part in [40, 65, 90, 99] {
            let cut = &bytes[..bytes.len() * part / 100];
            refused(cut, Extension::Unknown, &["ends too early: HDF5", "write it again"]);
        }
    }
    for (name, end) in [("cloud.xdmf", 700), ("series.xdmf", 500)] {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cut_{name}"));
        std::fs::write(&path, &std::fs::read(folder.join(name)).unwrap()[..end]).unwrap();
        let error = read(&path).unwrap_err().to_string();
        assert!(error.contains("the XML of an XDMF file, up to `</Xdmf>`"), "{error}");
    }
}

/// What is said of files of each kind that were cut off.
#[test]
fn what_was_cut_off_is_named() {
    let dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n\
                ITEM: ATOMS id x y z\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
    let of_dump = "expected 4 rows in a dump of LAMMPS, as its `ITEM: NUMBER OF ATOMS` says, found";
    let steps = "the dump was cut off: write it again; the whole steps before this one can be read";
    let counted = "4\ncomment\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    let of_xyz = "expected 4 rows in an XYZ file, as the count above them says, found";
    let table = "x,y,z,vx\n0,0,0,1\n1,0,0,1\n";
    let last = "this is the last line of the table, which was perhaps cut off: write it again";
    let vtk = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\n";
    let xml = "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\"><Points>";
    for (text, hint, parts) in [
        (dump.replace("4 0 0 1\n", ""), Extension::Unknown, [of_dump, "found 3 in line 12", steps]),
        (dump.replace("4 0 0 1\n", "4 0"), Extension::Unknown, [of_dump, "found 3 in", steps]),
        (dump.replace("\n1 0 0 0", ""), Extension::Unknown, [of_dump, "found 3 in", steps]),
        (dump[..dump.len() - 38].into(), Extension::Unknown, [of_dump, "found 0 in line 9", steps]),
        (format!("{dump}5 0 0 1\n"), Extension::Unknown, [of_dump, "found 5 in", "rows are wrong"]),
        (
            dump[..40].into(),
            Extension::Unknown,
            ["items of a dump of LAMMPS", "found \"none\"", "write it again"],
        ),
        (
            counted.replace("0 0 1\n", ""),
            Extension::Xyz,
            [of_xyz, "found 3 in line 5", "the whole frames before this one can be read"],
        ),
        (counted.replace("0 0 1\n", "0 "), Extension::Xyz, [of_xyz, "found 3 in", "was cut off"]),
        (format!("{table}1,0"), Extension::Csv, ["expected 4 fields", "found 2 in line 4", last]),
        (format!("{table}1,0,0,-"), Extension::Csv, ["a number in column `vx`", "line 4", last]),
        (table.replace(',', " ") + "1 0", Extension::Xyz, ["expected 4 values", "line 4", last]),
        (
            format!("{vtk}POINT_DA"),
            Extension::Vtk,
            ["ends too early", "the name of a section of legacy VTK", "write it again"],
        ),
        (
            xml.into(),
            Extension::Vtp,
            ["ends too early", "the XML of a VTK file, up to `</VTKFile>`", "write it again"],
        ),
        (
            "[[0, 0, 0], [0, 1".into(),
            Extension::Json,
            ["ends too early", "the JSON, up to the end of its first list", "write it again"],
        ),
    ] {
        refused(text.as_bytes(), hint, &parts);
    }
    // A row that is wrong is not the last one.
    let error = refused(format!("{table}1,0\n1,0,0,1\n").as_bytes(), Extension::Csv, &["line 4"]);
    assert!(!error.to_string().contains(last), "{error}");
    let text = table.replace(',', " ") + "1 0\n1 0 0 1\n";
    let error = refused(text.as_bytes(), Extension::Xyz, &["line 4"]);
    assert!(!error.to_string().contains(last), "{error}");
    // Another word is no section that was cut off.
    let p = read_bytes(format!("{vtk}PICTURE").as_bytes(), Extension::Vtk).unwrap();
    assert!(p.warnings[0].contains("unknown section \"PICTURE\""), "{:?}", p.warnings);
    let zip = samples::npz(&[("position", npy("<f4", "(1, 3)", false, 1, &[0; 12]))], false);
    let parts = ["a sound zip of arrays (NPZ), with its list of contents at the end"];
    refused(&zip[..zip.len() - 40], Extension::Npz, &parts);
}

/// Steps of a dump before one that was cut off, in its rows or before them, are read, and that one is told.
#[test]
fn steps_before_one_that_was_cut_off_are_read() {
    let step = |time: usize, rows: &str| {
        format!(
            "ITEM: TIMESTEP\n{time}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n\
             ITEM: ATOMS id x y z\n{rows}"
        )
    };
    let whole = step(0, "1 0 0 0\n2 1 0 0\n") + &step(1, "1 0 0 0\n2 1 0 1\n");
    for (name, more, told) in [
        ("rows", step(2, "1 0 0 0\n"), "found 1 in line 32"),
        ("within", step(2, "1 0"), "found 0 in line 32"),
        ("names", step(2, "")[..60].to_string(), "write it again"),
        ("time", "ITEM: TIMESTEP\n".into(), "items of a dump of LAMMPS"),
    ] {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cut_{name}.dump"));
        std::fs::write(&path, whole.clone() + &more).unwrap();
        let found = steps(&path).unwrap();
        assert_eq!(found.len(), 3, "{name}");
        for step in &found[..2] {
            assert_eq!(read_step(&path, *step, &[]).unwrap().positions.len(), 2, "{name}");
        }
        let error = read_step(&path, found[2], &[]).unwrap_err().to_string();
        assert!(error.contains(told), "{name}: {error}");
    }
}

/// A PLY file whose count of vertices is wrong and whose polygons follow: polygons would be taken as vertices, or
/// vertices be left out.
#[test]
fn vertices_of_ply_are_counted_right() {
    let face = "element face 2\nproperty list uchar int vertex_indices\n";
    let head = |format: &str, count: usize, more: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\n\
             {more}end_header\n"
        )
    };
    let points = [[0.5_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [3.0, 1.0, 2.0]];
    let faces = [[0, 1, 2], [1, 2, 3]];
    let text = |points: &[[f32; 3]]| {
        let points = points.iter().map(|[x, y, z]| format!("{x} {y} {z}\n"));
        let faces = faces.iter().map(|[a, b, c]| format!("3 {a} {b} {c}\n"));
        points.chain(faces).collect::<String>().into_bytes()
    };
    let binary = |points: &[[f32; 3]]| {
        let mut bytes = samples::floats(points.as_flattened(), 4, false);
        for face in faces {
            bytes.push(3);
            bytes.extend(samples::ints(&face, 4, false));
        }
        bytes
    };
    let check = |bytes: &[u8]| {
        let whole = read_bytes(bytes, Extension::Ply).map(|p| p.positions.len());
        let mut parts = 0;
        let read = Parts::of_bytes(bytes, Extension::Ply, 1).map(|all| {
            all.for_each(|part| parts += part.unwrap().positions.len());
            parts
        });
        let told = |error: ReadError| error.to_string();
        let (whole, read) = (whole.map_err(told), read.map_err(told));
        assert_eq!(whole, read);
        whole
    };
    let whole: Vec<[f32; 3]> = points.map(|[x, y, z]| [x.floor(), y, z]).into();
    for points in [&points[..], &whole] {
        for (format, rows) in [("ascii", text(points)), ("binary_little_endian", binary(points))] {
            for count in 1..=6 {
                let bytes = [head(format, count, face).into_bytes(), rows.clone()].concat();
                let found = check(&bytes);
                match found {
                    Ok(found) => assert!(count == 4 && found == 4, "{format} {count}: {found}"),
                    Err(error) => {
                        assert!(count != 4, "{format}: {error}");
                        let parts = ["element `", "write it again"];
                        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
                        let after = format!("after the {count} rows of element `vertex`");
                        assert!(count > 4 || error.contains(&after), "{format} {count}: {error}");
                    }
                }
            }
        }
    }
    // Without polygons, vertices may follow those that are counted.
    for (count, more) in [(4, ""), (3, "found 12 more bytes"), (5, "ends too early")] {
        let bytes = [
            head("binary_little_endian", count, "").into_bytes(),
            samples::floats(points.as_flattened(), 4, false),
        ]
        .concat();
        match check(&bytes) {
            Ok(found) => assert_eq!((found, more), (4, "")),
            Err(error) => assert!(!more.is_empty() && error.contains(more), "{error}"),
        }
    }
}
