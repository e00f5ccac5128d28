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

use super::RawCloud;
use super::lines::{Lines, number, quote};
use super::table::{Columns, Table};
use crate::error::{Error, Result};
use header::{Element, Encoding, Header, Property, Scalar, bad_line};

/// Whether the content starts as a PLY file does.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    let first = Lines::new(bytes, 0, 0).next().unwrap_or_default();
    first.trim_ascii() == b"ply"
}

/// Reads the points.
pub(super) fn read(bytes: &[u8]) -> Result<RawCloud> {
    let header = Header::parse(bytes)?;
    let (index, columns) = header.points()?;
    let (before, points) = (&header.elements[..index], &header.elements[index]);
    let mut cloud = match header.encoding {
        Encoding::Ascii => {
            let mut rows = AsciiRows {
                lines: Lines::new(bytes, header.end, header.lines),
            };
            before.iter().try_for_each(|element| rows.skip(element))?;
            // A row of text has at least a digit and a separator for each value.
            let most = (bytes.len() - rows.lines.at) / (2 * points.properties.len()) + 1;
            collect(points, columns, most, |row| rows.read(points, row))?
        }
        encoding => {
            let big_endian = encoding == Encoding::BigEndian;
            let mut rows = BinaryRows {
                bytes,
                at: header.end,
                big_endian,
            };
            before.iter().try_for_each(|element| rows.skip(element))?;
            let most = (bytes.len() - rows.at) / points.row_size().0;
            collect(points, columns, most, |row| rows.read(points, row))?
        }
    };
    let is_face = |element: &&Element| element.name == "face";
    cloud.faces = header
        .elements
        .iter()
        .find(is_face)
        .map_or(0, |face| face.rows);
    Ok(cloud)
}

/// All rows of the points; `most` is how many the bytes can hold.
fn collect(
    points: &Element,
    columns: Columns,
    most: usize,
    mut read_row: impl FnMut(&mut Vec<f64>) -> Result<()>,
) -> Result<RawCloud> {
    let rows = usize::try_from(points.rows).unwrap_or(usize::MAX).min(most);
    let mut table = Table::new(columns, rows);
    let mut row = Vec::new();
    for _ in 0..points.rows {
        row.clear();
        read_row(&mut row)?;
        table.push(&row);
    }
    Ok(table.finish())
}

/// Rows as text, one a line.
struct AsciiRows<'a> {
    lines: Lines<'a>,
}

impl<'a> AsciiRows<'a> {
    /// The next line that is not blank.
    fn line(&mut self, element: &Element) -> Result<&'a [u8]> {
        let is_row = |line: &&[u8]| !line.trim_ascii().is_empty();
        self.lines.find(is_row).ok_or_else(|| Error::BadFile {
            format: "PLY",
            place: "line",
            at: self.lines.number + 1,
            expected: format!(
                "one of {} rows of element {}",
                element.rows,
                quote(element.name.as_bytes())
            ),
            found: "the end of the file".into(),
        })
    }

    fn skip(&mut self, element: &Element) -> Result<()> {
        if element.properties.is_empty() {
            return Ok(());
        }
        (0..element.rows).try_for_each(|_| self.line(element).map(|_| ()))
    }

    /// The values of a row without its lists.
    fn read(&mut self, element: &Element, row: &mut Vec<f64>) -> Result<()> {
        let line = self.line(element)?;
        let at = self.lines.number;
        let mut tokens = line
            .split(u8::is_ascii_whitespace)
            .filter(|token| !token.is_empty());
        let mut next = || {
            let token = tokens.next().ok_or_else(|| {
                let expected = format!("{} values", element.properties.len());
                bad_line(at, &expected, line)
            })?;
            number(token).ok_or_else(|| bad_line(at, "a number", token))
        };
        for property in &element.properties {
            match property {
                Property::One { .. } => row.push(next()?),
                Property::List { .. } => {
                    let count = next()?;
                    let items =
                        list_length(count).ok_or_else(|| bad_line(at, "a list's length", line))?;
                    (0..items).try_for_each(|_| next().map(|_| ()))?;
                }
            }
        }
        match tokens.next() {
            None => Ok(()),
            Some(token) => Err(bad_line(at, "the end of the line", token)),
        }
    }
}

/// Binary rows.
struct BinaryRows<'a> {
    bytes: &'a [u8],
    at: usize,
    big_endian: bool,
}

impl<'a> BinaryRows<'a> {
    /// The next `size` bytes.
    fn take(&mut self, size: usize, element: &Element) -> Result<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        if size > rest.len() {
            return Err(Error::BadFile {
                format: "PLY",
                place: "byte",
                at: self.at as u64,
                expected: format!(
                    "{size} more bytes of {} rows of element {}",
                    element.rows,
                    quote(element.name.as_bytes())
                ),
                found: format!("{} bytes, then the end of the file", rest.len()),
            });
        }
        self.at += size;
        Ok(&rest[..size])
    }

    fn value(&mut self, scalar: Scalar, element: &Element) -> Result<f64> {
        let big_endian = self.big_endian;
        Ok(scalar.value(self.take(scalar.size(), element)?, big_endian))
    }

    fn skip(&mut self, element: &Element) -> Result<()> {
        let (size, fixed) = element.row_size();
        if fixed {
            let total = (size as u64).saturating_mul(element.rows);
            self.take(usize::try_from(total).unwrap_or(usize::MAX), element)?;
            return Ok(());
        }
        let mut row = Vec::new();
        for _ in 0..element.rows {
            row.clear();
            self.read(element, &mut row)?;
        }
        Ok(())
    }

    /// The values of a row without its lists.
    fn read(&mut self, element: &Element, row: &mut Vec<f64>) -> Result<()> {
        for property in &element.properties {
            match property {
                Property::One { scalar, .. } => row.push(self.value(*scalar, element)?),
                Property::List { count, item } => {
                    let at = self.at;
                    let length = self.value(*count, element)?;
                    let items = list_length(length).ok_or_else(|| Error::BadFile {
                        format: "PLY",
                        place: "byte",
                        at: at as u64,
                        expected: "a list's length".into(),
                        found: length.to_string(),
                    })?;
                    self.take(items.saturating_mul(item.size()), element)?;
                }
            }
        }
        Ok(())
    }
}

/// A list's length from its value in the file.
fn list_length(value: f64) -> Option<usize> {
    (value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0).then_some(value as usize)
}
