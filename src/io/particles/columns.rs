//! From named columns of numbers to [`Particles`]: which names mean what, and checks that hold for all formats.

use super::error::{Place, ReadError};
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
    /// Bytes of one value in a binary file, where it has a fixed size.
    pub(super) fn size(self) -> Option<u64> {
        match self {
            Self::I8 | Self::U8 => Some(1),
            Self::I16 | Self::U16 => Some(2),
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
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Number => "number",
            Self::Text => "text",
            Self::List => "list",
            Self::Other => "other",
        })
    }
}

/// The name and shape of one attribute of a file.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Attribute {
    /// As the file has it.
    pub name: String,
    /// Values per particle; 3 for a vector.
    pub components: usize,
    /// How each value is stored.
    pub ty: AttributeType,
}

impl std::fmt::Display for Attribute {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {} x {}", self.name, self.components, self.ty)
    }
}

/// Numbers in the narrowest form that holds them exactly.
#[derive(Debug, Clone)]
pub(super) enum Data {
    F32(Vec<f32>),
    F64(Vec<f64>),
    /// Unsigned 64-bit values beyond the range are held at its end: no id that large is kept anyway.
    Int(Vec<i64>),
}

impl Data {
    pub(super) fn for_type(ty: AttributeType) -> Self {
        use AttributeType as T;
        match ty {
            T::F32 => Self::F32(Vec::new()),
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

    fn f32(&self, i: usize) -> Option<f32> {
        match self {
            Self::F32(v) => v.get(i).copied(),
            Self::F64(v) => v.get(i).map(|x| *x as f32),
            Self::Int(v) => v.get(i).map(|x| *x as f32),
        }
    }

    fn f64(&self, i: usize) -> Option<f64> {
        match self {
            Self::F32(v) => v.get(i).map(|x| f64::from(*x)),
            Self::F64(v) => v.get(i).copied(),
            Self::Int(v) => v.get(i).map(|x| *x as f64),
        }
    }

    /// The value where it is a whole number that fits.
    fn u32(&self, i: usize) -> Option<u32> {
        match self {
            Self::Int(v) => v.get(i).and_then(|x| u32::try_from(*x).ok()),
            _ => {
                let x = self.f64(i)?;
                (x.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&x)).then_some(x as u32)
            }
        }
    }

    /// Appends a number given as text; false where it is none.
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
        match (bytes::parse_number(token), self) {
            (Some(x), Self::F64(v)) => v.push(x),
            (Some(x), Self::F32(v)) => v.push(x as f32),
            _ => return false,
        }
        true
    }

    /// Appends values that lie together in memory. False for a type without a size.
    pub(super) fn push_bytes(&mut self, ty: AttributeType, raw: &[u8], big_endian: bool) -> bool {
        /// One arm per type: cut into chunks, convert.
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
                // The cast wraps values over the range to negative ones.
                for x in v.iter_mut().skip(from).filter(|x| **x < 0) {
                    *x = i64::MAX;
                }
            }
            _ => return false,
        }
        true
    }

    /// Appends another piece of the same attribute; false where the types differ.
    pub(super) fn append(&mut self, other: Self) -> bool {
        match (self, other) {
            (Self::F32(a), Self::F32(b)) => a.extend(b),
            (Self::F64(a), Self::F64(b)) => a.extend(b),
            (Self::Int(a), Self::Int(b)) => a.extend(b),
            _ => return false,
        }
        true
    }

    /// From all values of the first component, then all of the second ...: to particle after particle.
    pub(super) fn transposed(self, components: usize) -> Self {
        fn turn<T: Copy>(v: &[T], components: usize) -> Vec<T> {
            let rows = v.len() / components.max(1);
            (0..rows)
                .flat_map(|row| (0..components).filter_map(move |c| v.get(c * rows + row).copied()))
                .collect()
        }
        match self {
            Self::F32(v) => Self::F32(turn(&v, components)),
            Self::F64(v) => Self::F64(turn(&v, components)),
            Self::Int(v) => Self::Int(turn(&v, components)),
        }
    }
}

/// Numbers of one attribute.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) components: usize,
    pub(super) data: Data,
}

/// What a reader found.
#[derive(Debug, Default)]
pub(super) struct Table {
    /// Positions, where the format has a place for them; else they are looked for among the columns.
    pub(super) positions: Option<Data>,
    pub(super) columns: Vec<Column>,
    pub(super) attributes: Vec<Attribute>,
    pub(super) warnings: Vec<String>,
}

const POSITION: &[&str] =
    &["position", "positions", "pos", "points", "point", "coordinates", "coords", "x", "p"];
const POSITION_BASES: &[&str] =
    &["", "points", "point", "position", "positions", "pos", "coordinates", "coords", "p"];
const POSITION_NAMES: &str = "`position`, `positions`, `pos`, `points` or `x` with 3 components, or `x` `y` `z`, `Points:0` `Points:1` `Points:2`";
const VELOCITY: &[&str] = &["velocity", "velocities", "vel", "v"];
const DENSITY: &[&str] = &["density", "densities", "rho"];
const ID: &[&str] = &["id", "ids", "particle_id", "particleid", "index"];
const LIFETIME: &[&str] = &["lifetime", "life"];
const KIND: &[&str] = &["type"];
/// How the components of a vector are told apart.
const SUFFIXES: &[[&str; 3]] = &[
    [":0", ":1", ":2"],
    ["_0", "_1", "_2"],
    ["[0]", "[1]", "[2]"],
    [":x", ":y", ":z"],
    ["_x", "_y", "_z"],
    [".x", ".y", ".z"],
    ["x", "y", "z"],
];

/// The names of the three scalars that a vector may be split into.
fn triples(bases: &[&str]) -> impl Iterator<Item = [String; 3]> {
    bases.iter().flat_map(|base| {
        SUFFIXES
            .iter()
            .filter(move |s| !base.is_empty() || s[0] == "x")
            .map(move |s| s.map(|s| format!("{base}{s}")))
    })
}

fn uvw() -> [String; 3] {
    ["u", "v", "w"].map(String::from)
}

/// Whether an attribute of this name may be used, so that a reader need not unpack the others.
pub(super) fn wanted(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    [POSITION, VELOCITY, DENSITY, ID, LIFETIME, KIND]
        .iter()
        .any(|names| names.contains(&name.as_str()))
        || uvw().contains(&name)
        || triples(POSITION_BASES).chain(triples(VELOCITY)).any(|names| names.contains(&name))
}

/// Whether `name` can be one of the columns that carry positions: tells a header from data.
pub(super) fn names_position(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    POSITION.contains(&name.as_str()) || triples(POSITION_BASES).any(|n| n.contains(&name))
}

impl Table {
    /// Lists an attribute, and says whether its numbers are wanted.
    pub(super) fn list(&mut self, name: &str, components: usize, ty: AttributeType) -> bool {
        self.attributes.push(Attribute { name: name.into(), components, ty });
        wanted(name)
    }

    pub(super) fn push(&mut self, name: &str, components: usize, data: Data) {
        self.columns.push(Column { name: name.into(), components, data });
    }

    /// Takes out the first column of one of these names and this number of components.
    fn find(&mut self, names: &[&str], components: usize) -> Option<Column> {
        for name in names {
            let found = self.columns.iter().position(|c| {
                c.components == components && c.name.trim().eq_ignore_ascii_case(name)
            });
            if let Some(i) = found {
                return Some(self.columns.swap_remove(i));
            }
        }
        None
    }

    /// Takes out a vector: one column of three components, or three scalar columns.
    fn find_vector(
        &mut self,
        names: &[&str],
        split: impl Iterator<Item = [String; 3]>,
    ) -> Option<Vector> {
        if let Some(column) = self.find(names, 3) {
            return Some(Vector::Whole(column));
        }
        for names in split {
            let has = |name: &String| {
                self.columns
                    .iter()
                    .any(|c| c.components == 1 && c.name.trim().eq_ignore_ascii_case(name))
            };
            if names.iter().all(has) {
                let [x, y, z] = names.map(|name| self.find(&[name.as_str()], 1));
                if let (Some(x), Some(y), Some(z)) = (x, y, z) {
                    return Some(Vector::Split(Box::new([x, y, z])));
                }
            }
        }
        None
    }

    /// Checks the lengths and gives the columns their meaning.
    pub(super) fn assemble(mut self, format: Format) -> Result<Particles, ReadError> {
        let positions = match self.positions.take() {
            Some(data) => {
                Some(Vector::Whole(Column { name: "positions".into(), components: 3, data }))
            }
            None => self.find_vector(POSITION, triples(POSITION_BASES)),
        };
        let Some(positions) = positions else {
            let names: Vec<_> = self.attributes.iter().map(Attribute::to_string).collect();
            return Err(ReadError::NoPositions {
                expected: POSITION_NAMES,
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
        let rows = positions.rows()?;
        let mut warnings = std::mem::take(&mut self.warnings);
        warnings.extend(positions.resolution_warning(rows));
        let positions = positions.to_f32(rows);
        let bad = super::count_non_finite(&positions);
        if bad > 0 {
            warnings.push(format!(
                "{bad} of {rows} positions are not finite (NaN or infinite, or too large for 32 bits); they are not drawn"
            ));
        }

        let velocity = self.find_vector(VELOCITY, triples(VELOCITY).chain(std::iter::once(uvw())));
        let velocities = match velocity {
            Some(v) => {
                v.check(rows)?;
                Some(v.to_f32(rows))
            }
            None => None,
        };
        let densities = self.scalar(DENSITY, rows)?.map(|c| c.to_f32(rows));
        let lifetimes = self.scalar(LIFETIME, rows)?.map(|c| c.to_f32(rows));
        let ids = self.scalar(ID, rows)?.and_then(|c| c.to_u32(rows, &mut warnings));
        let kinds = self.scalar(KIND, rows)?.and_then(|c| c.to_u32(rows, &mut warnings));
        Ok(Particles {
            positions,
            velocities,
            densities,
            ids,
            lifetimes,
            kinds,
            attributes: self.attributes,
            format,
            warnings,
        })
    }

    fn scalar(&mut self, names: &[&str], rows: usize) -> Result<Option<Column>, ReadError> {
        let column = self.find(names, 1);
        if let Some(column) = &column {
            column.check(rows)?;
        }
        Ok(column)
    }
}

impl Column {
    fn check(&self, rows: usize) -> Result<(), ReadError> {
        let expected = rows as u64 * self.components as u64;
        if self.data.len() as u64 != expected {
            return Err(ReadError::Length {
                attribute: self.name.clone(),
                expected,
                found: self.data.len() as u64,
            });
        }
        Ok(())
    }

    fn to_f32(&self, rows: usize) -> Vec<f32> {
        (0..rows).filter_map(|i| self.data.f32(i)).collect()
    }

    fn to_u32(&self, rows: usize, warnings: &mut Vec<String>) -> Option<Vec<u32>> {
        let values: Vec<u32> = (0..rows).map_while(|i| self.data.u32(i)).collect();
        if values.len() < rows {
            let value = self.data.f64(values.len()).unwrap_or(f64::NAN);
            warnings.push(format!(
                "attribute `{}` is dropped: value {value} of particle {} is no whole number from 0 to {}",
                self.name,
                values.len(),
                u32::MAX
            ));
            return None;
        }
        Some(values)
    }
}

enum Vector {
    Whole(Column),
    Split(Box<[Column; 3]>),
}

impl Vector {
    /// How many particles there are, where this is the positions.
    fn rows(&self) -> Result<usize, ReadError> {
        match self {
            Self::Whole(c) if c.data.len().is_multiple_of(3) => Ok(c.data.len() / 3),
            Self::Whole(c) => Err(ReadError::malformed(
                format!("three values per particle for `{}`", c.name),
                format!("{} values", c.data.len()),
                Place::Unknown,
            )),
            Self::Split(columns) => {
                let [x, y, z] = columns.as_ref();
                let rows = x.data.len();
                y.check(rows)?;
                z.check(rows)?;
                Ok(rows)
            }
        }
    }

    fn check(&self, rows: usize) -> Result<(), ReadError> {
        match self {
            Self::Whole(c) => c.check(rows),
            Self::Split(columns) => columns.iter().try_for_each(|c| c.check(rows)),
        }
    }

    fn f64(&self, i: usize) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            match self {
                Self::Whole(c) => c.data.f64(3 * i + k),
                Self::Split(c) => c.get(k).and_then(|c| c.data.f64(i)),
            }
            .unwrap_or(f64::NAN)
        })
    }

    fn to_f32(&self, rows: usize) -> Vec<[f32; 3]> {
        if let Self::Whole(Column { data: Data::F32(v), .. }) = self {
            return v.as_chunks::<3>().0.to_vec();
        }
        (0..rows).map(|i| self.f64(i).map(|c| c as f32)).collect()
    }

    /// Says where the bulk lies so far out that 32-bit floats cannot tell particles apart.
    fn resolution_warning(&self, rows: usize) -> Option<String> {
        let step = rows.div_ceil(4096).max(1);
        let samples: Vec<_> = (0..rows).step_by(step).map(|i| self.f64(i)).collect();
        let mut extent = 0.0_f64;
        let mut reach = 0.0_f64;
        for axis in 0..3 {
            let mut sorted: Vec<f64> = samples
                .iter()
                .filter_map(|p| p.get(axis).copied())
                .filter(|c| c.is_finite())
                .collect();
            sorted.sort_unstable_by(f64::total_cmp);
            // From the 5th to the 95th percentile: a few strays say nothing about the bulk.
            let cut = sorted.len() / 20;
            let low = sorted.get(cut)?;
            let high = sorted.get(sorted.len() - 1 - cut)?;
            extent = extent.max(high - low);
            reach = reach.max(low.abs()).max(high.abs());
        }
        let resolution = reach * f64::from(f32::EPSILON);
        (extent > 0.0 && resolution > 1e-3 * extent).then(|| {
            format!(
                "the particles lie {reach:.3e} from the origin but span only {extent:.3e}: 32-bit positions are no finer \
                 than {resolution:.1e} there; move them to the origin before writing the file"
            )
        })
    }
}
