//! What of the header matters, and how a record becomes a row.

use super::super::colors::ColorRange;
use super::super::input::Input;
use super::super::las_names::FIELDS;
use super::super::table::{Columns, Precision, Table};
use super::fields::{self, ALWAYS, Extra};
use crate::base::error::Result;
use ::las::point::Format;
use ::las::raw;

/// Seconds. Times that start before are counted from 0 already: single precision holds them as well as those from the first point.
const SHORT: f64 = 4096.0;

/// The longest of the headers.
pub(super) const HEADER: usize = 375;

/// What of the header matters here.
pub(super) struct Header {
    pub(super) points: u64,
    /// Byte of the first point, of the first variable length record, and how many of those there are said to be.
    pub(super) start: u64,
    pub(super) records_start: u64,
    pub(super) records: u32,
    /// Byte of the first long record, behind the points, and how many of those there are said to be.
    pub(super) long_records: Option<(u64, u32)>,
    /// Number of the point format, and its fields.
    pub(super) number: u8,
    pub(super) format: Format,
    pub(super) packed: bool,
    /// Bytes a point, unpacked.
    pub(super) record: usize,
    pub(super) scale: [f64; 3],
    pub(super) offset: [f64; 3],
    pub(super) extras: Vec<Extra>,
}

impl Header {
    pub(super) fn read(input: &Input) -> Result<Header> {
        let bytes = input.rest();
        if !bytes.starts_with(b"LASF") {
            return Err(input.bad_byte(
                0,
                "\"LASF\"",
                crate::formats::text::quote(&bytes[..bytes.len().min(4)]),
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
        let long_records = header
            .evlr
            .map(|evlr| (evlr.start_of_first_evlr, evlr.number_of_evlrs))
            .filter(|(start, count)| *count > 0 && *start < input.size);
        Ok(Header {
            points,
            start,
            records_start,
            records,
            long_records,
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
    pub(super) fn with_extras(mut self, input: &Input) -> Header {
        let room = self.record - usize::from(self.format.len());
        if room > 0 {
            self.extras = fields::extras(input, self.start, self.records_start, self.records, room);
        }
        self
    }

    /// The columns of the rows that [`Header::push`] makes.
    pub(super) fn columns(&self) -> Columns {
        let extras = self.extras.iter().map(|extra| extra.name.as_str());
        let names = FIELDS.into_iter().chain(extras);
        let scalars = names.enumerate().map(|(i, name)| (6 + i, name.into()));
        // Those that are described are wanted even where all are 0.
        let (mut fields, extras): (Vec<_>, Vec<_>) =
            scalars.partition(|(i, _)| *i < 6 + FIELDS.len());
        // Not those that extra bytes stand in for.
        fields.retain(|(_, name): &(usize, String)| extras.iter().all(|(_, other)| other != name));
        let (always, optional): (Vec<_>, Vec<_>) =
            fields.into_iter().partition(|(i, _)| *i < 6 + ALWAYS);
        let mut scalars = always;
        scalars.extend(extras);
        let optional_from = scalars.len();
        scalars.extend(optional);
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
    pub(super) fn push(
        &self,
        record: &[u8],
        start: &mut Option<f64>,
        row: &mut Vec<f64>,
        table: &mut Table,
    ) {
        // The record is as long as the format, or longer: it can be read.
        let Ok(point) = raw::Point::read_from(record, &self.format) else {
            return;
        };
        let [x, y, z] = [point.x, point.y, point.z].map(f64::from);
        let color = point.color.unwrap_or_default();
        if start.is_none() {
            let first = point.gps_time.filter(|time| time.is_finite());
            *start = first.map(|time| if time.abs() < SHORT { 0.0 } else { time });
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
        let extra_bytes = &record[usize::from(self.format.len())..];
        let extra = |extra: &Extra| extra.value(extra_bytes);
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
