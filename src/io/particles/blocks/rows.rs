//! Reads the rows of one step, and shows the blocks each line that is read.

use std::io::Read;

use super::super::asked::Asked;
use super::super::error::ReadError;
use super::super::heading::is_comment;
use super::super::source::{Content, Source};
use super::super::steps::{self, Start};
use super::super::text::Text;
use super::{Blocks, LONGEST};

/// The blocks of a table, and where its first row is: byte offset and number of lines before.
#[derive(Clone)]
pub(in super::super) struct Rows {
    pub(in super::super) blocks: Blocks,
    pub(in super::super) at: u64,
    pub(in super::super) lines: u64,
}

/// The rows of a table that are read.
pub(in super::super) struct Part {
    pub(in super::super) blocks: Blocks,
    /// Byte range, and number of lines before.
    pub(in super::super) from: u64,
    pub(in super::super) to: u64,
    pub(in super::super) lines: u64,
    pub(in super::super) time: Option<f64>,
    /// A warning if it is not sure that this is a step.
    pub(in super::super) told: Option<String>,
}

impl Rows {
    /// Where the steps begin, and whether that is sure; empty if the file has none, or a column of times.
    pub(in super::super) fn starts(
        self,
        content: &Content<'_>,
    ) -> Result<(Vec<Start>, bool), ReadError> {
        let Self { mut blocks, at, lines } = self;
        if !blocks.judged {
            return Ok((Vec::new(), true));
        }
        blocks.kept = true;
        let mut text = Text::new(content.open(at, content.length())?);
        let (mut number, mut quotes) = (content.lines_before() + lines, Quotes::default());
        loop {
            let own = text.at();
            let Some(line) = text.line()? else { break };
            if blocks.delimiter.is_none() || quotes.begins(line) {
                blocks.line(line, own, number);
            }
            number += 1;
        }
        Ok(blocks.into_starts())
    }

    /// The rows that were asked for.
    pub(in super::super) fn part(
        self,
        content: &Content<'_>,
        asked: &Asked,
    ) -> Result<Part, ReadError> {
        let Self { blocks, at, lines } = self;
        let (to, lines) = (content.length(), content.lines_before() + lines);
        let all = |blocks| Part { blocks, from: at, to, lines, time: None, told: None };
        let Some(step) = asked.step().filter(|_| blocks.judged) else { return Ok(all(blocks)) };
        let known = steps::known_span(content, step).map(|span| (span, step.time));
        let found = match known {
            Some(known) => Some(known),
            None => {
                let rows = Self { blocks: blocks.clone(), at, lines };
                let (starts, sure) = rows.starts(content)?;
                let steps = steps::spans(content, &starts, !sure);
                steps.get(step.index).and_then(|step| Some((step.text?, step.time)))
            }
        };
        let Some((span, time)) = found else { return Ok(all(blocks)) };
        let lines = if span.start > at { span.lines } else { lines };
        let told = span.unsure.then(|| {
            "blocks of rows with blank lines or comments between them are taken as time steps; if they are parts of \
             one frame, delete the lines between them, and if not, write the time above each block (# time = 0.1)"
                .into()
        });
        let blocks = Blocks { judged: false, ..blocks };
        Ok(Part { blocks, from: span.start.max(at), to: span.end, lines, time, told })
    }
}

/// Follows quoted fields that go over several lines.
#[derive(Default)]
struct Quotes {
    open: bool,
}

impl Quotes {
    /// Whether a line begins a record.
    fn begins(&mut self, line: &[u8]) -> bool {
        let begins = !self.open;
        let quotes = line.iter().filter(|b| **b == b'"').count();
        // Quotes in comments do not count.
        if !quotes.is_multiple_of(2) && (self.open || !is_comment(line)) {
            self.open ^= true;
        }
        begins
    }
}

/// Shows the blocks each line that is read.
pub(in super::super) struct Watched<'a> {
    source: Source<'a>,
    pub(in super::super) blocks: Blocks,
    quotes: Quotes,
    /// The beginning of the current line.
    line: Vec<u8>,
    lines: u64,
}

impl<'a> Watched<'a> {
    /// `lines` lines of the file precede the source.
    pub(in super::super) fn new(source: Source<'a>, blocks: Blocks, lines: u64) -> Self {
        Self { source, blocks, quotes: Quotes::default(), line: Vec::new(), lines }
    }

    fn add(&mut self, some: &[u8]) {
        let room = LONGEST.saturating_sub(self.line.len());
        self.line.extend_from_slice(some.get(..room).unwrap_or(some));
    }

    /// Ends a line with these bytes behind those that were added.
    fn end(&mut self, some: &[u8]) {
        if !self.line.is_empty() {
            self.add(some);
        }
        let line = if self.line.is_empty() { some } else { &self.line };
        if self.quotes.begins(line) {
            self.blocks.line(line, 0, self.lines);
        }
        self.line.clear();
        self.lines += 1;
    }
}

impl Read for Watched<'_> {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        let count = self.source.read(out)?;
        if !self.blocks.judged {
            return Ok(count);
        }
        let mut rest = out.get(..count).unwrap_or_default();
        while let Some(end) = memchr::memchr(b'\n', rest) {
            let (line, behind) = rest.split_at_checked(end).unwrap_or_default();
            self.end(line);
            rest = behind.get(1..).unwrap_or_default();
        }
        self.add(rest);
        if count == 0 && !out.is_empty() && !self.line.is_empty() {
            self.end(&[]);
        }
        Ok(count)
    }
}
