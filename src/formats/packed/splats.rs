//! Gaussian splats as SPZ (Niantic, versions 1 to 3) has them: a gzip file of columns.

use super::super::input::Input;
use super::super::reading::{Parser, Step};
use super::super::splats::{SPLATS, columns};
use super::super::table::Table;
use super::Archive;
use crate::base::error::Result;

/// Reads the centres.
#[derive(Default)]
pub(in super::super) struct Spz;

/// Bytes of the head.
const HEADER: usize = 16;

impl Parser for Spz {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if !input.last {
            return Ok(Step::More);
        }
        let bytes = input.rest();
        let unpacked = if Archive::looks_like(bytes) {
            let archive = Archive::open(bytes, None)?;
            archive.unpack(&archive.entries[0])?
        } else {
            bytes.to_vec()
        };
        let head: &[u8; HEADER] = match unpacked.first_chunk() {
            Some(head) if head.starts_with(b"NGSP") => head,
            _ => {
                let found = super::super::text::quote(&unpacked[..unpacked.len().min(4)]);
                return Err(input.bad_byte(0, "\"NGSP\" once it is unpacked", found));
            }
        };
        let word =
            |at: usize| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
        let (version, points) = (word(4), word(8) as usize);
        if !(1..=3).contains(&version) {
            return Err(input.unsupported("versions 1 to 3", format!("version {version}")));
        }
        let steps = f64::from(1u32 << head[13].min(31));
        let each = if version == 1 { 6 } else { 9 };
        let content = &unpacked[HEADER..];
        let sizes = [each, 1, 3].map(|size| points.saturating_mul(size));
        if sizes
            .iter()
            .fold(0, |all: usize, size| all.saturating_add(*size))
            > content.len()
        {
            let found = format!("{} bytes", content.len());
            return Err(input.bad_byte(0, &format!("{points} splats once it is unpacked"), found));
        }
        let (places, rest) = content.split_at(sizes[0]);
        let (opacities, rest) = rest.split_at(sizes[1]);
        let colors = &rest[..sizes[2]];
        let table = table.insert(Table::new(columns(), Some(points as u64)));
        for point in 0..points {
            let place = &places[each * point..each * (point + 1)];
            let coordinate = |axis: usize| match version {
                1 => half(u16::from_le_bytes([place[2 * axis], place[2 * axis + 1]])),
                _ => {
                    let [a, b, c] = [0, 1, 2].map(|i| place[3 * axis + i]);
                    f64::from(i32::from_le_bytes([0, a, b, c]) >> 8) / steps
                }
            };
            let color = |channel: usize| color(colors[3 * point + channel]);
            let opacity = f64::from(opacities[point]) / 255.0;
            let row = [
                coordinate(0),
                coordinate(1),
                coordinate(2),
                color(0),
                color(1),
                color(2),
                opacity,
            ];
            table.push(&row);
        }
        Ok(Step::Done)
    }

    fn notes(&self) -> Vec<String> {
        vec![SPLATS.into()]
    }
}

/// From a coefficient of the spherical harmonic of degree 0, in a byte, to a colour from 0 to 255.
fn color(byte: u8) -> f64 {
    const STEP: f64 = 0.15;
    const HARMONIC_0: f64 = 0.282_094_791_773_878_14;
    let coefficient = (f64::from(byte) / 255.0 - 0.5) / STEP;
    (255.0 * (0.5 + HARMONIC_0 * coefficient))
        .clamp(0.0, 255.0)
        .round()
}

/// A number of half precision.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (
        i32::from((bits >> 10) & 31),
        f64::from(bits & 1023) / 1024.0,
    );
    let power = |exponent: i32| f64::from_bits(((1023 + exponent) as u64) << 52);
    match exponent {
        0 => sign * fraction * power(-14),
        31 if fraction == 0.0 => sign * f64::INFINITY,
        31 => f64::NAN,
        _ => sign * (1.0 + fraction) * power(exponent - 15),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_precision() {
        for (bits, value) in [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x3555, 0.333_251_953_125),
            (0x0001, 5.960_464_477_539_063e-8),
        ] {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7e00).is_nan() && half(0xfc00) == f64::NEG_INFINITY);
    }

    #[test]
    fn the_middle_of_the_bytes_is_grey() {
        assert_eq!([color(0), color(255)], [0.0, 255.0]);
        assert!((color(128) - 128.0).abs() <= 1.0);
    }
}
