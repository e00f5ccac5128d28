//! The header: encoding, elements, properties.

use super::super::lines::{Lines, quote};
use super::super::table::Columns;
use crate::error::{Error, Result};

/// A scalar type.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &str) -> Option<Scalar> {
        Some(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }

    pub(super) fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    /// The value of `size()` bytes.
    pub(super) fn value(self, bytes: &[u8], big_endian: bool) -> f64 {
        let mut raw = [0u8; 8];
        for (i, &byte) in bytes.iter().enumerate() {
            raw[if big_endian { bytes.len() - 1 - i } else { i }] = byte;
        }
        let [a, b, c, d, ..] = raw;
        match self {
            Scalar::I8 => f64::from(a as i8),
            Scalar::U8 => f64::from(a),
            Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
            Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
            Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Scalar::F64 => f64::from_le_bytes(raw),
        }
    }
}

/// A property: one value, or a count and as many values.
pub(super) enum Property {
    One { name: String, scalar: Scalar },
    List { count: Scalar, item: Scalar },
}

pub(super) struct Element {
    pub(super) name: String,
    pub(super) rows: u64,
    pub(super) properties: Vec<Property>,
    /// Line of the header that declares it.
    pub(super) line: u64,
}

impl Element {
    /// Names of the properties that are one value, in order.
    fn names(&self) -> Vec<String> {
        let name = |property: &Property| match property {
            Property::One { name, .. } => Some(name.clone()),
            Property::List { .. } => None,
        };
        self.properties.iter().filter_map(name).collect()
    }

    /// Bytes of a binary row, an empty list counted for each list; and whether that is every row's size.
    pub(super) fn row_size(&self) -> (usize, bool) {
        let size = |property: &Property| match property {
            Property::One { scalar, .. } => scalar.size(),
            Property::List { count, .. } => count.size(),
        };
        let fixed = self
            .properties
            .iter()
            .all(|p| matches!(p, Property::One { .. }));
        (self.properties.iter().map(size).sum(), fixed)
    }

    /// Which values of a row are what; `None` without x, y and z.
    fn columns(&self) -> Option<Columns> {
        let mut columns = Columns::from_names(&self.names())?;
        let scalars: Vec<Scalar> = self
            .properties
            .iter()
            .filter_map(|property| match property {
                Property::One { scalar, .. } => Some(*scalar),
                Property::List { .. } => None,
            })
            .collect();
        columns.color_is_bytes = columns
            .color
            .is_some_and(|color| color.iter().all(|&i| scalars[i].size() == 1));
        Some(columns)
    }
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Byte and line at which the rows start.
    pub(super) end: usize,
    pub(super) lines: u64,
}

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Header> {
        let mut lines = Lines::new(bytes, 0, 0);
        let first = lines.next().unwrap_or_default();
        if first.trim_ascii() != b"ply" {
            return Err(bad_line(1, "\"ply\"", first));
        }
        let carriage_return_alone = bytes[first.len()..].first() == Some(&b'\r')
            && bytes.get(first.len() + 1) != Some(&b'\n');
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        loop {
            let start = lines.at;
            let Some(line) = lines.next() else {
                return Err(Error::BadFile {
                    format: "PLY",
                    place: "byte",
                    at: bytes.len() as u64,
                    expected: "\"end_header\"".into(),
                    found: "the end of the file".into(),
                });
            };
            let number = lines.number;
            let text = String::from_utf8_lossy(line);
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            match words[..] {
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, version] => {
                    encoding = Some(parse_encoding(name, version, number, line)?)
                }
                ["element", name, rows] => elements.push(Element {
                    name: name.into(),
                    rows: rows
                        .parse()
                        .map_err(|_| bad_line(number, "a count of rows", rows.as_bytes()))?,
                    properties: Vec::new(),
                    line: number,
                }),
                ["property", ..] => {
                    let element = elements.last_mut().ok_or_else(|| {
                        bad_line(number, "an element before its properties", line)
                    })?;
                    element
                        .properties
                        .push(parse_property(&words, number, line)?);
                }
                ["end_header"] => {
                    let encoding = encoding
                        .ok_or_else(|| bad_line(number, "a format line before end_header", line))?;
                    // Where lines end in \r alone, a \n after it is the first byte of the rows.
                    let end = if carriage_return_alone {
                        start + line.len() + 1
                    } else {
                        lines.at
                    };
                    return Ok(Header {
                        encoding,
                        elements,
                        end: end.min(bytes.len()),
                        lines: number,
                    });
                }
                _ => {
                    return Err(bad_line(
                        number,
                        "a line of a PLY header (format, comment, obj_info, element, property, end_header)",
                        line,
                    ));
                }
            }
        }
    }

    /// The element that holds the points, and its columns.
    pub(super) fn points(&self) -> Result<(usize, Columns)> {
        let vertex = self.elements.iter().position(|e| e.name == "vertex");
        let with_xyz = || self.elements.iter().position(|e| e.columns().is_some());
        let missing = |line: u64, found: String| Error::BadFile {
            format: "PLY",
            place: "line",
            at: line,
            expected: "an element with properties x, y and z".into(),
            found,
        };
        let Some(index) = vertex.or_else(with_xyz) else {
            let names = self.elements.iter().map(|e| e.name.clone()).collect();
            return Err(missing(self.lines, described("element", names)));
        };
        let element = &self.elements[index];
        let mut names = element.names();
        let Some(columns) = element.columns() else {
            return Err(missing(element.line, described("property", names)));
        };
        names.sort_unstable();
        if let Some(pair) = names.windows(2).find(|pair| pair[0] == pair[1]) {
            let expected = "properties with different names";
            return Err(bad_line(element.line, expected, pair[0].as_bytes()));
        }
        Ok((index, columns))
    }
}

fn parse_encoding(name: &str, version: &str, number: u64, line: &[u8]) -> Result<Encoding> {
    if version != "1.0" {
        return Err(bad_line(number, "version 1.0", line));
    }
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(bad_line(
            number,
            "ascii, binary_little_endian or binary_big_endian",
            line,
        )),
    }
}

fn parse_property(words: &[&str], number: u64, line: &[u8]) -> Result<Property> {
    let scalar = |name: &str| {
        Scalar::from_name(name).ok_or_else(|| {
            bad_line(
                number,
                "a type (char … double, int8 … float64)",
                name.as_bytes(),
            )
        })
    };
    match *words {
        [_, "list", count, item, _] => Ok(Property::List {
            count: scalar(count)?,
            item: scalar(item)?,
        }),
        [_, kind, name] if kind != "list" => Ok(Property::One {
            name: name.into(),
            scalar: scalar(kind)?,
        }),
        _ => Err(bad_line(
            number,
            "property <type> <name> or property list <type> <type> <name>",
            line,
        )),
    }
}

pub(super) fn bad_line(at: u64, expected: &str, found: &[u8]) -> Error {
    let found = if found.is_empty() {
        "nothing".into()
    } else {
        quote(found)
    };
    Error::BadFile {
        format: "PLY",
        place: "line",
        at,
        expected: expected.into(),
        found,
    }
}

/// `no property`, or `property "x, y"`.
fn described(what: &str, names: Vec<String>) -> String {
    if names.is_empty() {
        return format!("no {what}");
    }
    format!("{what} {}", quote(names.join(", ").as_bytes()))
}
