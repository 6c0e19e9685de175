//! Writes particles: classic BGEO, VTU, PLY and NPZ.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::error::WriteError;
use super::{Particles, WriteFormat};

/// Writes one file.
///
/// Writes positions and, where present, velocities, densities, ids, lifetimes and kinds under the names `velocity` (in
/// PLY `vx`, `vy`, `vz`), `density`, `id`, `lifetime` and `type`, by which [`read`](super::read) finds them again.
/// [`extras`](Particles::extras), [`time`](Particles::time) and [`origin`](Particles::origin) are not written. The file
/// is written under a temporary name in the same folder and then renamed, so an incomplete file never has the final
/// name.
///
/// # Errors
/// A list (velocities, densities, ids, lifetimes or kinds) that is not as long as the list of positions; for BGEO, an
/// id, a kind or a number of particles above 2^31 - 1; and errors of the operating system.
pub fn write(path: &Path, particles: &Particles, format: WriteFormat) -> Result<(), WriteError> {
    static COUNTER: AtomicU64 = AtomicU64::new(0);
    // Checked before a file is created.
    check(particles, format)?;
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let temporary = path.with_file_name(format!(
        ".{name}.{}-{}.tmp",
        std::process::id(),
        COUNTER.fetch_add(1, Ordering::Relaxed)
    ));
    let guard = Temporary(temporary);
    let io = |reason| WriteError::Io { path: path.to_path_buf(), reason };
    create(&guard.0, particles, format).map_err(io)?;
    std::fs::rename(&guard.0, path).map_err(io)
}

fn create(path: &Path, particles: &Particles, format: WriteFormat) -> io::Result<()> {
    let mut file = BufWriter::new(std::fs::File::create(path)?);
    write_to(&mut file, particles, format)?;
    file.into_inner().map_err(io::IntoInnerError::into_error)?;
    Ok(())
}

/// Writes to an open file or buffer.
///
/// # Errors
/// Those of [`write()`]. If the particles are invalid or exceed the format's limits, the error is
/// [`io::ErrorKind::InvalidInput`] and nothing is written.
pub fn write_to(
    out: &mut (impl Write + io::Seek),
    particles: &Particles,
    format: WriteFormat,
) -> io::Result<()> {
    check(particles, format).map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
    match format {
        WriteFormat::Bgeo { gzip: false } => bgeo(out, particles),
        WriteFormat::Bgeo { gzip: true } => {
            let mut packed = flate2::write::GzEncoder::new(out, flate2::Compression::fast());
            bgeo(&mut packed, particles)?;
            packed.finish().map(drop)
        }
        WriteFormat::Vtu => vtu(out, particles),
        WriteFormat::Ply => ply(out, particles),
        WriteFormat::Npz => npz(out, particles),
    }
}

/// Removes the temporary file if writing failed; after the rename it no longer exists.
struct Temporary(PathBuf);

impl Drop for Temporary {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn check(particles: &Particles, format: WriteFormat) -> Result<(), WriteError> {
    let expected = particles.positions.len();
    let lengths = [
        ("velocities", particles.velocities.as_ref().map(Vec::len)),
        ("densities", particles.densities.as_ref().map(Vec::len)),
        ("ids", particles.ids.as_ref().map(Vec::len)),
        ("lifetimes", particles.lifetimes.as_ref().map(Vec::len)),
        ("kinds", particles.kinds.as_ref().map(Vec::len)),
    ];
    for (attribute, found) in lengths {
        if let Some(found) = found.filter(|n| *n != expected) {
            return Err(WriteError::Length { attribute, expected, found });
        }
    }
    if let WriteFormat::Bgeo { .. } = format {
        let limit = i32::MAX.unsigned_abs();
        let largest = |v: &Option<Vec<u32>>| v.iter().flatten().max().map_or(0, |x| u64::from(*x));
        for (what, value) in [
            ("id", largest(&particles.ids)),
            ("type", largest(&particles.kinds)),
            ("the number of particles", expected as u64),
        ] {
            if value > u64::from(limit) {
                return Err(WriteError::Range {
                    what,
                    value,
                    limit: u64::from(limit),
                    format: "BGEO",
                });
            }
        }
    }
    Ok(())
}

/// One attribute to be written.
enum Values<'a> {
    Vector(&'a [[f32; 3]]),
    Float(&'a [f32]),
    Int(&'a [u32]),
}

impl Values<'_> {
    fn components(&self) -> usize {
        match self {
            Self::Vector(_) => 3,
            Self::Float(_) | Self::Int(_) => 1,
        }
    }

    /// Appends the values of one particle. All are four bytes wide.
    fn push(&self, i: usize, out: &mut Vec<u8>, big_endian: bool) {
        let mut put = |bits: u32| {
            out.extend(if big_endian { bits.to_be_bytes() } else { bits.to_le_bytes() });
        };
        match self {
            Self::Vector(v) => v.get(i).into_iter().flatten().for_each(|x| put(x.to_bits())),
            Self::Float(v) => v.get(i).into_iter().for_each(|x| put(x.to_bits())),
            Self::Int(v) => v.get(i).into_iter().for_each(|x| put(*x)),
        }
    }

    fn bytes(&self, count: usize) -> Vec<u8> {
        let mut out = Vec::with_capacity(count * self.components() * 4);
        for i in 0..count {
            self.push(i, &mut out, false);
        }
        out
    }
}

/// All present attributes except positions.
fn attributes(p: &Particles) -> Vec<(&'static str, Values<'_>)> {
    let mut list = Vec::new();
    if let Some(v) = &p.velocities {
        list.push(("velocity", Values::Vector(v)));
    }
    if let Some(v) = &p.densities {
        list.push(("density", Values::Float(v)));
    }
    if let Some(v) = &p.ids {
        list.push(("id", Values::Int(v)));
    }
    if let Some(v) = &p.lifetimes {
        list.push(("lifetime", Values::Float(v)));
    }
    if let Some(v) = &p.kinds {
        list.push(("type", Values::Int(v)));
    }
    list
}

fn bgeo(out: &mut impl Write, p: &Particles) -> io::Result<()> {
    let count = p.positions.len();
    let attributes = attributes(p);
    out.write_all(b"BgeoV")?;
    for n in [5, count as i32, 0, 0, 0, attributes.len() as i32, 0, 0, 0] {
        out.write_all(&n.to_be_bytes())?;
    }
    for (name, values) in &attributes {
        out.write_all(&(name.len() as u16).to_be_bytes())?;
        out.write_all(name.as_bytes())?;
        out.write_all(&(values.components() as u16).to_be_bytes())?;
        let ty: i32 = match values {
            Values::Float(_) => 0,
            Values::Int(_) => 1,
            Values::Vector(_) => 5,
        };
        out.write_all(&ty.to_be_bytes())?;
        for _ in 0..values.components() {
            out.write_all(&[0; 4])?;
        }
    }
    let positions = Values::Vector(&p.positions);
    let mut row = Vec::new();
    for i in 0..count {
        row.clear();
        positions.push(i, &mut row, true);
        row.extend(1.0_f32.to_be_bytes());
        for (_, values) in &attributes {
            values.push(i, &mut row, true);
        }
        out.write_all(&row)?;
    }
    // No detail attributes; the end of the file.
    out.write_all(&[0x00, 0xff])
}

fn vtu(out: &mut impl Write, p: &Particles) -> io::Result<()> {
    let count = p.positions.len();
    let mut data = Vec::new();
    let mut array = |name: &str, ty: &str, components: usize, raw: &[u8]| {
        let offset = data.len();
        pack_blocks(&mut data, raw)?;
        Ok::<_, io::Error>(format!(
            "        <DataArray type=\"{ty}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{offset}\"/>\n"
        ))
    };
    let mut point_data = String::new();
    for (name, values) in attributes(p) {
        let ty = match values {
            Values::Int(_) => "UInt32",
            Values::Vector(_) | Values::Float(_) => "Float32",
        };
        point_data += &array(name, ty, values.components(), &values.bytes(count))?;
    }
    let points = Values::Vector(&p.positions).bytes(count);
    let points = array("Points", "Float32", 3, &points)?;
    // One vertex cell per point, because ParaView draws cells.
    let numbers =
        |from: u64| -> Vec<u8> { (from..from + count as u64).flat_map(u64::to_le_bytes).collect() };
    let cells = [
        array("connectivity", "Int64", 1, &numbers(0))?,
        array("offsets", "Int64", 1, &numbers(1))?,
        array("types", "UInt8", 1, &vec![1; count])?,
    ]
    .concat();
    write!(
        out,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" \
         compressor=\"vtkZLibDataCompressor\">\n  <UnstructuredGrid>\n    \
         <Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{count}\">\n      \
         <PointData>\n{point_data}      </PointData>\n      <CellData/>\n      \
         <Points>\n{points}      </Points>\n      <Cells>\n{cells}      </Cells>\n    \
         </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n   _"
    )?;
    out.write_all(&data)?;
    out.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
}

/// Header and blocks of one appended array.
fn pack_blocks(out: &mut Vec<u8>, raw: &[u8]) -> io::Result<()> {
    const BLOCK: usize = 1 << 18;
    let mut blocks = Vec::new();
    for chunk in raw.chunks(BLOCK) {
        let mut packed =
            flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        packed.write_all(chunk)?;
        blocks.push(packed.finish()?);
    }
    let mut word = |n: usize| out.extend((n as u64).to_le_bytes());
    word(blocks.len());
    word(BLOCK);
    word(raw.len() % BLOCK);
    blocks.iter().for_each(|block| word(block.len()));
    blocks.iter().for_each(|block| out.extend(block));
    Ok(())
}

fn ply(out: &mut impl Write, p: &Particles) -> io::Result<()> {
    let count = p.positions.len();
    let attributes = attributes(p);
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\nelement vertex {count}\n\
         property float x\nproperty float y\nproperty float z\n"
    )?;
    for (name, values) in &attributes {
        match values {
            Values::Vector(_) => {
                out.write_all(b"property float vx\nproperty float vy\nproperty float vz\n")?
            }
            Values::Float(_) => writeln!(out, "property float {name}")?,
            Values::Int(_) => writeln!(out, "property uint {name}")?,
        }
    }
    out.write_all(b"end_header\n")?;
    let positions = Values::Vector(&p.positions);
    let mut row = Vec::new();
    for i in 0..count {
        row.clear();
        positions.push(i, &mut row, false);
        for (_, values) in &attributes {
            values.push(i, &mut row, false);
        }
        out.write_all(&row)?;
    }
    Ok(())
}

fn npz(out: &mut (impl Write + io::Seek), p: &Particles) -> io::Result<()> {
    let count = p.positions.len();
    let mut archive = zip::ZipWriter::new(out);
    let options = zip::write::SimpleFileOptions::default()
        .compression_method(zip::CompressionMethod::Deflated)
        .large_file(count > (u32::MAX / 16) as usize);
    let mut all = vec![("position", Values::Vector(&p.positions))];
    all.extend(attributes(p));
    for (name, values) in all {
        archive.start_file(format!("{name}.npy"), options).map_err(io::Error::other)?;
        let descr = match values {
            Values::Int(_) => "<u4",
            Values::Vector(_) | Values::Float(_) => "<f4",
        };
        let shape = match values {
            Values::Vector(_) => format!("({count}, 3)"),
            Values::Float(_) | Values::Int(_) => format!("({count},)"),
        };
        let mut header =
            format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
        // The header is padded so that the values begin at a multiple of 64; ten bytes precede it, and a line feed ends
        // it.
        let padded = (header.len() + 11).next_multiple_of(64) - 11;
        header.extend(std::iter::repeat_n(' ', padded - header.len()));
        header.push('\n');
        archive.write_all(b"\x93NUMPY\x01\x00")?;
        archive.write_all(&(header.len() as u16).to_le_bytes())?;
        archive.write_all(header.as_bytes())?;
        archive.write_all(&values.bytes(count))?;
    }
    archive.finish().map_err(io::Error::other)?;
    Ok(())
}
