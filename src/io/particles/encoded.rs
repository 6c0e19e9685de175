//! Binary arrays of VTK XML: raw or base64, compressed in blocks or uncompressed.
//!
//! A header of `UInt32` or `UInt64` words comes before the values. Without compression, the header is the
//! number of bytes. With compression, it is the number of blocks, the size of a block, the size of a smaller
//! last block (or 0), and the compressed size of each block. In base64, the header of compressed data is
//! encoded separately, with its own padding. The list of compressed sizes is not kept in memory: a second
//! source reads it again beside the blocks.

use base64::Engine;
use base64::engine::general_purpose::{STANDARD, STANDARD_NO_PAD};
use base64::{DecodeError, engine::GeneralPurpose};

use super::Compression;
use super::arrays::{Segment, Spare};
use super::bytes::unpack;
use super::columns::{AttributeType, Data};
use super::error::{Place, ReadError};
use super::plan::changed;
use super::source::{Content, Source, truncated};

/// Number of base64 characters decoded at a time: a multiple of 4.
const CHARACTERS: u64 = 1 << 14;
/// Number of compressed bytes read at a time.
const PACKED: u64 = 1 << 14;
/// Number of bytes decompressed at a time: the block size that VTK writes.
const UNPACKED: u64 = 1 << 15;
/// Number of block sizes read at a time.
const SIZES: u64 = 1 << 8;

/// How the values are encoded.
#[derive(Debug, Clone, Copy)]
pub(super) struct Encoding {
    pub(super) base64: bool,
    pub(super) compression: Compression,
    pub(super) big_endian: bool,
    /// Header words have 64 bits instead of 32.
    pub(super) wide: bool,
}

impl Encoding {
    /// Bytes per header word.
    fn word(self) -> u64 {
        if self.wide { 8 } else { 4 }
    }

    /// Decodes header words.
    fn words(self, bytes: &[u8]) -> Vec<u64> {
        let ty = if self.wide { AttributeType::U64 } else { AttributeType::U32 };
        let mut data = Data::for_type(ty);
        data.push_bytes(ty, bytes, self.big_endian);
        match data {
            Data::Int(words) => words.into_iter().map(i64::cast_unsigned).collect(),
            _ => Vec::new(),
        }
    }

    /// Number of bytes that `bytes` bytes take in the file when they are encoded on their own: 4 for each 3 in
    /// base64, rounded up with padding.
    fn stored(self, bytes: u64) -> u64 {
        if self.base64 { bytes.div_ceil(3).saturating_mul(4) } else { bytes }
    }
}

/// Decodes the bytes of an array, from the first to the last.
pub(super) struct Encoded<'a> {
    big_endian: bool,
    bytes: Bytes<'a>,
}

enum Bytes<'a> {
    None,
    Plain(Box<Run<'a>>),
    Blocks(Box<Blocks<'a>>),
}

/// Name and place of an array for error messages.
#[derive(Clone)]
struct Named {
    what: String,
    /// Byte offset of the array.
    offset: u64,
}

impl Named {
    fn truncated(&self, needed: u64, found: u64) -> ReadError {
        truncated(&self.what, self.offset, needed, found)
    }

    fn malformed(&self, expected: String, found: String) -> ReadError {
        ReadError::malformed(expected, found, Place::Byte(self.offset))
    }
}

impl<'a> Encoded<'a> {
    /// Opens a binary array: reads its header and checks that it declares as many values as `segment` has. `spare`
    /// holds sources from an earlier array of the file, which are read on if possible instead of opening the file
    /// again.
    pub(super) fn open(
        segment: &Segment<'a>,
        encoding: Encoding,
        offset: u64,
        name: &str,
        spare: &mut Spare<'a>,
    ) -> Result<Self, ReadError> {
        let array = Named { what: format!("array `{name}`"), offset };
        let size = segment.ty.size().unwrap_or(1);
        let expected = segment.count.saturating_mul(size);
        let check = |found: u64| match found == expected {
            true => Ok(()),
            false => Err(ReadError::Length {
                attribute: name.to_string(),
                expected: segment.count,
                found: found / size,
            }),
        };
        let word = encoding.word();
        let source = segment.content.reach(spare.data.take(), segment.start, segment.end)?;
        let mut head = Run::new(source, encoding, array.clone(), word)?;
        let first = head.words(1)?.first().copied().unwrap_or(0);
        let bytes = if encoding.compression == Compression::None {
            let run = if head.is_ended() {
                // Some writers encode the header of uncompressed data separately, with its own padding.
                Run::new(head.source, encoding, array, first)?
            } else {
                head.extended(word.saturating_add(first))?
            };
            check(first)?;
            Bytes::Plain(Box::new(run))
        } else if first == 0 {
            check(0)?;
            Bytes::None
        } else {
            let length = first.saturating_add(3).saturating_mul(word);
            let mut head = head.extended(length)?;
            let sizes = head.words(2)?;
            let (block, last) = match sizes.as_slice() {
                [block, 0] => (*block, *block),
                [block, last] => (*block, *last),
                _ => (0, 0),
            };
            check((first - 1).saturating_mul(block).saturating_add(last))?;
            let packed = head.sum(first)?;
            let packed = Run::new(head.source, encoding, array.clone(), packed)?;
            let source = segment.content.reach(spare.sizes.take(), segment.start, segment.end)?;
            let mut sizes = Run::new(source, encoding, array, length)?;
            sizes.words(3)?;
            Bytes::Blocks(Box::new(Blocks {
                sizes,
                ahead: Vec::new().into_iter(),
                packed,
                count: first,
                next: 0,
                block,
                last,
                size: 0,
                left: 0,
                unpacked: Vec::new(),
                given: 0,
                inflate: None,
            }))
        };
        Ok(Self { big_endian: encoding.big_endian, bytes })
    }

    pub(super) fn big_endian(&self) -> bool {
        self.big_endian
    }

    /// Appends the next `count` bytes.
    pub(super) fn fill(&mut self, count: u64, out: &mut Vec<u8>) -> Result<(), ReadError> {
        match &mut self.bytes {
            Bytes::None => Ok(()),
            Bytes::Plain(run) => run.fill(count, out),
            Bytes::Blocks(blocks) => blocks.fill(count, out),
        }
    }

    pub(super) fn into_spare(self, content: &Content<'a>) -> Spare<'a> {
        match self.bytes {
            Bytes::None => Spare::default(),
            Bytes::Plain(run) => Spare { data: content.spare(run.source), sizes: None },
            Bytes::Blocks(blocks) => Spare {
                data: content.spare(blocks.packed.source),
                sizes: content.spare(blocks.sizes.source),
            },
        }
    }
}

/// Reads a contiguous range of the file: raw bytes, or base64 text that was encoded in one go, with padding only at
/// its end.
struct Run<'a> {
    source: Source<'a>,
    encoding: Encoding,
    array: Named,
    /// Decoded bytes: the total, and how many were returned.
    bytes: u64,
    gone: u64,
    /// Encoded bytes: how many are still unread, and how many were read.
    left: u64,
    passed: u64,
    text: Vec<u8>,
    /// Decoded bytes that are buffered, and how many of them were returned.
    decoded: Vec<u8>,
    given: usize,
}

impl<'a> Run<'a> {
    /// A range of `bytes` decoded bytes; an error if the file is shorter.
    fn new(
        source: Source<'a>,
        encoding: Encoding,
        array: Named,
        bytes: u64,
    ) -> Result<Self, ReadError> {
        let run = Self {
            source,
            encoding,
            array,
            bytes: 0,
            gone: 0,
            left: 0,
            passed: 0,
            text: Vec::new(),
            decoded: Vec::new(),
            given: 0,
        };
        run.extended(bytes)
    }

    /// Changes the total number of decoded bytes.
    fn extended(mut self, bytes: u64) -> Result<Self, ReadError> {
        self.bytes = bytes;
        self.left = self.encoding.stored(bytes).saturating_sub(self.passed);
        // Padding ends base64, so nothing may follow it.
        let padded = (self.decoded.len() as u64) < self.passed / 4 * 3;
        if self.encoding.base64 && self.left > 0 && padded {
            let pad = self.text.iter().position(|b| *b == b'=').unwrap_or(0);
            let before = self.passed - self.text.len() as u64;
            return Err(self.not_base64(before, &DecodeError::InvalidByte(pad, b'=')));
        }
        let there = self.source.most_left();
        if there < self.left {
            return Err(self.array.truncated(self.passed + self.left, self.passed + there));
        }
        Ok(self)
    }

    /// Whether no decoded byte waits to be returned. After the header's words in base64 this means that the header
    /// was encoded separately and ended with padding. It is always true for raw bytes, which are not decoded ahead.
    fn is_ended(&self) -> bool {
        !self.encoding.base64 || self.given == self.decoded.len()
    }

    /// Appends the next `count` bytes.
    fn fill(&mut self, count: u64, out: &mut Vec<u8>) -> Result<(), ReadError> {
        if !self.encoding.base64 {
            let before = out.len();
            self.source.fill(count.min(self.left), out)?;
            let found = (out.len() - before) as u64;
            (self.passed, self.left) = (self.passed + found, self.left - found);
            return if found < count { Err(self.array.truncated(count, found)) } else { Ok(()) };
        }
        let mut wanted = usize::try_from(count).unwrap_or(usize::MAX);
        while wanted > 0 {
            let there = self.decoded.get(self.given..).unwrap_or_default();
            let some = there.get(..wanted).unwrap_or(there);
            out.extend_from_slice(some);
            (self.given, wanted) = (self.given + some.len(), wanted - some.len());
            self.gone += some.len() as u64;
            if wanted > 0 {
                if self.left == 0 {
                    return Err(self.array.truncated(self.bytes, self.gone));
                }
                self.decode()?;
            }
        }
        Ok(())
    }

    /// Decodes the next base64 characters of the range into `decoded`. Only the last four characters of the range may
    /// have padding (`=`).
    fn decode(&mut self) -> Result<(), ReadError> {
        let count = self.left.min(CHARACTERS);
        self.text.clear();
        self.source.fill(count, &mut self.text)?;
        if (self.text.len() as u64) < count {
            return Err(self.array.truncated(self.left, self.text.len() as u64));
        }
        let engine: &GeneralPurpose = if count == self.left { &STANDARD } else { &STANDARD_NO_PAD };
        self.decoded.clear();
        self.given = 0;
        // The standard allows line breaks inside base64; no known writer makes them, and they are an error here.
        engine
            .decode_vec(&self.text, &mut self.decoded)
            .map_err(|e| self.not_base64(self.passed, &e))?;
        (self.passed, self.left) = (self.passed + count, self.left - count);
        Ok(())
    }

    /// Error of a range that is not base64. `error` has a position in the characters that were read last, before
    /// which `passed` characters of the range were read; the message has the position in the range.
    fn not_base64(&self, passed: u64, error: &DecodeError) -> ReadError {
        let passed = passed as usize;
        let error = match *error {
            DecodeError::InvalidByte(at, byte) => DecodeError::InvalidByte(passed + at, byte),
            DecodeError::InvalidLastSymbol { offset, symbol, symbol_value } => {
                let offset = passed + offset;
                DecodeError::InvalidLastSymbol { offset, symbol, symbol_value }
            }
            ref error => error.clone(),
        };
        let expected = format!("base64 in {}", self.array.what);
        ReadError::malformed(expected, error.to_string(), Place::Unknown)
    }

    fn skip(&mut self, count: u64) -> Result<(), ReadError> {
        let mut left = count;
        let mut passed = Vec::new();
        while left > 0 {
            let some = left.min(PACKED);
            passed.clear();
            self.fill(some, &mut passed)?;
            left -= some;
        }
        Ok(())
    }

    /// Reads the next header words.
    fn words(&mut self, count: u64) -> Result<Vec<u64>, ReadError> {
        let mut bytes = Vec::new();
        self.fill(count * self.encoding.word(), &mut bytes)?;
        Ok(self.encoding.words(&bytes))
    }

    /// Reads the next header words and returns their sum.
    fn sum(&mut self, count: u64) -> Result<u64, ReadError> {
        let mut sum = 0_u64;
        let mut left = count;
        while left > 0 {
            let some = left.min(SIZES);
            sum = self.words(some)?.into_iter().fold(sum, u64::saturating_add);
            left -= some;
        }
        Ok(sum)
    }
}

/// Decompresses the blocks of an array one after the other.
struct Blocks<'a> {
    /// Reads the compressed sizes, some of them ahead.
    sizes: Run<'a>,
    ahead: std::vec::IntoIter<u64>,
    packed: Run<'a>,
    count: u64,
    /// `next` is the number of blocks that were started. `size` is the decompressed size of the current block in
    /// bytes, and `left` is how much of it is still to be decompressed.
    next: u64,
    size: u64,
    left: u64,
    /// Size of a block, and of the last one.
    block: u64,
    last: u64,
    /// Decompressed bytes that are buffered, and how many of them were returned.
    unpacked: Vec<u8>,
    given: usize,
    inflate: Option<Inflate>,
}

impl Blocks<'_> {
    fn fill(&mut self, count: u64, out: &mut Vec<u8>) -> Result<(), ReadError> {
        let mut wanted = usize::try_from(count).unwrap_or(usize::MAX);
        while wanted > 0 {
            let there = self.unpacked.get(self.given..).unwrap_or_default();
            let some = there.get(..wanted).unwrap_or(there);
            out.extend_from_slice(some);
            (self.given, wanted) = (self.given + some.len(), wanted - some.len());
            if wanted > 0 {
                self.given = 0;
                self.unpacked.clear();
                self.unpack()?;
            }
        }
        Ok(())
    }

    /// Decompresses the next bytes. LZ4 and LZMA blocks are decompressed whole.
    fn unpack(&mut self) -> Result<(), ReadError> {
        if self.left > 0 {
            return self.inflate();
        }
        if self.next == self.count {
            return Err(changed());
        }
        if self.ahead.len() == 0 {
            self.ahead = self.sizes.words(SIZES.min(self.count - self.next))?.into_iter();
        }
        let packed = self.ahead.next().unwrap_or(0);
        self.next += 1;
        let size = if self.next == self.count { self.last } else { self.block };
        if self.packed.encoding.compression == Compression::Zlib {
            (self.size, self.left) = (size, size);
            self.inflate.get_or_insert_default().start(packed);
            return self.inflate();
        }
        let mut block = Vec::new();
        self.packed.fill(packed, &mut block)?;
        self.unpacked = self.packed.unpack_block(&block, size)?;
        let found = self.unpacked.len() as u64;
        if found == size { Ok(()) } else { Err(self.short(size, found)) }
    }

    /// Decompresses the next [`UNPACKED`] bytes of a zlib block, or its rest, into `unpacked`. The number does not
    /// depend on how many bytes the caller of `fill` wants, so that an error message is the same whether a file is
    /// read in parts or whole.
    fn inflate(&mut self) -> Result<(), ReadError> {
        let count = self.left.min(UNPACKED) as usize;
        let inflate = self.inflate.get_or_insert_default();
        self.unpacked.resize(count, 0);
        let mut rest = self.unpacked.as_mut_slice();
        while !rest.is_empty() {
            match inflate.read(&mut self.packed, rest)? {
                0 => {
                    let found = inflate.done;
                    return Err(self.short(self.size, found));
                }
                read => rest = rest.get_mut(read..).unwrap_or_default(),
            }
        }
        self.left -= count as u64;
        if self.left == 0 {
            // Only the end of the stream has the checksum.
            if inflate.read(&mut self.packed, &mut [0])? > 0 {
                let what = self.packed.array.what.clone();
                return Err(ReadError::TooLarge { what, limit: self.size });
            }
            self.packed.skip(inflate.packed)?;
        }
        Ok(())
    }

    /// Error of a block whose decompressed size is wrong.
    fn short(&self, size: u64, found: u64) -> ReadError {
        let array = &self.packed.array;
        let expected = format!("{size} bytes in block {} of {}", self.next - 1, array.what);
        array.malformed(expected, format!("{found} bytes"))
    }
}

/// Decompresses a zlib block a stretch at a time.
struct Inflate {
    state: flate2::Decompress,
    input: Vec<u8>,
    used: usize,
    /// Compressed bytes of the block that are not read yet.
    packed: u64,
    /// Decompressed bytes of the block so far.
    done: u64,
    ended: bool,
}

impl Default for Inflate {
    fn default() -> Self {
        let state = flate2::Decompress::new(true);
        Self { state, input: Vec::new(), used: 0, packed: 0, done: 0, ended: false }
    }
}

impl Inflate {
    /// Starts a block of `packed` compressed bytes.
    fn start(&mut self, packed: u64) {
        self.state.reset(true);
        self.input.clear();
        (self.used, self.packed, self.done, self.ended) = (0, packed, 0, false);
    }

    /// Decompresses the block's next bytes into `out`. Returns how many bytes of `out` it has filled, 0 at the end of
    /// the block.
    fn read(&mut self, from: &mut Run<'_>, out: &mut [u8]) -> Result<usize, ReadError> {
        while !self.ended {
            if self.used == self.input.len() && self.packed > 0 {
                self.input.clear();
                self.used = 0;
                let some = self.packed.min(PACKED);
                from.fill(some, &mut self.input)?;
                self.packed -= some;
            }
            let input = self.input.get(self.used..).unwrap_or_default();
            let (flush, all) = match input.is_empty() {
                true => (flate2::FlushDecompress::Finish, true),
                false => (flate2::FlushDecompress::None, false),
            };
            let (used, done) = (self.state.total_in(), self.state.total_out());
            let status = self.state.decompress(input, out, flush);
            self.used += (self.state.total_in() - used) as usize;
            let read = (self.state.total_out() - done) as usize;
            let fault = match status {
                Ok(status) => {
                    self.ended = status == flate2::Status::StreamEnd;
                    (read == 0 && all && !self.ended).then_some("incomplete deflate stream")
                }
                Err(_) => Some("corrupt deflate stream"),
            };
            if let Some(fault) = fault {
                let array = &from.array;
                let found = format!("{fault} after {} unpacked bytes", self.done);
                return Err(array.malformed(format!("sound {}", array.what), found));
            }
            self.done += read as u64;
            if read > 0 {
                return Ok(read);
            }
        }
        Ok(0)
    }
}

impl Run<'_> {
    /// Decompresses a block whole.
    fn unpack_block(&self, block: &[u8], size: u64) -> Result<Vec<u8>, ReadError> {
        let (array, what) = (&self.array, &self.array.what);
        let size = usize::try_from(size).unwrap_or(usize::MAX);
        match self.encoding.compression {
            Compression::Lz4 => {
                // LZ4 expands by a factor of 255 at most, so no more memory is allocated, whatever the header
                // says.
                if size > block.len().saturating_mul(255).saturating_add(64) {
                    return Err(array.malformed(
                        format!("LZ4 data for {size} bytes in {what}"),
                        format!("{} bytes", block.len()),
                    ));
                }
                lz4_flex::block::decompress(block, size).map_err(|e| {
                    array.malformed(format!("sound LZ4 data in {what}"), e.to_string())
                })
            }
            // The decoder allocates the whole dictionary. The limit allows 64 MiB, as level 9 needs.
            Compression::Lzma => {
                let reader = lzma_rust2::XzReader::new_mem_limit(block, true, 66 << 10);
                unpack(reader, size, what, array.offset as usize)
            }
            Compression::Zlib | Compression::None => Ok(block.to_vec()),
        }
    }
}
