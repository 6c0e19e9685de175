//! Reads the bytes of a file in sequence, directly or decompressed. Only what the reader asked for is in
//! memory at a time. Reading starts at the first byte, or at any byte once the length of compressed content
//! is known.

use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use flate2::Crc;

use super::bytes::unpack_limit;
use super::error::{Place, ReadError};

/// A file, or a substitute for one.
pub(super) trait Bytes: Read + Seek + Send {}
impl<T: Read + Seek + Send> Bytes for T {}

/// A file that is read alternately at several positions.
#[derive(Clone)]
pub(super) struct Input<'a> {
    file: Arc<Mutex<Box<dyn Bytes + 'a>>>,
    length: u64,
}

impl<'a> Input<'a> {
    pub(super) fn new(mut file: impl Bytes + 'a) -> Result<Self, ReadError> {
        let length = file.seek(SeekFrom::End(0)).map_err(io_error)?;
        Ok(Self { file: Arc::new(Mutex::new(Box::new(file))), length })
    }

    /// The whole file, not decompressed.
    pub(super) fn section(&self) -> Section<'a> {
        Section { input: self.clone(), start: 0, at: 0, end: self.length }
    }

    pub(super) fn whole(&self, gzip: bool) -> Piece {
        let packing = if gzip { Packing::Gzip } else { Packing::None };
        Piece { start: 0, end: self.length, packing, what: "gzip data".into(), check: None }
    }

    /// Limit of what it may decompress to.
    pub(super) fn unpack_limit(&self) -> u64 {
        unpack_limit(usize::try_from(self.length).unwrap_or(usize::MAX)) as u64
    }
}

/// The decompressed content of a file, which can be opened at any position.
#[derive(Clone)]
pub(super) struct Content<'a> {
    input: Input<'a>,
    piece: Piece,
    length: u64,
    /// Number of lines of the file before this content.
    lines: u64,
}

impl<'a> Content<'a> {
    /// Compressed content is decompressed once, because only that shows its length and errors.
    pub(super) fn new(input: &Input<'a>, gzip: bool) -> Result<Self, ReadError> {
        let piece = input.whole(gzip);
        let mut length = input.length;
        if gzip {
            let mut source = Source::new(input, &piece);
            source.finish()?;
            length = source.at();
        }
        Ok(Self { input: input.clone(), piece, length, lines: 0 })
    }

    /// Content in memory.
    pub(super) fn of_bytes(bytes: impl AsRef<[u8]> + Send + 'a) -> Result<Self, ReadError> {
        Self::new(&Input::new(io::Cursor::new(bytes))?, false)
    }

    pub(super) fn length(&self) -> u64 {
        self.length
    }

    pub(super) fn lines_before(&self) -> u64 {
        self.lines
    }

    /// The content from byte `start` to byte `end`, as content of its own; `lines` lines of the file precede
    /// it. Of compressed content, a decompressed copy is kept in memory.
    pub(super) fn part(&self, start: u64, end: u64, lines: u64) -> Result<Self, ReadError> {
        let (start, end) = (start.min(self.length), end.min(self.length));
        let part = if self.piece.packing == Packing::None {
            let from = self.piece.start;
            let section = Section {
                input: self.input.clone(),
                start: from + start,
                at: from + start,
                end: from + end,
            };
            Self::new(&Input::new(section)?, false)?
        } else {
            let mut bytes = Vec::new();
            self.open(start, end)?.fill(end.saturating_sub(start), &mut bytes)?;
            Self::of_bytes(bytes)?
        };
        Ok(Self { lines, ..part })
    }

    /// Limit of what compressed values in it may decompress to.
    pub(super) fn unpack_limit(&self) -> u64 {
        unpack_limit(usize::try_from(self.length).unwrap_or(usize::MAX)) as u64
    }

    /// Opens a range of bytes. Compressed content is decompressed up to there.
    pub(super) fn open(&self, start: u64, end: u64) -> Result<Source<'a>, ReadError> {
        self.reach(None, start, end)
    }

    /// Decides whether to keep `source`, whose range has been read, for the next call of
    /// [`reach`](Self::reach). If the content is compressed, it is returned, because it can be read on to a
    /// later position; otherwise `None`, because every position can be opened directly.
    pub(super) fn spare(&self, source: Source<'a>) -> Option<Source<'a>> {
        Some(source).filter(|_| self.piece.packing != Packing::None)
    }

    /// Opens the bytes from `start` to `end` of the content. `spare` is a source opened earlier: if possible
    /// it is read on to `start`, instead of decompressing anew from the beginning.
    pub(super) fn reach(
        &self,
        spare: Option<Source<'a>>,
        start: u64,
        end: u64,
    ) -> Result<Source<'a>, ReadError> {
        let packed = self.piece.packing != Packing::None;
        let spare = spare.filter(|spare| packed && spare.at <= start);
        let mut source = spare.unwrap_or_else(|| Source::new(&self.input, &self.piece));
        let end = end.min(self.length);
        source.length = Some(end);
        source.skip(start.min(end) - source.at.min(end), &self.piece.what)?;
        Ok(source)
    }
}

/// An error without the file's name, which a caller adds.
pub(super) fn io_error(reason: io::Error) -> ReadError {
    ReadError::Io { path: PathBuf::new(), reason }
}

/// Restores the error of a reader that can only return system errors.
pub(super) fn inner_error(reason: io::Error) -> ReadError {
    reason.downcast::<ReadError>().unwrap_or_else(io_error)
}

/// A range of a file, with its own position.
pub(super) struct Section<'a> {
    input: Input<'a>,
    start: u64,
    at: u64,
    end: u64,
}

impl Read for Section<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let left = usize::try_from(self.end.saturating_sub(self.at)).unwrap_or(usize::MAX);
        let room = left.min(out.len());
        let mut file = self.input.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(self.at))?;
        let read = file.read(out.get_mut(..room).unwrap_or_default())?;
        self.at += read as u64;
        Ok(read)
    }
}

impl Seek for Section<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(n) => self.start.checked_add(n),
            SeekFrom::End(n) => self.end.checked_add_signed(n),
            SeekFrom::Current(n) => self.at.checked_add_signed(n),
        };
        let before = || io::Error::new(io::ErrorKind::InvalidInput, "a seek out of the file");
        self.at = at.filter(|at| *at >= self.start).ok_or_else(before)?;
        Ok(self.at - self.start)
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Packing {
    None,
    Gzip,
    Deflate,
}

/// Where bytes are in a file, and how they are stored.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub(super) start: u64,
    pub(super) end: u64,
    pub(super) packing: Packing,
    /// Name for messages.
    pub(super) what: String,
    /// Expected checksum and length after decompression.
    pub(super) check: Option<Check>,
}

/// Checksum and length of an entry in a zip.
#[derive(Debug, Clone, Copy)]
pub(super) struct Check {
    pub(super) crc: u32,
    pub(super) size: u64,
}

enum Reader<'a> {
    Plain(Section<'a>),
    Unpacked(Box<dyn Read + Send + 'a>),
}

/// Reads the bytes of a piece, decompressed.
pub(super) struct Source<'a> {
    reader: Reader<'a>,
    what: String,
    /// Number of bytes read so far.
    at: u64,
    /// Total number of bytes, if it is known without decompression.
    length: Option<u64>,
    limit: u64,
    check: Option<(Crc, Check)>,
}

impl<'a> Source<'a> {
    pub(super) fn new(input: &Input<'a>, piece: &Piece) -> Self {
        let Piece { start, end, packing, what, check } = piece.clone();
        let section = Section { input: input.clone(), start, at: start, end };
        let reader = match packing {
            Packing::None => Reader::Plain(section),
            Packing::Gzip => Reader::Unpacked(Box::new(flate2::bufread::MultiGzDecoder::new(
                BufReader::with_capacity(1 << 16, section),
            ))),
            Packing::Deflate => Reader::Unpacked(Box::new(flate2::bufread::DeflateDecoder::new(
                BufReader::with_capacity(1 << 16, section),
            ))),
        };
        Self {
            length: matches!(reader, Reader::Plain(_)).then(|| end.saturating_sub(start)),
            reader,
            what,
            at: 0,
            limit: input.unpack_limit(),
            check: check.map(|check| (Crc::new(), check)),
        }
    }

    /// Number of bytes read or skipped so far.
    pub(super) fn at(&self) -> u64 {
        self.at
    }

    /// Upper bound of the bytes left, independent of any header.
    pub(super) fn most_left(&self) -> u64 {
        self.length.unwrap_or(self.limit).saturating_sub(self.at)
    }

    /// Appends the next `count` bytes, or all if fewer are left.
    pub(super) fn fill(&mut self, count: u64, out: &mut Vec<u8>) -> Result<(), ReadError> {
        let before = out.len();
        let mut count = count;
        if let Some(length) = self.length {
            count = count.min(length.saturating_sub(self.at));
            out.reserve_exact(usize::try_from(count).unwrap_or(0));
        }
        let read = match &mut self.reader {
            Reader::Plain(section) => section.take(count).read_to_end(out),
            Reader::Unpacked(reader) => reader.take(count).read_to_end(out),
        };
        self.came(out.get(before..).unwrap_or_default(), read)
    }

    /// Counts and checks new bytes.
    fn came(&mut self, new: &[u8], read: io::Result<usize>) -> Result<(), ReadError> {
        self.at += new.len() as u64;
        if let Some((crc, _)) = &mut self.check {
            crc.update(new);
        }
        match (read, &self.reader) {
            (Err(reason), Reader::Plain(_)) => Err(io_error(reason)),
            (Err(reason), Reader::Unpacked(_)) => {
                Err(self.unsound(&format!("{reason} after {} unpacked bytes", self.at)))
            }
            (Ok(_), Reader::Unpacked(_)) if self.at > self.limit => {
                Err(ReadError::TooLarge { what: self.what.clone(), limit: self.limit })
            }
            (Ok(_), _) => Ok(()),
        }
    }

    /// Fails if it is known that fewer than `count` bytes are left.
    pub(super) fn require(&self, count: u64, what: &str) -> Result<(), ReadError> {
        let left = self.length.map_or(u64::MAX, |length| length.saturating_sub(self.at));
        if left < count { Err(truncated(what, self.at, count, left)) } else { Ok(()) }
    }

    /// Skips bytes.
    pub(super) fn skip(&mut self, count: u64, what: &str) -> Result<(), ReadError> {
        self.require(count, what)?;
        if let (Reader::Plain(section), None) = (&mut self.reader, &self.check) {
            section.at += count;
            self.at += count;
            return Ok(());
        }
        let from = self.at;
        let mut passed = Vec::new();
        while self.at - from < count {
            passed.clear();
            self.fill((count - (self.at - from)).min(1 << 16), &mut passed)?;
            if passed.is_empty() {
                return Err(truncated(what, from, count, self.at - from));
            }
        }
        Ok(())
    }

    /// Reads the rest if that is needed to detect errors.
    pub(super) fn finish(&mut self) -> Result<(), ReadError> {
        if let (Reader::Plain(_), None) = (&self.reader, &self.check) {
            return Ok(());
        }
        let mut passed = Vec::new();
        loop {
            passed.clear();
            self.fill(1 << 16, &mut passed)?;
            if passed.is_empty() {
                break;
            }
        }
        match &self.check {
            Some((_, check)) if self.at > check.size => {
                Err(self.unsound("more bytes than were stored"))
            }
            Some((crc, check)) if crc.sum() != check.crc => {
                Err(self.unsound("another checksum than that of what was stored"))
            }
            _ => Ok(()),
        }
    }

    fn unsound(&self, found: &str) -> ReadError {
        ReadError::malformed(format!("sound {}", self.what), found, Place::Byte(0))
    }
}

impl Read for Source<'_> {
    /// The errors are for [`inner_error`].
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let left = self.length.map_or(u64::MAX, |length| length.saturating_sub(self.at));
        let room = usize::try_from(left).unwrap_or(usize::MAX).min(out.len());
        let out = out.get_mut(..room).unwrap_or_default();
        let read = match &mut self.reader {
            Reader::Plain(section) => section.read(out),
            Reader::Unpacked(reader) => reader.read(out),
        };
        let count = match &read {
            Err(again) if again.kind() == io::ErrorKind::Interrupted => return read,
            read => *read.as_ref().unwrap_or(&0),
        };
        self.came(out.get(..count).unwrap_or_default(), read).map_err(io::Error::other)?;
        Ok(count)
    }
}

pub(super) fn truncated(what: &str, offset: u64, needed: u64, found: u64) -> ReadError {
    ReadError::Truncated { what: what.into(), offset, needed, found }
}

/// Parses the header of a file: calls `parse` with more and more of the beginning, until that is enough.
/// `parse` returns the parsed header and its length in bytes.
pub(super) fn header<T>(
    source: &mut Source<'_>,
    mut parse: impl FnMut(&[u8]) -> Result<(T, u64), ReadError>,
) -> Result<T, ReadError> {
    let mut head = Vec::new();
    let mut room = 1_u64 << 16;
    loop {
        source.fill(room - head.len() as u64, &mut head)?;
        let all = (head.len() as u64) < room;
        match parse(&head) {
            Err(ReadError::Truncated { .. }) if !all => {}
            // A line may end with two characters, the second of which is not read yet.
            Ok((_, length)) if length >= room && !all => {}
            result => return result.map(|(parsed, _)| parsed),
        }
        room = room.saturating_mul(2);
    }
}
