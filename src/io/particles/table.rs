//! Reads particles from rows of different lengths in sequence, mostly text: CSV, XYZ, GEO and PLY.

use super::asked::Asked;
use super::blocks;
use super::columns::Column;
use super::error::ReadError;
use super::plan::{About, Plan, Stream, Track};
use super::source::Content;

/// Number of rows for which memory is reserved at a time.
const BATCH: usize = 1 << 10;

/// A file of rows, at the first row.
pub(super) struct Table<'a> {
    /// Columns that may be used, empty.
    pub(super) columns: Vec<Column>,
    pub(super) about: About,
    pub(super) rows: Box<dyn RowReader + 'a>,
}

/// Reads rows.
pub(super) trait RowReader: Send {
    /// Appends the values of the next row to the columns; false at the end.
    fn next(&mut self, columns: &mut [Column]) -> Result<bool, ReadError>;

    /// Warnings after the last row.
    fn told(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// The blocks of the table, before the first row is read; `None` if its format has other frames.
    fn blocks(&self) -> Option<blocks::Rows> {
        None
    }
}

/// Reads the beginning of a file, up to the first row.
type Open = for<'a> fn(&Content<'a>, &Asked) -> Result<Table<'a>, ReadError>;

pub(super) fn plan<'a>(
    content: &Content<'a>,
    open: Open,
    asked: &Asked,
) -> Result<Plan<'a>, ReadError> {
    let Table { columns, about, .. } = open(content, asked)?;
    let (from, asked) = (content.clone(), asked.clone());
    let start = move |used: &[bool]| {
        let stream = TableStream { rows: open(&from, &asked)?.rows, used: used.to_vec() };
        Ok(Box::new(stream) as Box<dyn Stream + 'a>)
    };
    let track = Track { columns, lengths: None, what: "the rows".into(), open: Box::new(start) };
    Plan::new(vec![track], about, content.unpack_limit())
}

struct TableStream<'a> {
    rows: Box<dyn RowReader + 'a>,
    used: Vec<bool>,
}

impl Stream for TableStream<'_> {
    fn read(
        &mut self,
        count: usize,
        columns: &mut [Column],
        _room: &mut Vec<u8>,
    ) -> Result<usize, ReadError> {
        for i in 0..count {
            if i.is_multiple_of(BATCH) {
                let batch = BATCH.min(count - i);
                for column in used(columns, &self.used, true) {
                    let all = count.saturating_mul(column.components);
                    column.data.room(batch * column.components, all);
                }
            }
            if !self.rows.next(columns)? {
                return Ok(i);
            }
            // The values must be numbers even if they have no meaning.
            used(columns, &self.used, false).for_each(|column| column.data.clear());
        }
        Ok(count)
    }

    fn told(&mut self) -> Vec<String> {
        self.rows.told()
    }
}

fn used<'a>(
    columns: &'a mut [Column],
    used: &'a [bool],
    which: bool,
) -> impl Iterator<Item = &'a mut Column> {
    columns.iter_mut().zip(used).filter(move |(_, used)| **used == which).map(|(column, _)| column)
}
