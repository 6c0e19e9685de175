//! Turns named columns of numbers into [`Particles`]: finds the meaning of each name, and makes the checks that
//! all formats share.

use std::ops::Range;

use half::f16;

use super::asked::Asked;
use super::error::{Place, ReadError};
use super::meaning::Meaning;
use super::names::{self, Names};
use super::survey::{Columns, Survey};
use super::{Format, Particles, bytes};

/// How an attribute is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum AttributeType {
    /// Signed, 8 bits
    I8,
    /// Unsigned, 8 bits
    U8,
    /// Signed, 16 bits
    I16,
    /// Unsigned, 16 bits
    U16,
    /// Signed, 32 bits
    I32,
    /// Unsigned, 32 bits
    U32,
    /// Signed, 64 bits
    I64,
    /// Unsigned, 64 bits
    U64,
    /// Half precision
    F16,
    /// Single precision
    F32,
    /// Double precision
    F64,
    /// A number as text
    Number,
    /// Text, or an index into a list of texts
    Text,
    /// A list of varying length
    List,
    /// Anything else
    Other,
}

impl AttributeType {
    /// Bytes of one value in a binary file; `None` without a fixed size.
    pub(super) fn size(self) -> Option<u64> {
        match self {
            Self::I8 | Self::U8 => Some(1),
            Self::I16 | Self::U16 | Self::F16 => Some(2),
            Self::I32 | Self::U32 | Self::F32 => Some(4),
            Self::I64 | Self::U64 | Self::F64 => Some(8),
            Self::Number | Self::Text | Self::List | Self::Other => None,
        }
    }
}

impl std::fmt::Display for AttributeType {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::I8 => "i8",
            Self::U8 => "u8",
            Self::I16 => "i16",
            Self::U16 => "u16",
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::I64 => "i64",
            Self::U64 => "u64",
            Self::F16 => "f16",
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Number => "number",
            Self::Text => "text",
            Self::List => "list",
            Self::Other => "other",
        })
    }
}

/// Name and shape of one attribute in a file.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Attribute {
    /// Name in the file.
    pub name: String,
    /// Values per particle; 3 for a vector.
    pub components: usize,
    /// How each value is stored.
    pub ty: AttributeType,
}

/// An attribute that was requested by name.
#[derive(Debug, Clone, PartialEq)]
pub struct Extra {
    /// Name in the file.
    pub name: String,
    /// One value per particle; NaN where the file has no number.
    pub values: Vec<f64>,
}

impl std::fmt::Display for Attribute {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {} x {}", self.name, self.components, self.ty)
    }
}

/// Values in the narrowest type that holds them exactly.
#[derive(Debug, Clone)]
pub(super) enum Data {
    F32(Vec<f32>),
    F64(Vec<f64>),
    /// Integers of any width. Unsigned 64-bit values above `i64::MAX` are clamped to it, so
    /// [`to_ids`](Self::to_ids) refuses the id `i64::MAX`.
    Int(Vec<i64>),
}

impl Data {
    pub(super) const NONE: Self = Self::F32(Vec::new());

    pub(super) fn for_type(ty: AttributeType) -> Self {
        use AttributeType as T;
        match ty {
            T::F16 | T::F32 => Self::F32(Vec::new()),
            T::I8 | T::U8 | T::I16 | T::U16 | T::I32 | T::U32 | T::I64 | T::U64 => {
                Self::Int(Vec::new())
            }
            T::F64 | T::Number | T::Text | T::List | T::Other => Self::F64(Vec::new()),
        }
    }

    pub(super) fn len(&self) -> usize {
        match self {
            Self::F32(v) => v.len(),
            Self::F64(v) => v.len(),
            Self::Int(v) => v.len(),
        }
    }

    pub(super) fn reserve(&mut self, n: usize) {
        match self {
            Self::F32(v) => v.reserve(n),
            Self::F64(v) => v.reserve(n),
            Self::Int(v) => v.reserve(n),
        }
    }

    /// Reserves memory for `more` further values. If it has to grow, it doubles, but not beyond the expected
    /// total `all` (unless `more` needs it): a false total in a header cannot allocate much.
    pub(super) fn room(&mut self, more: usize, all: usize) {
        let (length, capacity) = match self {
            Self::F32(v) => (v.len(), v.capacity()),
            Self::F64(v) => (v.len(), v.capacity()),
            Self::Int(v) => (v.len(), v.capacity()),
        };
        if capacity - length < more {
            let grown = length.min(all.saturating_sub(length)).max(more);
            match self {
                Self::F32(v) => v.reserve_exact(grown),
                Self::F64(v) => v.reserve_exact(grown),
                Self::Int(v) => v.reserve_exact(grown),
            }
        }
    }

    /// Appends the other values; false if they have another type.
    #[cfg(feature = "hdf5")]
    pub(super) fn append(&mut self, other: Self) -> bool {
        match (self, other) {
            (Self::F32(v), Self::F32(mut more)) => v.append(&mut more),
            (Self::F64(v), Self::F64(mut more)) => v.append(&mut more),
            (Self::Int(v), Self::Int(mut more)) => v.append(&mut more),
            _ => return false,
        }
        true
    }

    pub(super) fn clear(&mut self) {
        match self {
            Self::F32(v) => v.clear(),
            Self::F64(v) => v.clear(),
            Self::Int(v) => v.clear(),
        }
    }

    /// Whether values of another type can be stored here.
    pub(super) fn takes(&self, ty: AttributeType) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(&Self::for_type(ty))
    }

    /// All values as `f32`, without a copy if they are stored so.
    pub(super) fn into_f32(self) -> Vec<f32> {
        match self {
            Self::F32(v) => v,
            Self::F64(v) => v.into_iter().map(|x| x as f32).collect(),
            Self::Int(v) => v.into_iter().map(|x| x as f32).collect(),
        }
    }

    /// Returns all values as ids of particles, those beyond 32 bits hashed. The error is the index of the first value
    /// that is negative, fractional or too large to be exact.
    pub(super) fn to_ids(&self) -> Result<Vec<u32>, usize> {
        let id = |i: usize| match self {
            // `i64::MAX` stands for all larger values, see `Data::Int`.
            Self::Int(v) => {
                v.get(i).filter(|x| (0..i64::MAX).contains(*x)).map(|x| hashed(*x as u64))
            }
            _ => {
                let x = self.f64(i)?;
                let exact = x.fract() == 0.0 && (0.0..self.limit()).contains(&x);
                exact.then(|| hashed(x as u64))
            }
        };
        let mut values = Vec::with_capacity(self.len());
        values.extend((0..self.len()).map_while(id));
        if values.len() < self.len() { Err(values.len()) } else { Ok(values) }
    }

    /// The number from which on floats do not tell all integers apart: 2^24, and of doubles about 2^53.
    pub(super) fn limit(&self) -> f64 {
        match self {
            Self::F32(_) => 16_777_216.0,
            Self::F64(_) | Self::Int(_) => 9.0e15,
        }
    }

    /// Returns all values as `u32`, or as the error the index of the first value that is not an integer in the
    /// range of `u32`.
    pub(super) fn to_u32(&self) -> Result<Vec<u32>, usize> {
        let mut values = Vec::with_capacity(self.len());
        values.extend((0..self.len()).map_while(|i| self.u32(i)));
        if values.len() < self.len() { Err(values.len()) } else { Ok(values) }
    }

    pub(super) fn f64(&self, i: usize) -> Option<f64> {
        match self {
            Self::F32(v) => v.get(i).map(|x| f64::from(*x)),
            Self::F64(v) => v.get(i).copied(),
            Self::Int(v) => v.get(i).map(|x| *x as f64),
        }
    }

    /// A value, if it is an integer that fits.
    fn u32(&self, i: usize) -> Option<u32> {
        match self {
            Self::Int(v) => v.get(i).and_then(|x| u32::try_from(*x).ok()),
            _ => {
                let x = self.f64(i)?;
                (x.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&x)).then_some(x as u32)
            }
        }
    }

    /// Appends a number given as text; false if it is none.
    pub(super) fn push_text(&mut self, token: &[u8]) -> bool {
        if let Self::Int(v) = self {
            let whole = std::str::from_utf8(token).ok().and_then(|t| t.parse().ok());
            if let Some(x) = whole.or_else(|| {
                let x = bytes::parse_number(token)?;
                (x.fract() == 0.0).then_some(x as i64)
            }) {
                v.push(x);
                return true;
            }
            return false;
        }
        bytes::parse_number(token).is_some_and(|x| self.push_number(x))
    }

    /// Appends a number; false if the values are integers.
    pub(super) fn push_number(&mut self, x: f64) -> bool {
        match self {
            Self::F64(v) => v.push(x),
            Self::F32(v) => v.push(x as f32),
            Self::Int(_) => return false,
        }
        true
    }

    /// Replaces the last value, if it is a double.
    pub(super) fn set_last(&mut self, value: f64) {
        if let Self::F64(v) = self {
            v.last_mut().into_iter().for_each(|x| *x = value);
        }
    }

    /// Appends contiguous values; false for a type without a fixed size.
    pub(super) fn push_bytes(&mut self, ty: AttributeType, raw: &[u8], big_endian: bool) -> bool {
        /// One arm per type: split into chunks and convert.
        macro_rules! push {
            ($v:expr, $number:ty, $target:ty) => {{
                let (chunks, _) = raw.as_chunks::<{ size_of::<$number>() }>();
                if big_endian {
                    $v.extend(chunks.iter().map(|c| <$number>::from_be_bytes(*c) as $target));
                } else {
                    $v.extend(chunks.iter().map(|c| <$number>::from_le_bytes(*c) as $target));
                }
            }};
        }
        use AttributeType as T;
        match (self, ty) {
            (Self::F32(v), T::F16) => {
                let number = if big_endian { f16::from_be_bytes } else { f16::from_le_bytes };
                v.extend(raw.as_chunks::<2>().0.iter().map(|c| number(*c).to_f32()));
            }
            (Self::F32(v), T::F32) => push!(v, f32, f32),
            (Self::F64(v), T::F64) => push!(v, f64, f64),
            (Self::Int(v), T::I8) => push!(v, i8, i64),
            (Self::Int(v), T::U8) => push!(v, u8, i64),
            (Self::Int(v), T::I16) => push!(v, i16, i64),
            (Self::Int(v), T::U16) => push!(v, u16, i64),
            (Self::Int(v), T::I32) => push!(v, i32, i64),
            (Self::Int(v), T::U32) => push!(v, u32, i64),
            (Self::Int(v), T::I64) => push!(v, i64, i64),
            (Self::Int(v), T::U64) => {
                let from = v.len();
                push!(v, u64, i64);
                // The cast wraps values beyond the range to negative ones.
                for x in v.iter_mut().skip(from).filter(|x| **x < 0) {
                    *x = i64::MAX;
                }
            }
            _ => return false,
        }
        true
    }

    /// The first `first` of the `components` values of each row.
    pub(super) fn some(&self, components: usize, first: usize) -> Self {
        fn some<T: Copy>(v: &[T], components: usize, first: usize) -> Vec<T> {
            v.chunks(components.max(1)).flat_map(|row| row.iter().take(first).copied()).collect()
        }
        match self {
            Self::F32(v) => Self::F32(some(v, components, first)),
            Self::F64(v) => Self::F64(some(v, components, first)),
            Self::Int(v) => Self::Int(some(v, components, first)),
        }
    }

    /// The rows with these indices.
    pub(super) fn picked(&self, components: usize, rows: &[u32]) -> Self {
        fn pick<T: Copy>(v: &[T], components: usize, rows: &[u32]) -> Vec<T> {
            let row = |row: &u32| {
                let start = (*row as usize).saturating_mul(components);
                v.get(start..start.saturating_add(components)).unwrap_or_default()
            };
            let mut picked = Vec::with_capacity(v.len());
            rows.iter().for_each(|index| picked.extend_from_slice(row(index)));
            picked
        }
        match self {
            Self::F32(v) => Self::F32(pick(v, components, rows)),
            Self::F64(v) => Self::F64(pick(v, components, rows)),
            Self::Int(v) => Self::Int(pick(v, components, rows)),
        }
    }

    /// Appends rows of values of the same type.
    pub(super) fn extend(&mut self, from: &Self, components: usize, rows: &Range<usize>) {
        let some = rows.start.saturating_mul(components)..rows.end.saturating_mul(components);
        match (self, from) {
            (Self::F32(v), Self::F32(from)) => {
                v.extend_from_slice(from.get(some).unwrap_or_default())
            }
            (Self::F64(v), Self::F64(from)) => {
                v.extend_from_slice(from.get(some).unwrap_or_default())
            }
            (Self::Int(v), Self::Int(from)) => {
                v.extend_from_slice(from.get(some).unwrap_or_default())
            }
            _ => {}
        }
    }

    /// Transposes values that are stored component after component to rows, and keeps `count` components of
    /// each row, from component `from` on.
    pub(super) fn turned(&self, components: usize, from: usize, count: usize) -> Self {
        fn turn<T: Copy>(v: &[T], components: usize, from: usize, count: usize) -> Vec<T> {
            let rows = v.len() / components.max(1);
            let row =
                |row| (from..from + count).filter_map(move |c| v.get(c * rows + row).copied());
            (0..rows).flat_map(row).collect()
        }
        match self {
            Self::F32(v) => Self::F32(turn(v, components, from, count)),
            Self::F64(v) => Self::F64(turn(v, components, from, count)),
            Self::Int(v) => Self::Int(turn(v, components, from, count)),
        }
    }
}

/// The values of one attribute.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) data: Data,
}

/// The result of a reader.
#[derive(Debug, Default)]
pub(super) struct Table {
    /// Number of components of a position, and the values of all positions, if the format stores them apart
    /// from the named columns; otherwise the positions are searched among these columns.
    pub(super) positions: Option<(usize, Data)>,
    pub(super) columns: Vec<Column>,
    pub(super) attributes: Vec<Attribute>,
    pub(super) warnings: Vec<String>,
    /// Time, if the file has it.
    pub(super) time: Option<f64>,
    pub(super) asked: Asked,
}

impl Table {
    pub(super) fn new(asked: &Asked) -> Self {
        Self { asked: asked.clone(), ..Self::default() }
    }

    /// Lists an attribute and returns whether its values are wanted.
    pub(super) fn list(&mut self, name: &str, components: usize, ty: AttributeType) -> bool {
        self.asked.list(&mut self.attributes, name, components, ty)
    }

    pub(super) fn push(&mut self, name: &str, components: usize, data: Data) {
        self.columns.push(Column { name: name.into(), components, data });
    }

    /// Checks the lengths and assigns meanings to the columns.
    pub(super) fn assemble(mut self, format: Format) -> Result<Particles, ReadError> {
        let placed = self.positions.take().map(|(components, data)| {
            self.push(PLACED, components, data);
            self.columns.len() - 1
        });
        let shapes: Vec<_> = self.columns.iter().map(Column::shape).collect();
        let roles = Roles::find(&shapes, placed, &self.attributes, &self.asked)?;
        roles.rows(&shapes)?;
        let mut meanings = roles.meanings(&shapes, &self.attributes);
        self.warnings.extend(roles.warnings());
        let columns = Columns::new(self.columns);
        let only = roles.steps.and_then(|_| self.asked.step()?.time);
        let mut survey = Survey::new(columns.origin(&roles)).of_time(only);
        let mut particles = survey.part(&roles, columns, format);
        survey.drop_from(&mut particles);
        self.warnings.extend(survey.finish()?);
        survey.settle(&mut meanings);
        let time = self.time.or(survey.time());
        Ok(Particles {
            attributes: self.attributes,
            meanings,
            warnings: self.warnings,
            time,
            ..particles
        })
    }
}

/// Name of positions that the format stores apart and without a name.
pub(super) const PLACED: &str = "positions";
/// Names under which formats list such positions.
const OWN: [&str; 3] = ["Points", "position", "array"];

impl Column {
    /// A column without values.
    pub(super) fn new(name: &str, components: usize, ty: AttributeType) -> Self {
        Self { name: name.into(), components, data: Data::for_type(ty) }
    }

    fn shape(&self) -> Shape<'_> {
        Shape { name: &self.name, components: self.components, values: self.data.len() as u64 }
    }
}

/// What determines the meaning of a column. It is known from the header of the file, before any values are
/// read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape<'a> {
    pub(super) name: &'a str,
    pub(super) components: usize,
    /// Number of values for all particles.
    pub(super) values: u64,
}

impl Shape<'_> {
    fn check(&self, rows: u64) -> Result<(), ReadError> {
        let expected = rows.saturating_mul(self.components as u64);
        if self.values != expected {
            return Err(ReadError::Length {
                attribute: self.name.to_string(),
                expected,
                found: self.values,
            });
        }
        Ok(())
    }
}

/// Where the components of a vector are stored: in one column of two or three components (`Whole`: its index
/// and the number of components), or in one column per component (`Split`: their indices). Missing components
/// are 0.
#[derive(Debug, Clone, Copy)]
pub(super) enum Vector {
    Whole(usize, usize),
    Split([Option<usize>; 3]),
}

impl Vector {
    pub(super) fn is_flat(self) -> bool {
        match self {
            Self::Whole(_, components) => components < 3,
            Self::Split(columns) => columns.contains(&None),
        }
    }

    /// For each axis, whether its component is missing.
    fn missing(self) -> [bool; 3] {
        match self {
            Self::Whole(_, components) => [false, false, components < 3],
            Self::Split(columns) => columns.map(|column| column.is_none()),
        }
    }

    pub(super) fn columns(self) -> impl Iterator<Item = usize> {
        let columns = match self {
            Self::Whole(column, _) => [Some(column), None, None],
            Self::Split(columns) => columns,
        };
        columns.into_iter().flatten()
    }
}

/// The index of the column that has each role. Of two columns with the same name, the first counts.
#[derive(Debug)]
pub(super) struct Roles {
    pub(super) positions: Vector,
    pub(super) velocities: Option<Vector>,
    pub(super) densities: Option<usize>,
    /// The time that a particle has left; with `ages`, the time that it may live in all.
    pub(super) lifetimes: Option<usize>,
    pub(super) ages: Option<usize>,
    pub(super) ids: Option<usize>,
    pub(super) kinds: Option<usize>,
    /// Marks copies of particles that belong to another piece.
    pub(super) ghosts: Option<usize>,
    /// Times or step numbers, one per particle.
    pub(super) steps: Option<usize>,
    /// Indices of columns that the caller requested by name.
    pub(super) extras: Vec<usize>,
    /// Warnings about the choice.
    told: Vec<String>,
}

/// Searches the columns of a file.
struct Search<'a> {
    shapes: &'a [Shape<'a>],
    /// Their plain names, see [`names::plain`].
    plain: Vec<String>,
}

impl<'a> Search<'a> {
    fn new(shapes: &'a [Shape<'a>]) -> Self {
        Self { shapes, plain: shapes.iter().map(|shape| names::plain(shape.name)).collect() }
    }

    /// The column with this name and number of components; of several, the first in small letters, because `X` beside
    /// `x` is where the particle was at first, else the first.
    fn one(&self, name: &str, components: usize) -> Option<usize> {
        let is = |(shape, plain): &(&Shape<'_>, &String)| {
            shape.components == components && *plain == name
        };
        let all = || self.shapes.iter().zip(&self.plain);
        let small = all().position(|each| is(&each) && !each.0.name.contains(char::is_uppercase));
        small.or_else(|| all().position(|each| is(&each)))
    }

    /// All columns that were requested by name.
    fn asked(&self, asked: &Asked) -> Vec<usize> {
        let all = self.shapes.iter().zip(&self.plain).enumerate();
        let asked = all.filter(|(_, (shape, plain))| shape.components == 1 && asked.has(plain));
        asked.map(|(i, _)| i).collect()
    }

    fn scalar(&self, names: Names) -> Option<usize> {
        names.iter().find_map(|name| self.one(name, 1))
    }

    /// Finds a vector: one column of three components, else three scalar columns, else one column of two
    /// components, else two scalar columns. A column with a name of [`names::VAGUE`] comes behind three scalars.
    fn vector(&self, names: Names) -> Option<Vector> {
        let whole = |components: usize, vague: bool| {
            let mut some = names.iter().filter(|name| names::VAGUE.contains(*name) == vague);
            let column = some.find_map(|name| self.one(name, components))?;
            Some(Vector::Whole(column, components))
        };
        let one = |name: &String| self.one(name, 1);
        let split = || names::triples(names).iter().map(|names| names.each_ref().map(one));
        let of_three = || split().find(|columns| !columns.contains(&None)).map(Vector::Split);
        let of_two = || {
            let mut split = split();
            let found = split.find(|columns| columns.iter().flatten().count() > 1);
            found.map(Vector::Split)
        };
        whole(3, false)
            .or_else(of_three)
            .or_else(|| whole(3, true))
            .or_else(|| whole(2, false))
            .or_else(|| whole(2, true))
            .or_else(of_two)
    }

    /// Finds the velocities. Two components suit positions in the same plane. Beside other positions, two named ones
    /// are told, and two of the bare `u v w` are no velocities but any two scalars, such as texture coordinates.
    fn velocities(&self, positions: Vector, told: &mut Vec<String>) -> Option<Vector> {
        let found = self.vector(names::VELOCITY)?;
        if !found.is_flat() || found.missing() == positions.missing() {
            return Some(found);
        }
        let listed: Vec<_> = found.columns().map(|i| format!("`{}`", self.name(i))).collect();
        let listed = listed.join(" and ");
        let is_bare =
            |i: usize| self.plain.get(i).is_some_and(|plain| names::BARE.contains(&plain.as_str()));
        if matches!(found, Vector::Split(_)) && found.columns().all(is_bare) {
            told.push(format!(
                "{listed} are not taken as velocities, because the positions have other axes; if they are velocities, \
                 call them vx, vy, vz"
            ));
            return None;
        }
        told.push(format!("velocities have two components ({listed}): the third is taken as 0"));
        Some(found)
    }

    /// Finds the lifetimes, and the ages to be subtracted from them. `ages` are those of the file.
    fn lifetimes(
        &self,
        ages: Option<usize>,
        told: &mut Vec<String>,
    ) -> (Option<usize>, Option<usize>) {
        let (left, life) = (self.scalar(names::LIFETIME), self.scalar(names::LIFE));
        match (left, life, ages) {
            (_, Some(life), Some(age)) => (Some(life), Some(age)),
            (Some(left), _, Some(age)) => {
                let (left_name, age_name) = (self.name(left), self.name(age));
                told.push(format!(
                    "the time left of a particle is taken as `{left_name}` less `{age_name}`; if `{left_name}` is \
                     already the time left, rename `{age_name}`"
                ));
                (Some(left), Some(age))
            }
            (Some(left), _, None) => (Some(left), None),
            (None, Some(life), None) => {
                told.push(format!(
                    "attribute `{}` is not used: it is the time that a particle may live in all, and without an \
                     attribute `age` the time left is unknown; call it `lifetime` if it is the time left",
                    self.name(life)
                ));
                (None, None)
            }
            (None, None, _) => (None, None),
        }
    }

    fn name(&self, column: usize) -> &'a str {
        self.shapes.get(column).map_or("", |shape| shape.name)
    }
}

impl Roles {
    /// Finds the column of each role by name. `placed` is the index of the column of positions, if the format
    /// stores them apart from the named columns.
    pub(super) fn find(
        shapes: &[Shape<'_>],
        placed: Option<usize>,
        attributes: &[Attribute],
        asked: &Asked,
    ) -> Result<Self, ReadError> {
        let search = Search::new(shapes);
        let plain: Vec<String> = attributes.iter().map(|a| names::plain(&a.name)).collect();
        let several = |digit: char| {
            ["x", "y", "z"].iter().all(|axis| {
                plain.iter().any(|name| {
                    name.strip_prefix(axis).is_some_and(|rest| rest.chars().eq([digit]))
                })
            })
        };
        // `x1 x2 x3` would be a position by itself.
        if several('1') && several('2') {
            return Err(ReadError::Unsupported {
                what: "a table with three columns for each particle (x1 y1 z1 x2 y2 z2 ...)".into(),
                advice: "write a line for each particle, with columns time,x,y,z",
            });
        }
        let positions = match placed {
            Some(placed) => {
                Some(Vector::Whole(placed, shapes.get(placed).map_or(3, |s| s.components)))
            }
            None => search.vector(names::POSITION),
        };
        let Some(positions) = positions else {
            let names: Vec<_> = attributes.iter().map(Attribute::to_string).collect();
            return Err(ReadError::NoPositions {
                expected: names::POSITION_NAMES,
                found: match names.len() {
                    0 => "no attributes at all".into(),
                    n => {
                        let more = if n > 24 { ", ..." } else { "" };
                        let names: Vec<_> = names.into_iter().take(24).collect();
                        format!("{}{more}", names.join(", "))
                    }
                },
            });
        };
        // A column whose number of values differs from the number of particles is no attribute; it may be a
        // list of times.
        let values = |i: usize| shapes.get(i).map(|shape| shape.values);
        let of_one = |vector: Vector| {
            vector.columns().next().and_then(|i| {
                let shape = shapes.get(i)?;
                Some(shape.values / (shape.components.max(1) as u64))
            })
        };
        let fits = |column: &usize| values(*column) == of_one(positions);
        let mut steps = names::STEP.iter().filter_map(|name| search.one(name, 1));
        let mut told = Vec::new();
        let ages = search.scalar(names::AGE).filter(fits);
        let (lifetimes, ages) = search.lifetimes(ages, &mut told);
        let velocities = search.velocities(positions, &mut told);
        let mut extras = search.asked(asked);
        extras.retain(fits);
        Ok(Self {
            ghosts: search.scalar(names::GHOST),
            steps: steps.find(fits),
            positions,
            velocities,
            densities: search.scalar(names::DENSITY),
            lifetimes,
            ages,
            ids: search.scalar(names::ID),
            kinds: search.scalar(names::KIND),
            extras,
            told,
        })
    }

    /// Warnings about the columns for the user.
    pub(super) fn warnings(&self) -> impl Iterator<Item = String> {
        self.positions
            .is_flat()
            .then(|| "positions have two components: the third is taken as 0".to_string())
            .into_iter()
            .chain(self.told.iter().cloned())
    }

    /// Number of particles, from the positions and checked against the other columns.
    pub(super) fn rows(&self, shapes: &[Shape<'_>]) -> Result<usize, ReadError> {
        let rows = match self.positions {
            Vector::Whole(i, components) => {
                let Some(shape) = shapes.get(i) else { return Ok(0) };
                let components = components as u64;
                if !shape.values.is_multiple_of(components) {
                    return Err(ReadError::malformed(
                        format!("{components} values per particle for `{}`", shape.name),
                        format!("{} values", shape.values),
                        Place::Unknown,
                    ));
                }
                shape.values / components
            }
            Vector::Split(columns) => {
                let first = columns.into_iter().flatten().next();
                first.and_then(|first| shapes.get(first)).map_or(0, |shape| shape.values)
            }
        };
        for shape in self.used().filter_map(|i| shapes.get(i)) {
            shape.check(rows)?;
        }
        usize::try_from(rows).map_err(|_| ReadError::TooLarge {
            what: "the list of particles".into(),
            limit: usize::MAX as u64,
        })
    }

    /// The meanings assigned to attributes.
    pub(super) fn meanings(
        &self,
        shapes: &[Shape<'_>],
        attributes: &[Attribute],
    ) -> Vec<(Meaning, Vec<String>)> {
        let vectors =
            [(Meaning::Position, Some(self.positions)), (Meaning::Velocity, self.velocities)];
        let scalars = [
            (Meaning::Density, self.densities, None),
            (Meaning::Lifetime, self.lifetimes, self.ages),
            (Meaning::Id, self.ids, None),
            (Meaning::Kind, self.kinds, None),
            (Meaning::Time, self.steps, None),
            (Meaning::Ghost, self.ghosts, None),
        ];
        let vectors = vectors.into_iter().filter_map(|(meaning, vector)| {
            let columns: Vec<_> = vector?.columns().collect();
            Some((meaning, columns))
        });
        let scalars = scalars.into_iter().filter_map(|(meaning, column, more)| {
            let columns: Vec<_> = std::iter::once(column?).chain(more).collect();
            Some((meaning, columns))
        });
        let name = |i: usize| shapes.get(i).map(|shape| shape.name.to_string());
        let all = vectors.chain(scalars);
        let all =
            all.map(|(meaning, columns)| (meaning, columns.into_iter().filter_map(name).collect()));
        let mut all: Vec<(Meaning, Vec<String>)> = all.collect();
        // Positions that are stored apart are listed under the format's name for them.
        let unlisted = |name: &String| !attributes.iter().any(|a| a.name == *name);
        if let Some((_, names)) = all.first_mut()
            && names.iter().any(unlisted)
            && let Some(own) = attributes.iter().find(|a| OWN.contains(&a.name.as_str()))
        {
            *names = vec![own.name.clone()];
        }
        all
    }

    /// The columns with a meaning, in the order of the checks.
    pub(super) fn used(&self) -> impl Iterator<Item = usize> {
        let vectors = [Some(self.positions), self.velocities].into_iter().flatten();
        let vectors = vectors.flat_map(Vector::columns);
        let scalars = [
            self.densities,
            self.lifetimes,
            self.ages,
            self.ids,
            self.kinds,
            self.ghosts,
            self.steps,
        ];
        vectors.chain(scalars.into_iter().flatten()).chain(self.extras.iter().copied())
    }
}

/// An id in 32 bits: itself if it fits, else a hash of all its bits. Ids beyond 32 bits are often made of two numbers, such
/// as the rank of a process in the upper half, so that the lower half alone would repeat. Of a million, the hash gives about
/// 120 pairs the same id.
fn hashed(id: u64) -> u32 {
    u32::try_from(id).unwrap_or_else(|_| {
        // The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
        let id = (id ^ id >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let id = (id ^ id >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((id ^ id >> 31) >> 32) as u32
    })
}
