//! Bounds-checked reading of bytes, tokens and lines, and unpacking with a limit.

use std::io::Read;

use super::error::{Place, ReadError};

/// Max number of bytes to which `len` compressed bytes may decompress. Real particle data compresses to a half
/// or a third of its size, a single constant attribute to a thousandth.
pub(super) fn unpack_limit(len: usize) -> usize {
    len.saturating_mul(64).saturating_add(16 << 20)
}

pub(super) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x1f\x8b")
}

pub(super) fn gunzip(bytes: &[u8]) -> Result<Vec<u8>, ReadError> {
    unpack(flate2::read::MultiGzDecoder::new(bytes), unpack_limit(bytes.len()), "gzip data", 0)
}

/// Reads `reader` to the end, or fails after `limit` bytes. Memory grows with the bytes that are read, not with
/// `limit`.
pub(super) fn unpack(
    reader: impl Read,
    limit: usize,
    what: &str,
    offset: usize,
) -> Result<Vec<u8>, ReadError> {
    let mut out = Vec::new();
    let read = reader.take((limit as u64).saturating_add(1)).read_to_end(&mut out);
    match read {
        Ok(_) if out.len() > limit => {
            Err(ReadError::TooLarge { what: what.into(), limit: limit as u64 })
        }
        Ok(_) => Ok(out),
        Err(e) => Err(ReadError::malformed(
            format!("sound {what}"),
            format!("{e} after {} unpacked bytes", out.len()),
            Place::Byte(offset as u64),
        )),
    }
}

/// A place in a byte slice.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cursor<'a> {
    data: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(data: &'a [u8]) -> Self {
        Self { data, at: 0 }
    }

    pub(super) fn at(&self) -> usize {
        self.at
    }

    pub(super) fn place(&self) -> Place {
        Place::Byte(self.at as u64)
    }

    pub(super) fn rest(&self) -> &'a [u8] {
        self.data.get(self.at..).unwrap_or_default()
    }

    /// Takes the next `n` bytes of the data; fails if fewer are left. `n` comes from headers, so it is a `u64`.
    pub(super) fn take(&mut self, n: u64, what: &str) -> Result<&'a [u8], ReadError> {
        let rest = self.rest();
        let taken = usize::try_from(n).ok().and_then(|n| rest.get(..n));
        match taken {
            Some(taken) => {
                self.at += taken.len();
                Ok(taken)
            }
            None => Err(ReadError::truncated(what, self.at, n, rest.len())),
        }
    }

    pub(super) fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], ReadError> {
        let bytes = self.take(N as u64, what)?;
        bytes
            .first_chunk::<N>()
            .copied()
            .ok_or_else(|| ReadError::truncated(what, self.at, N as u64, bytes.len()))
    }

    pub(super) fn u16_be(&mut self, what: &str) -> Result<u16, ReadError> {
        Ok(u16::from_be_bytes(self.array(what)?))
    }

    pub(super) fn i32_be(&mut self, what: &str) -> Result<i32, ReadError> {
        Ok(i32::from_be_bytes(self.array(what)?))
    }
}

/// Parses a number. Besides ordinary numbers it accepts NaN and infinity in every spelling of `printf` on any platform,
/// and Fortran's exponents: after a D, and of three digits without a letter (`1.4-100`).
pub(super) fn parse_number(token: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(token).ok()?;
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    // Fortran writes the exponent of a double after a D.
    if let Some(d) = text.find(['d', 'D'])
        && let (Some(mantissa), Some(exponent)) = (text.get(..d), text.get(d + 1..))
        && let Ok(value) = format!("{mantissa}e{exponent}").parse()
    {
        return Some(value);
    }
    if let Some(at) = text.len().checked_sub(4)
        && let Some((mantissa, exponent)) = text.split_at_checked(at)
        && exponent.starts_with(['+', '-'])
        && mantissa.contains('.')
        && let Ok(value) = format!("{mantissa}e{exponent}").parse()
    {
        return Some(value);
    }
    let bare = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
    if bare.starts_with("nan(") || bare.starts_with("1.#ind") || bare.starts_with("1.#qnan") {
        Some(f64::NAN)
    } else if bare.starts_with("1.#inf") {
        Some(f64::INFINITY.copysign(if text.starts_with('-') { -1.0 } else { 1.0 }))
    } else {
        None
    }
}

/// A short readable form of bytes for messages.
pub(super) fn show(bytes: &[u8]) -> String {
    let head = bytes.get(..bytes.len().min(40)).unwrap_or(bytes);
    let dots = if head.len() < bytes.len() { "..." } else { "" };
    format!("\"{}{dots}\"", head.escape_ascii())
}
