//! Values that VTK files store per cell instead of per point.
//!
//! Particles are often written as cells of one point each (vertices), with their values on the cells: by meshio, by
//! ParaView after a filter, by several SPH codes. If each point has exactly one such cell, cell `i` is a particle, and
//! its values are those of the point that it names, which need not be point `i`. Values of any other cells belong to no
//! particle; they are not read, and a warning says so.

use std::ops::Range;
use std::sync::Arc;

use super::columns::{Attribute, Column, Data};
use super::error::ReadError;
use super::names;
use super::plan::{Stream, Track, changed};

/// Number of integers read at a time.
const SOME: u64 = 1 << 12;
/// Max number of names in a warning.
const NAMED: usize = 12;

/// How the numbers of points per cell are stored.
pub(super) enum Ends<'a> {
    /// In the list of points itself, before the points of each cell.
    Inside,
    /// As a list of running sums of the numbers, and the expected first sum: 1, or 0 if a 0 precedes the sums, so
    /// that the list has one value more than there are cells.
    Sums(Track<'a>, u64),
}

/// The lists that say which points each cell has.
pub(super) struct Lists<'a> {
    pub(super) cells: u64,
    pub(super) ends: Ends<'a>,
    pub(super) points: Track<'a>,
    /// Number of values in the list of points.
    pub(super) length: u64,
}

impl Lists<'_> {
    /// The points of vertices and those of all other cells, if the lists can be read. `vertex` says which cells are
    /// vertices.
    pub(super) fn split(&self, vertex: impl Fn(usize) -> bool) -> Option<(Vec<u32>, Vec<u32>)> {
        let all = integers(&self.points, self.length)?;
        let sums = match &self.ends {
            Ends::Inside => None,
            Ends::Sums(track, first) => {
                let sums = integers(track, self.cells.saturating_add(1 - first.min(&1)))?;
                Some(sums.get(usize::from(*first == 0)..)?.to_vec())
            }
        };
        let (mut vertices, mut others) = (Vec::new(), Vec::new());
        let mut at = 0_usize;
        for cell in 0..usize::try_from(self.cells).ok()? {
            let end = match &sums {
                Some(sums) => *sums.get(cell)? as usize,
                None => {
                    let size = *all.get(at)? as usize;
                    at += 1;
                    at.checked_add(size)?
                }
            };
            let list = if vertex(cell) { &mut vertices } else { &mut others };
            list.extend_from_slice(all.get(at..end)?);
            at = end;
        }
        Some((vertices, others))
    }
}

/// The cells of a file, piece by piece, and the point of each.
#[derive(Clone, Default)]
pub(super) struct Cells {
    /// Number of points in all pieces added so far. It is also the number of their cells, because each point has one
    /// cell.
    count: u64,
    /// Index of the point of each cell; `None` as long as every cell i has point i.
    order: Option<Vec<u32>>,
    /// Why the cells are no particles.
    why: Option<String>,
}

impl Cells {
    /// Adds a piece of `points` points whose cells have no values.
    pub(super) fn skip(&mut self, points: u64) {
        let count = self.count.saturating_add(points);
        if let (Some(order), Ok(all)) = (&mut self.order, u32::try_from(count)) {
            order.extend(self.count as u32..all);
        }
        self.count = count;
    }

    /// Says that the cells are no particles. The first reason is kept.
    pub(super) fn refuse(&mut self, why: String) {
        self.why.get_or_insert(why);
    }

    pub(super) fn are_refused(&self) -> bool {
        self.why.is_some()
    }

    /// Refuses the cells if their number is not that of the points.
    pub(super) fn compare(&mut self, cells: u64, points: u64) {
        if cells != points {
            self.refuse(format!("there are {cells} cells for {points} points"));
        }
    }

    /// Adds a piece of `points` points. All of its lists are read.
    pub(super) fn add(&mut self, points: u64, lists: &Lists<'_>) {
        self.compare(lists.cells, points);
        let found = match self.why {
            None => self.read(points, lists),
            Some(_) => return,
        };
        match found {
            Ok(()) => self.count = self.count.saturating_add(points),
            Err(why) => self.refuse(why),
        }
    }

    fn read(&mut self, points: u64, lists: &Lists<'_>) -> Result<(), String> {
        let sized = |cell: u64, size: f64| match size {
            1.0 => Ok(()),
            _ => Err(format!("cell {cell} has {size} points instead of one")),
        };
        let inside = matches!(lists.ends, Ends::Inside);
        if let Ends::Sums(track, first) = &lists.ends {
            let count = lists.cells.saturating_add(1 - first.min(&1));
            let mut before = if *first == 0 { -1.0 } else { 0.0 };
            each(track, count, |i, sum| {
                let size = sum - before;
                before = sum;
                sized((i + first).saturating_sub(1), size)
            })?;
        }
        let values = if inside { 2 } else { 1 };
        let expected = points.saturating_mul(values);
        if lists.length != expected {
            return Err(format!("their list has {} values instead of {expected}", lists.length));
        }
        each(&lists.points, expected, |i, value| {
            if inside && i.is_multiple_of(2) {
                return sized(i / 2, value);
            }
            self.point(i / values, value, points)
        })
    }

    /// Adds a piece of `points` points whose cells have one point each. `list` holds the point of each cell;
    /// `None` means that every cell i has point i.
    #[cfg(feature = "hdf5")]
    pub(super) fn add_list(&mut self, points: u64, list: Option<&Data>) {
        let Some(list) = list else { return self.skip(points) };
        self.compare(list.len() as u64, points);
        for cell in 0..list.len() {
            if self.why.is_some() {
                return;
            }
            let value = list.f64(cell).unwrap_or(f64::NAN);
            if let Err(why) = self.point(cell as u64, value, points) {
                self.refuse(why);
            }
        }
        self.count = self.count.saturating_add(points);
    }

    fn point(&mut self, cell: u64, value: f64, points: u64) -> Result<(), String> {
        if value.fract() != 0.0 || !(0.0..points as f64).contains(&value) {
            return Err(format!("cell {cell} has point {value}, of {points}"));
        }
        self.push(cell, value as u64)
    }

    /// Adds the next cell of a piece and its point.
    fn push(&mut self, cell: u64, point: u64) -> Result<(), String> {
        if self.order.is_none() && cell == point {
            return Ok(());
        }
        let (cell, point) = (self.count.saturating_add(cell), self.count.saturating_add(point));
        let many = |_| "there are more than can be put in another order".to_string();
        let (cell, point) =
            (u32::try_from(cell).map_err(many)?, u32::try_from(point).map_err(many)?);
        self.order.get_or_insert_with(|| (0..cell).collect()).push(point);
        Ok(())
    }

    /// For each point the index of its only cell; `None` if every point i has cell i. The error says why the cells
    /// cannot be taken as particles.
    pub(super) fn finish(self) -> Result<Option<Arc<[u32]>>, String> {
        if let Some(why) = self.why {
            return Err(why);
        }
        let Some(order) = self.order else { return Ok(None) };
        let mut of_points = vec![None; order.len()];
        for (cell, point) in order.into_iter().enumerate() {
            match of_points.get_mut(point as usize) {
                Some(free @ None) => *free = Some(cell as u32),
                _ => return Err(format!("point {point} has several cells")),
            }
        }
        Ok(of_points.into_iter().collect::<Option<Vec<u32>>>().map(Arc::from))
    }
}

/// Which points of a grid are particles. In a file that holds particles and a mesh, such as ParaView's Append Datasets
/// writes, particles are the points that vertices (cells of one point) name; the mesh has the other points.
#[derive(Clone, Default)]
pub(super) struct Vertices {
    /// Number of points of all pieces so far.
    points: u64,
    /// Points of vertices, and of pieces without cells.
    kept: Vec<Range<u64>>,
    /// Whether any piece has vertices.
    any: bool,
}

impl Vertices {
    /// Adds a piece of `points` points without cells, or with a vertex for each point.
    pub(super) fn all(&mut self, points: u64, vertices: bool) {
        self.keep(self.points..self.points.saturating_add(points));
        self.points = self.points.saturating_add(points);
        self.any |= vertices;
    }

    /// Adds a piece of `points` points that only a mesh has.
    pub(super) fn none(&mut self, points: u64) {
        self.points = self.points.saturating_add(points);
    }

    /// Adds a piece of `points` points, given those of its vertices and those of its other cells.
    pub(super) fn some(&mut self, points: u64, mut vertices: Vec<u32>, mut others: Vec<u32>) {
        for list in [&mut vertices, &mut others] {
            list.sort_unstable();
            list.dedup();
        }
        if vertices.len() as u64 == points {
            return self.all(points, true);
        }
        // meshio needs a cell to write points alone, so that one of them is named.
        if vertices.len() < 2 && others.is_empty() {
            return self.all(points, false);
        }
        // Gmsh marks corners of a mesh by vertices.
        if vertices.iter().all(|point| others.binary_search(point).is_ok()) {
            return self.none(points);
        }
        self.any = true;
        for point in vertices {
            let point = self.points.saturating_add(u64::from(point));
            self.keep(point..point.saturating_add(1));
        }
        self.none(points);
    }

    fn keep(&mut self, range: Range<u64>) {
        match self.kept.last_mut() {
            Some(last) if last.end == range.start => last.end = range.end,
            _ => self.kept.push(range),
        }
    }

    /// The particles, and a warning about the points that are none; `None` if all are.
    pub(super) fn finish(self) -> Option<(Arc<[Range<u64>]>, String)> {
        let kept = count(&self.kept);
        (self.any && kept < self.points).then(|| {
            let told = format!(
                "{} of {} points are left out: they belong to polygons, other cells or none, where particles have \
                 vertices (cells of one point)",
                self.points - kept,
                self.points
            );
            (Arc::from(self.kept), told)
        })
    }
}

/// Number of points in ranges.
fn count(ranges: &[Range<u64>]) -> u64 {
    ranges.iter().fold(0, |sum, range| sum.saturating_add(range.end - range.start))
}

/// The values of a list of integers.
pub(super) fn integers(track: &Track<'_>, count: u64) -> Option<Vec<u32>> {
    let mut values = Vec::new();
    let integer = |_, value: f64| {
        let whole = value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value);
        values.push(if whole { value as u32 } else { return Err(String::new()) });
        Ok(())
    };
    each(track, count, integer).ok()?;
    Some(values)
}

/// The values of a track (values in a file) in some rows only.
pub(super) fn kept<'a>(track: Track<'a>, rows: Arc<[Range<u64>]>, all: u64) -> Track<'a> {
    let out = all.saturating_sub(count(&rows));
    let left = |(length, column): (&u64, &Column)| {
        length.saturating_sub(out.saturating_mul(column.components as u64))
    };
    let lengths = track.lengths.as_ref();
    let lengths = lengths.map(|all| all.iter().zip(&track.columns).map(left).collect());
    over(Track { lengths, ..track }, move |inner, used, passed| {
        let rows = rows.clone();
        Kept { inner, used, passed, rows, next: 0, at: 0, all }
    })
}

/// A track whose values come from those of another. `make` receives the other's stream, whether any column is used,
/// and empty columns.
fn over<'a, S: Stream + 'a>(
    track: Track<'a>,
    make: impl Fn(Box<dyn Stream + 'a>, bool, Vec<Column>) -> S + Send + 'a,
) -> Track<'a> {
    let Track { columns, lengths, what, open: inner } = track;
    let empty = columns.clone();
    let open = move |used: &[bool]| {
        let stream = make(inner(used)?, used.contains(&true), empty.clone());
        Ok(Box::new(stream) as Box<dyn Stream + 'a>)
    };
    Track { columns, lengths, what, open: Box::new(open) }
}

struct Kept<'a> {
    inner: Box<dyn Stream + 'a>,
    used: bool,
    /// Takes the rows that are left out.
    passed: Vec<Column>,
    rows: Arc<[Range<u64>]>,
    /// Index of the next range of rows.
    next: usize,
    /// Number of rows read, and of all rows.
    at: u64,
    all: u64,
}

impl Kept<'_> {
    /// Reads on to row `row`.
    fn pass(&mut self, row: u64, room: &mut Vec<u8>) -> Result<(), ReadError> {
        while self.at < row {
            let some = SOME.min(row - self.at);
            self.passed.iter_mut().for_each(|column| column.data.clear());
            self.inner.read(some as usize, &mut self.passed, room)?;
            self.at += some;
        }
        Ok(())
    }
}

impl Stream for Kept<'_> {
    fn read(
        &mut self,
        count: usize,
        columns: &mut [Column],
        room: &mut Vec<u8>,
    ) -> Result<usize, ReadError> {
        if !self.used {
            return Ok(count);
        }
        let mut read = 0;
        while read < count {
            let Some(range) = self.rows.get(self.next).cloned() else { break };
            self.pass(range.start, room)?;
            let left = usize::try_from(range.end - self.at).unwrap_or(usize::MAX);
            let some = left.min(count - read);
            self.inner.read(some, columns, room)?;
            (read, self.at) = (read + some, self.at + some as u64);
            self.next += usize::from(self.at == range.end);
        }
        Ok(read)
    }

    fn finish(&mut self) -> Result<u64, ReadError> {
        // What follows the last particle may be damaged.
        if self.used {
            self.pass(self.all, &mut Vec::new())?;
        }
        self.inner.finish()
    }
}

/// Reads a track (values in a file) that has one column, and calls `each` with the index and value of its first
/// `count` values.
fn each(
    track: &Track<'_>,
    count: u64,
    mut each: impl FnMut(u64, f64) -> Result<(), String>,
) -> Result<(), String> {
    let unread = |error: ReadError| format!("their list cannot be read ({error})");
    let mut stream = (track.open)(&[true]).map_err(unread)?;
    let mut columns = track.columns.clone();
    let (mut at, mut room) = (0, Vec::new());
    while at < count {
        let some = SOME.min(count - at);
        columns.iter_mut().for_each(|column| column.data.clear());
        stream.read(some as usize, &mut columns, &mut room).map_err(unread)?;
        for i in 0..some {
            let value = columns.first().and_then(|column| column.data.f64(i as usize));
            each(at + i, value.ok_or_else(|| unread(changed()))?)?;
        }
        at += some;
    }
    Ok(())
}

/// Name for a column of values per cell. A column that marks ghosts gets a suffix, because ghosts are marked by other
/// bits in cells than in points.
pub(super) fn column_name(name: &str) -> String {
    match names::is_ghost(name) {
        true => format!("{name}{}", names::OF_CELLS),
        false => name.to_string(),
    }
}

/// Removes from `cells` the fields that the points have under the same name, because those of the points are used.
/// Returns the removed names, except those of ghosts.
pub(super) fn doubled(cells: &mut Vec<Attribute>, points: &[Attribute]) -> Vec<String> {
    let plain: Vec<String> = points.iter().map(|point| names::plain(&point.name)).collect();
    let (double, own): (Vec<_>, Vec<_>) = std::mem::take(cells)
        .into_iter()
        .partition(|cell| plain.contains(&names::plain(&cell.name)));
    *cells = own;
    // Ghosts are marked in both alike.
    double.into_iter().map(|cell| cell.name).filter(|name| !names::is_ghost(name)).collect()
}

/// Warning about fields of cells that are not used.
pub(super) fn unused(names: &[String], why: &str) -> Option<String> {
    let quoted: Vec<_> = names.iter().take(NAMED).map(|name| format!("`{name}`")).collect();
    let more = if names.len() > NAMED { ", ..." } else { "" };
    (!names.is_empty())
        .then(|| format!("fields of cells are not used: {}{more}; {why}", quoted.join(", ")))
}

/// Why fields of cells are not used, if the cells are no particles.
pub(super) fn no_particles(why: &str) -> String {
    format!(
        "particles are points, or cells of one point each, but {why}; save the fields as point data (ParaView: filter Cell \
         Data to Point Data)"
    )
}

/// Why cell fields (values per cell) are not used: the points have fields of the same names.
pub(super) const DOUBLED: &str = "the points have fields of the same names, which are used";
/// Why cell fields (values per cell) are not used: they have too few values or too many.
pub(super) const UNEVEN: &str = "they do not have a value for each cell";

/// The same values as the given track (values in a file, one row per cell), with the rows in the order of the points.
/// All rows are in memory while they are read.
pub(super) fn reordered<'a>(track: Track<'a>, cells: Arc<[u32]>) -> Track<'a> {
    over(track, move |inner, used, empty| {
        let cells = cells.clone();
        Reordered { inner, used, empty, all: None, cells, next: 0 }
    })
}

struct Reordered<'a> {
    inner: Box<dyn Stream + 'a>,
    used: bool,
    empty: Vec<Column>,
    /// The values of all points, once they are read.
    all: Option<Vec<Data>>,
    /// The cell of each point.
    cells: Arc<[u32]>,
    /// Index of the next point.
    next: usize,
}

impl Stream for Reordered<'_> {
    fn read(
        &mut self,
        count: usize,
        columns: &mut [Column],
        room: &mut Vec<u8>,
    ) -> Result<usize, ReadError> {
        if !self.used {
            return Ok(count);
        }
        let all = match self.all.take() {
            Some(all) => all,
            None => {
                let mut own = self.empty.clone();
                self.inner.read(self.cells.len(), &mut own, room)?;
                own.iter().map(|c| c.data.picked(c.components, &self.cells)).collect()
            }
        };
        let end = self.cells.len().min(self.next.saturating_add(count));
        let some: Range<usize> = self.next..end;
        for (column, data) in columns.iter_mut().zip(&all) {
            column.data.extend(data, column.components, &some);
        }
        self.next = end;
        self.all = Some(all);
        Ok(some.len())
    }

    fn finish(&mut self) -> Result<u64, ReadError> {
        self.inner.finish()
    }
}
