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

mod label;
mod level;
mod rows;

use super::bytes::parse_number;
use super::error::ReadError;
use super::heading::{Line, is_comment, number_with_comma, uncommented};
use super::names;
use super::steps::Start;
use super::xyz;
use level::Level;

pub(super) use label::Label;
pub(super) use rows::{Rows, Watched};

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
/// Longest part of a line that is looked at.
const LONGEST: usize = 1 << 12;

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
