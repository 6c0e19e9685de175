//! Particles as rows of one length, each attribute at its place in them: how BGEO, binary PLY and arrays of NumPy
//! lie in a file. The header says where the rows are; whoever has some of them, all or a part, gets their numbers.

use super::bytes::Cursor;
use super::columns::{Attribute, AttributeType, Column, Data, Shape, Table};
use super::error::ReadError;
use super::{Format, Particles};

/// One attribute of a row.
pub(super) struct Field {
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) ty: AttributeType,
    /// Bytes from the start of the row.
    pub(super) offset: usize,
    /// Else its numbers are passed over, and its column stays empty.
    pub(super) wanted: bool,
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
        Ok(Self { name: name.into(), components, ty, offset, wanted: true })
    }

    fn size(&self) -> usize {
        self.components.saturating_mul(self.ty.size().unwrap_or(0) as usize)
    }
}

/// Where rows are, and what is in them.
pub(super) struct Rows {
    /// What they are called in errors.
    pub(super) what: String,
    /// Bytes of the header.
    pub(super) header: u64,
    /// What lies between it and the rows: what it is, and its bytes.
    pub(super) between: Vec<(String, u64)>,
    pub(super) count: u64,
    /// Bytes of a row.
    pub(super) stride: u64,
    pub(super) big_endian: bool,
    pub(super) fields: Vec<Field>,
}

impl Rows {
    /// Bytes of all of them.
    pub(super) fn bytes(&self) -> u64 {
        self.count.saturating_mul(self.stride)
    }

    pub(super) fn shapes(&self) -> impl Iterator<Item = Shape<'_>> {
        self.fields.iter().map(|field| Shape {
            name: &field.name,
            components: field.components,
            values: self.count.saturating_mul(field.components as u64),
        })
    }

    /// A column for each field, without numbers yet.
    pub(super) fn columns(&self) -> Vec<Column> {
        let column = |field: &Field| Column {
            name: field.name.clone(),
            components: field.components,
            data: Data::for_type(field.ty),
        };
        self.fields.iter().map(column).collect()
    }

    /// Appends the numbers of some rows; `coming`: how many there will be in the columns, these included.
    pub(super) fn decode(&self, raw: &[u8], coming: usize, columns: &mut [Column]) {
        let stride = self.stride as usize;
        for (field, column) in self.fields.iter().zip(columns) {
            let size = field.size();
            if !field.wanted || size == 0 {
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

/// A file that is rows.
pub(super) struct Layout {
    pub(super) rows: Rows,
    /// The first field is the positions, whatever its name.
    pub(super) placed: bool,
    pub(super) attributes: Vec<Attribute>,
    pub(super) format: Format,
}

impl Layout {
    /// All particles of a file that lies in memory.
    pub(super) fn read(self, bytes: &[u8]) -> Result<Particles, ReadError> {
        let rows = &self.rows;
        let mut cursor = Cursor::new(bytes);
        cursor.take(rows.header, "the header")?;
        for (what, length) in &rows.between {
            cursor.take(*length, what)?;
        }
        let raw = cursor.take(rows.bytes(), &rows.what)?;
        let mut columns = rows.columns();
        rows.decode(raw, rows.count as usize, &mut columns);
        let positions = self.placed.then(|| columns.remove(0).data);
        let Self { attributes, format, .. } = self;
        Table { positions, columns, attributes, warnings: Vec::new() }.assemble(format)
    }
}
