//! Reads JSON: an array of positions `[[x, y, z], ...]`, an array of particles `[{"position": [x, y, z],
//! "id": 7}, ...]`, or an object of arrays by name.
//!
//! The arrays of an object hold numbers or arrays of numbers: `{"positions": [[0, 0, 0]], "density": [1000]}`. In a
//! flat array the components of vectors follow one another. Vectors may be objects of lists: `{"position": {"x": [0],
//! "y": [0], "z": [0]}}`. Positions may be keyed by id: `{"7": [x, y, z], ...}`. An
//! object with particles in a single place, `{"meta": {...}, "run": {"particles": [...]}}`, is read as that place, see
//! `json_places`. A file with one JSON value
//! per line is read as an array of these. `null`, and Python's `NaN` and `Infinity`, are NaN. Comments, and commas
//! after the last value, are ignored. Houdini's JSON geometry begins with `"fileversion"` and is refused.
//!
//! A file with several frames is a list of such arrays or objects, an object that holds them by name
//! (`{"frame_1": ..}`), or an object of arrays with one more dimension (`{"positions": [[[x, y, z], ..], ..]}`): see
//! `json_frames`.

use std::collections::HashMap;

use serde_json::{Map, Value};

use super::asked::Asked;
use super::bytes::show;
use super::columns::{AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::names;
use super::source::Content;
use super::steps::Step;
use super::{Format, Particles, json_frames, json_places};

/// The frames of a file; empty for one frame.
pub(super) fn steps(content: &Content<'_>) -> Result<Vec<Step>, ReadError> {
    let mut bytes = Vec::new();
    content.open(0, content.length())?.fill(content.length(), &mut bytes)?;
    let value = value(&bytes)?;
    let times = json_frames::times(&value).into_iter().enumerate();
    let parts = json_frames::parts(&value, &bytes).unwrap_or_default();
    let part = |index: usize| parts.get(index).copied();
    Ok(times.map(|(index, time)| Step { part: part(index), ..Step::new(index, time) }).collect())
}

/// Reads the requested frame at its position in the file; `None` if the position is unknown, or if the bytes there are
/// no frame any more.
pub(super) fn read_part(content: &Content<'_>, asked: &Asked) -> Option<Particles> {
    let step = asked.step()?;
    let text = step.part?.text(|start, end| {
        let mut bytes = Vec::new();
        content.open(start, end).and_then(|mut part| part.fill(end - start, &mut bytes)).ok()?;
        Some(bytes)
    })?;
    let mut read = of_value(value(&text).ok()?, asked).ok()?;
    read.time = read.time.or(step.time);
    Some(read)
}

fn value(bytes: &[u8]) -> Result<Value, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match parse(bytes) {
        // What is no strict JSON is replaced only after an error, because such files are rare and the
        // replacement takes a copy.
        Err(error) => match strict(bytes) {
            Some(bytes) => parse(&bytes),
            None => Err(error),
        },
        Ok(value) => Ok(value),
    }
}

pub(super) fn read(bytes: &[u8], asked: &Asked) -> Result<Particles, ReadError> {
    let value = value(bytes)?;
    let value = match asked.step() {
        Some(step) => json_frames::one(value, step.index),
        None => value,
    };
    of_value(value, asked)
}

fn of_value(value: Value, asked: &Asked) -> Result<Particles, ReadError> {
    let value = json_frames::alone(value);
    let mut table = Table::new(asked);
    if let Value::Object(map) = &value {
        table.time = json_frames::time(map);
    }
    match value {
        Value::Array(rows) => list(rows, &mut table)?,
        Value::Object(map) => object(map, &mut table)?,
        other => {
            return Err(ReadError::json(
                "an array of positions or an object of arrays",
                show(other.to_string().as_bytes()),
            ));
        }
    }
    table.assemble(Format::Json)
}

/// Parses one value, or one value per line, which become an array.
fn parse(bytes: &[u8]) -> Result<Value, ReadError> {
    let mut values = serde_json::Deserializer::from_slice(bytes).into_iter::<Value>();
    let bad = |e: serde_json::Error| {
        if e.is_eof() {
            let what = "the JSON, up to the end of its first list or object,";
            return ReadError::truncated(what, bytes.len(), 1, 0);
        }
        ReadError::malformed("JSON", e.to_string(), Place::Line(e.line() as u64))
    };
    let Some(first) = values.next() else {
        return Err(ReadError::malformed("JSON", "nothing", Place::Line(1)));
    };
    let first = first.map_err(bad)?;
    let Some(second) = values.next() else { return Ok(first) };
    let mut rows = vec![first, second.map_err(bad)?];
    for value in values {
        rows.push(value.map_err(bad)?);
    }
    Ok(Value::Array(rows))
}

/// The text with `null` in place of Python's non-JSON numbers, without comments and without commas after the last
/// value; `None` if it has none of these.
fn strict(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(bytes.len());
    let mut rest = bytes;
    let mut quoted = false;
    let mut found = false;
    while let Some((&byte, behind)) = rest.split_first() {
        if quoted && byte == b'\\' {
            let (pair, after) = rest.split_at_checked(2).unwrap_or((rest, &[]));
            out.extend(pair);
            rest = after;
            continue;
        }
        quoted ^= byte == b'"';
        if let (false, Some(comment)) = (quoted, comment(rest)) {
            rest = rest.get(comment..).unwrap_or_default();
            found = true;
            continue;
        }
        let value = || !matches!(out.trim_ascii_end().last(), None | Some(b'[' | b'{' | b','));
        if byte == b',' && !quoted && closes(behind) && value() {
            rest = behind;
            found = true;
            continue;
        }
        let words = [&b"NaN"[..], b"-Infinity", b"Infinity"];
        let word = words.iter().find(|word| !quoted && rest.starts_with(word));
        match word {
            Some(word) => {
                out.extend(b"null");
                rest = rest.get(word.len()..).unwrap_or_default();
                found = true;
            }
            None => {
                out.push(byte);
                rest = behind;
            }
        }
    }
    found.then_some(out)
}

/// The length of a comment at the beginning.
pub(super) fn comment(text: &[u8]) -> Option<usize> {
    let end = |mark: &[u8]| text.windows(mark.len()).skip(2).position(|part| part == mark);
    if text.starts_with(b"//") {
        return Some(text.iter().position(|b| *b == b'\n').unwrap_or(text.len()));
    }
    text.starts_with(b"/*").then(|| end(b"*/").map_or(text.len(), |at| at + 4))
}

/// Whether the next character of `text`, after white space and comments, closes an array or object (`]` or `}`).
fn closes(mut text: &[u8]) -> bool {
    loop {
        text = text.trim_ascii_start();
        match comment(text) {
            Some(length) => text = text.get(length..).unwrap_or_default(),
            None => return matches!(text.first(), Some(b']' | b'}')),
        }
    }
}

/// Reads rows that are positions, or particles as objects.
fn list(mut rows: Vec<Value>, table: &mut Table) -> Result<(), ReadError> {
    // A list with one frame.
    while let [Value::Array(inner)] = rows.as_mut_slice() {
        if !inner.first().is_some_and(|first| first.is_array() || first.is_object()) {
            break;
        }
        rows = std::mem::take(inner);
    }
    if rows.first().and_then(Value::as_str) == Some("fileversion") {
        return Err(ReadError::Unsupported {
            what: "Houdini's JSON geometry (GEO of Houdini 12 and later)".into(),
            advice: "save classic BGEO (File Cache with the extension .bhclassic, or Partio), VTU, PLY or NPZ",
        });
    }
    if rows.first().is_some_and(Value::is_object) {
        return particles(rows, table);
    }
    several_frames(&rows, "the array")?;
    table.list("position", 3, AttributeType::Number);
    let (components, data) = numbers("position", &rows)?;
    if components > 3 {
        table.warnings.push(format!(
            "no names: the first 3 of {components} numbers of each particle are taken as positions, the others are not read"
        ));
        table.positions = Some((3, data.some(components, 3)));
        return Ok(());
    }
    let (components, data) = vectors("position", components, data)?;
    table.positions = Some((components, data));
    Ok(())
}

/// Converts tables as pandas writes them. Returns rows as objects if the table is a list of column names and a list of
/// rows, or rows keyed by row name. Otherwise returns `None`; columns whose values are keyed by row name then have
/// become arrays in `map`.
fn of_pandas(map: &mut Map<String, Value>, asked: &Asked) -> Option<Vec<Value>> {
    if let (Some(Value::Array(names)), Some(Value::Array(_))) =
        (map.get("columns"), map.get("data"))
    {
        let names: Vec<String> =
            names.iter().map(|name| Some(name.as_str()?.to_string())).collect::<Option<_>>()?;
        let Some(Value::Array(rows)) = map.remove("data") else { return None };
        let named = |row: Value| match row {
            Value::Array(row) => Value::Object(names.iter().cloned().zip(row).collect()),
            row => row,
        };
        return Some(rows.into_iter().map(named).collect());
    }
    let columns: Vec<_> =
        map.iter().filter(|(name, value)| asked.wants(name) && value.is_object()).collect();
    // Such an object may also hold the particles.
    let holds = columns.iter().any(|(_, v)| v.as_object().is_some_and(json_places::has_positions));
    let columns: Vec<_> = columns.into_iter().filter(|_| !holds).collect();
    let names: Vec<_> = columns.iter().map(|(name, _)| *name).collect();
    if names::may_have_positions(&names) {
        for value in map.values_mut() {
            if let Value::Object(rows) = value {
                *value = Value::Array(
                    std::mem::take(rows).into_iter().map(|(_, value)| value).collect(),
                );
            }
        }
        return None;
    }
    // A row has numbers and short vectors.
    let small = |value: &Value| {
        !value.is_object()
            && value.as_array().is_none_or(|v| v.len() <= 3 && v.iter().all(Value::is_number))
    };
    let particle = |value: &Value| {
        value.as_object().is_some_and(|row| {
            let names: Vec<_> = row.keys().collect();
            names::may_have_positions(&names) && row.values().all(small)
        })
    };
    (map.len() > 1 && map.values().all(particle))
        .then(|| std::mem::take(map).into_iter().map(|(_, row)| row).collect())
}

/// Positions keyed by id, as rows; `None` if any key is not an id or any value is not a position.
fn by_id(map: &mut Map<String, Value>) -> Option<Vec<Value>> {
    let position = |value: &Value| {
        value.as_array().is_some_and(|v| matches!(v.len(), 2 | 3) && v.iter().all(Value::is_number))
    };
    let are = map.iter().all(|(key, value)| key.parse::<u32>().is_ok() && position(value));
    let row = |(id, position): (String, Value)| {
        let id = id.parse::<u32>().unwrap_or_default().into();
        Value::Object(Map::from_iter([("id".into(), id), ("position".into(), position)]))
    };
    (are && !map.is_empty()).then(|| std::mem::take(map).into_iter().map(row).collect())
}

/// Interprets an array as vectors, nested or flat.
fn vectors(name: &str, components: usize, data: Data) -> Result<(usize, Data), ReadError> {
    match components {
        2 | 3 => Ok((components, data)),
        1 if data.len() == 0 || data.len().is_multiple_of(3) => Ok((3, data)),
        1 => Err(ReadError::Unsupported {
            what: format!("a flat list `{name}` of {} numbers that are not triples", data.len()),
            advice: "write a list of [x, y, z] for each particle",
        }),
        _ => Err(shape(name, "three numbers for each particle", components)),
    }
}

/// Refuses arrays of arrays of vectors, which are several frames.
fn several_frames(rows: &[Value], what: &str) -> Result<(), ReadError> {
    let inner = rows.first().and_then(Value::as_array).and_then(|row| row.first());
    if inner.is_some_and(|inner| inner.is_array() || inner.is_object()) {
        return Err(ReadError::Unsupported {
            what: format!(
                "a file of several frames ({what} has {} lists of particles)",
                rows.len()
            ),
            advice: "write one file per frame, with the frame's number in its name",
        });
    }
    Ok(())
}

/// An attribute of particles that are objects.
struct Field<'a> {
    name: &'a str,
    /// Its first value that is not `null`.
    first: &'a Value,
    /// Number of particles that have it.
    count: usize,
    /// A value that is no number.
    word: Option<&'a Value>,
}

impl Field<'_> {
    /// Whether the attribute is text: an error in positions, velocities and densities, unless it begins with text.
    fn is_text(&self) -> bool {
        self.word.is_some() && (self.first.is_string() || names::may_be_text(self.name))
    }

    /// Whether no particle may lack it.
    fn is_needed(&self) -> bool {
        let long = names::plain(self.name).len() > 1;
        (names::is_position(self.name) && long) || names::is_component(self.name)
    }
}

/// The attributes of particles that are objects, in the order in which they are found.
fn fields(rows: &[Value]) -> Result<Vec<Field<'_>>, ReadError> {
    let mut fields: Vec<Field<'_>> = Vec::new();
    let mut indices: HashMap<&str, usize> = HashMap::new();
    for row in rows {
        let Value::Object(row) = row else {
            return Err(ReadError::json(
                "an object for each particle, like the first",
                show(row.to_string().as_bytes()),
            ));
        };
        for (name, value) in row {
            let index = *indices.entry(name.as_str()).or_insert(fields.len());
            if index == fields.len() {
                fields.push(Field { name, first: value, count: 0, word: None });
            }
            let Some(field) = fields.get_mut(index) else { continue };
            field.count += 1;
            if field.first.is_null() {
                field.first = value;
            }
            field.word = field.word.or_else(|| word(value));
        }
    }
    Ok(fields)
}

/// Reads particles that are objects.
fn particles(rows: Vec<Value>, table: &mut Table) -> Result<(), ReadError> {
    if let Some(Value::Object(first)) = rows.first()
        && let Some((name, _)) = first.iter().find(|(_, value)| is_list_of_particles(value))
    {
        return Err(ReadError::Unsupported {
            what: format!("a file of {} frames (a list `{name}` in each)", rows.len()),
            advice: "write one file per frame, with the frame's number in its name",
        });
    }
    let mut columns: Vec<(String, Vec<Value>)> = Vec::new();
    for field in fields(&rows)? {
        let components = components(field.first).map_or(1, |vector| vector.len());
        let text = field.is_text();
        let ty = if text { AttributeType::Text } else { AttributeType::Number };
        let wanted = table.list(field.name, components, ty);
        if text {
            table.warnings.extend(unused_words(field.name, field.word));
            continue;
        }
        if !wanted {
            continue;
        }
        if field.count < rows.len() && field.is_needed() {
            return Err(ReadError::Length {
                attribute: field.name.into(),
                expected: rows.len() as u64,
                found: field.count as u64,
            });
        }
        // Missing values become NaN. Many names of which each is in few particles would take a lot of memory.
        if field.count.saturating_mul(2) < rows.len() {
            table.warnings.push(format!(
                "attribute `{}` is dropped: only {} of {} particles have it",
                field.name,
                field.count,
                rows.len()
            ));
            continue;
        }
        columns.push((field.name.into(), Vec::new()));
    }
    for row in rows {
        let Value::Object(mut row) = row else { continue };
        for (name, values) in &mut columns {
            values.push(row.remove(name.as_str()).unwrap_or_default());
        }
    }
    for (name, values) in columns {
        let (components, data) = numbers(&name, &values)?;
        table.push(&name, components, data);
    }
    Ok(())
}

/// Whether a value is a list of objects or of lists.
pub(super) fn is_list_of_particles(value: &Value) -> bool {
    let first = value.as_array().and_then(|list| list.first());
    first.is_some_and(|first| first.is_object() || first.is_array())
}

fn object(mut map: Map<String, Value>, table: &mut Table) -> Result<(), ReadError> {
    if map.contains_key("file-series-version") {
        return Err(ReadError::Unsupported {
            what: "a list of the files of a sequence".into(),
            advice: "name it .series, with the files beside it",
        });
    }
    interleave(&mut map)?;
    let rows = of_pandas(&mut map, &table.asked).or_else(|| by_id(&mut map));
    if let Some(rows) = rows {
        return list(rows, table);
    }
    if !json_places::has_positions(&map) {
        // The particles may be deeper.
        if let Some((value, time)) = json_places::only(&mut map, &mut table.warnings)? {
            table.time = table.time.or(time);
            return match value {
                Value::Array(rows) if rows.first().is_some_and(Value::is_array) => {
                    several_frames(&rows, "the list of particles")?;
                    list(rows, table)
                }
                Value::Array(rows) => list(rows, table),
                Value::Object(map) => object(map, table),
                _ => Ok(()),
            };
        }
        let mut inner: Vec<_> = map
            .into_iter()
            .filter(|(_, value)| value.is_object() || is_list_of_particles(value))
            .collect();
        if let [(_, value)] = inner.as_mut_slice() {
            return match std::mem::take(value) {
                Value::Array(rows) => list(rows, table),
                Value::Object(map) => object(map, table),
                _ => Ok(()),
            };
        }
        for (name, _) in inner {
            table.list(&name, 1, AttributeType::Other);
        }
        return Ok(());
    }
    let mut flat = Vec::new();
    for (name, value) in map {
        let Value::Array(rows) = value else { continue };
        let found = if names::may_be_text(&name) { rows.iter().find_map(word) } else { None };
        if found.is_some() {
            let components = rows.iter().find_map(components).map_or(1, |first| first.len());
            table.list(&name, components, AttributeType::Text);
            table.warnings.extend(unused_words(&name, found));
            continue;
        }
        if !table.asked.wants(&name) {
            let components = rows.first().and_then(Value::as_array).map_or(1, Vec::len);
            table.list(&name, components, AttributeType::Number);
            continue;
        }
        several_frames(&rows, &format!("`{name}`"))?;
        let (mut components, mut data) = numbers(&name, &rows)?;
        // `x` may be a list of vectors or of their first components, so a flat list of that name is not split
        // into vectors.
        let alone = names::plain(&name) != "x" && names::plain(&name).len() > 1;
        if components == 1 && names::is_vector(&name) && alone {
            if !names::is_position(&name) {
                flat.push((name, data));
                continue;
            }
            (components, data) = vectors(&name, components, data)?;
        }
        table.list(&name, components, AttributeType::Number);
        table.push(&name, components, data);
    }
    let position = |name: &str| names::is_position(name) || names::is_component(name);
    let positions = table.columns.iter().find(|column| position(&column.name));
    let count = positions.map(|column| column.data.len() / column.components.max(1));
    for (name, data) in flat {
        // A list with one number for each particle is a magnitude, such as a speed.
        let (components, data) = match count {
            Some(count) if count == data.len() => (1, data),
            _ => vectors(&name, 1, data)?,
        };
        table.list(&name, components, AttributeType::Number);
        table.push(&name, components, data);
    }
    Ok(())
}

/// The lists of a vector that is an object of them.
pub(super) fn lists(value: &Value) -> Option<Vec<&Vec<Value>>> {
    let map = value.as_object()?;
    let parts = components(value).filter(|parts| parts.len() == map.len())?;
    let numbers = |list: &&Vec<Value>| {
        list.first().is_none_or(|first| !first.is_array() && !first.is_object())
    };
    parts.into_iter().map(|part| part.as_array().filter(numbers)).collect()
}

/// Turns positions and velocities that are objects of lists into lists of vectors.
fn interleave(map: &mut Map<String, Value>) -> Result<(), ReadError> {
    for (name, value) in map.iter_mut().filter(|(name, _)| names::is_vector(name)) {
        let Some(lists) = lists(value) else { continue };
        let lengths: Vec<usize> = lists.iter().map(|list| list.len()).collect();
        let count = lengths.first().copied().unwrap_or(0);
        if lengths.iter().any(|length| *length != count) {
            return Err(ReadError::json(
                format!("as many numbers in x, y and z of `{name}`"),
                format!("{lengths:?}"),
            ));
        }
        let mut rows = Vec::with_capacity(count);
        for i in 0..count {
            let vector: Vec<Value> = lists.iter().filter_map(|list| list.get(i).cloned()).collect();
            rows.push(Value::Array(vector));
        }
        *value = Value::Array(rows);
    }
    Ok(())
}

/// A value that is no number: text, or `true` and `false`, also inside a vector.
fn word(value: &Value) -> Option<&Value> {
    match value {
        Value::String(text) => text.trim().parse::<f64>().is_err().then_some(value),
        Value::Bool(_) => Some(value),
        Value::Array(all) => all.iter().filter(|value| value.is_string()).find_map(word),
        _ => None,
    }
}

/// Warning about an attribute with a meaning whose values are words.
fn unused_words(name: &str, word: Option<&Value>) -> Option<String> {
    let word = word.filter(|_| names::known(&names::plain(name)))?;
    let found = word.as_str().map_or_else(|| word.to_string(), String::from);
    let found = show(found.as_bytes());
    Some(format!("`{name}` is not used: not all of its values are numbers ({found})"))
}

fn shape(name: &str, expected: &str, components: usize) -> ReadError {
    ReadError::json(format!("{expected} in `{name}`"), format!("{components}"))
}

/// The components of a vector: an array, or an object.
fn components(value: &Value) -> Option<Vec<&Value>> {
    match value {
        Value::Array(all) => Some(all.iter().collect()),
        Value::Object(all) => {
            let component = |lower: &str, upper: &str| all.get(lower).or_else(|| all.get(upper));
            let [x, y, z] = [("x", "X"), ("y", "Y"), ("z", "Z")].map(|(l, u)| component(l, u));
            Some([Some(x?), Some(y?), z].into_iter().flatten().collect())
        }
        _ => None,
    }
}

/// The values of an array, and their number per row.
fn numbers(name: &str, rows: &[Value]) -> Result<(usize, Data), ReadError> {
    let number = |value: &Value| match value {
        Value::Null => Ok(f64::NAN),
        // Some programs write numbers as strings, most often `"NaN"`.
        Value::String(text) if text.trim().parse::<f64>().is_ok() => {
            Ok(text.trim().parse().unwrap_or(f64::NAN))
        }
        value => value.as_f64().ok_or_else(|| {
            ReadError::json(format!("numbers in `{name}`"), show(value.to_string().as_bytes()))
        }),
    };
    let first = rows.iter().find(|row| !row.is_null());
    let components = first.and_then(components).map(|first| first.len());
    // Grown as needed, because the first row may be the only long one.
    let mut values = Vec::new();
    for row in rows {
        let vector = components.and_then(|_| self::components(row));
        match (vector, components) {
            (Some(row), Some(components)) => {
                if row.len() != components {
                    let expected = format!("{components} numbers in each row, as in the first");
                    return Err(shape(name, &expected, row.len()));
                }
                for value in row {
                    values.push(number(value)?);
                }
            }
            (_, None) => values.push(number(row)?),
            // A few `null` may not stand for many numbers.
            (None, Some(components @ 0..=3)) if row.is_null() => {
                values.extend(std::iter::repeat_n(f64::NAN, components));
            }
            (None, Some(_)) => {
                return Err(ReadError::json(
                    format!("arrays in `{name}`, like the first"),
                    show(row.to_string().as_bytes()),
                ));
            }
        }
    }
    Ok((components.unwrap_or(1), Data::F64(values)))
}
