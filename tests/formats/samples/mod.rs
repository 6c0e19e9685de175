//! One small cloud in every format and encoding, byte by byte: the cloud, how it is checked, and the
//! list of all samples.

mod houdini;
mod plain;
mod vtk;

use std::io::Write;
use whitewater::io::particles::{Compression, Extension, Format, Particles, Storage};

use houdini::geo;
use plain::{numpy_samples, text_samples};

pub use houdini::bgeo;
pub use plain::{npy, npz, ply};
pub use vtk::{Xml, vtk};

pub const COUNT: usize = 11;

/// Positions that 32-bit floats, and text of seven digits, hold exactly.
pub fn positions() -> Vec<[f32; 3]> {
    (0..COUNT)
        .map(|i| {
            let t = i as f32;
            [0.25 * t - 1.0, 0.5 + 0.125 * (t * 3.0 % 7.0), -0.375 * t]
        })
        .collect()
}

pub fn velocities() -> Vec<[f32; 3]> {
    (0..COUNT)
        .map(|i| {
            let t = i as f32;
            [1.5 - t, 0.0625 * t, -2.0]
        })
        .collect()
}

pub fn densities() -> Vec<f32> {
    (0..COUNT).map(|i| 1000.0 + 0.5 * i as f32).collect()
}

pub fn ids() -> Vec<u32> {
    (0..COUNT as u32).map(|i| 500 - 40 * i).collect()
}

/// What a sample has beside positions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Has {
    Positions,
    All,
}

pub struct Sample {
    pub name: String,
    pub hint: Extension,
    pub bytes: Vec<u8>,
    pub has: Has,
    pub format: Format,
}

fn sample(
    name: &str,
    hint: Extension,
    bytes: impl Into<Vec<u8>>,
    has: Has,
    format: Format,
) -> Sample {
    Sample { name: name.into(), hint, bytes: bytes.into(), has, format }
}

/// Fails unless the particles are those of this file.
pub fn check(name: &str, particles: &Particles, has: Has) {
    assert_eq!(particles.positions, positions(), "{name}: positions");
    match has {
        Has::Positions => {
            assert_eq!(particles.velocities, None, "{name}: velocities");
            assert_eq!(particles.ids, None, "{name}: ids");
        }
        Has::All => {
            assert_eq!(particles.velocities, Some(velocities()), "{name}: velocities");
            assert_eq!(particles.densities, Some(densities()), "{name}: densities");
            assert_eq!(particles.ids, Some(ids()), "{name}: ids");
        }
    }
    assert!(!particles.attributes.is_empty(), "{name}: attributes");
}

/// Values as bytes of `size` 4 or 8.
pub fn floats(values: &[f32], size: usize, big: bool) -> Vec<u8> {
    values
        .iter()
        .flat_map(|v| match (size, big) {
            (4, true) => v.to_be_bytes().to_vec(),
            (4, false) => v.to_le_bytes().to_vec(),
            (_, true) => f64::from(*v).to_be_bytes().to_vec(),
            (_, false) => f64::from(*v).to_le_bytes().to_vec(),
        })
        .collect()
}

pub fn ints(values: &[u32], size: usize, big: bool) -> Vec<u8> {
    values
        .iter()
        .flat_map(|v| match (size, big) {
            (4, true) => v.to_be_bytes().to_vec(),
            (4, false) => v.to_le_bytes().to_vec(),
            (_, true) => u64::from(*v).to_be_bytes().to_vec(),
            (_, false) => u64::from(*v).to_le_bytes().to_vec(),
        })
        .collect()
}

pub fn words<T: ToString>(values: impl IntoIterator<Item = T>) -> String {
    let words: Vec<_> = values.into_iter().map(|v| v.to_string()).collect();
    words.join(" ")
}

pub fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut out = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    out.write_all(bytes).unwrap();
    out.finish().unwrap()
}

pub fn all() -> Vec<Sample> {
    use Extension as E;
    use Has::All;
    let mut list = vec![
        sample("bgeo", E::Bgeo, bgeo(), All, Format::Bgeo { gzip: false }),
        sample("bgeo gzip", E::Bgeo, gzip(&bgeo()), All, Format::Bgeo { gzip: true }),
        sample("geo", E::Geo, geo(), All, Format::Geo),
        sample("bgeo named .ply", E::Ply, bgeo(), All, Format::Bgeo { gzip: false }),
    ];
    for (version, number) in
        [("2.0", (2, 0)), ("3.0", (3, 0)), ("4.1", (4, 1)), ("4.2", (4, 2)), ("5.1", (5, 1))]
    {
        for binary in [false, true] {
            for polydata in [false, true] {
                for double in [false, true] {
                    let name = format!(
                        "vtk {version} binary {binary} polydata {polydata} double {double}"
                    );
                    let format = Format::VtkLegacy { version: number, binary };
                    list.push(sample(
                        &name,
                        E::Vtk,
                        vtk(version, binary, polydata, double),
                        All,
                        format,
                    ));
                }
            }
        }
    }
    for storage in
        [Storage::Ascii, Storage::InlineBase64, Storage::AppendedBase64, Storage::AppendedRaw]
    {
        for compression in [Compression::None, Compression::Zlib, Compression::Lz4] {
            for bits in 0..32 {
                let [vtp, big, wide, pieces, double] = [1, 2, 4, 8, 16].map(|bit| bits & bit != 0);
                let xml = Xml { vtp, storage, compression, big, wide, pieces, double };
                let format = if vtp {
                    Format::Vtp(storage, compression)
                } else {
                    Format::Vtu(storage, compression)
                };
                let name =
                    format!("{format}, big {big} wide {wide} pieces {pieces} double {double}");
                list.push(sample(
                    &name,
                    if vtp { E::Vtp } else { E::Vtu },
                    xml.bytes(),
                    All,
                    format,
                ));
            }
        }
    }
    let lzma = include_bytes!("../lzma.vtu");
    list.push(sample(
        "vtu lzma",
        E::Vtu,
        &lzma[..],
        All,
        Format::Vtu(Storage::AppendedRaw, Compression::Lzma),
    ));
    for double in [false, true] {
        for lists in [false, true] {
            for (format, expected) in [
                ("ascii", Format::PlyAscii),
                ("binary_little_endian", Format::PlyBinary { big_endian: false }),
                ("binary_big_endian", Format::PlyBinary { big_endian: true }),
            ] {
                let name = format!("ply {format} double {double} lists {lists}");
                list.push(sample(&name, E::Ply, ply(format, double, lists), All, expected));
            }
        }
    }
    let cr = String::from_utf8(ply("ascii", false, true)).unwrap().replace('\n', "\r\n");
    list.push(sample("ply with carriage returns", E::Ply, cr, All, Format::PlyAscii));
    numpy_samples(&mut list);
    text_samples(&mut list);
    list
}
