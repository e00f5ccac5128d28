//! LAS 1.0 to 1.4 and LAZ (ASPRS; LASzip by Martin Isenburg), by the crates `las` and `laz`. Coordinates are the file's, scale
//! and offset applied in double precision. Attributes are `intensity` and `classification`, the other fields where one is not 0, and
//! the extra bytes that the file describes, scaled. Colours of 16 bits become 8, and those that are all 0 are none. Times
//! are counted from the first point's, because single precision does not hold them; those of LAZ in layers (point
//! formats 6 to 10) are left out. A header that says 0 points, as loggers leave it that never finish, is not believed where
//! points follow.
//!
//! The records of a LAS file are read as they come. A LAZ file is kept until all of it is there, and unpacked chunk by
//! chunk. Variable length records are passed over but for LASzip's own, so that a wrong count of them does no harm.

mod crs;
mod fields;
mod laz;
mod time;

use super::colors::ColorRange;
use super::input::Input;
use super::reading::{Parser, Step};
use super::table::{Columns, Precision, Table};
use crate::base::error::Result;
use crate::cloud::Crs;
use ::las::point::Format;
use ::las::raw;
use fields::{ALWAYS, Extra, FIELDS};
use laz::Laz;

/// The longest of the headers.
const HEADER: usize = 375;

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
            return Ok(Step::Done);
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
                Step::Done
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
        Ok(Step::Done)
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

/// What of the header matters here.
struct Header {
    points: u64,
    /// Byte of the first point, of the first variable length record, and how many of those there are said to be.
    start: u64,
    records_start: u64,
    records: u32,
    /// Number of the point format, and its fields.
    number: u8,
    format: Format,
    packed: bool,
    /// Bytes a point, unpacked.
    record: usize,
    scale: [f64; 3],
    offset: [f64; 3],
    extras: Vec<Extra>,
}

impl Header {
    fn read(input: &Input) -> Result<Header> {
        let bytes = input.rest();
        if !bytes.starts_with(b"LASF") {
            return Err(input.bad_byte(
                0,
                "\"LASF\"",
                super::text::quote(&bytes[..bytes.len().min(4)]),
            ));
        }
        if let Some(&[major, minor]) = bytes.get(24..26)
            && (major != 1 || minor > 4)
        {
            return Err(input.unsupported("version 1.0 to 1.4", format!("version {major}.{minor}")));
        }
        // The header's own size is of no use here, and a wrong one makes the crate want more bytes than there are.
        let mut fields = bytes[..bytes.len().min(HEADER)].to_vec();
        if let Some(size) = fields.get_mut(94..96) {
            size.copy_from_slice(&[0, 0]);
        }
        let header = raw::Header::read_from(&fields[..])
            .map_err(|_| input.no_bytes(HEADER as u64, "the header"))?;
        let number = header.point_data_record_format & 0x3f;
        let format = Format::new(number).map_err(|_| {
            input.unsupported(
                "point formats 0 to 10",
                format!("point format {}", header.point_data_record_format),
            )
        })?;
        let packed = header.point_data_record_format != number;
        let record = usize::from(header.point_data_record_length);
        if record < usize::from(format.len()) {
            let expected = format!("at least {} bytes a point of format {number}", format.len());
            return Err(input.bad_byte(105, &expected, record.to_string()));
        }
        let start = u64::from(header.offset_to_point_data);
        let legacy = u64::from(header.number_of_point_records);
        let points = match header.large_file {
            Some(large) if legacy == 0 => large.number_of_point_records,
            _ => legacy,
        };
        let scale = [
            header.x_scale_factor,
            header.y_scale_factor,
            header.z_scale_factor,
        ];
        let offset = [header.x_offset, header.y_offset, header.z_offset];
        if !scale.iter().all(|s| s.is_finite() && *s != 0.0)
            || !offset.iter().all(|o| o.is_finite())
        {
            return Err(input.bad_byte(
                131,
                "scales that are not 0 and offsets",
                format!("{scale:?} and {offset:?}"),
            ));
        }
        let points = match points {
            0 if !packed => unfinished(&header, input.size),
            points => points,
        };
        // Without points it does not matter where they start.
        let room = input.size.saturating_sub(start);
        if points > 0 && (start < 227 || room == 0) {
            return Err(input.bad_byte(
                96,
                "the byte at which the points start",
                format!("{start} of {}", input.size),
            ));
        }
        if !packed && points > room / record as u64 {
            let expected = format!("{points} points of {record} bytes from byte {start} on");
            return Err(input.bad_byte(
                input.size,
                &expected,
                format!("{} of them, then the end of the file", room / record as u64),
            ));
        }
        let records_start = u64::from(header.header_size);
        let records_start = if records_start == 0 {
            bytes
                .get(94..96)
                .map_or(0, |size| u64::from(u16::from_le_bytes([size[0], size[1]])))
        } else {
            records_start
        };
        let records = header.number_of_variable_length_records;
        Ok(Header {
            points,
            start,
            records_start,
            records,
            number,
            format,
            packed,
            record,
            scale,
            offset,
            extras: Vec::new(),
        })
    }

    /// With what the file says of the points' extra bytes.
    fn with_extras(mut self, input: &Input) -> Header {
        let room = self.record - usize::from(self.format.len());
        if room > 0 {
            self.extras = fields::extras(input, self.start, self.records_start, self.records, room);
        }
        self
    }

    /// The columns of the rows that [`Header::push`] makes.
    fn columns(&self) -> Columns {
        let extras = self.extras.iter().map(|extra| extra.name.as_str());
        let names = FIELDS.into_iter().chain(extras);
        let scalars = names.enumerate().map(|(i, name)| (6 + i, name.into()));
        // Those that are described are wanted even where all are 0.
        let (fields, extras): (Vec<_>, Vec<_>) = scalars.partition(|(i, _)| *i < 6 + FIELDS.len());
        let (always, optional) = fields.split_at(ALWAYS);
        let mut scalars = always.to_vec();
        scalars.extend(extras);
        let optional_from = scalars.len();
        scalars.extend(optional.iter().cloned());
        Columns {
            color: self.format.has_color.then_some([3, 4, 5]),
            scalars,
            optional_from,
            colors: ColorRange::Integers,
            precision: Precision::Double,
            ..Columns::xyz()
        }
    }

    /// A record as a row.
    fn push(&self, record: &[u8], start: &mut Option<f64>, row: &mut Vec<f64>, table: &mut Table) {
        // The record is as long as the format, or longer: it can be read.
        let Ok(point) = raw::Point::read_from(record, &self.format) else {
            return;
        };
        let [x, y, z] = [point.x, point.y, point.z].map(f64::from);
        let color = point.color.unwrap_or_default();
        if start.is_none() {
            *start = point.gps_time.filter(|time| time.is_finite());
        }
        table.colors_said |= [color.red, color.green, color.blue] != [0; 3];
        row.clear();
        row.extend([
            x * self.scale[0] + self.offset[0],
            y * self.scale[1] + self.offset[1],
            z * self.scale[2] + self.offset[2],
            f64::from(color.red),
            f64::from(color.green),
            f64::from(color.blue),
        ]);
        row.extend(fields::values(&point, start.unwrap_or(0.0)));
        let extra = |extra: &Extra| extra.value(&point.extra_bytes);
        row.extend(self.extras.iter().map(extra));
        table.push(row);
    }
}

/// Points behind a header that says 0 of them: the whole records up to the end, or to what the header says follows.
fn unfinished(header: &raw::Header, size: u64) -> u64 {
    let start = u64::from(header.offset_to_point_data);
    let follows = header.evlr.map(|evlr| evlr.start_of_first_evlr);
    let end = follows.filter(|end| *end > start).unwrap_or(size).min(size);
    let record = u64::from(header.point_data_record_length).max(1);
    if start < 227 {
        0
    } else {
        end.saturating_sub(start) / record
    }
}
