//! The fields of a point besides place and colour, and the extra bytes that a file describes.

use super::super::input::Input;
use super::super::las_names::{FIELDS, FLOAT};
use ::las::raw::Point;
use ::las::raw::point::{Flags, ScanAngle};

/// How many of [`FIELDS`] are always attributes; the others where one is not 0.
pub(super) const ALWAYS: usize = 2;

/// Values of [`FIELDS`]; the time counted from `start`.
pub(super) fn values(point: &Point, start: f64) -> [f64; FIELDS.len()] {
    let bits = |byte: u8, at: u8, count: u8| f64::from((byte >> at) & ((1 << count) - 1));
    let (class, flags) = match point.flags {
        Flags::TwoByte(a, b) => (
            f64::from(b & 31),
            [
                bits(a, 0, 3),
                bits(a, 3, 3),
                bits(a, 6, 1),
                bits(a, 7, 1),
                bits(b, 5, 1),
                bits(b, 6, 1),
                bits(b, 7, 1),
                0.0,
                0.0,
            ],
        ),
        Flags::ThreeByte(a, b, class) => (
            f64::from(class),
            [
                bits(a, 0, 4),
                bits(a, 4, 4),
                bits(b, 6, 1),
                bits(b, 7, 1),
                bits(b, 0, 1),
                bits(b, 1, 1),
                bits(b, 2, 1),
                bits(b, 3, 1),
                bits(b, 4, 2),
            ],
        ),
    };
    let angle = match point.scan_angle {
        ScanAngle::Rank(degrees) => f64::from(degrees),
        // In steps of 0.006 degrees.
        ScanAngle::Scaled(steps) => f64::from(steps) * 0.006,
    };
    let packet = point.waveform.as_ref();
    let [a, b, c, d, e, f, g, h, i] = flags;
    [
        f64::from(point.intensity),
        class,
        f64::from(point.nir.unwrap_or(0)),
        a,
        b,
        c,
        d,
        e,
        f,
        g,
        h,
        i,
        angle,
        f64::from(point.user_data),
        f64::from(point.point_source_id),
        point.gps_time.map_or(0.0, |time| time - start),
        packet.map_or(0.0, |packet| f64::from(packet.wave_packet_descriptor_index)),
    ]
}

/// A value among a point's extra bytes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Extra {
    pub(super) name: String,
    /// Where it is, and its type's number.
    at: usize,
    kind: u8,
    scale: f64,
    offset: f64,
    no_data: Option<f64>,
}

/// Bytes of the description of an extra value.
const DESCRIPTION: usize = 192;

/// Bytes of each type, by its number.
const SIZES: [usize; 11] = [0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8];

/// What a file says of the extra bytes of its points, of which there are `room`; its variable length records are at hand.
pub(super) fn extras(
    input: &Input,
    start: u64,
    records_start: u64,
    records: u32,
    room: usize,
) -> Vec<Extra> {
    let bytes = &input.rest()[..input.rest().len().min(start as usize)];
    let mut at = records_start as usize;
    for _ in 0..records {
        let Some(head) = bytes.get(at..at + RECORD_HEADER) else {
            break;
        };
        let length = usize::from(u16::from_le_bytes([head[20], head[21]]));
        let is_extra = head[2..18].starts_with(b"LASF_Spec\0") && head[18..20] == [4, 0];
        at += RECORD_HEADER;
        if is_extra {
            return described(bytes.get(at..at + length).unwrap_or_default(), room);
        }
        at += length;
    }
    Vec::new()
}

/// Bytes of a variable length record before its content.
const RECORD_HEADER: usize = 54;

fn described(content: &[u8], room: usize) -> Vec<Extra> {
    let mut extras: Vec<Extra> = Vec::new();
    let mut at = 0;
    for description in content.chunks_exact(DESCRIPTION) {
        let (kind, options) = (description[2], description[3]);
        let name = &description[4..36];
        let name = name.split(|&b| b == 0).next().unwrap_or_default();
        let name = String::from_utf8_lossy(name).trim().to_string();
        // Types 11 to 30 are two or three values of the types 1 to 10 and no longer in use; type 0 is bytes of no meaning.
        let (count, kind) = match kind {
            0 => (0, 0),
            1..=30 => (1 + usize::from(kind - 1) / 10, (kind - 1) % 10 + 1),
            _ => break,
        };
        let size = if kind == 0 {
            usize::from(options)
        } else {
            SIZES[usize::from(kind)]
        };
        for part in 0..count {
            let number = |from: usize| f64::from_le_bytes(eight(description, from + 8 * part));
            let said = |bit: u8| kind != 0 && options & bit != 0;
            let scale = if said(8) { number(112) } else { 1.0 };
            let offset = if said(16) { number(136) } else { 0.0 };
            let missing =
                said(1).then(|| raw(&description[40 + 8 * part..48 + 8 * part], wide(kind)));
            if at + (part + 1) * size > room || !scale.is_finite() || !offset.is_finite() {
                return extras;
            }
            let name = if count == 1 {
                name.clone()
            } else {
                format!("{name} {part}")
            };
            extras.push(Extra {
                name: free_name(name, &extras),
                at: at + part * size,
                kind,
                scale,
                offset,
                no_data: missing,
            });
        }
        at += if kind == 0 { size } else { count * size };
    }
    extras
}

/// A name that neither a field nor an extra value has; that of a field where the bytes say that they stand in for it.
fn free_name(name: String, extras: &[Extra]) -> String {
    let own = name
        .strip_suffix(FLOAT)
        .filter(|name| FIELDS.contains(name));
    let first = match own {
        Some(field) => field.into(),
        None if name.is_empty() => "extra".into(),
        None => name.clone(),
    };
    let mut free: String = first.clone();
    let mut count = 1;
    let is_field = |name: &str| FIELDS.contains(&name) && own != Some(name);
    while is_field(&free) || extras.iter().any(|extra| extra.name == free) {
        count += 1;
        free = format!("{first}_{count}");
    }
    free
}

impl Extra {
    /// Its value among a point's extra bytes; NaN where the file marks it as missing.
    pub(super) fn value(&self, bytes: &[u8]) -> f64 {
        let size = SIZES[usize::from(self.kind)];
        let Some(bytes) = bytes.get(self.at..self.at + size) else {
            return 0.0;
        };
        let value = raw(bytes, self.kind);
        if self.no_data == Some(value) {
            f64::NAN
        } else {
            value * self.scale + self.offset
        }
    }
}

/// The type of the same kind of number that has eight bytes.
fn wide(kind: u8) -> u8 {
    match kind {
        9 | 10 => 10,
        kind if kind % 2 == 0 => 8,
        _ => 7,
    }
}

fn eight(bytes: &[u8], at: usize) -> [u8; 8] {
    std::array::from_fn(|i| bytes[at + i])
}

/// A number of a type.
fn raw(bytes: &[u8], kind: u8) -> f64 {
    let mut all = [0; 8];
    all[..bytes.len()].copy_from_slice(bytes);
    let [a, b, c, d, ..] = all;
    match kind {
        2 => f64::from(a as i8),
        4 => f64::from(i16::from_le_bytes([a, b])),
        6 => f64::from(i32::from_le_bytes([a, b, c, d])),
        8 => i64::from_le_bytes(all) as f64,
        9 => f64::from(f32::from_le_bytes([a, b, c, d])),
        10 => f64::from_le_bytes(all),
        _ => u64::from_le_bytes(all) as f64,
    }
}
