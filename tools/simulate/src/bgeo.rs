//! Houdini's classic binary geometry, version 5, as Partio writes it: big-endian, points only.

use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

use flate2::{Compression, bufread::MultiGzDecoder, write::GzEncoder};
use glam::Vec3;

use crate::solver::REST_DENSITY;

/// A frame of particles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Positions, metres.
    pub positions: Vec<Vec3>,
    /// Velocities, metres per second.
    pub velocities: Vec<Vec3>,
    /// Densities, kilograms per cubic metre.
    pub densities: Vec<f32>,
    /// Identities, stable from frame to frame.
    pub ids: Vec<u32>,
}

const MAGIC: &[u8; 5] = b"BgeoV";
const VERSION: u32 = 5;
const FLOAT: u32 = 0;
const INTEGER: u32 = 1;
const VECTOR: u32 = 5;
/// The end of a classic file: the marks round the (empty) extra section.
const EXTRA: [u8; 2] = [0x00, 0xff];

/// Steps to which a frame is rounded before it is written. The dropped bits are noise that gzip cannot compress.
const POSITION_STEP: f32 = 1.0 / 65536.0;
const VELOCITY_STEP: f32 = 1.0 / 1024.0;
const DENSITY_STEP: f32 = 1.0 / 16.0;

fn invalid(what: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, what.into())
}

fn quantised(value: f32, step: f32) -> [u8; 4] {
    // Adding zero turns a negative zero into a positive one.
    ((value / step).round() * step + 0.0).to_be_bytes()
}

impl Frame {
    /// One line: particle count, largest speed, mean and worst compression.
    pub fn summary(&self) -> String {
        let count = self.ids.len().max(1) as f32;
        let fastest = self.velocities.iter().map(|v| v.length()).fold(0.0, f32::max);
        let compression = |d: f32| 100.0 * (d / REST_DENSITY - 1.0).max(0.0);
        let mean: f32 = self.densities.iter().map(|&d| compression(d)).sum::<f32>() / count;
        let worst = self.densities.iter().map(|&d| compression(d)).fold(0.0, f32::max);
        format!(
            "{} particles, {fastest:.2} m/s, compression {mean:.2} % (at most {worst:.1} %)",
            self.ids.len(),
        )
    }

    /// Writes the frame, compressed.
    ///
    /// # Errors
    /// Writing fails.
    pub fn write(&self, to: impl Write) -> io::Result<()> {
        let count = u32::try_from(self.ids.len()).map_err(|_| invalid("too many particles"))?;
        let mut out: Vec<u8> = Vec::with_capacity(self.ids.len() * 36 + 96);
        out.extend(MAGIC);
        // Points, primitives, point groups, primitive groups, then the numbers of point, vertex,
        // primitive and detail attributes.
        for number in [VERSION, count, 0, 0, 0, 3, 0, 0, 0] {
            out.extend(number.to_be_bytes());
        }
        for (name, size, kind) in
            [("id", 1u16, INTEGER), ("velocity", 3, VECTOR), ("density", 1, FLOAT)]
        {
            out.extend((name.len() as u16).to_be_bytes());
            out.extend(name.as_bytes());
            out.extend(size.to_be_bytes());
            out.extend(kind.to_be_bytes());
            out.extend(std::iter::repeat_n(0u8, 4 * usize::from(size)));
        }
        for i in 0..self.ids.len() {
            for value in self.positions[i].to_array() {
                out.extend(quantised(value, POSITION_STEP));
            }
            out.extend(1.0f32.to_be_bytes());
            out.extend(self.ids[i].to_be_bytes());
            for value in self.velocities[i].to_array() {
                out.extend(quantised(value, VELOCITY_STEP));
            }
            out.extend(quantised(self.densities[i], DENSITY_STEP));
        }
        out.extend(EXTRA);
        let mut file = GzEncoder::new(to, Compression::best());
        file.write_all(&out)?;
        file.finish()?.flush()
    }

    /// Reads a frame with the attributes `id`, `velocity` and `density`, in any order among others.
    ///
    /// # Errors
    /// The file cannot be read, or has another format.
    pub fn read(path: &Path) -> io::Result<Self> {
        let mut bytes = Vec::new();
        MultiGzDecoder::new(BufReader::new(File::open(path)?)).read_to_end(&mut bytes)?;
        let mut rest = bytes.as_slice();
        let mut take = |length: usize| -> io::Result<&[u8]> {
            let (head, tail) =
                rest.split_at_checked(length).ok_or_else(|| invalid("the file ends too early"))?;
            rest = tail;
            Ok(head)
        };
        let word = |bytes: &[u8]| u32::from_be_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        let short = |bytes: &[u8]| usize::from(u16::from_be_bytes([bytes[0], bytes[1]]));
        if take(5)? != MAGIC || word(take(4)?) != VERSION {
            return Err(invalid("not a classic BGEO file of version 5"));
        }
        let count = word(take(4)?) as usize;
        take(12)?;
        let attributes = word(take(4)?);
        take(12)?;
        let mut stride = 16;
        let (mut id, mut velocity, mut density) = (None, None, None);
        for _ in 0..attributes {
            let length = short(take(2)?);
            let name = take(length)?.to_vec();
            let size = short(take(2)?);
            let kind = word(take(4)?);
            take(4 * size)?;
            match (name.as_slice(), size, kind) {
                (b"id", 1, INTEGER) => id = Some(stride),
                (b"velocity", 3, FLOAT | VECTOR) => velocity = Some(stride),
                (b"density", 1, FLOAT) => density = Some(stride),
                _ => {}
            }
            stride += 4 * size;
        }
        let (Some(id), Some(velocity), Some(density)) = (id, velocity, density) else {
            return Err(invalid("an attribute of id, velocity, density is missing"));
        };
        let data = take(count.checked_mul(stride).ok_or_else(|| invalid("too many particles"))?)?;
        let mut frame = Self::default();
        for point in data.chunks_exact(stride) {
            let float = |at: usize| f32::from_bits(word(&point[at..]));
            let vector = |at: usize| Vec3::new(float(at), float(at + 4), float(at + 8));
            frame.positions.push(vector(0));
            frame.velocities.push(vector(velocity));
            frame.densities.push(float(density));
            frame.ids.push(word(&point[id..]));
        }
        Ok(frame)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_reads_back() -> io::Result<()> {
        let frame = Frame {
            positions: vec![Vec3::new(0.5, -0.25, 1.0), Vec3::ZERO],
            velocities: vec![Vec3::new(2.0, 0.0, -0.5), Vec3::ONE],
            densities: vec![1000.0, 998.5],
            ids: vec![7, 9],
        };
        let path = std::env::temp_dir().join(format!("whitewater-{}.bgeo", std::process::id()));
        frame.write(File::create(&path)?)?;
        let read = Frame::read(&path);
        std::fs::remove_file(&path)?;
        assert_eq!(read?, frame);
        Ok(())
    }
}
