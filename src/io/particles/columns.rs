//! From named columns of numbers to [`Particles`]: which names mean what, and checks that hold for all formats.

use super::error::{Place, ReadError};
use super::names::{self, Names};
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
    const NONE: Self = Self::F32(Vec::new());

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

    /// Makes room for some more of `all` that there will be, without room for those that may never come: it grows
    /// with what is there, and not beyond all of them.
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

    pub(super) fn clear(&mut self) {
        match self {
            Self::F32(v) => v.clear(),
            Self::F64(v) => v.clear(),
            Self::Int(v) => v.clear(),
        }
    }

    /// Whether numbers of another type can stand among these.
    pub(super) fn takes(&self, ty: AttributeType) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(&Self::for_type(ty))
    }

    /// All of them, without a copy where they are stored so.
    fn into_f32(self) -> Vec<f32> {
        match self {
            Self::F32(v) => v,
            Self::F64(v) => v.into_iter().map(|x| x as f32).collect(),
            Self::Int(v) => v.into_iter().map(|x| x as f32).collect(),
        }
    }

    /// All of them, or the index of the first that is no whole number or doesn't fit.
    fn to_u32(&self) -> Result<Vec<u32>, usize> {
        let mut values = Vec::with_capacity(self.len());
        values.extend((0..self.len()).map_while(|i| self.u32(i)));
        if values.len() < self.len() { Err(values.len()) } else { Ok(values) }
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
        bytes::parse_number(token).is_some_and(|x| self.push_number(x))
    }

    /// Appends a number; false where these are whole ones.
    pub(super) fn push_number(&mut self, x: f64) -> bool {
        match self {
            Self::F64(v) => v.push(x),
            Self::F32(v) => v.push(x as f32),
            Self::Int(_) => return false,
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

/// Lists an attribute, and says whether its numbers are wanted.
pub(super) fn list(
    attributes: &mut Vec<Attribute>,
    name: &str,
    components: usize,
    ty: AttributeType,
) -> bool {
    attributes.push(Attribute { name: name.into(), components, ty });
    names::wanted(name)
}

impl Table {
    /// Lists an attribute, and says whether its numbers are wanted.
    pub(super) fn list(&mut self, name: &str, components: usize, ty: AttributeType) -> bool {
        list(&mut self.attributes, name, components, ty)
    }

    pub(super) fn push(&mut self, name: &str, components: usize, data: Data) {
        self.columns.push(Column { name: name.into(), components, data });
    }

    /// Checks the lengths and gives the columns their meaning.
    pub(super) fn assemble(mut self, format: Format) -> Result<Particles, ReadError> {
        let placed = self.positions.take().map(|data| {
            self.push(PLACED, 3, data);
            self.columns.len() - 1
        });
        let shapes: Vec<_> = self.columns.iter().map(Column::shape).collect();
        let roles = Roles::find(&shapes, placed, &self.attributes)?;
        roles.rows(&shapes)?;
        self.warnings.extend(roles.warnings());
        let mut survey = Survey::default();
        let particles = survey.part(&roles, self.columns, format);
        self.warnings.extend(survey.warnings());
        Ok(Particles { attributes: self.attributes, warnings: self.warnings, ..particles })
    }
}

/// The name of positions that have none, but a place of their own.
pub(super) const PLACED: &str = "positions";

impl Column {
    /// Without numbers yet.
    pub(super) fn new(name: &str, components: usize, ty: AttributeType) -> Self {
        Self { name: name.into(), components, data: Data::for_type(ty) }
    }

    fn shape(&self) -> Shape<'_> {
        Shape { name: &self.name, components: self.components, values: self.data.len() as u64 }
    }
}

/// What tells the meaning of a column: known of a file's header before there are any numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape<'a> {
    pub(super) name: &'a str,
    pub(super) components: usize,
    /// Of all particles together.
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

/// A column of three components or of two, or one column for each, by their indices. What is missing is 0.
#[derive(Debug, Clone, Copy)]
enum Vector {
    Whole(usize, usize),
    Split([Option<usize>; 3]),
}

impl Vector {
    fn is_flat(self) -> bool {
        match self {
            Self::Whole(_, components) => components < 3,
            Self::Split(columns) => columns.contains(&None),
        }
    }

    fn columns(self) -> impl Iterator<Item = usize> {
        let columns = match self {
            Self::Whole(column, _) => [Some(column), None, None],
            Self::Split(columns) => columns,
        };
        columns.into_iter().flatten()
    }
}

/// Which column is what, by its index. Of two of one name it is the first.
#[derive(Debug)]
pub(super) struct Roles {
    positions: Vector,
    velocities: Option<Vector>,
    densities: Option<usize>,
    lifetimes: Option<usize>,
    ids: Option<usize>,
    kinds: Option<usize>,
}

/// What is looked for among the columns of a file.
struct Search<'a> {
    shapes: &'a [Shape<'a>],
    /// Their names, as [`names::plain`] gives them.
    plain: Vec<String>,
}

impl<'a> Search<'a> {
    fn new(shapes: &'a [Shape<'a>]) -> Self {
        Self { shapes, plain: shapes.iter().map(|shape| names::plain(shape.name)).collect() }
    }

    /// The first column of this name that has this number of components.
    fn one(&self, name: &str, components: usize) -> Option<usize> {
        let mut all = self.shapes.iter().zip(&self.plain);
        all.position(|(shape, plain)| shape.components == components && plain == name)
    }

    fn scalar(&self, names: Names) -> Option<usize> {
        names.iter().find_map(|name| self.one(name, 1))
    }

    /// A vector: one column of three components, or three scalar columns; or else of two dimensions.
    fn vector(&self, names: Names) -> Option<Vector> {
        let whole = |components| {
            let column = names.iter().find_map(|name| self.one(name, components))?;
            Some(Vector::Whole(column, components))
        };
        let split = || names::triples(names).map(|n| n.map(|name| self.one(&name, 1)));
        let of_three = || split().find(|columns| !columns.contains(&None)).map(Vector::Split);
        let of_two = || {
            let mut split = split();
            let found = split.find(|[x, y, z]| x.is_some() && (y.is_some() || z.is_some()));
            found.map(Vector::Split)
        };
        whole(3).or_else(of_three).or_else(|| whole(2)).or_else(of_two)
    }
}

impl Roles {
    /// `placed`: the positions, where the format has a place for them.
    pub(super) fn find(
        shapes: &[Shape<'_>],
        placed: Option<usize>,
        attributes: &[Attribute],
    ) -> Result<Self, ReadError> {
        let search = Search::new(shapes);
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
        Ok(Self {
            positions,
            velocities: search.vector(names::VELOCITY),
            densities: search.scalar(names::DENSITY),
            lifetimes: search.scalar(names::LIFETIME),
            ids: search.scalar(names::ID),
            kinds: search.scalar(names::KIND),
        })
    }

    /// What a user should know of them.
    pub(super) fn warnings(&self) -> impl Iterator<Item = String> {
        self.positions
            .is_flat()
            .then(|| "positions have two components: the third is taken as 0".to_string())
            .into_iter()
    }

    /// How many particles there are: as many as positions, and as what else there is.
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
            Vector::Split([x, ..]) => x.and_then(|x| shapes.get(x)).map_or(0, |shape| shape.values),
        };
        for shape in self.used().filter_map(|i| shapes.get(i)) {
            shape.check(rows)?;
        }
        usize::try_from(rows).map_err(|_| ReadError::TooLarge {
            what: "the list of particles".into(),
            limit: usize::MAX as u64,
        })
    }

    /// The columns that have a meaning, in the order in which they are checked.
    pub(super) fn used(&self) -> impl Iterator<Item = usize> {
        let vectors = [Some(self.positions), self.velocities].into_iter().flatten();
        let vectors = vectors.flat_map(Vector::columns);
        let scalars = [self.densities, self.lifetimes, self.ids, self.kinds];
        vectors.chain(scalars.into_iter().flatten())
    }
}

/// The columns of some particles.
struct Columns(Vec<Column>);

impl Columns {
    fn f64(&self, column: usize, i: usize) -> f64 {
        self.0.get(column).and_then(|c| c.data.f64(i)).unwrap_or(f64::NAN)
    }

    fn vector(&self, vector: Vector, i: usize) -> [f64; 3] {
        match vector {
            Vector::Whole(column, 3) => [0, 1, 2].map(|k| self.f64(column, 3 * i + k)),
            Vector::Whole(column, _) => [self.f64(column, 2 * i), self.f64(column, 2 * i + 1), 0.0],
            Vector::Split(columns) => columns.map(|c| c.map_or(0.0, |column| self.f64(column, i))),
        }
    }

    fn rows(&self, vector: Vector) -> usize {
        let values = |column: usize| self.0.get(column).map_or(0, |c| c.data.len());
        match vector {
            Vector::Whole(column, components) => values(column) / components.max(1),
            Vector::Split([x, ..]) => x.map_or(0, values),
        }
    }

    /// Numbers that are not needed any more are freed.
    fn take(&mut self, column: usize) -> Data {
        let taken = self.0.get_mut(column).map(|c| std::mem::replace(&mut c.data, Data::NONE));
        taken.unwrap_or(Data::NONE)
    }

    fn take_vectors(&mut self, vector: Vector) -> Vec<[f32; 3]> {
        let all = match vector {
            Vector::Whole(column, 3) => match self.0.get(column) {
                Some(Column { data: Data::F32(v), .. }) => Some(v.as_chunks::<3>().0.to_vec()),
                _ => None,
            },
            _ => None,
        };
        let all = all.unwrap_or_else(|| {
            (0..self.rows(vector)).map(|i| self.vector(vector, i).map(|c| c as f32)).collect()
        });
        vector.columns().for_each(|column| drop(self.take(column)));
        all
    }
}

/// Whole numbers that are none: an attribute that is dropped.
#[derive(Debug)]
struct Dropped {
    attribute: String,
    value: f64,
    particle: usize,
}

/// The most positions by which their reach is judged.
const SAMPLES: usize = 8192;

/// What is known of particles only when all were seen, whether they come at once or in parts.
#[derive(Debug)]
pub(super) struct Survey {
    seen: usize,
    /// Positions of a few thousand, evenly through the file, the first of each `step` particles.
    samples: Vec<[f64; 3]>,
    step: usize,
    not_finite: usize,
    ids: Option<Dropped>,
    kinds: Option<Dropped>,
}

impl Default for Survey {
    fn default() -> Self {
        Self { seen: 0, samples: Vec::new(), step: 1, not_finite: 0, ids: None, kinds: None }
    }
}

impl Survey {
    /// Particles until now.
    pub(super) fn seen(&self) -> usize {
        self.seen
    }

    /// Which they are is told by their number in the file alone: nobody knows yet how many will come.
    fn sample(&mut self, rows: usize, position: impl Fn(usize) -> [f64; 3]) {
        loop {
            let next = self.samples.len().saturating_mul(self.step);
            let Some(i) = next.checked_sub(self.seen).filter(|i| *i < rows) else { return };
            self.samples.push(position(i));
            if self.samples.len() == SAMPLES {
                let mut kept = false;
                self.samples.retain(|_| {
                    kept = !kept;
                    kept
                });
                self.step = self.step.saturating_mul(2);
            }
        }
    }

    /// Gives the columns of the particles that come next their meaning.
    pub(super) fn part(
        &mut self,
        roles: &Roles,
        columns: Vec<Column>,
        format: Format,
    ) -> Particles {
        let mut columns = Columns(columns);
        let rows = columns.rows(roles.positions);
        self.sample(rows, |i| columns.vector(roles.positions, i));
        let positions = columns.take_vectors(roles.positions);
        self.not_finite += super::count_non_finite(&positions);
        let velocities = roles.velocities.map(|v| columns.take_vectors(v));
        let mut scalar = |column: Option<usize>| column.map(|c| columns.take(c).into_f32());
        let (densities, lifetimes) = (scalar(roles.densities), scalar(roles.lifetimes));
        let mut whole = |column: Option<usize>, dropped: &mut Option<Dropped>| {
            let column = column?;
            let data = columns.take(column);
            let values = data.to_u32().map_err(|i| Dropped {
                attribute: columns.0.get(column).map_or(String::new(), |c| c.name.clone()),
                value: data.f64(i).unwrap_or(f64::NAN),
                particle: self.seen + i,
            });
            values.map_err(|first| dropped.get_or_insert(first)).ok()
        };
        let ids = whole(roles.ids, &mut self.ids);
        let kinds = whole(roles.kinds, &mut self.kinds);
        self.seen += rows;
        Particles {
            velocities,
            densities,
            ids,
            lifetimes,
            kinds,
            format,
            ..Particles::from_positions(positions)
        }
    }

    /// Takes out of a part, or of all of them, what the particles as a whole have not.
    pub(super) fn drop_from(&self, particles: &mut Particles) {
        if self.ids.is_some() {
            particles.ids = None;
        }
        if self.kinds.is_some() {
            particles.kinds = None;
        }
    }

    /// What a user should know, after the last part.
    pub(super) fn warnings(&self) -> Vec<String> {
        let not_finite = (self.not_finite > 0).then(|| {
            format!(
                "{} of {} positions are not finite (NaN or infinite, or too large for 32 bits); they are not drawn",
                self.not_finite, self.seen
            )
        });
        let dropped = [&self.ids, &self.kinds].into_iter().flatten().map(|dropped| {
            format!(
                "attribute `{}` is dropped: value {} of particle {} is no whole number from 0 to {}",
                dropped.attribute,
                dropped.value,
                dropped.particle,
                u32::MAX
            )
        });
        resolution_warning(&self.samples).into_iter().chain(not_finite).chain(dropped).collect()
    }
}

/// Says where the bulk lies so far out that 32-bit floats cannot tell particles apart.
fn resolution_warning(samples: &[[f64; 3]]) -> Option<String> {
    let mut extent = 0.0_f64;
    let mut reach = 0.0_f64;
    for axis in 0..3 {
        let mut sorted: Vec<f64> =
            samples.iter().filter_map(|p| p.get(axis).copied()).filter(|c| c.is_finite()).collect();
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
