//! Reads single frames of files that hold several.

use std::path::Path;

use super::asked::Asked;
use super::error::ReadError;
use super::format::{self, Extension};
use super::source::{Content, Input, Source};
use super::{
    Particles, bytes, comma, index, json, json_frames, lammps, numpy, parts, read_asked, tecplot,
    xyz,
};

/// A frame of a file that holds several.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Index, from 0.
    pub index: usize,
    /// Time in the file's unit, if the file has it. In a table with a column of times it selects the rows of
    /// the frame.
    pub time: Option<f64>,
    /// Position of the frame in a JSON file.
    pub(super) part: Option<json_frames::Part>,
    /// Position of the frame in another text.
    pub(super) text: Option<Span>,
}

/// Where a frame is in a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) start: u64,
    pub(super) end: u64,
    /// Number of lines before it.
    pub(super) lines: u64,
    /// Length of the whole text.
    length: u64,
    /// Whether the frames may be parts of one instead, see `blocks`.
    pub(super) unsure: bool,
}

impl Step {
    /// Names a frame by its index, from 0. A table with a column of times also needs `time`, which selects the rows.
    /// For JSON and other text, the steps that [`steps`] returns also hold the frame's position in the file; for a step
    /// made with this function, the file is read from its beginning.
    pub fn new(index: usize, time: Option<f64>) -> Self {
        Self { index, time, part: None, text: None }
    }
}

/// Where a frame begins in a text.
#[derive(Clone)]
pub(super) struct Start {
    pub(super) at: u64,
    /// Number of lines before it.
    pub(super) lines: u64,
    pub(super) time: Option<f64>,
}

/// The frames of a file, in the file's order. Frames that a column of times, times of HDF5 groups, or numbers in the
/// names of HDF5 groups or JSON members tell apart are in the order of these instead. The list is empty for a file with
/// one frame. Recognized are XYZ text (each frame begins with a count of particles) and LAMMPS dumps with several
/// frames, tables of text with the time (`# time = 0.1`), the line of names or blank lines between blocks of rows,
/// zones of Tecplot, NumPy arrays of shape (t, n, 3), JSON lists of frames, tables of any format with a column
/// of times or steps, and HDF5 and XDMF with steps. If necessary, the whole file is read for this.
///
/// # Errors
/// Those of [`read`](super::read), for the part that is read.
pub fn steps(path: &Path) -> Result<Vec<Step>, ReadError> {
    if index::Pieces::of(path)?.is_some() {
        return Ok(Vec::new());
    }
    let steps = found(path).map_err(|error| parts::named(path, error))?;
    Ok(if steps.len() < 2 { Vec::new() } else { steps })
}

/// Reads the frame `step` of a file that holds several. `extras` are further attributes to read, as in
/// [`read_with`](super::read_with).
///
/// # Errors
/// Those of [`read`](super::read).
pub fn read_step(path: &Path, step: Step, extras: &[&str]) -> Result<Particles, ReadError> {
    read_asked(path, &Asked::new(extras).of_step(Some(step)))
}

fn found(path: &Path) -> Result<Vec<Step>, ReadError> {
    let of = |times: Vec<Option<f64>>| {
        times.into_iter().enumerate().map(|(index, time)| Step::new(index, time)).collect()
    };
    #[cfg(feature = "hdf5")]
    if let Some(times) = super::hdf5::times(path).or_else(|| super::xdmf::times(path)) {
        return times.map(of);
    }
    let hint = Extension::from_path(path);
    let file = std::fs::File::open(path).map_err(super::source::io_error)?;
    let input = Input::new(file)?;
    let mut start = Vec::new();
    Source::new(&input, &input.whole(false)).fill(2, &mut start)?;
    let gzip = bytes::is_gzip(&start);
    start.clear();
    Source::new(&input, &input.whole(gzip)).fill(1 << 12, &mut start)?;
    let starts = match format::detect(&start, hint) {
        Ok(kind @ (format::Reader::XyzText | format::Reader::Csv)) => {
            let content = Content::new(&input, gzip)?;
            let zones = tecplot::starts(&content)?;
            if !zones.is_empty() {
                return Ok(spans(&content, &zones, false));
            }
            let starts = xyz::starts(&content, None)?;
            let open = if kind == format::Reader::Csv { comma::open } else { xyz::open };
            match starts.is_empty() {
                false => spans(&content, &starts, false),
                true => match open(&content, &Asked::default())?.rows.blocks() {
                    Some(rows) => {
                        let (starts, sure) = rows.starts(&content)?;
                        spans(&content, &starts, !sure)
                    }
                    None => Vec::new(),
                },
            }
        }
        Ok(format::Reader::Lammps) => {
            let content = Content::new(&input, gzip)?;
            spans(&content, &lammps::starts(&content, None)?, false)
        }
        Ok(format::Reader::Json) => return json::steps(&Content::new(&input, gzip)?),
        Ok(kind @ (format::Reader::Npy | format::Reader::Npz)) if !gzip => {
            let times = numpy::times(&input, kind == format::Reader::Npz)?;
            if !times.is_empty() {
                return Ok(of(times));
            }
            Vec::new()
        }
        _ => Vec::new(),
    };
    if starts.len() > 1 {
        return Ok(starts);
    }
    let plan = parts::plan(&input, hint, gzip, &Asked::default())?;
    let times = plan.map_or(Ok(Vec::new()), |plan| plan.times())?;
    Ok(of(times.into_iter().map(Some).collect()))
}

/// The frames of a text, given where they begin.
pub(super) fn spans(content: &Content<'_>, starts: &[Start], unsure: bool) -> Vec<Step> {
    let length = content.length();
    let ends = starts.iter().skip(1).map(|start| start.at).chain([length]);
    let span = |(index, (start, end)): (usize, (&Start, u64))| {
        let text = Some(Span { start: start.at, end, lines: start.lines, length, unsure });
        Step { text, ..Step::new(index, start.time) }
    };
    starts.iter().zip(ends).enumerate().map(span).collect()
}

/// Where a frame is in a text; `None` if that is unknown.
pub(super) fn known_span(content: &Content<'_>, step: Step) -> Option<Span> {
    // A file of another length was written anew.
    step.text.filter(|span| span.length == content.length())
}

/// The part of a text that holds the requested frame, and the frame's time. `None` if none was requested, or if its
/// position is unknown.
pub(super) fn known_part<'a>(
    content: &Content<'a>,
    asked: &Asked,
) -> Result<Option<(Content<'a>, Option<f64>)>, ReadError> {
    let Some(step) = asked.step() else { return Ok(None) };
    let Some(Span { start, end, lines, .. }) = known_span(content, step) else { return Ok(None) };
    Ok(Some((content.part(start, end, lines)?, step.time)))
}

/// The same, with `starts` to find the frames if the position is unknown.
pub(super) fn asked_part<'a>(
    content: &Content<'a>,
    asked: &Asked,
    starts: fn(&Content<'_>, Option<usize>) -> Result<Vec<Start>, ReadError>,
) -> Result<Option<(Content<'a>, Option<f64>)>, ReadError> {
    let Some(step) = asked.step() else { return Ok(None) };
    match known_part(content, asked)? {
        None => part(content, &starts(content, Some(step.index))?, step.index),
        known => Ok(known),
    }
}

/// The part of a text that holds a frame, given where the frames begin.
pub(super) fn part<'a>(
    content: &Content<'a>,
    starts: &[Start],
    index: usize,
) -> Result<Option<(Content<'a>, Option<f64>)>, ReadError> {
    let Some(start) = starts.get(index) else { return Ok(None) };
    let end = starts.get(index + 1).map_or(content.length(), |next| next.at);
    Ok(Some((content.part(start.at, end, start.lines)?, start.time)))
}
