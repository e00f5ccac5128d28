//! The rows: as text, as bytes, or as columns that are packed.

use super::super::input::Input;
use super::super::lzf;
use super::super::parser::Step;
use super::super::table::{Columns, Table};
use super::super::text::number;
use super::picture::Picture;
use crate::base::error::Result;

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Ascii,
    Binary,
    Compressed,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Signed,
    Unsigned,
    Float,
}

/// A field: `count` values of `size` bytes.
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) size: usize,
    pub(super) count: usize,
}

/// The rows, and how far they have been read.
pub(super) struct Body {
    pub(super) encoding: Encoding,
    pub(super) fields: Vec<Field>,
    pub(super) points: u64,
    pub(super) columns: Columns,
    /// The field that packs a colour.
    pub(super) color: Option<usize>,
    pub(super) row: u64,
    pub(super) values: Vec<f64>,
    pub(super) viewpoint: Option<[f64; 3]>,
    /// Of an organised cloud that says no viewpoint.
    pub(super) picture: Option<Picture>,
}

impl Body {
    fn row_size(&self) -> usize {
        self.fields
            .iter()
            .map(|field| field.size * field.count)
            .sum()
    }

    /// How many rows the file has room for, unless they are packed.
    pub(super) fn most_rows(&self, input: &Input) -> Option<u64> {
        let row = match self.encoding {
            Encoding::Ascii => 2 * self.fields.len(),
            Encoding::Binary => self.row_size(),
            Encoding::Compressed => return None,
        };
        Some(self.points.min((input.left() + 1) / row.max(1) as u64))
    }

    pub(super) fn read(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        let step = match self.encoding {
            Encoding::Ascii => self.read_text(input, table),
            Encoding::Binary => self.read_rows(input, table),
            Encoding::Compressed => self.read_columns(input, table),
        }?;
        let is_picture = self.picture.as_ref().is_some_and(Picture::is_of_the_origin);
        let origin = is_picture.then_some([0.0; 3]);
        if let (Step::Done, Some(viewpoint)) = (step, self.viewpoint.or(origin)) {
            table.stations.begin(0, Some(viewpoint));
        }
        Ok(step)
    }

    fn read_text(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        while self.row < self.points {
            let line = match input.line()? {
                Some(line) if line.trim_ascii().is_empty() => continue,
                Some(line) => line,
                None if input.last => {
                    return Err(input.no_line(&format!("one of {} points", self.points)));
                }
                None => return Ok(Step::More),
            };
            // Some programs write commas.
            let mut words = line
                .split(|b| b.is_ascii_whitespace() || *b == b',')
                .filter(|word| !word.is_empty());
            self.values.clear();
            let mut packed = None;
            for (i, field) in self.fields.iter().enumerate() {
                let mut first = 0.0;
                for part in 0..field.count {
                    let Some(word) = words.next() else {
                        let all: usize = self.fields.iter().map(|field| field.count).sum();
                        return Err(input.bad_line(&format!("{all} values"), line));
                    };
                    let value = number(word).ok_or_else(|| input.bad_line("a number", word))?;
                    if part == 0 {
                        first = value;
                    }
                }
                if self.color == Some(i) {
                    packed = Some(unpacked(field, first, (first as f32).to_bits()));
                }
                self.values.push(first);
            }
            if let Some(extra) = words.next() {
                return Err(input.bad_line("the end of the line", extra));
            }
            self.push(packed, table);
        }
        Ok(Step::Done)
    }

    fn read_rows(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        let size = self.row_size();
        while self.row < self.points {
            let Some(row) = input.take(size) else {
                return if input.last {
                    let missing = (self.points - self.row).saturating_mul(size as u64);
                    Err(input.no_bytes(missing, &format!("{} points", self.points)))
                } else {
                    Ok(Step::More)
                };
            };
            let mut at = 0;
            self.push_bytes(
                |field| {
                    let here = at;
                    at += field.size * field.count;
                    &row[here..here + field.size * field.count]
                },
                table,
            );
        }
        Ok(Step::Done)
    }

    /// All of the first field's values, then all of the second's …
    fn read_columns(&mut self, input: &mut Input, table: &mut Table) -> Result<Step> {
        if !input.last {
            return Ok(Step::More);
        }
        let start = input.place.byte;
        let Some(&[a, b, c, d, e, f, g, h]) = input.take(8) else {
            return Err(input.no_bytes(8, "the sizes of the packed points"));
        };
        let (packed, unpacked) = (
            u32::from_le_bytes([a, b, c, d]),
            u32::from_le_bytes([e, f, g, h]),
        );
        let size = self.row_size();
        if Some(u64::from(unpacked)) != self.points.checked_mul(size as u64) {
            let expected = format!("{} points of {size} bytes each", self.points);
            return Err(input.bad_byte(start + 4, &expected, format!("{unpacked} bytes in all")));
        }
        let Some(bytes) = input.take(packed as usize) else {
            return Err(input.no_bytes(u64::from(packed), "packed points"));
        };
        let at_fault = |at: usize| {
            input.bad_byte(
                start + 8 + at as u64,
                "points packed by LZF",
                "bytes that do not unpack",
            )
        };
        let columns = lzf::unpack(bytes, unpacked as usize).map_err(at_fault)?;
        if columns.len() != unpacked as usize {
            return Err(input.bad_byte(
                start + 4,
                &format!("{unpacked} bytes once unpacked"),
                columns.len().to_string(),
            ));
        }
        for row in 0..self.points as usize {
            let mut column = 0;
            self.push_bytes(
                |field| {
                    let width = field.size * field.count;
                    let here = column + row * width;
                    column += width * (columns.len() / size);
                    &columns[here..here + width]
                },
                table,
            );
        }
        Ok(Step::Done)
    }

    /// A row from the bytes of each field, in order.
    fn push_bytes<'a>(&mut self, mut next: impl FnMut(&Field) -> &'a [u8], table: &mut Table) {
        self.values.clear();
        let mut packed = None;
        for (i, field) in self.fields.iter().enumerate() {
            let bytes = next(field);
            let first = if field.count == 0 {
                0.0
            } else {
                value(field, bytes)
            };
            if self.color == Some(i) {
                packed = Some(match *bytes {
                    [a, b, c, d] => unpacked(field, first, u32::from_le_bytes([a, b, c, d])),
                    _ => unpacked(field, first, (first as f32).to_bits()),
                });
            }
            self.values.push(first);
        }
        self.push(packed, table);
    }

    /// Puts the values into the table, and the colour after them.
    fn push(&mut self, packed: Option<u32>, table: &mut Table) {
        if let Some(packed) = packed {
            let [blue, green, red, _] = packed.to_le_bytes();
            self.values.extend([red, green, blue].map(f64::from));
        }
        if let Some(picture) = &mut self.picture {
            picture.push(self.columns.position.map(|column| self.values[column]));
        }
        table.push(&self.values);
        self.row += 1;
    }
}

/// The colour that a value packs: its integer, or, of a float, its `bits`. Some programs write the integer as a float's value: it
/// is whole and not tiny, as the bits of no colour are without transparency or with all of it.
fn unpacked(field: &Field, value: f64, bits: u32) -> u32 {
    let is_integer = (1.0..=f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0;
    if field.kind == Kind::Float && !is_integer {
        bits
    } else {
        value as i64 as u32
    }
}

/// A field's first value.
fn value(field: &Field, bytes: &[u8]) -> f64 {
    let mut raw = [0u8; 8];
    raw[..field.size].copy_from_slice(&bytes[..field.size]);
    let [a, b, c, d, ..] = raw;
    match (field.kind, field.size) {
        (Kind::Float, 4) => f64::from(f32::from_le_bytes([a, b, c, d])),
        (Kind::Float, _) => f64::from_le_bytes(raw),
        (Kind::Unsigned, _) => u64::from_le_bytes(raw) as f64,
        (Kind::Signed, 1) => f64::from(a as i8),
        (Kind::Signed, 2) => f64::from(i16::from_le_bytes([a, b])),
        (Kind::Signed, 4) => f64::from(i32::from_le_bytes([a, b, c, d])),
        (Kind::Signed, _) => i64::from_le_bytes(raw) as f64,
    }
}
