//! LAS 1.0 to 1.4 and LAZ (ASPRS; LASzip by Martin Isenburg), by the crates `las` and `laz`. Coordinates are the file's, scale
//! and offset applied in double precision. Attributes are `intensity` and `classification`, the other fields where one is not 0, and
//! the extra bytes that the file describes, scaled. Colours of 16 bits become 8, and those that are all 0 are none. Times
//! are counted from the first point's, because single precision does not hold them. A header that says 0 points, as loggers leave
//! it that never finish, is not believed where points follow.
//!
//! The records of a LAS file are read as they come. A LAZ file is kept until all of it is there, and unpacked chunk by
//! chunk. Variable length records are passed over but for LASzip's own, so that a wrong count of them does no harm.

mod chunks;
mod crs;
mod fields;
mod header;
mod layered;
mod laz;
mod time;

use super::input::Input;
use super::parser::{Parser, Step};
use super::table::Table;
use crate::base::error::Result;
use crate::cloud::Crs;
pub use chunks::chunks;
use header::{HEADER, Header};
use laz::Laz;

/// Reads the points.
#[derive(Default)]
pub(super) struct Las {
    crs: Option<Crs>,
    header: Option<Header>,
    laz: Option<Laz>,
    row: u64,
    /// Time of the first point.
    start: Option<f64>,
    values: Vec<f64>,
}

impl Parser for Las {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        let header = match &self.header {
            Some(header) => header,
            None => {
                if input.rest().len() < HEADER && !input.last {
                    return Ok(Step::More);
                }
                let header = Header::read(input)?;
                // Up to the points the variable length records are wanted, too.
                let wanted = header.start.min(input.size);
                if (input.rest().len() as u64) < wanted && !input.last {
                    return Ok(Step::More);
                }
                self.crs = crs::read(&header, input.rest());
                self.header.insert(header.with_extras(input))
            }
        };
        let table = table.get_or_insert_with(|| {
            let mut table = Table::new(header.columns(), Some(header.points));
            table.colors_said = false;
            table
        });
        if self.row == header.points {
            return Ok(self.after_points(input));
        }
        if header.packed {
            if !input.last {
                return Ok(Step::More);
            }
            let laz = match &mut self.laz {
                Some(laz) => laz,
                None => self.laz.insert(Laz::open(header, input)?),
            };
            let left = header.points - self.row;
            let (start, row) = (&mut self.start, &mut self.values);
            self.row += laz.read_chunk(input, left, |record| {
                header.push(record, start, row, table);
            })?;
            return Ok(if self.row == header.points {
                self.after_points(input)
            } else {
                Step::More
            });
        }
        input.skip(header.start.saturating_sub(input.place.byte));
        while self.row < header.points {
            let Some(record) = input.take(header.record) else {
                let missing = (header.points - self.row) * header.record as u64;
                return if input.last {
                    Err(input.no_bytes(missing, "points"))
                } else {
                    Ok(Step::More)
                };
            };
            header.push(record, &mut self.start, &mut self.values, table);
            self.row += 1;
        }
        Ok(self.after_points(input))
    }

    fn crs(&self) -> Option<Crs> {
        self.crs.clone()
    }

    fn notes(&self) -> Vec<String> {
        let start = self.start.filter(|start| *start != 0.0);
        start
            .map(|start| format!("The attribute gps_time counts the seconds from {start}."))
            .into_iter()
            .collect()
    }
}

/// Bytes behind the points among which a reference system is looked for: wave forms may be there, too.
const MOST_BEHIND: u64 = 1 << 24;

impl Las {
    /// Where nothing before the points says the reference system, a long record behind them may.
    fn after_points(&mut self, input: &mut Input) -> Step {
        let records = self.header.as_ref().and_then(|header| header.long_records);
        let Some((start, count)) = records.filter(|(start, _)| {
            self.crs.is_none() && *start >= input.place.byte && input.size - start <= MOST_BEHIND
        }) else {
            return Step::Done;
        };
        if !input.last {
            return Step::More;
        }
        input.skip(start - input.place.byte);
        self.crs = crs::read_long(count, input.rest());
        Step::Done
    }
}
