//! Parses the header of a NumPy array: a Python dict, of which the three known keys are read.

use super::bytes::{Cursor, show};
use super::columns::AttributeType;
use super::error::{Place, ReadError};

/// A field of a structured array, or the whole of a plain one.
pub(super) struct Member {
    pub(super) name: String,
    pub(super) ty: AttributeType,
    pub(super) components: usize,
    /// Byte offset in an element.
    pub(super) offset: u64,
    pub(super) big_endian: bool,
}

/// The header of an array.
pub(super) struct Header {
    /// Fields; a plain array has one unnamed field.
    pub(super) members: Vec<Member>,
    pub(super) structured: bool,
    /// Bytes per element.
    pub(super) size: u64,
    pub(super) fortran: bool,
    /// The extents of the array; if it has more than two dimensions, those of size 1 are removed until two are left.
    pub(super) shape: Vec<u64>,
    pub(super) descr: String,
    /// Which frame to read, if the array holds several frames; `shape` is then that of one frame, without the
    /// dimension of the frames.
    pub(super) frame: Option<One>,
}

/// One of several frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct One {
    pub(super) index: u64,
    pub(super) count: u64,
}

/// Min number of columns from which on an array with 2 or 3 rows is taken as transposed: one column per particle
/// instead of one row.
pub(super) const WIDE: u64 = 8;

/// Min number of frames, and min ratio of frames to particles, from which on the dimensions of an array are taken
/// to be in another order.
const FRAMES: u64 = 500;
const RATIO: u64 = 10;

impl Header {
    /// Refuses an array that has far more frames than particles.
    pub(super) fn check_order(&self, name: &str) -> Result<(), ReadError> {
        let (frames, rows, advice) = match *self.shape.as_slice() {
            [frames, rows, 2 | 3 | 6] => (
                frames,
                rows,
                "the order is (frames, particles, 3): if it is another one, save np.swapaxes(a, 0, 1), otherwise save a \
                 file for each frame",
            ),
            [frames, 2 | 3, rows] => (
                frames,
                rows,
                "the order is (frames, 3, particles): if it is another one, save np.moveaxis(a, -1, 0), otherwise save a \
                 file for each frame",
            ),
            _ => return Ok(()),
        };
        if rows == 0 || frames < FRAMES || frames / rows < RATIO {
            return Ok(());
        }
        let shape: Vec<_> = self.shape.iter().map(u64::to_string).collect();
        Err(ReadError::Unsupported {
            what: format!(
                "array `{name}` of shape ({}), {frames} frames of {rows} particles,",
                shape.join(", ")
            ),
            advice,
        })
    }

    /// Length of all values in bytes.
    pub(super) fn bytes(&self) -> u64 {
        let frames = self.frame.map_or(1, |one| one.count).saturating_mul(self.size);
        self.shape.iter().fold(frames, |bytes, extent| bytes.saturating_mul(*extent))
    }

    /// Number of frames in an array that holds positions or, with `component`, one coordinate of them; `None` if the
    /// array has no dimension for frames, so is one frame.
    pub(super) fn frames(&self, component: bool) -> Option<u64> {
        match *self.shape.as_slice() {
            [frames, _, 2 | 3 | 6] if !self.structured => Some(frames),
            [frames, 2 | 3, rows] if !self.structured && rows >= WIDE => Some(frames),
            [frames, rows] if self.structured || (component && rows >= WIDE) => Some(frames),
            _ => None,
        }
    }

    /// Whether the first dimension of the array counts `count` frames. `vector` says that the array's name is that of
    /// a vector, so that an array of `count` rows and 2, 3 or 6 columns has one vector per particle, not an entry per
    /// frame.
    fn has_frames(&self, count: u64, vector: bool) -> bool {
        match *self.shape.as_slice() {
            [frames, _, _] => frames == count && !self.structured,
            [frames, columns] => {
                frames == count && (self.structured || !(vector && matches!(columns, 2 | 3 | 6)))
            }
            _ => false,
        }
    }

    /// Restricts the array to the frame `frame` if the array has an entry for each frame. Otherwise it is unchanged,
    /// because all frames share it.
    pub(super) fn of_frame(mut self, frame: Option<One>, vector: bool) -> Self {
        if let Some(one) = frame.filter(|one| self.has_frames(one.count, vector)) {
            self.shape.remove(0);
            self.frame = Some(one);
        }
        self
    }
}

/// Every `count`th element of `size` bytes, from element `index` on. In an array in Fortran order, whose first
/// dimension varies fastest, these are the elements of frame `index` of `count`.
pub(super) fn every(raw: &[u8], size: u64, one: One) -> Vec<u8> {
    let size = usize::try_from(size).unwrap_or(usize::MAX).max(1);
    let count = usize::try_from(one.count).unwrap_or(usize::MAX).max(1);
    let index = usize::try_from(one.index).unwrap_or(usize::MAX);
    let elements = raw.chunks_exact(size).skip(index).step_by(count);
    elements.flatten().copied().collect()
}

/// Parses the header of an array, up to its values.
pub(super) fn header(cursor: &mut Cursor<'_>) -> Result<Header, ReadError> {
    const WHAT: &str = "the header of an array";
    let magic = cursor.take(6, WHAT)?;
    if magic != b"\x93NUMPY" {
        return Err(ReadError::malformed(
            "an array that begins with \\x93NUMPY",
            show(magic),
            Place::Byte(0),
        ));
    }
    let [major, minor] = cursor.array::<2>(WHAT)?;
    let length = match major {
        1 => u64::from(u16::from_le_bytes(cursor.array(WHAT)?)),
        2 | 3 => u64::from(u32::from_le_bytes(cursor.array(WHAT)?)),
        _ => {
            return Err(ReadError::Unsupported {
                what: format!("NPY version {major}.{minor}"),
                advice: "save with numpy.save or numpy.savez",
            });
        }
    };
    let place = cursor.place();
    let raw = cursor.take(length, WHAT)?;
    let bad = |key: &str| ReadError::malformed(format!("`{key}` in {WHAT}"), show(raw), place);
    let text = std::str::from_utf8(raw).map_err(|_| bad("descr"))?;
    // The value of a key begins after the colon; a field of the same name has none.
    let value = |key: &str| {
        let quoted = format!("'{key}'");
        text.match_indices(quoted.as_str()).find_map(|(at, found)| {
            let behind = text.get(at + found.len()..)?;
            behind.trim_start().strip_prefix(':').map(str::trim_start)
        })
    };
    let descr = value("descr").ok_or_else(|| bad("descr"))?;
    let (members, size) = members(descr).ok_or_else(|| bad("descr"))?;
    let structured = descr.starts_with('[');
    let descr = match descr.strip_prefix('\'').and_then(|d| d.split_once('\'')) {
        Some((descr, _)) => descr.to_string(),
        None => "of several fields".to_string(),
    };
    let fortran = value("fortran_order").ok_or_else(|| bad("fortran_order"))?;
    let shape = value("shape")
        .and_then(|v| v.strip_prefix('(')?.split_once(')'))
        .ok_or_else(|| bad("shape"))?
        .0;
    let shape = shape
        .split(',')
        .map(str::trim)
        .filter(|n| !n.is_empty())
        .map(|n| n.trim_end_matches('L').parse())
        .collect::<Result<Vec<u64>, _>>()
        .map_err(|_| bad("shape"))?;
    let mut shape = shape;
    while shape.len() > 2
        && let Some(one) = shape.iter().position(|extent| *extent == 1)
    {
        shape.remove(one);
    }
    let fortran = fortran.starts_with("True");
    Ok(Header { members, structured, size, fortran, shape, descr, frame: None })
}

/// Fields of an element by its `descr`, and its size in bytes.
fn members(descr: &str) -> Option<(Vec<Member>, u64)> {
    let mut words = Words { rest: descr };
    if !descr.starts_with('[') {
        let (ty, size, big_endian) = scalar(words.text()?);
        let member = Member { name: String::new(), ty, components: 1, offset: 0, big_endian };
        return Some((vec![member], size));
    }
    let mut members = Vec::new();
    let size = words.fields("", NESTED, &mut members)?;
    Some((members, size))
}

/// Max depth of fields inside fields.
const NESTED: usize = 8;

/// Splits a Python list into words.
struct Words<'a> {
    rest: &'a str,
}

impl<'a> Words<'a> {
    fn sign(&mut self, sign: char) -> Option<()> {
        self.rest = self.rest.trim_start().strip_prefix(sign)?;
        Some(())
    }

    fn text(&mut self) -> Option<&'a str> {
        let rest = self.rest.trim_start();
        let quote = rest.chars().next().filter(|c| matches!(c, '\'' | '"'))?;
        let (text, behind) = rest.get(1..)?.split_once(quote)?;
        self.rest = behind;
        Some(text)
    }

    /// Reads a list of fields, whose names begin with `prefix`, and returns their size in bytes. Fields inside fields
    /// are named `outer.inner`.
    fn fields(&mut self, prefix: &str, depth: usize, members: &mut Vec<Member>) -> Option<u64> {
        let deeper = depth.checked_sub(1)?;
        self.sign('[')?;
        let mut offset = 0_u64;
        while self.sign('(').is_some() {
            // A name may be preceded by a title.
            let name = match self.sign('(') {
                Some(()) => {
                    self.text()?;
                    self.sign(',')?;
                    let name = self.text()?;
                    self.sign(')')?;
                    name
                }
                None => self.text()?,
            };
            self.sign(',')?;
            let name = format!("{prefix}{name}");
            let mut inner = Vec::new();
            let (ty, size, big_endian) = match self.rest.trim_start().starts_with('[') {
                true => {
                    let size = self.fields(&format!("{name}."), deeper, &mut inner)?;
                    (AttributeType::Other, size, false)
                }
                false => scalar(self.text()?),
            };
            let components = self.extents()?;
            self.sign(')')?;
            self.sign(',');
            if inner.is_empty() || components != 1 {
                let components = usize::try_from(components).ok()?;
                members.push(Member { name, ty, components, offset, big_endian });
            } else {
                for member in inner {
                    members.push(Member { offset: offset.checked_add(member.offset)?, ..member });
                }
            }
            offset = offset.checked_add(size.checked_mul(components)?)?;
        }
        self.sign(']')?;
        Some(offset)
    }

    /// Number of values in a field: the product of the extents after its type, or 1 if there are none.
    fn extents(&mut self) -> Option<u64> {
        if self.sign(',').is_none() {
            return Some(1);
        }
        if self.sign('(').is_none() {
            return Some(self.number().unwrap_or(1));
        }
        let mut components = 1_u64;
        while let Some(extent) = self.number() {
            components = components.checked_mul(extent)?;
            self.sign(',');
        }
        self.sign(')')?;
        Some(components)
    }

    fn number(&mut self) -> Option<u64> {
        let rest = self.rest.trim_start();
        let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let (digits, behind) = rest.split_at_checked(end)?;
        let number = digits.parse().ok()?;
        self.rest = behind.trim_start_matches('L');
        Some(number)
    }
}

/// Type of a number, its size in bytes, and whether it is big-endian.
fn scalar(descr: &str) -> (AttributeType, u64, bool) {
    let name = descr.trim_start_matches(['<', '>', '=', '|']);
    let ty = dtype(name);
    let digits = name.get(1..).unwrap_or_default();
    let digits = digits
        .find(|c: char| !c.is_ascii_digit())
        .and_then(|end| digits.get(..end))
        .unwrap_or(digits);
    let size = digits.parse().unwrap_or(0_u64);
    let size = if name.starts_with('U') { size.saturating_mul(4) } else { size };
    (ty, ty.size().unwrap_or(size), descr.starts_with('>'))
}

fn dtype(name: &str) -> AttributeType {
    use AttributeType as T;
    match name {
        "i1" => T::I8,
        "u1" | "b1" => T::U8,
        "i2" => T::I16,
        "u2" => T::U16,
        "i4" => T::I32,
        "u4" => T::U32,
        "i8" => T::I64,
        "u8" => T::U64,
        "f2" => T::F16,
        "f4" => T::F32,
        "f8" => T::F64,
        _ if name.starts_with(['U', 'S']) => T::Text,
        _ => T::Other,
    }
}
