//! The readers and writers of particle caches: every format and encoding, bad input, sequences,
//! spacing.
//!
//! Samples are built here byte by byte. If `WHITEWATER_DATA` names a folder of published caches,
//! those are read too.
#![allow(clippy::unwrap_used)] // a test may

#[path = "formats/allocation.rs"]
mod allocation;
#[path = "formats/arrays.rs"]
mod arrays;
#[path = "formats/bad.rs"]
mod bad;
#[path = "formats/cells.rs"]
mod cells;
#[path = "formats/data.rs"]
mod data;
#[path = "formats/dialects.rs"]
mod dialects;
#[path = "formats/extras.rs"]
mod extras;
#[path = "formats/folder.rs"]
mod folder;
#[cfg(feature = "hdf5")]
#[path = "formats/hdf5.rs"]
mod hdf5;
#[path = "formats/indices.rs"]
mod indices;
#[path = "formats/parts.rs"]
mod parts;
#[path = "formats/samples/mod.rs"]
mod samples;
#[cfg(feature = "headless")]
#[path = "formats/scenes.rs"]
mod scenes;
#[path = "formats/sequences.rs"]
mod sequences;
#[path = "support/skipped.rs"]
mod skipped;
#[path = "formats/spacings.rs"]
mod spacings;
#[path = "formats/steps.rs"]
mod steps;
#[path = "formats/writers.rs"]
mod writers;

use whitewater::io::particles::{AttributeType, Extension, Format, read_bytes};

#[test]
fn every_format_and_encoding_gives_the_same_particles() {
    let samples = samples::all();
    assert!(samples.len() > 400, "{} samples", samples.len());
    for s in samples {
        let particles = read_bytes(&s.bytes, s.hint).unwrap_or_else(|e| panic!("{}: {e}", s.name));
        samples::check(&s.name, &particles, s.has);
        assert_eq!(particles.format, s.format, "{}", s.name);
    }
}

#[test]
fn gzip_may_wrap_any_format() {
    for s in samples::all().iter().step_by(5) {
        if s.format == (Format::Bgeo { gzip: true }) {
            continue;
        }
        let particles = read_bytes(&samples::gzip(&s.bytes), s.hint)
            .unwrap_or_else(|e| panic!("{}: {e}", s.name));
        samples::check(&s.name, &particles, s.has);
    }
}

#[test]
fn attributes_are_listed_with_their_shape() {
    let particles = read_bytes(&samples::bgeo(&samples::cloud()), Extension::Bgeo).unwrap();
    let list: Vec<_> =
        particles.attributes.iter().map(|a| (a.name.as_str(), a.components, a.ty)).collect();
    assert_eq!(
        list,
        [
            ("position", 3, AttributeType::F32),
            ("life", 2, AttributeType::F32),
            ("id", 1, AttributeType::I32),
            ("material", 1, AttributeType::Text),
            ("velocity", 3, AttributeType::F32),
            ("density", 1, AttributeType::F32),
        ]
    );
    // A lifetime is a single number; a `life` of two components has another meaning.
    assert_eq!(particles.lifetimes, None);
}

#[test]
fn formats_have_names() {
    let xml = samples::Xml {
        vtp: false,
        storage: whitewater::io::particles::Storage::AppendedRaw,
        compression: whitewater::io::particles::Compression::Zlib,
        big: false,
        wide: false,
        pieces: false,
        double: false,
    };
    let name = |bytes: &[u8], hint| read_bytes(bytes, hint).unwrap().format.to_string();
    assert_eq!(name(&xml.bytes(&samples::cloud()), Extension::Vtu), "VTU, appended raw, zlib");
    assert_eq!(
        name(&samples::vtk(&samples::cloud(), "5.1", true, true, false), Extension::Vtk),
        "legacy VTK 5.1, binary"
    );
}

#[test]
fn whitewater_attributes_are_read() {
    let text = "x,y,z,lifetime,type,id\n0,0,0,1.5,0,7\n1,0,0,-40,1,8\n2,0,0,0.25,2,9\n";
    let particles = read_bytes(text.as_bytes(), Extension::Csv).unwrap();
    assert_eq!(particles.lifetimes, Some(vec![1.5, -40.0, 0.25]));
    assert_eq!(particles.kinds, Some(vec![0, 1, 2]));
    assert_eq!(particles.ids, Some(vec![7, 8, 9]));
}

#[test]
fn base64_with_a_header_of_its_own() {
    // Some writers encode the length of uncompressed data separately from the data, each with its
    // own padding.
    use base64::Engine;
    let encode = |b: &[u8]| base64::engine::general_purpose::STANDARD.encode(b);
    let raw = samples::floats(samples::cloud().positions.as_flattened(), 4, false);
    let head = samples::ints(&[raw.len() as u32], 4, false);
    let text = format!(
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"{}\"><Points>\
         <DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">{}{}</DataArray>\
         </Points></Piece></PolyData></VTKFile>",
        samples::COUNT,
        encode(&head),
        encode(&raw)
    );
    let particles = read_bytes(text.as_bytes(), Extension::Vtp).unwrap();
    samples::check("two runs", &particles, samples::Has::Positions);
}

#[test]
fn base64_of_one_byte_is_no_header_of_its_own() {
    use base64::Engine;
    let array = |ty: &str, name: &str, components: usize, raw: &[u8]| {
        let bytes = [&samples::ints(&[raw.len() as u32], 4, false), raw].concat();
        let text = base64::engine::general_purpose::STANDARD.encode(bytes);
        format!(
            "<DataArray type=\"{ty}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"binary\">{text}</DataArray>"
        )
    };
    let text = format!(
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\"><PointData>{}</PointData>\
         <Points>{}</Points></Piece></PolyData></VTKFile>",
        array("UInt8", "type", 1, &[2]),
        array("Float32", "Points", 3, &samples::floats(&[1.0, 2.0, 3.0], 4, false))
    );
    let particles = read_bytes(text.as_bytes(), Extension::Vtp).unwrap();
    assert_eq!((particles.positions, particles.kinds), (vec![[1.0, 2.0, 3.0]], Some(vec![2])));
}

#[test]
fn raw_triples_that_are_valid_utf8_are_no_text() {
    let particles = read_bytes(&[0; 24], Extension::Xyz).unwrap();
    assert_eq!(particles.format, Format::RawF32);
    assert_eq!(particles.positions, [[0.0; 3]; 2]);
}
