//! VTK XML: unstructured grids (VTU) and poly data (VTP), in every encoding that VTK and ParaView write.
//!
//! An XML header lists pieces and their arrays. The numbers stand in the element as text or base64, or after
//! `<AppendedData>` and an underscore as base64 or as bytes (which makes the file no XML: the header is cut off
//! before it). What is said here is where they are: `head` finds long texts in elements, `encoded` reads bytes.
//!
//! Own, since the crate for it (vtkio 0.6) reads ASCII, but none of these: raw appended data ends its XML parser,
//! compressed data that is appended as base64 comes out short, and inline it is not decoded.

use roxmltree::Node;

use super::arrays::{self, Array, Segment, Stored};
use super::bytes::show;
use super::columns::{self, AttributeType, Column, PLACED};
use super::encoded::Encoding;
use super::error::{Place, ReadError};
use super::head::{Head, Words};
use super::names;
use super::plan::{About, Plan};
use super::source::Content;
use super::text::Text;
use super::{Compression, Format, Storage};

pub(super) fn plan<'a>(content: &Content<'a>) -> Result<Plan<'a>, ReadError> {
    let plan = plan_of(content, &Head::read(content, true)?)?;
    plan.map_or_else(
        || match plan_of(content, &Head::read(content, false)?)? {
            Some(plan) => Ok(plan),
            None => Err(ReadError::malformed("texts in elements", "others", Place::Unknown)),
        },
        Ok,
    )
}

/// None where the head lacks texts that can't be read where they are.
fn plan_of<'a>(content: &Content<'a>, head: &Head) -> Result<Option<Plan<'a>>, ReadError> {
    let document = head.parse()?;
    let root = document.root_element();
    let kind = root.attribute("type").unwrap_or_default();
    let vtp = match (root.tag_name().name(), kind) {
        ("VTKFile", "UnstructuredGrid") => false,
        ("VTKFile", "PolyData") => true,
        ("VTKFile", "PUnstructuredGrid" | "PPolyData" | "Collection") => {
            return Err(ReadError::Unsupported {
                what: format!("the VTK index file of type {kind}"),
                advice: "it only names other files: give those",
            });
        }
        ("VTKFile", _) => {
            return Err(ReadError::Unsupported {
                what: format!("VTK XML of type \"{kind}\""),
                advice: "particles are UnstructuredGrid or PolyData: save one of these",
            });
        }
        (name, _) => {
            return Err(ReadError::malformed(
                "a VTKFile element",
                format!("`{name}`"),
                Place::Line(1),
            ));
        }
    };
    let compression = match root.attribute("compressor").unwrap_or_default() {
        "" => Compression::None,
        "vtkZLibDataCompressor" => Compression::Zlib,
        "vtkLZ4DataCompressor" => Compression::Lz4,
        "vtkLZMADataCompressor" => Compression::Lzma,
        other => {
            return Err(ReadError::Unsupported {
                what: format!("VTK XML packed by {other}"),
                advice: "save with zlib, LZ4, LZMA or no compression",
            });
        }
    };
    let mut reader = Reader {
        content,
        head,
        big_endian: match root.attribute("byte_order") {
            Some("BigEndian") => true,
            Some("LittleEndian") | None => false,
            Some(other) => return Err(attribute_error("byte_order", other)),
        },
        wide: match root.attribute("header_type") {
            Some("UInt64") => true,
            Some("UInt32") | None => false,
            Some(other) => return Err(attribute_error("header_type", other)),
        },
        compression,
        appended: head.appended.map(|at| Appended::parse(content, at)).transpose()?,
        budget: content.unpack_limit(),
    };

    let mut attributes = Vec::new();
    let mut found: Vec<(Column, Array<'a>)> = Vec::new();
    let mut storage = None;
    let pieces = root.descendants().filter(|node| node.has_tag_name("Piece"));
    for piece in pieces {
        let points: u64 = reader.parsed(&piece, "NumberOfPoints", None)?;
        if points == 0 {
            continue;
        }
        let Some(array) = child(&piece, "Points").and_then(|p| child(&p, "DataArray")) else {
            return Err(ReadError::malformed(
                "Points with a DataArray in each Piece",
                "none",
                head.place(&piece),
            ));
        };
        let (name, components, ty) = reader.described(&array)?;
        let first_piece = found.is_empty();
        if components != 3 || ty.size().is_none() {
            return Err(ReadError::malformed(
                "Points with three numbers each",
                format!("{components} x {ty}"),
                head.place(&array),
            ));
        }
        if first_piece {
            columns::list(&mut attributes, &name, components, ty);
            storage = Some(reader.storage(&array)?);
        }
        let segment = reader.segment(&array, &name, ty, points.saturating_mul(3))?;
        let Some(segment) = segment else { return Ok(None) };
        let points_column = Column::new(PLACED, 3, ty);
        if first_piece {
            found.push((points_column, Array { name, components, segments: Vec::new() }));
        }
        reader.add(found.first_mut(), segment, &array)?;
        let Some(point_data) = child(&piece, "PointData") else {
            continue;
        };
        for array in point_data.children().filter(|n| n.has_tag_name("DataArray")) {
            let (name, components, ty) = reader.described(&array)?;
            let wanted = if first_piece {
                columns::list(&mut attributes, &name, components, ty)
            } else {
                names::wanted(&name)
            };
            if !wanted || ty.size().is_none() {
                continue;
            }
            let count = points.saturating_mul(components as u64);
            let Some(segment) = reader.segment(&array, &name, ty, count)? else { return Ok(None) };
            let same = found.iter().skip(1).position(|(column, _)| column.name == name);
            // A second array of the same name in a piece makes it too long, which is found when all are there.
            let at = same.map_or(found.len(), |at| at + 1);
            if same.is_none() {
                let column = Column::new(&name, components, ty);
                found.push((column, Array { name, components, segments: Vec::new() }));
            }
            reader.add(found.get_mut(at), segment, &array)?;
        }
    }
    // A grid without points has no particles, which is no fault.
    if found.is_empty() {
        let none = Array { name: PLACED.into(), components: 3, segments: Vec::new() };
        found.push((Column::new(PLACED, 3, AttributeType::F32), none));
    }
    let storage = storage.unwrap_or(Storage::Ascii);
    let format =
        if vtp { Format::Vtp(storage, compression) } else { Format::Vtu(storage, compression) };
    let about = About { placed: Some(0), attributes, warnings: Vec::new(), time: None, format };
    let tracks = found.into_iter().map(|(column, array)| arrays::track(column, array));
    Plan::new(tracks.collect(), about, content.unpack_limit()).map(Some)
}

fn child<'a, 'i>(node: &Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|n| n.has_tag_name(name))
}

fn attribute_error(name: &str, value: &str) -> ReadError {
    ReadError::malformed(format!("a known `{name}`"), format!("\"{value}\""), Place::Unknown)
}

/// Bytes after the header.
#[derive(Clone, Copy)]
struct Appended {
    base64: bool,
    /// Where they begin in the file.
    start: u64,
}

impl Appended {
    /// From its element on, which begins `at` this place.
    fn parse(content: &Content<'_>, at: u64) -> Result<Self, ReadError> {
        let mut text = Text::new(content.open(at, content.length())?);
        let tag = text.until(b'>')?;
        let mark = text.until(b'_')?;
        let (Some(tag), Some(_)) = (tag, mark) else {
            return Err(ReadError::malformed(
                "an underscore before the appended data",
                "none",
                Place::Byte(at),
            ));
        };
        let start = text.at();
        let has = |word: &[u8]| tag.windows(word.len()).any(|w| w == word);
        if has(b"base64") {
            Ok(Self { base64: true, start })
        } else if has(b"raw") {
            Ok(Self { base64: false, start })
        } else {
            Err(ReadError::malformed(
                "appended data in `raw` or `base64`",
                show(&tag),
                Place::Byte(start),
            ))
        }
    }
}

/// Finds where arrays are.
struct Reader<'h, 'a> {
    content: &'h Content<'a>,
    head: &'h Head,
    big_endian: bool,
    /// Headers of 64 bits.
    wide: bool,
    compression: Compression,
    appended: Option<Appended>,
    /// Bytes that may still be unpacked: arrays may share data, so the whole is bounded, not each.
    budget: u64,
}

impl<'a> Reader<'_, 'a> {
    /// A number among the attributes of an element.
    fn parsed(
        &self,
        node: &Node<'_, '_>,
        name: &str,
        default: Option<u64>,
    ) -> Result<u64, ReadError> {
        let value = match (node.attribute(name), default) {
            (None, Some(default)) => return Ok(default),
            (value, _) => value.unwrap_or_default(),
        };
        value.trim().parse().map_err(|_| {
            ReadError::malformed(
                format!("a number as `{name}`"),
                format!("\"{value}\""),
                self.head.place(node),
            )
        })
    }

    /// Name, components and type of an array.
    fn described(&self, array: &Node<'_, '_>) -> Result<(String, usize, AttributeType), ReadError> {
        use AttributeType as T;
        let ty = match array.attribute("type").unwrap_or_default() {
            "Int8" => T::I8,
            "UInt8" => T::U8,
            "Int16" => T::I16,
            "UInt16" => T::U16,
            "Int32" => T::I32,
            "UInt32" => T::U32,
            "Int64" => T::I64,
            "UInt64" => T::U64,
            "Float32" => T::F32,
            "Float64" => T::F64,
            "String" => T::Text,
            _ => T::Other,
        };
        let name = array.attribute("Name").unwrap_or("unnamed").to_string();
        let components = self.parsed(array, "NumberOfComponents", Some(1))?;
        Ok((name, usize::try_from(components).unwrap_or(usize::MAX), ty))
    }

    fn storage(&self, array: &Node<'_, '_>) -> Result<Storage, ReadError> {
        match array.attribute("format").unwrap_or("ascii") {
            "ascii" => Ok(Storage::Ascii),
            "binary" => Ok(Storage::InlineBase64),
            "appended" => match self.appended {
                Some(Appended { base64: false, .. }) => Ok(Storage::AppendedRaw),
                Some(Appended { base64: true, .. }) => Ok(Storage::AppendedBase64),
                None => Err(ReadError::malformed(
                    "AppendedData in the file",
                    "none; it was perhaps cut off",
                    self.head.place(array),
                )),
            },
            other => Err(ReadError::malformed(
                "format `ascii`, `binary` or `appended`",
                format!("\"{other}\""),
                self.head.place(array),
            )),
        }
    }

    /// Where `count` numbers of an array are; none where the head lacks a text that can't be read where it is.
    fn segment(
        &mut self,
        array: &Node<'_, '_>,
        name: &str,
        ty: AttributeType,
        count: u64,
    ) -> Result<Option<Segment<'a>>, ReadError> {
        let storage = self.storage(array)?;
        let offset = self.head.offset(array);
        if storage != Storage::Ascii {
            let bytes = count.saturating_mul(ty.size().unwrap_or(1));
            if self.budget <= bytes {
                let what = format!("array `{name}`");
                return Err(ReadError::TooLarge { what, limit: self.budget });
            }
            self.budget -= bytes;
        }
        let encoding = |base64| Encoding {
            base64,
            compression: self.compression,
            big_endian: self.big_endian,
            wide: self.wide,
        };
        let (stored, text) = match (storage, self.appended) {
            (Storage::Ascii, _) => {
                (Stored::OwnWords(offset, self.head.place(array)), self.head.words(array))
            }
            (Storage::AppendedRaw | Storage::AppendedBase64, Some(Appended { base64, start })) => {
                let at = self.parsed(array, "offset", None)?;
                let start = start.saturating_add(at);
                (Stored::Bytes(encoding(base64), start), Words::There(start, u64::MAX))
            }
            _ => (Stored::Bytes(encoding(true), offset), self.head.words(array)),
        };
        let (content, start, end) = match text {
            // Keys with information about the array may stand beside its text.
            Words::Here(text) => {
                let text = text.as_bytes().to_vec();
                let length = text.len() as u64;
                (Content::of_bytes(text)?, 0, length)
            }
            Words::There(start, end) => (self.content.clone(), start, end),
            Words::Mixed => return Ok(None),
        };
        Ok(Some(Segment { content, start, end, count, ty, stored }))
    }

    /// Adds a segment to those of an attribute, which must be like it.
    fn add(
        &self,
        to: Option<&mut (Column, Array<'a>)>,
        segment: Segment<'a>,
        array: &Node<'_, '_>,
    ) -> Result<(), ReadError> {
        let Some((column, found)) = to else { return Ok(()) };
        let (name, components, _) = self.described(array)?;
        if components != found.components || !column.data.takes(segment.ty) {
            return Err(ReadError::malformed(
                format!("the same type and components of `{name}` in all pieces"),
                "others",
                self.head.place(array),
            ));
        }
        found.segments.push(segment);
        Ok(())
    }
}
