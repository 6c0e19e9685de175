//! JSON: an array of positions `[[x, y, z], ...]`, or an object of arrays by name.
//!
//! In an object an array holds numbers or arrays of numbers: `{"positions": [[0, 0, 0]], "density": [1000]}`.
//! `null` is NaN. Houdini's geometry as JSON begins with `"fileversion"` and is refused.

use serde_json::Value;

use super::bytes::show;
use super::columns::{AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::names;
use super::{Format, Particles};

pub(super) fn read(bytes: &[u8]) -> Result<Particles, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let value: Value = serde_json::from_slice(bytes)
        .map_err(|e| ReadError::malformed("JSON", e.to_string(), Place::Line(e.line() as u64)))?;
    let mut table = Table::default();
    match value {
        Value::Array(rows) => {
            if rows.first().and_then(Value::as_str) == Some("fileversion") {
                return Err(ReadError::Unsupported {
                    what: "Houdini's JSON geometry (GEO of Houdini 12 and later)".into(),
                    advice: "save classic BGEO (File Cache with the extension .bhclassic, or Partio), VTU, PLY or NPZ",
                });
            }
            table.list("position", 3, AttributeType::Number);
            let (components, data) = numbers("position", &rows)?;
            if components != 3 && !rows.is_empty() {
                return Err(shape("position", "three numbers for each particle", components));
            }
            table.positions = Some(data);
        }
        Value::Object(map) => {
            for (name, value) in map {
                let Value::Array(rows) = value else { continue };
                if !names::wanted(&name) {
                    let components = rows.first().and_then(Value::as_array).map_or(1, Vec::len);
                    table.list(&name, components, AttributeType::Number);
                    continue;
                }
                let (components, data) = numbers(&name, &rows)?;
                table.list(&name, components, AttributeType::Number);
                table.push(&name, components, data);
            }
        }
        other => {
            return Err(ReadError::malformed(
                "an array of positions or an object of arrays",
                show(other.to_string().as_bytes()),
                Place::Line(1),
            ));
        }
    }
    table.assemble(Format::Json)
}

fn shape(name: &str, expected: &str, components: usize) -> ReadError {
    ReadError::malformed(format!("{expected} in `{name}`"), format!("{components}"), Place::Unknown)
}

/// The numbers of an array, and how many there are in each row.
fn numbers(name: &str, rows: &[Value]) -> Result<(usize, Data), ReadError> {
    let number = |value: &Value| match value {
        Value::Null => Ok(f64::NAN),
        value => value.as_f64().ok_or_else(|| {
            ReadError::malformed(
                format!("numbers in `{name}`"),
                show(value.to_string().as_bytes()),
                Place::Unknown,
            )
        }),
    };
    let components = rows.first().and_then(Value::as_array).map(Vec::len);
    // Grown, not set aside: the first row may be the only long one.
    let mut values = Vec::new();
    for row in rows {
        match (row, components) {
            (Value::Array(row), Some(components)) => {
                if row.len() != components {
                    let expected = format!("{components} numbers in each row, as in the first,");
                    return Err(shape(name, &expected, row.len()));
                }
                for value in row {
                    values.push(number(value)?);
                }
            }
            (row, None) => values.push(number(row)?),
            (row, Some(_)) => {
                return Err(ReadError::malformed(
                    format!("arrays in `{name}`, as the first is one,"),
                    show(row.to_string().as_bytes()),
                    Place::Unknown,
                ));
            }
        }
    }
    Ok((components.unwrap_or(1), Data::F64(values)))
}
