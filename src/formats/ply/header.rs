//! The header: encoding, elements, properties.

use super::super::colors::{ColorRange, unpacked};
use super::super::input::{Ending, Input};
use super::super::table::{Columns, Precision};
use super::super::text::quote;
use crate::base::error::Result;

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

    /// Whether single precision holds every value.
    fn is_single(self) -> bool {
        !matches!(self, Scalar::I32 | Scalar::U32 | Scalar::F64)
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
    One {
        name: String,
        scalar: Scalar,
    },
    List {
        name: String,
        count: Scalar,
        item: Scalar,
    },
}

pub(super) struct Element {
    pub(super) name: String,
    pub(super) rows: u64,
    pub(super) properties: Vec<Property>,
    /// Line of the header that declares it.
    pub(super) line: u64,
}

impl Element {
    /// Names of the properties that are one value, in order; the second of a name gets a number.
    pub(super) fn names(&self) -> Vec<String> {
        let name = |property: &Property| match property {
            Property::One { name, .. } => Some(name.clone()),
            Property::List { .. } => None,
        };
        distinct(self.properties.iter().filter_map(name).collect())
    }

    /// Whether its rows are Gaussian splats.
    pub(super) fn is_splats(&self) -> bool {
        let names = self.names();
        let has = |name: &&str| names.iter().any(|own| own == name);
        SPLAT.iter().all(has)
    }

    /// Bytes of a row at least: in text a digit and its separator for each value, in binary with empty lists.
    fn least_size(&self, encoding: Encoding) -> u64 {
        let size = |property: &Property| match (encoding, property) {
            (Encoding::Ascii, _) => 2,
            (_, Property::One { scalar, .. }) => scalar.size() as u64,
            (_, Property::List { count, .. }) => count.size() as u64,
        };
        self.properties.iter().map(size).sum()
    }

    /// Bytes of every row, where they are the same.
    pub(super) fn fixed_size(&self, encoding: Encoding) -> Option<u64> {
        let one = |property: &Property| matches!(property, Property::One { .. });
        let fixed = encoding != Encoding::Ascii && self.properties.iter().all(one);
        fixed.then(|| self.least_size(encoding))
    }

    /// The property that packs a colour into four bytes, where the columns have none; they get three behind the row's.
    pub(super) fn packed_color(
        &mut self,
        encoding: Encoding,
        columns: &mut Columns,
    ) -> Option<Packed> {
        if columns.color.is_some() {
            return None;
        }
        let values = self
            .properties
            .iter_mut()
            .filter_map(|property| match property {
                Property::One { name, scalar } => Some((name.to_lowercase(), scalar)),
                Property::List { .. } => None,
            });
        let mut values: Vec<(String, &mut Scalar)> = values.collect();
        let packs = |(name, scalar): &(String, &mut Scalar)| {
            ["rgb", "rgba"].contains(&name.as_str())
                && matches!(scalar, Scalar::I32 | Scalar::U32 | Scalar::F32)
        };
        let at = values.iter().position(packs)?;
        let behind = values.len();
        let is_float = *values[at].1 == Scalar::F32;
        let is_bits = is_float && encoding != Encoding::Ascii;
        if is_bits {
            // As a number, bits that are none would change.
            *values[at].1 = Scalar::U32;
        }
        columns.color = Some([behind, behind + 1, behind + 2]);
        columns.colors = ColorRange::Bytes;
        columns.scalars.retain(|(column, _)| *column != at);
        Some(Packed {
            at,
            is_float,
            is_bits,
        })
    }

    /// Which values of a row are what; `None` without x, y and z.
    fn columns(&self, encoding: Encoding) -> Option<Columns> {
        let names = self.names();
        let mut columns = Columns::from_names(&names)?;
        if self.is_splats() {
            // What depends on the direction of view is left out.
            let depends = |name: &str| name.starts_with("f_rest_") || name.starts_with("f_dc_");
            columns.scalars.retain(|(_, name)| !depends(name));
            if columns.color.is_none() {
                let at = |wanted: &str| names.iter().position(|name| name == wanted).unwrap_or(0);
                columns.color = Some(["f_dc_0", "f_dc_1", "f_dc_2"].map(at));
                columns.colors = ColorRange::Harmonics;
            }
        }
        let scalars: Vec<Scalar> = self
            .properties
            .iter()
            .filter_map(|property| match property {
                Property::One { scalar, .. } => Some(*scalar),
                Property::List { .. } => None,
            })
            .collect();
        if let Some(color) = columns.color
            && color.iter().all(|&i| scalars[i].size() == 1)
            && columns.colors != ColorRange::Harmonics
        {
            columns.colors = ColorRange::Bytes;
        }
        // Text may have more digits than the type that it names.
        if encoding != Encoding::Ascii && columns.position.iter().all(|&i| scalars[i].is_single()) {
            columns.precision = Precision::Single;
        }
        Some(columns)
    }
}

/// A colour in one value of a row.
pub(super) struct Packed {
    at: usize,
    is_float: bool,
    /// The row has the float's bits.
    is_bits: bool,
}

impl Packed {
    /// Red, green and blue.
    pub(super) fn color(&self, row: &[f64]) -> [f64; 3] {
        let (value, bits) = if self.is_bits {
            let bits = row[self.at] as u32;
            (f64::from(f32::from_bits(bits)), bits)
        } else {
            (row[self.at], (row[self.at] as f32).to_bits())
        };
        let [blue, green, red, _] = unpacked(self.is_float, value, bits).to_le_bytes();
        [red, green, blue].map(f64::from)
    }
}

/// Properties that Gaussian splats have and nothing else.
const SPLAT: [&str; 5] = ["f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0"];

/// Names that all differ: CloudCompare writes scalar fields of one name.
fn distinct(mut names: Vec<String>) -> Vec<String> {
    let mut taken = std::collections::BTreeSet::new();
    for name in &mut names {
        let first = name.clone();
        let mut count = 1;
        while !taken.insert(name.clone()) {
            count += 1;
            *name = format!("{first}_{count}");
        }
    }
    names
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
    /// Names of the pictures that textures show.
    pub(super) textures: Vec<String>,
    /// Its last line.
    line: u64,
}

/// The lines of a header that have been read.
#[derive(Default)]
pub(super) struct HeaderLines {
    encoding: Option<Encoding>,
    elements: Vec<Element>,
    textures: Vec<String>,
    /// How the first line ended.
    ending: Option<Ending>,
    /// Lines end with a line feed and a carriage return, in this order: the second is at the start of the next line.
    reversed: bool,
}

impl HeaderLines {
    /// Reads the lines at hand; the header, once all of it was there.
    pub(super) fn read(&mut self, input: &mut Input) -> Result<Option<Header>> {
        loop {
            let whole = input.rest();
            let start = input.mark();
            let Some(line) = input.line()? else {
                return match (input.last, self.ending) {
                    (false, _) => Ok(None),
                    (true, None) => Err(input.no_line("\"ply\"")),
                    (true, Some(_)) => {
                        let end = input.place.byte;
                        Err(input.bad_byte(end, "\"end_header\"", "the end of the file"))
                    }
                };
            };
            if self.ending.is_none() {
                if line.trim_ascii() != b"ply" {
                    return Err(input.bad_line("\"ply\"", line));
                }
                self.ending = Some(input.ending);
                continue;
            }
            let after_feed = self.ending == Some(Ending::LineFeed);
            self.reversed |=
                line.is_empty() && after_feed && input.ending == Ending::CarriageReturn;
            let text = String::from_utf8_lossy(line);
            let words: Vec<&str> = text.split_ascii_whitespace().collect();
            match words[..] {
                ["comment", key, _, ..] if key.eq_ignore_ascii_case("TextureFile") => {
                    let (_, name) = text.split_once(key).unwrap_or_default();
                    self.textures.push(name.trim().trim_matches('"').into());
                }
                [] | ["comment" | "obj_info", ..] => {}
                ["format", name, version] => {
                    self.encoding = Some(parse_encoding(name, version, input, line)?)
                }
                ["element", name, rows] => self.elements.push(Element {
                    name: name.into(),
                    rows: rows
                        .parse()
                        .map_err(|_| input.bad_line("a count of rows", rows.as_bytes()))?,
                    properties: Vec::new(),
                    line: input.place.line,
                }),
                ["property", ..] => match self.elements.last_mut() {
                    Some(element) => element
                        .properties
                        .push(parse_property(&words, input, line)?),
                    None => return Err(input.bad_line("an element before its properties", line)),
                },
                ["end_header"] => {
                    if self.reversed && input.rest().is_empty() && !input.last {
                        input.go_back(start);
                        return Ok(None);
                    }
                    if self.reversed && input.rest().first() == Some(&b'\r') {
                        input.skip(1);
                    }
                    let Some(encoding) = self.encoding else {
                        return Err(input.bad_line("a format line before end_header", line));
                    };
                    // Where lines end in \r alone, a \n after it is the first byte of the rows.
                    if self.ending == Some(Ending::CarriageReturn) && input.ending == Ending::Both {
                        input.put_back_line_feed(whole);
                    }
                    return Ok(Some(Header {
                        encoding,
                        elements: std::mem::take(&mut self.elements),
                        textures: std::mem::take(&mut self.textures),
                        line: input.place.line,
                    }));
                }
                _ => {
                    let expected = "a line of a PLY header (format, comment, obj_info, element, property, end_header)";
                    return Err(input.bad_line(expected, line));
                }
            }
        }
    }
}

impl Header {
    /// How many rows of the points the file has room for.
    pub(super) fn most_rows(&self, points: usize, input: &Input) -> u64 {
        let element = &self.elements[points];
        // The last line of a text needs no end.
        let room = (input.left() + 1) / element.least_size(self.encoding).max(1);
        element.rows.min(room)
    }

    /// The element that holds the points, and its columns.
    pub(super) fn points(&self, input: &Input) -> Result<(usize, Columns)> {
        let vertex = self.elements.iter().position(|e| e.name == "vertex");
        let with_xyz = || {
            self.elements
                .iter()
                .position(|e| e.columns(self.encoding).is_some())
        };
        let missing = |line: u64, found: String| {
            input.bad_at_line(line, "an element with properties x, y and z", found)
        };
        let Some(index) = vertex.or_else(with_xyz) else {
            let names = self.elements.iter().map(|e| e.name.clone()).collect();
            return Err(missing(self.line, described("element", names)));
        };
        let element = &self.elements[index];
        let names = element.names();
        let Some(columns) = element.columns(self.encoding) else {
            return Err(missing(element.line, described("property", names)));
        };
        Ok((index, columns))
    }
}

fn parse_encoding(name: &str, version: &str, input: &Input, line: &[u8]) -> Result<Encoding> {
    if version != "1.0" {
        return Err(input.bad_line("version 1.0", line));
    }
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(input.bad_line("ascii, binary_little_endian or binary_big_endian", line)),
    }
}

fn parse_property(words: &[&str], input: &Input, line: &[u8]) -> Result<Property> {
    let scalar = |name: &str| {
        Scalar::from_name(name).ok_or_else(|| {
            input.bad_line("a type (char … double, int8 … float64)", name.as_bytes())
        })
    };
    match *words {
        [_, "list", count, item, name] => Ok(Property::List {
            name: name.into(),
            count: scalar(count)?,
            item: scalar(item)?,
        }),
        [_, kind, name] if kind != "list" => Ok(Property::One {
            name: name.into(),
            scalar: scalar(kind)?,
        }),
        _ => Err(input.bad_line(
            "property <type> <name> or property list <type> <type> <name>",
            line,
        )),
    }
}

/// `no property`, or `property "x, y"`.
fn described(what: &str, names: Vec<String>) -> String {
    if names.is_empty() {
        return format!("no {what}");
    }
    format!("{what} {}", quote(names.join(", ").as_bytes()))
}
