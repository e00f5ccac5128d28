//! PLY (Greg Turk, 1994): a text header that names elements and their properties, then rows, as text or binary.
//!
//! Read are all three encodings, all scalar types in both spellings, list properties in any element, elements in any
//! order, comments and `obj_info` anywhere in the header, and any end of line. The points are the element `vertex`, or
//! else the first element with x, y and z. Normals are `nx ny nz`, colours `red green blue` (bytes, 16 bits, or floats
//! from 0 to 1); every other scalar is an attribute, lists are passed over. Elements after the points are not looked at.
//!
//! Why not a crate: `ply-rs-bw`, the one that is kept up, makes a map from property name to value for every row, or
//! calls back with the name for every value, and reports errors as text. Here columns and the line or byte are wanted.

mod header;

use super::input::Input;
use super::reading::{Parser, Step};
use super::table::{Column, Table, names};
use super::text::{number, words};
use super::{Positions, RawCloud};
use crate::error::Result;
use header::{Element, Encoding, Header, HeaderLines, Property};
use std::fmt::Debug;
use std::io::Write;

/// Whether the content starts as a PLY file does.
pub(super) fn looks_like(head: &[u8]) -> bool {
    let first = head
        .split(|&b| b == b'\n' || b == b'\r')
        .next()
        .unwrap_or_default();
    first.trim_ascii() == b"ply"
}

/// Reads the points.
#[derive(Default)]
pub(super) struct Ply {
    header: HeaderLines,
    rows: Option<Rows>,
}

impl Parser for Ply {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        let rows = match &mut self.rows {
            Some(rows) => rows,
            None => {
                let Some(header) = self.header.read(input)? else {
                    return Ok(Step::More);
                };
                let (points, columns) = header.points(input)?;
                let most = header.most_rows(points, input);
                *table = Some(Table::new(columns, Some(most)));
                self.rows.insert(Rows {
                    header,
                    points,
                    element: 0,
                    row: 0,
                    skipped: 0,
                    values: Vec::new(),
                })
            }
        };
        match table {
            Some(table) => rows.read(input, table),
            None => Ok(Step::Done),
        }
    }

    fn faces(&self) -> u64 {
        let elements = self.rows.iter().flat_map(|rows| &rows.header.elements);
        elements
            .filter(|element| element.name == "face")
            .map(|face| face.rows)
            .next()
            .unwrap_or(0)
    }
}

/// The rows of the elements up to the points.
struct Rows {
    header: Header,
    /// Which element the points are.
    points: usize,
    /// The element whose rows come next, and how many of its rows, or of its bytes, have been.
    element: usize,
    row: u64,
    skipped: u64,
    values: Vec<f64>,
}

impl Rows {
    /// Reads what is at hand.
    fn read(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        while self.element <= self.points {
            let element = &self.header.elements[self.element];
            let points = self.element == self.points;
            if points {
                self.row += read_rows(
                    &self.header,
                    element,
                    self.row,
                    &mut self.values,
                    input,
                    |row| table.push(row),
                )?;
            } else if let Some(size) = element.fixed_size(self.header.encoding) {
                let total = size.saturating_mul(element.rows);
                self.skipped += input.skip(total - self.skipped);
                if self.skipped < total {
                    return if input.last {
                        Err(no_rows(input, total - self.skipped, element))
                    } else {
                        Ok(Step::More)
                    };
                }
                self.row = element.rows;
            } else {
                self.row += read_rows(
                    &self.header,
                    element,
                    self.row,
                    &mut self.values,
                    input,
                    |_| (),
                )?;
            }
            if self.row < element.rows {
                return Ok(Step::More);
            }
            (self.element, self.row, self.skipped) = (self.element + 1, 0, 0);
        }
        Ok(Step::Done)
    }
}

/// Reads rows of an element, of which `read` have been; how many they were. All, where nothing follows.
fn read_rows(
    header: &Header,
    element: &Element,
    read: u64,
    values: &mut Vec<f64>,
    input: &mut Input,
    mut row: impl FnMut(&[f64]),
) -> Result<u64> {
    if element.properties.is_empty() {
        return Ok(element.rows);
    }
    let mut count = 0;
    while read + count < element.rows {
        values.clear();
        let whole = match header.encoding {
            Encoding::Ascii => read_text_row(element, input, values)?,
            encoding => read_binary_row(element, encoding == Encoding::BigEndian, input, values)?,
        };
        if !whole {
            break;
        }
        row(values);
        count += 1;
    }
    Ok(count)
}

/// A line that is not blank: its values without its lists. `false` where it is not at hand.
fn read_text_row(element: &Element, input: &mut Input, row: &mut Vec<f64>) -> Result<bool> {
    let line = loop {
        match input.line()? {
            Some(line) if line.trim_ascii().is_empty() => {}
            Some(line) => break line,
            None if input.last => return Err(input.no_line(&rows_of(element))),
            None => return Ok(false),
        }
    };
    let mut tokens = words(line);
    let mut next = || {
        let token = tokens.next().ok_or_else(|| {
            let expected = format!("{} values", element.properties.len());
            input.bad_line(&expected, line)
        })?;
        number(token).ok_or_else(|| input.bad_line("a number", token))
    };
    for property in &element.properties {
        match property {
            Property::One { .. } => row.push(next()?),
            Property::List { .. } => {
                let items =
                    list_length(next()?).ok_or_else(|| input.bad_line("a list's length", line))?;
                (0..items).try_for_each(|_| next().map(|_| ()))?;
            }
        }
    }
    match tokens.next() {
        None => Ok(true),
        Some(token) => Err(input.bad_line("the end of the line", token)),
    }
}

/// A binary row: its values without its lists. `false` where it is not at hand.
fn read_binary_row(
    element: &Element,
    big_endian: bool,
    input: &mut Input,
    row: &mut Vec<f64>,
) -> Result<bool> {
    let here = input.rest();
    let mut at = 0;
    for property in &element.properties {
        let (Property::One { scalar, .. } | Property::List { count: scalar, .. }) = property;
        let Some(bytes) = here.get(at..at + scalar.size()) else {
            return missing(input, (at + scalar.size()) as u64, element);
        };
        let value = scalar.value(bytes, big_endian);
        match property {
            Property::One { .. } => row.push(value),
            Property::List { item, .. } => {
                let items = list_length(value).ok_or_else(|| {
                    input.bad_byte(
                        input.place.byte + at as u64,
                        "a list's length",
                        value.to_string(),
                    )
                })?;
                at = at.saturating_add(items.saturating_mul(item.size()));
            }
        }
        at = at.saturating_add(scalar.size());
        if at > here.len() {
            return missing(input, at as u64, element);
        }
    }
    Ok(input.take(at).is_some())
}

/// A row of `length` bytes is not at hand.
fn missing(input: &Input, length: u64, element: &Element) -> Result<bool> {
    // What a list says is longer than the file is never waited for.
    if input.last || length > input.left() {
        return Err(no_rows(input, length, element));
    }
    Ok(false)
}

fn no_rows(input: &Input, length: u64, element: &Element) -> crate::Error {
    input.no_bytes(length, &rows_of(element))
}

fn rows_of(element: &Element) -> String {
    format!(
        "{} rows of element {}",
        element.rows,
        super::text::quote(element.name.as_bytes())
    )
}

/// A list's length from its value in the file.
fn list_length(value: f64) -> Option<usize> {
    (value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0).then_some(value as usize)
}

/// Writes points and, with `triangles`, faces. Positions are `double` where they or the origin need it.
pub(super) fn write(cloud: &RawCloud, triangles: Option<&[u32]>, ascii: bool) -> Vec<u8> {
    let double = cloud.origin.is_some() || matches!(cloud.positions, Positions::F64(_));
    let mut out = write_header(cloud, triangles, ascii, double).into_bytes();
    let origin = cloud.origin.unwrap_or_default();
    let mut sink = Sink {
        out: &mut out,
        ascii,
        first: true,
    };
    for i in 0..cloud.points() {
        for (axis, start) in origin.iter().enumerate() {
            let x = cloud.positions.get(3 * i + axis) + start;
            if double {
                sink.f64(x)
            } else {
                sink.f32(x as f32)
            }
        }
        for &n in cloud
            .normals
            .iter()
            .flat_map(|normals| &normals[3 * i..3 * i + 3])
        {
            sink.f32(n);
        }
        for &c in cloud
            .colors
            .iter()
            .flat_map(|colors| &colors[3 * i..3 * i + 3])
        {
            sink.u8(c);
        }
        for attribute in &cloud.attributes {
            sink.f32(attribute.values[i]);
        }
        sink.end_row();
    }
    for triangle in triangles.unwrap_or_default().chunks_exact(3) {
        sink.u8(3);
        triangle.iter().for_each(|&index| sink.u32(index));
        sink.end_row();
    }
    out
}

fn write_header(cloud: &RawCloud, triangles: Option<&[u32]>, ascii: bool, double: bool) -> String {
    let encoding = if ascii {
        "ascii"
    } else {
        "binary_little_endian"
    };
    let mut header = format!(
        "ply\nformat {encoding} 1.0\ncomment Pointweave\nelement vertex {}\n",
        cloud.points()
    );
    for (name, column) in names(cloud) {
        let kind = match column {
            Column::Position if double => "double",
            Column::Position | Column::Float => "float",
            Column::Byte => "uchar",
        };
        header += &format!("property {kind} {name}\n");
    }
    if let Some(indices) = triangles {
        // Signed, as most readers expect.
        header += &format!(
            "element face {}\nproperty list uchar int vertex_indices\n",
            indices.len() / 3
        );
    }
    header + "end_header\n"
}

/// Values into rows: little endian bytes, or text that reads back to the same bits.
struct Sink<'a> {
    out: &'a mut Vec<u8>,
    ascii: bool,
    /// No value of the row was written yet.
    first: bool,
}

impl Sink<'_> {
    fn put(&mut self, bytes: &[u8], text: &dyn Debug) {
        if !self.ascii {
            self.out.extend(bytes);
            return;
        }
        if !self.first {
            self.out.push(b' ');
        }
        self.first = false;
        // Writing to a vector cannot fail.
        let _ = write!(self.out, "{text:?}");
    }

    fn f64(&mut self, value: f64) {
        self.put(&value.to_le_bytes(), &value);
    }

    fn f32(&mut self, value: f32) {
        self.put(&value.to_le_bytes(), &value);
    }

    fn u8(&mut self, value: u8) {
        self.put(&[value], &value);
    }

    fn u32(&mut self, value: u32) {
        self.put(&value.to_le_bytes(), &value);
    }

    fn end_row(&mut self) {
        if self.ascii {
            self.out.push(b'\n');
            self.first = true;
        }
    }
}
