//! Reads particles from rows of equal length with each attribute at a fixed offset, as in BGEO, binary PLY,
//! NumPy arrays, arrays of legacy VTK and raw triples. The header says where the rows are.

use std::sync::Arc;

use super::asked::Asked;
use super::bytes::Cursor;
use super::columns::{Attribute, AttributeType, Column, Roles, Shape, Table};
use super::error::ReadError;
use super::plan::{CHUNK, Stream, Track};
use super::source::{Source, truncated};
use super::{Format, Particles};

/// An attribute in a row.
pub(super) struct Field {
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) ty: AttributeType,
    /// Byte offset in the row.
    pub(super) offset: usize,
}

impl Field {
    pub(super) fn new(
        name: &str,
        components: usize,
        ty: AttributeType,
        offset: u64,
    ) -> Result<Self, ReadError> {
        let offset = usize::try_from(offset).map_err(|_| ReadError::TooLarge {
            what: "a row of attributes".into(),
            limit: usize::MAX as u64,
        })?;
        Ok(Self { name: name.into(), components, ty, offset })
    }

    fn size(&self) -> usize {
        self.components.saturating_mul(self.ty.size().unwrap_or(0) as usize)
    }
}

/// Where the rows are, and what they contain.
pub(super) struct Rows {
    /// Name for messages.
    pub(super) what: String,
    /// Length of the header in bytes.
    pub(super) header: u64,
    /// Data between the header and the rows: name and number of bytes.
    pub(super) between: Vec<(String, u64)>,
    pub(super) count: u64,
    /// Bytes per row.
    pub(super) stride: u64,
    pub(super) big_endian: bool,
    pub(super) fields: Vec<Field>,
}

impl Rows {
    /// Bytes of all rows.
    pub(super) fn bytes(&self) -> u64 {
        self.count.saturating_mul(self.stride)
    }

    /// One empty column per field.
    pub(super) fn columns(&self) -> Vec<Column> {
        self.fields.iter().map(|f| Column::new(&f.name, f.components, f.ty)).collect()
    }

    /// Appends the values of rows to the columns that are used. `coming` is the expected total number of rows,
    /// including these.
    pub(super) fn decode(&self, raw: &[u8], coming: usize, used: &[bool], columns: &mut [Column]) {
        let stride = self.stride as usize;
        for ((field, column), used) in self.fields.iter().zip(columns).zip(used) {
            let size = field.size();
            if !used || size == 0 {
                continue;
            }
            let data = &mut column.data;
            if data.len() == 0 {
                data.reserve(coming.saturating_mul(field.components));
            }
            if size == stride {
                data.push_bytes(field.ty, raw, self.big_endian);
                continue;
            }
            for row in raw.chunks_exact(stride) {
                let values = row.get(field.offset..field.offset + size).unwrap_or_default();
                data.push_bytes(field.ty, values, self.big_endian);
            }
        }
    }
}

/// A track that reads the rows; `open` opens a source at the first row.
pub(super) fn track<'a>(
    rows: Rows,
    open: impl Fn(&Rows) -> Result<Source<'a>, ReadError> + Send + 'a,
) -> Track<'a> {
    let columns = rows.columns();
    let lengths = columns.iter().map(|c| rows.count.saturating_mul(c.components as u64));
    let (lengths, what) = (Some(lengths.collect()), rows.what.clone());
    let rows = Arc::new(rows);
    let open = move |used: &[bool]| {
        let source = open(&rows)?;
        source.require(rows.bytes(), &rows.what)?;
        let stream =
            RowStream { rows: rows.clone(), used: used.to_vec(), first: source.at(), source };
        Ok(Box::new(stream) as Box<dyn Stream + 'a>)
    };
    Track { columns, lengths, what, open: Box::new(open) }
}

/// Reads rows.
struct RowStream<'a> {
    rows: Arc<Rows>,
    used: Vec<bool>,
    source: Source<'a>,
    /// Byte offset of the first row.
    first: u64,
}

impl Stream for RowStream<'_> {
    fn read(
        &mut self,
        count: usize,
        columns: &mut [Column],
        room: &mut Vec<u8>,
    ) -> Result<usize, ReadError> {
        let rows = &*self.rows;
        if !self.used.contains(&true) {
            return Ok(count);
        }
        let stride = rows.stride.max(1);
        // A header that declares more than the file can hold gets no memory for it.
        let most = usize::try_from(self.source.most_left() / stride).unwrap_or(usize::MAX);
        let mut left = count as u64;
        while left > 0 {
            let taken = left.min((CHUNK / stride).max(1));
            let bytes = taken.saturating_mul(stride);
            room.clear();
            self.source.fill(bytes, room)?;
            if (room.len() as u64) < bytes {
                let found = self.source.at() - self.first;
                return Err(truncated(&rows.what, self.first, rows.bytes(), found));
            }
            rows.decode(room, count.min(most), &self.used, columns);
            left -= taken;
        }
        Ok(count)
    }

    fn finish(&mut self) -> Result<u64, ReadError> {
        // An array without a meaning has not been read so far.
        let read = self.source.at() - self.first;
        self.source.skip(self.rows.bytes().saturating_sub(read), &self.rows.what)?;
        self.source.finish()?;
        Ok(self.rows.bytes())
    }
}

/// A file that consists of rows.
pub(super) struct Layout {
    pub(super) rows: Rows,
    /// Whether the first field holds the positions, whatever its name.
    pub(super) placed: bool,
    pub(super) attributes: Vec<Attribute>,
    pub(super) warnings: Vec<String>,
    pub(super) format: Format,
    pub(super) asked: Asked,
}

impl Layout {
    /// All particles of a file in memory.
    pub(super) fn read(self, bytes: &[u8]) -> Result<Particles, ReadError> {
        let rows = &self.rows;
        // Without positions nothing else matters.
        let columns = rows.columns();
        let shapes: Vec<_> = columns
            .iter()
            .map(|c| Shape {
                name: &c.name,
                components: c.components,
                values: rows.count.saturating_mul(c.components as u64),
            })
            .collect();
        Roles::find(&shapes, self.placed.then_some(0), &self.attributes, &self.asked)?;
        let mut cursor = Cursor::new(bytes);
        cursor.take(rows.header, "the header")?;
        for (what, length) in &rows.between {
            cursor.take(*length, what)?;
        }
        let raw = cursor.take(rows.bytes(), &rows.what)?;
        let mut columns = rows.columns();
        let used = vec![true; columns.len()];
        rows.decode(raw, rows.count as usize, &used, &mut columns);
        let positions = self.placed.then(|| columns.remove(0)).map(|c| (c.components, c.data));
        let Self { attributes, warnings, format, asked, .. } = self;
        Table { positions, columns, attributes, warnings, time: None, asked }.assemble(format)
    }
}
