//! Classic Houdini binary geometry, version 5 (`.bgeo` before Houdini 12; what Partio writes). All big-endian.
//!
//! `Bgeo`, `V`, then nine `i32`: version (5), points, primitives, point groups, primitive groups, point
//! attributes, vertex attributes, primitive attributes, detail attributes. Then for each point attribute: name
//! (`u16` length, bytes), `u16` components, `i32` type (0 float, 1 int, 4 index into texts, 5 vector) and either
//! the defaults (4 bytes per component) or the texts (`i32` count; each `u16` length, bytes). Then for each
//! point x y z w and its attributes, 4 bytes per value. What follows the points (attributes of vertices,
//! primitives and the whole, groups) is of no use here and is not read.

use super::Format;
use super::asked::Asked;
use super::bytes::Cursor;
use super::columns::{AttributeType, PLACED, Table};
use super::error::{Place, ReadError};
use super::rows::{Field, Layout, Rows};

/// Parses the header of a file or of its beginning.
pub(super) fn layout(bytes: &[u8], gzip: bool, asked: &Asked) -> Result<Layout, ReadError> {
    let mut cursor = Cursor::new(bytes);
    cursor.take(5, "the BGEO magic")?;
    let mut header = [0_i32; 9];
    for value in &mut header {
        *value = cursor.i32_be("the BGEO header")?;
    }
    let [version, points, _, _, _, point_attributes, ..] = header;
    if version != 5 {
        return Err(ReadError::Unsupported {
            what: format!("BGEO version {version}"),
            advice: "save classic BGEO version 5 (Partio, SPlisHSPlasH), VTU, PLY or NPZ",
        });
    }
    let count = |value: i32, what: &str| {
        u64::try_from(value).map_err(|_| {
            ReadError::malformed(format!("a number of {what}"), value.to_string(), Place::Byte(5))
        })
    };
    let points = count(points, "points")?;
    let point_attributes = count(point_attributes, "point attributes")?;

    let mut table = Table::new(asked);
    table.list("position", 3, AttributeType::F32);
    let mut fields = vec![Field::new(PLACED, 3, AttributeType::F32, 0)?];
    // x y z w come first.
    let mut stride = 16_u64;
    for _ in 0..point_attributes {
        let place = cursor.place();
        let length = cursor.u16_be("the length of an attribute's name")?;
        let name = cursor.take(u64::from(length), "an attribute's name")?;
        let name = String::from_utf8_lossy(name).into_owned();
        let components = cursor.u16_be("an attribute's size")?;
        let ty = cursor.i32_be("an attribute's type")?;
        let ty = match ty {
            0 | 5 => AttributeType::F32,
            1 => AttributeType::I32,
            4 => AttributeType::Text,
            2 => {
                return Err(ReadError::Unsupported {
                    what: format!("the BGEO text attribute `{name}` of fixed length"),
                    advice: "delete it, or make it an indexed string, before saving",
                });
            }
            _ => {
                return Err(ReadError::malformed(
                    format!("type 0, 1, 2, 4 or 5 of attribute `{name}`"),
                    ty.to_string(),
                    place,
                ));
            }
        };
        if ty == AttributeType::Text {
            let texts = cursor.i32_be("the number of an attribute's texts")?;
            for _ in 0..count(texts, "texts")? {
                let length = cursor.u16_be("the length of a text")?;
                cursor.take(u64::from(length), "a text")?;
            }
        } else {
            cursor.take(4 * u64::from(components), "an attribute's defaults")?;
        }
        if table.list(&name, usize::from(components), ty) && ty != AttributeType::Text {
            fields.push(Field::new(&name, usize::from(components), ty, stride)?);
        }
        stride += 4 * u64::from(components);
    }
    Ok(Layout {
        rows: Rows {
            what: "the points".into(),
            header: cursor.at() as u64,
            between: Vec::new(),
            count: points,
            stride,
            big_endian: true,
            fields,
        },
        placed: true,
        attributes: table.attributes,
        warnings: Vec::new(),
        format: Format::Bgeo { gzip },
        asked: table.asked,
    })
}
