//! One small cloud in every format and encoding, built byte by byte: the cloud, its check, and the
//! list of all samples.

mod houdini;
mod plain;
mod vtk;

use std::io::Write;
use whitewater::io::particles::{Compression, Extension, Format, Particles, Storage};

use plain::{numpy_samples, text_samples};

pub use houdini::{bgeo, geo};
pub use plain::{npy, npz, ply};
pub use vtk::{Xml, vtk, vtk_on_cells};

/// Another order of the cloud.
pub const ORDER: [u32; COUNT] = [3, 0, 2, 1, 10, 9, 5, 4, 8, 6, 7];

pub const COUNT: usize = 11;

/// The cloud of all samples. 32-bit floats and text of seven digits represent its values exactly.
pub fn cloud() -> Particles {
    let of = |f: fn(f32) -> [f32; 3]| (0..COUNT).map(|i| f(i as f32)).collect::<Vec<_>>();
    let mut cloud = Particles::from_positions(of(|t| {
        [0.25 * t - 1.0, 0.5 + 0.125 * (t * 3.0 % 7.0), -0.375 * t]
    }));
    cloud.velocities = Some(of(|t| [1.5 - t, 0.0625 * t, -2.0]));
    cloud.densities = Some((0..COUNT).map(|i| 1000.0 + 0.5 * i as f32).collect());
    cloud.ids = Some((0..COUNT as u32).map(|i| 500 - 40 * i).collect());
    cloud
}

fn positions(of: &Particles) -> &[[f32; 3]] {
    &of.positions
}

fn velocities(of: &Particles) -> &[[f32; 3]] {
    of.velocities.as_ref().unwrap()
}

fn densities(of: &Particles) -> &[f32] {
    of.densities.as_ref().unwrap()
}

fn ids(of: &Particles) -> &[u32] {
    of.ids.as_ref().unwrap()
}

/// Attributes of a sample besides positions.
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

/// Asserts that the particles are those of the cloud.
pub fn check(name: &str, particles: &Particles, has: Has) {
    let cloud = cloud();
    assert_eq!(particles.positions, cloud.positions, "{name}: positions");
    match has {
        Has::Positions => {
            assert_eq!(particles.velocities, None, "{name}: velocities");
            assert_eq!(particles.ids, None, "{name}: ids");
            assert_eq!(particles.densities, None, "{name}: densities");
        }
        Has::All => {
            assert_eq!(particles.velocities, cloud.velocities, "{name}: velocities");
            assert_eq!(particles.densities, cloud.densities, "{name}: densities");
            assert_eq!(particles.ids, cloud.ids, "{name}: ids");
        }
    }
    assert_eq!(particles.kinds, None, "{name}: kinds");
    assert_eq!(particles.lifetimes, None, "{name}: lifetimes");
    assert!(!particles.attributes.is_empty(), "{name}: attributes");
}

/// Values as floats of `size` 4 or 8 bytes.
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

/// The cloud with its values on cells of one point each.
fn on_cells(list: &mut Vec<Sample>, of: &Particles) {
    let same: Vec<u32> = (0..COUNT as u32).collect();
    for (order, told) in [(same.as_slice(), "in order"), (&ORDER, "in another order")] {
        for (version, number) in [("4.2", (4, 2)), ("5.1", (5, 1))] {
            for (binary, polydata) in [(false, false), (false, true), (true, false), (true, true)] {
                list.push(sample(
                    &format!("vtk {version} on cells {told} binary {binary} polydata {polydata}"),
                    Extension::Vtk,
                    vtk_on_cells(of, version, binary, polydata, order),
                    Has::All,
                    Format::VtkLegacy { version: number, binary },
                ));
            }
        }
        for storage in
            [Storage::Ascii, Storage::InlineBase64, Storage::AppendedBase64, Storage::AppendedRaw]
        {
            for bits in 0..8 {
                let [vtp, pieces, packed] = [1, 2, 4].map(|bit| bits & bit != 0);
                let compression = if packed { Compression::Zlib } else { Compression::None };
                let xml = Xml {
                    vtp,
                    storage,
                    compression,
                    big: pieces,
                    wide: packed,
                    pieces,
                    double: vtp,
                };
                let (hint, format) = match vtp {
                    true => (Extension::Vtp, Format::Vtp(storage, compression)),
                    false => (Extension::Vtu, Format::Vtu(storage, compression)),
                };
                list.push(sample(
                    &format!("{format} on cells {told} pieces {pieces}"),
                    hint,
                    xml.on_cells(of, order),
                    Has::All,
                    format,
                ));
            }
        }
    }
}

/// The cloud in every format and encoding.
pub fn all() -> Vec<Sample> {
    let of = &cloud();
    use Extension as E;
    use Has::All;
    let mut list = vec![
        sample("bgeo", E::Bgeo, bgeo(of), All, Format::Bgeo { gzip: false }),
        sample("bgeo gzip", E::Bgeo, gzip(&bgeo(of)), All, Format::Bgeo { gzip: true }),
        sample("geo", E::Geo, geo(of), All, Format::Geo),
        sample("bgeo named .ply", E::Ply, bgeo(of), All, Format::Bgeo { gzip: false }),
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
                        vtk(of, version, binary, polydata, double),
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
                    xml.bytes(of),
                    All,
                    format,
                ));
            }
        }
    }
    on_cells(&mut list, of);
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
                list.push(sample(&name, E::Ply, ply(of, format, double, lists), All, expected));
            }
        }
    }
    let cr = String::from_utf8(ply(of, "ascii", false, true)).unwrap().replace('\n', "\r\n");
    list.push(sample("ply with carriage returns", E::Ply, cr, All, Format::PlyAscii));
    numpy_samples(&mut list, of);
    text_samples(&mut list, of);
    list
}
