//! Kinds of picture files, told by how they start.

use crate::base::error::{Error, Result};
use crate::formats::raw_cloud::Skin;

/// A kind of file.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Kind {
    pub(super) mime: &'static str,
    /// What a glTF file needs besides to have it.
    pub(super) extension: Option<&'static str>,
}

const PNG: Kind = Kind {
    mime: "image/png",
    extension: None,
};

/// What a picture is.
///
/// # Errors
/// [`Error::BadOption`] for bytes of another kind.
pub(super) fn kind(bytes: &[u8]) -> Result<Kind> {
    let of = |mime, extension| Kind { mime, extension };
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Ok(PNG),
        [0xff, 0xd8, ..] => Ok(of("image/jpeg", None)),
        [
            b'R',
            b'I',
            b'F',
            b'F',
            _,
            _,
            _,
            _,
            b'W',
            b'E',
            b'B',
            b'P',
            ..,
        ] => Ok(of("image/webp", Some("EXT_texture_webp"))),
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', ..] => {
            Ok(of("image/ktx2", Some("KHR_texture_basisu")))
        }
        _ => Err(wrong("PNG, JPEG, WebP or KTX2 files", "other bytes")),
    }
}

/// # Errors
/// [`Error::BadOption`] where one is of another kind.
pub(super) fn expect_png(skin: &Skin) -> Result<()> {
    let pictures = [&skin.color, &skin.normal, &skin.occlusion];
    for bytes in pictures.into_iter().flatten() {
        let found = kind(bytes)?;
        if found != PNG {
            return Err(wrong("PNG files, but in a GLB", found.mime));
        }
    }
    Ok(())
}

fn wrong(expected: &str, found: &str) -> Error {
    Error::bad_option("textures", expected, found)
}
