//! ZIP and gzip archives: what is in them, and each part unpacked.
//!
//! Read are stored and deflated parts, of ZIP64, too. Encrypted ones and other methods are refused. A part that would unpack to more than
//! deflate can, or than its entry says, is damaged. The members of a gzip file, of which some programs write one a block, are one
//! content.

use crate::base::error::{Error, Result};
use miniz_oxide::inflate::TINFLStatus;
use miniz_oxide::inflate::core::{DecompressorOxide, decompress, inflate_flags};
use std::borrow::Cow;

/// Deflate packs no more bytes into one.
const MOST_A_BYTE: usize = 1032;

/// A file in an archive.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Its path.
    pub name: String,
    /// Bytes once it is unpacked, where the archive says it.
    pub size: Option<u64>,
    /// Where its bytes are.
    start: usize,
    packed: usize,
    method: u16,
    encrypted: bool,
}

/// An archive that is wholly in memory.
pub struct Archive<'a> {
    bytes: Cow<'a, [u8]>,
    format: &'static str,
    /// What is in it.
    pub entries: Vec<Entry>,
}

impl<'a> Archive<'a> {
    /// Whether the content starts as an archive does.
    pub fn looks_like(head: &[u8]) -> bool {
        head.starts_with(b"PK\x03\x04") || head.starts_with(b"PK\x05\x06") || head.starts_with(GZIP)
    }

    /// Finds what is in an archive; `name` is the file's, without which the content of a gzip file has none.
    ///
    /// # Errors
    /// [`Error::BadFile`] with the byte.
    pub fn open(bytes: impl Into<Cow<'a, [u8]>>, name: Option<&str>) -> Result<Archive<'a>> {
        let bytes = bytes.into();
        if bytes.starts_with(GZIP) {
            let start = gzip_start(&bytes).ok_or_else(|| bad("gzip", 0, HEAD, END))?;
            let name = name.unwrap_or_default();
            let entry = Entry {
                name: name.strip_suffix(".gz").unwrap_or(name).into(),
                size: None,
                start,
                packed: bytes.len().saturating_sub(start),
                method: DEFLATED,
                encrypted: false,
            };
            return Ok(Archive {
                bytes,
                format: "gzip",
                entries: vec![entry],
            });
        }
        let entries = directory(&bytes)?;
        Ok(Archive {
            bytes,
            format: "ZIP",
            entries,
        })
    }

    /// The content of an entry.
    ///
    /// # Errors
    /// [`Error::BadFile`] with the byte, [`Error::UnsupportedFile`].
    pub fn unpack(&self, entry: &Entry) -> Result<Vec<u8>> {
        let unsupported = |found: String| Error::UnsupportedFile {
            format: self.format,
            expected: "stored or deflated content without a password".into(),
            found,
        };
        if entry.encrypted {
            return Err(unsupported(format!("{} is encrypted", entry.name)));
        }
        let end = entry
            .start
            .saturating_add(entry.packed)
            .min(self.bytes.len());
        let packed = self.bytes.get(entry.start..end).unwrap_or_default();
        let at = entry.start as u64;
        match entry.method {
            STORED => Ok(packed.to_vec()),
            DEFLATED => {
                let most = packed
                    .len()
                    .saturating_mul(MOST_A_BYTE)
                    .saturating_add(1 << 10);
                let limit = entry.size.map_or(most, |size| (size as usize).min(most));
                let mut content = Vec::new();
                let mut next = 0;
                loop {
                    next += inflate(&packed[next..], limit, &mut content).map_err(|status| {
                        let found = format!("{} does not unpack: {status:?}", entry.name);
                        bad(self.format, at + next as u64, "deflated content", found)
                    })?;
                    // Behind the content of a gzip member are its checksum and size, and perhaps another.
                    let after = next.saturating_add(GZIP_TRAILER).min(packed.len());
                    if self.format != "gzip" || !packed[after..].starts_with(GZIP) {
                        return Ok(content);
                    }
                    next = after
                        + gzip_start(&packed[after..])
                            .ok_or_else(|| bad("gzip", at + after as u64, HEAD, END))?;
                }
            }
            method => Err(unsupported(format!(
                "{} is packed by method {method}",
                entry.name
            ))),
        }
    }
}

const GZIP: &[u8] = b"\x1f\x8b";
/// Bytes behind the content of a gzip member.
const GZIP_TRAILER: usize = 8;
const HEAD: &str = "the head of a gzip file";
const END: &str = "the end of the file";
const STORED: u16 = 0;
const DEFLATED: u16 = 8;

fn bad(format: &'static str, at: u64, expected: &str, found: impl Into<String>) -> Error {
    Error::BadFile {
        format,
        place: "byte",
        at,
        expected: expected.into(),
        found: found.into(),
    }
}

/// Unpacks deflated bytes behind `content`, up to `limit` bytes in all; how many packed bytes those were.
fn inflate(
    packed: &[u8],
    limit: usize,
    content: &mut Vec<u8>,
) -> std::result::Result<usize, TINFLStatus> {
    let flags = inflate_flags::TINFL_FLAG_USING_NON_WRAPPING_OUTPUT_BUF;
    let mut state = Box::<DecompressorOxide>::default();
    let (mut from, mut filled) = (0, content.len());
    loop {
        // Room for twice the packed bytes, then twice as much.
        let room = (filled + packed.len()).max(1 << 10).saturating_mul(2);
        content.resize(room.min(limit).max(filled), 0);
        let (status, taken, given) =
            decompress(&mut state, &packed[from..], content, filled, flags);
        (from, filled) = (from + taken, filled + given);
        match status {
            TINFLStatus::Done => {
                content.truncate(filled);
                return Ok(from);
            }
            TINFLStatus::HasMoreOutput if content.len() < limit => {}
            _ => return Err(status),
        }
    }
}

/// Where the deflated bytes of a gzip file start.
fn gzip_start(bytes: &[u8]) -> Option<usize> {
    let flags = *bytes.get(3)?;
    let mut at = 10;
    if flags & 4 != 0 {
        at += 2 + usize::from(u16::from_le_bytes([*bytes.get(at)?, *bytes.get(at + 1)?]));
    }
    for text in [8, 16] {
        if flags & text != 0 {
            at += bytes.get(at..)?.iter().position(|&b| b == 0)? + 1;
        }
    }
    if flags & 2 != 0 {
        at += 2;
    }
    (at <= bytes.len()).then_some(at)
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    bytes
        .get(at..at + 2)?
        .first_chunk()
        .map(|b| u16::from_le_bytes(*b))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    bytes
        .get(at..at + 4)?
        .first_chunk()
        .map(|b| u32::from_le_bytes(*b))
}

fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    bytes
        .get(at..at.checked_add(8)?)?
        .first_chunk()
        .map(|b| u64::from_le_bytes(*b))
}

/// The entries of a ZIP file, by the directory at its end.
fn directory(bytes: &[u8]) -> Result<Vec<Entry>> {
    const MARK: &[u8] = b"PK\x05\x06";
    const END_SIZE: usize = 22;
    let none = || bad("ZIP", bytes.len() as u64, "a directory at the end", "none");
    let from = bytes.len().saturating_sub(END_SIZE + usize::from(u16::MAX));
    let end = bytes[from..]
        .windows(MARK.len())
        .rposition(|window| window == MARK)
        .map(|at| from + at)
        .ok_or_else(none)?;
    let (count, start) = (u16_at(bytes, end + 10), u32_at(bytes, end + 16));
    let (mut count, mut start) = (
        u64::from(count.ok_or_else(none)?),
        u64::from(start.ok_or_else(none)?),
    );
    if let Some(large) = large_directory(bytes, end) {
        (count, start) = large;
    }
    let mut entries = Vec::new();
    let mut at = usize::try_from(start).map_err(|_| none())?;
    for _ in 0..count {
        let (entry, next) = entry(bytes, at)
            .ok_or_else(|| bad("ZIP", at as u64, "an entry of the directory", "none"))?;
        if !entry.name.ends_with('/') {
            entries.push(entry);
        }
        at = next;
    }
    Ok(entries)
}

/// Count and start of a ZIP64 directory.
fn large_directory(bytes: &[u8], end: usize) -> Option<(u64, u64)> {
    let locator = end.checked_sub(20)?;
    if bytes.get(locator..locator + 4)? != b"PK\x06\x07" {
        return None;
    }
    let at = usize::try_from(u64_at(bytes, locator + 8)?).ok()?;
    Some((
        u64_at(bytes, at.checked_add(32)?)?,
        u64_at(bytes, at.checked_add(48)?)?,
    ))
}

/// An entry of the directory, and where the next one is.
fn entry(bytes: &[u8], at: usize) -> Option<(Entry, usize)> {
    const SIZE: usize = 46;
    if bytes.get(at..at.checked_add(4)?)? != b"PK\x01\x02" {
        return None;
    }
    let short = |offset: usize| u16_at(bytes, at + offset).map(usize::from);
    let (name, extra, comment) = (short(28)?, short(30)?, short(32)?);
    let text = bytes.get(at + SIZE..at + SIZE + name)?;
    let extras = bytes.get(at + SIZE + name..at + SIZE + name + extra)?;
    let mut sizes = [20, 24, 42].map(|offset| u32_at(bytes, at + offset).map(u64::from));
    // ZIP64: what does not fit follows in this order: size, packed size, start.
    if let Some(mut large) = extra_field(extras, 1) {
        for i in [1, 0, 2] {
            if sizes[i] == Some(u64::from(u32::MAX)) {
                sizes[i] = u64_at(large, 0);
                large = large.get(8..).unwrap_or_default();
            }
        }
    }
    let local = usize::try_from(sizes[2]?).ok()?;
    if bytes.get(local..local.checked_add(4)?)? != b"PK\x03\x04" {
        return None;
    }
    let before = usize::from(u16_at(bytes, local + 26)?) + usize::from(u16_at(bytes, local + 28)?);
    let entry = Entry {
        name: String::from_utf8_lossy(text).into_owned(),
        size: sizes[1],
        start: local + 30 + before,
        packed: usize::try_from(sizes[0]?).ok()?,
        method: u16_at(bytes, at + 10)?,
        encrypted: u16_at(bytes, at + 8)? & 1 != 0,
    };
    Some((entry, at + SIZE + name + extra + comment))
}

/// The content of an extra field.
fn extra_field(mut extras: &[u8], wanted: u16) -> Option<&[u8]> {
    while let (Some(id), Some(size)) = (u16_at(extras, 0), u16_at(extras, 2)) {
        let content = extras.get(4..4 + usize::from(size))?;
        if id == wanted {
            return Some(content);
        }
        extras = &extras[4 + usize::from(size)..];
    }
    None
}
