//! What format a file is of.

use super::Format;
#[cfg(feature = "files")]
use super::reading::MARK;
use super::text::quote;
#[cfg(feature = "files")]
use super::{obj, off, pcd, ply, stl, xyz};
use crate::base::error::{Error, Result};

/// The format of a file: by its content where that tells, else by its name.
///
/// # Errors
/// [`Error::UnknownFormat`], which says what the content looks like.
pub fn detect(bytes: &[u8], name: Option<&str>) -> Result<Format> {
    detect_head(bytes, bytes.len() as u64, name)
}

/// [`detect`] from the first bytes of `size`.
pub(super) fn detect_head(head: &[u8], size: u64, name: Option<&str>) -> Result<Format> {
    const MAGIC: [(&[u8], Format); 3] = [
        (b"LASF", Format::Las),
        (b"ASTM-E57", Format::E57),
        (b"glTF", Format::Glb),
    ];
    if let Some((_, format)) = MAGIC.iter().find(|(start, _)| head.starts_with(start)) {
        return Ok(*format);
    }
    if let Some(other) = known_but_not_read(head) {
        return Err(unknown(other));
    }
    if let Some(format) = by_look(head, size) {
        return Ok(format);
    }
    let named = name.and_then(Format::from_name);
    // A format with a signature is never one by its name alone.
    let by_name = named.filter(|format| !MAGIC.iter().any(|(_, signed)| signed == format));
    by_name.ok_or_else(|| {
        let found = match head {
            [] => "no content".into(),
            _ => format!(
                "content that starts with {}",
                quote(&head[..head.len().min(16)])
            ),
        };
        match named {
            Some(format) => unknown(&format!("{found}, which no {} file does", format.title())),
            None => unknown(&found),
        }
    })
}

/// The format of a file without a signature, by what its first lines say or by its size.
#[cfg(feature = "files")]
fn by_look(head: &[u8], size: u64) -> Option<Format> {
    let head = head.strip_prefix(MARK).unwrap_or(head);
    type Look = fn(&[u8], u64) -> bool;
    let looks: [(Look, Format); 6] = [
        (|head, _| ply::looks_like(head), Format::Ply),
        (|head, _| pcd::looks_like(head), Format::Pcd),
        (stl::looks_like, Format::Stl),
        (|head, _| off::looks_like(head), Format::Off),
        (|head, _| obj::looks_like(head), Format::Obj),
        (|head, _| xyz::looks_like(head), Format::Xyz),
    ];
    let found = looks.iter().find(|(look, _)| look(head, size));
    found.map(|(_, format)| *format)
}

#[cfg(not(feature = "files"))]
fn by_look(_: &[u8], _: u64) -> Option<Format> {
    None
}

/// The name of a format that is recognised by its first bytes but has no reader here.
fn known_but_not_read(head: &[u8]) -> Option<&'static str> {
    const SIGNATURES: [(&[u8], &str); 8] = [
        (b"\xff\xfe", "UTF-16 text"),
        (b"\xfe\xff", "UTF-16 text"),
        (b"PK\x03\x04", "a ZIP archive"),
        (b"\x1f\x8b", "a gzip archive"),
        (
            b"version https://git-lfs",
            "a Git LFS pointer, not the file itself",
        ),
        (b"<", "an XML or HTML document"),
        (b"{", "a JSON document"),
        (b"%PDF", "a PDF document"),
    ];
    SIGNATURES
        .iter()
        .find(|(start, _)| head.starts_with(start))
        .map(|(_, name)| *name)
}

fn unknown(found: &str) -> Error {
    Error::UnknownFormat {
        expected: "PLY, PCD, LAS, LAZ, E57, OBJ, OFF, STL, GLB, or rows of numbers as text (XYZ, TXT, PTS, CSV)".into(),
        found: found.into(),
    }
}
