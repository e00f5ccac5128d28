//! Gaussian splats as `.splat` (antimatter15) has them: 32 bytes each, the place and the size in single precision, colour and
//! opacity and rotation in bytes. Nothing in such a file says what it is: its name does.

use super::colors::ColorRange;
use super::input::Input;
use super::reading::{Parser, Step};
use super::table::{Columns, Precision, Table};
use crate::base::error::Result;

/// A word on what the points are.
pub(super) const SPLATS: &str = "The file holds Gaussian splats. Their centres are the points, and their colours those of no \
    direction of view: size, rotation and opacity are not looked at, and many centres lie off the surface.";

/// The columns of a splat's rows: place, colour, opacity.
pub(super) fn columns() -> Columns {
    Columns {
        color: Some([3, 4, 5]),
        colors: ColorRange::Bytes,
        scalars: vec![(6, "opacity".into())],
        precision: Precision::Single,
        ..Columns::xyz()
    }
}

/// Bytes of a splat.
const SIZE: usize = 32;

/// Reads the centres.
#[derive(Default)]
pub(super) struct Splats;

impl Parser for Splats {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        let most = input.left() / SIZE as u64;
        let table = table.get_or_insert_with(|| Table::new(columns(), Some(most)));
        while let Some(splat) = input.take(SIZE) {
            let number = |at: usize| {
                let bytes = [splat[at], splat[at + 1], splat[at + 2], splat[at + 3]];
                f64::from(f32::from_le_bytes(bytes))
            };
            let byte = |at: usize| f64::from(splat[at]);
            let opacity = byte(27) / 255.0;
            table.push(&[
                number(0),
                number(4),
                number(8),
                byte(24),
                byte(25),
                byte(26),
                opacity,
            ]);
        }
        match (input.last, input.rest().len()) {
            (false, _) => Ok(Step::More),
            (true, 0) => Ok(Step::Done),
            (true, _) => Err(input.no_bytes(SIZE as u64, "a splat")),
        }
    }

    fn notes(&self) -> Vec<String> {
        vec![SPLATS.into()]
    }
}
