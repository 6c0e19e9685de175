//! Reads attributes that a file stores one after the other, as in legacy VTK (text) and VTK XML. In VTK XML,
//! each piece of the file has one segment of each attribute. Each attribute is read with a file position of its
//! own.

use std::sync::Arc;

use super::columns::{AttributeType, Column};
use super::encoded::{Encoded, Encoding};
use super::error::{Place, ReadError};
use super::plan::{CHUNK, Stream, Track, changed};
use super::source::{Content, Source};
use super::text::Text;

/// The part of an attribute's values that lies in one piece of the file.
#[derive(Clone)]
pub(super) struct Segment<'a> {
    /// Where the values are stored, and the byte range that may hold them (and values of other attributes).
    pub(super) content: Content<'a>,
    pub(super) start: u64,
    pub(super) end: u64,
    /// Number of values: components times particles.
    pub(super) count: u64,
    pub(super) ty: AttributeType,
    pub(super) stored: Stored,
}

/// How numbers are stored.
#[derive(Clone, Copy)]
pub(super) enum Stored {
    /// Text; other values may follow the last one.
    Words,
    /// Text of an XML element that has no other values than this segment's. Its byte offset and its line are for
    /// error messages.
    OwnWords(u64, Place),
    /// Binary, with the byte offset at which errors are reported.
    Bytes(Encoding, u64),
}

/// An attribute with all its segments, in the order of the particles.
#[derive(Clone)]
pub(super) struct Array<'a> {
    /// Name for error messages.
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) segments: Vec<Segment<'a>>,
}

/// Makes the [`Track`] of an attribute, which reads its values. `column` has the name and type that hold for
/// all segments.
pub(super) fn track<'a>(column: Column, array: Array<'a>) -> Track<'a> {
    let length = array.segments.iter().fold(0_u64, |sum, s| sum.saturating_add(s.count));
    let what = array.name.clone();
    let array = Arc::new(array);
    let open = move |used: &[bool]| {
        let (array, used) = (array.clone(), used.contains(&true));
        let stream = ArrayStream { array, used, next: 0, current: None, spare: Spare::default() };
        Ok(Box::new(stream) as Box<dyn Stream + 'a>)
    };
    Track { columns: vec![column], lengths: Some(vec![length]), what, open: Box::new(open) }
}

/// Number of values that [`first`] returns at most.
const ASKED: usize = 1 << 10;

/// The first values of a segment; `None` if they cannot be read.
pub(super) fn first(segment: Segment<'_>, ty: AttributeType) -> Option<Vec<f64>> {
    ty.size()?;
    let count = usize::try_from(segment.count).unwrap_or(usize::MAX).min(ASKED);
    let mut columns = [Column::new("", 1, ty)];
    let array = Array { name: String::new(), components: 1, segments: vec![segment] };
    let [column] = &columns;
    let track = track(column.clone(), array);
    let mut stream = (track.open)(&[true]).ok()?;
    stream.read(count, &mut columns, &mut Vec::new()).ok()?;
    let [column] = &columns;
    (0..column.data.len()).map(|i| column.data.f64(i)).collect()
}

/// Sources that were opened for an earlier segment and can be read on for the next one. A compressed file can
/// only be read forwards, so opening it anew would mean to decompress it from the start.
#[derive(Default)]
pub(super) struct Spare<'a> {
    pub(super) data: Option<Source<'a>>,
    pub(super) sizes: Option<Source<'a>>,
}

/// Reads an attribute segment by segment.
struct ArrayStream<'a> {
    array: Arc<Array<'a>>,
    used: bool,
    /// Index of the next segment.
    next: usize,
    current: Option<Current<'a>>,
    spare: Spare<'a>,
}

/// The segment that is being read.
struct Current<'a> {
    numbers: Numbers<'a>,
    /// Number of values not read yet.
    left: u64,
}

enum Numbers<'a> {
    Words(Text<'a>),
    Bytes(Encoded<'a>),
}

impl Stream for ArrayStream<'_> {
    fn read(
        &mut self,
        count: usize,
        columns: &mut [Column],
        room: &mut Vec<u8>,
    ) -> Result<usize, ReadError> {
        let Some(column) = columns.first_mut().filter(|_| self.used) else { return Ok(count) };
        let all = count.saturating_mul(self.array.components);
        let mut left = all as u64;
        while left > 0 {
            let read = self.some(left, all, column, room)?;
            if read == 0 {
                return Err(changed());
            }
            left -= read;
        }
        Ok(count)
    }

    fn finish(&mut self) -> Result<u64, ReadError> {
        // An attribute without a meaning has not been read so far: check its text now.
        let mut room = Vec::new();
        while !self.used && self.next < self.array.segments.len() {
            let ty = self.array.segments.get(self.next).map_or(AttributeType::F32, |s| s.ty);
            let mut column = Column::new(&self.array.name, self.array.components, ty);
            loop {
                self.some(u64::MAX, CHUNK as usize, &mut column, &mut room)?;
                column.data.clear();
                if self.current.is_none() {
                    break;
                }
            }
        }
        Ok(0)
    }
}

impl<'a> ArrayStream<'a> {
    /// Appends up to `left` of the next values to `column` and returns how many it appended. `all` is the total that
    /// the column will hold.
    fn some(
        &mut self,
        left: u64,
        all: usize,
        column: &mut Column,
        room: &mut Vec<u8>,
    ) -> Result<u64, ReadError> {
        let array = self.array.clone();
        let mut current = match self.current.take() {
            Some(current) => current,
            None => {
                let Some(segment) = array.segments.get(self.next) else { return Ok(0) };
                self.next += 1;
                self.open(segment, &array.name)?
            }
        };
        let Some(segment) = array.segments.get(self.next - 1) else { return Ok(0) };
        let size = segment.ty.size().unwrap_or(1);
        let count = left.min(current.left).min(CHUNK / size);
        column.data.room(count as usize, all);
        match &mut current.numbers {
            Numbers::Words(text) => text
                .numbers(count, current.left, &array.name, &mut column.data)
                .map_err(|error| segment.relocated(error))?,
            Numbers::Bytes(encoded) => {
                room.clear();
                encoded.fill(count * size, room)?;
                column.data.push_bytes(segment.ty, room, encoded.big_endian());
            }
        }
        current.left -= count;
        if current.left == 0 {
            self.close(segment, current)?;
        } else {
            self.current = Some(current);
        }
        Ok(count)
    }

    fn open(&mut self, segment: &Segment<'a>, name: &str) -> Result<Current<'a>, ReadError> {
        let numbers = match &segment.stored {
            Stored::Words | Stored::OwnWords(..) => {
                let spare = self.spare.data.take();
                Numbers::Words(Text::new(segment.content.reach(
                    spare,
                    segment.start,
                    segment.end,
                )?))
            }
            Stored::Bytes(encoding, offset) => {
                Numbers::Bytes(Encoded::open(segment, *encoding, *offset, name, &mut self.spare)?)
            }
        };
        Ok(Current { numbers, left: segment.count })
    }

    /// Called after the last value of a segment. If an XML element holds only this segment, checks that no more values
    /// follow. Keeps a compressed source for the next segment, which then need not be decompressed from the start.
    fn close(&mut self, segment: &Segment<'a>, current: Current<'a>) -> Result<(), ReadError> {
        match current.numbers {
            Numbers::Words(mut text) => {
                let mut more = 0;
                while matches!(segment.stored, Stored::OwnWords(..)) && text.token()?.is_some() {
                    more += 1;
                }
                if more > 0 {
                    return Err(ReadError::Length {
                        attribute: self.array.name.clone(),
                        expected: segment.count,
                        found: segment.count + more,
                    });
                }
                self.spare.data = segment.content.spare(text.into_source());
            }
            Numbers::Bytes(encoded) => self.spare = encoded.into_spare(&segment.content),
        }
        Ok(())
    }
}

impl Segment<'_> {
    /// Moves an error in an element's text to the place of the element.
    fn relocated(&self, error: ReadError) -> ReadError {
        match (error, &self.stored) {
            (ReadError::Malformed { expected, found, .. }, Stored::OwnWords(_, place)) => {
                ReadError::Malformed { expected, found, place: *place }
            }
            (ReadError::Truncated { what, needed, found, .. }, Stored::OwnWords(offset, _)) => {
                ReadError::Truncated { what, offset: *offset, needed, found }
            }
            (error, _) => error,
        }
    }
}
