//! The coordinate reference system among the variable length records: well-known text, or GeoTIFF's keys. A text that is too
//! long for them is in a long one behind the points.

use super::header::Header;
use crate::cloud::Crs;

/// Bytes of a record before its content, and its numbers.
const RECORD_HEADER: usize = 54;
const LONG_RECORD_HEADER: usize = 60;
const USER: &[u8] = b"LASF_Projection";
const TEXT: u16 = 2112;
const KEYS: u16 = 34735;
const DOUBLES: u16 = 34736;
const ASCII: u16 = 34737;

/// What the records before the points say; `bytes` are those of the file from its start.
pub(super) fn read(header: &Header, bytes: &[u8]) -> Option<Crs> {
    let mut crs = Crs::default();
    let mut at = header.records_start as usize;
    for _ in 0..header.records {
        let end = at.checked_add(RECORD_HEADER)?;
        let Some(head) = bytes.get(at..end).filter(|_| end as u64 <= header.start) else {
            break;
        };
        let length = usize::from(u16::from_le_bytes([head[20], head[21]]));
        let Some(content) = bytes.get(end..end + length) else {
            break;
        };
        if head[2..18].starts_with(USER) {
            take(&mut crs, u16::from_le_bytes([head[18], head[19]]), content);
        }
        at = end + length;
    }
    Some(crs).filter(|crs| !crs.is_empty())
}

/// What `count` long records say; `bytes` start at the first of them.
pub(super) fn read_long(count: u32, mut bytes: &[u8]) -> Option<Crs> {
    let mut crs = Crs::default();
    for _ in 0..count {
        let (head, rest) = bytes.split_at_checked(LONG_RECORD_HEADER)?;
        let length = head[20..28].first_chunk().map(|b| u64::from_le_bytes(*b))?;
        let (content, next) = rest.split_at_checked(usize::try_from(length).ok()?)?;
        if head[2..18].starts_with(USER) {
            take(&mut crs, u16::from_le_bytes([head[18], head[19]]), content);
            return Some(crs).filter(|crs| !crs.is_empty());
        }
        bytes = next;
    }
    None
}

fn take(crs: &mut Crs, number: u16, content: &[u8]) {
    let text = || {
        let end = content
            .iter()
            .rposition(|&b| b != 0)
            .map_or(0, |last| last + 1);
        String::from_utf8_lossy(&content[..end]).into_owned()
    };
    match number {
        TEXT => crs.wkt = Some(text()).filter(|text| !text.trim().is_empty()),
        KEYS => {
            crs.keys = content
                .as_chunks()
                .0
                .iter()
                .map(|&b| u16::from_le_bytes(b))
                .collect()
        }
        DOUBLES => {
            crs.doubles = content
                .as_chunks()
                .0
                .iter()
                .map(|&b| f64::from_le_bytes(b))
                .collect()
        }
        ASCII => crs.ascii = text(),
        _ => {}
    }
}
