//! Parses the XML of a VTK file without its long texts. They are nearly all of the file's size, so only their
//! places are kept.

use roxmltree::{Document, Node};

use super::error::{Place, ReadError};
use super::source::Content;
use super::text::Text;

/// The XML ends here if binary data follows.
const APPENDED: &[u8] = b"<AppendedData";

/// Longest text in bytes that is kept in memory.
const LONGEST: u64 = 64;

/// Number of bytes scanned at a time.
const CHUNK: usize = 1 << 14;

/// The line breaks of the text are counted in blocks of this many bytes.
const BLOCK: usize = 1 << 10;

/// The XML of a file, up to its appended data or its end.
pub(super) struct Head {
    /// The XML of the file, with each long text (data) replaced by one character: a space if the text is only white
    /// space, otherwise a digit.
    text: String,
    /// Number of line breaks before each block of the text, so that the line of one of many elements is found without
    /// a count from the beginning.
    breaks: Vec<u64>,
    cuts: Vec<Cut>,
    /// Length of the byte order mark before it.
    mark: u64,
    /// Where the appended data begins in the file.
    pub(super) appended: Option<u64>,
}

/// A text that is not in memory.
struct Cut {
    /// Index in [`Head::text`] of the character that replaces it.
    at: usize,
    /// Byte range of this text in the file, from its first to its last character that is not white space; an empty
    /// range if all of it is white space.
    start: u64,
    end: u64,
    /// Number of bytes and lines left out so far, this text included.
    bytes: u64,
    lines: u64,
    /// Whether this left-out text has a line break, and its number of bytes after the last one.
    breaks: bool,
    column: u64,
}

/// The text of an element.
pub(super) enum Words<'d> {
    /// It is in memory.
    Here(&'d str),
    /// It is in this byte range of the file.
    There(u64, u64),
    /// A long part of the element's text was left out of memory, and the rest has entities or CDATA. So the text is
    /// neither in memory nor a byte range of the file: the XML has to be read again with all texts in memory.
    Mixed,
}

impl Head {
    /// Reads the XML of a file. With `cut`, long texts are left out, so that memory use is proportional to
    /// the structure and not to the data.
    pub(super) fn read(content: &Content<'_>, cut: bool) -> Result<Self, ReadError> {
        let mut text = Text::of(content)?;
        let mark = text.at();
        let mut scan = Scan {
            out: Vec::new(),
            valid: 0,
            cuts: Vec::new(),
            state: State::Text,
            run: Run::default(),
            cut,
            mark,
        };
        let appended = loop {
            let chunk = text.ahead(CHUNK)?;
            let length = chunk.len();
            let appended = scan.chunk(chunk);
            let all = length == 0 || appended.is_some();
            scan.check(all)?;
            if all {
                break appended;
            }
            text.skip(length as u64, "the header")?;
        };
        // The closing tag of the root element comes after the appended data.
        if appended.is_some() {
            scan.out.extend(b"</VTKFile>");
        }
        let text = String::from_utf8(scan.out).unwrap_or_default();
        Ok(Self::of(text, scan.cuts, mark, appended))
    }

    fn of(text: String, cuts: Vec<Cut>, mark: u64, appended: Option<u64>) -> Self {
        let blocks = text.as_bytes().chunks(BLOCK);
        let before = blocks.scan(0, |before, block| {
            let breaks = line_breaks(block);
            let at = *before;
            *before += breaks;
            Some(at)
        });
        Self { breaks: before.collect(), text, cuts, mark, appended }
    }

    pub(super) fn parse(&self) -> Result<Document<'_>, ReadError> {
        Document::parse(&self.text).map_err(|e| {
            let position = e.pos();
            let mut lines = self.text.split_inclusive('\n');
            let before: usize =
                lines.by_ref().take(position.row.saturating_sub(1) as usize).map(str::len).sum();
            let line = lines.next().unwrap_or_default();
            let column = line.char_indices().nth(position.col.saturating_sub(1) as usize);
            let at = before + column.map_or(line.len(), |(i, _)| i);
            // Nothing follows the end of the root.
            let end = "</VTKFile>";
            if !self.text.trim_end().ends_with(end) {
                let all = self.text.len();
                let offset = file_offset(&self.cuts, self.mark, all);
                let what = format!("the XML of a VTK file, up to `{end}`,");
                return ReadError::Truncated { what, offset, needed: 1, found: 0 };
            }
            // The parser's position counts in the shortened text; make it one in the file.
            let there = format!(" at {}:{}", self.line(at), self.column(at));
            let found = e.to_string().replace(&format!(" at {position}"), &there);
            ReadError::malformed("well-formed XML", found, Place::Line(self.line(at)))
        })
    }

    /// Byte offset of an element in the file.
    pub(super) fn offset(&self, node: &Node<'_, '_>) -> u64 {
        let at = node.range().start;
        file_offset(&self.cuts, self.mark, at)
    }

    /// The line at which an element begins.
    pub(super) fn place(&self, node: &Node<'_, '_>) -> Place {
        Place::Line(self.line(node.range().start))
    }

    fn line(&self, at: usize) -> u64 {
        let block = at / BLOCK;
        let missing = before(&self.cuts, at).map_or(0, |cut| cut.lines);
        // The end of the text may be the end of its last block.
        let Some(known) = self.breaks.get(block) else {
            return 1 + missing + line_breaks(self.text.as_bytes());
        };
        let rest = self.text.as_bytes().get(block * BLOCK..at).unwrap_or_default();
        1 + missing + known + line_breaks(rest)
    }

    /// Column of the character at `at`, counted in characters from 1.
    fn column(&self, at: usize) -> u64 {
        let characters =
            |from, to| self.text.get(from..to).map_or(0, |text: &str| text.chars().count() as u64);
        let line = self.text.get(..at).and_then(|head| head.rfind('\n'));
        let mut from = line.map_or(0, |end| end + 1);
        let mut column = 1;
        let first = self.cuts.partition_point(|cut| cut.at < from);
        for cut in self.cuts.iter().skip(first).take_while(|cut| cut.at < at) {
            column = if cut.breaks { 1 } else { column + characters(from, cut.at) };
            column += cut.column;
            from = cut.at + 1;
        }
        column + characters(from, at)
    }

    /// The first text of an element that is not only white space.
    pub(super) fn words<'d>(&self, node: &Node<'d, '_>) -> Words<'d> {
        let texts = node.children().filter(Node::is_text);
        let mut texts = texts.filter_map(|child| Some((child, child.text()?)));
        let Some((child, text)) = texts.find(|(_, text)| !text.trim().is_empty()) else {
            return Words::Here("");
        };
        let start = child.range().start;
        let end = child.next_sibling().map_or(node.range().end, |next| next.range().start);
        let cut = self.cuts.get(self.cuts.partition_point(|cut| cut.at < start));
        match cut.filter(|cut| cut.at < end) {
            None => Words::Here(text.trim()),
            Some(cut) if text.len() == 1 => Words::There(cut.start, cut.end),
            Some(_) => Words::Mixed,
        }
    }
}

fn line_breaks(text: &[u8]) -> u64 {
    text.iter().filter(|b| **b == b'\n').count() as u64
}

/// The last cut before an index.
fn before(cuts: &[Cut], at: usize) -> Option<&Cut> {
    cuts.partition_point(|cut| cut.at < at).checked_sub(1).and_then(|i| cuts.get(i))
}

fn file_offset(cuts: &[Cut], mark: u64, at: usize) -> u64 {
    mark + at as u64 + before(cuts, at).map_or(0, |cut| cut.bytes)
}

/// What the next byte belongs to.
#[derive(Clone, Copy)]
enum State {
    Text,
    /// A tag that begins at this index of the text.
    Tag(usize),
    Quoted(u8),
    /// A comment or similar markup, up to these bytes.
    Until(&'static [u8]),
    /// A character reference that begins at this index of the text.
    Reference(usize),
}

/// Longest character reference in bytes.
const REFERENCE: usize = 16;

/// State of the scan.
struct Scan {
    out: Vec<u8>,
    /// Number of bytes at the start of the output text `out` that are known to be UTF-8.
    valid: usize,
    cuts: Vec<Cut>,
    state: State,
    run: Run,
    cut: bool,
    mark: u64,
}

/// A run of plain characters, see [`is_plain`].
#[derive(Default)]
struct Run {
    length: u64,
    /// Number of bytes after the last line break.
    column: u64,
    /// Number of these bytes at the end of `out`.
    kept: usize,
    lines: u64,
    /// Byte range within the run of text, from its first byte that is not white space to the end of its last one;
    /// `None` if there is none.
    words: Option<(u64, u64)>,
}

/// Whether a byte is printable ASCII or white space, and no markup. A long run of such bytes can be left out of
/// memory.
fn is_plain(byte: u8) -> bool {
    matches!(byte, b'\t' | b'\n' | b'\r' | b' '..=b'~') && !matches!(byte, b'<' | b'>' | b'&')
}

impl Scan {
    /// Scans the next bytes of an XML file; an empty chunk means the end of the file. Stops where the appended data
    /// begins and returns its offset in the file, otherwise `None`.
    fn chunk(&mut self, chunk: &[u8]) -> Option<u64> {
        let mut rest = chunk;
        while let Some((&byte, behind)) = rest.split_first() {
            if let State::Text = self.state {
                let plain = rest.iter().position(|b| !is_plain(*b));
                let (some, other) =
                    rest.split_at_checked(plain.unwrap_or(rest.len())).unwrap_or((rest, &[]));
                if !some.is_empty() {
                    self.plain(some);
                    rest = other;
                    continue;
                }
                self.end_run();
            }
            rest = behind;
            self.out.push(byte);
            self.step(byte);
            if byte == b'a' && self.out.ends_with(APPENDED) {
                self.out.truncate(self.out.len() - APPENDED.len());
                return Some(file_offset(&self.cuts, self.mark, self.out.len()));
            }
        }
        if chunk.is_empty() {
            self.end_run();
        }
        None
    }

    /// Adds plain characters to the current run of them, and drops the run from the output text `out` once it is too
    /// long.
    fn plain(&mut self, some: &[u8]) {
        let run = &mut self.run;
        let space = |b: &u8| b.is_ascii_whitespace();
        if let Some(first) = some.iter().position(|b| !space(b)) {
            let last = some.iter().rposition(|b| !space(b)).unwrap_or(first);
            let start = run.words.map_or(run.length + first as u64, |(start, _)| start);
            run.words = Some((start, run.length + last as u64 + 1));
        }
        run.length += some.len() as u64;
        run.lines += some.iter().filter(|b| **b == b'\n').count() as u64;
        match some.iter().rposition(|b| *b == b'\n') {
            Some(end) => run.column = (some.len() - end - 1) as u64,
            None => run.column += some.len() as u64,
        }
        if !self.cut || run.length <= LONGEST {
            self.out.extend_from_slice(some);
            run.kept += some.len();
        } else {
            self.out.truncate(self.out.len() - run.kept);
            run.kept = 0;
        }
    }

    fn end_run(&mut self) {
        let run = std::mem::take(&mut self.run);
        if !self.cut || run.length <= LONGEST {
            return;
        }
        let at = self.out.len();
        let from = file_offset(&self.cuts, self.mark, at);
        let (start, end) = run.words.unwrap_or((0, 0));
        let (bytes, lines) = self.cuts.last().map_or((0, 0), |cut| (cut.bytes, cut.lines));
        self.cuts.push(Cut {
            at,
            start: from + start,
            end: from + end,
            bytes: bytes + run.length - 1,
            lines: lines + run.lines,
            breaks: run.lines > 0,
            column: run.column,
        });
        self.out.push(if run.words.is_some() { b'0' } else { b' ' });
    }

    /// Fails if the output text has bytes that are not UTF-8. `all` says that no more bytes follow, so that no
    /// character may be incomplete.
    fn check(&mut self, all: bool) -> Result<(), ReadError> {
        self.valid = self.valid.min(self.out.len());
        let new = self.out.get(self.valid..).unwrap_or_default();
        match std::str::from_utf8(new) {
            Ok(_) => self.valid = self.out.len(),
            Err(e) => {
                self.valid += e.valid_up_to();
                if all || e.error_len().is_some() {
                    let place = file_offset(&self.cuts, self.mark, self.valid);
                    let place = Place::Byte(place);
                    return Err(ReadError::malformed("a header in UTF-8", "another byte", place));
                }
            }
        }
        Ok(())
    }

    fn step(&mut self, byte: u8) {
        let start = self.out.len() - 1;
        self.state = match (self.state, byte) {
            // Inside the value of an attribute, `<` is an error, which the parser reports. The bytes after it may
            // be text again.
            (State::Text | State::Tag(_) | State::Quoted(_) | State::Reference(_), b'<') => {
                State::Tag(start)
            }
            (State::Text, b'&') => State::Reference(start),
            (State::Reference(_), b';') => State::Text,
            (State::Reference(from), _) if start - from > REFERENCE => State::Text,
            (State::Tag(_), b'>') => State::Text,
            (State::Tag(_), b'"' | b'\'') => State::Quoted(byte),
            (State::Tag(start), _) => match self.out.get(start..) {
                Some(b"<!--") => State::Until(b"-->"),
                Some(b"<![CDATA[") => State::Until(b"]]>"),
                Some(b"<?") => State::Until(b"?>"),
                _ => State::Tag(start),
            },
            (State::Quoted(quote), _) if byte == quote => State::Tag(start),
            (State::Until(end), b'>') if self.out.ends_with(end) => State::Text,
            (state, _) => state,
        };
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    /// Counting in blocks gives the same lines as counting from the beginning.
    #[test]
    fn lines_are_counted_from_their_block() {
        let text = "<Piece>\n\n".repeat(1 << 20);
        let head = Head::of(text, Vec::new(), 0, None);
        for at in [0, 8, 9, 10, 1023, 1024, 1025, 2047, 2048, 9 << 20] {
            let before = head.text.as_bytes().iter().take(at).filter(|b| **b == b'\n').count();
            assert_eq!(head.line(at), 1 + before as u64, "{at}");
        }
    }
}
