//! VTK XML: unstructured grids (VTU) and poly data (VTP), in every encoding that VTK and ParaView write.
//!
//! An XML header lists pieces and their arrays. The numbers stand in the element as text or base64, or after
//! `<AppendedData>` and an underscore as base64 or as bytes (which makes the file no XML: the header is cut off
//! before it). Binary numbers begin with a header of `UInt32` or `UInt64`: uncompressed, the number of bytes;
//! compressed, the number of blocks, their size, the size of a last smaller one (or 0), and the packed size of
//! each. In base64 the header of compressed data is encoded apart, padding included.
//!
//! Own, since the crate for it (vtkio 0.6) reads ASCII, but none of these: raw appended data ends its XML parser,
//! compressed data that is appended as base64 comes out short, and inline it is not decoded.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use roxmltree::Node;

use super::bytes::{Cursor, ascii_values, show, unpack, unpack_limit};
use super::columns::{AttributeType, Data, Table};
use super::error::{Place, ReadError};
use super::{Compression, Format, Particles, Storage};

pub(super) fn read(bytes: &[u8]) -> Result<Particles, ReadError> {
    const MARK: &[u8] = b"<AppendedData";
    let split = bytes.windows(MARK.len()).position(|w| w == MARK);
    let (head, tail) = bytes.split_at_checked(split.unwrap_or(bytes.len())).unwrap_or((bytes, b""));
    let head = std::str::from_utf8(head).map_err(|e| {
        ReadError::malformed(
            "a header in UTF-8",
            "another byte",
            Place::Byte(e.valid_up_to() as u64),
        )
    })?;
    // The part before the appended data lacks the end of its root.
    let closed;
    let text = if tail.is_empty() {
        head
    } else {
        closed = format!("{head}</VTKFile>");
        &closed
    };
    let document =
        roxmltree::Document::parse(text.trim_start_matches('\u{feff}')).map_err(|e| {
            let at = Place::Line(u64::from(e.pos().row));
            ReadError::malformed("well-formed XML", e.to_string(), at)
        })?;
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
    let mut decoder = Decoder {
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
        appended: Appended::parse(tail, split.unwrap_or(0))?,
        budget: unpack_limit(bytes.len()),
    };

    let mut table = Table::default();
    let mut storage = None;
    let pieces = root.descendants().filter(|node| node.has_tag_name("Piece"));
    for piece in pieces {
        let points: u64 = parsed(&piece, "NumberOfPoints", None)?;
        if points == 0 {
            continue;
        }
        let Some(array) = child(&piece, "Points").and_then(|p| child(&p, "DataArray")) else {
            return Err(ReadError::malformed(
                "Points with a DataArray in each Piece",
                "none",
                place(&piece),
            ));
        };
        let (name, components, ty) = described(&array)?;
        let first_piece = table.positions.is_none();
        if components != 3 || ty.size().is_none() {
            return Err(ReadError::malformed(
                "Points with three numbers each",
                format!("{components} x {ty}"),
                place(&array),
            ));
        }
        if first_piece {
            table.list(&name, components, ty);
            storage = Some(decoder.storage(&array)?);
        }
        let data = decoder.values(&array, &name, ty, points.saturating_mul(3))?;
        let done = table.positions.get_or_insert_with(|| Data::for_type(ty));
        if !done.append(data) {
            return Err(mixed(&name, &array));
        }
        let Some(attributes) = child(&piece, "PointData") else {
            continue;
        };
        for array in attributes.children().filter(|n| n.has_tag_name("DataArray")) {
            let (name, components, ty) = described(&array)?;
            let wanted = if first_piece {
                table.list(&name, components, ty)
            } else {
                super::columns::wanted(&name)
            };
            if !wanted || ty.size().is_none() {
                continue;
            }
            let count = points.saturating_mul(components as u64);
            let data = decoder.values(&array, &name, ty, count)?;
            let column = table.columns.iter_mut().find(|c| c.name == name);
            match column {
                // A second array of the same name in a piece makes it too long, which is found below.
                Some(column) if column.components == components => {
                    if !column.data.append(data) {
                        return Err(mixed(&name, &array));
                    }
                }
                Some(_) => return Err(mixed(&name, &array)),
                None => table.push(&name, components, data),
            }
        }
    }
    // A grid without points has no particles, which is no fault.
    table.positions.get_or_insert_with(|| Data::F32(Vec::new()));
    let storage = storage.unwrap_or(Storage::Ascii);
    table.assemble(if vtp {
        Format::Vtp(storage, compression)
    } else {
        Format::Vtu(storage, compression)
    })
}

fn child<'a, 'i>(node: &Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|n| n.has_tag_name(name))
}

fn place(node: &Node<'_, '_>) -> Place {
    let position = node.document().text_pos_at(node.range().start);
    Place::Line(u64::from(position.row))
}

fn attribute_error(name: &str, value: &str) -> ReadError {
    ReadError::malformed(format!("a known `{name}`"), format!("\"{value}\""), Place::Unknown)
}

fn mixed(name: &str, node: &Node<'_, '_>) -> ReadError {
    ReadError::malformed(
        format!("the same type and components of `{name}` in all pieces"),
        "others",
        place(node),
    )
}

/// A number among the attributes of an element.
fn parsed(node: &Node<'_, '_>, name: &str, default: Option<u64>) -> Result<u64, ReadError> {
    let value = match (node.attribute(name), default) {
        (None, Some(default)) => return Ok(default),
        (value, _) => value.unwrap_or_default(),
    };
    value.trim().parse().map_err(|_| {
        ReadError::malformed(format!("a number as `{name}`"), format!("\"{value}\""), place(node))
    })
}

/// Name, components and type of an array.
fn described(array: &Node<'_, '_>) -> Result<(String, usize, AttributeType), ReadError> {
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
    let components = parsed(array, "NumberOfComponents", Some(1))?;
    Ok((name, usize::try_from(components).unwrap_or(usize::MAX), ty))
}

enum Appended<'a> {
    None,
    Raw { data: &'a [u8], offset: usize },
    Base64 { data: &'a [u8], offset: usize },
}

impl<'a> Appended<'a> {
    /// `tail` begins with the element, `offset` bytes into the file.
    fn parse(tail: &'a [u8], offset: usize) -> Result<Self, ReadError> {
        if tail.is_empty() {
            return Ok(Self::None);
        }
        let open = tail.iter().position(|b| *b == b'>').unwrap_or(tail.len());
        let tag = tail.get(..open).unwrap_or_default();
        let mark = tail.iter().skip(open).position(|b| *b == b'_');
        let Some(data) = mark.and_then(|mark| tail.get(open + mark + 1..)) else {
            return Err(ReadError::malformed(
                "an underscore before the appended data",
                "none",
                Place::Byte(offset as u64),
            ));
        };
        let offset = offset + tail.len() - data.len();
        let has = |word: &[u8]| tag.windows(word.len()).any(|w| w == word);
        if has(b"base64") {
            Ok(Self::Base64 { data, offset })
        } else if has(b"raw") {
            Ok(Self::Raw { data, offset })
        } else {
            Err(ReadError::malformed(
                "appended data in `raw` or `base64`",
                show(tag),
                Place::Byte(offset as u64),
            ))
        }
    }
}

struct Decoder<'a> {
    big_endian: bool,
    /// Headers of 64 bits.
    wide: bool,
    compression: Compression,
    appended: Appended<'a>,
    /// Bytes that may still be unpacked: arrays may share data, so the whole is bounded, not each.
    budget: usize,
}

impl Decoder<'_> {
    fn storage(&self, array: &Node<'_, '_>) -> Result<Storage, ReadError> {
        match array.attribute("format").unwrap_or("ascii") {
            "ascii" => Ok(Storage::Ascii),
            "binary" => Ok(Storage::InlineBase64),
            "appended" => match self.appended {
                Appended::Raw { .. } => Ok(Storage::AppendedRaw),
                Appended::Base64 { .. } => Ok(Storage::AppendedBase64),
                Appended::None => Err(ReadError::malformed(
                    "AppendedData in the file",
                    "none; it was perhaps cut off",
                    place(array),
                )),
            },
            other => Err(ReadError::malformed(
                "format `ascii`, `binary` or `appended`",
                format!("\"{other}\""),
                place(array),
            )),
        }
    }

    /// `count` numbers of an array.
    fn values(
        &mut self,
        array: &Node<'_, '_>,
        name: &str,
        ty: AttributeType,
        count: u64,
    ) -> Result<Data, ReadError> {
        let length_error =
            |found: u64| ReadError::Length { attribute: name.to_string(), expected: count, found };
        // Keys with information about the array may stand beside its text.
        let text = || {
            array
                .children()
                .filter(Node::is_text)
                .find_map(|n| n.text().map(str::trim).filter(|t| !t.is_empty()))
                .unwrap_or_default()
        };
        let size = ty.size().unwrap_or(1);
        let expected = count.saturating_mul(size);
        let raw = match (self.storage(array)?, &self.appended) {
            (Storage::Ascii, _) => {
                let mut cursor = Cursor::new(text().as_bytes());
                let data = ascii_values(&mut cursor, ty, count, name, true)
                    .map_err(|e| relocated(e, array))?;
                let mut more = 0;
                while cursor.token().is_some() {
                    more += 1;
                }
                return if more == 0 { Ok(data) } else { Err(length_error(count + more)) };
            }
            (_, Appended::Raw { data, offset }) => {
                let at = usize::try_from(parsed(array, "offset", None)?).unwrap_or(usize::MAX);
                let source = Source::Raw(data.get(at..).unwrap_or_default());
                self.binary(&source, name, expected, offset.saturating_add(at))?
            }
            (Storage::InlineBase64, _) => {
                let source = Source::Base64(text().as_bytes());
                self.binary(&source, name, expected, array.range().start)?
            }
            (_, Appended::Base64 { data, offset }) => {
                let at = usize::try_from(parsed(array, "offset", None)?).unwrap_or(usize::MAX);
                let source = Source::Base64(data.get(at..).unwrap_or_default());
                self.binary(&source, name, expected, offset.saturating_add(at))?
            }
            (_, Appended::None) => Vec::new(),
        };
        if raw.len() as u64 != expected {
            return Err(length_error(raw.len() as u64 / size));
        }
        self.budget = self.budget.saturating_sub(raw.len());
        let mut data = Data::for_type(ty);
        data.push_bytes(ty, &raw, self.big_endian);
        Ok(data)
    }

    /// The bytes of a binary array; `expected` of them unless the file is at fault.
    fn binary(
        &self,
        source: &Source<'_>,
        name: &str,
        expected: u64,
        offset: usize,
    ) -> Result<Vec<u8>, ReadError> {
        let word = if self.wide { 8 } else { 4 };
        let what = || format!("array `{name}`");
        let at = |e| match e {
            ReadError::Truncated { needed, found, .. } => {
                ReadError::Truncated { what: what(), offset: offset as u64, needed, found }
            }
            e => e,
        };
        if self.budget as u64 <= expected {
            return Err(ReadError::TooLarge { what: what(), limit: self.budget as u64 });
        }
        if self.compression == Compression::None {
            let head = source.bytes(0, word, &what()).map_err(at)?;
            let length = self.words(head.as_ref()).next().unwrap_or(0);
            let data = if source.header_ends(word) {
                source.second(word, length, &what())
            } else {
                source.bytes(word, length, &what())
            };
            // The caller checks the length.
            return data.map_err(at).map(std::borrow::Cow::into_owned);
        }

        let blocks =
            self.words(source.bytes(0, word, &what()).map_err(at)?.as_ref()).next().unwrap_or(0);
        if blocks == 0 {
            return Ok(Vec::new());
        }
        let head_length = blocks.saturating_add(3).saturating_mul(word);
        let head = source.bytes(0, head_length, &what()).map_err(at)?;
        let mut head = self.words(head.as_ref()).skip(1);
        let (block_size, last_size) = (head.next().unwrap_or(0), head.next().unwrap_or(0));
        let sizes: Vec<u64> = head.collect();
        let total = sizes.iter().fold(0_u64, |sum, s| sum.saturating_add(*s));
        let packed = source.second(head_length, total, &what()).map_err(at)?;
        let mut cursor = Cursor::new(&packed);
        let mut out = Vec::new();
        for (i, size) in sizes.iter().enumerate() {
            let last = i + 1 == sizes.len() && last_size != 0;
            let unpacked = if last { last_size } else { block_size };
            let left = expected.saturating_sub(out.len() as u64);
            if unpacked > left {
                return Err(ReadError::Length {
                    attribute: name.to_string(),
                    expected,
                    found: (out.len() as u64).saturating_add(unpacked),
                });
            }
            let block = cursor.take(*size, &what())?;
            let unpacked = usize::try_from(unpacked).unwrap_or(usize::MAX);
            let block = self.unpack_block(block, unpacked, &what(), offset)?;
            if block.len() != unpacked {
                return Err(ReadError::malformed(
                    format!("{unpacked} bytes in block {i} of array `{name}`"),
                    format!("{} bytes", block.len()),
                    Place::Byte(offset as u64),
                ));
            }
            out.extend_from_slice(&block);
        }
        Ok(out)
    }

    fn unpack_block(
        &self,
        block: &[u8],
        size: usize,
        what: &str,
        offset: usize,
    ) -> Result<Vec<u8>, ReadError> {
        match self.compression {
            Compression::Zlib => unpack(flate2::read::ZlibDecoder::new(block), size, what, offset),
            Compression::Lz4 => {
                // A byte of LZ4 stands for 255 at most: no more is set aside for a header that lies.
                if size > block.len().saturating_mul(255).saturating_add(64) {
                    return Err(ReadError::malformed(
                        format!("LZ4 data for {size} bytes in {what}"),
                        format!("{} bytes", block.len()),
                        Place::Byte(offset as u64),
                    ));
                }
                lz4_flex::block::decompress(block, size).map_err(|e| {
                    ReadError::malformed(
                        format!("sound LZ4 data in {what}"),
                        e.to_string(),
                        Place::Byte(offset as u64),
                    )
                })
            }
            // The dictionary is set aside whole, so it is bounded: level 9 takes 64 MiB.
            Compression::Lzma => unpack(
                lzma_rust2::XzReader::new_mem_limit(block, true, 66 << 10),
                size,
                what,
                offset,
            ),
            Compression::None => Ok(block.to_vec()),
        }
    }

    /// Header words.
    fn words(&self, bytes: &[u8]) -> impl Iterator<Item = u64> + use<> {
        let mut data = Data::for_type(AttributeType::U64);
        let ty = if self.wide { AttributeType::U64 } else { AttributeType::U32 };
        data.push_bytes(ty, bytes, self.big_endian);
        let words = match data {
            Data::Int(words) => words,
            _ => Vec::new(),
        };
        words.into_iter().map(i64::cast_unsigned)
    }
}

/// Bytes that stand as they are or in base64.
enum Source<'a> {
    Raw(&'a [u8]),
    Base64(&'a [u8]),
}

impl Source<'_> {
    /// `length` bytes from `from` on, where all is one run of base64, or its first run.
    fn bytes(
        &self,
        from: u64,
        length: u64,
        what: &str,
    ) -> Result<std::borrow::Cow<'_, [u8]>, ReadError> {
        match self {
            Self::Raw(data) => {
                let mut cursor = Cursor::new(data);
                cursor.take(from, what)?;
                Ok(cursor.take(length, what)?.into())
            }
            Self::Base64(text) => {
                let end = from.saturating_add(length);
                let decoded = decode_base64(text, end, what)?;
                let mut cursor = Cursor::new(&decoded);
                cursor.take(from, what)?;
                Ok(cursor.take(length, what)?.to_vec().into())
            }
        }
    }

    /// Whether a header of `head` bytes is a run of base64 of its own: it is with some writers.
    fn header_ends(&self, head: u64) -> bool {
        let last = (head.div_ceil(3) * 4).checked_sub(1);
        match (self, last.and_then(|last| usize::try_from(last).ok())) {
            (Self::Base64(text), Some(last)) => text.get(last) == Some(&b'='),
            _ => false,
        }
    }

    /// `length` bytes that follow a header of `head` bytes, which is a run of base64 of its own.
    fn second(
        &self,
        head: u64,
        length: u64,
        what: &str,
    ) -> Result<std::borrow::Cow<'_, [u8]>, ReadError> {
        match self {
            Self::Raw(_) => self.bytes(head, length, what),
            Self::Base64(text) => {
                let mut cursor = Cursor::new(text);
                cursor.take(head.div_ceil(3).saturating_mul(4), what)?;
                Ok(decode_base64(cursor.rest(), length, what)?.into())
            }
        }
    }
}

/// The first `length` bytes of a run of base64. Needs no end of the run: what follows is another array.
fn decode_base64(text: &[u8], length: u64, what: &str) -> Result<Vec<u8>, ReadError> {
    let length = usize::try_from(length).unwrap_or(usize::MAX);
    let mut cursor = Cursor::new(text);
    let text = cursor.take((length.div_ceil(3) as u64).saturating_mul(4), what)?;
    // Line breaks inside are allowed by the standard, though no known writer makes them.
    let mut out = STANDARD.decode(text).map_err(|e| {
        ReadError::malformed(format!("base64 in {what}"), e.to_string(), Place::Unknown)
    })?;
    if out.len() < length {
        return Err(ReadError::truncated(what, 0, length as u64, out.len()));
    }
    out.truncate(length);
    Ok(out)
}

/// Puts the place of an error in an element's text at the element.
fn relocated(error: ReadError, array: &Node<'_, '_>) -> ReadError {
    match error {
        ReadError::Malformed { expected, found, .. } => {
            ReadError::Malformed { expected, found, place: place(array) }
        }
        ReadError::Truncated { what, needed, found, .. } => {
            ReadError::Truncated { what, offset: array.range().start as u64, needed, found }
        }
        e => e,
    }
}
