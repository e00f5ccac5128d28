//! The packed points of a LAZ file, chunk by chunk.
//!
//! The crate `laz` trusts what it reads: it reserves what counts and sizes claim, and panics at data that no LASzip wrote.
//! So these are checked before it sees them, and a panic that is left is caught and becomes an error.

use super::super::input::Input;
use super::header::Header;
use super::layered::LayeredTimes;
use super::time::Times;
use crate::base::error::{Error, Result};
use laz::las::{v1, v2};
use laz::laszip::ChunkTable;
use laz::record::{
    LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor,
};
use laz::{DecompressionSelection, LazItem, LazItemRecordBuilder, LazItemType, LazVlr};
use std::io::{Cursor, ErrorKind};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Bytes of a variable length record before its content.
const RECORD_HEADER: usize = 54;

/// No scan is packed to more points a byte: points that are all the same come to 150 in chunks of the usual size. What claims
/// more is damaged, and would unpack to thousands of times its size.
const MOST_A_BYTE: u64 = 256;

/// How the points are laid out.
#[derive(Clone, Copy, PartialEq)]
enum Layout {
    /// One chunk.
    PointWise,
    /// Chunks of points.
    Chunked,
    /// Chunks of layers, one or more a field.
    Layered,
}

/// Where the next chunk starts, and what is known of it.
pub(super) struct Laz {
    vlr: LazVlr,
    layout: Layout,
    /// Byte of the next chunk.
    at: usize,
    /// Which chunk is next.
    chunk: usize,
    /// Bytes, and points where chunks differ in them.
    chunks: Option<ChunkTable>,
    record: usize,
}

impl Laz {
    /// Finds LASzip's record and the table of the chunks.
    pub(super) fn open(header: &Header, input: &Input) -> Result<Laz> {
        let bytes = input.rest();
        let (content, place) = laszip_record(header, input)?;
        let wrong = |found: String| {
            input.bad_byte(place as u64, "LASzip's description of the points", found)
        };
        let vlr = LazVlr::read_from(content).map_err(|error| wrong(error.to_string()))?;
        let layout = match content.first().zip(content.get(1)) {
            Some((1, 0)) => Layout::PointWise,
            Some((2, 0)) => Layout::Chunked,
            Some((3, 0)) => Layout::Layered,
            _ => {
                return Err(
                    input.unsupported("LASzip's point-wise and layered compression", "another")
                );
            }
        };
        let versions = if layout == Layout::Layered {
            3..=4
        } else {
            1..=2
        };
        let extra = header.record as u16 - header.format.len();
        let described = LazItemRecordBuilder::default_for_point_format_id(header.number, extra)
            .map_err(|error| wrong(error.to_string()))?;
        let kinds = |items: &[LazItem]| {
            items
                .iter()
                .map(LazItem::item_type)
                .collect::<Vec<LazItemType>>()
        };
        let whole = |item: &LazItem| versions.contains(&item.version());
        if kinds(vlr.items()) != kinds(&described) || !vlr.items().iter().all(whole) {
            let found = format!(
                "{:?} of versions {:?}",
                kinds(vlr.items()),
                vlr.items().iter().map(LazItem::version).collect::<Vec<_>>()
            );
            return Err(wrong(found));
        }
        if layout != Layout::PointWise && vlr.chunk_size() == 0 {
            return Err(wrong("chunks of no points".into()));
        }
        let start = header.start as usize;
        let chunks = if layout == Layout::PointWise {
            None
        } else {
            chunk_table((bytes, input.size), start, &vlr)
        };
        if layout == Layout::Chunked && vlr.uses_variable_size_chunks() && chunks.is_none() {
            return Err(input.bad_byte(start as u64, "the table of the chunks", "none"));
        }
        let at = if layout == Layout::PointWise {
            start
        } else {
            start + 8
        };
        Ok(Laz {
            vlr,
            layout,
            at,
            chunk: 0,
            chunks,
            record: header.record,
        })
    }

    /// Points and bytes of each chunk, of so many points in all, where each can be read without the table.
    pub(super) fn chunks_of(&self, points: u64) -> Option<Vec<(u64, u64)>> {
        if self.layout == Layout::Chunked && self.vlr.uses_variable_size_chunks() {
            return None;
        }
        let mut left = points;
        let of = |entry: &laz::laszip::ChunkTableEntry| {
            let points = entry.point_count.min(left);
            left -= points;
            (points, entry.byte_count)
        };
        let each: Vec<(u64, u64)> = self.chunks.as_ref()?.as_ref().iter().map(of).collect();
        (left == 0).then_some(each)
    }

    /// Unpacks the next chunk, of the `left` points that are still to come; how many it held.
    pub(super) fn read_chunk(
        &mut self,
        input: &Input,
        left: u64,
        mut push: impl FnMut(&[u8]),
    ) -> Result<u64> {
        let bytes = input.rest();
        let start = self.at;
        let bad = |found: String| input.bad_byte(start as u64, "a chunk of packed points", found);
        let entry = match &self.chunks {
            Some(chunks) => match chunks.as_ref().get(self.chunk) {
                Some(entry) => Some(*entry),
                None => {
                    return Err(bad(format!(
                        "the last of {} chunks before, and {left} points to come",
                        self.chunk
                    )));
                }
            },
            None => None,
        };
        let end = entry.map_or(bytes.len() as u64, |entry| {
            (start as u64).saturating_add(entry.byte_count)
        });
        let Some(chunk) = usize::try_from(end)
            .ok()
            .and_then(|end| bytes.get(start..end))
        else {
            return Err(bad(format!(
                "{} bytes, then the end of the file",
                bytes.len().saturating_sub(start)
            )));
        };
        let said = match self.layout {
            Layout::PointWise => left,
            Layout::Layered => layered_points(chunk, self.record, &self.vlr).map_err(bad)?,
            Layout::Chunked => match entry {
                Some(entry) if self.vlr.uses_variable_size_chunks() => entry.point_count,
                _ => u64::from(self.vlr.chunk_size()),
            },
        };
        let points = said.min(left);
        if points == 0 {
            return Err(bad(format!("no point, and {left} to come")));
        }
        if points / MOST_A_BYTE > chunk.len() as u64 {
            return Err(bad(format!("{points} points in {} bytes", chunk.len())));
        }
        let taken = guarded(|| self.unpack(chunk, points, &mut push)).map_err(bad)?;
        self.at = match entry {
            Some(_) => end as usize,
            None => start + taken,
        };
        self.chunk += 1;
        Ok(points)
    }

    /// Unpacks a chunk's points; how many bytes it had.
    fn unpack(
        &self,
        chunk: &[u8],
        points: u64,
        push: &mut dyn FnMut(&[u8]),
    ) -> std::result::Result<usize, laz::LasZipError> {
        let mut record = vec![0; self.record];
        let source = Cursor::new(chunk);
        let mut times = match self.layout {
            Layout::Layered => LayeredTimes::open(chunk, self.record, layers(&self.vlr))?,
            _ => None,
        };
        let mut all = |records: &mut dyn RecordDecompressor<Cursor<&[u8]>>| {
            for i in 0..points {
                records.decompress_next(&mut record)?;
                if let Some(times) = times.as_mut().filter(|_| i > 0) {
                    times.next(&mut record)?;
                }
                push(&record);
            }
            Ok::<(), laz::LasZipError>(())
        };
        if self.layout == Layout::Layered {
            let mut records = LayeredPointRecordDecompressor::new(source);
            records.set_fields_from(self.vlr.items())?;
            // Of the layers those that are used; times are decoded here.
            records.set_selection(
                DecompressionSelection::xy_returns_channel()
                    .decompress_z()
                    .decompress_classification()
                    .decompress_intensity()
                    .decompress_flags()
                    .decompress_scan_angle()
                    .decompress_user_data()
                    .decompress_point_source_id()
                    .decompress_extra_bytes()
                    .decompress_rgb()
                    .decompress_nir(),
            );
            all(&mut records)?;
            Ok(records.get().position() as usize)
        } else {
            let mut records = SequentialPointRecordDecompressor::new(source);
            for item in self.vlr.items() {
                add_field(&mut records, item)?;
            }
            all(&mut records)?;
            Ok(records.get().position() as usize)
        }
    }
}

/// How many layers a chunk has.
fn layers(vlr: &LazVlr) -> usize {
    let of = |item: &LazItem| match item.item_type() {
        LazItemType::Point14 => 9,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(bytes) => usize::from(bytes),
        _ => 1,
    };
    vlr.items().iter().map(of).sum()
}

/// As the crate does it, but for the times of version 2.
fn add_field<'a>(
    records: &mut SequentialPointRecordDecompressor<'a, Cursor<&'a [u8]>>,
    item: &LazItem,
) -> std::result::Result<(), laz::LasZipError> {
    let size = usize::from(item.size());
    match (item.item_type(), item.version()) {
        (LazItemType::Point10, 1) => {
            records.add_field_decompressor(v1::LasPoint0Decompressor::default())
        }
        (LazItemType::Point10, _) => {
            records.add_field_decompressor(v2::LasPoint0Decompressor::default())
        }
        (LazItemType::GpsTime, 1) => {
            records.add_field_decompressor(v1::LasGpsTimeDecompressor::default())
        }
        (LazItemType::GpsTime, _) => records.add_field_decompressor(Times::default()),
        (LazItemType::RGB12, 1) => {
            records.add_field_decompressor(v1::LasRGBDecompressor::default())
        }
        (LazItemType::RGB12, _) => {
            records.add_field_decompressor(v2::LasRGBDecompressor::default())
        }
        (LazItemType::Byte(_), 1) => {
            records.add_field_decompressor(v1::LasExtraByteDecompressor::new(size))
        }
        (LazItemType::Byte(_), _) => {
            records.add_field_decompressor(v2::LasExtraByteDecompressor::new(size))
        }
        (LazItemType::WavePacket13, _) => {
            records.add_field_decompressor(v1::LasWavepacketDecompressor::default())
        }
        (other, version) => {
            return Err(laz::LasZipError::UnsupportedLazItemVersion(other, version));
        }
    }
    Ok(())
}

/// The content of LASzip's variable length record, and where it is.
fn laszip_record<'a>(header: &Header, input: &Input<'a>) -> Result<(&'a [u8], usize)> {
    let bytes = input.rest();
    let mut at = header.records_start as usize;
    for _ in 0..header.records {
        let end = at + RECORD_HEADER;
        let Some(head) = bytes.get(at..end).filter(|_| end as u64 <= header.start) else {
            break;
        };
        let length = usize::from(u16::from_le_bytes([head[20], head[21]]));
        let is_laszip = head[2..18].starts_with(LazVlr::USER_ID.as_bytes())
            && u16::from_le_bytes([head[18], head[19]]) == LazVlr::RECORD_ID;
        if is_laszip {
            let content = bytes.get(end..end + length);
            return content
                .map(|content| (content, end))
                .ok_or_else(|| missing_record(header, input));
        }
        at = end + length;
    }
    Err(missing_record(header, input))
}

fn missing_record(header: &Header, input: &Input) -> Error {
    let expected = "LASzip's description of the packed points among the variable length records";
    input.bad_byte(header.records_start, expected, "none")
}

/// The table of the chunks, where there is one that can be right.
fn chunk_table((bytes, size): (&[u8], u64), start: usize, vlr: &LazVlr) -> Option<ChunkTable> {
    let number = |at: usize| Some(i64::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
    // A writer that could not go back has put the place at the end.
    let place = [number(start)?, number(bytes.len().checked_sub(8)?)?]
        .into_iter()
        .find(|&place| place > start as i64)?;
    let place = usize::try_from(place).ok()?;
    let count = u32::from_le_bytes(*bytes.get(place.checked_add(4)?..)?.first_chunk()?);
    // Every chunk has a point in full.
    if u64::from(count) > size / 20 {
        return None;
    }
    let mut source = Cursor::new(bytes);
    source.set_position(start as u64);
    guarded(|| ChunkTable::read_from(&mut source, vlr)).ok()
}

/// The count of points in a chunk of layers, whose sizes must be those of bytes that are there.
fn layered_points(chunk: &[u8], record: usize, vlr: &LazVlr) -> std::result::Result<u64, String> {
    let number = |at: usize| {
        chunk
            .get(at..)?
            .first_chunk()
            .map(|bytes| u64::from(u32::from_le_bytes(*bytes)))
    };
    let layers = layers(vlr);
    let short = || format!("{} bytes", chunk.len());
    let points = number(record).ok_or_else(short)?;
    let sizes: Option<u64> = (0..layers)
        .map(|layer| number(record + 4 + 4 * layer))
        .sum();
    let sizes = sizes.ok_or_else(short)?;
    let room = (chunk.len() - record - 4 - 4 * layers) as u64;
    if sizes > room {
        return Err(format!("layers of {sizes} bytes in {room}"));
    }
    Ok(points)
}

/// What the crate gives; its errors, and its panics, as text.
fn guarded<T>(
    call: impl FnOnce() -> std::result::Result<T, laz::LasZipError>,
) -> std::result::Result<T, String> {
    match catch_unwind(AssertUnwindSafe(call)) {
        Ok(result) => result.map_err(|error| match error {
            laz::LasZipError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
                "fewer bytes than its points take".into()
            }
            error => error.to_string(),
        }),
        Err(panic) => Err(panic_text(&panic)),
    }
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| text.to_string());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "data that cannot be unpacked".into())
}
