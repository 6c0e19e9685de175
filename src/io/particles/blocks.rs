//! Tells time steps apart that follow one another in a text table without a column of times: blocks of rows with lines
//! between them that are no rows.
//!
//! What separates steps, the surest first; blocks are what the surest separator in the file leaves between:
//! - a line with another time or step (`# time = 0.1`, `# t=0.2`, `# step 3`, also without `#`), or the line of names
//!   again. Blocks with the same time are one step;
//! - two blank lines or more, as between the data sets of gnuplot: if each block has three rows or more, and all
//!   equally many, or about as many as the next one at overlapping places;
//! - a blank line or a comment: if each block has eight rows or more and about as many as the next one, their extents
//!   overlap by half, and none is a curve. This leaves out grids, whose lines end with a blank line: each line is a
//!   curve, and neighbouring ones lie side by side.
//!
//! Comments with other words between the blocks (`# walls`) tell parts of one frame. Other blocks are one frame too; if
//! they might be steps, that is told.

use std::io::Read;

use super::asked::Asked;
use super::bytes::parse_number;
use super::error::ReadError;
use super::heading::{Line, is_comment, number_with_comma, uncommented};
use super::names;
use super::source::{Content, Source};
use super::steps::{self, Start};
use super::text::Text;
use super::xyz;

/// Fewest rows of a block between two blank lines, and between single ones.
const FEW: u64 = 3;
const SOME: u64 = 8;
/// Number of rows of a block from which its extent is found.
const LOOKED_AT: u64 = 1 << 12;
/// Max ratio of the numbers of rows of neighbouring blocks, between two blank lines and between single ones.
const ALIKE: f64 = 1.5;
const NEARLY: f64 = 1.1;
/// Min part of the extents that neighbouring blocks share along each axis.
const SHARED: f64 = 0.5;
/// Blocks that are thinner along an axis, as a part of two of them together, are planes of a grid.
const THICK: f64 = 0.2;
/// A curve is at most this many times as long as its extent; a circle 2.2 times.
const CURVE: f64 = 3.0;
/// Longest part of a line in which a time is looked for.
const LABELLED: usize = 1 << 8;
/// Longest part of a line that is looked at.
const LONGEST: usize = 1 << 12;

/// The time or number of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Label {
    pub(super) time: Option<f64>,
    step: Option<f64>,
}

const TIMES: [&str; 7] =
    ["time", "t", "simtime", "simulationtime", "physicaltime", "solutiontime", "currenttime"];
const STEPS: [&str; 9] =
    ["step", "timestep", "frame", "snapshot", "iteration", "iter", "cycle", "nstep", "tstep"];
/// Words before `time` that make it another one.
const OTHERS: [&str; 9] =
    ["end", "final", "max", "total", "wall", "cpu", "run", "start", "computation"];

impl Label {
    /// The label in a line.
    pub(super) fn of(line: &[u8]) -> Option<Self> {
        let line = line.get(..line.len().min(LABELLED)).unwrap_or(line);
        let text = String::from_utf8_lossy(line);
        let (mut time, mut step) = (None, None);
        let mut rest = text.as_ref();
        let mut before = "";
        while let Some(at) = rest.find(char::is_alphabetic) {
            let apart = !rest.get(..at)?.ends_with(|c: char| c.is_ascii_digit());
            rest = rest.get(at..)?;
            let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
            let word = rest.get(..end)?;
            if let Some((own, value)) = Self::at(rest).filter(|_| apart) {
                if own && !OTHERS.contains(&before.to_ascii_lowercase().as_str()) {
                    time = time.or(Some(value));
                } else if !own {
                    step = step.or(Some(value));
                }
            }
            before = word;
            rest = rest.get(end..)?;
        }
        (time.is_some() || step.is_some()).then_some(Self { time, step })
    }

    /// The label in a line of a table.
    fn in_line(line: &[u8]) -> Option<Self> {
        Self::of(line).or_else(|| Self::alone(line))
    }

    /// The label that is all of a line.
    pub(super) fn alone(line: &[u8]) -> Option<Self> {
        let end = line.iter().position(|b| !b.is_ascii_alphabetic()).unwrap_or(line.len());
        let word = line.get(..end)?;
        let mut known = TIMES.iter().chain(&STEPS);
        known.find(|name| word.eq_ignore_ascii_case(name.as_bytes()))?;
        let text = std::str::from_utf8(line).ok().filter(|_| line.len() < LABELLED)?;
        // In a table a separator may follow each word.
        let text = text.replace([',', ';', '\t', '|'], " ");
        let few = text.split_whitespace().count() < 5;
        Self::at(&text).filter(|_| few)?;
        Self::of(text.as_bytes())
    }

    /// Whether a text begins with a time (otherwise a step), and its value.
    fn at(text: &str) -> Option<(bool, f64)> {
        let end = text.find(|c: char| !(c.is_alphabetic() || c == '_')).unwrap_or(text.len());
        let (word, rest) = text.split_at_checked(end)?;
        let plain = word.replace('_', "").to_ascii_lowercase();
        let is_time = TIMES.contains(&plain.as_str());
        if !is_time && !STEPS.contains(&plain.as_str()) {
            return None;
        }
        let mut rest = rest.trim_start();
        let spaced = rest.len() < text.len() - end;
        // A unit, or what a number is.
        for (open, close) in [('[', ']'), ('(', ')')] {
            if let Some((_, behind)) = rest.strip_prefix(open).and_then(|r| r.split_once(close)) {
                rest = behind.trim_start();
            }
        }
        for word in ["number", "no.", "nr.", "#"] {
            rest = rest.strip_prefix(word).unwrap_or(rest).trim_start();
        }
        let value = rest.trim_start_matches(['=', ':']).trim_start();
        let equals = value.len() < rest.len() && rest.starts_with(['=', ':']);
        let joined = !is_time && value.starts_with(|c: char| c.is_ascii_digit());
        // A `t` may be anything.
        if !(equals || joined || (spaced && plain != "t")) {
            return None;
        }
        let value = value.trim_start_matches(['"', '\'']);
        let end = value.find(|c: char| c.is_whitespace() || ",;\"')]|".contains(c));
        let value = value.get(..end.unwrap_or(value.len()))?;
        // A unit may follow, but not the rest of a date.
        let unit = value.trim_end_matches(|c: char| c.is_alphabetic());
        let number = [value, unit].into_iter().find_map(|v| v.parse::<f64>().ok())?;
        let whole = number.fract() == 0.0 && number >= 0.0;
        (number.is_finite() && (is_time || whole)).then_some((is_time, number))
    }

    /// Whether both are of one step.
    fn same(self, other: Option<Self>) -> bool {
        other.is_some_and(|other| match (self.time, other.time) {
            (Some(a), Some(b)) => a == b,
            _ => self.step == other.step && self.time == other.time,
        })
    }
}

/// Where the first rows of a block are.
#[derive(Debug, Clone, Copy)]
struct Extent {
    low: [f64; 3],
    high: [f64; 3],
    before: Option<[f64; 3]>,
    /// Length of the way from row to row.
    way: f64,
}

impl Extent {
    const NONE: Self =
        Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3], before: None, way: 0.0 };

    fn add(&mut self, place: [f64; 3]) {
        for ((low, high), x) in self.low.iter_mut().zip(&mut self.high).zip(place) {
            (*low, *high) = (low.min(x), high.max(x));
        }
        if let Some(before) = self.before {
            self.way += length(place.iter().zip(before).map(|(a, b)| a - b));
        }
        self.before = Some(place);
    }

    fn is_curve(&self) -> bool {
        self.way <= CURVE * length(self.high.iter().zip(self.low).map(|(high, low)| high - low))
    }

    /// The least part that both share along an axis; below 0 if they are apart.
    fn shared(&self, other: &Self) -> f64 {
        self.part(other, |[a, b], [c, d]| b.min(d) - a.max(c))
    }

    /// The least extent of one of them along an axis, as a part of that of both together.
    fn thick(&self, other: &Self) -> f64 {
        self.part(other, |[a, b], [c, d]| (b - a).min(d - c))
    }

    /// The least part along an axis of what both together extend over; `of` finds it from their ends.
    fn part(&self, other: &Self, of: impl Fn([f64; 2], [f64; 2]) -> f64) -> f64 {
        let ours = self.low.iter().zip(&self.high);
        let all = ours.zip(other.low.iter().zip(&other.high));
        let part = all.map(|((a, b), (c, d))| {
            let whole = b.max(*d) - a.min(*c);
            if whole > 0.0 { of([*a, *b], [*c, *d]) / whole } else { 1.0 }
        });
        part.fold(1.0, f64::min)
    }
}

fn length(parts: impl Iterator<Item = f64>) -> f64 {
    parts.map(|part| part * part).sum::<f64>().sqrt()
}

/// The blocks between separators of one kind or surer ones.
#[derive(Clone)]
struct Level {
    /// Number of blocks, and of rows of the last one.
    blocks: u64,
    rows: u64,
    extent: Extent,
    /// The block before the last one.
    last: Option<(u64, Extent)>,
    fewest: u64,
    equal: bool,
    /// Largest ratio of the numbers of rows of neighbouring blocks, and least part of their extents that they share.
    ratio: f64,
    shared: f64,
    curve: bool,
    /// Least extent of a block along an axis, as a part of that of two neighbouring ones together.
    thick: f64,
    /// The line in which the second block begins.
    second: u64,
    starts: Vec<Start>,
}

impl Level {
    const fn new() -> Self {
        Self {
            blocks: 0,
            rows: 0,
            extent: Extent::NONE,
            last: None,
            fewest: u64::MAX,
            equal: true,
            ratio: 1.0,
            shared: 1.0,
            curve: false,
            thick: 1.0,
            second: 0,
            starts: Vec::new(),
        }
    }

    /// Ends the last block.
    fn close(&mut self) {
        if let Some((rows, extent)) = self.last.replace((self.rows, self.extent)) {
            let ratio = rows as f64 / self.rows.max(1) as f64;
            self.equal &= rows == self.rows;
            self.ratio = self.ratio.max(ratio).max(1.0 / ratio);
            self.shared = self.shared.min(extent.shared(&self.extent));
            self.thick = self.thick.min(extent.thick(&self.extent));
        }
        self.curve |= self.extent.is_curve();
        self.fewest = self.fewest.min(self.rows);
        (self.rows, self.extent) = (0, Extent::NONE);
    }
}

/// Index of the levels: a blank line or a comment, two blank lines, a time or names.
const SINGLE: usize = 0;
const DOUBLE: usize = 1;
const MARKED: usize = 2;

/// What the lines between two rows are.
#[derive(Clone, Default)]
struct Gap {
    /// Whether there are any; byte offset of the first one, and number of lines before it.
    any: bool,
    at: u64,
    lines: u64,
    /// Number of blank lines in sequence: the last ones, and the most.
    blank: u64,
    most: u64,
    label: Option<Label>,
    names: bool,
    /// A comment with other words, without its digits.
    words: Option<Vec<u8>>,
}

/// Follows the rows of a table, and what is between them.
#[derive(Clone)]
pub(super) struct Blocks {
    /// Whether blocks may be steps: the table has no column of times, and it is read as a whole.
    judged: bool,
    /// Whether to remember where blocks begin.
    kept: bool,
    names: Vec<u8>,
    delimiter: Option<u8>,
    /// Columns of the position.
    places: Vec<usize>,
    gap: Gap,
    label: Option<Label>,
    /// Whether the first block has a label, and number of those that separate blocks.
    first: bool,
    labels: u64,
    repeated: bool,
    levels: [Level; 3],
    /// Number of comments with words; the first one without digits; whether others differ from it.
    worded: u64,
    words: Vec<u8>,
    differ: bool,
    /// Whether blocks have one label.
    parts: bool,
}

/// What the blocks of a file are.
pub(super) enum Verdict {
    One,
    /// Steps; whether that is sure.
    Steps(usize, bool),
    /// Blocks that might be steps.
    Parts(u64),
}

impl Blocks {
    /// For the rows from byte offset `at` on, below this line of names; `names` are those of the columns.
    pub(super) fn new(
        lines: &[Line],
        (at, head): (u64, &[u8]),
        names: &[String],
        delimiter: Option<u8>,
    ) -> Self {
        let timed = |name: &String| names::is_time(name) && !names::is_unsure_step(name);
        let places = names.iter().enumerate().filter(|(_, name)| names::is_component(name));
        let is_head = |line: &Line| *uncommented(&line.text).0.trim_ascii() == *head.trim_ascii();
        let before = lines.iter().take_while(|line| line.start < at).filter(|line| !is_head(line));
        let label = before.filter_map(|line| Label::in_line(line.text.trim_ascii())).last();
        Self {
            judged: !names.iter().any(timed),
            kept: false,
            names: head.trim_ascii().to_vec(),
            delimiter,
            places: places.map(|(i, _)| i).take(3).collect(),
            gap: Gap::default(),
            label,
            first: false,
            labels: 0,
            repeated: false,
            levels: [Level::new(), Level::new(), Level::new()],
            worded: 0,
            words: Vec::new(),
            differ: false,
            parts: false,
        }
    }

    /// Whether a line that is no comment is no row either: the names again, or a time.
    pub(super) fn passes(&self, line: &[u8]) -> bool {
        let word = line.first().is_some_and(|b| b.is_ascii_alphabetic() || *b == b'"');
        word && ((!self.names.is_empty() && *line == *self.names) || Label::alone(line).is_some())
    }

    /// Takes the next line, which begins at a byte offset behind this number of lines.
    pub(super) fn line(&mut self, line: &[u8], at: u64, lines: u64) {
        if !self.judged {
            return;
        }
        let line = line.trim_ascii();
        let digit = line.first().is_some_and(|b| b.is_ascii_digit() || b"+-.".contains(b));
        if digit || (!is_comment(line) && !self.passes(line)) {
            self.row(line, at, lines);
            return;
        }
        let gap = &mut self.gap;
        if !gap.any {
            *gap = Gap { any: true, at, lines, ..Gap::default() };
        }
        if line.is_empty() {
            gap.blank += 1;
            gap.most = gap.most.max(gap.blank);
            return;
        }
        gap.blank = 0;
        let (text, _) = uncommented(line);
        if !self.names.is_empty() && *text.trim_ascii_end() == *self.names {
            gap.names = true;
        } else if let Some(label) = Label::in_line(text) {
            gap.label = Some(label);
        } else if text.iter().filter(|b| b.is_ascii_alphabetic()).count() > 1 {
            let text = text.iter().take(LONGEST).copied();
            gap.words = Some(text.filter(|b| !b.is_ascii_digit()).collect());
        }
    }

    fn row(&mut self, line: &[u8], at: u64, lines: u64) {
        let gap = std::mem::take(&mut self.gap);
        let begun = self.levels.first().is_some_and(|level| level.blocks > 0);
        let other = gap.label.filter(|label| !label.same(self.label));
        let again = begun && gap.label.is_some() && other.is_none();
        self.parts |= again;
        self.label = gap.label.or(self.label);
        let separates = if !begun {
            self.first = self.label.is_some();
            Some(MARKED)
        } else if !gap.any {
            None
        } else if other.is_some() || (gap.names && !again) {
            self.labels += u64::from(other.is_some());
            self.repeated |= gap.names;
            Some(MARKED)
        } else {
            Some(if gap.most > 1 { DOUBLE } else { SINGLE })
        };
        if let Some(words) = gap.words.filter(|_| begun) {
            self.differ |= self.worded > 0 && self.words != words;
            self.worded += 1;
            self.words = words;
        }
        let place = self.place(line);
        let (at, lines) = if gap.any { (gap.at, gap.lines) } else { (at, lines) };
        let time = self.label.and_then(|label| label.time);
        for (i, level) in self.levels.iter_mut().enumerate() {
            if separates.is_some_and(|separates| separates >= i) {
                if level.blocks > 0 {
                    level.close();
                }
                level.blocks += 1;
                if level.blocks == 2 {
                    level.second = lines + 1;
                }
                // Many short blocks are no steps, except between times.
                if self.kept && (i == MARKED || level.fewest >= FEW) {
                    level.starts.push(Start { at, lines, time });
                } else {
                    level.starts = Vec::new();
                }
            }
            level.rows += 1;
            if let Some(place) = place.filter(|_| level.rows <= LOOKED_AT) {
                level.extent.add(place);
            }
        }
    }

    /// The position in a row, while it is needed.
    fn place(&self, line: &[u8]) -> Option<[f64; 3]> {
        self.levels.first().filter(|level| level.rows < LOOKED_AT)?;
        let mut place = [0.0; 3];
        let number = |word: &[u8]| parse_number(word).or_else(|| number_with_comma(word));
        let mut set = |i: usize, word: &[u8]| {
            let at = self.places.iter().position(|place| *place == i);
            let Some(to) = at.and_then(|at| place.get_mut(at)) else { return Some(()) };
            *to = number(word.trim_ascii()).filter(|x| x.is_finite())?;
            Some(())
        };
        match self.delimiter {
            Some(d) => line.split(|b| *b == d).enumerate().try_for_each(|(i, w)| set(i, w))?,
            None => xyz::values(line, false).enumerate().try_for_each(|(i, w)| set(i, w))?,
        }
        Some(place)
    }

    /// What the blocks are; called after the last line.
    pub(super) fn verdict(&mut self) -> Verdict {
        self.levels.iter_mut().filter(|level| level.rows > 0).for_each(Level::close);
        let [single, double, marked] = &self.levels;
        if !self.judged {
            return Verdict::One;
        }
        if marked.blocks > 1 {
            // Times may also follow their blocks.
            let behind = !self.first && self.gap.label.is_some();
            let sure = self.first || behind || self.labels > 1 || self.repeated;
            let alike = marked.fewest >= FEW && marked.ratio <= ALIKE;
            return match sure || alike {
                true => Verdict::Steps(MARKED, true),
                false => Verdict::Parts(marked.blocks),
            };
        }
        if self.parts {
            return Verdict::One;
        }
        let remarks = self.worded == 1 || self.differ;
        if double.blocks > 1 {
            let alike = double.equal || (double.ratio <= ALIKE && double.shared > 0.0);
            return match double.fewest >= FEW && alike && !remarks {
                true => Verdict::Steps(DOUBLE, false),
                false => Verdict::Parts(double.blocks),
            };
        }
        let several = single.blocks > 1 && single.fewest >= FEW;
        if !several || self.places.is_empty() {
            return Verdict::One;
        }
        let alike = single.fewest >= SOME && single.ratio <= NEARLY;
        match single.shared >= SHARED {
            true if alike && !single.curve && self.worded == 0 => Verdict::Steps(SINGLE, false),
            // Blocks beside each other may be water that moves far, but lines and planes of a grid are thin.
            false if single.curve || single.thick < THICK => Verdict::One,
            _ => Verdict::Parts(single.blocks),
        }
    }

    /// Warnings of a table that was read to its end.
    ///
    /// # Errors
    /// The blocks are steps.
    pub(super) fn told(&mut self) -> Result<Option<String>, ReadError> {
        match self.verdict() {
            Verdict::One => Ok(None),
            Verdict::Steps(level, sure) => {
                let second = self.levels.get(level).map_or(0, |level| level.second);
                if sure {
                    return Err(xyz::several_frames(second));
                }
                Err(ReadError::Unsupported {
                    what: format!(
                        "a file of several frames (blocks of rows with blank lines or comments between them, the \
                         second from line {second} on)"
                    ),
                    advice: "write one file per frame, with the frame's number in its name; if the blocks are parts \
                             of one frame, delete the lines between them",
                })
            }
            Verdict::Parts(blocks) => Ok(Some(format!(
                "{blocks} blocks of rows with blank lines or comments between them are taken as one frame; if they are \
                 time steps, write the time above each block (# time = 0.1) or into a column `time`"
            ))),
        }
    }

    /// Where the steps begin.
    fn into_starts(mut self) -> (Vec<Start>, bool) {
        let Verdict::Steps(level, sure) = self.verdict() else { return (Vec::new(), true) };
        let behind = self.gap.label.filter(|_| level == MARKED && !self.first);
        let mut starts = std::mem::take(
            self.levels.get_mut(level).map_or(&mut Vec::new(), |level| &mut level.starts),
        );
        if let Some(last) = behind {
            let mut times: Vec<_> = starts.iter().skip(1).map(|start| start.time).collect();
            times.push(last.time);
            starts.iter_mut().zip(times).for_each(|(start, time)| start.time = time);
        }
        (starts, sure)
    }
}

/// The blocks of a table, and where its first row is: byte offset and number of lines before.
#[derive(Clone)]
pub(super) struct Rows {
    pub(super) blocks: Blocks,
    pub(super) at: u64,
    pub(super) lines: u64,
}

/// The rows of a table that are read.
pub(super) struct Part {
    pub(super) blocks: Blocks,
    /// Byte range, and number of lines before.
    pub(super) from: u64,
    pub(super) to: u64,
    pub(super) lines: u64,
    pub(super) time: Option<f64>,
    /// A warning if it is not sure that this is a step.
    pub(super) told: Option<String>,
}

impl Rows {
    /// Where the steps begin, and whether that is sure; empty if the file has none, or a column of times.
    pub(super) fn starts(self, content: &Content<'_>) -> Result<(Vec<Start>, bool), ReadError> {
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
    pub(super) fn part(self, content: &Content<'_>, asked: &Asked) -> Result<Part, ReadError> {
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
        if self.open || !is_comment(line) {
            let quotes = line.iter().filter(|b| **b == b'"').count();
            self.open ^= !quotes.is_multiple_of(2);
        }
        begins
    }
}

/// Shows the blocks each line that is read.
pub(super) struct Watched<'a> {
    source: Source<'a>,
    pub(super) blocks: Blocks,
    quotes: Quotes,
    /// The beginning of the current line.
    line: Vec<u8>,
    lines: u64,
}

impl<'a> Watched<'a> {
    /// `lines` lines of the file precede the source.
    pub(super) fn new(source: Source<'a>, blocks: Blocks, lines: u64) -> Self {
        Self { source, blocks, quotes: Quotes::default(), line: Vec::new(), lines }
    }

    fn add(&mut self, some: &[u8]) {
        let room = LONGEST.saturating_sub(self.line.len());
        self.line.extend(some.iter().take(room));
    }

    fn end(&mut self) {
        if self.quotes.begins(&self.line) {
            self.blocks.line(&self.line, 0, self.lines);
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
        while let Some(end) = rest.iter().position(|b| *b == b'\n') {
            let (line, behind) = rest.split_at_checked(end).unwrap_or_default();
            self.add(line);
            self.end();
            rest = behind.get(1..).unwrap_or_default();
        }
        self.add(rest);
        if count == 0 && !out.is_empty() && !self.line.is_empty() {
            self.end();
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_steps_are_labels() {
        let of = |line: &str| Label::of(line.as_bytes()).map(|label| (label.time, label.step));
        for (line, time) in [
            ("time = 0.1", 0.1),
            ("t=0.2", 0.2),
            ("T: 0.5", 0.5),
            ("Time 3", 3.0),
            ("time [s] = 0.25, 12 particles", 0.25),
            ("Simulation time: 1e-3 s", 1e-3),
            ("time=0.1s", 0.1),
            ("sim_time 2", 2.0),
        ] {
            assert_eq!(of(line), Some((Some(time), None)), "{line}");
        }
        for (line, step) in [
            ("step 3", 3.0),
            ("Timestep: 100", 100.0),
            ("time step 7", 7.0),
            ("frame_0003", 3.0),
            ("frame0012", 12.0),
            ("iteration no. 5", 5.0),
            ("snapshot #4", 4.0),
        ] {
            assert_eq!(of(line), Some((None, Some(step))), "{line}");
        }
        assert_eq!(of("step 3, t = 0.3"), Some((Some(0.3), Some(3.0))));
        for line in [
            "dt = 0.1",
            "time step = 0.001",
            "t 0.1",
            "end time = 5",
            "Time: 2024-05-01 12:00",
            "time 10:30:00",
            "walls",
            "x y z t",
            "steps",
            "",
        ] {
            assert_eq!(of(line), None, "{line}");
        }
    }
}
