//! Reads the text of a file by lines or words. Only one chunk of it is in memory, or one line or word if that
//! is longer.

use super::columns::{AttributeType, Data};
use super::error::{Place, ReadError};
use super::source::{Content, Source, truncated};

/// Number of bytes read at a time.
const CHUNK: u64 = 1 << 16;

/// A reader of text.
pub(super) struct Text<'a> {
    source: Source<'a>,
    /// Bytes that were read, and how many of them were consumed.
    buffer: Vec<u8>,
    next: usize,
}

impl<'a> Text<'a> {
    pub(super) fn new(source: Source<'a>) -> Self {
        Self { source, buffer: Vec::new(), next: 0 }
    }

    /// Starts at the beginning of the file, behind a byte order mark.
    pub(super) fn of(content: &Content<'a>) -> Result<Self, ReadError> {
        let mut text = Self::new(content.open(0, content.length())?);
        if text.ahead(3)?.starts_with(b"\xef\xbb\xbf") {
            text.next += 3;
        }
        Ok(text)
    }

    pub(super) fn into_source(self) -> Source<'a> {
        self.source
    }

    fn rest(&self) -> &[u8] {
        self.buffer.get(self.next..).unwrap_or_default()
    }

    /// Byte offset of the next byte.
    pub(super) fn at(&self) -> u64 {
        self.source.at() - self.rest().len() as u64
    }

    pub(super) fn place(&self) -> Place {
        Place::Byte(self.at())
    }

    /// Number of bytes not consumed yet.
    pub(super) fn left(&self) -> u64 {
        self.source.most_left() + self.rest().len() as u64
    }

    /// Reads the next chunk into the buffer; false at the end of the file.
    fn more(&mut self) -> Result<bool, ReadError> {
        self.buffer.drain(..self.next);
        self.next = 0;
        let before = self.buffer.len();
        let mut some = CHUNK;
        if before < CHUNK as usize / 2 {
            some -= before as u64;
        } else {
            // A line longer than the buffer: grow by whole chunks.
            self.buffer.reserve(CHUNK as usize);
        }
        self.source.fill(some, &mut self.buffer)?;
        Ok(self.buffer.len() > before)
    }

    /// The next `count` bytes, or all if fewer are left, without consuming them.
    pub(super) fn ahead(&mut self, count: usize) -> Result<&[u8], ReadError> {
        while self.rest().len() < count && self.more()? {}
        let rest = self.rest();
        Ok(rest.get(..count).unwrap_or(rest))
    }

    /// Number of bytes before the next one that `search` finds, and whether there is such a byte.
    fn find(
        &mut self,
        search: impl Fn(&[u8]) -> Option<usize>,
    ) -> Result<(usize, bool), ReadError> {
        let mut searched = 0;
        loop {
            let rest = self.rest().get(searched..).unwrap_or_default();
            if let Some(end) = search(rest) {
                return Ok((searched + end, true));
            }
            searched += rest.len();
            if !self.more()? {
                return Ok((searched, false));
            }
        }
    }

    fn pass(&mut self, count: usize) -> &[u8] {
        let from = self.next;
        self.next = self.buffer.len().min(from.saturating_add(count));
        self.buffer.get(from..self.next).unwrap_or_default()
    }

    /// The next line without its end, or `None` at the end.
    pub(super) fn line(&mut self) -> Result<Option<&[u8]>, ReadError> {
        let (length, ends) = self.find(|rest| memchr::memchr(b'\n', rest))?;
        if length == 0 && !ends {
            return Ok(None);
        }
        let line = self.pass(length + usize::from(ends));
        let line = line.get(..length).unwrap_or_default();
        Ok(Some(line.strip_suffix(b"\r").unwrap_or(line)))
    }

    pub(super) fn skip_space(&mut self) -> Result<(), ReadError> {
        loop {
            let space = self.rest().iter().position(|b| !b.is_ascii_whitespace());
            self.next = space.map_or(self.buffer.len(), |space| self.next + space);
            if space.is_some() || !self.more()? {
                return Ok(());
            }
        }
    }

    /// The next word between white space, or `None` at the end.
    pub(super) fn token(&mut self) -> Result<Option<&[u8]>, ReadError> {
        self.skip_space()?;
        let (length, _) = self.find(|rest| rest.iter().position(u8::is_ascii_whitespace))?;
        Ok(Some(self.pass(length)).filter(|token| !token.is_empty()))
    }

    /// Consumes the bytes up to `end` and `end` itself. Returns those before it (only the first ones if there
    /// are many), or `None` if `end` does not follow.
    pub(super) fn until(&mut self, end: u8) -> Result<Option<Vec<u8>>, ReadError> {
        let mut passed = Vec::new();
        loop {
            let rest = self.rest();
            let found = rest.iter().position(|b| *b == end);
            let before = rest.get(..found.unwrap_or(rest.len())).unwrap_or_default();
            let room = (CHUNK as usize).saturating_sub(passed.len()).min(before.len());
            passed.extend(before.iter().take(room));
            self.next = found.map_or(self.buffer.len(), |found| self.next + found + 1);
            if found.is_some() {
                return Ok(Some(passed));
            }
            if !self.more()? {
                return Ok(None);
            }
        }
    }

    fn require(&self, count: u64, what: &str) -> Result<(), ReadError> {
        let left = self.left();
        if left < count { Err(truncated(what, self.at(), count, left)) } else { Ok(()) }
    }

    /// Consumes `count` bytes, which need not be text.
    pub(super) fn take(&mut self, count: u64, what: &str) -> Result<&[u8], ReadError> {
        self.require(count, what)?;
        let (at, count) = (self.at(), count as usize);
        let found = self.ahead(count)?.len();
        if found < count {
            return Err(truncated(what, at, count as u64, found as u64));
        }
        Ok(self.pass(count))
    }

    /// Consumes bytes, without reading them if possible.
    pub(super) fn skip(&mut self, count: u64, what: &str) -> Result<(), ReadError> {
        self.require(count, what)?;
        let there = count.min(self.rest().len() as u64);
        self.pass(there as usize);
        self.source.skip(count - there, what)
    }

    /// Appends the next `count` of `left` numbers from words of text.
    pub(super) fn numbers(
        &mut self,
        count: u64,
        left: u64,
        what: &str,
        data: &mut Data,
    ) -> Result<(), ReadError> {
        for i in 0..count {
            let place = self.place();
            let Some(token) = self.token()? else { return Err(self.ended(left - i, what)) };
            if !data.push_text(token) {
                let expected = format!("a number for {what}");
                return Err(ReadError::malformed(expected, super::bytes::show(token), place));
            }
        }
        Ok(())
    }

    /// The error at the end of the file when `missing` more words are expected.
    fn ended(&self, missing: u64, what: &str) -> ReadError {
        // A number and the space after it take at least two bytes.
        truncated(what, self.at(), missing.saturating_mul(2).saturating_sub(1), 0)
    }

    /// Consumes `count` words.
    pub(super) fn skip_words(&mut self, count: u64, what: &str) -> Result<(), ReadError> {
        let mut left = count;
        let mut inside = false;
        while left > 0 {
            let ends = self.rest().iter().position(|byte| {
                let space = byte.is_ascii_whitespace();
                left -= u64::from(inside && space);
                inside = !space;
                left == 0
            });
            self.next = ends.map_or(self.buffer.len(), |end| self.next + end);
            if left > 0 && !self.more()? {
                left -= u64::from(inside);
                return if left == 0 { Ok(()) } else { Err(self.ended(left, what)) };
            }
        }
        Ok(())
    }

    /// Consumes `count` words and checks that each is a number.
    pub(super) fn check_numbers(
        &mut self,
        ty: AttributeType,
        count: u64,
        what: &str,
    ) -> Result<(), ReadError> {
        let mut left = count;
        while left > 0 {
            let some = left.min(1 << 12);
            self.numbers(some, left, what, &mut Data::for_type(ty))?;
            left -= some;
        }
        Ok(())
    }
}
