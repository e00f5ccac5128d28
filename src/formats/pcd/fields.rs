//! Fields of a point: their types, what they are, and their values.

use super::super::colors::ColorRange;
use super::super::table::{Columns, Precision};

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

/// The columns of the rows that `Body::push` makes: a value for each field, then red, green, blue where one packs them.
pub(super) fn columns(fields: &[Field], encoding: Encoding) -> Option<Columns> {
    // Fields with several values and padding have names of no meaning, and no attribute is made of them.
    let name = |(i, field): (usize, &Field)| {
        if field.count == 1 && field.name != "_" {
            field.name.clone()
        } else {
            format!("\0{i}")
        }
    };
    let mut names: Vec<String> = fields.iter().enumerate().map(name).collect();
    let packed = packed_color(fields);
    if let Some(packed) = packed {
        names[packed] = "\0".into();
        names.extend(["red", "green", "blue"].map(String::from));
    }
    let mut columns = Columns::from_names(&names)?;
    columns.scalars.retain(|(_, name)| !name.starts_with('\0'));
    if packed.is_some() {
        columns.colors = ColorRange::Bytes;
    }
    let is_single =
        |&i: &usize| fields[i].size < 4 || (fields[i].size == 4 && fields[i].kind == Kind::Float);
    // Text may have more digits than the type that it names.
    if encoding != Encoding::Ascii && columns.position.iter().all(is_single) {
        columns.precision = Precision::Single;
    }
    Some(columns)
}

/// The field that packs a colour into four bytes.
pub(super) fn packed_color(fields: &[Field]) -> Option<usize> {
    let packs = |field: &Field| {
        ["rgb", "rgba"].contains(&field.name.to_lowercase().as_str())
            && field.size >= 4
            && field.count == 1
    };
    fields.iter().position(packs)
}

/// A field's first value.
pub(super) fn value(field: &Field, bytes: &[u8]) -> f64 {
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
